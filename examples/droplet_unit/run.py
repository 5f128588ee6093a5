"""A drop's unit above a wall that this program models: alumina that warms up ring by ring."""

import sys
import time
from dataclasses import dataclass, field
from math import pi, sqrt
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import shared  # noqa: E402
from impinge import Unit  # noqa: E402
from matplotlib.colors import PowerNorm  # noqa: E402

NAME = "droplet_unit"
STOP, STEP = 3.5e-6, 5e-8  # s
RINGS, RADIUS = 30, 150e-6  # m, as in scene.toml
DIAMETER, SPEED = 0.1e-3, 50.0  # m, m/s
HOT, COLD = 373.15, 293.15  # K
EFFUSIVITY = sqrt(10.0 * 3950.0 * 900.0)  # W √s/(m² K), of alumina

EDGES = np.linspace(0, RADIUS, RINGS + 1)
AREAS = pi * np.diff(EDGES**2)
SPAN, WIDE = 4, 2  # steps and rings of a mean that is drawn
SCALARS = [
    "drop.spread_diameter",
    "drop.height",
    "drop.kinetic_energy",
    "drop.compression_energy",
    "drop.heat",
    "drop.heat_flow",
    "drop.force",
    "drop.impulse_z",
    "drop.momentum_z",
]


class HalfSpaces:
    """A half space of alumina under each ring, whose flux is held over each step.

    A flux q that begins at t' warms the surface by 2 q √((t − t')/π)/e (H. S. Carslaw and
    J. C. Jaeger, Conduction of Heat in Solids, Oxford 1959, §2.9).
    """

    def __init__(self):
        self.starts, self.jumps = [], []
        self.flux = np.zeros(RINGS)

    def add(self, start: float, flux: np.ndarray):
        self.starts.append(start)
        self.jumps.append(flux - self.flux)
        self.flux = flux

    def temperature(self, t: float) -> np.ndarray:
        since = np.sqrt((t - np.array(self.starts)) / pi)
        return COLD + 2 / EFFUSIVITY * since @ np.array(self.jumps)


@dataclass
class Result:
    times: list[float] = field(default_factory=list)  # s, ends of steps
    scalars: list[np.ndarray] = field(default_factory=list)  # in the order of SCALARS
    fluxes: list[np.ndarray] = field(default_factory=list)  # W/m² of each ring
    pressures: list[np.ndarray] = field(default_factory=list)  # Pa of each ring
    surface: list[np.ndarray] = field(default_factory=list)  # K of each ring
    outside: float = 0.0  # J that went beyond the rings
    momentum: float = 0.0  # kg m/s along z in the beginning

    def freeze(self):
        for name in ("times", "scalars", "fluxes", "pressures", "surface"):
            setattr(self, name, np.array(getattr(self, name)))

    def history(self, name: str) -> np.ndarray:
        return self.scalars[:, SCALARS.index(name)]


def simulate(fmu: Path) -> Result:
    result, wall = Result(), HalfSpaces()
    with Unit(fmu) as unit:
        result.momentum = unit["drop.momentum_z"]
        for step in range(round(STOP / STEP)):
            start = unit.time
            unit.step_to((step + 1) * STEP)
            flux = unit["wall.heat_flux"]
            wall.add(start, flux)
            surface = wall.temperature(unit.time)
            unit["wall.temperature"] = surface
            result.times.append(unit.time)
            result.fluxes.append(flux)
            result.surface.append(surface)
            result.pressures.append(unit["wall.pressure"])
            result.scalars.append(unit.get(SCALARS))
            result.outside += STEP * unit["wall.heat_flow_outside"]
    result.freeze()
    return result


def report(result: Result):
    rows = []
    for t in [0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 3.5]:
        step = round(t * 1e-6 / STEP) - 1
        values = [
            result.history("drop.spread_diameter")[step] / DIAMETER,
            result.history("drop.height")[step] / DIAMETER,
            result.pressures[step, 0] / 1e6,
            result.history("drop.force")[step] * 1e3,
            result.fluxes[step, 0] / 1e6,
            result.surface[step, 0] - shared.ZERO_CELSIUS,
        ]
        rows.append([f"{t:g}"] + [f"{value:.3f}" for value in values])
    head = ["t/µs", "spread/D", "height/D", "p/MPa", "force/mN", "q/(MW/m²)", "wall/°C"]
    shared.print_table(head, rows)
    given = STEP * (result.fluxes @ AREAS).sum() + result.outside
    heat = result.history("drop.heat")[-1]
    print(f"heat of all rings and beyond {given * 1e6:.6f} µJ = drop's to {given / heat - 1:.0e}")
    lost = result.momentum - result.history("drop.momentum_z")[-1]
    impulse = result.history("drop.impulse_z")[-1]
    print(f"impulse of the wall {impulse:.4e} N s = momentum lost to {impulse / lost - 1:.0e}")


