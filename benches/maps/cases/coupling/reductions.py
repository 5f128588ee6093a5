"""A reduced plate beside the full one on the same mesh, under heat that is switched on and off: is
it off by no more than it says?
"""

from math import nan

from plan import Answer, Axis, Map, Work
from problems.plates import CENTRE, load, probe, scene
from unit_run import run_unit, unit_work

TOLERANCES = [1e-1, 1e-2, 1e-3, 1e-4]
PERIODS = [1e-6, 1e-4, 1e-3, 1e-2, 1e-1]
STOP, COUNT, FLUX = 1e-2, 24, 1e7
START = 300.0


def work(tolerance: float, period: float) -> Work:
    """The default experiment is a step of the flux up to `STOP`; here it is on for half a period
    and off for the other, in 24 steps of a quarter of that."""
    plate = {
        "shape": {"disc": {"radius": 1e-3, "thickness": 0.3e-3}},
        "initial_temperature": START,
        "mesh": {"spacing": 4e-5, "depth_spacing": 1e-5, "growth": 1.2},
        "faces": {"bottom": {"convection": {"coefficient": 1e4, "ambient": START}}},
    }
    spot = load({"gaussian": {"radius": 2e-4}}, "heat_flux", FLUX)
    probes = [CENTRE, probe("beside", [3e-4, 0.0, -1e-4], "temperature")]
    told = scene(plate, STOP, STOP / 10, "Spot", load=[spot], probe=probes)
    return {"scene": told, "tolerance": tolerance, "period": period}


def run(of: Work) -> Answer:
    """Temperatures of both, and the largest error that the reduced one says."""
    temperatures = ["centre.temperature", "beside.temperature"]
    flux = [FLUX * (n // 2 % 2 == 0) for n in range(COUNT)]
    values = {}
    for level in ("full", "reduced"):
        fidelity = {"level": level, "tolerance": of["tolerance"] if level == "reduced" else 0.9}
        more = ["plate.error_bound_temperature"] if level == "reduced" else []
        steps = [of["period"] / 4] * COUNT
        told = unit_work(
            of["scene"] | {"fidelity": fidelity},
            temperatures + more,
            steps,
            {"spot.heat_flux": flux},
        )
        answer = run_unit(told)
        if answer.refused:
            return answer
        values |= {f"{level}.{name}": row for name, row in answer.values.items()}
    return Answer(values, answer.warned)


def share(answer: Answer, tolerance: float, period: float) -> float:
    """The largest error over the bound at its time; what is within rounding counts as that."""
    values = answer.values
    bounds = values["reduced.plate.error_bound_temperature"]
    worst = 0.0
    for place in ("centre", "beside"):
        rows = zip(
            values[f"reduced.{place}.temperature"],
            values[f"full.{place}.temperature"],
            bounds,
            strict=True,
        )
        worst = max([worst, *(abs(a - b) / max(bound, 1e-10) for a, b, bound in rows)])
    return worst or nan


def reductions() -> Map:
    return Map(
        name="coupling_reductions",
        title="A reduced plate beside the full one",
        x=Axis("period of the heat", "s", PERIODS),
        y=Axis("tolerance asked for", "1", TOLERANCES),
        outcome="error over the bound that the unit tells",
        unit="1",
        bad=1.0,
        work=lambda period, tolerance: work(tolerance, period),
        run=run,
        judge=share,
        colours=(1e-4, 1.0),
    )
