"""A printer lays a line of wax drops at 1 kHz on a warm plate, which they make warmer."""

import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "printed_line"
STEP, PERIOD, STOP = 1e-4, 1e-3, 40e-3  # s
DROPS, PITCH = 25, 80e-6  # m
SIZE = (2.4e-3, 0.8e-3)  # m, of the field
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
    titles = ["Surface after the last drop", f"Surface at {STOP * 1e3:.0f} ms"]
    for axis, values, title in zip(axes[0], fields, titles, strict=True):
        image = shared.show_field(axis, values - shared.ZERO_CELSIUS, size, cmap="inferno")
        shared.add_colour_bar(image, "°C")
        axis.set(title=title, xlabel="x [mm]", ylabel="y [mm]")
    milliseconds = rows[:, 0] * 1e3
    axes[1, 0].plot(milliseconds, rows[:, 5] - shared.ZERO_CELSIUS)
    axes[1, 0].set(title="Middle of the plate", xlabel="t [ms]", ylabel="°C")
    axes[1, 1].plot(milliseconds, rows[:, 2] * 1e3, label="all drops together")
    axes[1, 1].set(title="Heat flow into the plate", xlabel="t [ms]", ylabel="mW")
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
