"""Axisymmetric droplets beside the quarter of three dimensions: error, cost, and their limits.

The drop of `examples/droplet_impact` on a disc of the same material, or on its own box. Each run is
one call of `impinge run`; times are processor times of these on one thread, taken in turn, the
median of several. Orders and limits follow from three resolutions in a constant ratio (Richardson).
"""

import argparse
import csv
import math
import resource
import statistics
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory

ROOT = Path(__file__).resolve().parents[1]
D_OVER_U = 2e-6  # s
READ = {
    "centre.temperature": "centre [K]",
    "drop.heat": "heat [J]",
    "drop.impulse_z": "impulse [N s]",
    "drop.spread_diameter": "spread [m]",
    "drop.height": "height [m]",
    "plate.max_temperature": "plate's highest [K]",
}


def scene(symmetry, across, radial, depth, stop, on_box):
    """The scene's text with so many particles over the diameter."""
    text = (ROOT / "examples/droplet_impact/scene.toml").read_text()
    text = text[: text.index("[[field]]")]
    to_disc = [
        ("box = [2e-3, 2e-3, 0.26e-3]", "disc = { radius = 1e-3, thickness = 0.26e-3 }"),
        ("sides = { clamped = true }", "side = { clamped = true }"),
    ]
    for old, new in ([] if on_box else to_disc) + [
        ("spacing = 2.5e-6 ", f'symmetry = "{symmetry}"\nspacing = {1e-4 / across!r} '),
        (
            "spacing = 7.5e-6, depth_spacing = 0.3e-6",
            f"spacing = {radial!r}, depth_spacing = {depth!r}",
        ),
        ("stop_time = 3.5e-6", f"stop_time = {stop!r}"),
        (", young = 300e9, poisson = 0.21, expansion = 8.1e-6", ""),
        ('"temperature", "stress", "max_principal", "displacement"', '"temperature"'),
        ('"temperature", "stress", "max_principal"', '"temperature"'),
        ('"temperature", "stress"', '"temperature"'),
        ("sides = { clamped = true }" if on_box else "side = { clamped = true }", ""),
    ]:
        assert old in text, old
        text = text.replace(old, new)
    return text + "\n[solver]\nthreads = 1\n"


def run(program, text):
    """Rows by time, and processor time [s]."""
    with TemporaryDirectory() as folder:
        path = Path(folder, "scene.toml")
        path.write_text(text)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        command = [program, "run", path, "--out", Path(folder, "out"), "--fields-every", "0"]
        subprocess.run(command, check=True, capture_output=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        (table,) = Path(folder, "out").glob("*.csv")
        with open(table) as file:
            rows = [
                {k.split(" ")[0]: float(v) for k, v in row.items()} for row in csv.DictReader(file)
            ]
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return rows, seconds


def at(rows, time, name):
    return min(rows, key=lambda row: abs(row["time"] - time))[name]


def mean(rows, first, last, name):
    """Over part of a run: single times ring with the fluid's sound."""
    values = [row[name] for row in rows if first - 1e-12 <= row["time"] <= last + 1e-12]
    return sum(values) / len(values)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default=str(ROOT / "target/release/impinge"))
    parser.add_argument("--rings", type=float, nargs="*", default=[40, 80, 160])
    parser.add_argument("--quarters", type=float, nargs="*", default=[40])
    parser.add_argument("--radial", type=float, default=2.5e-6)
    parser.add_argument("--depth", type=float, default=0.1e-6)
    parser.add_argument("--stop", type=float, default=3.5e-6)
    parser.add_argument("--box", action="store_true", help="on the example's box instead of a disc")
    parser.add_argument(
        "--repeat", type=int, default=1, help="runs of each, of which times are medians"
    )
    options = parser.parse_args()
    found, times = {}, {}
    cases = [("axisymmetric", n) for n in options.rings] + [
        ("quarter", n) for n in options.quarters
    ]
    for _ in range(options.repeat):
        for symmetry, across in cases:
            text = scene(symmetry, across, options.radial, options.depth, options.stop, options.box)
            found[symmetry, across], seconds = run(options.program, text)
            times.setdefault((symmetry, across), []).append(seconds)
    for symmetry, across in cases:
        rows, seconds = found[symmetry, across], statistics.median(times[symmetry, across])
        print(f"\n{symmetry} D/Δx {across:g}: {seconds:.1f} s of processor time")
        for part in (0.5, 1.0, 1.5):
            time = part * D_OVER_U
            values = ", ".join(
                f"{words} {at(rows, time, name):.5g}" for name, words in READ.items()
            )
            temperature = mean(rows, time - 1e-7, time + 1e-7, "centre.temperature")
            print(
                f"  {part} D/U: {values}; centre's mean over 0.1 D/U {temperature:.2f} K",
                flush=True,
            )
    for a, b, c in zip(options.rings, options.rings[1:], options.rings[2:], strict=False):
        print(f"\nRings at D/Δx {a:g}, {b:g}, {c:g}: order and limit")
        for part in (0.5, 1.0, 1.5):
            for name, words in READ.items():
                time = part * D_OVER_U
                x, y, z = (
                    mean(found["axisymmetric", n], time - 1e-7, time + 1e-7, name)
                    for n in (a, b, c)
                )
                if (x - y) * (y - z) <= 0 or abs(y - z) >= abs(x - y):
                    print(f"  {part} D/U {words}: {x:.5g}, {y:.5g}, {z:.5g}: no order")
                    continue
                order = math.log((x - y) / (y - z)) / math.log(c / b)
                limit = z + (z - y) / ((x - y) / (y - z) - 1)
                print(
                    f"  {part} D/U {words}: {x:.5g}, {y:.5g}, {z:.5g}: order {order:.2f}, "
                    f"limit {limit:.5g}"
                )


if __name__ == "__main__":
    main()
