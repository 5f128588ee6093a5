"""Draws a map: outcomes coloured, where they turn bad, where theory and the product see that."""

from math import log10
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from boundary import crossings, is_bad, silent
from matplotlib.collections import LineCollection
from matplotlib.colors import Colormap, LinearSegmentedColormap, LogNorm, Normalize
from matplotlib.lines import Line2D
from pictures import save
from plan import Axis, Map
from table import Known

STYLE = {
    "font.size": 10,
    "axes.titlelocation": "left",
    "axes.titleweight": "bold",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.frameon": False,
}
THEORY = ["#7a1fa2", "#0b6e4f", "#111111"]
GOOD = ["#08306b", "#2f7fb8", "#9fd0e6", "#e9f4f9"]
BAD = ["#fdeeda", "#fdb366", "#e2622b", "#7f1d0a"]
"""Colours up to the outcome from which on a cell is bad, and beyond it: pale where it is near."""
DASHES = [(0, (5, 3)), (0, (1, 2)), (0, (7, 2, 1, 2))]


def edges(axis: Axis) -> np.ndarray:
    """Of the cells around an axis's values."""
    at = np.log(axis.values) if axis.is_logarithmic else np.array(axis.values, float)
    middle = 0.5 * (at[1:] + at[:-1])
    ends = np.concatenate([[at[0] - (middle[0] - at[0])], middle, [at[-1] + (at[-1] - middle[-1])]])
    return np.exp(ends) if axis.is_logarithmic else ends


def coloured(axes, of: Map, known: Known):
    """Outcomes as colours; what was refused is grey."""
    grid = np.full((len(of.y.values), len(of.x.values)), np.nan)
    for row, y in enumerate(of.y.values):
        for column, x in enumerate(of.x.values):
            if cell := known.get((x, y)):
                grid[row, column] = cell.outcome
    seen = np.abs(grid[np.isfinite(grid)])
    seen = seen[seen > 0]
    low, high = of.colours or (seen.min(initial=1e-3), seen.max(initial=1.0))
    wide = low > 0 and high / low > 20
    norm = LogNorm(low, high, clip=True) if wide else Normalize(low, high, clip=True)
    if wide:
        grid = np.where(grid <= 0, low, grid)
    palette = parted(float(np.clip(norm(of.bad), 0.02, 0.98)))
    shown = np.ma.masked_invalid(np.where(np.isposinf(grid), high, grid))
    mesh = axes.pcolormesh(edges(of.x), edges(of.y), shown, cmap=palette, norm=norm)
    return mesh, beyond(grid, low, high)


def parted(at: float) -> Colormap:
    """Blue up to this share of the range and orange beyond it; what was refused is grey."""
    good = [(at * place / (len(GOOD) - 1), colour) for place, colour in enumerate(GOOD)]
    bad = [(at + (1.0 - at) * place / (len(BAD) - 1), c) for place, c in enumerate(BAD)]
    palette = LinearSegmentedColormap.from_list("parted", [*good, *bad], N=512)
    palette.set_bad("0.82")
    return palette


def bar(figure, axes, of: Map, mesh, ends: str) -> None:
    """The scale of colours, with a line where outcomes turn bad."""
    unit = f" [{of.unit}]" if of.unit not in ("", "1") else ""
    made = figure.colorbar(mesh, ax=axes, label=f"{of.outcome}{unit}", shrink=0.9, extend=ends)
    if mesh.norm.vmin < of.bad < mesh.norm.vmax:
        made.ax.axhline(of.bad, color="black", linewidth=1.8)
        made.ax.annotate(
            f"{of.bad:g}",
            (0.0, of.bad),
            (-3, 0),
            xycoords=("axes fraction", "data"),
            textcoords="offset points",
            ha="right",
            va="center",
            fontsize=9,
        )


def beyond(grid: np.ndarray, low: float, high: float) -> str:
    """At which ends of the colours outcomes lie beyond them."""
    below, above = bool(np.nanmin(grid) < low), bool(np.nanmax(grid) > high)
    return {(True, True): "both", (True, False): "min", (False, True): "max"}.get(
        (below, above), "neither"
    )


