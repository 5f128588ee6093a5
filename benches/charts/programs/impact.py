"""A drop that hits a wall, as a unit that a host steps: its peak force or its largest spread.

`impact.py '{"of": "force", "name": "peak force", "weber": 250, "reynolds": 6000, "across": 24}'`;
`body` has more keys of the droplet. Water's density, 2 mm and 1 m/s; the wall meets fluid at 90°.
"""

import json
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

# The folders of charts and of all benches.
sys.path += [str(folder) for folder in Path(__file__).resolve().parents[1:3]]

from measure import pack, peak_memory  # noqa: E402
from problems.drops import droplet, wall  # noqa: E402
from problems.materials import liquid  # noqa: E402

DIAMETER, SPEED, DENSITY = 2e-3, 1.0, 1000.0  # m, m/s, kg/m³
TIME = DIAMETER / SPEED
FORCE = DENSITY * SPEED**2 * DIAMETER**2  # N
UNTIL = {"force": 0.5, "spread": 3.0}
"""D/U."""
STEP = {"force": 0.01, "spread": 0.05}
"""Communication step over D/U."""
WINDOW = 10
"""Steps over which the force is a mean."""
BACK = 0.1
"""Over D: a film that has drawn back by that is past its widest."""


def scene(asked: dict) -> dict:
    viscosity = DENSITY * SPEED * DIAMETER / asked["reynolds"]
    tension = DENSITY * SPEED**2 * DIAMETER / asked["weber"]
    fluid = liquid(DENSITY, viscosity, 4000.0, 0.0, tension)
    drop = droplet(DIAMETER, SPEED, 293.15, fluid, spacing=DIAMETER / asked["across"])
    return {
        "name": "Impact",
        "stop_time": UNTIL[asked["of"]] * TIME,
        "step": STEP[asked["of"]] * TIME,
        "body": {"drop": drop | asked.get("body", {})},
        "wall": [wall(1, 5.0 * DIAMETER, 293.15)],
        "solver": {"threads": 1},
    }


def advance(unit, of: str):
    """Impulse into the wall [N s] and spread [m] at the start and after each step."""
    read = unit.reader(["drop.impulse_z", "drop.spread_diameter"])
    rows = [tuple(map(float, read()))]
    for _ in range(round(UNTIL[of] / STEP[of])):
        unit.step(STEP[of] * TIME)
        rows.append(tuple(map(float, read())))
        widest = max(spread for _, spread in rows)
        if of == "spread" and rows[-1][1] < widest - BACK * DIAMETER:
            break
    return rows


def value(rows, of: str) -> float:
    """The highest mean force over ρU²D², or the largest spread over D."""
    if of == "spread":
        return max(spread for _, spread in rows) / DIAMETER
    impulses = [abs(impulse) for impulse, _ in rows]
    window = WINDOW * STEP[of] * TIME
    pairs = zip(impulses, impulses[WINDOW:], strict=False)
    return max(after - before for before, after in pairs) / window / FORCE


def main() -> None:
    from impinge import Unit

    asked = json.loads(sys.argv[1])
    with TemporaryDirectory() as folder:
        file, _ = pack(scene(asked), Path(folder))
        before = peak_memory()
        begin = time.perf_counter()
        with Unit(file) as unit:
            started = time.perf_counter()
            rows = advance(unit, asked["of"])
            ended = time.perf_counter()
        told = {
            "values": {asked["name"]: value(rows, asked["of"])},
            "start": started - begin,
            "steps": ended - started,
            "memory": peak_memory() - before,
        }
    print(json.dumps(told))


if __name__ == "__main__":
    main()
