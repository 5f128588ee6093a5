"""Noise on a lattice of particles: maps of where it grows, beside the method's own small waves."""

from collections.abc import Callable
from functools import cache
from math import exp, inf, log

import numpy as np
from plan import Answer, Axis, Boundary, Map

from cases.fluids.flow_limits import run_flow
from cases.fluids.lattice import (
    SHAPES,
    Lattice,
    growth,
    largest,
    mean_slope,
    noise_between_periods,
    second_moment,
)

ACROSS, STEPS, GROWN = 24, 300, 100.0
"""Particles along a side, time steps, and growth of noise that counts as one."""
SOURCE = "small waves on the lattice"
COURANT, VISCOUS, DIFFUSIVE = 0.2, 0.85, 0.85
"""Of the time steps that scenes get (`StepShares` in `src/method/sph/method.rs`)."""


def work(**settings) -> dict:
    return {
        "flow": "lattice",
        "across": ACROSS,
        "steps": STEPS,
        "precision": "double",
    } | settings


def grown(answer: Answer, x: float, y: float) -> float:
    found = answer.values.get("growth", inf)
    return min(found, 1e30)


def is_stable(of: Lattice, step: float, **settings) -> bool:
    """Whether no wave that fits between the periods grows as much as counts."""
    return STEPS * log(growth(of, step, **settings)) < log(GROWN)


@cache
def longest_step(of: Lattice, **settings) -> float:
    return largest(lambda step: is_stable(of, step, **settings), 1e-4, 4.0)


def between(values: list[float], limit: Callable[[float], float]) -> Callable[[float], float]:
    """A limit that is costly, at an axis's values, and drawn straight on between them."""

    @cache
    def knots() -> list[float]:
        return [log(limit(x)) for x in values]

    return lambda x: exp(np.interp(x, values, knots()))


def own_step(kernel: str, viscosity: float = 0.0, diffusion: float = 0.1) -> float:
    """That of scenes, of fluid at rest in two dimensions."""
    steps = [COURANT]
    if viscosity:
        steps.append(VISCOUS * second_moment(kernel, 2) / (8.0 * viscosity))
    if diffusion:
        steps.append(DIFFUSIVE / (diffusion * mean_slope(kernel, 2)))
    return min(steps)


def map_of_steps(name: str, title: str, x: Axis, y: Axis, setting, own) -> Map:
    """Time steps over a setting: `setting(x)` are arguments of theory and program alike."""
    return Map(
        name=name,
        title=title,
        x=x,
        y=y,
        outcome=f"growth of noise in {STEPS} steps",
        unit="1",
        bad=GROWN,
        work=lambda x, y: work(courant=y, **setting(x)),
        run=run_flow,
        judge=grown,
        theory=[
            Boundary("limit of theory", between(x.values, lambda x: limit(setting(x))), SOURCE),
            Boundary("steps of scenes", own, "src/method/sph/method.rs", is_limit=False),
        ],
        must_speak=False,
        refine=1.02,
        colours=(1e-2, 1e6),
    )


def limit(settings: dict) -> float:
    of = Lattice(settings.get("kernel", "wendland_c2"), settings.get("support", 3.0))
    rest = {k: v for k, v in settings.items() if k not in ("kernel", "support")}
    return longest_step(of, **rest)


def map_of_pressures(name: str, title: str, kernel: str, sign: float, cells: str) -> Map:
    """Support over a pressure of some sign, under which particles pair or come apart."""
    supports = [2.0, 2.25, 2.5, 2.75, 3.0, 3.5, 4.0, 5.0, 6.0]

    def onset(support: float) -> float:
        of = Lattice(kernel, support, cells, ACROSS)
        return largest(
            lambda p: noise_between_periods(of, COURANT, STEPS, pressure=sign * p) < GROWN,
            1e-5,
            1.0 if sign > 0 else 0.1,
        )

    return Map(
        name=name,
        title=title,
        x=Axis("support H over the distance of particles Δx", "1", supports, False),
        y=Axis(
            "pressure p₀/(ρc₀²)" if sign > 0 else "tension −p₀/(ρc₀²)",
            "1",
            [1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1] + ([0.3, 1.0] if sign > 0 else []),
        ),
        outcome=f"growth of noise in {STEPS} steps",
        unit="1",
        bad=GROWN,
        work=lambda x, y: work(
            courant=COURANT, support=x, pressure=sign * y, kernel=kernel, cells=cells
        ),
        run=run_flow,
        judge=grown,
        theory=[Boundary("limit of theory", between(supports, onset), SOURCE)],
        must_speak=False,
        refine=1.05,
        colours=(1e-2, 1e6),
    )


KERNELS = list(SHAPES)
