"""A ball of mortar spreads on a plate: which yield stress explains the height at which it rests?"""

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import shared  # noqa: E402
from impinge import Study  # noqa: E402
from impinge.study import Paired  # noqa: E402

NAME = "mini_slump"
MEASURED, UNSURE = 9.0e-3, 0.3e-3  # m: the height of the heap, and how well a ruler tells it
LEVELS = [15.0, 30.0, 60.0, 120.0, 240.0]  # Pa
DIAMETER, DENSITY, GRAVITY = 18e-3, 2000.0, 9.81
VOLUME = np.pi / 6 * DIAMETER**3  # m³
STRESS, HEIGHT, WIDTH = "paste.yield_stress", "paste.height", "paste.spread_diameter"


@dataclass
class Result:
    levels: np.ndarray  # Pa
    heights: np.ndarray  # m at rest
    widths: np.ndarray  # m
    found: float  # Pa
    within: tuple[float, float]  # Pa, by the ruler
    check: float  # m: height at rest with the yield stress that was found


def rests(fmu: Path, levels) -> tuple[np.ndarray, np.ndarray]:
    """Height and width at rest for several yield stresses; runs share the cores."""
    study = Study(fmu, {STRESS: list(levels)}, outputs=[HEIGHT, WIDTH], sampler=Paired())
    table = study.run()
    return table[HEIGHT].values, table[WIDTH].values


def explains(levels: np.ndarray, heights: np.ndarray, height: float) -> float:
    """Yield stress of a height, linear between logarithms [Pa]."""
    return float(np.exp(np.interp(np.log(height), np.log(heights), np.log(levels))))


def thin(height: np.ndarray) -> np.ndarray:
    """Yield stress of a thin heap whose base holds it, after Roussel & Coussot (2005) [Pa].

    τ = ρ g h²/(2 R) in the middle, with the volume 8π/15 h R² of that profile
    (doi 10.1122/1.1879041).
    """
    radius = np.sqrt(15 * VOLUME / (8 * np.pi * height))
    return DENSITY * GRAVITY * height**2 / (2 * radius)


def simulate(fmu: Path) -> Result:
    levels = np.array(LEVELS)
    heights, widths = rests(fmu, levels)
    found = explains(levels, heights, MEASURED)
    within = tuple(explains(levels, heights, MEASURED + by) for by in (-UNSURE, UNSURE))
    check, _ = rests(fmu, [found])
    return Result(levels, heights, widths, found, within, float(check[0]))


def report(result: Result):
    rows = [
        [f"{level:.0f}", f"{height * 1e3:.2f}", f"{width * 1e3:.1f}", f"{by_hand:.0f}"]
        for level, height, width, by_hand in zip(
            result.levels, result.heights, result.widths, thin(result.heights), strict=True
        )
    ]
    shared.print_table(["yield/Pa", "height/mm", "width/mm", "thin heap/Pa"], rows)
    low, high = result.within
    print(
        f"A heap {MEASURED * 1e3:.1f} ± {UNSURE * 1e3:.1f} mm high has a yield stress of ", end=""
    )
    print(f"{result.found:.0f} Pa ({low:.0f} to {high:.0f}); ", end="")
    print(f"with it the unit rests at {result.check * 1e3:.2f} mm.")


def draw(result: Result, folder: Path) -> Path:
    figure, plot = shared.new_figure(1, 1, height=5.5)
    low, high = result.within
    plot.axvspan(low, high, color="#fbe7d6", linewidth=0, zorder=0)
    plot.axhspan(
        (MEASURED - UNSURE) * 1e3, (MEASURED + UNSURE) * 1e3, color="#dfe5f2", linewidth=0, zorder=0
    )
    plot.plot(result.levels, result.heights * 1e3, "o-", label="unit", color=shared.COLOURS[0])
    heights = np.geomspace(0.6 * result.heights.min(), 1.1 * result.heights.max(), 100)
    plot.plot(thin(heights), heights * 1e3, **shared.CLOSED_FORM, label="thin heap, by hand")
    plot.plot(
        result.found,
        result.check * 1e3,
        "D",
        color=shared.COLOURS[1],
        ms=9,
        zorder=6,
        label=f"run with {result.found:.0f} Pa",
    )
    plot.annotate(
        "as measured",
        (result.levels[-1], MEASURED * 1e3),
        (-4, 4),
        textcoords="offset points",
        ha="right",
        color=shared.COLOURS[0],
    )
    plot.set(
        xlabel="yield stress / Pa",
        ylabel="height at rest / mm",
        xscale="log",
        xlim=(0.8 * result.levels[0], 1.25 * result.levels[-1]),
    )
    plot.set_title("A ball of mortar, 18 mm across, spreads until its yield stress holds it")
    plot.legend(loc="upper left")
    return shared.save(figure, folder, NAME)


def main(given: list[str] | None = None) -> Result:
    options = shared.arguments(NAME, __doc__, given)
    result = simulate(options.fmu)
    report(result)
    draw(result, options.out)
    return result


if __name__ == "__main__":
    main()
