"""Drops of water fall on hot glass again and again, and flaws grow while they are pulled."""

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "thermal_fatigue"
PERIOD = 5.0  # s
# Stress changes as a drop lands, and hardly later: steps grow with the time since [s].
TIMES = np.geomspace(2e-3, PERIOD, 40)
PLATES = [60.0, 80.0, 95.0]  # °C
EXPONENT, MODULUS = 16.0, 7.0  # of slow growth, of Weibull


@dataclass
class Result:
    times: np.ndarray  # s
    risks: np.ndarray  # B so far, and by the stress of the moment
    stress: np.ndarray  # Pa, largest principal

    def after_drops(self) -> np.ndarray:
        """Probability of failure after each drop."""
        return -np.expm1(-self.risks[len(TIMES) - 1 :: len(TIMES), 0])

    def without_water(self) -> np.ndarray:
        """The same if no flaw grew: of the worst moment."""
        present = self.risks[:, 1].reshape(-1, len(TIMES)).max(axis=1)
        return -np.expm1(-np.maximum.accumulate(present))


def simulate(fmu: Path, plate: float, drops: int) -> Result:
    kelvin = plate + shared.ZERO_CELSIUS
    names = ["plate.failure_risk", "plate.present_failure_risk", "plate.max_principal"]
    rows = []
    with Unit(fmu, parameters={"plate.initial_temperature": kelvin}) as unit:
        unit["plate.bottom.temperature"] = kelvin
        for drop in range(drops):
            unit["drop.release"] = drop + 1
            for time in TIMES:
                unit.step_to(drop * PERIOD + time)
                rows.append([unit.time, *unit.get(names)])
    rows = np.array(rows)
    return Result(rows[:, 0], rows[:, 1:3], rows[:, 3])


def report(results: dict[float, Result]):
    drops = len(results[PLATES[-1]].after_drops())
    shown = [drop for drop in (1, 2, 5, 10, 20) if drop <= drops]
    rows = []
    for plate, result in results.items():
        after, without = result.after_drops(), result.without_water()
        rows.append([f"{plate:.0f} °C", *(f"{after[drop - 1]:.1e}" for drop in shown)])
        rows[-1].append(f"{without[-1]:.1e}")
    heads = [f"P after {drop}" for drop in shown]
    shared.print_table(["plate", *heads, "without water"], rows)


def draw(results: dict[float, Result], folder: Path):
    figure, axes = shared.new_figure(1, 2, height=4.6)
    drops = 1 + np.arange(len(results[PLATES[-1]].after_drops()))
    for (plate, result), colour in zip(results.items(), shared.COLOURS, strict=False):
        first = result.times <= PERIOD
        label = f"{plate:.0f} °C"
        tension = result.stress[first] * 1e-6
        axes[0].semilogx(result.times[first], tension, color=colour, label=label)
        axes[1].loglog(drops, result.after_drops(), "o-", ms=3, color=colour, label=label)
        axes[1].loglog(drops, result.without_water(), "--", lw=1, color=colour)
    axes[0].set(xlabel="time since the drop / s", ylabel="largest tension / MPa")
    axes[0].set_title("A film pulls the skin that it cools")
    axes[0].legend(title="plate")
    axes[1].set(xlabel="drops", ylabel="probability of failure P")
    axes[1].set_title("Each drop adds to what the last has grown")
    guide = results[PLATES[-1]].after_drops()[0] * drops ** (MODULUS / (EXPONENT - 2.0))
    axes[1].loglog(drops, guide, color="0.6", lw=1)
    axes[1].text(drops[-1], 1.15 * guide[-1], "√N", color="0.4", ha="right")
    axes[1].plot([], [], "--", lw=1, color="0.4", label="no flaw grows")
    axes[1].legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    figure.suptitle("Water of 20 °C (2 mm, 0.7 m/s) on soda-lime glass, a drop every 5 s")
    shared.save(figure, folder, NAME)


def check(results: dict[float, Result]):
    """Risk never falls, water only adds to it, and the hotter plate is worse."""
    for result in results.values():
        after, without = result.after_drops(), result.without_water()
        assert np.all(np.diff(result.risks[:, 0]) >= 0), "the risk falls"
        assert np.all(after >= without * (1 - 1e-2)), "water takes cracks away"
    lasts = [result.after_drops()[-1] for result in results.values()]
    assert np.all(np.diff(lasts) > 0), "the colder plate is worse"
    # Equal drops grow flaws alike: B ∝ N^(m/(n − 2)) once growth is what counts.
    after = -np.log1p(-results[PLATES[-1]].after_drops())
    if len(after) >= 8:
        slope = np.log(after[-1] / after[len(after) // 2 - 1]) / np.log(2.0)
        assert abs(slope - MODULUS / (EXPONENT - 2.0)) < 0.1, slope


def main(given: list[str] | None = None):
    number = {"type": int, "default": 20, "help": "number of drops [default: %(default)s]"}
    options = shared.arguments(NAME, __doc__, given, drops=number)
    results = {plate: simulate(options.fmu, plate, options.drops) for plate in PLATES}
    report(results)
    check(results)
    draw(results, options.out)


if __name__ == "__main__":
    main()
