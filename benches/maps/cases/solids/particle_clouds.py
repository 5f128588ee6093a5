"""The corrected operator on disordered particles beside a face, and on the meshes users reach."""

from dataclasses import replace

from plan import Answer, Axis, Map, Work
from problems.half_spaces import disc_flux_rise
from problems.materials import ALUMINA
from problems.plates import START, load, probe, scene
from unit_run import equal_steps, run_unit, unit_work

from cases.solids.built import printed
from cases.solids.plates import DIFFUSIVITY

CLOUDS = 60
DISORDERS = [0.0, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5]
DISTANCES = [0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0]


SUPPORT, NARROW = 3.0, 1.6  # over the spacing: as users have it, and near where neighbours get few


def cloud(disorder: float, distance: float) -> Work:
    return {"support": SUPPORT, "disorder": disorder, "distance": distance, "count": CLOUDS}


def narrow_cloud(disorder: float, distance: float) -> Work:
    return cloud(disorder, distance) | {"support": NARROW}


def run_cloud(work: Work) -> Answer:
    words = [work[name] for name in ("support", "disorder", "distance", "count")]
    return Answer(printed("particle_limits", "operator", *words))


def of_clouds(name: str, title: str, outcome: str, key: str, bad: float, colours) -> Map:
    return Map(
        name=name,
        title=title,
        x=Axis("disorder: largest shift over spacing", "1", DISORDERS, is_logarithmic=False),
        y=Axis("distance to a bare face over spacing", "1", DISTANCES, is_logarithmic=False),
        outcome=outcome,
        unit="1",
        bad=bad,
        work=cloud,
        run=run_cloud,
        judge=lambda answer, *_: answer.values[key],
        guards="no user reaches disordered particles without images",
        must_speak=False,
        colours=colours,
    )


def cloud_condition() -> Map:
    return of_clouds(
        "cloud_condition",
        "Corrected operator: condition of its systems",
        "larger condition number, median",
        "condition",
        1e3,
        (1.0, 1e3),
    )


def cloud_error() -> Map:
    return of_clouds(
        "cloud_error",
        "Corrected operator: error of a Laplacian",
        "error of a wave of twelve particles, root mean square",
        "error",
        0.3,
        (1e-3, 1.0),
    )


def cloud_plain() -> Map:
    return of_clouds(
        "cloud_plain",
        "Plain operator: error of a Laplacian",
        "error of a wave of twelve particles, root mean square",
        "plain",
        0.3,
        (1e-3, 1.0),
    )


def cloud_fallback() -> Map:
    usual = of_clouds(
        "cloud_fallback",
        f"Particles that fall back to the plain operator, support {NARROW:g}",
        "part of the particles whose corrected operator is given up",
        "fallback",
        0.5,
        (0.0, 1.0),
    )
    return replace(usual, work=narrow_cloud)


RADIUS, HALF, FLUX = 50e-6, 0.25e-3, 1e8
STOP = (0.5 * RADIUS) ** 2 / DIFFUSIVITY
GROWTHS = [1.0, 1.05, 1.1, 1.2, 1.3, 1.4, 1.6, 2.0]
SUPPORTS = [1.1, 1.3, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0]


def graded(growth: float, support: float) -> Work:
    body = {
        "shape": {"disc": {"radius": HALF, "thickness": HALF}},
        "heat": "sph",
        "sph": {"support": support},
        "mesh": {"spacing": 0.1 * RADIUS, "depth_spacing": 0.05 * RADIUS, "growth": growth},
    }
    told = scene(
        body,
        STOP,
        STOP,
        load=[load({"disc": {"radius": RADIUS}}, "heat_flux", FLUX)],
        probe=[probe("centre", [0.0, 0.0, 0.0], "temperature")],
    )
    outputs = ["centre.temperature", "plate.fallback_particles"]
    return unit_work(told, outputs, equal_steps(STOP, 1))


def error(answer: Answer, *_) -> float:
    rise = disc_flux_rise(FLUX, RADIUS, 0.0, STOP, ALUMINA)
    return abs(answer.values["centre.temperature"][-1] - START - rise) / rise


def particle_grading() -> Map:
    return Map(
        name="particle_grading",
        title="Error under a spot, by support and grading of particles",
        x=Axis("growth of distances", "1", GROWTHS),
        y=Axis("support over spacing", "1", SUPPORTS),
        outcome="relative error of the centre's rise",
        unit="1",
        bad=0.05,
        work=graded,
        run=run_unit,
        judge=error,
        colours=(1e-3, 1.0),
    )
