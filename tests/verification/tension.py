"""Draw the swinging drops of `tension.rs`: `tension.py FOLDER_OF_TABLES FOLDER_OF_PICTURES`."""

import csv
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

LABELS = {"lattice": "from a lattice", "noise": "from blue noise"}


def table(path):
    """The columns of a table by their names."""
    with path.open() as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def main(tables, pictures):
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.4), sharey=True, layout="constrained")
    for axis, (kind, label) in zip(axes, LABELS.items(), strict=True):
        for across in (20, 28, 40):
            run = table(tables / f"swing_{kind}_{across}.csv")
            axis.plot(run["t_over_T"], run["elongation"], label=f"D/Δx = {across}")
        time = run["t_over_T"]
        free = run["elongation"][0] * np.cos(2 * np.pi * time)
        axis.plot(time, free, "k:", label="Rayleigh, no damping")
        axis.set_title(f"Particles {label}")
        axis.set_xlabel("time over Rayleigh's period")
        axis.axhline(0.0, color="0.8", zorder=0)
    axes[0].set_ylabel("⟨z² − (x² + y²)/2⟩ / R²")
    figure.legend(*axes[1].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    figure.savefig(pictures / "tension.png", dpi=100)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
