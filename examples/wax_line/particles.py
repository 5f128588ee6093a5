"""A strand of thick wax by particles, which freezes on cold aluminium as it is laid."""

import shutil
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import paraview  # noqa: E402
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "wax_particles"
SCENE = Path(__file__).parent / "particles.toml"
STEP, END, LAID = 0.05, 1.6, 0.8  # s, step, end of the run and of the path
SPACING, HEIGHT, MIDDLE = 0.25e-3, 0.8e-3, 1.5e-3  # m, of particles, the outlet and half a section
READ = ["solid_fraction", "width", "height", "heat", "heat_lost", "heat_drift"]


def lay(folder: Path) -> list[dict[str, float]]:
    """Readings after each step, with ParaView files in a folder."""
    shutil.rmtree(folder, ignore_errors=True)
    rows = []
    with Unit(SCENE, parameters={"output.directory": str(folder)}) as unit:
        for step in range(round(END / STEP)):
            unit.step(STEP)
            row = {key: unit[f"ink.{key}"] for key in READ}
            rows.append({"time": (step + 1) * STEP, **row})
    return rows


def draw(rows: list[dict[str, float]], folder: Path, out: Path) -> Path:
    """Draws the strand when it is laid, its section at the end, and its frozen part."""
    files = list(paraview.files(folder, "ink").values())
    figure, axes = shared.new_figure(1, 3, height=3.4, gridspec_kw={"width_ratios": [2.2, 1, 1.2]})
    shown = [(files[round(LAID / STEP)], 0, f"laid, {LAID} s"), (files[-1], 1, f"section, {END} s")]
    for panel, (file, axis, title) in zip(axes, shown, strict=False):
        arrays = paraview.read(file)
        place = 1e3 * arrays["position"]
        kept = np.abs(place[:, 0]) < 1e3 * MIDDLE if axis else place[:, 1] < 1e3 * SPACING
        place, frozen = place[kept], arrays["solid_fraction"][kept]
        points = panel.scatter(
            place[:, axis], place[:, 2], c=frozen, cmap="coolwarm_r", s=45, vmin=0, vmax=1
        )
        panel.axhline(0.0, color=shared.COLOURS[4], linewidth=1.0)
        panel.set(aspect="equal", title=title, xlabel=f"{'xy'[axis]} / mm", ylabel="z / mm")
    figure.colorbar(points, ax=axes[1], label="frozen part")
    times = [row["time"] for row in rows]
    axes[2].plot(times, [row["solid_fraction"] for row in rows], color=shared.COLOURS[0])
    axes[2].axvline(LAID, **shared.CLOSED_FORM)
    axes[2].set(xlabel="time / s", ylabel="frozen part of the strand", ylim=(0.0, 1.0))
    return shared.save(figure, out, NAME)


def main() -> dict[str, float]:
    out = shared.ROOT / "out/wax_line"
    out.mkdir(parents=True, exist_ok=True)
    rows = lay(out / "particles")
    last = rows[-1]
    table = [
        ["frozen part", f"{last['solid_fraction']:.2f}"],
        ["width and height", f"{1e3 * last['width']:.2f} mm, {1e3 * last['height']:.2f} mm"],
        ["heat to the plate", f"{1e3 * last['heat']:.0f} mJ"],
        ["heat to the air", f"{1e3 * last['heat_lost']:.0f} mJ"],
        ["lost in the balance", f"{abs(last['heat_drift'] / last['heat']):.0e} of the heat"],
    ]
    shared.print_table(["at the end", ""], table)
    draw(rows, out / "particles", out)
    return last


if __name__ == "__main__":
    main()
