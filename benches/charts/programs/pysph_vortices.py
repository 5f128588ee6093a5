"""Taylor and Green's vortices by PySPH (doi 10.1145/3460773), its own example on one thread.

`pysph_vortices.py '{"scheme": "edac", "side": 25, "scatter": 0.2, "reynolds": 100, "stop": 0.5}'`:
double precision; particles are moved by up to `scatter` of their distance along each axis first.
With `is_settled` they start from where a first run, which is not timed, has left them.
"""

import json
import re
import resource
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np


def main() -> None:
    asked = json.loads(sys.argv[1])
    with TemporaryDirectory() as folder:
        start = ["--perturb", str(asked["scatter"])]
        if asked.get("is_settled"):
            run(asked, start, folder)
            start = ["--init", str(results(folder)[-1])]
        with TemporaryDirectory() as beside:
            begin = time.perf_counter()
            steps = run(asked, start, beside)
            values = errors(results(beside), asked)
            total = time.perf_counter() - begin
    memory = 1024 * resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
    print(json.dumps({"values": values, "start": total - steps, "steps": steps, "memory": memory}))


def run(asked: dict, start: list[str], folder: str) -> float:
    """Leaves results in a folder; how long all steps took [s]."""
    command = [sys.executable, "-m", "pysph.examples.taylor_green"]
    command += ["--nx", str(asked["side"]), "--re", str(asked["reynolds"])]
    command += ["--tf", str(asked["stop"]), "--scheme", asked["scheme"], *start]
    command += ["--pfreq", "1000000", "--directory", folder]
    ran = subprocess.run(command, check=True, capture_output=True, text=True)
    return float(re.search(r"Run took: ([\d.]+)", ran.stdout)[1])


def results(folder: str) -> list[Path]:
    return sorted(Path(folder).glob("taylor_green_*"), key=number)


def number(path: Path) -> int:
    return int(re.search(r"_(\d+)\.", path.name)[1])


def errors(files: list[Path], asked: dict) -> dict[str, float]:
    """Of the velocities at the end, and of the rate at which the kinetic energy falls."""
    from pysph.solver.utils import load

    first, last = (load(str(file)) for file in (files[0], files[-1]))
    fluid, time_reached = last["arrays"]["fluid"], last["solver_data"]["t"]
    rate = 8.0 * np.pi**2 / asked["reynolds"]
    left = np.exp(-rate * time_reached)
    x, y = 2.0 * np.pi * fluid.x, 2.0 * np.pi * fluid.y
    exact = left * np.array([-np.cos(x) * np.sin(y), np.sin(x) * np.cos(y)])
    found = np.array([fluid.u, fluid.v])

    def energy(fluid) -> float:
        return float(np.sum(fluid.m * (fluid.u**2 + fluid.v**2)))

    decay = np.log(energy(first["arrays"]["fluid"]) / energy(fluid)) / (2.0 * rate * time_reached)
    return {
        "error of velocities": float(np.sqrt(np.sum((found - exact) ** 2) / np.sum(exact**2))),
        "rate of decay": float(decay),
    }


if __name__ == "__main__":
    main()
