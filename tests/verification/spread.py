"""Draws what the study in spread.rs kept: python spread.py TABLES FOLDER."""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import NullFormatter

sys.path.append(str(Path(__file__).resolve().parents[2] / "benches"))
from pictures import save  # noqa: E402

REYNOLDS = 500.0
COARSE, FINE = 24, 48  # Particles over the diameter.
NAMES = {
    "clanet": "Clanet et al. 2004",
    "pasandideh_fard": "Pasandideh-Fard et al. 1996, 90°",
    "roisman": "Roisman 2009",
    "laan": "Laan et al. 2014",
}


def correlations(weber):
    """D_max/D; sources in spread.rs."""
    root = np.sqrt(weber * REYNOLDS**-0.4)
    return {
        "clanet": weber**0.25,
        "pasandideh_fard": np.sqrt((weber + 12) / (3 + 4 * weber / np.sqrt(REYNOLDS))),
        "roisman": 0.87 * REYNOLDS**0.2 - 0.4 * REYNOLDS**0.4 / np.sqrt(weber),
        "laan": REYNOLDS**0.2 * root / (1.24 + root),
    }


def wildeman(weber):
    """D_max/D; source in spread.rs."""
    beta = np.linspace(1.0, 6.0, 5001)[:, None]
    energy = beta**2 * (3 / weber + 0.7 * np.sqrt((beta - 1) / REYNOLDS))
    return beta[np.argmin(np.abs(energy - 12 / weber - 0.5), axis=0), 0]


def largest(axes, table):
    """Largest spread over the Weber number."""
    weber = np.geomspace(8, 500, 100)
    curves = correlations(weber)
    low, high = (of(list(curves.values()), axis=0) for of in (np.min, np.max))
    axes.fill_between(weber, low, high, color="0.92", label="between all four")
    for (name, values), style in zip(curves.items(), ["-", "--", "-.", ":"], strict=True):
        axes.plot(weber, values, style, color="0.35", lw=1.5, label=NAMES[name])
    axes.plot(
        weber[weber >= 30], wildeman(weber[weber >= 30]), "C4", label="Wildeman et al. 2016, 90°"
    )
    marks = {
        16: ("C2", "v"),
        COARSE: ("C0", "o"),
        36: ("C5", "<"),
        FINE: ("C3", "s"),
        64: ("C1", "^"),
    }
    for resolution, (colour, mark) in marks.items():
        run = table[table["resolution"] == resolution]
        label = f"computed, D/Δx = {resolution}"
        size = 9 if resolution == COARSE else 6
        axes.plot(run["weber"], run["spread"], mark, color=colour, ms=size, label=label)
    axes.set(
        xscale="log",
        xlabel="We",
        ylabel="D_max/D",
        ylim=(1, 5),
        title="Largest spread, Re 500, contact angle 90°",
    )
    ticks = [10, 30, 100, 200, 400]
    axes.set_xticks(ticks, [str(tick) for tick in ticks])
    axes.minorticks_off()


def histories(axes, table):
    """Spread over time."""
    for index, weber in enumerate(np.unique(table["weber"])):
        for resolution, style in [(COARSE, "-"), (FINE, "--")]:
            run = table[(table["weber"] == weber) & (table["resolution"] == resolution)]
            label = f"We {weber:.0f}, D/Δx = {resolution}"
            if len(run):
                axes.plot(run["time"], run["spread"], style, color=f"C{index}", label=label)
    axes.set(xlabel="t U/D", ylabel="spread/D", title="Diameter of the film", ylim=(0, None))


def shapes(panels, table):
    """Side views of the drops when they are widest."""
    for panel, weber in zip(panels, np.unique(table["weber"]), strict=True):
        run = table[(table["weber"] == weber) & (table["resolution"] == FINE)]
        colours = {"c": run["speed"], "vmin": 0, "vmax": 0.5, "cmap": "viridis", "s": 3}
        panel.scatter(run["radius"], run["height"], **colours)
        points = panel.scatter(-run["radius"], run["height"], **colours)
        panel.set(aspect="equal", xlim=(-2.4, 2.4), ylim=(0, 0.5), ylabel="z/D")
        panel.text(-2.3, 0.36, f"We {weber:.0f}")
        panel.set_xlabel("distance to the axis over D")
    return points


def costs(axes, table):
    """Error of the largest spread over the time that it took to compute."""
    for weber, colour in [(30, "C1"), (100, "C2")]:
        runs = np.sort(table[table["weber"] == weber], order="resolution")
        error = 100 * np.abs(runs["spread"] / runs["spread"][-1] - 1)[:-1]
        axes.loglog(runs["seconds"][:-1], error, "o-", color=colour, label=f"We {weber}")
        for run, percent in zip(runs, error, strict=False):
            place = {"xytext": (4, 4), "textcoords": "offset points", "fontsize": 7}
            axes.annotate(f"{run['resolution']:.0f}", (run["seconds"], percent), **place)
    # Within a decade, all multiples would be labelled, over each other.
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.set(
        xlabel="computed in / s, two threads",
        ylabel="off / %",
        title="Spread against D/Δx = 64, numbers are D/Δx",
    )
    axes.title.set_fontsize(9)
    axes.grid(alpha=0.3)
    axes.legend(fontsize=7)


def main(tables: Path, folder: Path):
    def read(name):
        return np.genfromtxt(tables / f"{name}.csv", delimiter=",", names=True)

    folder.mkdir(parents=True, exist_ok=True)
    figure = plt.figure(figsize=(13, 9.5), layout="constrained")
    upper, lower = figure.subfigures(2, 1, height_ratios=[1.25, 1])
    left, right = upper.subplots(1, 2)
    largest(left, read("spread"))
    histories(right, read("spread_history"))
    for axes in (left, right):
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8)
    rows = lower.subplots(3, 2)
    costs(rows[2, 1], read("spread"))
    points = shapes(rows.flat[:5], read("spread_shape"))
    lower.colorbar(points, ax=rows, label="speed over U")
    lower.suptitle(f"Widest shapes from the side, D/Δx = {FINE}")
    save(figure, folder / "spread.png")
    print(folder / "spread.png")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
