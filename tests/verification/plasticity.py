"""Plates that a spot heats into yield, in impinge and in scikit-fem on the same nodes.

A Gaussian spot heats a plate that its supports hold, then the plate cools with residual stress.
Both programs compute heat and equilibrium on their own, over the same increments. Exit code 1 if
they differ.
"""

import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import vtr
from yield_peer import Body, Metal, max_principal, von_mises

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "tests/fmpy"))
COLD = 300.0
LIMIT = 1.0  # percent
INNER = 20  # Steps of the peer's heat in an increment.

STEEL = Metal(
    density=7800.0,
    specific_heat=500.0,
    conductivity=45.0,
    poisson=0.3,
    expansion=1.2e-5,
    young=([300.0, 900.0], [205e9, 150e9]),
    yield_stress=([300.0, 900.0], [250e6, 100e6]),
    isotropic_hardening=2e9,
    kinematic_hardening=4e9,
)
COPPER = Metal(
    density=8960.0,
    specific_heat=385.0,
    conductivity=400.0,
    poisson=0.34,
    expansion=1.7e-5,
    young=120e9,
    yield_stress=60e6,
    isotropic_hardening=1e9,
)


def clamped_rim(places, _component):
    return np.isclose(places[:, 0], places[:, 0].max())


def ring_on_roller(places, component):
    """A section whose bottom keeps its height; the axis stays where it is."""
    low = np.isclose(places[:, 1], places[:, 1].min()) & (component == 1)
    return low | (np.isclose(places[:, 0], 0.0) & (component == 0))


def rim(places, component):
    return clamped_rim(places, component) | (np.isclose(places[:, 0], 0.0) & (component == 0))


def box_between_rollers(places, component):
    """A quarter whose faces keep their places, but for the top."""
    at = places[:, component]
    high = np.isclose(at, at.max()) & (component < 2)
    return np.isclose(at, at.min(), atol=1e-12) | high


@dataclass(frozen=True)
class Case:
    """A plate, its spot and the increments: `(heat flux [W/m²], duration [s], increments)`."""

    title: str
    shape: str
    mesh: str
    metal: Metal
    faces: str
    held: callable
    flux: float
    radius: float
    course: tuple
    probes: tuple


CASES = [
    Case(
        "steel disc, rim clamped, both hardenings, tables over the temperature",
        "disc = { radius = 5e-3, thickness = 1.5e-3 }",
        "spacing = 2.5e-5, depth_spacing = 2.5e-5, growth = 1.2, order = 2",
        STEEL,
        "sides = { clamped = true }",
        rim,
        4e7,
        1e-3,
        ((1.0, 20e-3, 10), (0.0, 0.4, 10)),
        ((0.15e-3, -0.15e-3), (0.3e-3, -0.1e-3), (0.1e-3, -0.1e-3)),
    ),
    Case(
        "copper disc on a roller, isotropic hardening",
        "disc = { radius = 4e-3, thickness = 2e-3 }",
        "spacing = 2.5e-5, depth_spacing = 2.5e-5, growth = 1.2, order = 2",
        COPPER,
        "bottom = { roller = true }",
        ring_on_roller,
        1.5e8,
        0.8e-3,
        ((1.0, 5e-3, 10), (0.0, 0.1, 10)),
        ((0.15e-3, -0.15e-3), (0.3e-3, -0.1e-3), (0.1e-3, -0.1e-3)),
    ),
    Case(
        "steel box between rollers, both hardenings, tables over the temperature",
        "box = [8e-3, 7e-3, 1.5e-3]",
        "spacing = 4e-4, depth_spacing = 1.5e-4, growth = 1.3, order = 2",
        STEEL,
        "bottom = { roller = true }\nsides = { roller = true }",
        box_between_rollers,
        2e7,
        2e-3,
        ((1.0, 0.1, 5), (0.0, 0.4, 5)),
        ((0.5e-3, 0.4e-3, -0.2e-3), (1e-3, 0.6e-3, -0.2e-3), (0.6e-3, 0.6e-3, -0.4e-3)),
    ),
]


def toml(constant):
    if isinstance(constant, tuple):
        return f"{{ temperature = {constant[0]}, value = {constant[1]} }}"
    return str(constant)


def scene(case):
    material = "".join(f"{key} = {toml(value)}\n" for key, value in vars(case.metal).items())
    symmetry = 'symmetry = "quarter"' if "box" in case.shape else ""
    duration, count = case.course[0][1:]
    probes = ""
    for i, place in enumerate(case.probes):
        at = [place[0], 0.0, place[1]] if len(place) == 2 else list(place)
        probes += f'[[probe]]\nname = "p{i}"\nin = "plate"\nat = {at}\ngives = ["stress"]\n'
    return f"""
name = "Yields"
stop_time = {sum(duration for _, duration, _ in case.course)}
step = {duration / count}
[body.plate]
kind = "solid"
shape = {{ {case.shape} }}
initial_temperature = {COLD}
{symmetry}
mesh = {{ {case.mesh} }}
[body.plate.material]
model = "elastoplastic"
{material}
[body.plate.faces]
{case.faces}
[[load]]
name = "spot"
on = "plate.top"
footprint = {{ gaussian = {{ radius = {case.radius} }} }}
carries = ["heat_flux"]
{probes}"""


@dataclass
class Moment:
    """What is compared at the end of a part of the course."""

    temperature: np.ndarray
    displacement: np.ndarray
    totals: dict
    probes: np.ndarray


TOTALS = ["max_von_mises", "max_principal", "max_plastic_strain", "plastic_work"]
COMPONENTS = {2: ["xx", "yy", "zz", "xz"], 3: ["xx", "yy", "zz", "xy", "yz", "xz"]}


