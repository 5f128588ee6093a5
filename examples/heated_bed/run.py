"""A controller holds a heated bed at 60 °C while a fan blows on its middle."""

import sys
import time
from dataclasses import dataclass, field
from math import pi
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "heated_bed"
STOP, STEP = 600.0, 0.5  # s
SET_POINT, ROOM = 60.0, 20.0  # °C
PROBES = ["thermocouple", "middle", "rim"]

HEATER_RADIUS, HEATER_POWER = 30e-3, 80.0  # m, W at most
HEATER_AREA = pi * HEATER_RADIUS**2

# The fan: a Gaussian jet, on between these times
FAN_RADIUS, FAN_FLUX, FAN_ON = 10e-3, -20e3, (240.0, 420.0)  # m, W/m² at its centre, s
FAN_POWER = FAN_FLUX * pi * FAN_RADIUS**2 / 2


@dataclass
class Controller:
    """Proportional, integral and derivative, saturated, without wind-up.

    The derivative acts on the measured value, filtered, so that a new set point gives no kick.
    """

    gain: float = 12.0  # W/K
    integral_time: float = 40.0  # s
    derivative_time: float = 1.5  # s
    filter_time: float = 1.0  # s
    highest: float = HEATER_POWER
    integral: float = 0.0  # W
    slope: float = 0.0  # K/s
    last: float | None = None

    def power(self, wanted: float, measured: float, step: float) -> float:
        """Power of the heater [W] for the next step."""
        rate = 0.0 if self.last is None else (measured - self.last) / step
        self.last = measured
        self.slope += (rate - self.slope) * step / (self.filter_time + step)
        error = wanted - measured
        asked = self.integral + self.gain * (error - self.derivative_time * self.slope)
        given = min(max(asked, 0.0), self.highest)
        # While the heater is at a limit the integral does not run away.
        if given == asked or (asked - given) * error < 0:
            self.integral += self.gain * error * step / self.integral_time
        return given


@dataclass
class Result:
    times: list[float] = field(default_factory=list)  # s, ends of steps
    temperatures: list[np.ndarray] = field(default_factory=list)  # °C, in the order of PROBES
    powers: list[float] = field(default_factory=list)  # W of the heater during each step
    heat: list[np.ndarray] = field(default_factory=list)  # J brought in, stored, lost
    heat_balance: float = 0.0  # relative

    def freeze(self):
        self.temperatures, self.heat = np.array(self.temperatures), np.array(self.heat)
        self.times, self.powers = np.array(self.times), np.array(self.powers)
        brought, stored, lost = self.heat[-1]
        self.heat_balance = abs(brought - stored - lost) / brought


def simulate(fmu: Path) -> Result:
    result, controller = Result(), Controller()
    with Unit(fmu) as unit:
        unit.set({"bed.top.ambient": ROOM + shared.ZERO_CELSIUS})
        unit.set({"bed.sides.ambient": ROOM + shared.ZERO_CELSIUS})
        for step in range(round(STOP / STEP)):
            measured = unit["thermocouple.temperature"] - shared.ZERO_CELSIUS
            power = controller.power(SET_POINT, measured, STEP)
            blows = FAN_ON[0] <= unit.time < FAN_ON[1]
            unit.set(
                {
                    "heater.heat_flux": power / HEATER_AREA,
                    "fan.heat_flux": FAN_FLUX if blows else 0.0,
                }
            )
            unit.step_to((step + 1) * STEP)
            result.times.append(unit.time)
            result.powers.append(power)
            probed = unit.get([f"{probe}.temperature" for probe in PROBES])
            result.temperatures.append(probed - shared.ZERO_CELSIUS)
            result.heat.append(unit.get(["bed.heat_in", "bed.heat_stored", "bed.heat_lost"]))
    result.freeze()
    return result


