"""Balanced truncation of a modal system by pyMOR beside impinge's reduction of the same numbers.

The system is that of a box of alumina, insulated but for its bottom, which is held: modes are
products of cosines along x and y and of quarter waves through the thickness, with rates
`κ (k_x² + k_y² + k_z²)` (H. S. Carslaw and J. C. Jaeger 1959, Conduction of Heat in Solids,
chapter 6). A Gaussian spot heats the top; two points are read. pyMOR solves its Lyapunov equations
by low-rank ADI and truncates; the error is that of step responses over all times, against the sum
of all modes. impinge reduces the same numbers (`cargo bench --bench reduction`, or a program that
is named).
"""

import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import scipy.sparse as sp
from problems.materials import ALUMINA
from pymor.models.iosys import LTIModel
from pymor.reductors.bt import BTReductor

ROOT = Path(__file__).resolve().parents[1]
LENGTH, WIDTH, HEIGHT = 4e-3, 4e-3, 0.5e-3
DENSITY, HEAT, CONDUCTIVITY = ALUMINA.values()
RADIUS, FLUX = 2e-4, 3e7
POINTS = [(0.0, 0.0, 0.0), (1.5e-4, 1e-4, -1e-4)]


def along(length, count, place):
    """Wave numbers of even cosines of norm one, sources of a Gaussian, and values at a place."""
    k = 2 * np.pi * np.arange(count) / length
    norm = np.where(k > 0, np.sqrt(2 / length), np.sqrt(1 / length))
    # ∫ exp(−2x²/R²) cos kx dx; what lies beyond the box is below 1e-80.
    source = norm * np.sqrt(np.pi / 2) * RADIUS * np.exp(-((k * RADIUS) ** 2) / 8)
    return k, source, norm * np.cos(k * np.asarray(place))


def system(counts):
    """Rates, `b` and `c` of all modes."""
    nx, ny, nz = counts
    depth = (np.arange(nz) + 0.5) * np.pi / HEIGHT
    norm = np.sqrt(2 / HEIGHT)
    kx, bx, _ = along(LENGTH, nx, 0.0)
    ky, by, _ = along(WIDTH, ny, 0.0)
    kappa = CONDUCTIVITY / (DENSITY * HEAT)
    outer = lambda x, y, z: np.einsum("i,j,k->ijk", x, y, z).ravel()  # noqa: E731
    rates = (
        kappa
        * (kx[:, None, None] ** 2 + ky[None, :, None] ** 2 + depth[None, None, :] ** 2).ravel()
    )
    b = FLUX / (DENSITY * HEAT) * outer(bx, by, norm * np.ones(nz))
    values = []
    for x, y, z in POINTS:
        values.append(
            outer(along(LENGTH, nx, x)[2], along(WIDTH, ny, y)[2], norm * np.cos(depth * z))
        )
    return rates, b, np.array(values)


def steps(rates, b, c, times):
    """Step responses of a diagonal system at times."""
    return np.array([(c * b) @ (-np.expm1(-rates * t) / rates) for t in times])


def reduced_steps(model, times):
    """Step responses of a small dense system."""
    a, b, c = (
        part.to_numpy() if hasattr(part, "to_numpy") else part
        for part in model.to_abcde_matrices()[:3]
    )
    e = model.to_abcde_matrices()[4]
    a, b = (a, b) if e is None else (np.linalg.solve(e, a), np.linalg.solve(e, b))
    values, vectors = np.linalg.eig(a)
    entering = np.linalg.solve(vectors, b.astype(complex)).ravel()
    leaving = c @ vectors
    return np.array([((leaving * entering) @ (np.expm1(values * t) / values)).real for t in times])


def impinge(program, numbers, orders):
    """What impinge says of its own reduction of a system."""
    rates, b, c = numbers
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "system"
        with path.open("wb") as file:
            np.array([len(rates), len(c)], dtype="<u8").tofile(file)
            for part in (rates, b, *c):
                np.ascontiguousarray(part, dtype="<f8").tofile(file)
        command = (
            [program] if program else ["cargo", "bench", "--quiet", "--bench", "reduction", "--"]
        )
        command += [path, *map(str, orders)]
        return subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT).stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--orders", type=int, nargs="+", default=[8, 12, 16, 20])
    parser.add_argument(
        "--counts", type=int, nargs=3, default=[48, 48, 48], help="modes along x, y, z"
    )
    parser.add_argument(
        "--program", type=Path, help="the bench `reduction`, built; else cargo builds it"
    )
    asked = parser.parse_args()
    rates, b, c = system(asked.counts)
    times = np.concatenate([[0.0], np.geomspace(1e-7, 100 / rates.min(), 400)])
    exact = steps(rates, b, c, times)
    print(f"{len(rates)} modes, rise {exact.max():.1f} K")
    model = LTIModel.from_matrices(sp.diags(-rates).tocsc(), b[:, None], c)
    begin = time.perf_counter()
    reductor = BTReductor(model)
    first = True
    print("| | order | worst error of step responses [K] | time [s] |\n|---|---|---|---|")
    for order in asked.orders:
        small = reductor.reduce(order)
        spent = time.perf_counter() - begin
        error = np.abs(reduced_steps(small, times) - exact).max()
        words = "with its Gramians" if first else "so far"
        print(f"| pyMOR | {order} | {error:.2g} | {spent:.1f} {words} |", flush=True)
        first = False
    print("\nimpinge\n" + impinge(asked.program, (rates, b, c), asked.orders), end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())