def marks(axes, of: Map, known: Known) -> list[Line2D]:
    """Dots where the product warns, crosses where it refuses, rings where it fails in silence."""
    groups = [
        (
            "the run warned",
            "o",
            {"color": "black", "markersize": 4, "markeredgecolor": "white"},
            lambda c: c.said == "warned",
        ),
        ("refused", "x", {"color": "0.3", "markersize": 5}, lambda c: c.said == "refused"),
    ]
    handles = []
    for label, marker, style, chosen in groups:
        cells = [c for c in known.values() if not c.is_search and chosen(c)]
        if cells:
            (line,) = axes.plot(
                [c.x for c in cells], [c.y for c in cells], marker, linestyle="none", **style
            )
            line.set_label(label)
            handles.append(line)
    quiet = silent(of, known)
    if quiet and of.must_speak:
        (line,) = axes.plot(
            [c.x for c in quiet],
            [c.y for c in quiet],
            "o",
            color="black",
            fillstyle="none",
            markersize=11,
            label="bad, and nothing said",
        )
        handles.append(line)
    return handles


def lines(axes, of: Map, known: Known) -> list[Line2D]:
    """The measured boundary and those of theory."""
    handles = searched(axes, of, known) if of.refine else outlined(axes, of, known)
    ends = of.x.values[0], of.x.values[-1]
    fine = np.geomspace(*ends, 200) if of.x.is_logarithmic else np.linspace(*ends, 200)
    for place, theory in enumerate(of.theory):
        handles += axes.plot(
            fine,
            [theory.y(float(x)) for x in fine],
            color=THEORY[place % len(THEORY)],
            linestyle=DASHES[place % len(DASHES)],
            linewidth=1.6,
            label=f"{theory.name} ({theory.source})",
        )
    return handles


def searched(axes, of: Map, known: Known) -> list[Line2D]:
    """Where outcomes turn bad, found between the rows."""
    found = crossings(of, known)
    return axes.plot(
        [c.x for c in found],
        [c.middle(of) for c in found],
        color="black",
        linewidth=1.8,
        marker="o",
        markersize=3,
        label=f"measured limit, {of.bad:g}",
    )


def outlined(axes, of: Map, known: Known) -> list[Line2D]:
    """Sides that bad cells share with good ones."""
    columns, rows = edges(of.x), edges(of.y)
    bad = np.array(
        [[(x, y) in known and is_bad(of, known[x, y]) for x in of.x.values] for y in of.y.values]
    )
    sides = [
        [(columns[i + 1], rows[j]), (columns[i + 1], rows[j + 1])]
        for j, i in np.argwhere(bad[:, 1:] != bad[:, :-1])
    ]
    sides += [
        [(columns[i], rows[j + 1]), (columns[i + 1], rows[j + 1])]
        for j, i in np.argwhere(bad[1:] != bad[:-1])
    ]
    if not sides:
        return []
    axes.add_collection(LineCollection(sides, colors="black", linewidths=1.8))
    return [Line2D([], [], color="black", linewidth=1.8, label=f"limit, {of.bad:g}")]


def label(axis: Axis) -> str:
    return axis.name if axis.unit in ("", "1") else f"{axis.name} [{axis.unit}]"


def prepare(axes, of: Map) -> None:
    for axis, scale, limits, ticks in (
        (of.x, axes.set_xscale, axes.set_xlim, axes.set_xticks),
        (of.y, axes.set_yscale, axes.set_ylim, axes.set_yticks),
    ):
        scale("log" if axis.is_logarithmic else "linear")
        limits(edges(axis)[0], edges(axis)[-1])
        if axis.labels:
            ticks(axis.values, axis.labels)
            (axes.minorticks_off)()
        elif not axis.is_logarithmic or log10(axis.values[-1] / axis.values[0]) < 1.2:
            ticks(axis.values, [f"{value:g}" for value in axis.values])
            (axes.minorticks_off)()
    axes.set_xlabel(label(of.x))
    axes.set_ylabel(label(of.y))
    axes.set_title(of.title)


def draw(of: Map, known: Known, folder: Path) -> None:
    plt.rcParams.update(STYLE)
    figure, axes = plt.subplots(figsize=(7.4, 6.0), layout="constrained")
    mesh, ends = coloured(axes, of, known)
    prepare(axes, of)
    handles = lines(axes, of, known) + marks(axes, of, known)
    bar(figure, axes, of, mesh, ends)
    if handles:
        figure.legend(handles=handles, loc="outside lower left", ncols=2, fontsize=8)
    save(figure, folder / f"{of.name}.png")
    plt.close(figure)
