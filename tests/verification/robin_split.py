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
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "tests/python"), str(ROOT / "benches")]
from impinge import Master, Unit  # noqa: E402
from impinge.master import Graded  # noqa: E402
from impinge.unit import build  # noqa: E402
from linear_unit import make  # noqa: E402
from pictures import save  # noqa: E402

COEFFICIENT, AMBIENT, COLD = 1e5, 373.15, 293.15  # W/(m² K), K, K
STOP = 64e-3  # s
STEPS = [8e-3, 4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4]

MATERIAL = '{ model = "thermoelastic", density = 3950, specific_heat = 900, conductivity = 10 }'
SCENE = f"""
name = "Plate"
stop_time = {STOP}
step = 1e-3

[body.plate]
kind = "solid"
shape = {{ box = [2e-3, 2e-3, 1e-3] }}
material = {MATERIAL}
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
BEST, GRADED = "iterated, adaptive, quadratic", "iterated, graded, quadratic"
TOLERANCES = [3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6]
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


def truth(unit, times):
    """Temperatures [K] of the plate whose face is convective."""
    unit.reset()
    found = []
    for time in times:
        unit.step_to(time)
        found.append(unit["centre.temperature"])
    return np.array(found)


def errors(unit, times, temperatures):
    """The largest error [K] at the times where a master has stopped, and that at the end."""
    apart = np.abs(temperatures - truth(unit, times))
    return apart.max(), apart[-1]


def ours(plate, law, whole, options):
    """Steps of the plate, errors and the energy residual."""
    with Master({"plate": plate, "law": law}, CONNECTIONS, energy=["law.y"], **options) as master:
        result = master.run(STOP)
    told = result["plate.centre.temperature"][1:]
    found = errors(whole, told.time.values, told.values)
    return result.attrs["unit_steps.plate"], *found, result.attrs["energy_residual.law.y"]


def other(plate, law, whole, tool, options, step):
    """The same by a master of others, without a residual, or what it ends with."""
    python = sys.executable if tool in ("libcosimpy", "ecospy") else str(masters())
    job = {"tool": tool, "plate": str(plate), "law": str(law), "step": step, "options": options}
    job["steps"] = round(STOP / step)
    command = [python, Path(__file__).with_name("masters.py"), json.dumps(job)]
    # CoFMUPy takes units in the order of a set, which differs from run to run.
    environment = {**os.environ, "PYTHONHASHSEED": "0"}
    ran = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
    lines = [line for line in ran.stdout.splitlines() if line.startswith("rows ")]
    if ran.returncode != 0 or not lines:
        return (ran.stdout + ran.stderr).strip().splitlines()[-1]
    rows = np.array(json.loads(lines[0][5:]))
    taken = int(ran.stdout.split("unit steps")[1])
    return taken, *errors(whole, rows[:, 0], rows[:, 1]), np.nan


def masters():
    """Python beside CoFMUPy and syssimx."""
    return Path(os.environ.get("MASTERS", ROOT / ".venv-masters/bin/python"))


def order(series):
    """How the largest error falls with the number of steps, from the first row to the last."""
    (first, error), (last, small) = series[0][:2], series[-1][:2]
    return np.log(error / small) / np.log(last / first)


def table(plate, law, whole):
    """Rows (steps of the plate, largest error, error at the end [K], energy residual) by master."""
    found = {}
    for name, options in OURS.items():
        rows = [ours(plate, law, whole, {"step": step, **options}) for step in STEPS]
        found[name] = rows
    options = {"step": 1e-5, "adaptive": True, "order": 2}
    rows = [ours(plate, law, whole, {"tolerance": each, **options}) for each in TOLERANCES]
    found[BEST] = rows
    for scheme in ("jacobi", "gauss-seidel"):
        options = {"scheme": scheme}
        rows = [ours(plate, law, whole, {"step": step, **options}) for step in STEPS[1:]]
        found[f"{scheme}, held"] = rows
    for name, (tool, options) in OTHERS.items():
        if tool in ("syssimx", "cofmupy") and not masters().is_file():
            print(f"{name}: left out, as there is no {masters()}")
            continue
        for step in STEPS:
            row = other(plate, law, whole, tool, options, step)
            if isinstance(row, str):
                print(f"{name}, steps of {step * 1e3:g} ms: ends with “{row}”")
            else:
                found.setdefault(name, []).append(row)
    return found


def between(series, steps, column):
    """The error at a number of steps, between rows."""
    logs = np.log([[row[0], row[column]] for row in sorted(series)])
    return float(np.exp(np.interp(np.log(steps), *logs.T)))


def judge(found):
    """Asserts what is claimed; returns the lines that say so."""
    mine = [name for name in found if name.startswith("iterated")]
    theirs = [name for name in OTHERS if name in found]
    lines = []
    for name in mine[1:]:
        lines.append(f"{name}: order {order(found[name]):.2f} over the steps of the plate")
        assert order(found[name]) > 1.8, (name, order(found[name]))
    low = min(found[BEST])[0]
    for name in theirs:
        rows = [row for row in found[name] if row[0] >= low]
        most = [row[1] / between(found[BEST], row[0], 1) for row in rows]
        last = [row[2] / between(found[GRADED], max(row[0], 72), 2) for row in rows]
        lines.append(
            f"{name}: at equal steps {min(most):.0f} to {max(most):.0f} times the largest error,"
            f" {min(last):.1f} to {max(last):.0f} times that at the end"
        )
        assert min(most) > 10, (name, most)
    for name in mine:
        assert all(lost < 1e-4 for *_, lost in found[name]), found[name]
    return lines


def draw(found, path):
    figure, both = plt.subplots(1, 2, figsize=(14, 6.2), layout="constrained", sharex=True)
    for name, series in found.items():
        steps, *columns, _ = np.array(series).T
        is_ours = name in OURS or name == BEST
        style = {"linewidth": 1.2, "marker": "x"}
        if is_ours:
            style = {"linewidth": 2.2, "marker": "o"}
        elif "held" in name:
            style = {"linewidth": 1.2, "marker": "s", "linestyle": ":", "markersize": 4}
        label = name if name in OTHERS else f"impinge: {name}"
        for axes, column in zip(both, columns, strict=True):
            axes.loglog(steps, column, **style, label=label)
    titles = ["Largest error at the master’s own times", "Error at the end"]
    guide = np.array([40.0, 900.0])
    for axes, title, start in zip(both, titles, (10.0, 0.1), strict=True):
        axes.loglog(guide, start * (guide / 40) ** -2, color="black", linewidth=0.8, ls="--")
        axes.text(500, start * 0.012, "order 2", fontsize=10)
        axes.set_title(title, loc="left", fontsize=11)
        axes.set_xlabel("steps of the plate’s unit")
        axes.set_ylabel("K")
        axes.grid(alpha=0.25, which="both")
        axes.spines[["top", "right"]].set_visible(False)
    figure.suptitle(
        "A plate under an outside law q = h (T∞ − T), split between two units: rise 70 K in 64 ms",
        x=0.01,
        ha="left",
        fontweight="bold",
    )
    figure.legend(*both[0].get_legend_handles_labels(), loc="outside right center", frameon=False)
    path.parent.mkdir(parents=True, exist_ok=True)
    save(figure, path)
    print(f"picture: {path}")


def main(path):
    with TemporaryDirectory() as name:
        plate, law, whole = units(Path(name))
        with Unit(whole) as convective:
            end = [truth(convective, np.linspace(0, STOP, n + 1)[1:])[-1] for n in (1, 37)]
            assert abs(end[1] - end[0]) < 1e-10
            print(f"rise {end[0] - COLD:.1f} K; truth agrees with itself to {np.ptp(end):.0e} K")
            found = table(plate, law, convective)
    for master, series in found.items():
        told = ", ".join(f"{row[0]}: {row[1]:.2g}, {row[2]:.2g}" for row in series)
        print(f"{master}: {told} (steps: largest error, that at the end / K)")
    draw(found, path)
    print("\n".join(judge(found)))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
