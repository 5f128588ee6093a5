"""Reduced solids beside full ones: error, bound, initialisation, steps, memory, size of units.

Both levels take the same steps under the same inputs, which change at random every few steps.
Errors are those of temperatures in the last tenth of the steps. Times are those of a loop in C
(`benches/steps.c`, compiled with `cc`), the least of five; memory is what the process takes more
once the unit stands.
"""

import argparse
import random
import subprocess
import tempfile
import time
import zipfile
from pathlib import Path

from impinge import Unit
from impinge.unit import build

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
MOVING = "range = { x = [-0.5e-3, 0.5e-3], y = [-0.25e-3, 0.25e-3] }"
TILES = """
name = "Tiles"
stop_time = 1e-3
step = 1e-5
[body.plate]
kind = "solid"
shape = { box = [2e-3, 2e-3, 0.2e-3] }
material = { model = "thermoelastic", density = 3950.0, specific_heat = 900.0, conductivity = 10.0 }
initial_temperature = 293.15
mesh = { spacing = 50e-6, depth_spacing = 10e-6, growth = 1.4 }
[body.plate.faces]
bottom = { convection = { coefficient = 1e3, ambient = 293.15 } }
[[load]]
name = "spray"
on = "plate.top"
footprint = { tiles = { count = [8, 8], size = [1e-3, 1e-3] } }
carries = ["heat_flux"]
""" + "".join(
    f'[[probe]]\nname = "p{n}"\nin = "plate"\nat = [{1e-4 * n}, {5e-5 * n}, {-2e-5 * n}]\n'
    'gives = ["temperature"]\n'
    for n in range(8)
)


class Case:
    """A scene, its inputs with the largest value of each, and what is read."""

    def __init__(self, text, body, step, inputs, temperatures, outputs):
        self.text, self.body, self.step = text, body, step
        self.inputs, self.temperatures, self.outputs = inputs, temperatures, outputs


def example(name):
    """The text of an example without its fields, whose stress is too much for a reduced model."""
    text = (ROOT / "examples" / name / "scene.toml").read_text()
    head, _, rest = text.partition("[[field]]")
    return head + rest[rest.find("\n[[") :] if "\n[[" in rest else head


STRESS = ["stress_xx", "stress_yy", "stress_zz", "stress_xy", "stress_yz", "stress_xz"]


def cases():
    crossing = [
        "crossing.temperature",
        *(f"crossing.{key}" for key in STRESS),
        "crossing.max_principal",
    ]
    centre = ["centre.temperature", *(f"centre.{key}" for key in STRESS), "plate.heat_stored"]
    bed = [
        "thermocouple.temperature",
        "middle.temperature",
        "rim.temperature",
        "bed.heat_in",
        "bed.heat_stored",
    ]
    spot = {"spot.heat_flux": 2e7, "spot.x": 0.5e-3}
    line, short = (f"range = {{ x = [-{half}, {half}] }}" for half in ("0.5e-3", "0.1e-3"))
    return {
        "alumina plate": Case(
            example("alumina_plate"),
            "plate",
            1e-8,
            {"spot.heat_flux": 5e8, "spot.pressure": 1e6},
            ["centre.temperature"],
            centre,
        ),
        "heated bed": Case(
            example("heated_bed"),
            "bed",
            0.5,
            {"heater.heat_flux": 2e4, "fan.heat_flux": -2e3},
            bed[:3],
            bed,
        ),
        "spot, fixed": Case(
            example("moving_spot").replace(MOVING, ""),
            "plate",
            2.5e-5,
            {"spot.heat_flux": 2e7},
            crossing[:1],
            crossing,
        ),
        "spot, moving ± 0.1 mm": Case(
            example("moving_spot").replace(MOVING, short),
            "plate",
            2.5e-5,
            {**spot, "spot.x": 0.1e-3},
            crossing[:1],
            crossing,
        ),
        "spot, moving ± 0.5 mm": Case(
            example("moving_spot").replace(MOVING, line),
            "plate",
            2.5e-5,
            spot,
            crossing[:1],
            crossing,
        ),
        "tiles 8 × 8": Case(
            TILES,
            "plate",
            1e-5,
            {f"spray.heat_flux[{i},{j}]": 1e7 for i in (1, 4, 8) for j in (1, 4, 8)},
            [f"p{n}.temperature" for n in range(8)],
            [f"p{n}.temperature" for n in range(8)],
        ),
    }


STEPS, HELD = 200, 20


