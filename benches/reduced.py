"""Reduced solids beside full ones: error, bound, time to initialise and per step, size of a state.

Both take the same steps under the same inputs, which change at random every few steps; outputs are read in the last
tenth of the steps alone, where errors are compared.
"""

import random
import sys
import tempfile
import time
from pathlib import Path

from impinge import Unit
from impinge.unit import build

ROOT = Path(__file__).resolve().parents[1]
# Without fields of stress, which a reduced model does not have; inputs, with the largest value of each.
CASES = {
    "alumina_plate": ({"spot.heat_flux": 5e8, "spot.pressure": 1e6}, "centre"),
    "heated_bed": ({"heater.heat_flux": 2e4, "fan.heat_flux": -2e3, "bed.top.ambient": 300.0}, "middle"),
    "moving_spot": ({"spot.heat_flux": 2e7, "spot.x": 0.5e-3, "spot.y": 0.25e-3}, "crossing"),
}
STEPS, HELD = 200, 20


def scene(name, level, folder):
    text = (ROOT / "examples" / name / "scene.toml").read_text()
    head, _, rest = text.partition("[[field]]")
    text = head + rest[rest.find("\n[[") :] if "\n[[" in rest else head
    path = Path(folder) / f"{name}_{level}.toml"
    path.write_text(f'{text}\n[fidelity]\nlevel = "{level}"\ntolerance = 1e-3\n')
    return path


def values(inputs, rng):
    moved = {name for name in inputs if name.endswith((".x", ".y"))}
    return {n: v * (rng.uniform(-1, 1) if n in moved else rng.random()) for n, v in inputs.items()}


def run(path, inputs, outputs, step):
    rng = random.Random(7)
    begin = time.perf_counter()
    unit = Unit(build(path))
    unit.step(step)
    started = time.perf_counter() - begin
    found, spent = [], 0.0
    for n in range(STEPS):
        if n % HELD == 0:
            unit.set(values(inputs, rng) if "ambient" not in str(inputs) else
                     {**values(inputs, rng), "bed.top.ambient": 293.15 + 20 * rng.random()})
        begin = time.perf_counter()
        unit.step(step)
        spent += time.perf_counter() - begin
        if n >= STEPS - STEPS // 10:
            found.append(unit.get(outputs))
    return unit, started, 1e6 * spent / STEPS, found


def main():
    steps = {"alumina_plate": 1e-8, "heated_bed": 0.5, "moving_spot": 2.5e-5}
    print(f"{'':16s}{'level':10s}{'start [s]':>10s}{'step [µs]':>11s}{'error':>12s}{'bound':>12s}")
    for name in sys.argv[1:] or CASES:
        inputs, probe = CASES[name]
        with tempfile.TemporaryDirectory() as folder:
            outputs = [f"{probe}.temperature"]
            results = {}
            for level in ("full", "reduced"):
                results[level] = run(scene(name, level, folder), inputs, outputs, steps[name])
            unit, *_ = results["reduced"]
            body = "bed" if name == "heated_bed" else "plate"
            bound = unit.get([f"{body}.error_bound_temperature"])
            pairs = zip(results["full"][3], results["reduced"][3])
            error = max(abs(list(a.values())[0] - list(b.values())[0]) for a, b in pairs)
            for level, (_, started, spent, _) in results.items():
                said = f"{error:12.2e}{list(bound.values())[0]:12.2e}" if level == "reduced" else ""
                print(f"{name:16s}{level:10s}{started:10.2f}{spent:11.2f}{said}")


if __name__ == "__main__":
    main()
