"""A unit whose inputs change on the way.

Argument: JSON with `scene`, `outputs` (variables by quantity), `schedule` (a step from which on,
and inputs), and `steps` of equal length up to its stop time, or `ends` of steps [s]. Quantities are
read at the end of every step and told after the last one, or after that which `moments` names.
"""

import json
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from impinge import Unit

sys.path.append(str(Path(__file__).resolve().parents[1]))
from measure import pack, peak_memory  # noqa: E402


def follow(unit, asked: dict, read) -> list[list[float]]:
    """What is read after every step."""
    schedule = dict(asked["schedule"])
    stop = unit.default_stop
    ends = asked.get("ends")
    lengths = asked["steps"] * [stop / asked["steps"]] if ends is None else differences(ends)
    rows = []
    for n, length in enumerate(lengths):
        for name, value in schedule.get(n, {}).items():
            unit[name] = value
        unit.step(length)
        rows.append(list(map(float, read())))
    return rows


def differences(ends: list[float]) -> list[float]:
    return [end - begin for begin, end in zip([0.0, *ends], ends, strict=False)]


def told(asked: dict, rows: list[list[float]]) -> dict[str, float]:
    moments = asked.get("moments", {})
    return {
        name: rows[moments.get(name, len(rows)) - 1][place]
        for place, name in enumerate(asked["outputs"])
    }


def main() -> None:
    asked = json.loads(sys.argv[1])
    with TemporaryDirectory() as folder:
        file, packing = pack(asked["scene"], Path(folder))
        size, before, begin = file.stat().st_size, peak_memory(), time.perf_counter()
        with Unit(file) as unit:
            read = unit.reader(list(asked["outputs"].values()))
            started = time.perf_counter()
            rows = follow(unit, asked, read)
            ended = time.perf_counter()
    times = {"pack": packing, "start": started - begin, "steps": ended - started, "size": size}
    memory = peak_memory() - before
    print(json.dumps({"values": told(asked, rows), "memory": memory} | times))


if __name__ == "__main__":
    main()
