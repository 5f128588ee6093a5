"""Draws error over time, both logarithmic, with the front of what nothing else beats."""

from dataclasses import replace
from math import isnan
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from chart import Chart, Outcome
from labels import Labels
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
from pictures import save
from table import error, key

COLOURS = ["#20306b", "#b0303c", "#e08214", "#2a8a7f", "#7b7b7b", "#8e5ea2", "#3b8bc4", "#a0752d"]
COLOURS += ["#d65f9e", "#111111", "#6b8e23", "#c9a400"]
MARKERS = "osD^vPX*<>ph"
FILLS = ("full", "none", "left", "right")
SMALLEST, LARGEST = 1e-9, 1.0
"""Errors are not drawn below, which is rounding and the references' own, nor beyond, where a value
has nothing of the right one: these stand at the upper edge with an arrow."""
FRONT = {"color": "0.85", "linewidth": 6, "zorder": 0}


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


def plain_seconds(axis, low: float, high: float):
    """Seconds as they are read, with 2 and 5 between powers of ten where few of these are there."""
    few = high / low <= 100.0
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if few else (1.0,)))
    axis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))
    axis.set_minor_formatter(NullFormatter())


GAP = 1e3
"""Between times, which an axis leaves out."""


def left_end(times: list[float]) -> float:
    """Time from which on points stand where they are: what is far quicker is drawn there."""
    times = sorted(times)
    return times[1] / 2.0 if len(times) > 1 and times[1] > GAP * times[0] else 0.0


def panel(axes, chart: Chart, quantity, known):
    curves = [curve(chart, quantity, method, known) for method in chart.methods]
    begin = left_end([seconds for found in curves for seconds, *_ in found])
    every, ends = [], []
    for place, (method, found) in enumerate(zip(chart.methods, curves, strict=True)):
        if not found:
            continue
        found = [beside(begin, *point) for point in found]
        every += [(seconds, err) for seconds, err, *_ in found]
        colour, marker = COLOURS[place % len(COLOURS)], MARKERS[place % len(MARKERS)]
        axes.loglog(
            [f[0] for f in found],
            [min(f[1], LARGEST) for f in found],
            color=colour,
            marker=marker,
            markersize=5,
            linewidth=1.3,
            label=method.name,
        )
        ends += [(point, colour) for point in (found[0], found[-1])[: len(found)]]
    if every:
        best = [(seconds, min(err, LARGEST)) for seconds, err in front(every)]
        axes.step(*zip(*best, strict=True), where="post", **FRONT)
        axes.set_ylim(top=min(axes.get_ylim()[1], 1.6 * LARGEST))
    axes.set_title(f"Error of {quantity.shown}")
    axes.set_xlabel("time that a host waits: start, steps and readings [s]")
    plain_seconds(axes.xaxis, *axes.get_xlim())
    axes.set_ylabel("relative error")
    axes.grid(True, which="major", color="0.92")
    return [(*seen(*point), colour) for point, colour in ends]


def seen(seconds: float, err: float, setting: str, _) -> tuple[float, float, str, str]:
    """Place of a point in the picture, its setting, and its error if that is beyond the edge."""
    return seconds, min(err, LARGEST), setting, "" if err <= LARGEST else f"↑ {err:.3g}"


def beside(begin: float, seconds: float, err: float, setting: str, asked: float | None) -> tuple:
    """A point, at the left end and with its time if it is quicker than that."""
    if seconds >= begin:
        return seconds, err, setting, asked
    return begin, err, f"{setting} ← {1e6 * seconds:.1g} µs".strip(), asked


def asked_over_found(axes, chart: Chart, known):
    """Where a method can be asked for an error: what it kept of that."""
    shown = []
    for place, method in enumerate(chart.methods):
        for quantity, fill in zip(chart.quantities, FILLS, strict=False):
            found = [f for f in curve(chart, quantity, method, known) if f[3] is not None]
            if found:
                shown.append((quantity.shown, fill))
                axes.loglog(
                    [f[3] for f in found],
                    [f[1] for f in found],
                    color=COLOURS[place % len(COLOURS)],
                    marker=MARKERS[place % len(MARKERS)],
                    fillstyle=fill,
                    markersize=6,
                    linewidth=1.0,
                )
    ends = axes.get_xlim()
    bound = {"color": "black", "linestyle": (0, (4, 3)), "linewidth": 1.0}
    axes.loglog(ends, ends, **bound)
    axes.set_xlim(ends)
    axes.set_title("Error found, by the error asked for")
    axes.set_xlabel("error asked for")
    axes.set_ylabel("error found (kept below the dashed line)")
    axes.grid(True, which="major", color="0.92")
    handles = [Line2D([], [], label="found = asked for", **bound)]
    handles += [
        Line2D([], [], color="0.3", marker="o", fillstyle=fill, linestyle="none", label=name)
        for name, fill in dict.fromkeys(shown)
    ]
    make_room(axes, len(handles))
    axes.legend(handles=handles, fontsize=8, loc="lower right")


def make_room(axes, entries: int):
    """Leaves the lower part of the panel to a legend of so many entries."""
    share = 0.045 * entries + 0.03
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
    ends = [panel(axes[i], chart, quantity, known) for i, quantity in enumerate(drawn)]
    if can_ask:
        asked_over_found(axes[panels], chart, known)
    figure.suptitle(chart.title, x=0.01, ha="left", fontsize=14, fontweight="bold")
    explain(figure, chart, axes, panels, count)
    figure.canvas.draw()
    figure.set_layout_engine("none")
    for place, points in zip(axes, ends, strict=False):
        labels = Labels(place)
        for seconds, err, setting, beyond, colour in points:
            words = [setting] if chart.has_settings else []
            labels.put(seconds, err, " ".join([*words, beyond]).strip(), colour)
    save(figure, folder / f"{chart.name}.png")
    plt.close(figure)


def explain(figure, chart: Chart, axes, panels: int, count: int):
    """The legend of methods, in the free panel or below all."""
    lines = {line.get_label(): line for place in axes[:panels] for line in place.get_lines()}
    labels = [method.name for method in chart.methods if method.name in lines]
    handles = [lines[label] for label in labels]
    handles.append(Line2D([], [], label="best error for the time", **FRONT))
    labels.append("best error for the time")
    if len(axes) > count:
        axes[-1].axis("off")
        axes[-1].legend(handles, labels, loc="center left", fontsize=10)
        figure.supxlabel(chart.points, x=0.01, ha="left", fontsize=9, color="0.3")
    else:
        about = {"title": chart.points, "title_fontsize": 9, "alignment": "left"}
        figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=9, **about)


def arranged(panels: int):
    """Panels in rows of two, so that they can be read at the width of a page."""
    rows = (panels + 1) // 2
    columns = min(panels, 2)
    size = 5.4 * columns, (5.6 if rows == 1 else 5.0 * rows)
    figure, axes = plt.subplots(rows, columns, figsize=size, layout="constrained", squeeze=False)
    return figure, list(axes.flat)
