"""Footprints that elements hardly see: small ones, and those that reach over the edge."""

import math
from collections.abc import Callable

from plan import Answer, Axis, Map, Work
from problems.half_spaces import disc_flux_rise
from problems.materials import ALUMINA
from problems.plates import START, load, probe, scene
from unit_run import equal_steps, run_unit, unit_work

from cases.solids.plates import DIFFUSIVITY

SPACING, HALF, FLUX = 10e-6, 0.2e-3, 1e7  # m, m, W/m²
OFFSETS = [0.0, 0.1, 0.25, 0.5, 0.75, 1.0]
SIZES = [0.1, 0.2, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0]


def small(size: float, offset: float) -> Work:
    """A spot beside the middle of a box, read in its own centre."""
    radius, place = size * SPACING, offset * 2.0 * SPACING
    stop = radius**2 / DIFFUSIVITY
    body = {
        "shape": {"box": [2 * HALF, 2 * HALF, HALF]},
        "mesh": {"spacing": SPACING, "depth_spacing": 0.1 * radius, "growth": 1.3},
    }
    told = scene(
        body,
        stop,
        stop,
        load=[load({"disc": {"radius": radius}}, "heat_flux", FLUX, start={"x": place})],
        probe=[probe("centre", [place, 0.0, 0.0], "temperature")],
    )
    return unit_work(told, ["centre.temperature", "plate.heat_in"], equal_steps(stop, 1))


def of_small(answer: Answer, size: float, _: float) -> float:
    """The larger of the errors of the centre's rise and of the heat that entered."""
    radius = size * SPACING
    stop = radius**2 / DIFFUSIVITY
    rise = disc_flux_rise(FLUX, radius, 0.0, stop, ALUMINA)
    found = answer.values["centre.temperature"][-1] - START
    heat = answer.values["plate.heat_in"][-1] / (math.pi * radius**2 * FLUX * stop)
    return max(abs(found / rise - 1.0), abs(heat - 1.0))


def small_spots() -> Map:
    return Map(
        name="small_spots",
        title="Error under a spot smaller than an element",
        x=Axis("radius over the distance of nodes", "1", SIZES),
        y=Axis("offset of the centre over an element", "1", OFFSETS, is_logarithmic=False),
        outcome="relative error of the centre's rise and of the heat",
        unit="1",
        bad=0.05,
        work=small,
        run=run_unit,
        judge=of_small,
        colours=(1e-3, 1.0),
    )


RADIUS, STOP = 50e-6, 1e-4  # m, s


def at_edge(place: float, spacing: float) -> Work:
    """A spot whose centre is so many radii within the edge."""
    body = {
        "shape": {"box": [2 * HALF, 2 * HALF, HALF]},
        "mesh": {"spacing": RADIUS / spacing, "depth_spacing": 5e-6, "growth": 1.3},
    }
    at = HALF - place * RADIUS
    spot = load({"disc": {"radius": RADIUS}}, "heat_flux", FLUX, start={"x": at})
    return unit_work(scene(body, STOP, STOP, load=[spot]), ["plate.heat_in"], [STOP])


def missing(answer: Answer, *_) -> float:
    """Part of the footprint's heat that did not enter."""
    return 1.0 - answer.values["plate.heat_in"][-1] / (math.pi * RADIUS**2 * FLUX * STOP)


def edge_spots() -> Map:
    return Map(
        name="edge_spots",
        title="Spots over the edge of a plate",
        x=Axis(
            "distance of the centre from the edge over the radius",
            "1",
            [0.0, 0.1, 0.25, 0.5, 0.75, 0.9, 0.99, 1.0, 1.25, 1.5],
            is_logarithmic=False,
        ),
        y=Axis("nodes over the radius", "1", [2.5, 4.0, 6.0, 10.0]),
        outcome="part of the heat that misses the plate",
        unit="1",
        bad=1e-9,
        work=at_edge,
        run=run_unit,
        judge=missing,
        colours=(0.0, 0.5),
    )


WIDE = 4e-3  # m


def moved(place: float, growth: float) -> Work:
    """A spot of fixed size that has moved from the fine mesh into the coarse one."""
    stop = RADIUS**2 / DIFFUSIVITY
    body = {
        "shape": {"box": [WIDE, WIDE, HALF]},
        "mesh": {"spacing": 0.1 * RADIUS, "depth_spacing": 10e-6, "growth": growth},
    }
    spot = load({"disc": {"radius": RADIUS}}, "heat_flux", FLUX)
    at = place * RADIUS
    told = scene(
        body,
        stop,
        stop,
        load=[spot],
        probe=[probe("centre", [at, 0.0, 0.0], "temperature")],
    )
    return unit_work(told, ["centre.temperature", "plate.heat_in"], [stop], {"spot.x": at})


def of_moved(answer: Answer, *_) -> float:
    rise = disc_flux_rise(FLUX, RADIUS, 0.0, RADIUS**2 / DIFFUSIVITY, ALUMINA)
    return abs(answer.values["centre.temperature"][-1] - START - rise) / rise


def off_its_place(
    name: str,
    title: str,
    x: Axis,
    growths: list[float],
    work: Callable[[float, float], Work],
    colours: tuple[float, float],
) -> Map:
    """What becomes of a spot where the mesh was not made for it."""
    return Map(
        name=name,
        title=title,
        x=x,
        y=Axis("growth of elements", "1", growths),
        outcome="relative error of the centre's rise",
        unit="1",
        bad=0.05,
        work=work,
        run=run_unit,
        judge=of_moved,
        colours=colours,
    )


def moved_spots() -> Map:
    ways = [0.0, 1.0, 2.0, 4.0, 8.0, 16.0, 28.0]
    return off_its_place(
        "moved_spots",
        "Error under a spot that an input moves off the fine mesh",
        Axis("way from where it starts over the radius", "1", ways, is_logarithmic=False),
        [1.1, 1.2, 1.35, 1.6, 2.0],
        moved,
        (1e-3, 1.0),
    )


SEAM = 1.2  # radii: the fine mesh ends two distances of nodes beyond the spot that it is made for


def on_seam(place: float, growth: float) -> Work:
    """A spot whose centre is so many radii beyond the seam."""
    return moved(SEAM + place, growth)


def seam() -> Map:
    places = [-1.2, -0.75, -0.25, 0.0, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0]
    return off_its_place(
        "seam",
        "A spot across the seam where elements begin to grow",
        Axis("centre beyond the seam over the radius", "1", places, is_logarithmic=False),
        [1.1, 1.2, 1.4, 1.6, 2.0],
        on_seam,
        (1e-4, 0.3),
    )
