"""Four layers of wax by G-code, on a cold bed and on one that a controller heats."""

import shutil
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import paraview  # noqa: E402
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "wax_layers"
STEP = 0.1  # s
WANTED = {"cold bed": None, "heated bed": 33.0}  # °C at the sensor
GAIN, INTEGRAL, MOST = 4.0, 0.6, 60.0  # K/K, 1/s, and the hottest bed in °C
READ = {
    "frozen": "ink.solid_fraction",
    "width": "ink.width",
    "coldest": "ink.min_temperature",
    "drift": "ink.heat_drift",
    "heat": "ink.heat",
}


def simulate(fmu: Path, folder: Path, wanted: float | None, stop: float) -> dict[str, np.ndarray]:
    """Runs the unit with the bed at 20 °C, or under a controller; readings over time."""
    shutil.rmtree(folder, ignore_errors=True)
    readings = {key: [] for key in ["time", "bed", "sensor", *READ]}
    integral = 0.0
    with Unit(fmu, parameters={"output.directory": str(folder)}) as unit:
        for n in range(round(stop / STEP)):
            sensor = unit["sensor.temperature"] - shared.ZERO_CELSIUS
            bed = 20.0
            if wanted is not None:
                error = wanted - sensor
                integral = np.clip(integral + INTEGRAL * error * STEP, -30.0, 30.0)
                bed = float(np.clip(wanted + GAIN * error + integral, 20.0, MOST))
            unit["plate.bottom.ambient"] = bed + shared.ZERO_CELSIUS
            unit.step(STEP)
            values = {"time": (n + 1) * STEP, "bed": bed, "sensor": sensor}
            values |= {key: unit[name] for key, name in READ.items()}
            for key, value in values.items():
                readings[key].append(value)
        surface = np.asarray(unit["surface.temperature"]) - shared.ZERO_CELSIUS
        deviation = unit["ink.largest_deviation"]
    return {
        **{key: np.array(values) for key, values in readings.items()},
        "surface": surface,
        "deviation": deviation,
    }


def segments(folder: Path) -> dict[str, np.ndarray]:
    """Segments of the last ParaView file, with the way along the first layer [mm]."""
    arrays = paraview.read(list(paraview.files(folder, "ink").values())[-1])
    steps = np.linalg.norm(np.diff(arrays["position"][:, :2], axis=0), axis=1)
    arrays["way"] = 1e3 * np.r_[0.0, np.cumsum(steps)]
    return arrays


def draw(runs: dict, folder: Path, out: Path) -> Path:
    figure, axes = shared.new_figure(2, 3, height=7.6)
    for panel, (name, run) in zip(axes[:, 0], runs.items(), strict=True):
        image = shared.show_field(
            panel, run["surface"], (20.0, 20.0), cmap="inferno", vmin=20.0, vmax=36.0
        )
        panel.set(title=f"{name}: top of the plate / °C", xlabel="x / mm", ylabel="y / mm")
        shared.add_colour_bar(image, "")
    for panel, name in zip(axes[:, 1], runs, strict=True):
        arrays = segments(folder / name)
        dots = panel.scatter(
            arrays["way"],
            1e3 * arrays["position"][:, 2],
            c=1e3 * arrays["width"],
            s=7,
            vmin=1.0,
            vmax=2.0,
        )
        panel.set(title=f"{name}: layers", xlabel="along the strand / mm", ylabel="z / mm")
        panel.set_ylim(0.0, 1.8)
        figure.colorbar(dots, ax=panel, label="width / mm")
    for name, run in runs.items():
        axes[0, 2].plot(run["time"], run["sensor"], label=f"plate, {name}")
        axes[1, 2].plot(run["time"], 100 * run["frozen"], label=name)
    heated = runs["heated bed"]
    axes[0, 2].plot(heated["time"], heated["bed"], color=shared.COLOURS[2], label="heated bed")
    axes[0, 2].set(title="temperatures / °C", xlabel="t / s")
    axes[1, 2].set(title="frozen / %", xlabel="t / s", ylim=(0, 100))
    for panel in axes[:, 2]:
        panel.legend(fontsize=9)
    return shared.save(figure, out, NAME)


def main(given: list[str] | None = None) -> dict:
    until = {"type": float, "default": 24.0, "help": "end in s [default: %(default)s]"}
    options = shared.arguments(NAME, __doc__, given, stop=until)
    began = time.perf_counter()
    folder = options.out / "fields"
    runs = {
        name: simulate(options.fmu, folder / name, to, options.stop) for name, to in WANTED.items()
    }
    print(f"two runs took {time.perf_counter() - began:.1f} s")
    rows = []
    for name, run in runs.items():
        arrays = segments(folder / name)
        rows.append(
            [
                name,
                f"{1e3 * run['width'][-1]:.2f} mm",
                f"{1e3 * arrays['position'][:, 2].max():.2f} mm",
                f"{100 * run['frozen'][-1]:.0f} %",
                f"{1e3 * run['deviation']:.2f} mm",
                f"{abs(run['drift'][-1] / run['heat'][-1]):.0e}",
            ]
        )
    shared.print_table(
        ["bed", "mean width", "highest middle", "frozen", "off the square", "balance"], rows
    )
    draw(runs, folder, options.out)
    return runs


if __name__ == "__main__":
    main()
