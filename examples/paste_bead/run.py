"""A nozzle draws a bead of paste round a corner: as particles, and as a line of segments."""

import shutil
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.collections import PolyCollection

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import paraview  # noqa: E402
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "paste_bead"
CORNERS = np.array([[-8e-3, 0.0], [0.0, 0.0], [0.0, 8e-3]])  # m
DIAMETER, SPACING, HEIGHT = 1e-3, 0.2e-3, 0.8e-3  # m, of the nozzle, of particles, of the outlet
LEG = 8e-3  # m
STATION, BEND = 0.4e-3, 1.2e-3  # m, between sections, and from the corner to the nearest
NAMES = ["bead", "line"]


@dataclass
class Strand:
    """Sections over the path of the nozzle: place along it [m], width [m], area [m²]."""

    along: np.ndarray
    width: np.ndarray
    area: np.ndarray


def simulate(fmu: Path, folder: Path, steps: int | None) -> dict[str, dict[str, float]]:
    """Runs the unit with ParaView files in a folder; the last readings of both strands."""
    shutil.rmtree(folder, ignore_errors=True)
    keys = ["width", "height", "largest_deviation", "deviation", "volume"]
    with Unit(fmu, parameters={"output.directory": str(folder)}) as unit:
        step = unit.default_step
        for _ in range(steps or round(unit.default_stop / step)):
            unit.step(step)
        return {name: {key: unit[f"{name}.{key}"] for key in keys} for name in NAMES}


def last(folder: Path, body: str) -> dict[str, np.ndarray]:
    """The arrays of the last ParaView file of a body."""
    return paraview.read(list(paraview.files(folder, body).values())[-1])


