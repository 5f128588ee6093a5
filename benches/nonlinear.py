"""Times nonlinear heat and yield, packed as units, beside the same nodes in scikit-fem.

Each code takes one step after the other, in turn, over the same course; medians without the first
step, in which PARDISO orders its systems and scikit-fem's bases are made. The peer's set-up is the
best there is: heat as ∫ k dT, so that only diagonals change; element matrices by batches of dense
products; one symbolic factor for all systems. Heat goes at equal errors in time: the peer's steps
are as few as keep its own below that which impinge is asked for.
"""

import argparse
import os
import statistics
import subprocess
import sys
import time
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "tests/verification"), str(ROOT / "tests/fmpy")]

HEAT_SPACINGS = [4.4e-5, 3.4e-5]
YIELD_MESHES = [
    "spacing = 1.4e-4, depth_spacing = 0.5e-4, growth = 1.2, order = 2",
    "spacing = 1e-4, depth_spacing = 0.4e-4, growth = 1.2, order = 2",
]
COARSE = 1e-4
TIME_ERROR = 0.3  # K
TOLERANCE = 2e-1  # Of impinge's `fidelity`, with which it makes that error.


CLOCKS = {"wall": time.perf_counter, "processor": time.process_time}


@dataclass(frozen=True)
class Way:
    """How it is measured."""

    clock: str
    threads: int
    repetitions: int

    def timed(self, call):
        begin = CLOCKS[self.clock]()
        call()
        return CLOCKS[self.clock]() - begin


def pack(text, folder):
    (folder / "scene.toml").write_text(text)
    build = [ROOT / "target/release/build-fmu", folder / "scene.toml", "-o", folder / "unit.fmu"]
    subprocess.run(build, check=True, capture_output=True)
    return folder / "unit.fmu"


def report(name, axes, ours, theirs, newton):
    shape = " × ".join(str(len(axis)) for axis in axes)
    count = 1
    for axis in axes:
        count *= len(axis)
    ours, theirs = statistics.median(ours[1:]), statistics.median(theirs[1:])
    print(
        f"| {name} | {shape} = {count} | {ours:.3g} | {theirs:.3g} | {newton:.3g} "
        f"| {theirs / newton:.3g} | {theirs / ours:.1f} |",
        flush=True,
    )


def errors_in_time():
    """On a coarse mesh: the peer's steps in one of ours, and the errors of ours and its [K]."""
    import nonlinear_heat as study
    import numpy as np

    def apart(one, other):
        return np.abs(one.temperature - other.temperature).max()

    axes, ours = study.run_impinge(COARSE, tolerance=TOLERANCE)
    own = apart(ours, study.run_impinge(COARSE, tolerance=1e-5)[1])
    finest, _ = study.run_peer(axes, study.Integral, 48)
    for inner in (4, 6, 8, 10, 12, 16, 20):
        error = apart(study.run_peer(axes, study.Integral, inner)[0], finest)
        if error < TIME_ERROR:
            return inner, own, error
    raise RuntimeError("the peer's heat needs shorter steps than foreseen")


def bench_heat(spacing, inner, way):
    import nonlinear_heat as study
    from master import Unit

    axes, _ = study.run_impinge(spacing, study.STOP / 1000)
    step = study.STOP / study.STEPS
    with TemporaryDirectory() as folder:
        file = pack(study.scene(spacing, TOLERANCE), Path(folder))
        with Unit(file, {"solver.threads": way.threads}) as unit:
            peer = study.Integral(axes, study.STEEL, study.COLD, study.EMISSIVITY)
            peer.heat_by(study.FLUX, study.RADIUS)
            ours, theirs = [], []
            for number in range(way.repetitions + 1):
                ours.append(way.timed(lambda: (unit.step(step), unit["plate.max_temperature"])))
                if number == 1:
                    peer.newton_steps = 0
                theirs.append(way.timed(lambda: peer.advance(step, inner)))
            apart = abs(unit["plate.max_temperature"] - peer.temperature().max())
    report("heat", axes, ours, theirs, peer.newton_steps / way.repetitions)
    assert apart < 20.0, apart


def bench_yield(mesh, way):
    import numpy as np
    import plasticity as study
    from master import Unit

    box = next(case for case in study.CASES if "box" in case.shape)
    case = replace(box, mesh=mesh, course=((1.0, 0.1, 5),))
    step = 0.02
    with TemporaryDirectory() as folder:
        folder = Path(folder)
        file = pack(study.scene(case), folder)
        first = {"output.directory": str(folder / "out"), "spot.heat_flux": case.flux}
        with Unit(file, first) as unit:
            axes, *_ = study.fields(folder / "out", False)
        with Unit(file, {"solver.threads": way.threads, "spot.heat_flux": case.flux}) as unit:
            body = study.Body(tuple(axes), case.metal, study.COLD, case.held)
            body.assemble_heat()
            spot = body.flux_under_spot(case.flux, case.radius)
            rise = np.zeros(len(spot))
            ours, theirs = [], []
            for number in range(way.repetitions + 1):
                ours.append(way.timed(lambda: (unit.step(step), unit["plate.plastic_work"])))
                rise = body.advance_heat(rise, spot, step, study.INNER)
                if number == 1:
                    body.newton_steps = 0
                temperature = study.COLD + rise
                theirs.append(way.timed(lambda at=temperature: body.advance(at)))
            apart = unit["plate.plastic_work"] / body.dissipated() - 1
    report("yield", axes, ours, theirs, body.newton_steps / way.repetitions)
    assert abs(apart) < 0.01, apart


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repetitions", type=int, default=3)
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--clock", choices=CLOCKS, default="wall")
    parser.add_argument("--only", choices=["heat", "yield"])
    parser.add_argument("--sizes", type=int, default=2, help="1: the smaller mesh alone")
    given = parser.parse_args()
    way = Way(given.clock, given.threads, given.repetitions)
    # Read when the libraries are loaded; the batches are of small products.
    os.environ |= {"MKL_NUM_THREADS": str(given.threads), "OPENBLAS_NUM_THREADS": "1"}
    print(f"{way.clock} time [s], {way.threads} threads, medians of {way.repetitions}\n")
    print("| | nodes | impinge | scikit-fem, PARDISO | its Newton steps | each | ratio |")
    print("|---|---|---|---|---|---|---|", flush=True)
    if given.only != "yield":
        inner, own, error = errors_in_time()
        for spacing in HEAT_SPACINGS[: given.sizes]:
            bench_heat(spacing, inner, way)
    if given.only != "heat":
        for mesh in YIELD_MESHES[: given.sizes]:
            bench_yield(mesh, way)
    if given.only != "yield":
        print(f"\nHeat: errors in time of {own:.2f} K and {error:.2f} K at the end of the course;")
        print(f"scikit-fem takes {inner} steps of two stages in one step of impinge.")


if __name__ == "__main__":
    main()
