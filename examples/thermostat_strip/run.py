"""A thermostat: a bimetal strip opens the contact of a heater as it bends, and closes it again."""

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "thermostat_strip"
STOP, STEP = 900.0, 3.0  # s
ROOM = 20.0  # °C
POWER, CAPACITY, LOSS = 1200.0, 700.0, 3.0  # W, J/K and W/K of the sole of an iron
LAG = 20.0  # s by which the strip follows the sole
LENGTH, HEIGHT = 60e-3, 0.8e-3  # m
OPENS, CLOSES = 14.0e-3, 13.0e-3  # m of the tip: a spring snaps over
SHOWN = [50.0, 100.0, 150.0, 200.0]  # °C


@dataclass
class Result:
    times: np.ndarray  # s
    sole: np.ndarray  # °C
    strip: np.ndarray  # °C
    curvature: np.ndarray  # 1/m
    tip: np.ndarray  # m
    heats: np.ndarray  # True while the contact is closed


def deflection(curvature: np.ndarray) -> np.ndarray:
    """Height of the end of a circular arc above its beginning [m]."""
    turned = np.asarray(curvature) * LENGTH
    return -LENGTH * np.sin(turned / 2) * np.sinc(turned / (2 * np.pi))


def timoshenko() -> float:
    """Curvature per kelvin of two equally thick layers in plane strain, Timoshenko (1925)."""
    modulus = [105e9 / (1 - 0.34**2), 141e9 / (1 - 0.29**2)]
    more = 1.34 * 19e-6 - 1.29 * 1.3e-6
    ratio = modulus[1] / modulus[0]
    return -24 * more / (HEIGHT * (12 + (1 + ratio) * (1 + 1 / ratio)))


def simulate(fmu: Path) -> Result:
    rows, sole, strip, heats = [], ROOM, ROOM, True
    with Unit(fmu) as unit:
        for step in range(round(STOP / STEP)):
            # The sole and the strip as bodies of one temperature each, exact over a step.
            rests = ROOM + (POWER if heats else 0.0) / LOSS
            sole = rests + (sole - rests) * np.exp(-LOSS * STEP / CAPACITY)
            strip = sole + (strip - sole) * np.exp(-STEP / LAG)
            unit["strip.temperature"] = strip + shared.ZERO_CELSIUS
            unit.step_to((step + 1) * STEP)
            curvature = unit["strip.curvature"]
            tip = deflection(curvature)
            heats = tip < OPENS if heats else tip < CLOSES
            rows.append([unit.time, sole, strip, curvature, tip, heats])
    rows = np.array(rows)
    return Result(*rows[:, :5].T, rows[:, 5] > 0)


def report(result: Result):
    linear = timoshenko()
    rows = []
    for temperature in SHOWN:
        step = int(np.argmax(result.strip >= temperature))
        warm = result.strip[step] - ROOM
        curvature, tip = result.curvature[step], result.tip[step]
        values = [f"{result.times[step]:.0f}", f"{result.strip[step]:.1f}", f"{curvature:.3f}"]
        values += [f"{linear * warm:.3f}", f"{tip * 1e3:.2f}"]
        rows.append(values)
    shared.print_table(["t/s", "strip/°C", "curvature·m", "Timoshenko", "tip/mm"], rows)
    opened = np.flatnonzero(result.heats[:-1] & ~result.heats[1:]) + 1
    closed = np.flatnonzero(~result.heats[:-1] & result.heats[1:]) + 1
    print(f"The contact opens at {result.strip[opened].mean():.0f} °C of the strip, ", end="")
    print(f"closes at {result.strip[closed].mean():.0f} °C; ", end="")
    swing = result.sole[opened[0] :]
    print(f"the sole swings from {swing.min():.0f} to {swing.max():.0f} °C.")


def draw(result: Result, folder: Path) -> Path:
    figure, axes = shared.new_figure(1, 3, height=5.0)
    draw_temperatures(axes[0], result)
    draw_bending(axes[1], result)
    draw_shapes(axes[2], result)
    figure.suptitle("A strip of brass on Invar, 60 mm × 0.8 mm, keeps the sole of an iron warm")
    return shared.save(figure, folder, NAME)


def draw_temperatures(plot, result: Result):
    plot.fill_between(
        result.times,
        0,
        1,
        where=result.heats,
        step="pre",
        transform=plot.get_xaxis_transform(),
        color="#fbe7d6",
        linewidth=0,
        zorder=0,
        label="heater on",
    )
    plot.plot(result.times, result.sole, label="sole", color=shared.COLOURS[1])
    plot.plot(result.times, result.strip, label="strip", color=shared.COLOURS[0])
    plot.set(xlabel="time / s", ylabel="temperature / °C", xlim=(0, STOP), ylim=(0, None))
    plot.set_title("The strip switches the heater")
    plot.legend(loc="lower right")


def draw_bending(plot, result: Result):
    warm = np.linspace(0, result.strip.max() - ROOM, 50)
    plot.plot(result.strip, -result.tip * 1e3, label="unit", color=shared.COLOURS[0])
    linear = deflection(timoshenko() * warm)
    plot.plot(ROOM + warm, -linear * 1e3, **shared.CLOSED_FORM, label="Timoshenko, small strain")
    for height, name in [(OPENS, "opens"), (CLOSES, "closes")]:
        plot.axhline(-height * 1e3, color="0.7", linewidth=1)
        plot.annotate(name, (ROOM, -height * 1e3), (2, 3), textcoords="offset points", color="0.4")
    plot.set(xlabel="temperature of the strip / °C", ylabel="height of the end / mm")
    plot.set_title("It bends towards the Invar")
    plot.legend(loc="upper right")


def draw_shapes(plot, result: Result):
    along = np.linspace(0, LENGTH, 100)
    for temperature, colour in zip(SHOWN, shared.COLOURS, strict=False):
        step = int(np.argmax(result.strip >= temperature))
        turned = result.curvature[step] * along
        part = np.sinc(turned / (2 * np.pi))
        x, z = along * np.cos(turned / 2) * part, along * np.sin(turned / 2) * part
        plot.plot(x * 1e3, z * 1e3, color=colour, label=f"{result.strip[step]:.0f} °C")
    plot.set(xlabel="x / mm", ylabel="z / mm")
    plot.set_aspect("equal", adjustable="datalim")
    plot.set_title("Its shape on the way up")
    plot.legend(loc="lower left")


def main(given: list[str] | None = None) -> Result:
    options = shared.arguments(NAME, __doc__, given)
    result = simulate(options.fmu)
    report(result)
    draw(result, options.out)
    return result


if __name__ == "__main__":
    main()
