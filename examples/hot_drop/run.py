"""A drop of molten aluminium on a glowing plate: its section over time, as ParaView shows it."""

import shutil
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import sections  # noqa: E402
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "hot_drop"
STOP, STEP = 6e-4, 2e-5  # s
DIAMETER, SPEED = 0.5e-3, 2.0  # m, m/s
HOT, WARM = 1200.0, 1000.0  # K
SHOWN = [1e-4, 2e-4, 4e-4, 6e-4]  # s
VIEW = sections.View(0.6, 0.75, 0.3, {"cmap": "inferno", "vmin": 640.0, "vmax": 930.0})


def simulate(fmu: Path, folder: Path) -> list[float]:
    """Runs the unit, which writes a file of each body for each step; the heat [J] of the drop."""
    shutil.rmtree(folder, ignore_errors=True)
    heat = []
    with Unit(fmu, parameters={"output.directory": str(folder)}) as unit:
        for step in range(1, round(STOP / STEP) + 1):
            unit.step_to(step * STEP)
            heat.append(unit["drop.heat"])
        taken = unit["plate.heat_in"]
    print(f"the drop gave {heat[-1] * 1e3:.3f} mJ, the plate took it to {taken / heat[-1] - 1:.0e}")
    return heat


def draw(folder: Path, out: Path) -> Path:
    figure, axes = shared.new_figure(1, len(SHOWN), height=3.7, sharey=True)
    files = sections.series(folder, ["drop", "plate"], SHOWN)
    for panel, moment, (drop, plate) in zip(axes, SHOWN, files, strict=True):
        image = sections.draw(panel, VIEW, drop, plate)
        panel.set_xlabel("x / mm", color=sections.PALE)
        panel.set_title(f"{moment * 1e3:.1f} ms", color=sections.PALE)
    axes[0].set_ylabel("z / mm", color=sections.PALE)
    sections.add_bar(figure, axes, image, "temperature / °C")
    hot, warm = (value - shared.ZERO_CELSIUS for value in (HOT, WARM))
    figure.suptitle(
        f"Molten aluminium of {hot:.0f} °C ({DIAMETER * 1e3:.1f} mm, {SPEED:.0f} m/s) lands on "
        f"aluminium nitride of {warm:.0f} °C, warms it and comes off",
        color=sections.PALE,
    )
    return shared.save(figure, out, NAME, smooth=True)


def main(given: list[str] | None = None):
    options = shared.arguments(NAME, __doc__, given)
    started = time.perf_counter()
    fields = options.out / "fields"
    heat = simulate(options.fmu, fields)
    print(f"{len(heat)} steps in {time.perf_counter() - started:.1f} s")
    draw(fields, options.out)
    return heat


if __name__ == "__main__":
    main()
