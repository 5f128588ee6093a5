"""A narrow hairpin of paste by particles: along the drawing, along the best path of a line, and,
with `--simulations`, along the best path that particles find."""

import argparse
import shutil
import sys
import time
import tomllib
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import paraview  # noqa: E402
import run  # noqa: E402
import shared  # noqa: E402
from impinge import Unit  # noqa: E402
from impinge.study import path  # noqa: E402

NAME = "particles"
SCENE = Path(__file__).parent / "paste.toml"
DRAWING = np.array(tomllib.loads(SCENE.read_text())["target"][0]["line"])  # m
HEIGHT, END = 2.5e-3, 0.0  # m, of the outlet, and x at which the drawing ends
READ = ["deviation", "largest_deviation", "lag", "width"]


def as_line(folder: Path) -> Path:
    """The same scene by a line of segments."""
    lines = SCENE.read_text().splitlines()
    kept = [line for line in lines if not line.startswith(("method", "spacing"))]
    scene = folder / "line.toml"
    scene.write_text("\n".join(kept))
    return scene


def follow(scene: Path, places: np.ndarray, folder: Path) -> dict[str, float]:
    """Readings where the nozzle is above the drawing's end, with ParaView files in a folder."""
    shutil.rmtree(folder, ignore_errors=True)
    steps = np.hypot(*np.diff(places, axis=0).T)
    with Unit(scene, parameters={"output.directory": str(folder)}) as unit:
        for place, after, length in zip(places, places[1:], steps, strict=False):
            if after[0] < END:
                break
            duration = length / run.SPEED
            for axis, name in enumerate(["ink.nozzle_x", "ink.nozzle_y"]):
                unit[name] = place[axis]
                unit.set_input_derivatives({name: [(after[axis] - place[axis]) / duration]})
            unit.step(duration)
        return {key: unit[f"ink.{key}"] for key in READ}


def draw(paths: dict[str, np.ndarray], out: Path) -> Path:
    figure, axes = shared.new_figure(1, len(paths), height=4.4, squeeze=False)
    for panel, (name, places) in zip(axes[0], paths.items(), strict=True):
        arrays = paraview.read(list(paraview.files(out / name, "ink").values())[-1])
        below = arrays["position"][:, 2] < HEIGHT
        x, y, z = 1e3 * arrays["position"][below].T
        order = np.argsort(z)
        panel.scatter(x[order], y[order], c=z[order], cmap="viridis", s=12, linewidths=0)
        panel.plot(*(1e3 * places.T), color=shared.COLOURS[1], linewidth=1.0)
        panel.plot(*(1e3 * DRAWING.T), **shared.CLOSED_FORM)
        panel.set(xlabel="x / mm", aspect="equal", title=name.replace("_", " "))
        panel.set(xlim=(-0.5, 9.5), ylim=(-1.5, 4.5))
    axes[0, 0].set_ylabel("y / mm")
    return shared.save(figure, out, NAME)


def main(given: list[str] | None = None) -> dict[str, dict[str, float]]:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--simulations", type=int, default=0, help="runs of particles, half a minute each"
    )
    parser.add_argument("--out", type=Path, default=shared.ROOT / "out/bend/particles")
    options = parser.parse_args(given)
    options.out.mkdir(parents=True, exist_ok=True)
    settings = {"by": "gauss-newton", "speed": run.SPEED, "folder": options.out / "runs"}
    line = as_line(options.out)
    best = path(line, waypoints=6, region=(0.2, 0.8), simulations=100, **settings)
    paths = {"along_the_drawing": best.along, "best_path_of_a_line": best.places}
    if options.simulations:
        count = {"waypoints": 2, "simulations": options.simulations, "size": 3}
        own = path(SCENE, region=(0.25, 0.75), **count, **settings)
        paths["best_path_of_particles"] = own.places
    found, rows = {}, []
    for name, places in paths.items():
        for method, scene in {"line": line, "particles": SCENE}.items():
            begin = time.process_time()
            folder = options.out / (name if method == "particles" else "line")
            read = found[f"{name}, {method}"] = follow(scene, places, folder)
            off = [1e3 * read[key] / run.DIAMETER for key in ("deviation", "largest_deviation")]
            lengths = [1e3 * read[key] for key in ("lag", "width")]
            row = [*(f"{one:.3f} D" for one in off), *(f"{one:.2f} mm" for one in lengths)]
            seconds = time.process_time() - begin
            rows.append([name.replace("_", " "), method, *row, f"{seconds:.0f} s"])
    head = ["path", "laid by", "mean", "at most", "lag", "width", "processor time"]
    shared.print_table(head, rows)
    draw(paths, options.out)
    return found


if __name__ == "__main__":
    main()
