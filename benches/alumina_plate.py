"""Times the alumina plate, packed as a unit, beside the same nodes in scikit-fem if they fit.

Each repetition is a process of its own, so that the peak of memory is its own too. Medians.
"""

import argparse
import json
import os
import re
import statistics
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "tests/verification"), str(ROOT / "tests/fmpy")]

# Mesh, order of elements, solves that are timed, and whether scikit-fem's factor fits into memory.
SIZES = {
    "9e4": ("spacing = 2.5e-6, depth_spacing = 0.5e-6, growth = 1.3", 2, 5, True),
    "1e6": ("spacing = 1.0e-6, depth_spacing = 0.3e-6, growth = 1.1", 2, 3, False),
    "1e7": ("spacing = 2.95e-6, depth_spacing = 2.95e-6, growth = 1.0", 1, 1, False),
}
STEP = 1e-8
LINES = {
    "build": "build: assembly and factorisation / s",
    "factor": "  of it, factorisation / s",
    "first": "build, step and first stress / s",
    "heat": "heat step / s",
    "mechanics": "mechanical solve, stress at a point / s",
    "memory": "peak memory / GB",
}


def timed(call, repetitions=1):
    """Median time of a call [s]."""
    times = []
    for _ in range(repetitions):
        begin = time.perf_counter()
        call()
        times.append(time.perf_counter() - begin)
    return statistics.median(times)


def peak_memory():
    """[GB]"""
    status = Path("/proc/self/status").read_text()
    (line,) = (line for line in status.splitlines() if line.startswith("VmHWM"))
    return int(line.split()[1]) * 1024 / 1e9


def time_impinge(folder, _, solves):
    from master import Unit

    begin = time.perf_counter()
    with Unit(folder / "unit.fmu", {"solver.threads": os.cpu_count()}) as unit:
        result = {"build": time.perf_counter() - begin}
        unit.step(STEP)
        unit["p0.stress_xx"]
        result["first"] = time.perf_counter() - begin

        def heat():
            unit.step(STEP)
            return unit["p0.temperature"]

        result["heat"] = timed(heat, 4 * solves)

        def both():
            unit.step(STEP)
            return unit["p0.stress_xx"]

        result["mechanics"] = timed(both, solves) - result["heat"]
        return result | {"memory": peak_memory()}


def time_peer(folder, order, solves):
    import numpy as np
    from peer import Case, Plate

    nodes = list(np.load(folder / "nodes.npz").values())
    begin = time.perf_counter()
    plate = Plate(nodes, order, Case())
    plate.assemble_heat()
    plate.assemble_mechanics()
    assembled = time.perf_counter()
    plate.factor_heat(STEP)
    plate.factor_mechanics()
    done = time.perf_counter()
    result = {"build": done - begin, "factor": done - assembled}
    state = {"temperature": np.zeros(plate.scalar.N)}

    def heat():
        state["temperature"] = plate.heat_step(state["temperature"])

    def mechanics():
        displacement = plate.displacement(state["temperature"])
        plate.values(state["temperature"], displacement, np.array([[0.0], [0.0], [0.0]]))

    result["heat"] = timed(heat, 4 * solves)
    result["mechanics"] = timed(mechanics, solves)
    return result | {"memory": peak_memory(), "solver": plate.elastic_factor.name}


ENGINES = {"impinge": time_impinge, "scikit-fem": time_peer}


def prepare(folder, size):
    """Writes the unit and nodes for scikit-fem; returns the numbers of nodes along the axes."""
    import numpy as np
    from independent_code import run_impinge, scene
    from peer import Case

    mesh, order, _, has_peer = SIZES[size]
    mesh = f"{{ {mesh}, order = {order} }}"
    (folder / "scene.toml").write_text(scene(Case(), mesh))
    build = [ROOT / "target/release/build-fmu", folder / "scene.toml", "-o", folder / "unit.fmu"]
    subprocess.run(build, check=True, capture_output=True)
    if has_peer:
        np.savez(folder / "nodes.npz", *run_impinge(Case(), mesh)[1])
    check = [ROOT / "target/release/impinge", "check", folder / "scene.toml"]
    checked = subprocess.run(check, check=True, capture_output=True, text=True).stdout
    (counts,) = re.findall(r"(\d+) × (\d+) × (\d+) nodes", checked)
    return [int(count) for count in counts]


def repetition(engine, folder, order, solves):
    command = [sys.executable, __file__, "--engine", engine, "--folder", folder]
    command += ["--order", str(order), "--solves", str(solves)]
    ran = subprocess.run(command, check=True, capture_output=True, text=True)
    return json.loads(ran.stdout.splitlines()[-1])


def median(results, key):
    """Nothing where an engine does not tell."""
    values = [result[key] for result in results if key in result]
    return statistics.median(values) if values else None


def compare(size, repetitions):
    """Prints the table of a size."""
    _, order, solves, has_peer = SIZES[size]
    engines = list(ENGINES) if has_peer else ["impinge"]
    with TemporaryDirectory() as folder:
        counts = prepare(Path(folder), size)
        runs = {engine: [] for engine in engines}
        for _ in range(repetitions):
            for engine, results in runs.items():
                results.append(repetition(engine, folder, order, solves))
    shape = " × ".join(map(str, counts))
    nodes = counts[0] * counts[1] * counts[2]
    solver = f", {runs['scikit-fem'][0]['solver']}" if has_peer else ""
    print(f"\n{shape} = {nodes} nodes, order {order}, {os.cpu_count()} threads{solver}")
    print(f"medians of {repetitions} runs, taken in turn")
    print(f"{'':42}" + "".join(f"{engine:>12}" for engine in engines) + f"{'ratio':>9}" * has_peer)
    for key, label in LINES.items():
        found = [median(runs[engine], key) for engine in engines]
        if not any(found):
            continue
        cells = "".join(f"{value:12.4g}" if value else f"{'':12}" for value in found)
        ratio = f"{found[1] / found[0]:9.1f}" if all(found) and has_peer else ""
        print(f"{label:42}{cells}{ratio}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repetitions", type=int, default=3)
    parser.add_argument("--sizes", nargs="+", choices=SIZES, default=list(SIZES))
    parser.add_argument("--engine", choices=ENGINES, help=argparse.SUPPRESS)
    parser.add_argument("--folder", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("--order", type=int, help=argparse.SUPPRESS)
    parser.add_argument("--solves", type=int, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.engine:
        result = ENGINES[arguments.engine](arguments.folder, arguments.order, arguments.solves)
        print(json.dumps(result))
        return
    for size in arguments.sizes:
        compare(size, arguments.repetitions)


if __name__ == "__main__":
    main()