def errors(paths, case):
    """Largest error of temperatures, and the bound that the reduced unit tells."""
    found = {}
    for level, path in paths.items():
        rng, unit, rows = random.Random(7), Unit(path), []
        for n in range(STEPS):
            if n % HELD == 0:
                unit.set(
                    {
                        name: size * (rng.uniform(-1, 1) if name.endswith(".x") else rng.random())
                        for name, size in case.inputs.items()
                    }
                )
            unit.step(case.step)
            if n >= STEPS - STEPS // 10:
                rows.append(unit.get(case.temperatures))
        found[level] = rows
        if level == "reduced":
            name = f"{case.body}.error_bound_temperature"
            bound = unit.get([name])[0]
        unit.close()
    pairs = zip(found["full"], found["reduced"], strict=True)
    worst = max(abs(a - b).max() for a, b in pairs)
    rise = max(row.max() for row in found["full"]) - 293.15
    return worst, bound, rise


def attributes(folder):
    text = (folder / "modelDescription.xml").read_text()
    guid = text.split(' guid="')[1].split('"')[0]
    references = {}
    for part in text.split("<ScalarVariable")[1:]:
        references[part.split(' name="')[1].split('"')[0]] = part.split(' valueReference="')[
            1
        ].split('"')[0]
    return guid, references


def timed(program, folder, case, steps):
    """Seconds to initialise, per step, and per step with readings; memory [MB]: taken, most."""
    guid, references = attributes(folder)
    library = next((folder / "binaries" / "linux64").glob("*.so"))
    inputs = [
        part for name, value in case.inputs.items() for part in (references[name], f"{value:e}")
    ]
    arguments = [
        program,
        library,
        (folder / "resources").as_uri(),
        guid,
        f"{case.step:e}",
        str(steps),
    ]
    arguments += [str(len(case.inputs)), *inputs, *(references[name] for name in case.outputs)]
    said = subprocess.run(
        [str(part) for part in arguments], capture_output=True, text=True, check=True
    )
    start, step, both, before, after, most = map(float, said.stdout.split())
    return start, step, both, (after - before) / 1e3, (most - before) / 1e3


def stored(unit, body):
    """Bytes of a stored reduction, and its number of unknowns."""
    with zipfile.ZipFile(unit) as archive:
        content = archive.read(f"resources/reduced/{body}.reduced")
    key = int.from_bytes(content[8:16], "little")
    # Behind the key: modes, inputs, outputs, unknowns.
    return len(content), int.from_bytes(content[16 + key + 24 : 16 + key + 32], "little")


def unpacked(unit, folder, *, with_reduction=True):
    with zipfile.ZipFile(unit) as archive:
        names = [
            name
            for name in archive.namelist()
            if with_reduction or not name.startswith("resources/reduced/")
        ]
        archive.extractall(folder, names)
    return folder


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("cases", nargs="*", help="those whose names begin so; all if none is named")
    parser.add_argument("--tolerance", default="1e-3")
    asked = parser.parse_args()
    row(
        [
            "case",
            "level",
            "unknowns",
            "error [K]",
            "bound [K]",
            "initialise [s]",
            "stored [s]",
            "step [µs]",
            "step and outputs [µs]",
            "memory [MB]",
            "at most [MB]",
            "pack [s]",
            "stored [kB]",
        ]
    )
    row(["---"] * 13)
    with tempfile.TemporaryDirectory() as place:
        place = Path(place)
        program = place / "steps"
        subprocess.run(["cc", "-O2", "-o", program, HERE / "steps.c", "-ldl"], check=True)
        for number, (name, case) in enumerate(cases().items()):
            if asked.cases and not any(name.startswith(begin) for begin in asked.cases):
                continue
            paths, packing = {}, {}
            for level in ("full", "reduced"):
                scene = place / f"case_{number}_{level}.toml"
                fidelity = f'[fidelity]\nlevel = "{level}"\ntolerance = {asked.tolerance}\n'
                scene.write_text(f"{case.text}\n{fidelity}# {time.time()}\n")
                begin = time.perf_counter()
                paths[level] = build(scene)
                packing[level] = time.perf_counter() - begin
            worst, bound, rise = errors(paths, case)
            full = timed(program, unpacked(paths["full"], place / f"{number}f"), case, 20)
            made = timed(
                program,
                unpacked(paths["reduced"], place / f"{number}m", with_reduction=False),
                case,
                20,
            )
            reduced = timed(program, unpacked(paths["reduced"], place / f"{number}r"), case, 5000)
            size, unknowns = stored(paths["reduced"], case.body)
            outputs = f"{len(case.outputs)} outputs"
            row([name, "full", "", "", "", *times(full[0], None, full), packing["full"]])
            error = f"{worst:.2g} of {rise:.3g}"
            reached = [unknowns, error, f"{bound:.2g}", *times(made[0], reduced[0], reduced)]
            row([outputs, "reduced", *reached, packing["reduced"], size / 1e3])


def times(made, stored, timed):
    """Columns of one level."""
    _, step, both, memory, most = timed
    return [made, "" if stored is None else stored, 1e6 * step, 1e6 * both, memory, most]


def row(cells):
    said = (f"{cell:.3g}" if isinstance(cell, float) else str(cell) for cell in cells)
    print("| " + " | ".join(said) + " |", flush=True)


if __name__ == "__main__":
    main()
