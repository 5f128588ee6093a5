"""Drops that hit a wall of rings, as scenes, and what is known of them."""

from math import sqrt

from problems.drops import droplet, wall
from problems.materials import liquid
from unit_run import equal_steps, unit_work

HOT, COLD = 350.0, 293.15  # K
DENSITY, TENSION, DIAMETER = 1000.0, 0.072, 1e-4


def viscous(ohnesorge: float) -> dict:
    """As dense as water and of its tension, as viscous as `Oh = µ/√(ρσD)` says."""
    viscosity = ohnesorge * sqrt(DENSITY * TENSION * DIAMETER)
    return liquid(DENSITY, viscosity, surface_tension=TENSION)


def speed_of(weber: float) -> float:
    return sqrt(weber * TENSION / (DENSITY * DIAMETER))


def ohnesorge_of(weber: float, reynolds: float) -> float:
    return sqrt(weber) / reynolds


def impact(
    across: float,
    speed: float,
    fluid: dict,
    stop: float,
    *,
    diameter: float = DIAMETER,
    reach: float = 5.0,
    **body,
) -> dict:
    """Until so many D/U have passed."""
    spacing = diameter / across
    drop = droplet(diameter, speed, HOT, fluid, spacing=spacing)
    rings = wall(max(1, int(0.5 * reach * across / 2.0)), 0.5 * reach * diameter, COLD)
    time = stop * diameter / speed
    return {
        "name": "Impact",
        "stop_time": time,
        "step": time / 20.0,
        "body": {"drop": drop | body},
        "wall": [rings],
        "solver": {"threads": 1},
    }


def impact_work(scene: dict, outputs: list[str], steps: int = 40) -> dict:
    return unit_work(
        scene, [f"drop.{name}" for name in outputs], equal_steps(scene["stop_time"], steps)
    )


def largest_spread(weber: float, reynolds: float, at_rest: float) -> float:
    """D_max/D by a fit of measurements.

    `√(β² − β₀²) = Re^(1/5) √We/(7.6 + √We)` with β₀ of a drop at rest (Lee et al.
    2016, J. Fluid Mech. 786, R4, doi 10.1017/jfm.2015.620)."""
    root = sqrt(weber)
    return sqrt(at_rest**2 + (reynolds**0.2 * root / (7.6 + root)) ** 2)


HEMISPHERE = 2.0 ** (1.0 / 3.0)
"""Diameter over D of a drop at rest that meets the wall at 90°."""
