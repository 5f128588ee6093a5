"""Draw the swinging drops of `tension.rs`: `tension.py FOLDER_OF_TABLES FOLDER_OF_PICTURES`."""

import csv
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[2] / "benches"))
from pictures import save  # noqa: E402

LABELS = {"lattice": "from a lattice", "noise": "from blue noise"}


def table(path):
    """The columns of a table by their names."""
    with path.open() as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def smooth(values):
    """Running means of ten values."""
    return np.convolve(np.pad(values, (5, 4), mode="edge"), np.ones(10) / 10, mode="valid")


def main(tables, pictures):
    figure, both = plt.subplots(
        2, 2, figsize=(11, 7), sharex=True, sharey="row", layout="constrained"
    )
    axes = both[0]
    for axis, below, (kind, label) in zip(axes, both[1], LABELS.items(), strict=True):
        for across in (20, 28, 40):
            run = table(tables / f"swing_{kind}_{across}.csv")
            axis.plot(run["t_over_T"], run["elongation"], label=f"D/Δx = {across}")
            below.plot(run["t_over_T"][1:], smooth(run["core_pressure"][1:]))
        below.axhline(1.0, color="k", linestyle=":")
        below.set_ylim(0.8, 1.2)
        below.set_xlabel("time over Rayleigh's period")
        time = run["t_over_T"]
        free = run["elongation"][0] * np.cos(2 * np.pi * time)
        axis.plot(time, free, "k:", label="Rayleigh, no damping")
        axis.set_title(f"Particles {label}")
        axis.axhline(0.0, color="0.8", zorder=0)
    axes[0].set_ylabel("⟨z² − (x² + y²)/2⟩ / R²")
    both[1][0].set_ylabel("core pressure over 2σ/R,\nmean of a tenth of a period")
    figure.legend(*axes[1].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    pictures.mkdir(parents=True, exist_ok=True)
    save(figure, pictures / "tension.png")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
