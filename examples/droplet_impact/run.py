"""A hot drop hits an alumina plate: fluid, heat and stress in one unit."""

import sys
import time
from dataclasses import dataclass, field
from math import sqrt
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "droplet_impact"
STOP, STEP = 3.5e-6, 5e-8  # s
STRESS_EVERY = 5  # steps: each costs a solution of the plate's elasticity
DIAMETER, SPEED = 0.1e-3, 50.0  # m, m/s
HOT, COLD = 100.0, 20.0  # °C
SIZE = 400  # µm: the field of the scene
DEPTHS = {"centre": 0, "depth_1": 1, "depth_3": 3, "depth_10": 10}  # µm

ALUMINA, WATER = sqrt(10.0 * 3950.0 * 900.0), sqrt(0.6 * 1000.0 * 4000.0)  # effusivities
CONTACT = (ALUMINA * COLD + WATER * HOT) / (ALUMINA + WATER)  # °C, of two half spaces
SCALARS = [
    "drop.spread_diameter",
    "drop.height",
    "drop.kinetic_energy",
    "drop.force",
    "drop.heat",
    "plate.heat_in",
]


@dataclass
class Result:
    times: list[float] = field(default_factory=list)  # s, ends of steps
    scalars: list[np.ndarray] = field(default_factory=list)  # in the order of SCALARS
    temperatures: list[np.ndarray] = field(default_factory=list)  # °C, in the order of DEPTHS
    stress_times: list[float] = field(default_factory=list)  # s
    stresses: list[np.ndarray] = field(default_factory=list)  # Pa, σ_xx and σ_zz of the centre
    largest: list[np.ndarray] = field(default_factory=list)  # Pa: von Mises, principal
    surface_temperature: np.ndarray | None = None  # °C, at the end
    surface_von_mises: np.ndarray | None = None  # Pa, at the end

    def freeze(self):
        for name in ("times", "scalars", "temperatures", "stress_times", "stresses", "largest"):
            setattr(self, name, np.array(getattr(self, name)))

    def history(self, name: str) -> np.ndarray:
        return self.scalars[:, SCALARS.index(name)]


def simulate(fmu: Path) -> Result:
    result = Result()
    with Unit(fmu) as unit:
        for step in range(1, round(STOP / STEP) + 1):
            unit.step_to(step * STEP)
            result.times.append(unit.time)
            result.scalars.append(unit.get(SCALARS))
            temperatures = unit.get([f"{probe}.temperature" for probe in DEPTHS])
            result.temperatures.append(temperatures - shared.ZERO_CELSIUS)
            if step % STRESS_EVERY == 0:
                result.stress_times.append(unit.time)
                result.stresses.append(unit.get(["centre.stress_xx", "centre.stress_zz"]))
                result.largest.append(unit.get(["plate.max_von_mises", "plate.max_principal"]))
        result.surface_temperature = unit["surface.temperature"] - shared.ZERO_CELSIUS
        result.surface_von_mises = unit["surface.von_mises"]
    result.freeze()
    return result


def report(result: Result):
    rows = []
    for i, t in enumerate(result.stress_times):
        step = round(t / STEP) - 1
        values = [
            result.history("drop.spread_diameter")[step] / DIAMETER,
            result.history("drop.force")[step] * 1e3,
            result.temperatures[step, 0],
            result.stresses[i, 0] / 1e6,
            result.largest[i, 0] / 1e6,
        ]
        rows.append([f"{t * 1e6:.2f}"] + [f"{value:.3f}" for value in values])
    head = ["t/µs", "spread/D", "force/mN", "centre/°C", "σ_xx/MPa", "von Mises/MPa"]
    shared.print_table(head, rows)
    given, taken = result.history("drop.heat")[-1], result.history("plate.heat_in")[-1]
    print(f"the drop gave {given * 1e6:.4f} µJ, the plate took it to {abs(taken / given - 1):.0e}")
    print(f"contact of two half spaces: {CONTACT:.2f} °C")


def draw(result: Result, folder: Path) -> Path:
    figure, axes = shared.new_figure(2, 3)
    draw_fields(axes[:, 0], result)
    draw_drop(axes[:, 1], result)
    draw_plate(axes[:, 2], result)
    figure.suptitle(
        f"Water of {HOT:.0f} °C hits alumina of {COLD:.0f} °C at {SPEED:.0f} m/s: "
        "drop and plate in one unit"
    )
    return shared.save(figure, folder, NAME)


def draw_fields(axes, result: Result):
    image = shared.show_field(axes[0], result.surface_temperature, (SIZE, SIZE), cmap="inferno")
    shared.add_colour_bar(image, "°C")
    stress = result.surface_von_mises / 1e6
    image = shared.show_field(axes[1], stress, (SIZE, SIZE), cmap="viridis")
    shared.add_colour_bar(image, "MPa")
    axes[0].set_title(f"Temperature after {STOP * 1e6:.1f} µs")
    axes[1].set_title(f"Von Mises stress after {STOP * 1e6:.1f} µs")
    for plot in axes:
        plot.set(xlabel="x / µm", ylabel="y / µm")


def draw_drop(axes, result: Result):
    times = result.times * 1e6
    plot = axes[0]
    plot.plot(times, result.history("drop.spread_diameter") / DIAMETER, label="spread diameter")
    plot.plot(times, result.history("drop.height") / DIAMETER, label="height")
    plot.set(ylabel="over the drop's diameter", ylim=(0, None))
    plot.set_title("The drop becomes a lamella")
    plot.legend()
    plot = axes[1]
    plot.plot(times, result.history("drop.force") * 1e3, color=shared.COLOURS[1])
    plot.set(ylabel="force on the plate / mN")
    plot.set_title("The blow is over soon")
    for plot in axes:
        plot.set(xlabel="time / µs")


def draw_plate(axes, result: Result):
    times = result.times * 1e6
    plot = axes[0]
    for values, depth in zip(result.temperatures.T, DEPTHS.values(), strict=True):
        plot.plot(times, values, label="surface" if depth == 0 else f"{depth} µm deep")
    plot.axhline(CONTACT, **shared.CLOSED_FORM, label="two half spaces")
    plot.set(ylabel="temperature / °C", ylim=(None, 65.0))
    plot.set_title("The heat comes and stays")
    plot.legend(loc="upper left", ncols=2)
    plot = axes[1]
    stress_times = result.stress_times * 1e6
    plot.plot(stress_times, result.stresses[:, 0] / 1e6, "o-", label=r"$\sigma_{xx}$ at the centre")
    plot.plot(stress_times, result.largest[:, 0] / 1e6, "o-", label="highest von Mises")
    plot.plot(stress_times, result.largest[:, 1] / 1e6, "o-", label="largest principal")
    highest = 1.8e-6 * result.largest.max()
    plot.set(ylabel="stress / MPa", ylim=(None, highest))
    plot.set_title("Stress of the plate")
    plot.legend(loc="upper left")
    for plot in axes:
        plot.set(xlabel="time / µs")


def main(given: list[str] | None = None) -> Result:
    options = shared.arguments(NAME, __doc__, given)
    started = time.perf_counter()
    result = simulate(options.fmu)
    print(f"{len(result.times)} steps in {time.perf_counter() - started:.1f} s")
    report(result)
    draw(result, options.out)
    return result


if __name__ == "__main__":
    main()
