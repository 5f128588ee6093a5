"""Two thick solids of different temperature that touch through a conductance: how short do
exchanges have to be for the heat that passes?

Settings are those of half spaces of effusivities e₁, e₂, `H√t = h (1/e₁ + 1/e₂) √t`.
"""

from math import sqrt

from plan import Answer, Axis, Map, Work
from problems.half_spaces import heat_through_contact, reciprocal_effusivities
from problems.materials import ALUMINA as UPPER
from problems.materials import thermal, thermoelastic
from unit_run import run_unit, unit_work

HOT, COLD = 400.0, 300.0
STOP = 1e-3  # s
SIDE, THICKNESS = 1e-3, 2e-3  # m, ten times as deep as heat goes
LOWER = thermal(8000.0, 500.0, 15.0)
BIOT = [1e-2, 1e-1, 0.3, 1.0, 3.0, 1e1, 1e2, 1e5]
EXCHANGES = [1, 2, 3, 5, 10, 20, 40]


def conductance(biot: float) -> float:
    return biot / reciprocal_effusivities(LOWER, UPPER) / sqrt(STOP)


def body(material: dict, temperature: float) -> dict:
    return {
        "kind": "solid",
        "shape": {"box": [SIDE, SIDE, THICKNESS]},
        "material": thermoelastic(material),
        "initial_temperature": temperature,
        "mesh": {"spacing": SIDE / 2, "depth_spacing": 2e-6, "growth": 1.3},
    }


def work(biot: float, exchanges: float) -> Work:
    """`biot` is H√t of the whole time; a communication step is that time."""
    scene = {
        "name": "Touching",
        "stop_time": STOP,
        "step": STOP,
        "body": {"lower": body(LOWER, COLD), "upper": body(UPPER, HOT)},
        "coupling": [
            {
                "from": "lower.top",
                "to": "upper.bottom",
                "conductance": conductance(biot),
                "interval": STOP / exchanges,
            }
        ],
    }
    return unit_work(scene, ["lower.heat_in"], [STOP])


def error(answer: Answer, biot: float, exchanges: float) -> float:
    """Of the heat that has passed, relative."""
    heat = heat_through_contact(conductance(biot), HOT - COLD, STOP, LOWER, UPPER) * SIDE**2
    return abs(answer.values["lower.heat_in"][-1] / heat - 1)


def touching_solids() -> Map:
    return Map(
        name="coupling_solids",
        title="Two solids that touch",
        x=Axis("conductance h √t (1/e₁ + 1/e₂)", "1", BIOT),
        y=Axis("exchanges in the time", "1", EXCHANGES),
        outcome="relative error of the heat that passes",
        unit="1",
        bad=0.02,
        work=work,
        run=run_unit,
        judge=error,
        colours=(1e-6, 0.02),
    )
