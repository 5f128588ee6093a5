"""A second drop of tin lands on the first, which has frozen: how hot must it be to melt into it?"""

import shutil
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import sections  # noqa: E402
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "remelting"
STEP, SECOND, AFTER = 1e-3, 25e-3, 25e-3  # s
SECONDS = [250.0, 330.0, 430.0]  # °C, of the second drop
SHOWN = [4e-3, 6e-3, 10e-3, 20e-3]  # s after the second drop is let go
VIEW = sections.View(4.4, 4.0, 0.9, {"cmap": "inferno", "vmin": 20.0, "vmax": 430.0})
TIN = {"liquid": (6967.0, 28.5, 249.4), "solid": (6967.0, 59.5, 259.0)}  # kg/m³, W/(m K), J/(kg K)
MELTS = 232.0  # °C


def effusivity(state: str) -> float:
    density, conductivity, heat = TIN[state]
    return np.sqrt(density * conductivity * heat)


def least_to_melt(splat: float) -> float:
    """Temperature of liquid tin whose contact with solid tin is at the melting point [°C].

    Two half spaces in contact, without latent heat: the mean weighted by effusivities.
    """
    return MELTS + effusivity("solid") / effusivity("liquid") * (MELTS - splat)


def simulate(fmu: Path, folder: Path, second: float, after: float) -> dict[str, np.ndarray]:
    """Runs both drops, the second of a temperature [°C]; readings over time."""
    shutil.rmtree(folder, ignore_errors=True)
    names = ["drop.frozen_mass", "drop.mean_temperature", "centre.temperature"]
    rows = []
    with Unit(fmu, parameters={"output.directory": str(folder)}) as unit:
        unit["drop.release"] = 1
        for step in range(1, round((SECOND + after) / STEP) + 1):
            unit.step_to(step * STEP)
            rows.append([unit.time, *unit.get(names)])
            if step == round(SECOND / STEP):
                unit["drop.release"] = 2
                unit["drop.temperature"] = second + shared.ZERO_CELSIUS
        balance = abs(unit["drop.heat_drift"] / unit["drop.heat"])
        assert unit["drop.released"] == 2, "the second drop waits"
    assert balance < 1e-6, balance
    moments, frozen, mean, centre = np.array(rows).T
    return {"time": moments, "frozen": frozen, "mean": mean, "centre": centre}


def remelted(run: dict[str, np.ndarray]) -> float:
    """Largest part of what was frozen so far that is liquid again, once the second drop falls."""
    most = np.maximum.accumulate(run["frozen"])
    falls = run["time"] > SECOND
    return (1.0 - run["frozen"][falls] / most[falls]).max()


def draw_sections(runs: dict, folder: Path, out: Path) -> Path:
    figure, axes = shared.new_figure(2, len(SHOWN), height=5.6, sharex=True, sharey=True)
    chosen = [SECONDS[0], SECONDS[-1]]
    for row, second in zip(axes, chosen, strict=True):
        moments = [SECOND + moment for moment in SHOWN]
        files = sections.series(folder / f"{second:.0f}", ["drop", "plate"], moments)
        for panel, moment, (drop, below) in zip(row, SHOWN, files, strict=True):
            image = sections.draw(panel, VIEW, drop, below)
            panel.set_title(f"{moment * 1e3:.0f} ms", color=sections.PALE)
        row[0].set_ylabel(f"second drop of {second:.0f} °C\nz / mm", color=sections.PALE)
    for panel in axes[-1]:
        panel.set_xlabel("x / mm", color=sections.PALE)
    sections.add_bar(figure, axes, image, "temperature / °C")
    figure.suptitle(
        "A drop of tin on a splat of tin, which froze on steel; hatched: frozen",
        color=sections.PALE,
    )
    return shared.save(figure, out, NAME, smooth=True)


def draw_curves(runs: dict, out: Path) -> Path:
    figure, axes = shared.new_figure(1, 2, height=4.2)
    for (second, run), colour in zip(runs.items(), shared.COLOURS, strict=False):
        moments, label = run["time"] * 1e3, f"{second:.0f} °C"
        axes[0].plot(moments, run["frozen"] * 1e6, color=colour, label=label)
        axes[1].plot(moments, run["centre"] - shared.ZERO_CELSIUS, color=colour, label=label)
    axes[0].legend(title="second drop")
    axes[0].set(xlabel="t / ms", ylabel="mg", title="what is frozen")
    axes[1].set(xlabel="t / ms", ylabel="°C", title="centre of the plate")
    return shared.save(figure, out, f"{NAME}_over_time")


def report(runs: dict):
    rows = []
    for second, run in runs.items():
        last = f"{run['frozen'][-1] * 1e6:.0f} mg"
        rows.append([f"{second:.0f} °C", f"{100 * remelted(run):.1f} %", last])
    shared.print_table(["second drop", "melted again at most", "frozen at the end"], rows)


def check(runs: dict):
    """The hotter the second drop, the more melts; far below the limit nothing does."""
    parts = [remelted(run) for run in runs.values()]
    assert np.all(np.diff(parts) >= 0), parts
    assert parts[0] < 0.01, parts
    assert parts[-1] > 0.01, parts


def main(given: list[str] | None = None) -> dict:
    span = {"type": float, "default": AFTER, "help": "time after the second drop [s]"}
    options = shared.arguments(NAME, __doc__, given, after=span)
    started = time.perf_counter()
    folder = options.out / "fields"
    runs = {
        second: simulate(options.fmu, folder / f"{second:.0f}", second, options.after)
        for second in SECONDS
    }
    print(f"three runs took {time.perf_counter() - started:.1f} s")
    report(runs)
    check(runs)
    draw_sections(runs, folder, options.out)
    draw_curves(runs, options.out)
    return runs


if __name__ == "__main__":
    main()
