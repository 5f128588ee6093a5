"""A motion planner's unit moves the nozzle of a filament: a stiff machine, and one that rings."""

import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import planner  # noqa: E402
import shared  # noqa: E402
from impinge import Master, Unit, gcode  # noqa: E402
from impinge.study.corrections import Line  # noqa: E402
from pythonfmu import FmuBuilder  # noqa: E402

NAME = "motion_planner"
HERE = Path(__file__).parent
SPEED, ACCELERATION, CORNER_SPEED = 0.1, 5.0, 8e-3  # m/s, m/s², m/s
FREQUENCY, DAMPING = 40.0, 0.05  # Hz of the axes
SECTION = 0.088e-6  # m² of the strand
STEP, AFTER = 1e-3, 0.02  # s, of the master, and at rest in the end
READ = ["touchdown_x", "touchdown_y", "last_width", "deviation", "largest_deviation", "volume"]
READ = [f"melt.{key}" for key in READ]
MACHINES = {
    "stiff": {"frequency": 0.0},
    "40 Hz": {"frequency": FREQUENCY},
    "40 Hz, shaped": {"frequency": FREQUENCY, "shaped": 1.0},
}
MOTION = planner.Motion(planner.DRAWING, SPEED, ACCELERATION, CORNER_SPEED)
DRAWING = Line(planner.DRAWING)


@dataclass(frozen=True)
class Strand:
    """Strand of a machine: readings over time, and the flow of its nozzle [m³/s]."""

    readings: dict[str, np.ndarray]
    flow: np.ndarray

    def of(self, key: str) -> np.ndarray:
        return self.readings[f"melt.{key}"]

    @property
    def touched(self) -> np.ndarray:
        return np.c_[self.of("touchdown_x"), self.of("touchdown_y")]

    @property
    def aside(self) -> tuple[np.ndarray, np.ndarray]:
        """Lengths along the drawing, and distances of the touchdown to its left [m]."""
        return DRAWING.beside(self.touched)

    @property
    def enlarged(self) -> np.ndarray:
        """The line of touchdown, its distances from the drawing ten times as large [m]."""
        along, distance = self.aside
        normal = DRAWING.along[DRAWING.part(along)] @ np.array([[0.0, 1.0], [-1.0, 0.0]])
        return DRAWING.at(along) + 10.0 * distance[:, None] * normal

    @property
    def even(self) -> np.ndarray:
        """Widths [m] of what is laid at full planned speed."""
        return self.of("last_width")[self.flow > 0.999 * SECTION * SPEED]


def lay(fmu: Path, machine: Path, settings: dict[str, float], order: int = 2) -> Strand:
    """The strand of a machine. Over a step the nozzle follows polynomials of the degree `order`
    through the planner's outputs; steps end where its velocity or acceleration jumps."""
    delays = [0.0]
    if settings.get("shaped"):
        delays = [delay for _, delay in planner.shaper(FREQUENCY, DAMPING)]
    stop = MOTION.end + max(delays) + AFTER
    motion = {"speed": SPEED, "acceleration": ACCELERATION, "corner_speed": CORNER_SPEED}
    master = Master(
        {"planner": machine, "melt": fmu},
        [
            ("planner.x", "melt.melt.nozzle_x"),
            ("planner.y", "melt.melt.nozzle_y"),
            ("planner.z", "melt.melt.nozzle_z"),
            ("planner.flow", "melt.melt.flow"),
        ],
        scheme="gauss-seidel",
        order=order,
        step=STEP,
        jumps=sorted({kink + delay for kink in MOTION.times for delay in delays} - {0.0}),
        outputs=[f"melt.{name}" for name in READ],
        parameters={
            "planner": {**motion, "damping": DAMPING, "section": SECTION, **settings},
        },
    )
    with master:
        table = master.run(stop, progress=False)
    readings = {name: table[f"melt.{name}"].values for name in READ}
    return Strand(readings, table["planner.flow"].values)


