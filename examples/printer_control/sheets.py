"""The pictures of the example."""

from pathlib import Path

import numpy as np
import shared
import warm_up

SIZE = (40.0, 12.0)  # mm of the bed


def draw_print(done, folder: Path) -> Path:
    """Control over the run, the bed's surface after each drop, and a drop's milliseconds."""
    figure = shared.new_figure(1, 1, height=8.6)[0]
    figure.clear()
    grid = figure.add_gridspec(3, 12, height_ratios=[1.25, 0.85, 1.0])
    draw_control(figure.add_subplot(grid[0, :6]), figure.add_subplot(grid[0, 6:]), done)
    draw_surfaces([figure.add_subplot(grid[1, 3 * k : 3 * k + 3]) for k in range(4)], done)
    draw_drop([figure.add_subplot(grid[2, 4 * k : 4 * k + 4]) for k in range(3)], done)
    figure.suptitle("Drops of 160 °C on a bed that a controller holds at 120 °C")
    return shared.save(figure, folder, "printing")


def releases(done) -> np.ndarray:
    """Times of the record at which another drop had been released."""
    released = done.of("drop.released")
    return done.table["time"].values[1:][np.diff(released) > 0] - warm_up.SAMPLE


def draw_control(left, right, done) -> None:
    times = done.table["time"].values
    begun = releases(done)
    for probe, label in zip(warm_up.PROBES, ["thermocouple", "middle"], strict=True):
        left.plot(times, done.of(probe) - shared.ZERO_CELSIUS, label=label)
    left.axhline(warm_up.WANTED - shared.ZERO_CELSIUS, **shared.CLOSED_FORM, label="set point")
    power = done.table["controller.power"].values
    right.step(times, power, where="post", label="heater", color=shared.COLOURS[0])
    flow = np.diff(done.of("drop.heat")) / np.diff(times)
    right.stairs(flow, times, baseline=None, color=shared.COLOURS[1], linewidth=2, label="drops")
    lost = np.diff(done.of("bed.heat_lost")) / np.diff(times)
    right.plot(0.5 * (times[1:] + times[:-1]), lost, color=shared.COLOURS[3], label="lost")
    for plot in (left, right):
        for t in begun:
            plot.axvline(t, color="0.8", linewidth=1, zorder=0)
        plot.set(xlabel="time / s", xlim=(begun[0] - 1.0, times[-1]))
        plot.legend(loc="upper left", ncols=3)
    left.set(ylabel="temperature / °C", ylim=(115, 145))
    left.set_title("The bed warms where drops land")
    right.set(ylabel="power / W", ylim=(0, 22))
    right.set_title("The heater gives way to the heat of the drops")


def draw_surfaces(plots, done) -> None:
    """What the drops have added, each a tenth of a second after it was let go, and at the end."""
    times = done.table["time"].values
    begun = releases(done)
    field = done.of("surface.temperature")
    before = field[int(np.argmin(np.abs(times - begun[0])))]
    moments = [*(begun + 0.1), *([times[-1]] * 3)][:4]
    rows = [int(np.argmin(np.abs(times - t))) for t in moments]
    rises = field[rows] - before
    most = np.abs(rises).max()
    for plot, row, rise in zip(plots, rows, rises, strict=True):
        image = shared.show_field(plot, rise, SIZE, cmap="RdBu_r", vmin=-most, vmax=most)
        if rise.min() < 0.0 < rise.max():
            extent = {"extent": image.get_extent(), "linewidths": 0.8}
            plot.contour(rise.T, levels=[0.0], colors="0.4", **extent)
        plot.set_title(f"{times[row]:.2f} s: {rise.min():+.1f} to {rise.max():+.1f} K", fontsize=11)
        plot.set(xlabel="x / mm")
    plots[0].set_ylabel("y / mm")
    shared.add_colour_bar(image, "since the first\ndrop / K")


def draw_drop(plots, done) -> None:
    drop = done.drop
    ms = drop["time"] * 1e3
    plots[0].plot(ms, drop["drop.spread_diameter"] * 1e3, label="diameter on the bed")
    plots[0].plot(ms, drop["drop.height"] * 1e3, label="height")
    plots[0].set(ylabel="length / mm", title="The first drop spreads")
    plots[1].plot(ms, drop["drop.heat"] * 1e3, label="the drop")
    plots[1].plot(ms, drop["exact"] * 1e3, **shared.CLOSED_FORM, label="half spaces at rest")
    plots[1].set(ylabel="heat / mJ", title="It gives heat")
    plots[2].plot(ms, drop["rise"])
    plots[2].set(ylabel="rise / K", title="The bed below it is warmer")
    for plot in plots:
        plot.set(xlabel="time since its release / ms", ylim=(0, None))
    for plot in plots[:2]:
        plot.legend()


def draw_plans(runs: dict, folder: Path) -> Path:
    """The plan beside the PI controller."""
    figure, axes = shared.new_figure(2, 2, height=7.5, sharex=True, height_ratios=[1.6, 1])
    for column, other in enumerate(("", ", other bed")):
        names = [("plan anew" if other else "plan"), "PI by rule", "PI searched"]
        top, bottom = axes[:, column]
        for name, colour in zip(names, shared.COLOURS, strict=False):
            run = runs[f"{name}{other}"]
            celsius = run.temperatures - shared.ZERO_CELSIUS
            top.plot(run.times, celsius[:, 0], color=colour, label=f"{name}: thermocouple")
            top.plot(run.times, celsius[:, 1], ":", color=colour, label=f"{name}: middle")
            bottom.step(run.times, run.powers, where="post", color=colour, label=name)
        wanted, limit = (each - shared.ZERO_CELSIUS for each in (warm_up.WANTED, warm_up.HOTTEST))
        top.axhline(wanted, **shared.CLOSED_FORM)
        top.axhline(limit, color="0.6", linewidth=1)
        top.text(6.0, limit + 1, "limit of the middle", color="0.5", ha="right")
        bottom.axhline(warm_up.HIGHEST, color="0.6", linewidth=1)
        bottom.set(xlabel="time / s", ylabel="heater / W")
        top.set(ylabel="°C", xlim=(0, 6.0))
        top.legend(loc="lower right")
    axes[0, 0].set_title("The bed that the map was made of")
    axes[0, 1].set_title("A bed that stores 10 % more and loses 30 % more below")
    figure.suptitle("From 25 °C to 120 °C: a plan by the linear map, and a PI controller")
    return shared.save(figure, folder, "plans")
