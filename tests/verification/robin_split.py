"""A plate under an outside law, by masters of ours and of others: error over the steps it takes.

A plate gets its heat through one tile over its face from a unit that knows only the law
`q = h (T∞ − T)` with the plate's surface temperature T. The same plate with a convective face is
the truth; it agrees with itself to 1e-13 K whatever its steps. Heating begins with a jump, so
temperatures start like √t. Masters of others run in processes of their own (`masters.py`).

    .venv/bin/python tests/verification/robin_split.py out/verification/robin_split.png
"""

import json
import os
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "tests/python")]
from impinge import Master, Unit  # noqa: E402
from impinge.errors import ImpingeError  # noqa: E402
from impinge.master import Graded  # noqa: E402
from impinge.unit import build  # noqa: E402
from linear_unit import make  # noqa: E402

COEFFICIENT, AMBIENT, COLD = 1e5, 373.15, 293.15  # W/(m² K), K, K
STOP, COMPARED = 64e-3, 8e-3 * np.arange(1, 9)  # s
STEPS = [8e-3, 4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4]

SCENE = f"""
name = "Plate"
stop_time = {STOP}
step = 1e-3

[body.plate]
kind = "solid"
shape = {{ box = [2e-3, 2e-3, 1e-3] }}
material = {{ model = "thermoelastic", density = 3950.0, specific_heat = 900.0, conductivity = 10.0 }}
initial_temperature = {COLD}

[[probe]]
name = "centre"
in = "plate"
at = [0.0, 0.0, 0.0]
gives = ["temperature"]
"""
SPLIT = """
[[load]]
name = "patch"
on = "plate.top"
footprint = { tiles = { count = [1, 1], size = [2e-3, 2e-3] } }
carries = ["heat_flux"]
"""
WHOLE = f"""
[body.plate.faces]
top = {{ convection = {{ coefficient = {COEFFICIENT}, ambient = {AMBIENT} }} }}
"""
CONNECTIONS = [
    ("plate.centre.temperature", "law.u"),
    ("law.y", "plate.patch.heat_flux[1,1]"),
]
OURS = {
    "iterated, equal steps": {},
    "iterated, graded": {"graded": Graded(STOP, 2.0)},
    "iterated, graded, quadratic": {"graded": Graded(STOP, 3.0), "order": 2},
}
TOLERANCES = [3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5]
OTHERS = {
    "libcosimpy": ("libcosimpy", {}),
    "ecospy": ("ecospy", {}),
    "syssimx, Jacobi": ("syssimx", {"method": "jacobi"}),
    "syssimx, Gauss-Seidel": ("syssimx", {"method": "gauss-seidel"}),
    "CoFMUPy, Jacobi": ("cofmupy", {"method": "jacobi", "iterative": False}),
    "CoFMUPy, Gauss-Seidel": ("cofmupy", {"method": "gauss-seidel", "iterative": False}),
    "CoFMUPy, iterated": ("cofmupy", {"method": "gauss-seidel", "iterative": True}),
}


def units(folder):
    """The plate whose face is a tile, the law, and the plate whose face is convective."""
    paths = []
    for name, text in (("split", SCENE + SPLIT), ("whole", SCENE + WHOLE)):
        (folder / f"{name}.toml").write_text(text)
        paths.append(build(folder / f"{name}.toml"))
    law = make(folder, "law", d=-COEFFICIENT, e=COEFFICIENT * AMBIENT)
    return paths[0], law, paths[1]


def truth(whole, steps):
    """Temperatures [K] at the times that are compared, by so many steps between two of them."""
    with Unit(whole) as unit:
        found = []
        for time in COMPARED:
            for part in np.linspace(unit.time, time, steps + 1)[1:]:
                unit.step_to(part)
            found.append(unit["centre.temperature"])
        return np.array(found)


def ours(plate, law, options):
    """Steps of the plate, temperatures and the energy residual."""
    with Master({"plate": plate, "law": law}, CONNECTIONS, energy=["law.y"], **options) as master:
        found = []
        for time in COMPARED:
            result = master.run(time)
            found.append(float(result["plate.centre.temperature"][-1]))
        lost = result.attrs["energy_residual.law.y"]
        return result.attrs["unit_steps.plate"], np.array(found), lost


def other(plate, law, tool, options, step):
    """The same by a master of others, or None where it ends in an error."""
    python = sys.executable if tool in ("libcosimpy", "ecospy") else str(masters())
    job = {"tool": tool, "plate": str(plate), "law": str(law), "step": step, "options": options}
    job["steps"] = round(STOP / step)
    command = [python, Path(__file__).with_name("masters.py"), json.dumps(job)]
    ran = subprocess.run(command, capture_output=True, text=True, check=False)
    lines = dict(line.split(" ", 1) for line in ran.stdout.splitlines() if line.startswith("rows "))
    if ran.returncode != 0 or not lines:
        return None
    rows = np.array(json.loads(lines["rows"]))
    taken = int(ran.stdout.split("unit steps")[1])
    at = [int(np.argmin(np.abs(rows[:, 0] - time))) for time in COMPARED]
    assert np.allclose(rows[at, 0], COMPARED, rtol=1e-6), rows[at, 0]
    return taken, rows[at, 1]


