"""Draws what the studies of particles in particles.rs kept: python particles.py TABLES PICTURE."""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[2] / "benches"))
from pictures import save  # noqa: E402

MARKS = {"corrected": ("C0", "o"), "plain": ("C3", "s"), "finite elements": ("0.4", "^")}


def laplacian(axes, table):
    """Park Fig. 2.4."""
    for name, (colour, mark) in list(MARKS.items())[:2]:
        axes.plot(table["x"], table[name], color=colour, marker=mark, label=name)
    axes.set(xlabel="x", ylabel="Laplacian of (x² + y²)/2", title="11 × 11 points, y = 0.5")


def rod(axes, table):
    """Park Fig. 2.7: the error rather than the profiles, which no eye tells apart."""
    for particles in np.unique(table["particles"]):
        run = table[table["particles"] == particles]
        for name, (colour, _) in list(MARKS.items())[:2]:
            error = np.abs(run[name] - run["exact"])[1:-1]
            line = {80: "-", 160: "--", 320: ":"}[int(particles)]
            axes.semilogy(
                run["x"][1:-1], error, line, color=colour, label=f"{name}, {particles:.0f}"
            )
    axes.set(xlabel="x", ylabel="error", title="rod with a sudden end temperature, t = 0.03")
    axes.set_ylim(1e-8, 1e-2)


def cost(axes, table):
    """Accuracy against cost on the box under a disc flux."""
    for name, kind in [("corrected", 1), ("finite elements", 0)]:
        run = table[(table["box"] == 1) & (table["sph"] == kind)]
        colour, mark = MARKS[name]
        axes.loglog(run["build"] + run["steps"], run["norm"], color=colour, marker=mark, label=name)
        for seconds, error, spacing in zip(
            run["build"] + run["steps"], run["norm"], run["spacing"], strict=True
        ):
            axes.annotate(f" {spacing * 1e6:.0f} µm", (seconds, error))
    axes.set(
        xlabel="seconds to build and for ten steps",
        ylabel="relative error down the axis",
        title="disc flux on a box, same graded mesh",
    )


def drift(axes, table):
    """Balance and temperature against resolution."""
    names = ["corrected, graded", "corrected, equal", "plain, equal"]
    for index, (name, colour) in enumerate(zip(names, ["C2", "C0", "C3"], strict=True)):
        run = table[table["run"] == index]
        spacing = run["spacing"] * 1e6
        lost = np.maximum(np.abs(run["drift"]), 1e-16)
        axes.loglog(spacing, lost, color=colour, marker="o", label=f"{name}: drift")
        axes.loglog(
            spacing,
            np.abs(run["surface"]),
            "--",
            color=colour,
            marker="s",
            label=f"{name}: surface",
        )
    axes.set(
        xlabel="distance of particles at the load [µm]",
        ylabel="relative error",
        title="heat balance and surface temperature",
    )


def main(tables: Path, picture: Path):
    figure, axes = plt.subplots(2, 2, figsize=(11, 8.5), layout="constrained")
    panels = [("laplacian", laplacian), ("rod", rod), ("plate", cost), ("drift", drift)]
    for panel, (name, draw) in zip(axes.flat, panels, strict=True):
        draw(panel, np.genfromtxt(tables / f"{name}.csv", delimiter=",", names=True))
        panel.grid(alpha=0.3)
        panel.legend(fontsize=8)
    picture.parent.mkdir(parents=True, exist_ok=True)
    save(figure, picture)
    print(picture)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
