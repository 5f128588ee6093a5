"""Draws what the studies in flows.rs kept: python flows.py TABLES FOLDER."""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[2] / "benches"))
from pictures import save  # noqa: E402

DECAY = 0.16 * np.pi**2  # Rate of the kinetic energy [1/s].


def plates(axes, table):
    """Velocities between the plates, support of four distances, twenty rows."""
    run = table[(table["support"] == 4) & (table["rows"] == 20)]
    for time, colour in [(0.1, "C0"), (1.2, "C3")]:
        now = np.sort(run[run["time"] == time], order="z")
        axes.plot(now["velocity"], now["z"], ".", color=colour, label=f"t = {time} H²/ν")
        axes.plot(now["exact"], now["z"], color="0.3", lw=1)
    axes.set(
        xlabel="velocity [m/s]",
        ylabel="z [m]",
        title="Flow between plates, Δx = H/20\n(points; lines: closed form)",
    )


def plate_errors(axes, table):
    """How far each velocity is from the closed form."""
    for support, style in [(4, "-"), (3, ":")]:
        for rows, colour in [(10, "C2"), (20, "C0"), (40, "C3")]:
            run = table[(table["support"] == support) & (table["rows"] == rows)]
            now = run[run["time"] == 1.2]
            layer = np.minimum((now["z"] * rows).astype(int), rows - 1)
            miss = (now["velocity"] - now["exact"]) / now["exact"].max()
            mean = [100 * miss[layer == k].mean() for k in range(rows)]
            middle = (np.arange(rows) + 0.5) / rows
            label = f"H = {support}Δx, {rows} rows"
            axes.plot(mean, middle, style, color=colour, label=label)
    axes.set(
        xlabel="error over the largest velocity [%]",
        ylabel="z [m]",
        title="Steady velocities of layers",
        xlim=(0, 5),
    )


def vortices(axes, table):
    """Decay of the kinetic energy."""
    time = np.linspace(0, 1, 50)
    axes.semilogy(time, np.exp(-DECAY * time), color="0.3", label="closed form")
    kinds = [(4, "C0", "o", "tilted lattice"), (0, "C3", "s", "lattice along the axes")]
    for support, colour, mark, name in kinds:
        run = table[table["support"] == support]
        for size, spacing in zip((3, 5, 7), np.unique(run["spacing"]), strict=True):
            now = run[run["spacing"] == spacing]
            style = {"marker": mark, "ms": size, "mfc": "none", "ls": "", "color": colour}
            axes.plot(now["time"], now["energy"], **style, label=f"{name}, 1/{1 / spacing:.0f} m")
    axes.set(
        xlabel="time [s]", ylabel="kinetic energy over that at first", title="Taylor–Green, Re 100"
    )


def column(axes, table):
    """Pressure of layers of the column at rest."""
    for rows, colour in zip(np.unique(table["rows"]), ["C2", "C0", "C3"], strict=True):
        run = table[table["rows"] == rows]
        miss = 100 * run["miss"] / table["exact"].max()
        height = (np.arange(len(run)) + 0.5) / rows
        axes.plot(miss, height, marker=".", color=colour, label=f"Δx = H/{rows:.0f}")
    axes.set(
        xlabel="error over the largest pressure [%]",
        ylabel="height of the layer [m]",
        title="Column at rest, mean pressure\nfrom 10 to 20 √(H/g)",
    )


def fronts(axes, table):
    """Front of the column that collapses."""
    axes.plot(table["time"], table["measured"], "ko", label="Martin & Moyce (1952)")
    for name, columns, colour in [("coarse", 10, "C2"), ("middle", 20, "C0"), ("fine", 40, "C3")]:
        axes.plot(table["time"], table[name], color=colour, label=f"Δx = a/{columns}")
    axes.set(xlabel="t √(2g/a)", ylabel="front x/a", title="Break of a dam, height 2a")


def square(figure, table):
    """The rotating square, without and with shifting."""
    names = ["without shifting", "with shifting"]
    times = np.unique(table["time"])
    axes = figure.subplots(2, len(times), sharex="col", sharey="col")
    for kind, (row, name) in enumerate(zip(axes, names, strict=True)):
        for panel, time in zip(row, times, strict=True):
            now = table[(table["shifting"] == kind) & (table["time"] == time)]
            points = panel.scatter(
                now["x"], now["z"], c=now["pressure"], s=3, cmap="coolwarm", vmin=-100, vmax=100
            )
            panel.set(aspect="equal", title=f"{name}, ωt = {time:.0f}", xlabel="x [m]")
        row[0].set_ylabel("z [m]")
    figure.colorbar(points, ax=axes, label="pressure [Pa]", shrink=0.8)


def collapse(figure, table):
    """The column at some of the times at which its front was measured."""
    times = np.unique(table["time"])[[0, 2, 4, 7]]
    axes = figure.subplots(len(times), 1, sharex=True)
    for panel, time in zip(axes, times, strict=True):
        now = table[table["time"] == time]
        points = panel.scatter(now["x"], now["z"], c=now["speed"], s=1.5, vmin=0, vmax=2)
        panel.set(aspect="equal", xlim=(0, 8), ylim=(0, 2.05), ylabel="z/a")
        panel.text(7.9, 1.9, f"t √(2g/a) = {time:.2f}", ha="right", va="top")
    axes[-1].set_xlabel("x/a")
    figure.colorbar(points, ax=axes, label="speed [m/s]", shrink=0.8)


def main(tables: Path, folder: Path):
    def read(name):
        return np.genfromtxt(tables / f"{name}.csv", delimiter=",", names=True)

    def keep(figure, name):
        save(figure, folder / f"{name}.png")
        print(folder / f"{name}.png")

    folder.mkdir(parents=True, exist_ok=True)
    figure, axes = plt.subplots(2, 3, figsize=(14, 9), layout="constrained")
    flow, energy = read("plates"), read("vortices")
    panels = [(plates, flow), (plate_errors, flow), (vortices, energy)]
    panels += [(column, read("column")), (fronts, read("fronts"))]
    for panel, (draw, table) in zip(axes.flat, panels, strict=False):
        draw(panel, table)
        panel.grid(alpha=0.3)
        panel.legend(fontsize=8)
    axes.flat[-1].axis("off")
    keep(figure, "flows")
    figure = plt.figure(figsize=(13, 8), layout="constrained")
    square(figure, read("square"))
    keep(figure, "flows_square")
    figure = plt.figure(figsize=(9, 9), layout="constrained")
    collapse(figure, read("collapse"))
    keep(figure, "flows_dam")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
