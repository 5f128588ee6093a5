"""Times one reading of the stress intensities of thousands of scratches on a cooled plate."""

import argparse
import statistics
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from impinge import Unit

STEP = 1e-3  # s
PLATE = f"""
name = "Scratches"
stop_time = {100 * STEP!r}
step = {STEP!r}
[body.plate]
kind = "solid"
shape = {{ box = [6e-3, 4e-3, 2e-3] }}
initial_temperature = 573.15
mesh = {{ spacing = 1e-3, depth_spacing = 5e-5 }}
faces.top = {{ temperature = 536.25 }}
faces.bottom = {{ roller = true }}
faces.sides = {{ roller = true }}
[body.plate.material]
model = "thermoelastic"
density = 3980.0
specific_heat = 880.0
conductivity = 31.0
young = 340e9
poisson = 0.22
expansion = 8e-6
toughness = 3.8e6
"""


def scratches(count: int) -> str:
    random = np.random.default_rng(1)
    places = random.uniform(-1.0, 1.0, (count, 2)) * [2.5e-3, 1.5e-3]
    depths = random.uniform(1e-4, 2e-4, count)
    rows = zip(places.tolist(), depths.tolist(), strict=True)
    return "".join(
        f'[[flaw]]\nname = "f{n}"\nin = "plate"\nat = [{x!r}, {y!r}, 0.0]\n'
        f'normal = [1.0, 0.0, 0.0]\ndepth = {depth!r}\ngives = ["stress_intensity"]\n'
        for n, ((x, y), depth) in enumerate(rows)
    )


def median_of(unit: Unit, names: list[str], repeat: int) -> float:
    """Median time of a reading of these names, each after a step [ms]."""
    times = []
    for _ in range(repeat + 1):
        unit.step(STEP)
        start = time.perf_counter()
        unit.get(names)
        times.append(time.perf_counter() - start)
    return 1e3 * statistics.median(times[1:])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--flaws", type=int, default=10_000)
    parser.add_argument("--repeat", type=int, default=10)
    options = parser.parse_args()
    names = [f"f{n}.stress_intensity" for n in range(options.flaws)]
    with TemporaryDirectory() as folder:
        file = Path(folder) / "scratches.toml"
        file.write_text(PLATE + scratches(options.flaws))
        with Unit(file) as unit:
            one, every = (median_of(unit, own, options.repeat) for own in (names[-1:], names))
    print(f"the stress of the plate, read at one flaw: {one:.1f} ms, median of readings")
    print(f"{options.flaws} flaws: {every:.1f} ms, {every - one:.1f} ms beyond that stress")


if __name__ == "__main__":
    main()
