"""The gel's unit on the plate's unit, joined by a master, compared with both in one unit."""

import argparse
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import shared  # noqa: E402
from impinge import Master, Unit  # noqa: E402

NAME = "gel_drop_on_plate"
HERE = Path(__file__).parent
STOP, STEP = 10e-3, 1e-4  # s
RADIUS, RINGS = 9e-3, 20  # m
GRAVITY = 9.81  # m/s²
CONNECTIONS = [
    ("gel.wall.heat_flux", "plate.bead.heat_flux"),
    ("gel.wall.pressure", "plate.bead.pressure"),
    ("plate.face.temperature", "gel.wall.temperature"),
]
# Readings with the unit of the two that has them.
READ = {
    "bead.contact_force": "gel",
    "bead.momentum_z": "gel",
    "bead.width": "gel",
    "bead.heat": "gel",
    "surface.temperature": "plate",
    "below.stress_xx": "plate",
    "below.displacement_z": "plate",
}


def couple(gel: Path, plate: Path) -> dict[str, np.ndarray]:
    """Both units in turns: the gel above the plate as it was, the plate under what it received."""
    outputs = [f"{unit}.{name}" for name, unit in READ.items()]
    outputs += ["plate.plate.heat_in", "gel.wall.pressure", "gel.bead.mass"]
    outputs += ["gel.wall.force_outside", "gel.wall.heat_flow_outside", "plate.face.temperature"]
    units = {"gel": gel, "plate": plate}
    with Master(units, CONNECTIONS, scheme="gauss-seidel", step=STEP, outputs=outputs) as master:
        run = master.run(STOP)
    return {name.split(".", 1)[1]: np.asarray(run[name].values) for name in outputs}


def together(scene: Path) -> dict[str, np.ndarray]:
    """The same from one unit that holds both."""
    with Unit(scene) as unit:
        rows, rings = [unit.get(list(READ))], [unit["face.temperature"]]
        for step in range(1, round(STOP / STEP) + 1):
            unit.step_to(step * STEP)
            rows.append(unit.get(list(READ)))
            rings.append(unit["face.temperature"])
    table = dict(zip(READ, np.transpose(rows), strict=True))
    return table | {"face.temperature": np.array(rings)}


def report(two: dict[str, np.ndarray], one: dict[str, np.ndarray]):
    rows = []
    for name in READ:
        whole = np.abs(one[name] - one[name][0]).max()
        off = (two[name] - one[name]) / whole
        largest = off[np.abs(off).argmax()]
        rows.append([name, f"{whole:.4g}", f"{largest:+.2%}", f"{off[-1]:+.2%}"])
    shared.print_table(["output", "range", "largest difference", "at the end"], rows)
    of_rings(two["face.temperature"], one["face.temperature"])
    areas = np.pi * np.diff(np.linspace(0.0, RADIUS, RINGS + 1) ** 2)
    force = two["wall.pressure"] @ areas + two["wall.force_outside"]
    weight = GRAVITY * two["bead.mass"][-1]
    gained = two["bead.momentum_z"][-1] - two["bead.momentum_z"][0] + weight * STOP
    received = STEP * force[1:].sum()
    off = received / gained - 1
    print(f"impulse of the cells {received:.6e} N s = that of the gel to {off:.0e}")
    taken = two["plate.heat_in"][-1] + STEP * two["wall.heat_flow_outside"][1:].sum()
    given = two["bead.heat"][-1]
    print(f"heat received by the plate {taken:.6e} J = given by the gel to {taken / given - 1:.0e}")
    print(f"beyond the rings: at most {np.abs(two['wall.force_outside']).max():.1e} N")


def of_rings(two: np.ndarray, one: np.ndarray):
    """Differences of the rings' mean temperatures, of the range of all."""
    off = np.abs(two - one) / (one - one[0]).max()
    print(f"rings: first {off[:, 0].max():.1%}, others {off[:, 1:].max():.1%} at most,", end=" ")
    print(f"at the end {off[-1, 0]:.1%} and {off[-1, 1:].max():.1%}")


def draw(two: dict[str, np.ndarray], one: dict[str, np.ndarray], folder: Path):
    figure, axes = shared.new_figure(1, 4, height=3.4)
    moments = np.linspace(0.0, STOP, len(one["bead.heat"])) * 1e3
    for panel, (name, scale, title) in zip(
        axes,
        [
            ("bead.contact_force", 1.0, "force / N"),
            ("bead.heat", 1e3, "heat / mJ"),
            ("surface.temperature", 1.0, "surface of the glass / K"),
            ("below.stress_xx", 1e-6, "stress of the glass / MPa"),
        ],
        strict=True,
    ):
        panel.plot(moments, scale * two[name], label="two units")
        panel.plot(moments, scale * one[name], **shared.CLOSED_FORM, label="one unit")
        panel.set(title=title, xlabel="t / ms")
    axes[0].legend()
    return shared.save(figure, folder, f"{NAME}_two_units")


def main(given: list[str] | None = None):
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("gel", "plate", "together"):
        scene = HERE / f"{name}.toml"
        parser.add_argument(f"--{name}", type=Path, default=scene, help="scene or unit")
    parser.add_argument("--out", type=Path, default=shared.ROOT / "out" / NAME, help="folder")
    options = parser.parse_args(given)
    options.out.mkdir(parents=True, exist_ok=True)
    started = time.perf_counter()
    two = couple(options.gel, options.plate)
    middle = time.perf_counter()
    one = together(options.together)
    print(f"two units {middle - started:.1f} s, one {time.perf_counter() - middle:.1f} s")
    report(two, one)
    draw(two, one, options.out)


if __name__ == "__main__":
    main()
