"""The alumina plate in impinge and in scikit-fem on the same nodes; exit code 1 if they differ."""

import csv
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import vtr
from peer import Case, Plate

ROOT = Path(__file__).resolve().parents[2]
STOP, STEPS = 3.5e-6, 250
COLD = 293.15
LIMIT = 1.0  # percent

POINTS = {
    "centre": (0.0, 0.0, 0.0),
    "depth 5 µm": (0.0, 0.0, -5e-6),
    "depth 20 µm": (0.0, 0.0, -20e-6),
    "radius 15 µm": (15e-6, 0.0, 0.0),
    "radius 45 µm": (45e-6, 0.0, 0.0),
}
QUANTITIES = {
    "temperature": ("rise", "K", 1.0),
    "stress_xx": ("σ_xx", "MPa", 1e6),
    "stress_zz": ("σ_zz", "MPa", 1e6),
    "displacement_x": ("u_x", "nm", 1e-9),
    "displacement_z": ("u_z", "nm", 1e-9),
}
MESHES = {
    1: "{ spacing = 3e-6, depth_spacing = 0.5e-6, growth = 1.2, order = 1 }",
    2: "{ spacing = 2.5e-6, depth_spacing = 0.75e-6, growth = 1.4, order = 2 }",
}


def scene(case, mesh):
    probes = "".join(
        f'[[probe]]\nname = "p{i}"\nin = "plate"\nat = {list(point)}\n'
        'gives = ["temperature", "stress", "displacement"]\n'
        for i, point in enumerate(POINTS.values())
    )
    constants = "density specific_heat conductivity young poisson expansion".split()
    material = ", ".join(f"{name} = {getattr(case, name)}" for name in constants)
    return f"""
name = "Compared"
stop_time = {STOP}
step = {STOP}
[body.plate]
kind = "solid"
shape = {{ box = [2e-3, 2e-3, 0.26e-3] }}
material = {{ model = "thermoelastic", {material} }}
initial_temperature = {COLD}
mesh = {mesh}
[body.plate.faces]
sides = {{ clamped = true }}
[[load]]
name = "spot"
on = "plate.top"
footprint = {{ disc = {{ radius = {case.radius} }} }}
carries = ["heat_flux", "pressure"]
start = {{ heat_flux = {case.heat_flux}, pressure = {case.pressure} }}
{probes}"""


def run_impinge(case, mesh):
    """Values at the points, and the nodes along the axes of the quarter."""
    with TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "scene.toml").write_text(scene(case, mesh))
        command = [ROOT / "target/release/impinge", "run", folder / "scene.toml"]
        command += ["--out", folder / "out", "--fields-every", "1"]
        subprocess.run(command, check=True, capture_output=True)
        with (folder / "out/outputs.csv").open() as file:
            *_, last = csv.DictReader(file)
        grid = vtr.read(max((folder / "out").glob("plate_*.vtr")))
    last = {name.split(" ")[0]: float(value) for name, value in last.items()}
    values = {q: np.array([last[f"p{i}.{q}"] for i in range(len(POINTS))]) for q in QUANTITIES}
    values["temperature"] -= COLD
    nodes = grid["x"][grid["x"] >= 0.0], grid["y"][grid["y"] >= 0.0], grid["z"]
    return values, nodes


def run_peer(case, nodes, order):
    plate = Plate(nodes, order, case)
    plate.assemble_heat()
    plate.factor_heat(STOP / STEPS)
    temperature = np.zeros(plate.scalar.N)
    for _ in range(STEPS):
        temperature = plate.heat_step(temperature)
    plate.assemble_mechanics()
    plate.factor_mechanics()
    displacement = plate.displacement(temperature)
    return plate.values(temperature, displacement, np.array(list(POINTS.values())).T)


def compare(order):
    """Prints the table of one order; answers the largest difference in percent."""
    begin = time.perf_counter()
    ours, nodes = run_impinge(Case(), MESHES[order])
    theirs = run_peer(Case(), nodes, order)
    count = " × ".join(str(len(axis)) for axis in nodes)
    print(f"\nElements of order {order}, {count} nodes, {time.perf_counter() - begin:.0f} s")
    print(f"{'':14}{'':12}{'impinge':>12}{'scikit-fem':>12}{'difference / %':>17}")
    worst = 0.0
    for quantity, (name, unit, scale) in QUANTITIES.items():
        # A displacement is a vector: its components are measured alike.
        alike = [q for q in QUANTITIES if q == quantity or q[:-1] == quantity[:-1]]
        largest = max(np.abs(theirs[q]).max() for q in alike)
        for i, point in enumerate(POINTS):
            a, b = ours[quantity][i], theirs[quantity][i]
            difference = 100 * (a - b) / largest
            worst = max(worst, abs(difference))
            print(
                f"{point:14}{f'{name} / {unit}':12}{a / scale:12.5f}{b / scale:12.5f}"
                f"{difference:17.4f}"
            )
    return worst


def main():
    worst = {order: compare(order) for order in MESHES}
    print("\nDifferences are in percent of the quantity's largest value at the points.")
    for order, difference in worst.items():
        verdict = "ok" if difference < LIMIT else f"more than {LIMIT} %"
        print(f"order {order}: at most {difference:.3f} % apart: {verdict}")
    return any(not difference < LIMIT for difference in worst.values())


if __name__ == "__main__":
    sys.exit(main())
