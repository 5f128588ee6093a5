"""Two thick slabs that pass heat through a contact, as two units under a master: time, and how far
the wall is from the temperature that the joint system has, at any end of a step and at the last.

Argument: JSON with `master` ("impinge" or "libcosim"), `steps` of equal length and options of
`impinge.Master`. Slabs are linear elements with lumped capacities on graded cells, exact in time
within their units; the reference is the matrix exponential of both together (SciPy).
"""

import json
import sys
import time
import warnings
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import xarray
from impinge import Master
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave
from scipy.linalg import expm

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tests/python"), str(ROOT / "benches/charts")]
from linear_unit import make  # noqa: E402
from measure import peak_memory  # noqa: E402

CELLS, DEPTH, GROWTH = 40, 6.0, 1.12
CONDUCTANCE, STOP = 2.0, 1.0
EFFUSIVITIES = 1.0, 0.5  # of the slab that takes a flux and of that behind the contact
RING = [("a.y", "b.u"), ("b.y", "a.u")]


def slab(effusivity: float) -> tuple[np.ndarray, np.ndarray]:
    """Rates of nodes among each other, and capacities; diffusivity 1, the wall is node 0."""
    widths = GROWTH ** np.arange(CELLS)
    widths *= DEPTH / widths.sum()
    mass = effusivity * np.convolve(widths, [0.5, 0.5])
    stiffness = np.zeros((CELLS + 1, CELLS + 1))
    for i, width in enumerate(widths):
        stiffness[i : i + 2, i : i + 2] += effusivity / width * np.array([[1, -1], [-1, 1]])
    return -stiffness / mass[:, None], mass


def units(folder: str) -> dict:
    """`a` takes a flux and gives its wall's temperature; `b` has the contact and gives the flux."""
    (first, mass), (second, other) = map(slab, EFFUSIVITIES)
    wall = np.eye(CELLS + 1)[0]
    cooled = second.copy()
    cooled[0, 0] -= CONDUCTANCE / other[0]
    a = make(folder, "a", first, wall / mass[0], wall, x=np.ones(CELLS + 1), f=mass)
    b = make(folder, "b", cooled, CONDUCTANCE / other[0] * wall, CONDUCTANCE * wall, d=-CONDUCTANCE)
    return {"a": a, "b": b}


def exact(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Wall temperature of `a` and flux into it at the ends of equal steps."""
    (first, mass), (second, other) = map(slab, EFFUSIVITIES)
    n = CELLS + 1
    joint = np.block([[first, np.zeros((n, n))], [np.zeros((n, n)), second]])
    for row, capacity, sign in ((0, mass[0], -1.0), (n, other[0], 1.0)):
        joint[row, 0] += sign * CONDUCTANCE / capacity
        joint[row, n] -= sign * CONDUCTANCE / capacity
    step = expm(joint * STOP / count)
    states = [np.concatenate([np.ones(n), np.zeros(n)])]
    for _ in range(count):
        states.append(step @ states[-1])
    found = np.array(states)
    return found[:, 0], CONDUCTANCE * (found[:, n] - found[:, 0])


def by_impinge(files: dict, steps: int, options: dict) -> tuple[np.ndarray, np.ndarray, float]:
    """Times, wall temperatures, and when all units stood."""
    with Master(files, RING, step=STOP / steps, **options) as master:
        started = time.perf_counter()
        result = master.run(STOP)
    return result.time.values, result["a.y"].values, started


def by_libcosim(files: dict, steps: int) -> tuple[np.ndarray, np.ndarray, float]:
    """Units side by side in steps of one length, inputs held (libcosim's fixed-step algorithm)."""
    execution = CosimExecution.from_step_size(round(1e9 * STOP / steps))
    place = {
        name: execution.add_local_slave(CosimLocalSlave(fmu_path=str(path), instance_name=name))
        for name, path in files.items()
    }
    for source, target in (("a", "b"), ("b", "a")):
        execution.connect_real_variables(place[source], 1, place[target], 0)
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    started = time.perf_counter()
    walls = []
    for _ in range(steps):
        execution.step()
        walls.append(observer.last_real_values(place["a"], [1])[0])
    return np.arange(1, steps + 1) * STOP / steps, np.array(walls), started


def main() -> None:
    asked = json.loads(sys.argv[1])
    warnings.simplefilter("ignore")
    xarray.Dataset({"t": ("t", [0.0])})  # imports what the first of a process does
    with TemporaryDirectory() as folder:
        files = units(folder)
        before, begin = peak_memory(), time.perf_counter()
        if asked["master"] == "libcosim":
            times, walls, started = by_libcosim(files, asked["steps"])
        else:
            times, walls, started = by_impinge(files, asked["steps"], asked["options"])
        ended = time.perf_counter()
    fine = 4096
    wanted = np.interp(times, np.linspace(0.0, STOP, fine + 1), exact(fine)[0])
    late = times >= 0.1 * STOP
    values = {
        "temperature of the wall": float(np.abs(walls - wanted)[late].max()),
        "the same at the end": float(walls[-1] - wanted[-1]),
    }
    told = {"values": values, "start": started - begin, "steps": ended - started}
    print(json.dumps(told | {"memory": peak_memory() - before}))


if __name__ == "__main__":
    main()
