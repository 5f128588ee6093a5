"""A column of water that is let go, by PySPH (doi 10.1145/3460773): its own example on one thread.

`pysph_dam.py '{"scheme": "wcsph", "across": 32, "stop": 2.5, "names": {…}}'`: so many particles
over the width, up to so many √(a/2g). The example's column is 1 m by 2 m, its tank 4 m by 4 m.
Asked for another distance of particles, the example keeps masses and supports of its own 0.03 m;
here they follow. `alpha` is of the artificial viscosity, 0.1 if nothing is said.
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

GRAVITY = 9.81
EXAMPLE = """
import pysph.examples.dam_break_2d as example

example.dx = {dx!r}
example.h, example.m = example.hdx * example.dx, example.dx**2 * example.ro
example.DamBreak2D(fname="dam").run()
"""


def main() -> None:
    asked = json.loads(sys.argv[1])
    stop = asked["stop"] / (2.0 * GRAVITY) ** 0.5
    begin = time.perf_counter()
    with TemporaryDirectory() as folder:
        dx = 1.0 / asked["across"]
        command = [sys.executable, "-c", EXAMPLE.format(dx=dx)]
        command += ["--dx", repr(dx), "--tf", repr(stop)]
        command += ["--alpha", repr(asked["alpha"])] if "alpha" in asked else []
        command += ["--scheme", asked["scheme"], "--pfreq", "1000000", "--directory", folder]
        ran = subprocess.run(command, check=True, capture_output=True, text=True)
        files = sorted(Path(folder).glob("dam_*"), key=number)
        values = compared(files[0], files[-1], stop, asked["names"])
    total = time.perf_counter() - begin
    steps = float(re.search(r"Run took: ([\d.]+)", ran.stdout)[1])
    memory = 1024 * resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
    print(json.dumps({"values": values, "start": total - steps, "steps": steps, "memory": memory}))


def number(path: Path) -> int:
    return int(re.search(r"_(\d+)\.", path.name)[1])


def compared(first: Path, last: Path, stop: float, names: dict[str, str]) -> dict[str, float]:
    """How far front and middle have gone, over the width; the last step ends at `stop`."""
    from pysph.solver.utils import load

    before, after = (load(str(file)) for file in (first, last))
    reached = after["solver_data"]["t"]
    if abs(reached - stop) > 1e-6 * stop:
        raise SystemExit(f"ended at {reached} s, not at {stop} s")
    x, there = (of["arrays"]["fluid"].x for of in (before, after))
    return {
        names["front"]: float(1.0 + np.max(there) - np.max(x)),
        names["middle"]: float(0.5 + np.mean(there) - np.mean(x)),
    }


if __name__ == "__main__":
    main()
