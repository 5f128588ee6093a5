"""Heat through a disc under a spot that flickers: quadratic elements on a meridian section.

Operators are products of those along the radius and along the depth, with consistent capacities;
they take NumPy alone. `reduced_unit.py` and `reduced_pymor.py` reduce the same numbers.
"""

import math
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.linalg import eigh

sys.path.append(str(Path(__file__).resolve().parents[2]))
from problems.half_spaces import disc_flux_rise  # noqa: E402 - of the folder of all benches
from problems.materials import ALUMINA  # noqa: E402

RADIUS, HALF, THICKNESS = 50e-6, 500e-6, 200e-6  # m: of the spot, of the disc
SPACING = RADIUS / 6  # of nodes
COOLING = 1e4
FLUX = 5e7  # W/m²
STOP, STEPS, HELD = 1e-3, 2000, 50
LEVELS = np.random.default_rng(7).random(STEPS // HELD)
"""Parts of the flux, each for so many steps."""
DIFFERENCE, BOUND, CENTRE = "difference to all modes", "bound told", "temperature of the centre"
POINTS = {"centre": (0.0, 0.0), "rim": (RADIUS, 0.0), "below": (0.0, 50e-6)}
"""Radius and depth of what is read [m]."""


@dataclass(frozen=True)
class Operators:
    """`E dT/dt = −K T + b q`, `y = C T`, with temperatures above those at the start."""

    capacity: np.ndarray
    conductance: np.ndarray
    load: np.ndarray
    rows: np.ndarray


def along(nodes: np.ndarray, weight) -> tuple[np.ndarray, np.ndarray]:
    """Mass and stiffness of quadratic elements at equal distances [weight × m, weight / m]."""
    size = nodes[2] - nodes[0]
    mass, stiffness = np.zeros((2, len(nodes), len(nodes)))
    for at, share in zip(*np.polynomial.legendre.leggauss(4), strict=True):
        shape = np.array([at * (at - 1.0) / 2.0, 1.0 - at**2, at * (at + 1.0) / 2.0])
        slope = np.array([at - 0.5, -2.0 * at, at + 0.5]) * 2.0 / size
        for i in range(0, len(nodes) - 1, 2):
            here = 0.5 * share * size * weight(nodes[i + 1] + 0.5 * at * size)
            mass[i : i + 3, i : i + 3] += here * np.outer(shape, shape)
            stiffness[i : i + 3, i : i + 3] += here * np.outer(slope, slope)
    return mass, stiffness


def operators() -> Operators:
    radii = np.linspace(0.0, HALF, round(HALF / SPACING) + 1)
    depths = np.linspace(0.0, THICKNESS, round(THICKNESS / SPACING) + 1)
    ring, across = along(radii, lambda r: 2.0 * math.pi * r)
    line, down = along(depths, lambda z: 1.0)
    top, bottom = np.eye(len(depths))[[0, -1]]
    conductance = ALUMINA["conductivity"] * (np.kron(across, line) + np.kron(ring, down))
    conductance += COOLING * np.kron(ring, np.outer(bottom, bottom))
    inside = radii[: round(RADIUS / SPACING) + 1]
    spot = np.zeros(len(radii))
    spot[: len(inside)] = along(inside, lambda r: 2.0 * math.pi * r)[0].sum(axis=0)
    rows = [
        np.kron(np.isclose(radii, r, atol=1e-9), np.isclose(depths, z, atol=1e-9))
        for r, z in POINTS.values()
    ]
    capacity = ALUMINA["density"] * ALUMINA["specific_heat"] * np.kron(ring, line)
    return Operators(capacity, conductance, np.kron(spot, top), np.array(rows, float))


def exact() -> np.ndarray:
    """What is read at the ends of all steps [K], above the start: all modes, each exact in time."""
    of = operators()
    rates, modes = eigh(of.conductance, of.capacity)
    decay = np.exp(-rates * STOP / STEPS)
    gain = (1.0 - decay) / rates * (modes.T @ of.load) * FLUX
    values, state = of.rows @ modes, np.zeros(len(rates))
    read = []
    for n in range(STEPS):
        state = decay * state + gain * LEVELS[n // HELD]
        read.append(values @ state)
    return np.array(read)


def answer(time: float) -> float:
    """Rise of the spot's centre on a half space under the whole flux [K]."""
    return disc_flux_rise(FLUX, RADIUS, 0.0, time, ALUMINA)


def half_space() -> float:
    """The centre at the end [K], above the start; answers to jumps of the flux add up."""
    jumps = np.diff(LEVELS, prepend=0.0)
    begins = np.arange(len(LEVELS)) * STOP / len(LEVELS)
    return sum(jump * answer(STOP - begin) for jump, begin in zip(jumps, begins, strict=True))


def values(read: np.ndarray) -> dict[str, float]:
    """Of what is read at the ends of all steps [K], above the start."""
    return {
        DIFFERENCE: float(np.abs(read - exact()).max()),
        CENTRE: float(read[-1, 0]),
    }
