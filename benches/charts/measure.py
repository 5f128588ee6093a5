"""Runs one point of a chart in a process of its own."""

import json
import subprocess
import sys
import time
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

import tomli_w
from chart import Formula, Outcome, Point, ProgramRun, UnitRun

ROOT = Path(__file__).resolve().parents[2]
LIMIT = 900.0  # s, for one repetition
ABOUT = 2e-2  # s that a formula is repeated for


def peak_memory() -> int:
    """Of this process [B]."""
    status = Path("/proc/self/status").read_text()
    (line,) = (line for line in status.splitlines() if line.startswith("VmHWM"))
    return 1024 * int(line.split()[1])


def drive(unit_file: str, work: dict) -> dict:
    """Starts, steps and reads a packed unit."""
    from impinge import Unit

    before = peak_memory()
    begin = time.perf_counter()
    with Unit(Path(unit_file)) as unit:
        for name, value in work["inputs"].items():
            unit[name] = value
        read = unit.reader(list(work["outputs"].values()))
        started = time.perf_counter()
        length = unit.default_stop / work["steps"]
        for _ in range(work["steps"]):
            unit.step(length)
            last = read()
        ended = time.perf_counter()
        values = dict(zip(work["outputs"], map(float, last), strict=True))
    return {
        "values": values,
        "start": started - begin,
        "steps": ended - started,
        "memory": peak_memory() - before,
    }


def pack(scene: dict, folder: Path) -> tuple[Path, float]:
    """The unit's file, and how long packing took [s]."""
    text, unit = folder / "scene.toml", folder / "unit.fmu"
    text.write_text(tomli_w.dumps(scene))
    begin = time.perf_counter()
    command = [ROOT / "target/release/build-fmu", text, "-o", unit]
    packed = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT)
    if packed.returncode:
        raise RuntimeError(packed.stderr.strip().splitlines()[0])
    return unit, time.perf_counter() - begin


def run_unit(work: UnitRun, repetitions: int) -> Outcome:
    told = {"inputs": work.inputs, "outputs": work.outputs, "steps": work.steps}
    with TemporaryDirectory() as folder:
        unit, packing = pack(work.scene, Path(folder))
        runs = repeated([sys.executable, __file__, unit, json.dumps(told)], repetitions)
        size = unit.stat().st_size
    return Outcome(values=runs[0]["values"], pack=packing, size=size, **medians(runs))


def run_program(work: ProgramRun, repetitions: int) -> Outcome:
    python = ROOT / work.environment / "bin/python"
    program = Path(__file__).parent / "programs" / work.program
    runs = repeated([python, program, json.dumps(work.arguments)], repetitions)
    packing = median(run.get("pack", 0.0) for run in runs)
    size = runs[0].get("size", 0)
    return Outcome(values=runs[0]["values"], pack=packing, size=size, **medians(runs))


def repeated(command: list, repetitions: int) -> list[dict]:
    """The last lines of the command's output, read as JSON."""
    runs = []
    for _ in range(repetitions):
        ran = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT)
        if ran.returncode:
            raise RuntimeError((ran.stderr.strip() or "no message").splitlines()[-1])
        runs.append(json.loads(ran.stdout.splitlines()[-1]))
    return runs


def medians(runs: list[dict]) -> dict[str, float]:
    return {key: median(run[key] for run in runs) for key in ("start", "steps", "memory")}


def run_formula(work: Formula) -> Outcome:
    begin, count = time.perf_counter(), 0
    while count == 0 or time.perf_counter() - begin < ABOUT:
        values = work.evaluate()
        count += 1
    spent = (time.perf_counter() - begin) / count
    return Outcome(values, pack=0.0, start=0.0, steps=spent, memory=0, size=0)


def measure(point: Point, repetitions: int) -> Outcome:
    try:
        match point.work:
            case UnitRun() as work:
                return run_unit(work, repetitions)
            case ProgramRun() as work:
                return run_program(work, repetitions)
            case Formula() as work:
                return run_formula(work)
    except (RuntimeError, subprocess.TimeoutExpired) as failure:
        return Outcome({}, 0.0, 0.0, 0.0, 0.0, 0, str(failure))


if __name__ == "__main__":
    print(json.dumps(drive(sys.argv[1], json.loads(sys.argv[2]))))
