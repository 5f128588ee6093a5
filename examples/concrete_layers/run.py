"""A wall of concrete, layer on layer: when does the lowest one yield?"""

import shutil
import sys
from pathlib import Path

import numpy as np
from matplotlib.patches import Rectangle

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import paraview  # noqa: E402
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "concrete_layers"
STOP, STEP = 36.0, 0.5  # s
DENSITY, GRAVITY, YIELD_STRESS = 2200.0, 9.81, 600.0  # as in scene.toml
BEARS = np.sqrt(3.0) * YIELD_STRESS / (DENSITY * GRAVITY)  # m of wall that a layer bears
LAYER = 12e-3  # m
READ = {"ratio": "wall.bearing_ratio", "width": "wall.width", "volume": "wall.volume"}


def simulate(fmu: Path, folder: Path) -> dict[str, np.ndarray]:
    """Runs the unit with ParaView files in a folder; readings over time."""
    shutil.rmtree(folder, ignore_errors=True)
    readings = {key: [0.0] for key in ["time", *READ]}
    with Unit(fmu, parameters={"output.directory": str(folder)}) as unit:
        for n in range(round(STOP / STEP)):
            unit.step(STEP)
            readings["time"].append((n + 1) * STEP)
            for key, name in READ.items():
                readings[key].append(unit[name])
    return {key: np.array(values) for key, values in readings.items()}


def segments(folder: Path) -> dict[str, np.ndarray]:
    """Base, height and length of the segments of the last ParaView file [m], and the load of each
    over what it bears."""
    arrays = paraview.read(list(paraview.files(folder, "wall").values())[-1])
    x, _, middle = arrays["position"].T
    height = arrays["pressure"] / (DENSITY * GRAVITY)
    length = arrays["mass"] / (arrays["density"] * arrays["width"] * height)
    base, top = middle - 0.5 * height, (middle + 0.5 * height).max()
    return {
        "x": x,
        "base": base,
        "height": height,
        "length": length,
        "width": arrays["width"],
        "ratio": (top - base) / BEARS,
    }


def draw(run: dict, wall: dict, out: Path) -> Path:
    figure, (left, right) = shared.new_figure(1, 2, height=4.6, width_ratios=[3, 2])
    colours = left.scatter([], [], c=[], cmap="RdYlBu_r", vmin=0.0, vmax=2.0)
    for x, base, height, length, ratio in zip(
        *(wall[key] for key in ["x", "base", "height", "length", "ratio"]), strict=True
    ):
        place = (1e3 * (x - 0.5 * length), 1e3 * base)
        face = colours.cmap(0.5 * ratio)
        left.add_patch(
            Rectangle(place, 1e3 * length, 1e3 * height, facecolor=face, edgecolor="white")
        )
    figure.colorbar(colours, ax=left, label="load over what a layer bears")
    left.set(title="side of the wall", xlabel="x / mm", ylabel="z / mm")
    left.set(xlim=(-280, 280), ylim=(0, 90))
    right.plot(run["time"], run["ratio"], label="unit")
    layer = run["time"] // 6.0 + 1.0
    height = np.minimum(layer, 6.0) * LAYER / BEARS
    right.step(run["time"], height, where="post", **shared.CLOSED_FORM, label="ρ g H/(√3 τ)")
    right.axhline(1.0, color=shared.COLOURS[1], linewidth=1.0)
    right.set(title="load of the lowest layer over what it bears", xlabel="t / s", ylim=(0, 2))
    right.legend(loc="upper left")
    return shared.save(figure, out, NAME)


def main(given: list[str] | None = None) -> dict[str, np.ndarray]:
    options = shared.arguments(NAME, __doc__, given)
    folder = options.out / "fields"
    run = simulate(options.fmu, folder)
    wall = segments(folder)
    yields = run["time"][np.argmax(run["ratio"] >= 1.0)]
    print(f"a layer bears a wall of {1e3 * BEARS:.0f} mm; the lowest one yields at {yields:.1f} s")
    shared.print_table(
        ["layers", "height of one", "width", "wall", "load of the lowest"],
        [
            [
                f"{(wall['base'] + wall['height']).max() / LAYER:.0f}",
                f"{1e3 * np.median(wall['height']):.1f} mm",
                f"{1e3 * np.median(wall['width']):.1f} mm",
                f"{1e3 * (wall['base'] + wall['height']).max():.0f} mm",
                f"{run['ratio'][-1]:.2f}",
            ]
        ],
    )
    draw(run, wall, options.out)
    return run


if __name__ == "__main__":
    main()
