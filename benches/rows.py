"""Times what is read of the alumina plate by influence rows beside solutions for each state.

Both units have the same mesh and inputs; the experiment of the second ends after one step, which is
worth no rows. Each runs in a process of its own, so that the peak of memory is its own too.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import time
from ctypes import c_size_t, c_void_p
from pathlib import Path
from tempfile import TemporaryDirectory

import impinge
import numpy as np
from impinge.unit.slave import pointer

ROOT = Path(__file__).resolve().parents[1]

STEP = 1e-8
STOPS = {"rows": 350 * STEP, "solutions": STEP}
MESHES = {
    "9e4": "{ spacing = 2.5e-6, depth_spacing = 0.5e-6, growth = 1.3, order = 2 }",
    "2e4": "{ spacing = 5e-6, depth_spacing = 1e-6, growth = 1.4, order = 2 }",
}
MATERIAL = (
    'model = "thermoelastic", density = 3950.0, specific_heat = 900.0, conductivity = 10.0, '
    "young = 300e9, poisson = 0.21, expansion = 8.1e-6"
)
OUTPUTS = [f"p{i}.stress_{c}" for i in range(8) for c in ("xx", "zz", "xz")]
OUTPUTS += [f"p{i}.displacement_z" for i in range(8)]

SCENE = """
name = "Rows"
stop_time = {stop!r}
step = {step!r}
[body.plate]
kind = "solid"
shape = {{ box = [2e-3, 2e-3, 0.26e-3] }}
material = {{ {material} }}
initial_temperature = 293.15
mesh = {mesh}
[body.plate.faces]
sides = {{ clamped = true }}
[[load]]
name = "spot"
on = "plate.top"
footprint = {{ disc = {{ radius = 30e-6 }} }}
carries = ["heat_flux"]
start = {{ heat_flux = 1e8 }}
[[load]]
name = "tiles"
on = "plate.top"
footprint = {{ tiles = {{ count = [{tiles}, {tiles}], size = [4e-6, 4e-6] }} }}
carries = ["pressure"]
{probes}"""


def scene(kind, mesh, tiles=16):
    probes = "".join(
        f'[[probe]]\nname = "p{i}"\nin = "plate"\nat = [0.0, 0.0, {-2e-6 * i!r}]\n'
        'gives = ["temperature", "stress", "displacement"]\n'
        for i in range(8)
    )
    names = {"stop": STOPS[kind], "step": STEP, "mesh": mesh, "tiles": tiles}
    return SCENE.format(**names, material=MATERIAL, probes=probes)


def peak_memory():
    """[GB]"""
    status = Path("/proc/self/status").read_text()
    (line,) = (line for line in status.splitlines() if line.startswith("VmHWM"))
    return int(line.split()[1]) * 1024 / 1e9


def adjoint(unit, outputs):
    """Derivatives of a sum of outputs by all tiles."""
    unknowns = np.concatenate([unit.variable(name).references for name in outputs])
    knowns = np.asarray(unit.variable("tiles.pressure").references)
    weights, found = np.ones(len(outputs)), np.zeros(len(unit["tiles.pressure"].ravel()))
    types = (c_void_p, c_size_t) * 4
    places = (pointer(unknowns), len(unknowns), pointer(knowns), len(knowns))
    values = (pointer(weights), weights.size, pointer(found), found.size)
    unit.slave.call("GetAdjointDerivative", *places, *values, types=types)
    return found


def measure(file, kind, derivatives):
    begin = time.perf_counter()
    solves = 2000 if kind == "rows" else 5
    with impinge.Unit(file, parameters={"solver.threads": os.cpu_count()}) as unit:
        result = {"initialise": time.perf_counter() - begin}
        unit.step(STEP)
        begin = time.perf_counter()
        values = [float(unit["p0.stress_xx"])]
        result["first"] = time.perf_counter() - begin
        begin = time.perf_counter()
        values += [float(unit[name]) for name in OUTPUTS]
        result["others"] = time.perf_counter() - begin

        # Steps cost more than readings: these are timed alone, after each step.
        times = []
        for _ in range(min(solves, 200)):
            unit.step(STEP)
            begin = time.perf_counter()
            unit["p0.stress_xx"]
            times.append(time.perf_counter() - begin)
        result["reading"] = statistics.median(times)
        if derivatives:
            begin = time.perf_counter()
            gradient = adjoint(unit, OUTPUTS)
            result["adjoint"] = time.perf_counter() - begin
            result["gradient"] = gradient.tolist()
        result["values"] = values
        return result | {"memory": peak_memory()}


LABELS = {
    "initialise": "initialise / s",
    "first": "first reading of stress / s",
    "others": f"first reading of {len(OUTPUTS)} outputs / s",
    "reading": "reading after a step / s",
    "adjoint": "adjoint derivatives by all tiles / s",
    "memory": "peak memory / GB",
}


def compare(size, tiles, derivatives):
    """Prints the table of a mesh."""
    results = {}
    with TemporaryDirectory() as folder:
        for kind in STOPS:
            text = Path(folder) / f"{kind}.toml"
            text.write_text(scene(kind, MESHES[size], tiles))
            unit = text.with_suffix(".fmu")
            build = [ROOT / "target/release/build-fmu", text, "-o", unit, "--fmi", "3"]
            subprocess.run(build, check=True, capture_output=True)
            command = [sys.executable, __file__, "--unit", unit, "--kind", kind]
            command += ["--derivatives"] * derivatives
            ran = subprocess.run(command, check=True, capture_output=True, text=True)
            results[kind] = json.loads(ran.stdout.splitlines()[-1])
    rows, solutions = results["rows"], results["solutions"]
    print(f"\nmesh {size}, {tiles} × {tiles} tiles, {os.cpu_count()} threads")
    print(f"{'':42}{'rows':>12}{'solutions':>12}{'ratio':>10}")
    for key, label in LABELS.items():
        if key in rows:
            ratio = solutions[key] / rows[key]
            print(f"{label:42}{rows[key]:12.4g}{solutions[key]:12.4g}{ratio:10.3g}")
    for key in ("values", "gradient"):
        if key in rows:
            pairs = list(zip(rows[key], solutions[key], strict=True))
            stresses = pairs[: 1 + 24] if key == "values" else pairs
            largest = max(abs(b) for _, b in stresses)
            worst = max(abs(a - b) for a, b in stresses) / largest
            print(f"largest difference of {key} over the largest: {worst:.2g}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sizes", nargs="+", choices=MESHES, default=["9e4"])
    parser.add_argument("--tiles", type=int, default=16, help="along each side of the load")
    parser.add_argument("--without-derivatives", action="store_true", help="which take a minute")
    parser.add_argument("--unit", help=argparse.SUPPRESS)
    parser.add_argument("--kind", choices=STOPS, help=argparse.SUPPRESS)
    parser.add_argument("--derivatives", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.unit:
        print(json.dumps(measure(arguments.unit, arguments.kind, arguments.derivatives)))
        return
    for size in arguments.sizes:
        compare(size, arguments.tiles, not arguments.without_derivatives)


if __name__ == "__main__":
    main()
