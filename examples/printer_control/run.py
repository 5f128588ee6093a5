"""A printer lays drops on a heated bed under control; a plan by the bed's linear map beside it."""

import argparse
import sys
import time
from dataclasses import dataclass
from math import pi, sqrt
from pathlib import Path

import numpy as np
import xarray as xr

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import shared  # noqa: E402
import sheets  # noqa: E402
import warm_up  # noqa: E402
from impinge import Connection, Master, Unit  # noqa: E402
from pythonfmu import FmuBuilder  # noqa: E402

NAME = "printer_control"
HERE = Path(__file__).parent
START, INTERVAL, AFTER = 9.0, 0.35, 1.1  # s: the first drop, the next ones, how long after the last
FIRST, PITCH, DROPS = -10e-3, 10e-3, 3  # m, m
DIAMETER, DENSITY, SPECIFIC_HEAT, SPEED, GRAVITY = 5e-3, 1300.0, 1800.0, 0.15, 9.81
MASS = pi / 6 * DIAMETER**3 * DENSITY  # kg of a drop
HOT = 433.15  # K
EFFUSIVITIES = [sqrt(1.0 * DENSITY * SPECIFIC_HEAT), sqrt(167.0 * 2700.0 * 896.0)]  # drop, bed
TOTALS = ["bed.heat_in", "bed.heat_stored", "bed.heat_lost", "bed.max_temperature"]
TOTALS += [
    f"drop.{key}"
    for key in ("heat", "heat_stored", "mass", "released", "waiting", "momentum_z", "impulse_z")
    + ("stray_mass", "force_outside", "steps")
]
ZOOM, ZOOM_STEPS = 1e-3, 50  # s, how closely the first drop is looked at


@dataclass
class Print:
    """What was recorded over the run, and the first drop's first milliseconds in fine steps."""

    table: xr.Dataset
    drop: dict[str, np.ndarray]

    def of(self, name: str) -> np.ndarray:
        return self.table[f"printer.{name}"].values


def make(name: str, folder: Path) -> Path:
    """The unit of a Python class, by PythonFMU."""
    return Path(FmuBuilder.build_FMU(HERE / f"{name}.py", dest=folder))


def print_drops(
    fmu: Path, folder: Path, settings: dict[str, float], drops: int, after: float
) -> Print:
    """Warms the bed up, lets drops fall, and waits."""
    line = {"start": START, "interval": INTERVAL, "first": FIRST, "pitch": PITCH, "count": drops}
    units = {
        "schedule": make("schedule", folder),
        "controller": make("controller", folder),
        "printer": fmu,
    }
    master = Master(
        units,
        [
            ("schedule.release", "printer.drop.release"),
            ("schedule.x", "printer.drop.x"),
            ("printer.thermocouple.temperature", "controller.measured"),
            Connection("controller.power", "printer.heater.heat_flux[1,1]", gain=1 / warm_up.PAD),
        ],
        scheme="gauss-seidel",
        order=0,  # a controller holds its output over a step
        step=warm_up.SAMPLE,
        inputs={"controller.wanted": warm_up.WANTED},
        outputs=[f"printer.{name}" for name in (*warm_up.PROBES, *TOTALS, "surface.temperature")],
        parameters={
            "schedule": line,
            "controller": {**settings, "highest": warm_up.HIGHEST},
        },
    )
    with master:
        master.run(START)
        drop = look_at_a_drop(master.units["printer"])
        table = master.run(START + INTERVAL * (drops - 1) + after)
    return Print(table, drop)


def look_at_a_drop(printer: Unit) -> dict[str, np.ndarray]:
    """The first drop in steps of a millisecond; then the unit goes back to where it was."""
    names = ["drop.height", "drop.spread_diameter", "drop.heat"]
    rows, rises = [], []
    before = printer["surface.temperature"]
    below = before[int((FIRST + 20e-3) / 40e-3 * len(before))].mean()
    with printer.state() as state:
        printer.set({"drop.release": 1, "drop.x": FIRST})
        for _ in range(ZOOM_STEPS):
            printer.step(ZOOM)
            rows.append(printer.get(names))
            rises.append((printer["surface.temperature"] - before).max())
        printer.restore(state)
    times = ZOOM * np.arange(1, ZOOM_STEPS + 1)
    told = dict(zip(names, np.transpose(rows), strict=True))
    exact = heat_of_contact(times, told["drop.spread_diameter"], HOT - below)
    return {"time": times, **told, "rise": np.array(rises), "exact": exact}


