"""Measures the time of drops with solved pressure and with explicit steps.

    .venv/bin/python benches/pressure.py

For drops that fall on a cold wall it prints a row for each way: time steps, seconds of one thread,
and how height, spread diameter and heat to the wall end. `docs/theory/viscosity.md` has the table.
"""

import csv
import subprocess
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).parents[1]
PROGRAM = ROOT / "target/release/impinge"
WAYS = {
    "explicit": 'viscous = "explicit"',
    "viscous implicit": 'viscous = "implicit"',
    "pressure implicit": 'pressure = "implicit"',
}
# End of the run [s], diameter [m], speed [m/s], distance of particles [m], fluid.
DROPS = {
    "honey, 10 Pa s": (
        0.1,
        5e-3,
        0.1,
        2.5e-4,
        "density = 1420, viscosity = 10.0, specific_heat = 2500, conductivity = 0.5,"
        " surface_tension = 0.06, contact_angle = 0.7",
    ),
    "glycerol, 1 Pa s": (
        0.03,
        2e-3,
        0.5,
        1e-4,
        "density = 1260, viscosity = 1.0, specific_heat = 2400, conductivity = 0.29,"
        " surface_tension = 0.063, contact_angle = 0.9",
    ),
    "paste, 20 Pa and 1 Pa s": (
        0.05,
        5e-3,
        0.1,
        2.5e-4,
        'density = 1800, viscosity = { law = "bingham", yield_stress = 20.0,'
        " plastic_viscosity = 1.0 }, specific_heat = 1500, conductivity = 0.5",
    ),
    "wax, 0.05 Pa s": (
        0.02,
        1e-3,
        0.3,
        5e-5,
        "density = 780, viscosity = 0.05, specific_heat = 2500, conductivity = 0.15,"
        " surface_tension = 0.026, contact_angle = 0.6",
    ),
    "wax that freezes, 0.5 Pa s": (
        0.05,
        2e-3,
        0.5,
        1e-4,
        "density = 780, viscosity = 0.5, specific_heat = 2200, conductivity = 0.15,"
        " surface_tension = 0.025, contact_angle = 0.5,"
        " melting = { solidus = 330.0, liquidus = 333.0, latent_heat = 1.9e5 }",
    ),
    "water, 0.001 Pa s": (
        0.005,
        2e-3,
        1.0,
        1e-4,
        "density = 998, viscosity = 1e-3, specific_heat = 4180, conductivity = 0.6,"
        " surface_tension = 0.072, contact_angle = 1.2",
    ),
}


def scene(way: str, drop: tuple[float, float, float, float, str]) -> str:
    stop, diameter, speed, spacing, fluid = drop
    return f"""
name = "Pressure"
stop_time = {stop}
step = {stop / 20}
solver = {{ threads = 1 }}
[body.drop]
kind = "droplet"
diameter = {diameter}
impact_velocity = {speed}
initial_temperature = 350
gravity = 9.81
spacing = {spacing}
{way}
fluid = {{ {fluid} }}
[[wall]]
name = "wall"
under = "drop"
footprint = {{ rings = {{ count = 20, radius = {4 * diameter} }} }}
start = {{ temperature = 300 }}
"""


def run(text: str, folder: Path) -> tuple[float, dict[str, float]]:
    """Seconds of a run, and the outputs at its end."""
    (folder / "scene.toml").write_text(text)
    call = [PROGRAM, "run", "scene.toml", "--overwrite", "--out", "out", "--fields-every", "0"]
    begin = time.perf_counter()
    subprocess.run(call, cwd=folder, capture_output=True, check=True)
    spent = time.perf_counter() - begin
    with open(folder / "out/outputs.csv") as file:
        *_, last = csv.DictReader(file)
    return spent, {name.split(" [")[0]: float(value) for name, value in last.items()}


def main() -> None:
    print("| fluid | solved | steps | s | height mm | spread mm | heat mJ |")
    print("|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for fluid, drop in DROPS.items():
            for way, key in WAYS.items():
                if "law" in drop[4] and way == "explicit":
                    continue
                spent, found = run(scene(key, drop), Path(folder))
                of = [
                    found[f"drop.{key}"] for key in ("steps", "height", "spread_diameter", "heat")
                ]
                steps, *values = of
                shown = " | ".join(f"{1e3 * value:.3g}" for value in values)
                print(f"| {fluid} | {way} | {steps:.0f} | {spent:.2g} | {shown} |", flush=True)


if __name__ == "__main__":
    main()
