"""Drops that are repeated, beside the same drops of particles: error of heat, surface temperature
and spread on a single drop, on a warmer plate, on neighbours, on a train, for six fluids, and on
solids that conduct less than the drop; rings beside the quarter that is recorded; then many drops
along a path on a heated bed.

`python benches/recorded_drops.py [--impinge PATH] [--across N] [--drops N] [WHAT …]` prints one
table each; N particles lie across a drop, and times are those of the processor."""

import argparse
import csv
import resource
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from problems.materials import INK, liquid

ROOT = Path(__file__).resolve().parents[1]
DIAMETER, SPEED, WARM, COLD = 1e-4, 20.0, 350.0, 300.0
TIME = DIAMETER / SPEED
# Drops start clear of the films of those before.
ABOVE = 1.5 * DIAMETER
ALUMINA = "density = 3950.0, specific_heat = 900.0, conductivity = 10.0"
# Effusivities of 1.5, 0.14 and 0.05 times that of mercury.
INSULATORS = {
    "alumina": ALUMINA,
    "PMMA": "density = 1180.0, specific_heat = 1450.0, conductivity = 0.19",
    "cork": "density = 240.0, specific_heat = 1900.0, conductivity = 0.085",
}
GRID, PATCHES = 40, 10


# At the drop's temperature; speeds keep Re and We within what drops of particles resolve.
FLUIDS = {
    "mercury": (liquid(13534.0, 1.53e-3, 139.0, 8.5, 0.485), 4.0),
    "tin": (liquid(6970.0, 1.8e-3, 245.0, 31.0, 0.55), 5.0),
    "water": (liquid(980.0, 4.0e-4, 4186.0, 0.66, 0.064), 10.0),
    "ethanol": (liquid(760.0, 6.5e-4, 2700.0, 0.16, 0.019), 10.0),
    "glycerol": (liquid(1240.0, 0.1, 2600.0, 0.29, 0.06), 20.0),
    "wax": (liquid(800.0, 1.2e-2, 2200.0, 0.15, 0.025), 10.0),
}


class Runs:
    """Runs scenes with the program, in a folder of its own."""

    def __init__(self, program: Path, folder: Path, across: float):
        self.program, self.folder, self.across = program, folder, across
        self.count, self.known = 0, {}

    def scene(self, method, stop, **options):
        ink, speed = options.get("ink", (INK, SPEED))
        fluid_keys = ", ".join(f"{key} = {value!r}" for key, value in ink.items())
        spacing = "" if method == "film" else f"spacing = {DIAMETER / self.across!r}"
        length = options.get("length", 8e-4)
        return f"""
name = "Drops"
stop_time = {stop!r}
step = {options.get("step", 0.1 * DIAMETER / speed)!r}
[solver]
threads = 1
[body.drop]
kind = "droplet"
method = "{method}"
diameter = {DIAMETER!r}
impact_velocity = {speed!r}
initial_temperature = {WARM!r}
{spacing}
fluid = {{ {fluid_keys} }}
{options.get("keys", "")}
[body.plate]
kind = "solid"
shape = {{ box = [{length!r}, 5e-4, 1e-4] }}
material = {{ model = "thermoelastic", {options.get("material", ALUMINA)} }}
initial_temperature = {options.get("plate", COLD)!r}
mesh = {{ spacing = 1e-5, depth_spacing = 1e-6, growth = 1.4, order = 1 }}
[[coupling]]
from = "drop"
to = "plate.top"
traction = false
radius = 1.6e-4
{f"interval = {options['interval']!r}" if "interval" in options else ""}
[[field]]
name = "surface"
on = "plate.top"
grid = [{GRID}, {GRID}]
size = [{0.9 * length!r}, 4.5e-4]
gives = ["temperature"]
"""

    def run(self, text):
        """Columns over time, and the processor time [s]."""
        self.count += 1
        scene, out = (self.folder / f"{self.count}{end}" for end in (".toml", ""))
        scene.write_text(text)
        begin = processor_time()
        subprocess.run([self.program, "run", scene, "--out", out], check=True, capture_output=True)
        spent = processor_time() - begin
        with (out / "outputs.csv").open() as table:
            rows = csv.reader(table)
            names = [name.split(" ")[0] for name in next(rows)]
            values = np.array([[float(value) for value in row] for row in rows])
        return dict(zip(names, values.T, strict=True)), spent

    def both(self, method, stop, **options):
        """A method beside particles, which are run once for the same drops."""
        own = self.run(self.scene(method, stop, **options))
        text = self.scene("sph", stop, **options)
        if text not in self.known:
            self.known[text] = self.run(text)
        particles = self.known[text]
        return compare(own[0], particles[0]), own[1], particles[1]


