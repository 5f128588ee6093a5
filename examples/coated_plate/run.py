"""Coated alumina under a hot spot and under a hot drop: both sides of the interface."""

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "coated_plate"
STOP, STEP = 2e-3, 2e-4  # s
FLUX, RADIUS = 3e6, 0.5e-3  # W/m² in the middle of the spot, m
COATING, ALUMINA = 20e-6, 240e-6  # m
RESISTANCE = 1e-6  # m² K/W
START = 20.0  # °C
TEMPERATURES = ["surface", "coating_at_interface", "alumina_at_interface"]
UNDER_DROP = ["under_drop", "coating_under_drop", "alumina_under_drop"]
LABELS = ["surface", "coating at the interface", "alumina at the interface"]


@dataclass
class Result:
    times: np.ndarray  # s
    spot: np.ndarray  # °C, in the order of TEMPERATURES
    drop: np.ndarray  # °C, in the order of UNDER_DROP
    stresses: np.ndarray  # Pa, xx in coating and alumina at the interface of the plate
    heat: np.ndarray  # J brought in, stored, lost by the plate


def simulate(fmu: Path) -> Result:
    rows = []
    with Unit(fmu) as unit:
        for step in range(round(STOP / STEP)):
            unit.step_to((step + 1) * STEP)
            probed = [f"{probe}.temperature" for probe in TEMPERATURES + UNDER_DROP]
            stresses = ["coating_at_interface.stress_xx", "alumina_at_interface.stress_xx"]
            heat = ["plate.heat_in", "plate.heat_stored", "plate.heat_lost"]
            rows.append([unit.time, *unit.get([*probed, *stresses, *heat])])
    rows = np.array(rows)
    celsius = rows[:, 1:7] - shared.ZERO_CELSIUS
    return Result(rows[:, 0], celsius[:, :3], celsius[:, 3:], rows[:, 7:9], rows[:, 9:])


def report(result: Result):
    rows = []
    for step in [0, 1, 2, 4, 9]:
        values = [*result.spot[step], *result.drop[step], *(result.stresses[step] * 1e-6)]
        rows.append([f"{result.times[step] * 1e3:.1f}"] + [f"{value:.2f}" for value in values])
    header = ["t/ms", *(f"{probe}/°C" for probe in TEMPERATURES + UNDER_DROP)]
    shared.print_table([*header, "coating/MPa", "alumina/MPa"], rows)
    brought, stored, lost = result.heat[-1]
    print(f"plate: brought in {brought:.6e} J = stored {stored:.6e} J + lost {lost:.6e} J", end="")
    print(f" to {abs(brought - stored - lost) / brought:.0e}")
    _, above, below = result.spot[-1]
    passed = (above - below) / RESISTANCE
    print(f"flux through the contact in the middle of the spot: {passed:.3e} W/m²")


def draw(result: Result, folder: Path):
    figure, axes = shared.new_figure(1, 3, height=5.0)
    times = np.concatenate([[0.0], result.times * 1e3])
    for plot, values, title in [
        (axes[0], result.spot, "Hot spot: the contact holds back heat"),
        (axes[1], result.drop, "Hot drop: the surface follows the film"),
    ]:
        values = np.vstack([np.full(3, START), values])
        plot.fill_between(times, values[:, 1], values[:, 2], color="0.88", lw=0)
        for label, column, colour in zip(LABELS, values.T, shared.COLOURS, strict=False):
            plot.plot(times, column, color=colour, label=label, marker="o", markersize=3.5)
        step = f"{values[-1, 1] - values[-1, 2]:.1f} K across the contact"
        plot.text(times[-1], START + 2, step, ha="right", color="0.35")
        plot.set(title=title, xlabel="time / ms", ylabel="temperature / °C", ylim=(START, 98))
        plot.legend(loc="upper left")
    stresses = np.vstack([np.zeros(2), result.stresses * 1e-6])
    for label, column, colour in zip(LABELS[1:], stresses.T, shared.COLOURS[1:], strict=False):
        axes[2].plot(times, column, color=colour, label=label, marker="o", markersize=3.5)
    axes[2].set(xlabel="time / ms", ylabel="stress along the surface, σ_xx / MPa")
    axes[2].set_title("Hot spot: the stiff alumina bears more")
    axes[2].legend()
    figure.suptitle("20 µm of zirconia on 240 µm of alumina, at both sides of the contact")
    shared.save(figure, folder, NAME)


def check(result: Result):
    """The contact passes what the spot brings in, less what the coating has taken up and spread."""
    settled = result.spot[-1]
    passed = (settled[1] - settled[2]) / RESISTANCE
    assert 0.8 * FLUX < passed < FLUX, passed
    through = FLUX * (COATING / 1.5 + RESISTANCE)
    assert abs(settled[0] - settled[2] - through) < 0.2 * through, settled
    assert np.all(np.diff(result.drop[-1]) < 0), "heat comes from the drop"
    brought, stored, lost = result.heat[-1]
    assert abs(brought - stored - lost) < 1e-9 * brought


def main(given: list[str] | None = None):
    options = shared.arguments(NAME, __doc__, given)
    result = simulate(options.fmu)
    report(result)
    check(result)
    draw(result, options.out)


if __name__ == "__main__":
    main()
