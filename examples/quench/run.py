"""A plate of alumina is quenched from several temperatures: when does it break?"""

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "quench"
STOP, STEP = 0.1, 1e-3  # s
WATER = 293.15  # K
DROPS = [200.0, 300.0, 400.0, 500.0, 600.0, 700.0, 800.0]  # K
SHOWN = 600.0  # K, the drop whose history is drawn
# The plate
DENSITY, HEAT, CONDUCTIVITY = 3980.0, 880.0, 31.0
YOUNG, POISSON, EXPANSION = 340e9, 0.22, 8e-6
COEFFICIENT, HALF, RADIUS = 20e3, 0.5e-3, 10e-3  # W/(m² K), m, m
MODULUS, STRENGTH, VOLUME = 10.0, 300e6, 1e-9
EQUIBIAXIAL = 5.675464  # risk over that of uniaxial tension, averaged over directions


@dataclass
class Result:
    times: np.ndarray  # s
    risks: np.ndarray  # B so far of the whole plate, a row for each drop of temperature
    present: np.ndarray  # B of the moment
    stresses: np.ndarray  # Pa, at the middle of the surface
    intensities: np.ndarray  # Pa √m, of the scratch


def simulate(fmu: Path) -> Result:
    names = ["plate.failure_risk", "plate.present_failure_risk"]
    names += ["surface.stress_xx", "scratch.stress_intensity"]
    runs = []
    for drop in DROPS:
        rows = []
        with Unit(fmu, parameters={"plate.initial_temperature": WATER + drop}) as unit:
            for step in range(round(STOP / STEP)):
                unit.step_to((step + 1) * STEP)
                rows.append([unit.time, *unit.get(names)])
        runs.append(rows)
    runs = np.array(runs)
    # The plate has two halves.
    return Result(runs[0, :, 0], 2 * runs[:, :, 1], 2 * runs[:, :, 2], runs[:, :, 3], runs[:, :, 4])


def closed_form(drop: float, times: np.ndarray) -> np.ndarray:
    """Risk of a wide plate that cools by convection, without its edge."""
    biot = COEFFICIENT * HALF / CONDUCTIVITY
    roots = [
        brentq(lambda x: x * np.sin(x) - biot * np.cos(x), n * np.pi, n * np.pi + np.pi / 2)
        for n in range(40)
    ]
    roots = np.array(roots)
    factors = 2 * np.sin(roots) / (roots + np.sin(roots) * np.cos(roots))
    points, weights = np.polynomial.legendre.leggauss(60)
    depths = 0.5 * (1 + points)
    fourier = CONDUCTIVITY / (DENSITY * HEAT) * times / HALF**2
    decay = factors * np.exp(-np.outer(fourier, roots**2))
    temperature = drop * decay @ np.cos(np.outer(roots, depths))
    mean = drop * decay @ (np.sin(roots) / roots)
    stress = YOUNG * EXPANSION / (1 - POISSON) * (mean[:, None] - temperature)
    largest = np.maximum.accumulate(np.maximum(stress, 0.0), axis=0)
    share = (largest / STRENGTH) ** MODULUS @ weights / 2
    return EQUIBIAXIAL * share * 2 * HALF * np.pi * RADIUS**2 / VOLUME


def report(result: Result):
    rows = []
    for drop, risk, stress, own in zip(
        DROPS, result.risks[:, -1], result.stresses, result.intensities, strict=True
    ):
        expected = closed_form(drop, result.times)[-1]
        rows.append(
            [f"{drop:.0f}", f"{stress.max() * 1e-6:.1f}", f"{risk:.3e}", f"{expected:.3e}"]
            + [f"{-np.expm1(-risk):.2e}", f"{own.max() * 1e-6:.3f}"]
        )
    shared.print_table(["ΔT/K", "σ/MPa", "B", "B of a wide plate", "P", "K/(MPa √m)"], rows)


def draw(result: Result, folder: Path):
    figure, axes = shared.new_figure(1, 3, height=5.0)
    drops = np.linspace(DROPS[0], DROPS[-1], 300)
    place = DROPS.index(SHOWN)
    scale = result.risks[place, -1] / SHOWN**MODULUS
    axes[0].plot(drops, -np.expm1(-scale * drops**MODULUS), color=shared.COLOURS[0])
    axes[0].plot(DROPS, -np.expm1(-result.risks[:, -1]), "o", color=shared.COLOURS[1])
    half = (np.log(2) / scale) ** (1 / MODULUS)
    axes[0].annotate(f"half of the plates: {half:.0f} K", (half, 0.5), (210, 0.6))
    axes[0].plot(half, 0.5, "o", color="0.3")
    axes[0].set(xlabel="temperature above the water / K", ylabel="probability of failure P")
    axes[0].set_title("Who breaks: P = 1 − exp(−c ΔTᵐ)")
    times = result.times * 1e3
    axes[1].plot(times, result.risks[place], label="largest stress so far")
    axes[1].plot(times, result.present[place], label="present stress")
    axes[1].plot(times, closed_form(SHOWN, result.times), label="wide plate", **shared.CLOSED_FORM)
    axes[1].set(xlabel="time / ms", ylabel="risk B", xlim=(0, 60))
    axes[1].set_title(f"When: risk of ΔT = {SHOWN:.0f} K")
    axes[1].legend()
    stress, own = result.stresses[place] * 1e-6, result.intensities[place] * 1e-6
    axes[2].plot(times, own)
    axes[2].axhline(3.8, color="0.5", lw=1)
    axes[2].text(60, 3.87, "toughness", ha="right", color="0.4")
    axes[2].set(xlabel="time / ms", ylabel="stress intensity / (MPa √m)")
    axes[2].set(xlim=(0, 60), ylim=(0, 4.4))
    axes[2].set_title(f"A scratch of 20 µm, up to {stress.max():.0f} MPa")
    figure.suptitle("A plate of alumina, 1 mm thick, in cold water (20 kW/(m² K))")
    shared.save(figure, folder, NAME)


def check(result: Result):
    """B follows the m-th power of the drop of temperature, and a wide plate away from the rim."""
    scaled = result.risks[:, -1] / np.array(DROPS) ** MODULUS
    assert np.ptp(scaled) < 1e-6 * scaled.mean(), scaled
    assert np.all(np.diff(result.risks) >= 0), "the risk falls"
    expected = closed_form(SHOWN, result.times)[-1]
    found = result.risks[DROPS.index(SHOWN), -1]
    assert abs(found / expected - 1) < 0.15, (found, expected)


def main(given: list[str] | None = None):
    options = shared.arguments(NAME, __doc__, given)
    result = simulate(options.fmu)
    report(result)
    check(result)
    draw(result, options.out)


if __name__ == "__main__":
    main()