def processor_time():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def surface(columns):
    """Temperatures of the field, a row for each time."""
    return np.array([values for name, values in columns.items() if name.startswith("surface.")]).T


def patches(values):
    """Means over patches of the surface, a row for each time: the field in tenths of its sides."""
    part = GRID // PATCHES
    return values.reshape(-1, PATCHES, part, PATCHES, part).mean(axis=(2, 4))


def compare(found, wanted):
    """Largest differences over time: heat over the last heat, temperature over the largest rise
    (root mean square over patches; and of a single place), spread over the largest."""
    given = wanted["drop.heat"]
    heat = np.abs(found["drop.heat"] - given).max() / np.abs(given[-1])
    one, other = surface(found), surface(wanted)
    places = np.abs(one - other).max() / np.abs(other - other[0]).max()
    one, other = patches(one), patches(other)
    error, rise = (
        np.sqrt(((a - b) ** 2).mean(axis=(1, 2))) for a, b in ((one, other), (other, other[0]))
    )
    spread = found["drop.spread_diameter"].max() / wanted["drop.spread_diameter"].max() - 1
    return heat, error.max() / rise.max(), places, spread


def row(*cells):
    print("| " + " | ".join(cells) + " |", flush=True)


def table(*heads):
    print()
    row(*heads)
    row(*("---" for _ in heads))


def percent(value):
    return f"{100 * value:.1f} %"


def figures(result):
    (heat, mean, places, spread), spent, full = result
    return [*map(percent, (heat, mean, places, spread)), f"{spent:.1f} s", f"{full:.1f} s"]


HEADS = ("heat", "temperature of patches", "of a place", "spread", "repeated", "particles")


def single(runs):
    table("single drop", "method", *HEADS)
    # Particles in other steps: what a film that tears does is known no better.
    for times in (4, 12):
        whole, full = runs.run(runs.scene("sph", times * TIME))
        other, spent = runs.run(runs.scene("sph", times * TIME, interval=0.02 * TIME))
        row(f"to {times} D/U", "particles anew", *figures((compare(other, whole), spent, full)))
    for method in ("record", "film"):
        for name, plate, times in (
            ("", COLD, 4),
            ("to 12 D/U", COLD, 12),
            ("plate 100 K warmer", COLD + 100, 4),
        ):
            row(name or "to 4 D/U", method, *figures(runs.both(method, times * TIME, plate=plate)))


def neighbours(runs):
    table("second drop after", "distance over D", *HEADS)
    for delay in (0.0, 5.0):
        for distance in (0.0, 1.5, 3.0) if delay else (1.5, 3.0):
            x = 0.5 * distance * DIAMETER
            keys = (
                f'symmetry = "none"\nheight = {ABOVE!r}\n'
                f"arrivals = [{{ x = {-x!r} }}, {{ time = {delay * TIME!r}, x = {x!r} }}]"
            )
            result = runs.both("record", (delay + 5.5) * TIME, keys=keys)
            row(f"{delay:g} D/U", f"{distance:g}", *figures(result))


def train(runs):
    table("drops", "distance over D", "delay over D/U", *HEADS)
    for distance in (1.5, 3.5):
        count, delay = 10, 4.0
        places = (np.arange(count) - 0.5 * (count - 1)) * distance * DIAMETER
        arrivals = ", ".join(
            f"{{ time = {n * delay * TIME!r}, x = {x!r} }}" for n, x in enumerate(places.tolist())
        )
        keys = f'symmetry = "none"\nheight = {ABOVE!r}\narrivals = [{arrivals}]'
        stop = (count * delay + 1.5) * TIME
        options = {"keys": keys, "length": 6e-4 + count * distance * DIAMETER, "step": 0.25 * TIME}
        row(
            str(count),
            f"{distance:g}",
            f"{delay:g}",
            *figures(runs.both("record", stop, **options)),
        )


def fluids(runs):
    table("fluid", "method", *HEADS)
    for name, (ink, speed) in FLUIDS.items():
        for method in ("record", "film"):
            result = runs.both(method, 4 * DIAMETER / speed, ink=(ink, speed))
            row(name, method, *figures(result))


def insulators(runs):
    """At a usual speed, and at Weber number 5.6."""
    table("mercury on", "speed", *HEADS)
    ink, usual = FLUIDS["mercury"]
    for speed in (usual, 1.42):
        for name, material in INSULATORS.items():
            stop = 4 * DIAMETER / speed
            results = runs.both("record", stop, ink=(ink, speed), material=material)
            row(name, f"{speed:g} m/s", *figures(results))


