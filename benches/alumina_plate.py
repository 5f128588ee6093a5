"""Times the alumina plate, packed as a unit, beside the same nodes in scikit-fem.

Each repetition is a process of its own, so that the peak of memory is its own too. Medians.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "tests/verification"), str(ROOT / "tests/fmpy")]

MESH = "{ spacing = 2.5e-6, depth_spacing = 0.5e-6, growth = 1.3, order = 2 }"
ORDER = 2
STEP = 1e-8
LINES = {
    "build": "build: assembly and factorisation / s",
    "factor": "  of it, factorisation / s",
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


def time_impinge(folder):
    from master import Unit

    begin = time.perf_counter()
    with Unit(folder / "unit.fmu", {"solver.threads": os.cpu_count()}) as unit:
        result = {"build": time.perf_counter() - begin}

        def heat():
            unit.step(STEP)
            return unit["p0.temperature"]

        result["heat"] = timed(heat, 20)

        def both():
            unit.step(STEP)
            return unit["p0.stress_xx"]

        result["mechanics"] = timed(both, 5) - result["heat"]
        return result | {"memory": peak_memory()}


def time_peer(folder):
    import numpy as np
    from peer import Case, Plate

    nodes = list(np.load(folder / "nodes.npz").values())
    begin = time.perf_counter()
    plate = Plate(nodes, ORDER, Case())
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

    result["heat"] = timed(heat, 20)
    result["mechanics"] = timed(mechanics, 5)
    return result | {"memory": peak_memory(), "solver": plate.elastic_factor.name}


ENGINES = {"impinge": time_impinge, "scikit-fem": time_peer}


def prepare(folder):
    """Writes the unit and the nodes; answers how many nodes there are."""
    import numpy as np
    from independent_code import run_impinge, scene
    from peer import Case

    (folder / "scene.toml").write_text(scene(Case(), MESH))
    build = [ROOT / "target/release/build-fmu", folder / "scene.toml", "-o", folder / "unit.fmu"]
    subprocess.run(build, check=True, capture_output=True)
    _, nodes = run_impinge(Case(), MESH)
    np.savez(folder / "nodes.npz", *nodes)
    return [len(axis) for axis in nodes]


def repetition(engine, folder):
    command = [sys.executable, __file__, "--engine", engine, "--folder", folder]
    ran = subprocess.run(command, check=True, capture_output=True, text=True)
    return json.loads(ran.stdout.splitlines()[-1])


def median(results, key):
    """Nothing where an engine does not tell."""
    values = [result[key] for result in results if key in result]
    return statistics.median(values) if values else None


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repetitions", type=int, default=3)
    parser.add_argument("--engine", choices=ENGINES, help=argparse.SUPPRESS)
    parser.add_argument("--folder", type=Path, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.engine:
        print(json.dumps(ENGINES[arguments.engine](arguments.folder)))
        return
    with TemporaryDirectory() as folder:
        counts = prepare(Path(folder))
        runs = {engine: [] for engine in ENGINES}
        for _ in range(arguments.repetitions):
            for engine, results in runs.items():
                results.append(repetition(engine, folder))
    nodes = counts[0] * counts[1] * counts[2]
    shape = " × ".join(map(str, counts))
    solver = runs["scikit-fem"][0]["solver"]
    print(f"{shape} = {nodes} nodes, order {ORDER}, {os.cpu_count()} threads, {solver}")
    print(f"medians of {arguments.repetitions} runs, taken in turn")
    print(f"{'':42}{'impinge':>12}{'scikit-fem':>12}{'ratio':>9}")
    for key, label in LINES.items():
        ours, theirs = (median(runs[engine], key) for engine in ENGINES)
        ratio = f"{theirs / ours:9.1f}" if ours else ""
        print(f"{label:42}{f'{ours:.4g}' if ours else '':>12}{theirs:12.4g}{ratio}")


if __name__ == "__main__":
    main()
