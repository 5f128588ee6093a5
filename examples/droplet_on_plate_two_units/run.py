"""A drop's unit on a plate's unit, joined by a master, beside both in one unit."""

import argparse
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import shared  # noqa: E402
from impinge import Master, Unit  # noqa: E402

NAME = "droplet_on_plate_two_units"
HERE = Path(__file__).parent
STOP, STEP = 2.5e-6, 2.5e-8  # s
COLD = 293.15  # K
PROBES = ["centre", "beside", "below"]
OUTPUTS = [f"{probe}.{key}" for probe in PROBES for key in ("temperature", "stress_xx")]
CONNECTIONS = [
    ("drop.wall.heat_flux", "plate.drop.heat_flux"),
    ("drop.wall.pressure", "plate.drop.pressure"),
    ("drop.wall.shear_r", "plate.drop.shear_r"),
    ("plate.face.temperature", "drop.wall.temperature"),
]


def couple(drop: Path, plate: Path, step: float):
    """Both units in turns: the drop above the plate as it was, the plate under what it gave."""
    units = {"drop": drop, "plate": plate}
    outputs = [f"plate.{name}" for name in (*OUTPUTS, "plate.heat_in")]
    outputs += ["drop.drop.heat", "drop.wall.heat_flow_outside"]
    with Master(units, CONNECTIONS, scheme="gauss-seidel", step=step, outputs=outputs) as master:
        return master.run(STOP)


def together(scene: Path, step: float) -> dict[str, np.ndarray]:
    """The same from one unit that holds both."""
    names = [*OUTPUTS, "plate.heat_in", "drop.heat"]
    with Unit(scene) as unit:
        rows, rings = [unit.get(names)], [unit["face.temperature"]]
        for _ in range(round(STOP / step)):
            unit.step(step)
            rows.append(unit.get(names))
            rings.append(unit["face.temperature"])
    table = dict(zip(names, np.transpose(rows), strict=True))
    return table | {"face.temperature": np.array(rings)}


def report(two, one: dict[str, np.ndarray], step: float):
    rows = []
    for name in OUTPUTS:
        start = one[name][0]
        whole = np.abs(one[name] - start).max()
        off = (two[f"plate.{name}"].values - one[name]) / whole
        later = off[round(1e-6 / step) :]
        rows.append([name, f"{whole:.4g}", f"{off[-1]:+.1%}", f"{np.sqrt(np.mean(later**2)):.1%}"])
    shared.print_table(["output", "range", "at the end", "rms from 1 µs on"], rows)
    outside = step * two["drop.wall.heat_flow_outside"].values[1:].sum()
    taken = two["plate.plate.heat_in"].values[-1] + outside
    given = two["drop.drop.heat"].values[-1]
    print(f"heat taken by the plate and beyond it {taken:.6e} J = given to {taken / given - 1:.0e}")
    print(f"heat given, beside one unit: {given / one['drop.heat'][-1] - 1:+.2%}")


def draw(two, one: dict[str, np.ndarray], folder: Path):
    figure, axes = shared.new_figure(1, 3, height=5.2)
    times = two["time"].values * 1e6
    for probe, colour in zip(PROBES, shared.COLOURS, strict=False):
        for plot, key, base, scale in (
            (axes[0], "temperature", COLD, 1.0),
            (axes[1], "stress_xx", 0.0, 1e-6),
        ):
            name = f"{probe}.{key}"
            values = (two[f"plate.{name}"].values - base) * scale
            plot.plot(times, values, color=colour, label=probe)
            plot.plot(times, (one[name] - base) * scale, **shared.CLOSED_FORM)
    axes[0].set(title="Rise of the plate", xlabel="time / µs", ylabel="K")
    axes[1].set(title="Radial stress", xlabel="time / µs", ylabel="MPa")
    edges = np.linspace(0, 200, two["plate.face.temperature"].shape[1] + 1)
    for t, colour in zip([0.3, 0.6, 1.2, 2.5], shared.COLOURS, strict=False):
        row = int(np.argmin(np.abs(times - t)))
        rise = two["plate.face.temperature"].values[row] - COLD
        axes[2].stairs(rise, edges, color=colour, linewidth=2, label=f"{t:g} µs")
        axes[2].stairs(one["face.temperature"][row] - COLD, edges, **shared.CLOSED_FORM)
    axes[2].set(title="Rings of the face", xlabel="radius / µm", ylabel="K")
    axes[0].plot([], [], **shared.CLOSED_FORM, label="one unit")
    for plot in axes:
        plot.legend()
    return shared.save(figure, folder, NAME)


def main(given: list[str] | None = None):
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("drop", "plate", "together"):
        scene = HERE / f"{name}.toml"
        parser.add_argument(f"--{name}", type=Path, default=scene, help="scene or unit")
    parser.add_argument("--step", type=float, default=STEP, help="s [default: %(default)s]")
    parser.add_argument("--out", type=Path, default=shared.ROOT / "out" / NAME, help="folder")
    options = parser.parse_args(given)
    options.out.mkdir(parents=True, exist_ok=True)
    started = time.perf_counter()
    two = couple(options.drop, options.plate, options.step)
    middle = time.perf_counter()
    one = together(options.together, options.step)
    print(f"two units {middle - started:.1f} s, one {time.perf_counter() - middle:.1f} s")
    report(two, one, options.step)
    draw(two, one, options.out)


if __name__ == "__main__":
    main()