def rings(runs):
    """The same drop as rings about its axis and as a quarter, on the same box."""
    table("fluid", "heat, last", "impulse, last", "rings", "quarter")
    for name, (ink, speed) in {"ink": (INK, SPEED), "mercury": FLUIDS["mercury"]}.items():
        of = {}
        for symmetry in ("axisymmetric", "quarter"):
            keys = f'symmetry = "{symmetry}"'
            text = runs.scene("sph", 6 * DIAMETER / speed, ink=(ink, speed), keys=keys)
            of[symmetry] = runs.run(text)
        (one, quick), (other, slow) = of.values()
        parts = (one[key][-1] / other[key][-1] - 1 for key in ("drop.heat", "drop.impulse_z"))
        row(name, *map(percent, parts), f"{quick:.1f} s", f"{slow:.1f} s")


def bed(runs, count):
    """Lines of drops at 2 kHz on a bed that a heater holds warm, one communication step a drop."""
    side, pitch, period = 4e-3, 1e-4, 5e-4
    across = int(np.sqrt(count))
    lines = -(-count // across)
    place = (np.arange(across) - 0.5 * (across - 1)) * pitch * 30 / max(across, 30)
    place = place.tolist()
    rows = ["time,drop.release,drop.x,drop.y,heater.heat_flux"]
    for n in range(count):
        line, at = divmod(n, across)
        x = place[at] if line % 2 == 0 else place[across - 1 - at]
        y = (line - 0.5 * (lines - 1)) * pitch * 30 / max(lines, 30)
        rows.append(f"{n * period!r},{n + 1},{x!r},{y!r},2e4")
    text = f"""
name = "Bed"
stop_time = {count * period!r}
step = {period!r}
[solver]
threads = 1
[body.drop]
kind = "droplet"
method = "record"
diameter = {DIAMETER!r}
impact_velocity = {SPEED!r}
initial_temperature = {WARM!r}
spacing = {DIAMETER / runs.across!r}
fluid = {{ {", ".join(f"{key} = {value!r}" for key, value in INK.items())} }}
release = "input"
most = {count}
[body.plate]
kind = "solid"
shape = {{ box = [{side!r}, {side!r}, 5e-4] }}
material = {{ model = "thermoelastic", {ALUMINA} }}
initial_temperature = {COLD!r}
mesh = {{ spacing = 1e-4, depth_spacing = 1e-5, growth = 1.6, order = 1 }}
faces = {{ top = {{ convection = {{ coefficient = 10.0, ambient = {COLD!r} }} }} }}
[[coupling]]
from = "drop"
to = "plate.top"
traction = false
radius = 5e-4
[[load]]
name = "heater"
on = "plate.bottom"
footprint = {{ tiles = {{ count = [1, 1], size = [{side!r}, {side!r}] }} }}
carries = ["heat_flux"]
"""
    inputs = runs.folder / "inputs.csv"
    inputs.write_text("\n".join(rows))
    scene, out = runs.folder / "bed.toml", runs.folder / "bed"
    scene.write_text(text)
    begin = processor_time()
    command = [runs.program, "run", scene, "--out", out, "--inputs", inputs]
    command += ["--between", "held", "--rows-every", "1000"]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(done.stderr)
    spent = processor_time() - begin
    with (out / "outputs.csv").open() as file:
        rows = list(csv.reader(file))
    last = dict(zip((name.split(" ")[0] for name in rows[0]), map(float, rows[-1]), strict=True))
    balance = last["plate.heat_in"] - last["plate.heat_stored"] - last["plate.heat_lost"]
    table("drops", "processor time", "drops per second", "overlapping", "heat balance")
    row(
        f"{last['drop.released']:.0f}",
        f"{spent:.1f} s",
        f"{count / spent:.0f}",
        f"{last['drop.overlapping']:.0f}",
        f"{abs(balance / last['plate.heat_in']):.0e}",
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    tables = {
        function.__name__: function
        for function in (single, neighbours, train, fluids, insulators, rings)
    }
    parser.add_argument("what", nargs="*", default=[*tables, "bed"])
    parser.add_argument("--impinge", type=Path, default=ROOT / "target/release/impinge")
    parser.add_argument("--across", type=float, default=20.0)
    parser.add_argument("--drops", type=int, default=10_000)
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        runs = Runs(chosen.impinge, Path(folder), chosen.across)
        for what in chosen.what:
            if what == "bed":
                bed(runs, chosen.drops)
            else:
                tables[what](runs)


if __name__ == "__main__":
    main()
