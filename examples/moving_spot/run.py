"""A laser spot runs a figure of eight on alumina: temperature against a closed form, and stress."""

import sys
import time
from dataclasses import dataclass
from math import pi, sqrt
from pathlib import Path

import numpy as np
from matplotlib.animation import FuncAnimation, PillowWriter

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import shared  # noqa: E402
from impinge import Unit  # noqa: E402
from shared import plt  # noqa: E402

NAME = "moving_spot"
STOP, STEPS = 6e-3, 240  # s; a step moves the spot by a sixteenth of its radius
FRAMES = 60  # of the moving picture; a stress costs a solve, and only when it is read
FRAME_COUNTS = [count for count in range(8, STEPS + 1) if STEPS % count == 0]
GRID, SIZE = (32, 20), (1.6, 1.0)  # points, mm: the field of the scene

# Alumina, as in scene.toml
CONDUCTIVITY, DIFFUSIVITY, COLD = 10.0, 10.0 / (3950.0 * 900.0), 20.0  # W/(m K), m²/s, °C
STRENGTH = 300e6  # Pa, tensile, of a good alumina

PEAK_FLUX, SPOT_RADIUS = 80e6, 200e-6  # W/m², m (1/e²)
HALF_WIDTH = 0.5e-3  # m, of the path
TEMPERATURE = plt.get_cmap("inferno", 20)  # steps of colour show isotherms, and pack well
WIDTH = SPOT_RADIUS / sqrt(2)  # m (1/e)
NODES, WEIGHTS = np.polynomial.legendre.leggauss(120)


def eight() -> tuple[np.ndarray, np.ndarray]:
    """The path (x, y) [m] at many equal distances: x = a sin φ, y = a sin φ cos φ.

    It begins at the right end, and crosses itself after a quarter and three quarters.
    """
    angle = np.linspace(0.5 * pi, 2.5 * pi, 20001)
    points = HALF_WIDTH * np.array([np.sin(angle), np.sin(angle) * np.cos(angle)])
    length = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(points)))])
    share = np.linspace(0, 1, 5001)
    return share, np.array([np.interp(share * length[-1], length, xy) for xy in points])


SHARE, PATH = eight()
SPEED = np.hypot(*np.diff(PATH)).sum() / STOP  # m/s


def place(t):
    """Centre of the spot at a time, at constant speed along the path [m]."""
    return np.array([np.interp(t / STOP, SHARE, xy) for xy in PATH])


def exact_rise(x, y, t: float):
    """Temperature rise of the surface of a half space [K] under the spot on its path.

    A time τ ago the spot left heat that has since spread to the width √(W² + 4aτ) (H. E. Cline and
    T. R. Anthony 1977, doi 10.1063/1.324261). With √(4aτ) = W tan φ the integral over the past is
    smooth: q₀W/(k√π) ∫ exp(−|x − p(t − τ)|² cos²φ / W²) dφ.
    """
    end = np.arctan(sqrt(4 * DIFFUSIVITY * t) / WIDTH)
    angles = 0.5 * end * (NODES + 1)
    past_x, past_y = place(t - (WIDTH * np.tan(angles)) ** 2 / (4 * DIFFUSIVITY))
    square = (np.asarray(x)[..., None] - past_x) ** 2 + (np.asarray(y)[..., None] - past_y) ** 2
    integral = np.exp(-square * (np.cos(angles) / WIDTH) ** 2) @ WEIGHTS * 0.5 * end
    return PEAK_FLUX * WIDTH / (CONDUCTIVITY * sqrt(pi)) * integral


@dataclass
class Result:
    step_times: np.ndarray  # s, ends of steps
    crossing: np.ndarray  # °C, where the path crosses itself
    exact_crossing: np.ndarray
    times: np.ndarray  # s, those at which the rest was read
    fields: np.ndarray  # °C, of the surface
    exact_fields: np.ndarray
    hottest: np.ndarray  # °C, of the body
    von_mises: np.ndarray  # Pa, of the surface
    crossing_stress: np.ndarray  # Pa, σ_xx
    highest_principal: np.ndarray  # Pa, of the body
    heat_balance: float  # relative


