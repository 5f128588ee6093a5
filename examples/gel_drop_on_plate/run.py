"""A bead of warm gel falls on a plate of glass, flattens, warms it, and bounces off."""

import shutil
import sys
import time
from pathlib import Path

import matplotlib.tri as mtri
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import paraview  # noqa: E402
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "gel_drop_on_plate"
STOP, STEP = 10e-3, 1e-4  # s
SHOWN = [0.0, 1e-3, 3e-3, 5e-3, 6.5e-3, 8e-3]  # s
READ = {
    "width": "bead.width",
    "height": "bead.height",
    "force": "bead.contact_force",
    "radius": "bead.contact_radius",
    "kinetic": "bead.kinetic",
    "stored": "bead.stored",
    "bending": "below.stress_xx",
    "heat": "bead.heat",
    "surface": "surface.temperature",
}


def simulate(fmu: Path, folder: Path) -> dict[str, np.ndarray]:
    """Runs the unit with ParaView files in a folder; readings over time."""
    shutil.rmtree(folder, ignore_errors=True)
    readings = {key: [] for key in ["time", *READ]}
    with Unit(fmu, parameters={"output.directory": str(folder)}) as unit:
        for step in range(round(STOP / STEP) + 1):
            if step > 0:
                unit.step_to(step * STEP)
            readings["time"].append(step * STEP)
            for key, name in READ.items():
                readings[key].append(unit[name])
        print(f"left the plate after {unit['bead.lift_off_time'] * 1e3:.2f} ms")
    return {key: np.array(values) for key, values in readings.items()}


def moment(run: dict, key: str) -> float:
    """Time of the largest value [s]."""
    return run["time"][run[key].argmax()]


def draw_beads(folder: Path, out: Path) -> Path:
    """The meridian section of the bead at some moments, coloured by the pressure in it."""
    files = paraview.files(folder, "bead")
    nearest = [min(files.items(), key=lambda at: abs(at[0] - moment))[1] for moment in SHOWN]
    arrays = [paraview.read(path) for path in nearest]
    # The reference shape is convex: its triangles are those of all moments.
    radius, z = arrays[0]["position"][:, 0], arrays[0]["position"][:, 2]
    triangles = mtri.Triangulation(radius, z).triangles
    figure, axes = shared.new_figure(1, len(SHOWN), height=3.4, sharey=True)
    for panel, moment, now in zip(axes, SHOWN, arrays, strict=True):
        x, z = now["position"][:, 0] * 1e3, now["position"][:, 2] * 1e3
        for side in (-1, 1):
            image = panel.tripcolor(
                side * x,
                z,
                triangles,
                now["pressure"] * 1e-3,
                shading="gouraud",
                cmap="RdBu_r",
                vmin=-10,
                vmax=10,
            )
        panel.axhspan(-1.0, 0.0, color="#9db8c4")
        panel.set(xlim=(-9, 9), ylim=(-1, 17), aspect="equal", xlabel="x / mm")
        panel.set_title(f"{moment * 1e3:g} ms")
    axes[0].set_ylabel("z / mm")
    figure.colorbar(image, ax=axes, label="pressure / kPa", aspect=14, pad=0.015)
    return shared.save(figure, out, NAME, smooth=True)


def draw_curves(run: dict, out: Path) -> Path:
    figure, axes = shared.new_figure(1, 5, height=3.2)
    moments = run["time"] * 1e3
    axes[0].plot(moments, run["width"] * 1e3, label="width")
    axes[0].plot(moments, run["height"] * 1e3, label="height")
    axes[0].plot(moments, 2e3 * run["radius"], label="contact")
    axes[0].legend()
    axes[1].plot(moments, run["force"])
    axes[2].plot(moments, run["kinetic"] * 1e3, label="kinetic")
    axes[2].plot(moments, run["stored"] * 1e3, label="stored")
    axes[2].legend()
    axes[3].plot(moments, run["bending"] * 1e-6)
    axes[4].plot(moments, run["surface"] - run["surface"][0], label="surface / K")
    axes[4].plot(moments, run["heat"] * 1e3, label="heat / mJ")
    axes[4].legend()
    titles = [
        "size / mm",
        "force / N",
        "energy / mJ",
        "stress of the glass / MPa",
        "the glass warms",
    ]
    for panel, title in zip(axes, titles, strict=True):
        panel.set(title=title, xlabel="t / ms")
    return shared.save(figure, out, f"{NAME}_over_time")


def main(given: list[str] | None = None) -> dict:
    options = shared.arguments(NAME, __doc__, given)
    started = time.perf_counter()
    folder = options.out / "fields"
    run = simulate(options.fmu, folder)
    print(f"the run took {time.perf_counter() - started:.1f} s")
    shared.print_table(
        ["", "largest", "at"],
        [
            [words, f"{run[key].max() * scale:.2f} {unit}", f"{moment(run, key):.4f} s"]
            for words, key, scale, unit in [
                ("width", "width", 1e3, "mm"),
                ("force", "force", 1.0, "N"),
                ("stress of the glass", "bending", 1e-6, "MPa"),
                ("heat to the glass", "heat", 1e3, "mJ"),
            ]
        ],
    )
    draw_beads(folder, options.out)
    draw_curves(run, options.out)
    return run


if __name__ == "__main__":
    main()
