"""Concrete in a pressure cell: strength, softening and dilation by lateral pressure."""

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "concrete_cylinder"
RADIUS, HEIGHT = 50e-3, 50e-3  # m
PRESSURES = [0.0, 1e6, 5e6, 10e6, 20e6]  # Pa
STRAINS = [10e-3, 15e-3, 25e-3, 40e-3, 40e-3]  # at the end of each test
PRESSED = 0.1  # s, at which the lateral pressure is whole and the platen starts
STEP, STOP = 2e-3, 1.0  # s
A0, A1, A2 = 8.868e6, 0.4463, 2.693e-9  # of `strength` in the scene: Pa, 1, 1/Pa
OUTPUTS = ["cylinder.top.force_z", "cylinder.width", "cylinder.max_damage"]


@dataclass
class Test:
    pressure: float  # Pa
    strains: np.ndarray  # axial, compression positive
    stresses: np.ndarray  # Pa, of the platen on the present area
    dilations: np.ndarray  # change of volume over the volume
    damages: np.ndarray

    def strength(self) -> float:
        return self.stresses.max()


def press(unit: Unit, pressure: float, most: float) -> Test:
    rows = []
    for step in range(1, round(STOP / STEP) + 1):
        time = step * STEP
        shortened = most * HEIGHT * max(0.0, (time - PRESSED) / (STOP - PRESSED))
        unit["cylinder.sides.pressure"] = pressure * min(1.0, time / PRESSED)
        unit["cylinder.top.displacement_z"] = -shortened
        unit.step_to(time)
        rows.append([shortened / HEIGHT, *unit.get(OUTPUTS)])
    strains, forces, widths, damages = np.array(rows).T
    dilations = (widths / (2 * RADIUS)) ** 2 * (1 - strains) - 1
    started = round(PRESSED / STEP) - 1
    rows = [strains, -forces / (np.pi * (widths / 2) ** 2), dilations, damages]
    return Test(pressure, *[row[started:] for row in rows])


def simulate(fmu: Path) -> list[Test]:
    tests = []
    for pressure, most in zip(PRESSURES, STRAINS, strict=True):
        with Unit(fmu) as unit:
            tests.append(press(unit, pressure, most))
    return tests


def strength(lateral: np.ndarray) -> np.ndarray:
    """Axial stress at which the surface of the law is reached under a lateral pressure [Pa]."""
    low, high = np.array(lateral, float), np.array(lateral, float) + 1e9
    for _ in range(80):
        middle = (low + high) / 2
        mean = (middle + 2 * lateral) / 3
        fails = middle - lateral > A0 + mean / (A1 + A2 * mean)
        low, high = np.where(fails, low, middle), np.where(fails, middle, high)
    return low


def report(tests: list[Test]):
    rows = []
    for test in tests:
        peak = int(test.stresses.argmax())
        closed_form = float(strength(np.array(test.pressure)))
        values = [test.pressure * 1e-6, test.strength() * 1e-6, closed_form * 1e-6]
        row = [f"{value:.2f}" for value in values]
        row += [f"{test.strains[peak] * 100:.3f}", f"{test.stresses[-1] * 1e-6:.2f}"]
        rows.append([*row, f"{test.dilations[-1] * 100:+.2f}", f"{test.damages[-1]:.2f}"])
    header = ["lateral/MPa", "strength/MPa", "closed form/MPa", "at strain/%"]
    shared.print_table([*header, "stress left/MPa", "dilation/%", "damage"], rows)


def draw(tests: list[Test], folder: Path) -> Path:
    figure, axes = shared.new_figure(2, 2)
    for test, colour in zip(tests, shared.COLOURS, strict=True):
        named = {"color": colour, "label": f"{test.pressure * 1e-6:.0f} MPa"}
        percent = test.strains * 100
        axes[0, 0].plot(percent, test.stresses * 1e-6, **named)
        axes[1, 0].plot(percent, test.dilations * 100, **named)
        axes[1, 1].plot(percent, test.damages, **named)
    axes[0, 0].set(xlabel="axial strain / %", ylabel="axial stress / MPa", ylim=(0, None))
    axes[0, 0].set_title("Pressure makes concrete strong and tough")
    axes[0, 0].legend(title="lateral pressure", loc="lower right")
    draw_strengths(axes[0, 1], tests)
    axes[1, 0].axhline(0, color="0.7", linewidth=1)
    axes[1, 0].set(xlabel="axial strain / %", ylabel="change of volume / %")
    axes[1, 0].set_title("It is compacted, then dilates as it yields")
    axes[1, 1].set(xlabel="axial strain / %", ylabel="damage", ylim=(0, 1.05))
    axes[1, 1].set_title("Damage begins beyond the peak")
    figure.suptitle("A cylinder of concrete of 30 MPa between smooth platens in a pressure cell")
    return shared.save(figure, folder, NAME)


def draw_strengths(plot, tests: list[Test]):
    lateral = np.linspace(0, 22e6, 100)
    known = strength(lateral)
    plot.plot(lateral * 1e-6, known * 1e-6, **shared.CLOSED_FORM, label="surface of the law")
    tested = (known[0] + 4.1 * lateral) * 1e-6
    plot.plot(lateral * 1e-6, tested, color="0.6", label="Richart et al. 1929: $f_c + 4.1\\,p$")
    for test, colour in zip(tests, shared.COLOURS, strict=True):
        plot.plot(test.pressure * 1e-6, test.strength() * 1e-6, "o", color=colour)
    plot.set(xlabel="lateral pressure / MPa", ylabel="strength / MPa", ylim=(0, None))
    plot.set_title("Peaks are those of the surface")
    plot.legend(loc="lower right")


def main(given: list[str] | None = None) -> list[Test]:
    options = shared.arguments(NAME, __doc__, given)
    tests = simulate(options.fmu)
    report(tests)
    draw(tests, options.out)
    return tests


if __name__ == "__main__":
    main()
