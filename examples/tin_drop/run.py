"""A drop of molten tin on stainless steel: it freezes on a cold plate, and comes off a hot one."""

import shutil
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import sections  # noqa: E402
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "tin_drop"
STOP, STEP = 25e-3, 5e-4  # s
PLATES = {"cold": 25.0, "hot": 240.0}  # °C
SHOWN = [2e-3, 5e-3, 10e-3, 25e-3]  # s
VIEW = sections.View(4.4, 4.0, 0.9, {"cmap": "inferno", "vmin": 20.0, "vmax": 250.0})
READ = {
    "spread": "drop.spread_diameter",
    "height": "drop.height",
    "frozen": "drop.solid_fraction",
    "arrest": "drop.arrest_time",
    "heat": "drop.heat",
    "centre": "centre.temperature",
    "stress": "centre.stress_xx",
}


def simulate(fmu: Path, folder: Path, plate: float) -> dict[str, np.ndarray]:
    """Runs the unit on a plate [°C], with ParaView files in a folder; readings over time."""
    shutil.rmtree(folder, ignore_errors=True)
    kelvin = plate + shared.ZERO_CELSIUS
    parameters = {"output.directory": str(folder), "plate.initial_temperature": kelvin}
    readings = {key: [] for key in ["time", *READ]}
    with Unit(fmu, parameters=parameters) as unit:
        for step in range(1, round(STOP / STEP) + 1):
            unit.step_to(step * STEP)
            readings["time"].append(step * STEP)
            for key, name in READ.items():
                readings[key].append(unit[name])
        balance = unit["drop.heat_drift"] / unit["drop.heat"]
    print(f"plate of {plate:.0f} °C: heat is balanced to {abs(balance):.0e}")
    return {key: np.array(values) for key, values in readings.items()}


def draw_sections(axes, folder: Path, plate: float):
    files = sections.series(folder, ["drop", "plate"], SHOWN)
    for panel, moment, (drop, below) in zip(axes, SHOWN, files, strict=True):
        image = sections.draw(panel, VIEW, drop, below)
        panel.set_title(f"{moment * 1e3:.0f} ms", color=sections.PALE)
    axes[0].set_ylabel(f"plate of {plate:.0f} °C\nz / mm", color=sections.PALE)
    return image


def draw(runs: dict, folder: Path, out: Path) -> list[Path]:
    figure, axes = shared.new_figure(2, len(SHOWN), height=5.6, sharex=True, sharey=True)
    for row, (name, plate) in zip(axes, PLATES.items(), strict=True):
        image = draw_sections(row, folder / name, plate)
    for panel in axes[-1]:
        panel.set_xlabel("x / mm", color=sections.PALE)
    sections.add_bar(figure, axes, image, "temperature / °C")
    figure.suptitle(
        "Tin of 250 °C (2.7 mm, 1 m/s) on stainless steel; hatched: frozen", color=sections.PALE
    )
    pictures = [shared.save(figure, out, NAME, smooth=True)]
    figure, axes = shared.new_figure(1, 4, height=3.6)
    for (name, plate), colour in zip(PLATES.items(), shared.COLOURS[:2], strict=True):
        run, label = runs[name], f"plate of {plate:.0f} °C"
        moments = run["time"] * 1e3
        axes[0].plot(moments, run["spread"] * 1e3, color=colour, label=label)
        axes[1].plot(moments, run["frozen"] * 100, color=colour)
        axes[2].plot(moments, run["centre"] - shared.ZERO_CELSIUS, color=colour)
        axes[3].plot(moments, run["stress"] * 1e-6, color=colour)
    axes[0].legend()
    titles = ["spread / mm", "frozen / %", "centre of the plate / °C", "its radial stress / MPa"]
    for panel, title in zip(axes, titles, strict=True):
        panel.set(title=title, xlabel="t / ms")
    return [*pictures, shared.save(figure, out, f"{NAME}_over_time")]


def main(given: list[str] | None = None) -> dict:
    options = shared.arguments(NAME, __doc__, given)
    started = time.perf_counter()
    folder = options.out / "fields"
    runs = {name: simulate(options.fmu, folder / name, plate) for name, plate in PLATES.items()}
    print(f"both runs took {time.perf_counter() - started:.1f} s")
    shared.print_table(
        ["plate", "largest spread", "frozen", "layer on the plate frozen", "heat", "hottest"],
        [
            [
                f"{PLATES[name]:.0f} °C",
                f"{run['spread'].max() * 1e3:.2f} mm",
                f"{run['frozen'][-1] * 100:.0f} %",
                f"{run['arrest'][-1] * 1e3:.1f} ms" if run["arrest"][-1] > 0 else "never",
                f"{run['heat'][-1]:.2f} J",
                f"{run['centre'].max() - shared.ZERO_CELSIUS:.0f} °C",
            ]
            for name, run in runs.items()
        ],
    )
    draw(runs, folder, options.out)
    return runs


if __name__ == "__main__":
    main()
