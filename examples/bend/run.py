"""Three bends of ink from a high nozzle: along the drawing, and along the best path found."""

import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import shared  # noqa: E402
from impinge import Unit  # noqa: E402
from impinge.study import FoundPath, path  # noqa: E402

NAME = "bend"
SPEED = 20e-3  # m/s
DIAMETER = 0.7  # mm


def hairpin(radius: float, leg: float = 12e-3) -> np.ndarray:
    """Two legs and the half circle between them [m]."""
    angles = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 25)
    arc = np.c_[leg + radius * np.cos(angles), radius + radius * np.sin(angles)]
    return np.vstack([[0.0, 0.0], arc, [0.0, 2 * radius]])


DRAWINGS = {
    "corner of 90°": np.array([[0.0, 0.0], [12e-3, 0.0], [12e-3, 12e-3]]),
    "narrow hairpin": hairpin(1.5e-3),
    "wide hairpin": hairpin(4e-3),
}
# The nozzle may leave the drawing between these parts of its length.
REGIONS = {
    "corner of 90°": (0.3, 0.95),
    "narrow hairpin": (0.2, 0.8),
    "wide hairpin": (0.2, 0.85),
}


def lay(unit: Unit, found: FoundPath, places: np.ndarray) -> np.ndarray:
    """Places of touchdown [m] of a nozzle that moves evenly between places, from time zero."""
    steps = np.hypot(*np.diff(places, axis=0).T)
    touched = []
    unit.reset()
    unit["ink.nozzle_z"] = found.height
    unit["ink.flow"] = found.flow
    for place, after, length in zip(places, places[1:], steps, strict=False):
        duration = length / SPEED
        for axis, name in enumerate(["ink.nozzle_x", "ink.nozzle_y"]):
            unit[name] = place[axis]
            unit.set_input_derivatives({name: [(after[axis] - place[axis]) / duration, 0.0]})
        unit.step(duration)
        touched.append(unit.get(["ink.touchdown_x", "ink.touchdown_y"]))
    return np.array(touched)


def draw(fmu: Path, found: dict[str, FoundPath], out: Path) -> Path:
    figure, axes = shared.new_figure(2, 3, height=7.6)
    with Unit(fmu) as unit:
        for column, (name, best) in enumerate(found.items()):
            drawing = DRAWINGS[name]
            tried = [(best.along, best.naive), (best.places, best.best)]
            for panel, (places, one) in zip(axes[:, column], tried, strict=True):
                width = 72 * 0.9 * DIAMETER / 4.0
                style = {"solid_capstyle": "round", "solid_joinstyle": "round"}
                touched = 1e3 * lay(unit, best, places)
                panel.plot(*touched.T, color="#9ec3e6", linewidth=width, **style)
                panel.plot(*touched.T, color=shared.COLOURS[0], linewidth=1.0)
                panel.plot(*(1e3 * drawing.T), color="black", linewidth=1.2, linestyle=(0, (4, 3)))
                panel.plot(*(1e3 * places.T), color=shared.COLOURS[1], linewidth=1.0)
                panel.set(title=f"{name}: {1e3 * one.largest / DIAMETER:.2f} D off at most")
                panel.set_aspect("equal")
                panel.set(xlim=(-1, 19), ylim=(-3, 13) if column != 1 else (-6.5, 9.5))
    for panel, title in zip(axes[:, 0], ["along the drawing", "best path"], strict=True):
        panel.set_ylabel(f"{title}\ny / mm")
    for panel in axes[1]:
        panel.set_xlabel("x / mm")
    return shared.save(figure, out, NAME)


def main(given: list[str] | None = None) -> dict[str, FoundPath]:
    search = {"default": "gauss-newton", "choices": ["gauss-newton", "cma", "swarm"]}
    count = {"type": int, "default": 100, "help": "runs for each bend [default: %(default)s]"}
    options = shared.arguments(NAME, __doc__, given, by=search, simulations=count)
    found, rows = {}, []
    for name, drawing in DRAWINGS.items():
        began = time.perf_counter()
        best = path(
            options.fmu,
            drawing,
            by=options.by,
            speed=SPEED,
            waypoints=6,
            region=REGIONS[name],
            simulations=options.simulations,
            folder=options.out / "runs" / options.by / name.replace(" ", "_"),
        )
        seconds = time.perf_counter() - began
        found[name] = best
        best.write_gcode(options.out / f"{name.replace(' ', '_')}.gcode")
        diameters = [1e3 * one / DIAMETER for one in (best.naive.largest, best.best.largest)]
        rows.append(
            [name, *(f"{one:.2f} D" for one in diameters)]
            + [f"{best.ratio:.1f}", f"{best.simulations}", f"{seconds:.1f} s"]
        )
    head = ["drawing", "off along it", "best path", "objective over best", "runs", "time"]
    shared.print_table(head, rows)
    draw(options.fmu, found, options.out)
    return found


if __name__ == "__main__":
    main()
