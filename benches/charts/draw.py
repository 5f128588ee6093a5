"""Draws error over time, both logarithmic, with the front of what nothing else beats."""

from dataclasses import replace
from math import isnan
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from chart import Chart, Outcome
from matplotlib.ticker import FuncFormatter, NullFormatter
from pictures import save
from table import error, key

COLOURS = ["#20306b", "#b0303c", "#e08214", "#2a8a7f", "#7b7b7b", "#8e5ea2", "#3b8bc4", "#a0752d"]
COLOURS += ["#d65f9e", "#111111", "#6b8e23", "#c9a400"]
MARKERS = "osD^vPX*<>ph"
SMALLEST = 1e-9
"""Errors are not drawn below: rounding, and the references' own."""


def front(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Of (time, error), those that no other point beats in both."""
    best, kept = float("inf"), []
    for seconds, err in sorted(points):
        if err < best:
            best = err
            kept.append((seconds, err))
    return kept


def curve(chart: Chart, quantity, method, known: dict[tuple[str, str], Outcome]):
    """Time, error, setting and the error asked for, of the points that came to something."""
    found = []
    for point in method.points:
        outcome = known.get((method.name, key(point)))
        if outcome and not outcome.failure and quantity.name in outcome.values:
            err = error(quantity, method, outcome)
            # Its reference may not be measured yet.
            if not isnan(err):
                found.append((outcome.seconds, max(err, SMALLEST), point.setting, point.asked))
    return found


def between(low: float, high: float):
    """Tells 2 and 5 between powers of ten where few of these are on the axis."""
    if high / low > 100.0:
        return NullFormatter()
    return FuncFormatter(lambda x, _: f"{x:g}" if f"{x:e}"[0] in "25" else "")


GAP = 1e3
"""Between times, which an axis leaves out."""


def left_end(times: list[float]) -> float:
    """Time from which on points stand where they are: what is far quicker is drawn there."""
    times = sorted(times)
    return times[1] / 2.0 if len(times) > 1 and times[1] > GAP * times[0] else 0.0


def panel(axes, chart: Chart, quantity, known):
    curves = [curve(chart, quantity, method, known) for method in chart.methods]
    begin = left_end([seconds for found in curves for seconds, *_ in found])
    every = []
    for place, (method, found) in enumerate(zip(chart.methods, curves, strict=True)):
        if not found:
            continue
        found = [beside(begin, *point) for point in found]
        every += [(seconds, err) for seconds, err, *_ in found]
        colour, marker = COLOURS[place % len(COLOURS)], MARKERS[place % len(MARKERS)]
        axes.loglog(
            [f[0] for f in found],
            [f[1] for f in found],
            color=colour,
            marker=marker,
            markersize=5,
            linewidth=1.3,
            label=method.name,
        )
        for seconds, err, setting, _ in (found[0], found[-1])[: len(found)]:
            axes.annotate(
                setting,
                (seconds, err),
                (4, 4),
                textcoords="offset points",
                fontsize=7,
                color=colour,
            )
    if every:
        axes.step(
            *zip(*front(every), strict=True), where="post", color="0.8", linewidth=6, zorder=0
        )
    axes.set_title(quantity.name)
    axes.set_xlabel("time that a host waits: start, steps and readings [s]")
    axes.xaxis.set_minor_formatter(between(*axes.get_xlim()))
    axes.set_ylabel("relative error [1]")
    axes.grid(True, which="major", color="0.92")


def beside(begin: float, seconds: float, err: float, setting: str, asked: float | None) -> tuple:
    """A point, at the left end and with its time if it is quicker than that."""
    if seconds >= begin:
        return seconds, err, setting, asked
    return begin, err, f"{setting} ← {1e6 * seconds:.1g} µs".strip(), asked


def asked_over_found(axes, chart: Chart, known):
    """Where a method can be asked for an error: what it kept of that."""
    drawn = False
    for place, method in enumerate(chart.methods):
        for quantity, fill in zip(
            chart.quantities, ("full", "none", "left", "right"), strict=False
        ):
            found = [f for f in curve(chart, quantity, method, known) if f[3] is not None]
            if found:
                drawn = True
                axes.loglog(
                    [f[3] for f in found],
                    [f[1] for f in found],
                    color=COLOURS[place % len(COLOURS)],
                    marker=MARKERS[place % len(MARKERS)],
                    fillstyle=fill,
                    markersize=5,
                    linewidth=1.0,
                    label=f"{method.name}: {quantity.name}",
                )
    if drawn:
        ends = axes.get_xlim()
        axes.loglog(ends, ends, color="black", linestyle=(0, (4, 3)), linewidth=1.0)
        axes.set_xlim(ends)
    axes.set_title("asked and found")
    axes.set_xlabel("error asked for [1]")
    axes.set_ylabel("error found [1]")
    axes.grid(True, which="major", color="0.92")
    make_room(axes, len(axes.get_legend_handles_labels()[0]))
    axes.legend(fontsize=7, loc="lower right")
    return drawn


def make_room(axes, entries: int):
    """Leaves the lower part of the panel to a legend of so many entries."""
    share = 0.038 * entries + 0.03
    low, high = axes.get_ylim()
    axes.set_ylim(high * (low / high) ** (1.0 / (1.0 - share)), high)


def draw(chart: Chart, known: dict[tuple[str, str], Outcome], folder: Path):
    plt.rcParams.update(
        {
            "font.size": 10,
            "axes.titlelocation": "left",
            "axes.titleweight": "bold",
            "axes.spines.top": False,
            "axes.spines.right": False,
            "legend.frameon": False,
        }
    )
    chart = replace(chart, methods=[m for m in chart.methods if not m.is_reference])
    can_ask = any(p.asked is not None for m in chart.methods for p in m.points)
    drawn = [quantity for quantity in chart.quantities if quantity.has_panel]
    panels, count = len(drawn), len(drawn) + can_ask
    figure, axes = arranged(count)
    for place, quantity in enumerate(drawn):
        panel(axes[place], chart, quantity, known)
    if can_ask:
        asked_over_found(axes[panels], chart, known)
    lines = {line.get_label(): line for place in axes[:panels] for line in place.get_lines()}
    labels = [method.name for method in chart.methods if method.name in lines]
    figure.suptitle(chart.title, x=0.01, ha="left", fontsize=13)
    handles = [lines[label] for label in labels]
    if len(axes) > count:
        axes[-1].axis("off")
        axes[-1].legend(handles, labels, loc="center left", fontsize=10)
    else:
        figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=9)
    save(figure, folder / f"{chart.name}.png")
    plt.close(figure)


def arranged(panels: int):
    """Panels in rows of two, so that they can be read at the width of a page."""
    rows = (panels + 1) // 2
    columns = min(panels, 2)
    size = 5.4 * columns, (5.6 if rows == 1 else 5.0 * rows)
    figure, axes = plt.subplots(rows, columns, figsize=size, layout="constrained", squeeze=False)
    return figure, list(axes.flat)