def draw(result: Result, folder: Path) -> Path:
    figure, axes = shared.new_figure(2, 3, height=7.2)
    cooled = result.fluxes / 1e6, "heat flux / (MW/m²)", "inferno"
    pressed = result.pressures / 1e6, "pressure / MPa", "viridis"
    warmed = result.surface - COLD, "rise of the wall / K", "magma"
    for plot, (values, label, colours), title in zip(
        axes[0],
        (cooled, pressed, warmed),
        ("Heat goes where the rim runs", "The blow is at the centre", "The wall is warm at once"),
        strict=True,
    ):
        draw_rings(plot, result, values, label, colours)
        plot.set_title(title)
    draw_shape(axes[1, 0], result)
    draw_momentum(axes[1, 1], result)
    draw_energy(axes[1, 2], result)
    figure.suptitle(
        f"A drop of {DIAMETER * 1e6:.0f} µm and 100 °C hits a wall at {SPEED:.0f} m/s "
        f"(means over {SPAN * STEP * 1e6:g} µs and {RADIUS / RINGS * WIDE * 1e6:g} µm of radius)"
    )
    return shared.save(figure, folder, NAME)


def draw_rings(plot, result: Result, values: np.ndarray, label: str, colours: str):
    """Values over time and radius, averaged: a ring is as wide as a particle."""
    steps, rings = len(values) // SPAN * SPAN, RINGS // WIDE
    by_area = (values * AREAS)[:steps].reshape(-1, SPAN, rings, WIDE).sum(axis=(1, 3))
    means = np.clip(by_area / SPAN / AREAS.reshape(rings, WIDE).sum(axis=1), 0.0, None)
    times = np.concatenate([[0], result.times[:steps]])[::SPAN] * 1e6
    norm = PowerNorm(0.5, 0.0, means.max())
    mesh = plot.pcolormesh(times, EDGES[::WIDE] * 1e6, means.T, norm=norm, cmap=colours)
    plot.plot(result.times * 1e6, rim(result) * 1e6, color="white", linewidth=1.2, linestyle=":")
    plot.figure.colorbar(mesh, ax=plot, label=label)
    plot.set(xlabel="time / µs", ylabel="radius / µm", ylim=(0, RADIUS * 1e6))
    plot.set_xlim(0, times[-1])


def rim(result: Result) -> np.ndarray:
    """Radius that the drop has wetted so far [m]."""
    return np.maximum.accumulate(result.history("drop.spread_diameter")) / 2


def draw_shape(plot, result: Result):
    times = result.times * 1e6
    plot.plot(times, result.history("drop.spread_diameter") / DIAMETER, label="spread diameter")
    plot.plot(times, result.history("drop.height") / DIAMETER, label="height")
    plot.set(xlabel="time / µs", ylabel="over the drop's diameter", ylim=(0, None))
    plot.set_title("The drop becomes a lamella")
    plot.legend()


def draw_momentum(plot, result: Result):
    """Impulse of the wall, which is smooth where forces swing with the waves of sound."""
    came = abs(result.momentum) * 1e9
    plot.plot(
        result.times * 1e6, np.abs(result.history("drop.impulse_z")) * 1e9, label="the wall's"
    )
    plot.axhline(came, **shared.CLOSED_FORM, label="that of the drop as it came")
    plot.set(xlabel="time / µs", ylabel="impulse / (nN s)", ylim=(0, 1.35 * came))
    plot.set_title("The wall stops it within 2 µs")
    plot.legend(loc="upper left")


def draw_energy(plot, result: Result):
    """Kinetic energy on the left axis, heat, twenty times as much, on the right one."""
    times = result.times * 1e6
    heat = plot.twinx()
    for axes, values, label, colour in (
        (plot, result.history("drop.kinetic_energy") * 1e9, "kinetic energy / nJ", 0),
        (heat, result.history("drop.heat") * 1e6, "heat given to the wall / µJ", 1),
    ):
        axes.plot(times, values, color=shared.COLOURS[colour])
        axes.set_ylabel(label, color=shared.COLOURS[colour])
        axes.tick_params(axis="y", colors=shared.COLOURS[colour])
        axes.set_ylim(0, None)
    heat.spines.right.set_visible(True)
    plot.set(xlabel="time / µs")
    plot.set_title("It slows down, and gives heat")


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