def masters():
    """Python beside CoFMUPy and syssimx."""
    return Path(os.environ.get("MASTERS", ROOT / ".venv-masters/bin/python"))


def slope(series):
    """The order: how error falls with the number of steps, from the first row to the last."""
    (first, error), (last, small) = series[0][:2], series[-1][:2]
    return np.log(error / small) / np.log(last / first)


def table(plate, law, exact):
    """Rows (steps of the plate, largest error [K], energy residual) by master."""
    found = {}
    for name, options in OURS.items():
        for step in STEPS:
            steps, values, lost = ours(plate, law, {"step": step, **options})
            found.setdefault(name, []).append((steps, np.abs(values - exact).max(), lost))
    for tolerance in TOLERANCES:
        options = {"step": 1e-5, "adaptive": True, "order": 2, "tolerance": tolerance}
        steps, values, lost = ours(plate, law, options)
        name = "iterated, adaptive, quadratic"
        found.setdefault(name, []).append((steps, np.abs(values - exact).max(), lost))
    for scheme in ("jacobi", "gauss-seidel"):
        for step in STEPS[1:]:
            steps, values, lost = ours(plate, law, {"step": step, "scheme": scheme})
            name = f"{scheme}, held"
            found.setdefault(name, []).append((steps, np.abs(values - exact).max(), lost))
    for name, (tool, options) in OTHERS.items():
        if tool in ("syssimx", "cofmupy") and not masters().is_file():
            print(f"{name}: left out, there is no {masters()}")
            continue
        for step in STEPS:
            result = other(plate, law, tool, options, step)
            if result is None:
                print(f"{name}: ends in an error at steps of {step} s")
                continue
            error = np.abs(result[1] - exact).max()
            found.setdefault(name, []).append((result[0], error, np.nan))
    return found


def at_steps(series, steps):
    """The error at a number of steps, between rows."""
    series = sorted(series)
    logs = np.log([[row[0], row[1]] for row in series])
    return float(np.exp(np.interp(np.log(steps), *logs.T)))


def judge(found):
    """Asserts what is claimed; returns the lines that say so."""
    mine = [name for name in found if name.startswith("iterated")]
    theirs = [name for name in OTHERS if name in found]
    best = "iterated, adaptive, quadratic"
    lines = []
    for name in mine[1:]:
        order = slope(found[name])
        lines.append(f"{name}: order {order:.2f} over the steps of the plate")
        assert order > 1.8, (name, order)
    for name in theirs:
        ratios = []
        for steps, error, _ in found[name]:
            low, high = min(found[best])[0], max(found[best])[0]
            if low <= steps <= high:
                ratios.append(error / at_steps(found[best], steps))
        lines.append(
            f"{name}: at equal steps {min(ratios):.0f} to {max(ratios):.0f} times the error"
        )
        assert min(ratios) > 10, (name, ratios)
    for name in mine:
        assert all(lost < 1e-4 for *_, lost in found[name]), found[name]
    return lines


def draw(found, path):
    figure, axes = plt.subplots(figsize=(11, 6.5), layout="constrained")
    for name, series in found.items():
        steps, errors = np.array(series)[:, :2].T
        is_ours = name.startswith("iterated")
        style = {"linewidth": 2.2, "marker": "o"} if is_ours else {"linewidth": 1.2, "marker": "x"}
        if "held" in name:
            style = {"linewidth": 1.2, "marker": "s", "linestyle": ":", "markersize": 4}
        axes.loglog(
            steps, errors, **style, label=("impinge: " if is_ours or "held" in name else "") + name
        )
    guide = np.array([30.0, 1000.0])
    axes.loglog(guide, 1.5 * (guide / 30) ** -2, color="black", linewidth=0.8, linestyle="--")
    axes.text(330, 0.015, "order 2", fontsize=10)
    axes.set_xlabel("steps of the plate's unit")
    axes.set_ylabel("largest error / K (rise 70 K), at eight times")
    axes.set_title("Plate under an outside law q = h (T∞ − T), split between two units", loc="left")
    axes.grid(alpha=0.3, which="both")
    figure.legend(loc="outside right upper", frameon=False)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110)
    print(f"picture: {path}")


def main(path):
    with TemporaryDirectory() as name:
        plate, law, whole = units(Path(name))
        exact, again = truth(whole, 1), truth(whole, 7)
        assert np.abs(exact - again).max() < 1e-10
        print(
            f"rise {exact[-1] - COLD:.1f} K; truth agrees with itself to"
            f" {np.abs(exact - again).max():.0e} K"
        )
        found = table(plate, law, exact)
    for master, series in found.items():
        told = ", ".join(f"{int(steps)}: {error:.2g}" for steps, error, _ in series)
        print(f"{master}: {told} (steps: error/K)")
    print("\n".join(judge(found)))
    draw(found, path)


if __name__ == "__main__":
    try:
        main(Path(sys.argv[1]))
    except ImpingeError as error:
        sys.exit(str(error))
