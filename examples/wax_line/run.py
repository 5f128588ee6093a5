"""A nozzle lays a bend of wax on glass: too high, braking, and with a flow that follows it."""

import shutil
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from matplotlib.collections import PolyCollection

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import paraview  # noqa: E402
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "wax_line"
CORNERS = np.array([[-14e-3, -8e-3], [10e-3, -8e-3], [10e-3, 10e-3]])  # m
SPEED, SLOW, ACCELERATION = 20e-3, 2e-3, 0.05  # m/s, m/s at corners, m/s²
SECTION = 0.45e-6  # m², of the strand
STEP, AFTER = 0.05, 1.5  # s, longest step, and time without flow in the end
READ = {
    "deviation": "ink.largest_deviation",
    "frozen": "ink.solid_fraction",
    "stress": "corner.max_principal",
    "heat": "ink.heat",
    "drift": "ink.heat_drift",
}


@dataclass(frozen=True)
class Plan:
    """A nozzle's height [m], whether it brakes at corners and the flow follows its speed."""

    title: str
    height: float = 0.7e-3
    brakes: bool = True
    follows: bool = True

    def flow(self, speed: float) -> float:
        """Volume flow at a speed along the path [m³/s]."""
        return SECTION * (speed if self.follows else SPEED)


PLANS = {
    "high": Plan("nozzle 3 mm high, even speed", height=3e-3, brakes=False),
    "brakes": Plan("low, brakes at the corner, even flow", follows=False),
    "follows": Plan("low, brakes, flow follows the speed"),
}


@dataclass(frozen=True)
class Piece:
    """A motion of constant acceleration: place, direction, speed, acceleration and duration."""

    place: np.ndarray
    along: np.ndarray
    speed: float
    acceleration: float
    duration: float

    def after(self, moment: float) -> "Piece":
        """Returns the motion that remains after a moment."""
        path = moment * (self.speed + 0.5 * self.acceleration * moment)
        return replace(
            self,
            place=self.place + path * self.along,
            speed=self.speed + self.acceleration * moment,
            duration=self.duration - moment,
        )


def pieces(plan: Plan) -> Iterator[Piece]:
    """The motion along all legs: at corners the nozzle is slow, or turns at full speed."""
    for begin, end in zip(CORNERS, CORNERS[1:], strict=False):
        length = np.hypot(*(end - begin))
        along = (end - begin) / length
        slow = SLOW if plan.brakes else SPEED
        ramp = (SPEED**2 - slow**2) / (2 * ACCELERATION)  # m
        durations = [(SPEED - slow) / ACCELERATION, (length - 2 * ramp) / SPEED]
        motions = [(slow, ACCELERATION), (SPEED, 0.0), (SPEED, -ACCELERATION)]
        place = begin
        for (speed, acceleration), duration in zip(
            motions, [*durations, durations[0]], strict=True
        ):
            piece = Piece(place, along, speed, acceleration, duration)
            place = piece.after(duration).place
            if duration > 0:
                yield piece


def steps(plan: Plan) -> Iterator[Piece]:
    """The motion in equal steps, none of which crosses a change of acceleration."""
    for piece in pieces(plan):
        count = int(np.ceil(piece.duration / STEP - 1e-9))
        for n in range(count):
            yield replace(piece.after(n * piece.duration / count), duration=piece.duration / count)


def drive(unit: Unit, plan: Plan, piece: Piece) -> None:
    """Sets place and flow at the beginning of a step, and their derivatives over it."""
    rates = {"ink.flow": [0.0, 0.0]}
    for name, place, along in zip("xy", piece.place, piece.along, strict=True):
        unit[f"ink.nozzle_{name}"] = place
        rates[f"ink.nozzle_{name}"] = [along * piece.speed, along * piece.acceleration]
    unit["ink.flow"] = plan.flow(piece.speed)
    if plan.follows:
        rates["ink.flow"] = [SECTION * piece.acceleration, 0.0]
    unit.set_input_derivatives(rates)


def simulate(fmu: Path, folder: Path, plan: Plan) -> dict[str, np.ndarray]:
    """Runs the unit by a plan, with ParaView files in a folder; readings over time."""
    shutil.rmtree(folder, ignore_errors=True)
    readings = {key: [] for key in ["time", *READ]}
    rest = Piece(CORNERS[-1], np.zeros(2), 0.0, 0.0, STEP)

    def read() -> None:
        readings["time"].append(unit.time)
        for key, name in READ.items():
            readings[key].append(unit[name])

    with Unit(fmu, parameters={"output.directory": str(folder)}) as unit:
        unit["ink.nozzle_z"] = plan.height
        for piece in steps(plan):
            drive(unit, plan, piece)
            unit.step(piece.duration)
            read()
        laid = unit["surface.temperature"]
        still = replace(plan, follows=True)
        for _ in range(round(AFTER / STEP)):
            drive(unit, still, rest)
            unit.step(STEP)
            read()
        totals = {key: unit[f"ink.{key}"] for key in ["width", "deviation", "gap", "volume"]}
    return {
        **{key: np.array(values) for key, values in readings.items()},
        "laid": np.asarray(laid) - shared.ZERO_CELSIUS,
        "totals": totals,
    }


