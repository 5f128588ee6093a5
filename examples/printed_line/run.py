"""A printer lays a line of wax drops at 1 kHz on a warm plate, which they make warmer."""

import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import shared  # noqa: E402
from impinge import Unit  # noqa: E402
from matplotlib.colors import LogNorm  # noqa: E402
from matplotlib.ticker import FuncFormatter  # noqa: E402

NAME = "printed_line"
STEP, PERIOD, STOP = 1e-4, 1e-3, 40e-3  # s
DROPS, PITCH = 25, 80e-6  # m
SIZE = (2.4e-3, 0.8e-3)  # m, of the field
START, LEAST = 320.0, 0.1  # K, of the plate, and the least rise that is drawn
OUTPUTS = ["drop.heat", "drop.heat_flow", "drop.active", "drop.overlapping", "middle.temperature"]


def simulate(fmu: Path):
    """Outputs after each step, and the surface after the last drop and at the end."""
    rows, fields = [], []
    places = (np.arange(DROPS) - 0.5 * (DROPS - 1)) * PITCH
    with Unit(fmu) as unit:
        for step in range(round(STOP / STEP)):
            drop, waits = divmod(step, round(PERIOD / STEP))
            if waits == 0 and drop < DROPS:
                unit["drop.x"] = places[drop]
                unit["drop.release"] = drop + 1
            unit.step_to((step + 1) * STEP)
            rows.append([unit.time, *unit.get(OUTPUTS)])
            if step + 1 in (round(DROPS * PERIOD / STEP), round(STOP / STEP)):
                fields.append(unit["surface.temperature"])
        balance = unit["plate.heat_in"] - unit["plate.heat_stored"] - unit["plate.heat_lost"]
        print(
            f"heat balance of the plate: {abs(balance / unit['plate.heat_in']):.0e} of what came in"
        )
    return np.array(rows), [np.reshape(field, (48, 16)) for field in fields]


def report(rows: np.ndarray):
    table = []
    for t in (1, 5, 10, 20, 25, 30, 40):
        _, heat, flow, active, overlapping, middle = rows[round(t * 1e-3 / STEP) - 1]
        table.append(
            [
                f"{t}",
                f"{heat * 1e6:.2f}",
                f"{flow * 1e3:.2f}",
                f"{active:.0f}",
                f"{overlapping:.0f}",
                f"{middle - shared.ZERO_CELSIUS:.2f}",
            ]
        )
    head = ["t/ms", "heat/µJ", "flow/mW", "active", "overlapping", "middle/°C"]
    shared.print_table(head, table)


def draw(rows: np.ndarray, fields: list[np.ndarray], folder: Path):
    ratios = {"height_ratios": [2, 3]}
    figure, axes = shared.new_figure(2, 2, height=6.5, gridspec_kw=ratios)
    figure.suptitle(
        f"{DROPS} wax drops of 127 °C, one a millisecond {PITCH * 1e6:.0f} µm apart, "
        "on glass of 47 °C"
    )
    size = tuple(1e3 * extent for extent in SIZE)
    moments = [f"{DROPS * PERIOD * 1e3:.0f} ms, after the last drop", f"{STOP * 1e3:.0f} ms"]
    places = (np.arange(DROPS) - 0.5 * (DROPS - 1)) * PITCH * 1e3
    for axis, values, moment in zip(axes[0], fields, moments, strict=True):
        rise = values - START
        shown = np.clip(rise, LEAST, None)
        norm = LogNorm(LEAST, 20.0)
        image = shared.show_field(axis, shown, size, cmap="inferno", norm=norm)
        axis.plot(places, np.zeros(DROPS), "|", color="white", markersize=5, markeredgewidth=0.6)
        shared.add_colour_bar(image, "rise / K")
        image.colorbar.formatter = FuncFormatter(lambda x, _: f"{x:g}")
        axis.set(title=f"{moment}: up to {rise.max():.1f} K warmer", xlabel="x / mm")
        axis.set_ylabel("y / mm")
    milliseconds = rows[:, 0] * 1e3
    middle = rows[:, 5] - shared.ZERO_CELSIUS
    axes[1, 0].plot(milliseconds, middle)
    axes[1, 0].annotate(
        f"drop {DROPS // 2 + 1} lands here",
        (milliseconds[middle.argmax()], middle.max()),
        (14, -4),
        textcoords="offset points",
    )
    axes[1, 0].set(xlabel="time / ms", ylabel="temperature / °C")
    axes[1, 0].set_title("The middle of the plate feels one drop, and its neighbours")
    axes[1, 1].plot(milliseconds, rows[:, 2] * 1e3, linewidth=1.2)
    axes[1, 1].set(xlabel="time / ms", ylabel="heat flow / mW", ylim=(0, None))
    axes[1, 1].set_title("Flows of successive drops add up")
    shared.save(figure, folder, NAME)


def main(given: list[str] | None = None):
    options = shared.arguments(NAME, __doc__, given)
    begin = time.perf_counter()
    rows, fields = simulate(options.fmu)
    print(f"{DROPS} drops in {time.perf_counter() - begin:.1f} s")
    report(rows)
    draw(rows, fields, options.out)


if __name__ == "__main__":
    main()