def simulate(fmu: Path, frames: int) -> Result:
    step_times = STOP * np.arange(1, STEPS + 1) / STEPS
    read_every = STEPS // frames
    times = step_times[read_every - 1 :: read_every]
    scalars = ["plate.max_temperature", "crossing.stress_xx", "plate.max_principal"]
    crossing, values, fields, von_mises = [], [], [], []
    with Unit(fmu) as unit:
        unit.set({"spot.heat_flux": PEAK_FLUX})
        for step, t in enumerate(step_times, start=1):
            x, y = place(0.5 * (unit.time + t))  # it stands still during a step
            unit.set({"spot.x": x, "spot.y": y})
            unit.step_to(t)
            crossing.append(unit["crossing.temperature"])
            if step % read_every == 0:
                values.append(unit.get(scalars))
                fields.append(unit["surface.temperature"])
                von_mises.append(unit["surface.von_mises"])
        brought, stored, lost = unit.get(["plate.heat_in", "plate.heat_stored", "plate.heat_lost"])
    hottest, stress, highest = np.array(values).T
    x, y = np.meshgrid(*points(), indexing="ij")
    return Result(
        step_times,
        np.array(crossing) - shared.ZERO_CELSIUS,
        np.array([COLD + exact_rise(0.0, 0.0, t) for t in step_times]),
        times,
        np.array(fields) - shared.ZERO_CELSIUS,
        np.array([COLD + exact_rise(x, y, t) for t in times]),
        hottest - shared.ZERO_CELSIUS,
        np.array(von_mises),
        stress,
        highest,
        abs(brought - stored - lost) / brought,
    )


def points() -> list[np.ndarray]:
    """Coordinates of the grid of the field [m]: the middles of equal cells."""
    return [
        1e-3 * size * ((np.arange(count) + 0.5) / count - 0.5)
        for size, count in zip(SIZE, GRID, strict=True)
    ]


def report(result: Result):
    rows = []
    eighth = len(result.times) // 8
    read_every = STEPS // len(result.times)
    for i in range(eighth - 1, len(result.times), eighth):
        step = (i + 1) * read_every - 1
        error = np.abs(result.fields[i] - result.exact_fields[i]).max()
        values = [result.crossing[step], result.exact_crossing[step], error, result.hottest[i]]
        values += [result.crossing_stress[i] / 1e6, result.highest_principal[i] / 1e6]
        rows.append([f"{result.times[i] * 1e3:.2f}"] + [f"{value:.1f}" for value in values])
    head = ["t/ms", "crossing/°C", "closed", "worst of field/K", "hottest/°C"]
    shared.print_table([*head, "σ_xx/MPa", "largest principal/MPa"], rows)
    print(f"speed {SPEED:.2f} m/s, power {PEAK_FLUX * pi * WIDTH**2:.2f} W;", end=" ")
    print(f"heat balance to {result.heat_balance:.0e}")


def draw(result: Result, folder: Path) -> Path:
    figure, axes = shared.new_figure(2, 3, height=6.6, height_ratios=[1, 1.25])
    shown = [int(np.argmin(abs(result.times - t))) for t in (1.5e-3, 3.0e-3, 4.5e-3)]
    top = result.fields.max()
    for plot, i in zip(axes[0], shown, strict=True):
        image, _ = draw_surface(plot, result.fields[i], result.times[i], TEMPERATURE, (COLD, top))
        x, y = (1e3 * axis for axis in points())
        levels = [60, 120, 180, 240]
        exact = result.exact_fields[i].T
        plot.contour(x, y, exact, levels, colors="white", linestyles="--", linewidths=1)
        plot.set_title(f"{result.times[i] * 1e3:.1f} ms, hottest {result.hottest[i]:.0f} °C")
    shared.add_colour_bar(image, "temperature / °C")
    draw_crossing(axes[1, 0], result)
    i = shown[-1]
    stress = result.von_mises[i] / 1e6
    image, _ = draw_surface(axes[1, 1], stress, result.times[i], "viridis", (0, stress.max()))
    shared.add_colour_bar(image, "MPa")
    axes[1, 1].set_title(f"{result.times[i] * 1e3:.1f} ms, von Mises stress")
    draw_stress(axes[1, 2], result)
    figure.suptitle(
        f"A spot of {PEAK_FLUX * pi * WIDTH**2:.0f} W runs a figure of eight on alumina at "
        f"{SPEED:.1f} m/s: unit in colour, closed form dashed"
    )
    return shared.save(figure, folder, NAME)


