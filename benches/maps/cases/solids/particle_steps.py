"""Particles that conduct: steps over what explicit Euler bears, and the unit's at any length."""

import itertools
import math

import numpy as np
from plan import Answer, Axis, Boundary, Map, Work
from problems.plates import START, probe, scene
from unit_run import equal_steps, run_unit, unit_work

from cases.solids.built import printed
from cases.solids.plates import DIFFUSIVITY, slab_surface_rise

SIDE, COUNT = 8, 600
"""Particles along an edge of the cube, and Euler steps."""
SUPPORTS = [1.5, 1.75, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0]
SPACING, LAYERS, FLUX = 10e-6, 24, 1e7  # m, 1, W/m²
OVER = SPACING**2 / DIFFUSIVITY  # s
UNITS = 120
"""The unit's time in Δx²/a."""


def fastest_decay(support: float) -> float:
    """λ_max Δx²/a of the corrected operator on an infinite lattice, by its symbol.

    `λ(θ) = Σ_j c_j (1 − cos θ·j)` with `c_j ∝ −W'(r)/r` of Wendland's C2 kernel in space,
    `−W'/r ∝ (1 − q)³`, scaled to be exact for quadratics, `Σ c_j j_x² = 2`; the lattice's symmetry
    leaves nothing else to correct."""
    reach = range(-math.ceil(support), math.ceil(support) + 1)
    places = np.array([j for j in itertools.product(reach, repeat=3) if any(j)], float)
    weights = np.maximum(1.0 - np.linalg.norm(places, axis=1) / support, 0.0) ** 3
    weights *= 2.0 / (weights @ places[:, 0] ** 2)
    waves = math.pi * np.arange(SIDE) / (SIDE - 1)
    return max(
        weights @ (1.0 - np.cos(places @ np.array(wave)))
        for wave in itertools.combinations_with_replacement(waves, 3)
    )


def euler_work(support: float, step: float) -> Work:
    return {"side": SIDE, "support": support, "step": step, "count": COUNT}


def run_euler(work: Work) -> Answer:
    words = [work["side"], work["support"], "corrected", work["step"], work["count"]]
    return Answer(printed("particle_limits", "euler", *words))


def particle_euler() -> Map:
    limit = Boundary(
        "2/λ of the fastest wave",
        lambda support: 2.0 / fastest_decay(support),
        "von Neumann",
    )
    return Map(
        name="particle_euler",
        title="Explicit Euler on the particles' own operator",
        x=Axis("support over spacing", "1", SUPPORTS),
        y=Axis("step a Δt/Δx²", "1", [0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 3.2]),
        outcome="growth of random temperatures in 600 steps",
        unit="1",
        bad=1.0,
        work=euler_work,
        run=run_euler,
        judge=lambda answer, *_: answer.values["growth"],
        theory=[limit],
        guards="no user reaches explicit steps",
        must_speak=False,
        refine=1.01,
        colours=(1e-3, 1e3),
    )


def unit_of(support: float, step: float) -> Work:
    stop = UNITS * OVER
    body = {
        "shape": {"box": [8 * SPACING, 8 * SPACING, LAYERS * SPACING]},
        "heat": "sph",
        "sph": {"support": support},
        "mesh": {"spacing": SPACING, "growth": 1.0},
        "faces": {"top": {"flux": FLUX}},
    }
    told = scene(body, stop, step * OVER, probe=[probe("top", [0.0, 0.0, 0.0], "temperature")])
    return unit_work(told, ["top.temperature"], equal_steps(stop, round(UNITS / step)))


def error(answer: Answer, *_) -> float:
    rise = slab_surface_rise(FLUX, LAYERS * SPACING, UNITS * OVER)
    return abs(answer.values["top.temperature"][-1] - START - rise) / rise


def particle_steps() -> Map:
    limit = Boundary(
        "where Euler's method would end",
        lambda support: 2.0 / fastest_decay(support),
        "2/λ",
        is_limit=False,
    )
    return Map(
        name="particle_steps",
        title="The unit's particles at the same steps and longer ones",
        x=Axis("support over spacing", "1", SUPPORTS),
        y=Axis("step a Δt/Δx²", "1", [0.1, 0.3, 1.0, 3.0, 12.0, 40.0, 120.0]),
        outcome="error of the surface's rise",
        unit="1",
        bad=0.02,
        work=unit_of,
        run=run_unit,
        judge=error,
        theory=[limit],
        colours=(1e-4, 1e-1),
    )