def along_path(places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distances along the path of the nozzle and across it [m], of the leg on its side of the
    corner's bisector."""
    x, y = places[:, 0], places[:, 1]
    first = x + y < 0.0
    return np.where(first, LEG + x, LEG + y), np.where(first, y, -x)


def of_particles(arrays: dict[str, np.ndarray]) -> Strand:
    """Sections of all fluid below the outlet, from station to station."""
    laid = arrays["position"][:, 2] < HEIGHT
    places = arrays["position"][laid]
    volume = (arrays["mass"] / arrays["density"])[laid]
    along, across = along_path(places)
    ends = np.arange(-0.5, 2 * LEG / STATION + 1.5) * STATION
    which = np.digitize(along, ends) - 1
    rows = []
    for n in range(len(ends) - 1):
        own, middle = which == n, 0.5 * (ends[n] + ends[n + 1])
        if own.sum() >= 3:
            row = [middle, np.ptp(across[own]) + SPACING, volume[own].sum() / STATION]
            rows.append([middle, np.nan, np.nan] if abs(middle - LEG) < BEND else row)
    return Strand(*np.array(rows).T)


def of_line(arrays: dict[str, np.ndarray]) -> Strand:
    """Sections of the segments."""
    along, _ = along_path(arrays["position"])
    area = arrays["width"] * 2.0 * arrays["position"][:, 2]
    order = np.argsort(along)
    return Strand(along[order], arrays["width"][order], area[order])


def outlines(arrays: dict[str, np.ndarray]) -> list[np.ndarray]:
    """Rectangles of the segments of a line [mm]."""
    middle, width = 1e3 * arrays["position"][:, :2], 1e3 * arrays["width"]
    volume = 1e9 * arrays["mass"] / arrays["density"]
    length = volume / (width * 2e3 * arrays["position"][:, 2])
    direction = np.gradient(middle, axis=0)
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    half_length = 0.5 * length[:, None] * direction
    half_width = 0.5 * width[:, None] * np.c_[-direction[:, 1], direction[:, 0]]
    corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    return list(np.stack([middle + i * half_length + j * half_width for i, j in corners], axis=1))


def draw_in_space(figure, place, arrays: dict[str, np.ndarray]):
    """All particles in space, as balls that those before them hide, coloured by their height."""
    axes = figure.add_subplot(place, projection="3d")
    x, y, z = 1e3 * arrays["position"].T
    axes.scatter(x, y, z, c=z, cmap="viridis", s=20, edgecolors="black", linewidths=0.15)
    axes.set_box_aspect((np.ptp(x), np.ptp(y), np.ptp(z)), zoom=1.0)
    axes.view_init(elev=32, azim=-62)
    axes.set(xlabel="x / mm", ylabel="y / mm", zticks=[0, 1, 2])
    axes.set_title("Particles, with the column in the nozzle", y=0.98)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.pane.set_facecolor("white")
    axes.grid(False)


def draw_from_above(axes, particles: dict, segments: dict):
    laid = particles["position"][:, 2] < HEIGHT
    x, y, z = 1e3 * particles["position"][laid].T
    order = np.argsort(z)
    axes.scatter(x[order], y[order], c=z[order], cmap="viridis", s=14, linewidths=0)
    edges = {"facecolors": "none", "edgecolors": shared.COLOURS[1], "linewidths": 0.7}
    axes.add_collection(PolyCollection(outlines(segments), **edges))
    axes.plot(*(1e3 * CORNERS.T), **shared.CLOSED_FORM)
    axes.set(xlabel="x / mm", ylabel="y / mm", aspect="equal")
    axes.set_title("From above: particles, line (red), nozzle's path")


def draw_section(axes, particles: dict, line: Strand):
    """A section across the middle of the first leg."""
    x, y, z = 1e3 * particles["position"].T
    own = np.abs(x + 0.5e3 * LEG) < 1e3 * SPACING
    axes.scatter(y[own], z[own], s=70, color=shared.COLOURS[0], alpha=0.75, linewidths=0)
    n = np.argmin(np.abs(line.along - 0.5 * LEG))
    width, height = 1e3 * line.width[n], 1e3 * line.area[n] / line.width[n]
    sides, tops = 0.5 * width * np.array([-1, -1, 1, 1]), height * np.array([0, 1, 1, 0])
    axes.plot(sides, tops, color=shared.COLOURS[1])
    axes.axhline(0.0, color="0.5", linewidth=1)
    axes.set(xlabel="across / mm", ylabel="z / mm", aspect="equal", ylim=(-0.1, 1.1))
    axes.set_title("Section in the middle of the first leg")


def draw(particles: dict, segments: dict, strands: dict[str, Strand], folder: Path) -> Path:
    figure, axes = shared.new_figure(2, 2, height=8.4, gridspec_kw={"height_ratios": [3, 2]})
    place = axes[0, 0].get_subplotspec()
    axes[0, 0].remove()
    draw_in_space(figure, place, particles)
    draw_from_above(axes[0, 1], particles, segments)
    draw_section(axes[1, 0], particles, strands["line"])
    titles = {"bead": "particles", "line": "line"}
    for name, strand in strands.items():
        colour = shared.COLOURS[NAMES.index(name)]
        axes[1, 1].plot(1e3 * strand.along, 1e3 * strand.width, color=colour, label=titles[name])
        axes[1, 1].plot(1e3 * strand.along, 1e6 * strand.area, color=colour, linestyle=":")
    axes[1, 1].axvline(1e3 * LEG, color="0.8", linewidth=1, zorder=0)
    axes[1, 1].plot([], [], color="0.3", linestyle=":", label="area / mm²")
    axes[1, 1].set(xlabel="along the path / mm", ylabel="width / mm", ylim=(0, None))
    axes[1, 1].set_title("Width and area of sections, round the corner at 8 mm")
    axes[1, 1].legend()
    return shared.save(figure, folder, NAME)


def main(given: list[str] | None = None) -> dict[str, Strand]:
    steps = {"type": int, "help": "number of steps [default: all of the scene]"}
    options = shared.arguments(NAME, __doc__, given, steps=steps)
    folder = options.out / "fields"
    begin = time.perf_counter()
    readings = simulate(options.fmu, folder, options.steps)
    print(f"both strands took {time.perf_counter() - begin:.1f} s")
    particles, segments = last(folder, "bead"), last(folder, "line")
    strands = {"bead": of_particles(particles), "line": of_line(segments)}
    shared.print_table(
        ["strand", "width", "height", "off the path", "at most"],
        [
            [
                name,
                f"{1e3 * read['width']:.2f} mm",
                f"{1e3 * read['height']:.2f} mm",
                f"{1e3 * read['deviation']:.3f} mm",
                f"{1e3 * read['largest_deviation']:.3f} mm",
            ]
            for name, read in readings.items()
        ],
    )
    draw(particles, segments, strands, options.out)
    return strands


if __name__ == "__main__":
    main()
