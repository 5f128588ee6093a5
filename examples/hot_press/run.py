"""Acrylic in a hot press: stress relaxes while it is warm, and comes back as it cools."""

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "hot_press"
STOP, STEP = 180.0, 1.0  # s
COLD, HOT = 20.0, 140.0  # °C of the platen
PRESSURE = 1e6  # Pa
COOLED, RELEASED = 90.0, 150.0  # s
SOFTENS = 378.0 - shared.ZERO_CELSIUS  # °C, reference of the shift
OUTPUTS = [
    "top.temperature",
    "bottom.temperature",
    "top.displacement_z",
    "glass_top.displacement_z",
    "bottom.stress_xx",
    "glass_bottom.stress_xx",
    "pad.stored",
    "pad.dissipated",
]


@dataclass
class Result:
    times: np.ndarray  # s
    temperatures: np.ndarray  # °C, top and bottom
    rises: np.ndarray  # m of the top, of the pad and of the glass
    stresses: np.ndarray  # Pa, xx at the bottom of both
    energies: np.ndarray  # J stored and dissipated


def simulate(fmu: Path) -> Result:
    rows = []
    with Unit(fmu) as unit:
        for step in range(round(STOP / STEP)):
            platen = HOT if unit.time < COOLED else COLD
            pressure = PRESSURE if unit.time < RELEASED else 0.0
            for body, load in [("pad", "press"), ("glass", "glass_press")]:
                unit[f"{body}.top.ambient"] = platen + shared.ZERO_CELSIUS
                unit[f"{load}.pressure"] = pressure
            unit.step_to((step + 1) * STEP)
            rows.append([unit.time, *unit.get(OUTPUTS)])
    rows = np.array(rows)
    celsius = rows[:, 1:3] - shared.ZERO_CELSIUS
    return Result(rows[:, 0], celsius, rows[:, 3:5], rows[:, 5:7], rows[:, 7:9])


def report(result: Result):
    rows = []
    for t in [10, 30, 60, 90, 100, 120, 150, 180]:
        step = round(t / STEP) - 1
        values = [*result.temperatures[step]]
        values += [*(result.rises[step] * 1e6), *(result.stresses[step] * 1e-6)]
        values += [*(result.energies[step] * 1e3)]
        rows.append([f"{t:.0f}"] + [f"{value:.2f}" for value in values])
    header = ["t/s", "top/°C", "bottom/°C", "pad/µm", "glass/µm", "xx/MPa", "glass/MPa"]
    shared.print_table([*header, "stored/mJ", "dissipated/mJ"], rows)


def draw(result: Result, folder: Path) -> Path:
    figure, axes = shared.new_figure(2, 2, sharex="col")
    for plot in axes.flat:
        plot.axvspan(0, COOLED, color="#fbe7d6", zorder=0, linewidth=0)
        plot.axvline(RELEASED, color="0.7", linewidth=1)
        plot.set(xlim=(0, STOP))
    draw_temperatures(axes[0, 0], result)
    draw_rises(axes[0, 1], result)
    draw_stresses(axes[1, 0], result)
    draw_energies(axes[1, 1], result)
    for plot in axes[1]:
        plot.set(xlabel="time / s")
    figure.suptitle(
        f"A hot press on acrylic of 2 mm: {PRESSURE * 1e-6:.0f} MPa, a platen of {HOT:.0f} °C for "
        f"{COOLED:.0f} s, then of {COLD:.0f} °C; released after {RELEASED:.0f} s"
    )
    return shared.save(figure, folder, NAME)


def draw_temperatures(plot, result: Result):
    for values, name in zip(result.temperatures.T, ["top", "bottom"], strict=True):
        plot.plot(result.times, values, label=name)
    plot.axhline(SOFTENS, **shared.CLOSED_FORM, label="reference of the shift")
    plot.set(ylabel="temperature / °C")
    plot.set_title("Soft for a minute")
    plot.legend(loc="upper right")


def draw_rises(plot, result: Result):
    pad, glass = result.rises.T * 1e6
    plot.plot(result.times, pad, label="acrylic", color=shared.COLOURS[1])
    plot.plot(result.times, glass, label="if it stayed a glass", color=shared.COLOURS[4])
    plot.set(ylabel="rise of the top / µm")
    plot.set_title(f"Cold again, it stands {pad[-1]:.0f} µm higher")
    plot.legend(loc="upper right")


def draw_stresses(plot, result: Result):
    pad, glass = result.stresses.T * 1e-6
    plot.plot(result.times, pad, label="acrylic", color=shared.COLOURS[1])
    plot.plot(result.times, glass, label="if it stayed a glass", color=shared.COLOURS[4])
    plot.axhline(0, color="0.7", linewidth=1)
    plot.set(ylabel="stress along the base / MPa")
    plot.set_title(f"Stress relaxes when warm, cold it is {pad[-1]:+.1f} MPa")
    plot.legend(loc="lower right")


def draw_energies(plot, result: Result):
    stored, dissipated = result.energies.T * 1e3
    plot.plot(result.times, stored, label="stored, elastic")
    plot.plot(result.times, dissipated, label="dissipated", color=shared.COLOURS[2])
    plot.set(ylabel="energy / mJ", ylim=(0, None))
    plot.set_title("Energy is dissipated while the pad is warm")
    plot.legend(loc="center", bbox_to_anchor=(0.45, 0.5))


def main(given: list[str] | None = None) -> Result:
    options = shared.arguments(NAME, __doc__, given)
    result = simulate(options.fmu)
    report(result)
    draw(result, options.out)
    return result


if __name__ == "__main__":
    main()
