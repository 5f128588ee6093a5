"""The disc of `disc_section.py` as a unit, full or reduced.

Argument: JSON with `fidelity`, as of a scene, and `mesh`, or none where it follows from that.
"""

import json
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import disc_section as disc  # puts the folder of all benches on the path
import numpy as np
from impinge import Unit
from problems import plates

sys.path.append(str(Path(__file__).resolve().parents[1]))
from measure import pack, peak_memory  # noqa: E402


def scene(fidelity: dict, mesh: dict | None) -> dict:
    plate = {
        "shape": {"disc": {"radius": disc.HALF, "thickness": disc.THICKNESS}},
        "faces": {"bottom": {"convection": {"coefficient": disc.COOLING, "ambient": plates.START}}},
    }
    plate |= {"mesh": mesh} if mesh else {}
    spot = plates.load(plates.disc(disc.RADIUS), "heat_flux", disc.FLUX)
    probes = [
        plates.probe(name, [r, 0.0, -z], "temperature") for name, (r, z) in disc.POINTS.items()
    ]
    step = disc.STOP / disc.STEPS
    return plates.scene(plate, disc.STOP, step, "Flicker", load=[spot], probe=probes) | fidelity


def drive(file: Path, names: list[str]) -> tuple[np.ndarray, dict]:
    """What is read at the ends of all steps, and times and memory."""
    before, begin = peak_memory(), time.perf_counter()
    with Unit(file) as unit:
        read = unit.reader(names)
        started, rows = time.perf_counter(), []
        for n in range(disc.STEPS):
            if n % disc.HELD == 0:
                unit["spot.heat_flux"] = disc.FLUX * disc.LEVELS[n // disc.HELD]
            unit.step(disc.STOP / disc.STEPS)
            rows.append(np.array(read()))
        ended = time.perf_counter()
    told = {"start": started - begin, "steps": ended - started, "memory": peak_memory() - before}
    return np.array(rows), told


def main() -> None:
    asked = json.loads(sys.argv[1])
    names = [f"{name}.temperature" for name in disc.POINTS]
    is_reduced = asked["fidelity"].get("level") == "reduced"
    with TemporaryDirectory() as folder:
        told = scene({"fidelity": asked["fidelity"]}, asked["mesh"])
        file, packing = pack(told, Path(folder))
        rows, spent = drive(file, names + ["plate.error_bound_temperature"] * is_reduced)
        size = file.stat().st_size
    values = disc.values(rows[:, : len(names)] - plates.START)
    if is_reduced:
        values[disc.BOUND] = float(rows[-1, -1])
    if not asked["mesh"]:
        del values[disc.DIFFERENCE]
    print(json.dumps({"values": values, "pack": packing, "size": size} | spent))


if __name__ == "__main__":
    main()