def heat_of_contact(times: np.ndarray, diameters: np.ndarray, difference: float) -> np.ndarray:
    """Heat [J] that half spaces at rest pass through a disc that grows,

        Q(t) = ΔT e₁ e₂ / (e₁ + e₂) ∫ 2 √((t − τ) / π) dA(τ)

    with their effusivities e [W √s/(m² K)] and the area A [m²] (H. S. Carslaw, J. C. Jaeger,
    Conduction of Heat in Solids, Oxford 1959, §2.9)."""
    first, second = EFFUSIVITIES
    grown = np.diff(pi / 4 * np.maximum.accumulate(diameters) ** 2, prepend=0.0)
    since = np.maximum(times[:, None] - (times - ZOOM / 2)[None, :], 0.0)
    return difference * first * second / (first + second) * 2 * np.sqrt(since / pi) @ grown


def check_balances(done: Print, drops: int) -> None:
    """Heat, mass and momentum, printed and held to what they have to be."""
    times = done.table["time"].values
    heater = float(done.table["controller.power"].values[:-1] @ np.diff(times))
    brought, stored, lost = (done.of(f"bed.heat_{key}")[-1] for key in ("in", "stored", "lost"))
    given = done.of("drop.heat")[-1]
    had = drops * MASS * SPECIFIC_HEAT * (HOT - warm_up.WANTED)
    print(f"bed: {brought:.4f} J in = {stored:.4f} J stored + {lost:.4f} J lost", end="")
    _check("", brought - stored - lost, brought, 1e-9)
    print(f"  = heater {heater:.4f} J + drops {given:.4f} J", end="")
    _check("", brought - heater - given, brought, 1e-9)
    kept = -done.of("drop.heat_stored")[-1]
    print(f"drops gave {given:.4f} J of the {had:.2f} J above the set point,", end="")
    _check(" what they lost", given - kept, given, 1e-6)
    mass = done.of("drop.mass")[-1]
    print(f"{done.of('drop.released')[-1]:.0f} drops, {mass * 1e6:.4f} mg", end="")
    _check("", mass - drops * MASS, mass, 1e-9)
    falls = times[-1] - START - INTERVAL * np.arange(drops)
    weight = -MASS * float(np.sum(SPEED + GRAVITY * falls))
    momentum = done.of("drop.momentum_z")[-1] + done.of("drop.impulse_z")[-1]
    print(f"impulse of falls and weight {weight * 1e3:.5f} mN s", end="")
    _check("", momentum - weight, weight, 1e-4)
    stray = done.of("drop.stray_mass")[-1] / mass
    print(f"{stray:.1%} of the fluid has come off the drops, and lies beside their rims")
    assert not done.of("drop.waiting").any() and not done.of("drop.force_outside").any()
    assert stray < 0.1


def _check(what: str, residual: float, scale: float, allowed: float) -> None:
    share = abs(residual / scale)
    print(f"{what} to {share:.0e}")
    assert share < allowed, f"{share} (allowed: {allowed})"


def report_print(done: Print) -> None:
    rows = []
    times = done.table["time"].values
    probes = [done.of(probe) - shared.ZERO_CELSIUS for probe in warm_up.PROBES]
    power, released = done.table["controller.power"].values, done.of("drop.released")
    flow = np.gradient(done.of("drop.heat"), times)
    for t in [1, 2, 4, 8, *np.arange(START, times[-1] + 1e-6, INTERVAL)]:
        k = int(np.argmin(np.abs(times - t)))
        values = [values[k] for values in (*probes, power, flow)]
        rows.append([f"{t:.1f}", f"{released[k]:.0f}", *(f"{value:.2f}" for value in values)])
    head = ["t/s", "drops", "thermocouple/°C", "middle/°C", "heater/W", "drops/W"]
    shared.print_table(head, rows)


