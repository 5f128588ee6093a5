"""A steel box that a spot melts, in impinge and in scikit-fem on the same nodes.

Specific heat and conductivity are tables, melting takes latent heat over a range of temperatures,
the top radiates. On two meshes: both codes are of second order, so their difference must
fall. Exit code 1 if it does not, or if they differ by more than a percent on the finer one or by
four times that on the coarser.
"""

import csv
import subprocess
import sys
import time
from dataclasses import dataclass
from math import log2
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import vtr
from enthalpy_peer import AtPoints, Integral, Melt

ROOT = Path(__file__).resolve().parents[2]
COLD, EMISSIVITY = 300.0, 0.5
LIMIT = 1.0  # percent, on the finer mesh
LEAST_ORDER = 1.5

STEEL = Melt(
    density=7800.0,
    specific_heat=([300.0, 900.0, 1500.0], [480.0, 800.0, 680.0]),
    conductivity=([300.0, 1000.0, 1600.0, 1800.0], [52.0, 28.0, 30.0, 34.0]),
    solidus=1690.0,
    liquidus=1770.0,
    latent_heat=2.7e5,
)
SIZE = [2.4e-3, 2.4e-3, 0.8e-3]
FLUX, RADIUS = 2.4e8, 1e-3
STOP, STEPS = 16e-3, 8
SPACINGS = [1e-4, 5e-5]  # 10 and 20 to the radius; k(T) at Gauss points on the first alone
LABELS = {AtPoints: "k(T) at Gauss points", Integral: "∫ k dT at nodes"}
INNER = 5  # Steps of the peer in one of ours.


def toml(table):
    return f"{{ temperature = {list(table[0])}, value = {list(table[1])} }}"


def scene(spacing, tolerance=1e-2):
    mesh = f"spacing = {spacing}, depth_spacing = {spacing}, growth = 1.0, order = 1"
    return f"""
name = "Melts"
stop_time = {STOP}
step = {STOP / STEPS}
fidelity = {{ tolerance = {tolerance} }}
[body.plate]
kind = "solid"
shape = {{ box = {SIZE} }}
initial_temperature = {COLD}
mesh = {{ {mesh} }}
[body.plate.material]
model = "thermoelastic"
density = {STEEL.density}
specific_heat = {toml(STEEL.specific_heat)}
conductivity = {toml(STEEL.conductivity)}
[body.plate.material.melting]
solidus = {STEEL.solidus}
liquidus = {STEEL.liquidus}
latent_heat = {STEEL.latent_heat}
[body.plate.faces]
top = {{ radiation = {{ emissivity = {EMISSIVITY}, ambient = {COLD} }} }}
[[load]]
name = "spot"
on = "plate.top"
footprint = {{ gaussian = {{ radius = {RADIUS} }} }}
carries = ["heat_flux"]
start = {{ heat_flux = {FLUX} }}
"""


@dataclass
class Result:
    """Temperatures as [x, y, z] of the quarter [K], and the liquid volume [m³]."""

    temperature: np.ndarray
    liquid: float

    def front(self, nodes, values):
        """Where a line of temperatures that falls passes the middle of the melting range."""
        middle = 0.5 * (STEEL.solidus + STEEL.liquidus)
        return float(np.interp(-middle, -values, nodes))

    def fronts(self, axes):
        """Depth below the centre and radius on the top [m]."""
        depth = self.front(-axes[2][::-1], self.temperature[0, 0, ::-1])
        return depth, self.front(axes[0], self.temperature[:, 0, -1])


def run_impinge(spacing, stop=STOP, tolerance=1e-2):
    """Nodes along the axes of the quarter, and the result at the end."""
    with TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "scene.toml").write_text(scene(spacing, tolerance))
        command = [ROOT / "target/release/impinge", "run", folder / "scene.toml"]
        command += ["--out", folder / "out", "--fields-every", "1"]
        command += ["--until", str(stop), "--step", str(min(stop, STOP / STEPS))]
        subprocess.run(command, check=True, capture_output=True)
        with (folder / "out/outputs.csv").open() as file:
            *_, last = csv.DictReader(file)
        grid = vtr.read(max((folder / "out").glob("plate_*.vtr")))
    shape = [len(grid[axis]) for axis in "zyx"]
    temperature = grid["temperature"].reshape(shape).transpose(2, 1, 0)
    first = [np.searchsorted(grid[axis], -1e-12) for axis in "xy"]
    axes = [grid["x"][first[0] :], grid["y"][first[1] :], grid["z"]]
    liquid = float(last["plate.liquid_volume [m3]"])
    return axes, Result(temperature[first[0] :, first[1] :], liquid)


def run_peer(axes, kind, inner):
    problem = kind(axes, STEEL, COLD, EMISSIVITY)
    problem.heat_by(FLUX, RADIUS)
    problem.advance(STOP, STEPS * inner)
    temperature = problem.on_grid(problem.temperature())
    return Result(temperature, problem.liquid_volume()), problem.newton_steps


def differences(ours, theirs, axes):
    """In percent: of the highest rise, of volume, depth and radius of what has melted."""
    pairs = zip(ours.fronts(axes), theirs.fronts(axes), strict=True)
    depth, radius = (a / b - 1 for a, b in pairs)
    apart = np.abs(ours.temperature - theirs.temperature).max()
    found = {
        "temperature": apart / (theirs.temperature.max() - COLD),
        "liquid volume": ours.liquid / theirs.liquid - 1,
        "depth": depth,
        "radius": radius,
    }
    return {name: 100 * value for name, value in found.items()}


def compare(spacing, kind):
    """Prints a row; answers the differences."""
    begin = time.perf_counter()
    axes, ours = run_impinge(spacing)
    theirs, newton = run_peer(axes, kind, INNER)
    found = differences(ours, theirs, axes)
    nodes = " × ".join(str(len(axis)) for axis in axes)
    label = f"{nodes} nodes, {LABELS[kind]}"
    spent = f"   {newton} Newton steps, {time.perf_counter() - begin:.0f} s"
    print(f"{label:46}" + "".join(f"{value:15.3f}" for value in found.values()) + spent, flush=True)
    return found


def worst(found):
    return max(abs(value) for value in found.values())


def main():
    names = ["temperature", "liquid volume", "depth", "radius"]
    print("impinge beside scikit-fem, differences in percent")
    print(f"{'':46}" + "".join(f"{name:>15}" for name in names))
    coarse, fine = SPACINGS
    first, second = compare(coarse, AtPoints), compare(coarse, Integral)
    last = compare(fine, Integral)
    order = log2(second["temperature"] / last["temperature"])
    failed = not (
        order > LEAST_ORDER and worst(last) < LIMIT and max(worst(first), worst(second)) < 4 * LIMIT
    )
    print(f"temperatures: the difference falls at order {order:.2f}")
    print(f"finer mesh: at most {worst(last):.3f} %: {'more than it may' if failed else 'ok'}")
    return failed


if __name__ == "__main__":
    sys.exit(main())