def report(result: Result):
    rows = []
    for t in [30, 60, 120, 239, 250, 419, 600]:
        step = round(t / STEP) - 1
        values = [*result.temperatures[step], result.powers[step]]
        rows.append([f"{t:.0f}"] + [f"{value:.2f}" for value in values])
    shared.print_table(["t/s", *(f"{probe}/°C" for probe in PROBES), "heater/W"], rows)
    brought, stored, lost = result.heat[-1]
    fan_time = FAN_ON[1] - FAN_ON[0]
    sent = result.powers.sum() * STEP + FAN_POWER * fan_time
    print(f"brought in {brought:.3f} J = stored {stored:.3f} J + lost {lost:.3f} J", end="")
    print(f" to {result.heat_balance:.0e}")
    print(f"heater {result.powers.sum() * STEP:.3f} J, fan {FAN_POWER * fan_time:.3f} J:", end="")
    print(f" brought in to {abs(sent / brought - 1):.0e}")


def draw(result: Result, folder: Path) -> Path:
    figure, axes = shared.new_figure(2, 2, sharex="col")
    for plot in axes.flat:
        plot.axvspan(*FAN_ON, color="#dbe9f6", zorder=0, linewidth=0)
    draw_temperatures(axes[0], result)
    draw_power(axes[1, 0], result)
    draw_heat(axes[1, 1], result)
    figure.suptitle(
        "A controller holds a steel bed of 80 mm at 60 °C: a fan on its thermocouple makes "
        "the rest too warm"
    )
    return shared.save(figure, folder, NAME)


def draw_temperatures(axes, result: Result):
    names = ["thermocouple, centre", "20 mm from the centre", "rim"]
    for plot in axes:
        for values, name in zip(result.temperatures.T, names, strict=True):
            plot.plot(result.times, values, label=name)
        plot.axhline(SET_POINT, **shared.CLOSED_FORM, label="set point")
        plot.set(ylabel="temperature / °C")
    axes[0].text(sum(FAN_ON) / 2, 46, "fan on the centre", ha="center", color="#3a6ea5")
    axes[0].set_title("Warm in a minute, no wind-up")
    axes[0].legend(loc="lower right")
    axes[1].set(ylim=(57.5, 63.5))
    middle = result.temperatures[round(FAN_ON[1] / STEP) - 1, 1]
    axes[1].set_title(f"Held at the centre, {middle - SET_POINT:.1f} K too warm beside it")


def draw_power(plot, result: Result):
    lost = np.diff(result.heat[:, 2], prepend=0.0) / STEP
    plot.plot(result.times, result.powers, label="heater")
    plot.plot(result.times, lost, label="lost to the room", color=shared.COLOURS[3])
    plot.axhline(HEATER_POWER, color="0.7", linewidth=1)
    plot.text(STOP, HEATER_POWER - 1.5, "limit", color="0.5", ha="right", va="top")
    plot.set(xlabel="time / s", ylabel="power / W", xlim=(0, STOP))
    plot.set_title("The heater makes up for fan and room")
    plot.legend(loc="center right", bbox_to_anchor=(1, 0.6))


def draw_heat(plot, result: Result):
    brought, stored, lost = result.heat.T / 1e3
    plot.fill_between(result.times, stored, color="#f0b878", linewidth=0, label="stored in the bed")
    plot.fill_between(
        result.times, stored, stored + lost, color="#9fcfc8", linewidth=0, label="lost to the room"
    )
    plot.plot(result.times, brought, label="brought in, less the fan's")
    plot.set(xlabel="time / s", ylabel="heat / kJ", xlim=(0, STOP), ylim=(0, None))
    plot.set_title(f"Stored + lost = brought in, to {result.heat_balance:.0e}")
    plot.legend(loc="upper left")


def main(given: list[str] | None = None) -> Result:
    options = shared.arguments(NAME, __doc__, given)
    started = time.perf_counter()
    result = simulate(options.fmu)
    print(f"{len(result.times)} steps in {time.perf_counter() - started:.2f} s")
    report(result)
    draw(result, options.out)
    return result


if __name__ == "__main__":
    main()
