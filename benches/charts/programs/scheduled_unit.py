"""A unit whose inputs change on the way.

Argument: JSON with `scene`, `steps` of equal length up to its stop time, `outputs` (variables by
quantity, read at the end of every step), and `schedule`: step from which on, and inputs.
"""

import json
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from impinge import Unit

sys.path.append(str(Path(__file__).resolve().parents[1]))
from measure import pack, peak_memory  # noqa: E402


def main() -> None:
    asked = json.loads(sys.argv[1])
    schedule = dict(asked["schedule"])
    with TemporaryDirectory() as folder:
        file, packing = pack(asked["scene"], Path(folder))
        size, before, begin = file.stat().st_size, peak_memory(), time.perf_counter()
        with Unit(file) as unit:
            read = unit.reader(list(asked["outputs"].values()))
            length, started = unit.default_stop / asked["steps"], time.perf_counter()
            for n in range(asked["steps"]):
                for name, value in schedule.get(n, {}).items():
                    unit[name] = value
                unit.step(length)
                last = read()
            ended = time.perf_counter()
    values = dict(zip(asked["outputs"], map(float, last), strict=True))
    told = {"pack": packing, "start": started - begin, "steps": ended - started, "size": size}
    print(json.dumps({"values": values, "memory": peak_memory() - before} | told))


if __name__ == "__main__":
    main()