def fields(folder, is_ring):
    """Axes, temperatures and displacements of the latest file of a section or of a quarter."""
    if not is_ring:
        grid = vtr.read(max(folder.glob("plate_*.vtr")))
        axes = [grid["x"], grid["y"], grid["z"]]
        shape = [len(axis) for axis in reversed(axes)]
        keep = [slice(np.searchsorted(axis, -1e-12), None) for axis in axes[:2]]
        part = (slice(None), keep[1], keep[0])
        pick = lambda values: values.reshape(*shape, -1)[part]  # noqa: E731
        axes = [axes[0][keep[0]], axes[1][keep[1]], axes[2]]
        return axes, pick(grid["temperature"]).ravel(), pick(grid["displacement"]).reshape(-1, 3)
    grid = vtr.read(max(folder.glob("plate_*.vts")))
    place = grid["position"]
    section = (np.abs(place[:, 1]) < 1e-12) & (place[:, 0] >= 0.0)
    # The axis stands once in every section.
    _, first = np.unique(np.round(place[section][:, [2, 0]], 12), axis=0, return_index=True)
    chosen = np.nonzero(section)[0][first]
    axes = [np.unique(np.round(place[chosen][:, axis], 12)) for axis in (0, 2)]
    return axes, grid["temperature"][chosen], grid["displacement"][chosen][:, [0, 2]]


def run_impinge(case):
    """The nodes along the axes, and a moment for each part of the course."""
    from master import Unit

    is_ring = "disc" in case.shape
    moments = []
    with TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "scene.toml").write_text(scene(case))
        build = [ROOT / "target/release/build-fmu", folder / "scene.toml"]
        subprocess.run([*build, "-o", folder / "unit.fmu"], check=True, capture_output=True)
        with Unit(folder / "unit.fmu", {"output.directory": str(folder / "out")}) as unit:
            for flux, duration, count in case.course:
                unit["spot.heat_flux"] = flux * case.flux
                for _ in range(count):
                    unit.step(duration / count)
                axes, temperature, displacement = fields(folder / "out", is_ring)
                totals = {name: unit[f"plate.{name}"] for name in TOTALS}
                components = COMPONENTS[len(axes)]
                probes = [
                    [unit[f"p{i}.stress_{c}"] for c in components] for i in range(len(case.probes))
                ]
                moments.append(Moment(temperature, displacement, totals, np.array(probes)))
    return axes, moments


def run_peer(case, axes):
    body = Body(tuple(axes), case.metal, COLD, case.held)
    body.assemble_heat()
    spot = body.flux_under_spot(case.flux, case.radius)
    rise = np.zeros(len(spot))
    moments = []
    shears = np.where(np.arange(4 if body.is_ring else 6) < 3, 1.0, np.sqrt(0.5))
    for flux, duration, count in case.course:
        for _ in range(count):
            rise = body.advance_heat(rise, flux * spot, duration / count, INNER)
            body.advance(COLD + rise)
        totals = {
            "max_von_mises": von_mises(body.stress).max(),
            "max_principal": max_principal(body.stress).max(),
            "max_plastic_strain": body.points.accumulated.max(),
            "plastic_work": body.dissipated(),
        }
        displacement = body.displacement.reshape(-1, body.degrees)
        places = [np.array(place) for place in case.probes]
        probes = np.array([shears * body.recovered(body.stress, place) for place in places])
        moments.append(Moment(COLD + rise, displacement, totals, probes))
    return moments, body.newton_steps


def differences(ours, theirs):
    """In percent: of the largest value of a field, of the value itself of a total."""
    rise = theirs.temperature - COLD
    found = {
        "temperatures": np.abs(ours.temperature - theirs.temperature).max() / rise.max(),
        "displacements": np.abs(ours.displacement - theirs.displacement).max()
        / np.abs(theirs.displacement).max(),
        "stresses at probes": np.abs(ours.probes - theirs.probes).max()
        / theirs.totals["max_von_mises"],
    }
    for name in TOTALS:
        found[name] = ours.totals[name] / theirs.totals[name] - 1
    return {name: 100 * value for name, value in found.items()}


def compare(case):
    """Prints the table of a case; answers the largest difference in percent."""
    begin = time.perf_counter()
    axes, ours = run_impinge(case)
    theirs, newton = run_peer(case, axes)
    nodes = " × ".join(str(len(axis)) for axis in axes)
    spent = time.perf_counter() - begin
    print(f"\n{case.title}: {nodes} nodes, {newton} Newton steps of the peer, {spent:.0f} s")
    print(f"{'':22}{'hot':>34}{'cold':>36}")
    print(f"{'':22}" + f"{'impinge':>12}{'scikit-fem':>12}{'%':>10}  " * 2)
    table = [differences(*pair) for pair in zip(ours, theirs, strict=True)]
    for name in table[0]:
        row = f"{name:22}"
        for pair, column in zip(zip(ours, theirs, strict=True), table, strict=True):
            values = "".join(
                f"{moment.totals[name]:12.5g}" if name in TOTALS else 12 * " " for moment in pair
            )
            row += f"{values}{column[name]:10.3f}  "
        print(row)
    return max(abs(value) for column in table for value in column.values())


def main():
    worst = {case.title: compare(case) for case in CASES}
    print("\nFields: in percent of the largest rise, displacement, von Mises stress.")
    for title, difference in worst.items():
        verdict = "ok" if difference < LIMIT else f"more than {LIMIT} %"
        print(f"{title}: at most {difference:.3f} % apart: {verdict}")
    return any(not difference < LIMIT for difference in worst.values())


if __name__ == "__main__":
    sys.exit(main())