def draw_surface(plot, values, t: float, colours, limits: tuple[float, float]):
    """A field of the surface with the path and the spot."""
    low, high = limits
    image = shared.show_field(plot, values, SIZE, cmap=colours, vmin=low, vmax=high)
    plot.plot(*(1e3 * PATH), color="0.6", linewidth=0.8)
    circle = plot.plot(*circle_around(t), color="cyan", linewidth=1.2)[0]
    plot.set(xlabel="x / mm", ylabel="y / mm", xticks=[-0.5, 0, 0.5], yticks=[-0.4, 0, 0.4])
    return image, circle


def circle_around(t: float) -> np.ndarray:
    """Outline of the spot [mm]."""
    angle = np.linspace(0, 2 * pi, 60)
    return 1e3 * (place(t)[:, None] + SPOT_RADIUS * np.array([np.cos(angle), np.sin(angle)]))


def draw_crossing(plot, result: Result):
    times = 1e3 * result.step_times
    plot.plot(times, result.crossing, label="unit")
    plot.plot(times, result.exact_crossing, **shared.CLOSED_FORM, label="closed form")
    first, second = np.split(result.crossing, 2)
    plot.set(xlabel="time / ms", ylabel="crossing / °C", ylim=(0, 380))
    plot.set_title(f"The second pass gets {second.max() - first.max():.0f} K hotter")
    plot.legend(loc="upper left", ncols=2)


def draw_stress(plot, result: Result):
    times = 1e3 * result.times
    plot.plot(times, result.crossing_stress / 1e6)
    plot.plot(times, result.highest_principal / 1e6)
    plot.axhline(0, color="0.8", linewidth=0.8, zorder=0)
    plot.axhline(STRENGTH / 1e6, color="0.7", linewidth=1)
    plot.text(0, STRENGTH / 1e6 + 15, "tensile strength", color="0.45")
    plot.text(0, 85, "largest tension, 0.1 mm deep", color=shared.COLOURS[1])
    name = "$\\sigma_{xx}$ at\nthe crossing"
    plot.text(2.1, -330, name, color=shared.COLOURS[0], va="top")
    plot.set(xlabel="time / ms", ylabel="stress / MPa", ylim=(None, 390))
    plot.set_title("Pressed hard, pulled little")


def animate(result: Result, folder: Path):
    """A moving picture of the temperature."""
    figure, plot = plt.subplots(figsize=(5.6, 3.2), layout="constrained")
    limits = (COLD, result.fields.max())
    image, circle = draw_surface(plot, result.fields[0], 0.0, TEMPERATURE, limits)
    shared.add_colour_bar(image, "temperature / °C")

    def show(i: int):
        image.set_data(result.fields[i].T)
        circle.set_data(*circle_around(result.times[i]))
        plot.set_title(f"{result.times[i] * 1e3:.1f} ms", loc="left")

    # All frames have the layout of the first.
    show(0)
    figure.canvas.draw()
    figure.set_layout_engine("none")
    path = folder / f"{NAME}.gif"
    moving = FuncAnimation(figure, show, frames=len(result.times))
    moving.save(path, PillowWriter(fps=15), dpi=80)
    plt.close(figure)
    print(f"picture: {path}")


def main(given: list[str] | None = None) -> Result:
    frames = {"type": int, "default": FRAMES, "choices": FRAME_COUNTS, "metavar": "N"}
    frames["help"] = "of the moving picture, a divisor of 240, at least 8 [default: %(default)s]"
    options = shared.arguments(NAME, __doc__, given, frames=frames)
    started = time.perf_counter()
    result = simulate(options.fmu, options.frames)
    print(f"{STEPS} steps in {time.perf_counter() - started:.1f} s")
    report(result)
    draw(result, options.out)
    animate(result, options.out)
    return result


if __name__ == "__main__":
    main()
