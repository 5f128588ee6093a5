"""The disc of `disc_section.py`, truncated to an order by pyMOR's balanced truncation.

Gramians are of low rank (ADI); packing is the reduction, start the matrix exponential over a step.
Argument: JSON with `order`.
"""

import json
import resource
import sys
import time

import disc_section as disc
import numpy as np
import scipy.sparse as sp
from pymor.core.logger import set_log_levels
from pymor.models.iosys import LTIModel
from pymor.reductors.bt import BTReductor
from scipy.linalg import expm


def peak() -> int:
    """Peak memory of this process [B]."""
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def reduced(order: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A, B and C."""
    of = disc.operators()
    sparse = [sp.csc_matrix(part) for part in (-of.conductance, of.capacity)]
    model = LTIModel.from_matrices(sparse[0], of.load[:, None], of.rows, E=sparse[1])
    small = BTReductor(model).reduce(order)
    a, b, c, _, e = small.to_abcde_matrices()
    return (a, b, c) if e is None else (np.linalg.solve(e, a), np.linalg.solve(e, b), c)


def advance(a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Exact over a step whose input is held."""
    joint = np.block([[a, b], [np.zeros((1, len(a) + 1))]]) * disc.STOP / disc.STEPS
    step = expm(joint)[:-1]
    return step[:, :-1], step[:, -1] * disc.FLUX


def main() -> None:
    set_log_levels({"pymor": "ERROR"})
    before, begin = peak(), time.perf_counter()
    a, b, c = reduced(json.loads(sys.argv[1])["order"])
    packed = time.perf_counter()
    step, gain = advance(a, b)
    started, state, rows = time.perf_counter(), np.zeros(len(a)), []
    for n in range(disc.STEPS):
        state = step @ state + gain * disc.LEVELS[n // disc.HELD]
        rows.append(c @ state)
    ended = time.perf_counter()
    told = {"pack": packed - begin, "start": started - packed, "steps": ended - started}
    told |= {"memory": peak() - before, "size": a.nbytes + b.nbytes + c.nbytes}
    print(json.dumps({"values": disc.values(np.array(rows))} | told))


if __name__ == "__main__":
    main()