def strand(folder: Path) -> dict[str, np.ndarray]:
    """The segments of the last ParaView file of a run."""
    return paraview.read(list(paraview.files(folder, "ink").values())[-1])


def widths(arrays: dict[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Distance along the strand and its width [mm]."""
    steps = np.linalg.norm(np.diff(arrays["position"][:, :2], axis=0), axis=1)
    return 1e3 * np.r_[0.0, np.cumsum(steps)], 1e3 * arrays["width"]


def outlines(arrays: dict[str, np.ndarray]) -> list[np.ndarray]:
    """Rectangles of the segments [mm]."""
    middle, width = 1e3 * arrays["position"][:, :2], 1e3 * arrays["width"]
    volume = 1e9 * arrays["mass"] / arrays["density"]
    length = volume / (width * 2e3 * arrays["position"][:, 2])
    along = np.gradient(middle, axis=0)
    along /= np.linalg.norm(along, axis=1)[:, None]
    across = np.c_[-along[:, 1], along[:, 0]]
    half_length, half_width = 0.5 * length[:, None] * along, 0.5 * width[:, None] * across
    corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    return list(np.stack([middle + i * half_length + j * half_width for i, j in corners], axis=1))


def draw(runs: dict, folder: Path, out: Path) -> Path:
    figure, axes = shared.new_figure(2, 3, height=7.2, height_ratios=[3, 2])
    for panel, (name, plan) in zip(axes[0], PLANS.items(), strict=True):
        image = shared.show_field(
            panel, runs[name]["laid"], (40.0, 30.0), cmap="inferno", vmin=20.0, vmax=45.0
        )
        style = {"facecolors": "none", "edgecolors": "white", "linewidths": 0.5}
        panel.add_collection(PolyCollection(outlines(strand(folder / name)), **style))
        panel.plot(*(1e3 * CORNERS.T), color="#59c3ff", linewidth=1.0, linestyle=(0, (4, 3)))
        panel.set(title=plan.title, xlim=(-16, 16), ylim=(-12, 12), xlabel="x / mm")
    axes[0, 0].set_ylabel("y / mm")
    shared.add_colour_bar(image, "glass at the end of the path / °C")
    for (name, plan), colour in zip(PLANS.items(), shared.COLOURS, strict=False):
        run = runs[name]
        axes[1, 0].plot(*widths(strand(folder / name)), color=colour, label=plan.title)
        axes[1, 1].plot(run["time"], run["stress"] * 1e-6, color=colour)
        axes[1, 2].plot(run["time"], run["frozen"] * 100, color=colour)
    axes[1, 0].legend(fontsize=9)
    axes[1, 0].set_ylim(bottom=0.0)
    titles = ["final width / mm", "tension of the glass at the corner / MPa", "frozen / %"]
    for panel, title in zip(axes[1], titles, strict=True):
        panel.set(title=title, xlabel="t / s")
    axes[1, 0].set_xlabel("along the strand / mm")
    return shared.save(figure, out, NAME)


def main(given: list[str] | None = None) -> dict:
    options = shared.arguments(NAME, __doc__, given)
    started = time.perf_counter()
    folder = options.out / "fields"
    runs = {name: simulate(options.fmu, folder / name, plan) for name, plan in PLANS.items()}
    print(f"three runs took {time.perf_counter() - started:.1f} s")
    shared.print_table(
        ["nozzle", "largest deviation", "largest width", "mean width", "gap", "frozen", "balance"],
        [
            [
                plan.title,
                f"{runs[name]['deviation'].max() * 1e3:.2f} mm",
                f"{widths(strand(folder / name))[1].max():.2f} mm",
                f"{runs[name]['totals']['width'] * 1e3:.2f} mm",
                f"{runs[name]['totals']['gap'] * 1e3:.2f} mm",
                f"{runs[name]['frozen'][-1] * 100:.0f} %",
                f"{abs(runs[name]['drift'][-1] / runs[name]['heat'][-1]):.0e}",
            ]
            for name, plan in PLANS.items()
        ],
    )
    draw(runs, folder, options.out)
    return runs


if __name__ == "__main__":
    main()
