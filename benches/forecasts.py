"""Compares what `impinge check` forecasts of a run with the run itself, on one thread.

    python benches/forecasts.py [NAME …]

Each of some eighty scenes runs once as a process of its own. `time` is its processor time, which
an idle machine takes as wall time; `memory` is its peak resident set. Ratios are measured over
forecast.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[1]
RELEASE = PROJECT / "target/release"

# Scenes of the examples, each with what the command line sets so that something acts.
EXAMPLES = {
    "alumina_plate/scene.toml": ["spot.heat_flux=5e7"],
    "coated_plate/scene.toml": [],
    "heated_bed/scene.toml": ["heater.heat_flux=7e3"],
    "moving_spot/scene.toml": ["spot.heat_flux=1e8", "spot.x=1e-4", "spot.y=1e-4"],
    "printer_control/bed.toml": ["heater.heat_flux=7e3"],
    "droplet_on_plate_two_units/together.toml": [],
    "droplet_unit/scene.toml": [],
    "droplet_impact/scene.toml": [],
    "stress_study/scene.toml": [],
}
STEEL = "density = 7850.0, specific_heat = 470.0, conductivity = 45.0"
ELASTIC = "young = 210e9, poisson = 0.3, expansion = 12e-6"
WATER = (
    "density = 1000.0, viscosity = 1e-3, specific_heat = 4180.0, "
    "conductivity = 0.6, surface_tension = 0.072"
)
TIN = (
    "density = 6970.0, viscosity = 1.85e-3, specific_heat = 244.0, "
    "conductivity = 33.0, surface_tension = 0.544"
)
HONEY = (
    "density = 1420.0, viscosity = 5.0, specific_heat = 2400.0, "
    "conductivity = 0.35, surface_tension = 0.06"
)
CENTRE = '[[probe]]\nname = "centre"\nin = "plate"\nat = [0.0, 0.0, 0.0]\ngives = {gives}\n'


def head(name: str, stop: float, step: float) -> str:
    return f'name = "{name}"\nstop_time = {stop:e}\nstep = {step:e}\n'


ALL = '["temperature", "stress"]'
ONLY_HEAT = '["temperature"]'


def solid(shape: str, material: str, gives: str = ALL) -> str:
    held = "" if gives == ONLY_HEAT else "faces = { bottom = { clamped = true } }\n"
    return (
        f'[body.plate]\nkind = "solid"\nshape = {{ {shape} }}\nmaterial = {{ {material} }}\n'
        f"initial_temperature = 300.0\n{held}{CENTRE.format(gives=gives)}"
    )


def spot(radius: float, flux: float) -> str:
    return (
        '[[load]]\nname = "spot"\non = "plate.top"\n'
        f"footprint = {{ disc = {{ radius = {radius:e} }} }}\n"
        f'carries = ["heat_flux"]\nstart = {{ heat_flux = {flux:e} }}\n'
    )


def droplet(fluid: str, diameter: float, speed: float, across: float, more: str = "") -> str:
    spacing = "" if across == 0 else f"spacing = {diameter / across:e}\n"
    return (
        f'[body.drop]\nkind = "droplet"\ndiameter = {diameter:e}\nimpact_velocity = {speed}\n'
        f"initial_temperature = 350.0\n{spacing}fluid = {{ {fluid} }}\n{more}"
        '[[coupling]]\nfrom = "drop"\nto = "plate.top"\n'
    )


THERMAL = f'model = "thermoelastic", {STEEL}'
ELASTIC_STEEL = f'model = "thermoelastic", {STEEL}, {ELASTIC}'
HARDENING = "yield_stress = 250e6, isotropic_hardening = 2e9"
YIELDING = f'model = "elastoplastic", {STEEL}, {ELASTIC}, {HARDENING}'
CREEPING = (
    f'model = "viscoplastic", {STEEL}, {ELASTIC}, creep = {{ coefficient = 1e-26, exponent = 3.0 }}'
)
MELTING = f"{THERMAL}, melting = {{ solidus = 1700.0, liquidus = 1750.0, latent_heat = 2.7e5 }}"
DISC = "disc = { radius = 2e-3, thickness = 0.5e-3 }"
BOX = "box = [4e-3, 4e-3, 0.5e-3]"

# A hundred drops in a row, 60 µm apart.
PLACES = ", ".join(f"{{ time = {1e-4 * n:e}, x = {6e-5 * (n % 20 - 10):e} }}" for n in range(100))
TRAIN = f"arrivals = [{PLACES}]\n"

SCENES = {
    "disc, heat": head("A", 1e-2, 1e-3) + solid(DISC, THERMAL, gives=ONLY_HEAT) + spot(2e-4, 1e7),
    "disc, tight tolerance": head("B", 1e-2, 1e-3)
    + "fidelity = { tolerance = 1e-3 }\n"
    + solid(DISC, ELASTIC_STEEL)
    + spot(2e-4, 1e7),
    "box, tight tolerance": head("C", 1e-2, 1e-3)
    + "fidelity = { tolerance = 2e-3 }\n"
    + solid(BOX, THERMAL, gives=ONLY_HEAT)
    + spot(2e-4, 1e7),
    "box, stress": head("D", 1e-2, 1e-3) + solid(BOX, ELASTIC_STEEL) + spot(2e-4, 1e7),
    "disc, yielding": head("E", 1e-2, 5e-4) + solid(DISC, YIELDING) + spot(2e-4, 3e8),
    "box, yielding": head("L", 1e-2, 1e-3) + solid(BOX, YIELDING) + spot(2e-4, 3e8),
    "box, hardly yielding": head("M", 1e-2, 1e-3) + solid(BOX, YIELDING) + spot(2e-4, 2e7),
    "box, creeping": head("N", 2e-3, 1e-3) + solid(BOX, CREEPING) + spot(2e-4, 1e8),
    "box, melting": head("F", 2e-4, 2e-5) + solid(BOX, MELTING, gives=ONLY_HEAT) + spot(3e-4, 1e9),
    "water on a disc": head("G", 2e-4, 1e-5)
    + solid(DISC, THERMAL, gives=ONLY_HEAT)
    + droplet(WATER, 2e-4, 3.0, 30),
    "tin on a box": head("H", 2e-4, 1e-5)
    + solid(BOX, THERMAL, gives=ONLY_HEAT)
    + droplet(TIN, 2e-4, 3.0, 20),
    "honey on a disc": head("I", 2e-4, 1e-5)
    + solid(DISC, THERMAL, gives=ONLY_HEAT)
    + droplet(HONEY, 2e-4, 3.0, 20),
    "recorded drops": head("J", 2e-2, 1e-4)
    + solid(BOX, THERMAL, gives=ONLY_HEAT)
    + droplet(WATER, 1e-4, 3.0, 20, f'method = "record"\n{TRAIN}'),
    "films": head("K", 2e-2, 1e-4)
    + solid(BOX, THERMAL, gives=ONLY_HEAT)
    + droplet(WATER, 1e-4, 3.0, 0, f'method = "film"\n{TRAIN}'),
}

RUBBER = (
    'model = "neo_hookean", density = 1000.0, specific_heat = 1900.0, conductivity = 0.2, '
    "young = 1e6, poisson = 0.4"
)
METAL = (
    'model = "elastoplastic", density = 2700.0, specific_heat = 900.0, conductivity = 200.0, '
    "young = 70e9, poisson = 0.33, yield_stress = 100e6, isotropic_hardening = 1e9"
)


def block(mechanics: str, axes: int, cells: int, motion: str, of_metal: bool) -> str:
    """A square or cube of large strain that a traction shears, or that falls."""
    traction = 4.2e7 if of_metal else 5e4
    moves = f"top = {{ traction = [{traction:e}, 0.0, 0.0] }}"
    crossing = 20e-3 * (2.0e-4 if of_metal else 3.2e-2)  # s
    step = crossing * {"rest": 1.0, "implicit": 0.5, "explicit": 0.2}[motion]
    keys = {
        "rest": f"faces = {{ bottom = {{ clamped = true }}, {moves} }}",
        "implicit": 'inertia = true\nmotion = "implicit"\n'
        f"faces = {{ bottom = {{ clamped = true }}, {moves} }}",
        "explicit": "inertia = true\nstart = { velocity = [0.0, 0.0, -0.5], height = 2e-5 }",
    }
    # A body at rest has moved after its first step.
    steps = {"rest": 2, "implicit": 8, "explicit": 20}[motion]
    return head("S", steps * step, step) + (
        f'[body.block]\nkind = "solid"\nstrain = "finite"\ndimension = {axes}\n'
        f'symmetry = "none"\nmechanics = "{mechanics}"\ninitial_temperature = 293.15\n'
        f"shape = {{ box = [20e-3, {'20e-3' if axes == 3 else '1.0'}, 20e-3] }}\n"
        f"mesh = {{ spacing = {20e-3 / cells:e} }}\n"
        f"material = {{ {METAL if of_metal else RUBBER} }}\n{keys[motion]}\n"
    )


for mechanics, sizes in {"fem": [50, 10], "rkpm": [20, 5], "efg": [20, 5], "sph": [25, 7]}.items():
    for axes, cells in zip([2, 3], sizes, strict=True):
        for motion in ["rest", "implicit", "explicit"]:
            for of_metal in [False, True]:
                title = f"{mechanics}, {axes} axes, {motion}, {'metal' if of_metal else 'rubber'}"
                SCENES[title] = block(mechanics, axes, cells, motion, of_metal)


STEEL_YIELDS = (
    'model = "elastoplastic", density = 7850.0, specific_heat = 470.0, conductivity = 45.0, '
    "young = 200e9, poisson = 0.3, yield_stress = 250e6, isotropic_hardening = 5e8"
)


def bent(section: str, motion: str, cells: int) -> str:
    """A cantilever of steel whose end jumps by twenty times what makes it yield."""
    inertia = 'inertia = true\nmotion = "implicit"\n' if motion == "implicit" else ""
    return head("U", 1e-2, 1e-3) + (
        f'[body.bar]\nkind = "solid"\nstrain = "finite"\ndimension = 2\nsection = "{section}"\n'
        f"shape = {{ box = [20e-3, 1e-3, 4e-3] }}\ninitial_temperature = 293.15\n"
        f"material = {{ {STEEL_YIELDS} }}\nmesh = {{ spacing = {4e-3 / cells:e} }}\n{inertia}"
        "faces.left = { clamped = true }\nfaces.right = { displacement = [0.0, 0.0, 2e-3] }\n"
    )


def impact(shape: str, speed: float) -> str:
    """A body of steel that flattens on a rigid plane."""
    return head("V", 8e-5, 4e-6) + (
        f'[body.bar]\nkind = "solid"\nstrain = "finite"\nshape = {{ {shape} }}\n'
        f"initial_temperature = 293.15\nmaterial = {{ {STEEL_YIELDS} }}\n"
        "mesh = { spacing = 0.64e-3 }\ninertia = true\n"
        f"start = {{ velocity = [0.0, 0.0, {-speed}], height = 1e-6 }}\n"
    )


def strand(conductivity: float) -> str:
    """A strand of wax on a plate whose conductivity depends on the temperature."""
    table = f"{{ temperature = [250.0, 400.0], value = [{conductivity}, {0.8 * conductivity}] }}"
    return head("W", 0.5, 0.05) + (
        '[body.ink]\nkind = "filament"\nmost = 5e-7\n'
        'fluid = { substance = "n-eicosane", at = "60 °C", contact_angle = "20°" }\n'
        'nozzle = { diameter = 0.8e-3, height = 0.7e-3, temperature = "70 °C", flow = 2e-8 }\n'
        "path = { time = [0.0, 0.5], x = [0.0, 0.0], y = [-8e-3, 8e-3] }\n"
        '[[coupling]]\nfrom = "ink"\nto = "plate.top"\n'
        '[body.plate]\nkind = "solid"\nshape = { box = [40e-3, 30e-3, 2e-3] }\n'
        'initial_temperature = "20 °C"\nmesh = { spacing = 0.4e-3 }\n'
        'material = { model = "thermoelastic", density = 2500.0, specific_heat = 800.0, '
        f"conductivity = {table} }}\n"
    )


for section in ["plane_strain", "plane_stress"]:
    for motion in ["rest", "implicit"]:
        SCENES[f"bent steel, {section}, {motion}"] = bent(section, motion, 8)
SCENES["impact of a bar"] = impact("disc = { radius = 3.2e-3, thickness = 32.4e-3 }", 300.0)
SCENES["impact of a ball"] = impact("ball = { radius = 5e-3 }", 100.0)
SCENES["strand on glass"] = strand(1.0)
SCENES["strand on metal"] = strand(25.0)


def scenes(folder: Path) -> dict[str, Path]:
    """All scenes as files."""
    found = {name: PROJECT / "examples" / name for name in EXAMPLES}
    for name, text in SCENES.items():
        found[name] = folder / (re.sub(r"\W+", "_", name) + ".toml")
        found[name].write_text(text)
    return {name: on_one_thread(path, folder) for name, path in found.items()}


def on_one_thread(path: Path, folder: Path) -> Path:
    """A copy of a scene that takes one thread."""
    copy = folder / f"one_thread_{path.parent.name}_{path.name}"
    copy.write_text("solver = { threads = 1 }\n" + path.read_text())
    return copy


UNITS = {
    "ns": 1e-9,
    "µs": 1e-6,
    "ms": 1e-3,
    "s": 1.0,
    "minutes": 60.0,
    "hours": 3600.0,
    "days": 86400.0,
}
COST = re.compile(
    r"takes +about (.+?) on idle cores(?:, the first time (.+?) more to choose and judge meshes)?"
    r", (.+?) MB of memory"
)


def seconds(text: str) -> float:
    """A duration as `impinge check` writes it [s]."""
    number, unit = re.fullmatch(r"([\d.e-]+) ?(\w+)", text).groups()
    return float(number) * UNITS[unit]


def forecast(scene: Path) -> tuple[float, float]:
    """Time of a first run [s] and memory [MB] as forecast."""
    command = [RELEASE / "impinge", "check", "--fresh", scene]
    report = subprocess.run(command, capture_output=True, text=True)
    if report.returncode:
        raise SystemExit(report.stderr)
    time, first, memory = COST.search(report.stdout).groups()
    return seconds(time) + seconds(first or "0 s"), float(memory)


def measured(scene: Path, sets: list[str], folder: Path) -> tuple[float, float]:
    """Processor time [s] and peak resident memory [MB] of a run."""
    command = [RELEASE / "impinge", "run", "--fresh", scene, "--out", folder / "out", "--overwrite"]
    command += [word for one in sets for word in ("--set", one)]
    code = (
        "import resource, subprocess, sys\n"
        "done = subprocess.run(sys.argv[1:], capture_output=True, text=True)\n"
        "used = resource.getrusage(resource.RUSAGE_CHILDREN)\n"
        "print(used.ru_utime + used.ru_stime, used.ru_maxrss / 1e3)\n"
        "sys.exit(done.stderr if done.returncode else 0)\n"
    )
    done = subprocess.run([sys.executable, "-c", code, *command], capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(done.stderr)
    time, memory = done.stdout.split()
    return float(time), float(memory)


def main() -> None:
    wanted = sys.argv[1:]
    heading = ["time, s", "forecast", "ratio", "memory, MB", "forecast", "ratio"]
    print(f"{'scene':<42}" + "".join(f"{word:>12}" for word in heading))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for scene, path in scenes(folder).items():
            if wanted and not any(part in scene for part in wanted):
                continue
            said, space = forecast(path)
            time, memory = measured(path, EXAMPLES.get(scene, []), folder)
            values = [time, said, time / said, memory, space, memory / space]
            print(f"{scene:<42}" + "".join(f"{value:12.2f}" for value in values), flush=True)


if __name__ == "__main__":
    main()
