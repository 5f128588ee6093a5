"""Many runs of the heated bed: one by one with FMPy, as a study on processes and on Dask.

Conductivity and coefficient of convection change from run to run, so that each is initialised anew.
A study is also killed half-way and resumed: its table is that of one that was not.
"""

import argparse
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import xarray as xr
from fmpy import simulate_fmu
from impinge import Study, Unit
from impinge.study import LatinHypercube, maximum, over_time
from impinge.unit import build

SCENE = Path(__file__).resolve().parents[1] / "examples/heated_bed/scene.toml"
HEATER = 7e3  # W/m2
STOP = 600.0  # s


def study(rows: int, step: float) -> Study:
    return Study(
        SCENE,
        {"bed.conductivity": (20.0, 60.0), "bed.top.coefficient": (10.0, 50.0)},
        inputs={"heater.heat_flux": HEATER},
        outputs=[
            "thermocouple.temperature",
            over_time("rim.temperature"),
            maximum("bed.max_temperature"),
        ],
        stop=STOP,
        step=step,
        sampler=LatinHypercube(rows, seed=1),
    )


def one_by_one(rows: list[dict[str, float]], step: float) -> tuple[float, np.ndarray]:
    """Seconds a run by `simulate_fmu` on the file, and the last temperatures."""
    unit = build(SCENE)
    names = ["thermocouple.temperature", "rim.temperature", "bed.max_temperature"]
    began = time.perf_counter()
    last = [
        simulate_fmu(
            str(unit),
            stop_time=STOP,
            output_interval=step,
            start_values={**row, "heater.heat_flux": HEATER},
            output=names,
        )["thermocouple.temperature"][-1]
        for row in rows
    ]
    return (time.perf_counter() - began) / len(rows), np.array(last)


def parts_of_a_run(step: float, rows: list[dict[str, float]]) -> dict[str, float]:
    """Seconds that a run takes to be initialised, to step and to be read, in one process."""
    spent = {"initialise": 0.0, "steps": 0.0, "readings": 0.0}
    with Unit(SCENE) as unit:
        read = unit.reader(["thermocouple.temperature", "rim.temperature", "bed.max_temperature"])
        for row in rows:
            marks = [time.perf_counter()]
            unit.reset(row)
            unit["heater.heat_flux"] = HEATER
            marks.append(time.perf_counter())
            spent["initialise"] += marks[1] - marks[0]
            for _ in range(round(STOP / step)):
                begin = time.perf_counter()
                unit.step(step)
                middle = time.perf_counter()
                read()
                spent["steps"] += middle - begin
                spent["readings"] += time.perf_counter() - middle
    return {name: seconds / len(rows) for name, seconds in spent.items()}


def processor_time() -> float:
    """Seconds of this process and of those that it has started and that have ended."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(u.ru_utime + u.ru_stime for u in used)


def timed(call) -> tuple[float, xr.Dataset]:
    began = time.perf_counter()
    table = call()
    assert table.attrs["failed"] == table.attrs["not_run"] == 0
    return time.perf_counter() - began, table


def killed_and_resumed(rows: int, step: float, folder: Path) -> tuple[int, int, xr.Dataset]:
    """Runs a study in another process, kills it half-way, and goes on here."""
    command = [sys.executable, __file__, "--rows", str(rows), "--step", str(step)]
    process = subprocess.Popen([*command, "--folder", folder], start_new_session=True)
    journal = folder / "rows.jsonl"
    while not journal.is_file() or journal.read_bytes().count(b"\n") < rows // 2:
        if process.poll() is not None:
            raise RuntimeError("the study ended before it was killed")
        time.sleep(0.01)
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    time.sleep(5.0)  # its workers end
    kept = journal.read_bytes().count(b"\n")
    table = study(rows, step).run(2, folder=folder)
    return kept, journal.read_bytes().count(b"\n") - kept, table


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rows", type=int, default=1000)
    parser.add_argument("--step", type=float, default=10.0, help="s between outputs")
    parser.add_argument("--folder", type=Path, help="only run the study, into this folder")
    options = parser.parse_args()
    rows, step = options.rows, options.step
    if options.folder:
        study(rows, step).run(2, folder=options.folder)
        return
    some = study(rows, step).design.rows[:20]
    single, last = one_by_one(some, step)
    print(f"simulate_fmu, {len(some)} runs: {1 / single:.1f} runs/s ({1e3 * single:.0f} ms a run)")
    for name, seconds in parts_of_a_run(step, some).items():
        print(f"  one instance, {name}: {1e3 * seconds:.2f} ms a run")
    with tempfile.TemporaryDirectory() as folder:
        whole = Path(folder)
        before = processor_time()
        spent, table = timed(lambda: study(rows, step).run(2, folder=whole / "processes"))
        print(f"two processes: {rows / spent:.0f} runs/s ({spent:.2f} s with their start),", end="")
        print(f" {1e3 * (processor_time() - before) / rows:.2f} ms of processor time a run")
        assert np.array_equal(table["thermocouple.temperature"].values[: len(some)], last)
        from distributed import LocalCluster

        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
            address = cluster.scheduler_address
            spent, by_dask = timed(lambda: study(rows, step).run(dask=address))
        print(f"Dask, two workers at {address}: {rows / spent:.0f} runs/s ({spent:.2f} s)")
        xr.testing.assert_equal(table, by_dask)
        kept, new, resumed = killed_and_resumed(rows, step, whole / "killed")
        print(f"killed with {kept} rows written, resumed with {new} more", end="")
        xr.testing.assert_equal(table, resumed)
        assert kept + new == rows
        print(": the same table, to the bit")


if __name__ == "__main__":
    main()