def by_code(folder: Path) -> Strand:
    """Lays the strand of the same motion as the unit itself plans it, from G-code."""
    places = np.c_[planner.DRAWING, np.full(len(planner.DRAWING), planner.HEIGHT)]
    times, volumes = DRAWING.ends / SPEED, np.diff(DRAWING.ends, prepend=0.0) * SECTION
    folder.mkdir(exist_ok=True)
    gcode.write(folder / "drawing.gcode", places, times, volumes)
    path = f'file = "drawing.gcode", acceleration = {ACCELERATION}, corner_speed = {CORNER_SPEED}'
    scene = folder / "coded.toml"
    text = (HERE / "scene.toml").read_text()
    scene.write_text(text.replace('path = "input"', f"path = {{ {path} }}"))
    rows, flows = [], []
    with Unit(scene) as unit:
        while unit.time < MOTION.end + AFTER:
            unit.step(STEP)
            rows.append(unit.get(READ))
            flows.append(SECTION * np.hypot(*MOTION.at(unit.time)[1]))
    return Strand(dict(zip(READ, np.transpose(rows), strict=True)), np.array(flows))


def report(strands: dict[str, Strand]) -> None:
    rows = []
    for name, strand in strands.items():
        last = [1e6 * strand.of(key)[-1] for key in ("largest_deviation", "deviation")]
        widths = [1e6 * strand.even.min(), 1e6 * strand.even.max()]
        volume = f"{1e9 * strand.of('volume')[-1]:.4f}"
        rows.append([name, *(f"{one:.1f}" for one in [*last, *widths]), volume])
    head = ["machine", "off at most / µm", "mean / µm", "narrowest / µm", "widest / µm", "mm³"]
    shared.print_table(head, rows)


def draw(strands: dict[str, Strand], folder: Path) -> Path:
    figure, axes = shared.new_figure(2, 2, height=8.0)
    drawing = 1e3 * np.array(planner.DRAWING)
    for (name, strand), colour in zip(strands.items(), shared.COLOURS, strict=False):
        width = 3.5 if name == "stiff" else 1.6
        style = {"color": colour, "linewidth": width, "label": name}
        axes[0, 0].plot(*(1e3 * strand.enlarged.T), **style)
        axes[0, 1].plot(*(1e3 * strand.touched.T), **style)
        along, distance = strand.aside
        axes[1, 0].plot(1e3 * along, 1e6 * distance, **style)
        axes[1, 1].plot(1e3 * along, 1e3 * strand.of("last_width"), **style)
    for panel in axes[0]:
        panel.plot(*drawing.T, **shared.CLOSED_FORM)
        panel.set(xlabel="x / mm", ylabel="y / mm", aspect="equal")
    axes[0, 0].set_title("Distances from the drawing (dashed) tenfold")
    axes[0, 1].set(xlim=(18.8, 20.5), ylim=(-0.25, 0.95), title="The corner of 90°")
    axes[0, 0].legend(loc="upper left")
    for panel in axes[1]:
        for end in DRAWING.ends[1:-1]:
            panel.axvline(1e3 * end, color="0.85", linewidth=1, zorder=0)
        panel.set(xlabel="along the drawing / mm")
    axes[1, 0].set(ylabel="to the left / µm", title="Distance from the drawing, corners in grey")
    axes[1, 1].set(ylabel="width / mm", ylim=(0.3, 0.6), title="Width of what is laid")
    return shared.save(figure, folder, NAME)


def main(given: list[str] | None = None) -> dict[str, Strand]:
    order = {
        "type": int,
        "default": 2,
        "help": "highest derivative that is sent [default: %(default)s]",
    }
    options = shared.arguments(NAME, __doc__, given, order=order)
    machine = Path(FmuBuilder.build_FMU(HERE / "planner.py", dest=options.out))
    begin = time.perf_counter()
    strands = {
        name: lay(options.fmu, machine, settings, options.order)
        for name, settings in MACHINES.items()
    }
    print(f"{len(strands)} strands took {time.perf_counter() - begin:.1f} s")
    report({"stiff, by G-code": by_code(options.out / "coded"), **strands})
    draw(strands, options.out)
    return strands


if __name__ == "__main__":
    main()
