"""A strand is printed across a gap: it sags while it is hot, and stays where it is when cold."""

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "printed_strand"
STOP, STEP = 6.0, 0.02  # s
HOT, AIR = 473.15, 298.15  # K
SPAN, WIDTH = 8e-3, 0.4e-3  # m
DENSITY, HEAT = 1200.0, 1800.0  # kg/m³, J/(kg K)
STRANDS = {"fanned": 250.0, "still": 80.0}  # W/(m² K): convection to the air
VISCOSITY, SLOPE = 0.00042 * 1.2132e9 * 1e10, (17.44, 51.6, 333.0)  # Pa s at 333 K, and its shift


@dataclass
class Result:
    times: np.ndarray  # s
    temperatures: dict[str, np.ndarray]  # K
    sags: dict[str, np.ndarray]  # m of the middle


def temperature(name: str, time: np.ndarray | float) -> np.ndarray:
    """A strand of one temperature, which convection cools from all sides [K]."""
    lag = DENSITY * HEAT * WIDTH / (4 * STRANDS[name])
    return AIR + (HOT - AIR) * np.exp(-np.asarray(time) / lag)


def by_hand(name: str, times: np.ndarray) -> np.ndarray:
    """Sag of a viscous beam between clamps, thin, straight, free of tension: ∫ ρgL⁴/(96ηh²) dt."""
    first, second, reference = SLOPE
    above = temperature(name, times) - reference
    viscosity = VISCOSITY * 10 ** (-first * above / (second + above))
    rate = DENSITY * 9.81 * SPAN**4 / (96 * viscosity * WIDTH**2)
    steps = 0.5 * (rate[1:] + rate[:-1]) * np.diff(times)
    return np.concatenate([[0.0], np.cumsum(steps)])


def simulate(fmu: Path) -> Result:
    rows = []
    with Unit(fmu) as unit:
        straight = unit["still.height"]
        for step in range(round(STOP / STEP)):
            end = (step + 1) * STEP
            for name in STRANDS:
                unit[f"{name}.temperature"] = float(temperature(name, end))
            unit.step_to(end)
            rows.append([unit.time, *unit.get([f"{name}.height" for name in STRANDS])])
    rows = np.array(rows)
    names = list(STRANDS)
    sags = {name: rows[:, n + 1] - straight for n, name in enumerate(names)}
    return Result(rows[:, 0], {name: temperature(name, rows[:, 0]) for name in names}, sags)


def report(result: Result):
    rows = []
    for name, convection in STRANDS.items():
        sag = result.sags[name]
        values = [f"{sag[round(t / STEP) - 1] * 1e3:.3f}" for t in (0.1, 0.3, 1.0, 6.0)]
        beam = by_hand(name, np.linspace(0, 0.1, 1001))[-1]
        rows.append([name, f"{convection:.0f}", f"{beam * 1e3:.3f}", *values])
    head = ["strand", "h/(W/m²K)", "beam, 0.1 s", "0.1 s", "0.3 s", "1 s", "6 s"]
    print("Sag in mm:")
    shared.print_table(head, rows)


def draw(result: Result, folder: Path) -> Path:
    figure, axes = shared.new_figure(1, 2, height=5.0)
    fine = np.linspace(0, STOP, 6001)
    for (name, convection), colour in zip(STRANDS.items(), shared.COLOURS, strict=False):
        label = f"{convection:.0f} W/(m² K)"
        celsius = result.temperatures[name] - shared.ZERO_CELSIUS
        axes[0].plot(result.times, celsius, label=label, color=colour)
        axes[1].plot(result.times, result.sags[name] * 1e3, label=label, color=colour)
        axes[1].plot(fine, by_hand(name, fine) * 1e3, **shared.CLOSED_FORM)
    axes[0].axhline(SLOPE[2] - shared.ZERO_CELSIUS, color="0.7", linewidth=1)
    axes[0].annotate(
        "glass",
        (STOP, SLOPE[2] - shared.ZERO_CELSIUS),
        (-4, 4),
        textcoords="offset points",
        ha="right",
        color="0.4",
    )
    axes[0].set(xlabel="time / s", ylabel="temperature / °C", xlim=(0, STOP))
    axes[0].set_title("Both strands cool in the air")
    axes[0].legend(title="convection")
    axes[1].set(xlabel="time / s", ylabel="sag of the middle / mm", xlim=(0, STOP), ylim=(0, None))
    axes[1].set_title("They sag while hot, and shrink taut as they cool")
    axes[1].plot([], [], **shared.CLOSED_FORM, label="viscous beam without tension")
    axes[1].legend()
    figure.suptitle("A strand of polymer, 0.4 mm × 0.4 mm, is printed across a gap of 8 mm")
    return shared.save(figure, folder, NAME)


def main(given: list[str] | None = None) -> Result:
    options = shared.arguments(NAME, __doc__, given)
    result = simulate(options.fmu)
    report(result)
    draw(result, options.out)
    return result


if __name__ == "__main__":
    main()