def compare(folder: Path, settings: dict[str, float], found, done: Print):
    """The same change of set point by plan, plan made anew and PI, on two beds."""
    controller = make("controller", folder)
    bed = HERE / "bed.toml"
    best = warm_up.make_plan(found)
    more: list[float] = []
    runs: dict[str, warm_up.Run] = {}
    for other, parameters in (("", {}), (", other bed", warm_up.OTHER)):
        with Unit(bed, parameters=parameters) as unit, Unit(bed) as model:
            begin = unit.state()
            runs[f"plan{other}"] = warm_up.follow(unit, best.inputs)
            if other:
                unit.restore(begin)
                runs[f"plan anew{other}"], more = warm_up.replan(unit, model, found)
            for name, chosen in (("PI by rule", settings), ("PI searched", warm_up.SEARCHED)):
                unit.restore(begin)
                runs[f"{name}{other}"] = warm_up.under_pi(unit, controller, chosen)
    off = np.abs(runs["plan"].temperatures - best.outputs).max()
    rows = []
    for name, run in runs.items():
        values = [run.rise_time, run.overshoot, run.settling_time]
        values += [run.temperatures[:, 1].max() - shared.ZERO_CELSIUS, run.energy]
        rows.append([name, *("–" if np.isnan(value) else f"{value:.2f}" for value in values)])
    head = ["", "rise/s", "overshoot/K", "within 1 K/s", "middle at most/°C", "heat/J"]
    shared.print_table(head, rows)
    again = min(warm_up.make_plan(found).seconds for _ in range(5))
    print(
        f"a plan of {warm_up.MOVES} moves: {best.seconds * 1e3:.1f} ms, again {again * 1e3:.1f} ms;"
        f" anew at each step, with the model's forecast: median {np.median(more) * 1e3:.1f} ms;"
        f" the bed does as planned to {off:.0e} K"
    )
    assert off < 1e-9 and again < 20e-3
    hottest = max(runs[name].temperatures[:, 1].max() for name in ("plan", "plan anew, other bed"))
    assert hottest < warm_up.HOTTEST + 1.0
    # The bed of bed.toml is that of scene.toml.
    rule = runs["PI by rule"]
    printed = np.interp(rule.times, done.table["time"].values, done.of(warm_up.PROBES[0]))
    assert np.abs(printed - rule.temperatures[:, 0]).max() < 1e-6
    return runs


def main(given: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--fmu", type=Path, default=HERE / "scene.toml", help="scene or unit")
    parser.add_argument("--drops", type=int, default=DROPS, help="[default: %(default)s]")
    parser.add_argument(
        "--after",
        type=float,
        default=AFTER,
        help="s, to go on after the last [default: %(default)s]",
    )
    parser.add_argument("--out", type=Path, default=shared.ROOT / "out" / NAME, help="folder")
    options = parser.parse_args(given)
    if not 1 <= options.drops <= DROPS:
        parser.error(f"--drops {options.drops} (allowed: 1 to {DROPS})")
    if not options.after >= 2 * warm_up.SAMPLE:
        parser.error(f"--after {options.after} (allowed: {2 * warm_up.SAMPLE} s or more)")
    options.out.mkdir(parents=True, exist_ok=True)
    began = time.perf_counter()
    with Unit(HERE / "bed.toml") as bed:
        found = warm_up.learn(bed)
    settings = warm_up.tune(found)
    mapped = time.perf_counter()
    print(f"map of {found.steps} steps in {mapped - began:.2f} s, adds up to {found.defect:.0e}")
    print(f"PI: {settings['gain']:.2f} W/K, {settings['integral_time']:.2f} s")
    done = print_drops(options.fmu, options.out, settings, options.drops, options.after)
    printed = time.perf_counter()
    share = done.drop["drop.heat"][-1] / done.drop["exact"][-1] - 1
    print(f"the first drop's heat after {ZOOM * ZOOM_STEPS * 1e3:.0f} ms:", end="")
    print(f" {share:+.1%} beside half spaces that touch where it is")
    print(f"printed {options.drops} drops in {printed - mapped:.1f} s")
    report_print(done)
    check_balances(done, options.drops)
    runs = compare(options.out, settings, found, done)
    sheets.draw_print(done, options.out)
    sheets.draw_plans(runs, options.out)
    spent = time.process_time()
    print(f"{time.perf_counter() - began:.1f} s in all, {spent:.1f} s of processor")


if __name__ == "__main__":
    main()
