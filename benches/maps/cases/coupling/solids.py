"""Two thick solids of different temperature that touch through a conductance: how short do
exchanges have to be for the heat that passes?

Half spaces of effusivities e₁, e₂ whose faces pass `q = h ΔT` (H. S. Carslaw, J. C. Jaeger 1959,
§ 2.7, for both): with `H = h (1/e₁ + 1/e₂)`, `q = h ΔT e^(H²t) erfc(H√t)` and
`Q = h ΔT/H² (e^(H²t) erfc(H√t) − 1 + 2H√(t/π))`.
"""

from math import pi, sqrt

from plan import Answer, Axis, Map, Work
from scipy.special import erfcx
from unit_run import run_unit, unit_work

HOT, COLD = 400.0, 300.0
STOP = 1e-3  # s
SIDE, THICKNESS = 1e-3, 2e-3  # m, ten times as deep as heat goes
LOWER = {"density": 8000.0, "specific_heat": 500.0, "conductivity": 15.0}
UPPER = {"density": 3950.0, "specific_heat": 900.0, "conductivity": 10.0}
BIOT = [1e-2, 1e-1, 0.3, 1.0, 3.0, 1e1, 1e2, 1e5]
EXCHANGES = [1, 2, 3, 5, 10, 20, 40]


def effusivity(material: dict) -> float:
    return sqrt(material["density"] * material["specific_heat"] * material["conductivity"])


RECIPROCAL = 1 / effusivity(LOWER) + 1 / effusivity(UPPER)


def body(material: dict, temperature: float) -> dict:
    return {
        "kind": "solid",
        "shape": {"box": [SIDE, SIDE, THICKNESS]},
        "material": {"model": "thermoelastic"} | material,
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
                "conductance": biot / RECIPROCAL / sqrt(STOP),
                "interval": STOP / exchanges,
            }
        ],
    }
    return unit_work(scene, ["lower.heat_in"], [STOP])


def error(answer: Answer, biot: float, exchanges: float) -> float:
    """Of the heat that has passed, relative."""
    conductance = biot / RECIPROCAL / sqrt(STOP)
    rate = biot / sqrt(STOP)
    shape = erfcx(biot) - 1 + 2 * biot / sqrt(pi)
    heat = conductance * (HOT - COLD) / rate**2 * shape * SIDE**2
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
