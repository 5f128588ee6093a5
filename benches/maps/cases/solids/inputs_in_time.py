"""Inputs that change within a communication step: held, or with their slopes."""

import cmath
import math
from functools import cache

import numpy as np
from plan import Answer, Axis, Boundary, Map, Work
from problems.materials import ALUMINA
from problems.plates import START, probe, scene
from scipy.optimize import brentq
from unit_run import equal_steps, run_unit, unit_work

from cases.solids.plates import DIFFUSIVITY

THICKNESS, FLUX, CYCLES = 0.2e-3, 1e6, 2.0  # m, W/m², 1
RATE = DIFFUSIVITY / THICKNESS**2  # 1/s
BEATS = [0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0]
ROTATIONS = [0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0]
TERMS = 20_000


def of(has_slopes: bool):
    """A slab under `q (1 + cos ωt)`; `beat` is ω over the slab's own rate, `rotation` ω Δt."""

    def work(beat: float, rotation: float) -> Work:
        omega = beat * RATE
        count = max(round(2.0 * math.pi * CYCLES / rotation), 1)
        stop = count * rotation / omega
        told = scene(
            {"shape": {"box": [THICKNESS] * 3}, "faces": {"top": {"flux": FLUX}}},
            stop,
            stop / count,
            probe=[probe("top", [0.0, 0.0, 0.0], "temperature")],
            fidelity={"tolerance": 1e-3},
        )
        phases = [rotation * place for place in range(count)]
        fluxes = {"plate.top.flux": [FLUX * (1.0 + math.cos(phase)) for phase in phases]}
        slopes = {"plate.top.flux": [-FLUX * omega * math.sin(phase) for phase in phases]}
        steps = equal_steps(stop, count)
        return unit_work(told, ["top.temperature"], steps, fluxes, slopes if has_slopes else None)

    return work


def exact_rise(omega: float, times: np.ndarray) -> np.ndarray:
    """The heated face of the slab under `q (1 + cos ωt)`, mode by mode [K].

    `T = q/ρcL [t + sin ωt/ω + 2 Σ (1 − e^{−λt})/λ + (λ cos ωt + ω sin ωt − λ e^{−λt})/(λ² + ω²)]`,
    `λ = (nπ)² a/L²`."""
    rates = (math.pi * np.arange(1, TERMS)) ** 2 * RATE
    rises = []
    for time in times:
        fades = np.exp(-np.minimum(rates * time, 700.0))
        cosine = rates * math.cos(omega * time) + omega * math.sin(omega * time) - rates * fades
        sums = np.sum((1.0 - fades) / rates + cosine / (rates**2 + omega**2))
        rises.append(time + math.sin(omega * time) / omega + 2.0 * sums)
    capacity = ALUMINA["density"] * ALUMINA["specific_heat"] * THICKNESS
    return FLUX / capacity * np.array(rises)


def response(omega: float) -> complex:
    """`coth(√(iω L²/a))/(k √(iω/a))`: the face's rise over a flux of that frequency [K m²/W]."""
    root = cmath.sqrt(1j * omega / DIFFUSIVITY)
    return 1.0 / (cmath.tanh(root * THICKNESS) * ALUMINA["conductivity"] * root)


def error(answer: Answer, beat: float, rotation: float) -> float:
    """The amplitude of what is off over the last cycle, of the swing's.

    A shift that stays is left out: it is that of the heat which the first step brings too much."""
    omega = beat * RATE
    found = np.array(answer.values["top.temperature"]) - START
    times = np.arange(len(found)) * rotation / omega
    last = times > times[-1] - 2.0 * math.pi / omega
    off = found[last] - exact_rise(omega, times[last])
    phases = omega * times[last]
    basis = np.stack([np.ones_like(phases), np.cos(phases), np.sin(phases)], axis=1)
    _, cosine, sine = np.linalg.lstsq(basis, off, rcond=None)[0]
    return math.hypot(cosine, sine) / (FLUX * abs(response(omega)))


@cache
def settled_error(beat: float, rotation: float, has_slopes: bool) -> float:
    """What a swing errs by at communication points once transients are over, by z-transform.

    The stepwise input has the frequencies `ν = ω + 2πm/Δt`, whose responses add up there: Franklin,
    Powell & Workman (1998), Digital Control of Dynamic Systems, § 4.3."""
    omega = beat * RATE
    step = rotation / omega
    total = 0.0
    for place in range(-200, 201):
        nu = omega + 2.0 * math.pi * place / step
        turned = cmath.exp(-1j * nu * step)
        held = (1.0 - turned) / (1j * nu * step)
        tilt = -turned / (1j * nu) + (1.0 - turned) / ((1j * nu) ** 2 * step)
        total += (held + (1j * omega * tilt if has_slopes else 0.0)) * response(nu)
    return abs(total / response(omega) - 1.0)


def map_of(name: str, title: str, has_slopes: bool) -> Map:
    def limit(beat: float) -> float:
        off = lambda rotation: settled_error(beat, rotation, has_slopes) - 0.05  # noqa: E731
        return brentq(off, 1e-3, 2.5, xtol=1e-3)

    return Map(
        name=name,
        title=title,
        x=Axis("frequency of the input ω L²/a", "1", BEATS),
        y=Axis("communication step ω Δt", "1", ROTATIONS),
        outcome="relative error of the swing",
        unit="1",
        bad=0.05,
        work=of(has_slopes),
        run=run_unit,
        judge=error,
        theory=[Boundary("five per cent", limit, "z-transform of the stepwise input")],
        guards="a unit cannot know what its input does between communication points",
        must_speak=False,
        refine=1.03,
        colours=(1e-4, 1.0),
    )


def held_inputs() -> Map:
    return map_of(
        "held_inputs", "Error of an input held over a communication step", has_slopes=False
    )


def sloping_inputs() -> Map:
    return map_of("sloping_inputs", "Inputs with their slopes", has_slopes=True)
