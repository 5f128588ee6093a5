"""A ring of rubber on curved spokes bounces, with and without pressure in its hub."""

import shutil
import sys
from pathlib import Path

import numpy as np
from matplotlib.collections import PolyCollection

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import paraview  # noqa: E402
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

sys.path.insert(0, str(Path(__file__).resolve().parent))
import part  # noqa: E402

NAME = "spoked_ring"
STOP, STEP = 24e-3, 2e-4  # s
SHOWN = [0.0, 2e-3, 4e-3, 6e-3, 10e-3]  # s
PRESSURES = [0.0, 50e3]  # Pa
GRAVITY = 9.81  # m/s²


def simulate(fmu: Path, folder: Path, pressure: float, stop: float) -> dict[str, np.ndarray]:
    """Runs the unit with ParaView files in a folder; readings over time."""
    shutil.rmtree(folder, ignore_errors=True)
    names = [
        "height",
        "width",
        "contact_force",
        "kinetic",
        "stored",
        "load_work",
        "mass",
        "centre_z",
    ]
    readings = {key: [] for key in ["time", *names]}
    with Unit(fmu, parameters={"output.directory": str(folder)}) as unit:
        unit["ring.sides.pressure"] = pressure
        for step in range(round(stop / STEP) + 1):
            if step > 0:
                unit.step_to(step * STEP)
            readings["time"].append(step * STEP)
            for name in names:
                readings[name].append(unit[f"ring.{name}"])
    return {key: np.array(values) for key, values in readings.items()}


def balance(run: dict[str, np.ndarray]) -> float:
    """Energy at the end over that at the start and the work of the hub, less 1."""
    rises = run["mass"] * GRAVITY * (run["centre_z"] - run["centre_z"][0])
    energies = run["kinetic"] + run["stored"] + rises
    return (energies[-1] - energies[0] - run["load_work"][-1]) / energies[0]


def draw(folder: Path, runs: list[dict], out: Path) -> Path:
    """The cells of the ring at some moments, coloured by the pressure, and the force over time."""
    _, cells, _ = part.ring()
    files = paraview.files(folder, "ring")
    figure, axes = shared.new_figure(2, 3)
    *panels, last = axes.flat
    for panel, moment in zip(panels, SHOWN, strict=True):
        now = paraview.read(min(files.items(), key=lambda at: abs(at[0] - moment))[1])
        places = 1e3 * now["position"][:, [0, 2]]
        cloud = PolyCollection(places[np.array(cells)], cmap="RdBu_r", edgecolors="0.4")
        cloud.set(linewidth=0.2, clim=(-150, 150))
        cloud.set_array(1e-3 * now["pressure"][np.array(cells)].mean(axis=1))
        panel.add_collection(cloud)
        panel.axhspan(-2.0, 0.0, color="#9db8c4")
        panel.set(xlim=(-26, 26), ylim=(-2, 50), aspect="equal", xlabel="x / mm")
        panel.set_title(f"{moment * 1e3:g} ms")
    for row in axes:
        row[0].set_ylabel("z / mm")
    figure.colorbar(cloud, ax=panels, label="pressure / kPa", aspect=30, pad=0.015)
    for pressure, run in zip(PRESSURES, runs, strict=True):
        label = f"hub at {1e-3 * pressure:g} kPa"
        last.plot(1e3 * run["time"], 1e-3 * run["contact_force"], label=label)
    last.set(xlabel="time / ms", ylabel="force / (kN per metre of depth)", xlim=(0, 10))
    last.set_title("The ground's force")
    last.legend()
    return shared.save(figure, out, NAME)


def main(given: list[str] | None = None):
    until = {"type": float, "default": STOP, "help": "s [default: %(default)s]"}
    options = shared.arguments(NAME, __doc__, given, stop=until)
    folders = [options.out / f"files_{pressure:g}" for pressure in PRESSURES]
    pairs = zip(folders, PRESSURES, strict=True)
    runs = [simulate(options.fmu, folder, pressure, options.stop) for folder, pressure in pairs]
    rows = []
    for pressure, run in zip(PRESSURES, runs, strict=True):
        speed = (run["centre_z"][-1] - run["centre_z"][-2]) / STEP
        rows.append(
            [
                f"{1e-3 * pressure:g} kPa",
                f"{1e3 * run['height'].min():.1f} mm",
                f"{1e3 * run['width'].max():.1f} mm",
                f"{1e-3 * run['contact_force'].max():.2f} kN/m",
                f"{speed:.2f} m/s",
                f"{100 * balance(run):+.2f} %",
            ]
        )
    header = ["hub", "lowest", "widest", "largest force", "rises at", "energy off"]
    shared.print_table(header, rows)
    draw(folders[0], runs, options.out)


if __name__ == "__main__":
    main()
