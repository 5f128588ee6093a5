"""Risk of failure by flaws: a stress that is linear through a plate, and a sudden cooling."""

from plan import Answer, Axis, Map, Work
from problems.materials import ALUMINA, ELASTIC_ALUMINA, thermoelastic
from problems.plates import scene
from scipy.integrate import quad
from scipy.special import erfc
from unit_run import run_unit, unit_work

from cases.solids.plates import DIFFUSIVITY

COLD, COLDER, STRENGTH, VOLUME = 293.15, 100.0, 300e6, 1e-9  # K, K, Pa, m³
SIDE, THICK, FREE = 1e-3, 1e-3, 333.15  # m, m, K
REACH = 1e-4
"""√(at) at the end of a shock [m]; the body is 16 of it thick."""
PER_KELVIN = ELASTIC_ALUMINA["young"] * ELASTIC_ALUMINA["expansion"]
PER_KELVIN /= 1.0 - ELASTIC_ALUMINA["poisson"]
"""Stress of a plate that is held along its surface, per kelvin below its stress-free state [Pa]."""
MODULI = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0]
TOLD = "errors of outputs"


def held(
    modulus: float, mesh: dict, thickness: float, free: float, below: float, stop: float
) -> Work:
    """A plate on rollers whose top is cold from the first on; stress-free as it begins."""
    weibull = {"modulus": modulus, "strength": STRENGTH, "volume": VOLUME}
    roller = {"roller": True}
    body = {
        "shape": {"box": [SIDE, SIDE, thickness]},
        "material": thermoelastic(ALUMINA, ELASTIC_ALUMINA, {"weibull": weibull}),
        "initial_temperature": free,
        "mesh": mesh | {"spacing": 0.5 * SIDE, "growth": 1.0},
        "faces": {
            "top": {"temperature": COLD},
            "bottom": roller | {"temperature": below},
            "sides": roller,
        },
    }
    outputs = ["plate.failure_risk"]
    return unit_work(scene(body, stop, stop), outputs, [stop], about=TOLD)


def risk(modulus: float, colder: float, depth: float) -> float:
    """Of equibiaxial tension of a plate so much too cold [K] over an effective depth [m]."""
    return 2.0 * (colder * PER_KELVIN / STRENGTH) ** modulus * depth * SIDE**2 / VOLUME


def off(answer: Answer, expected: float) -> float:
    return abs(answer.values["plate.failure_risk"][-1] / expected - 1.0)


def linear_plate(modulus: float, layers: float) -> Work:
    """Two thirds of the thickness of its heat are in compression."""
    mesh = {"depth_spacing": THICK / layers}
    settled = 50.0 * THICK**2 / DIFFUSIVITY
    return held(modulus, mesh, THICK, FREE, COLD + COLDER, settled)


def of_linear(answer: Answer, modulus: float, _: float) -> float:
    """`∫ (1 − z/d)^m dz = d/(m + 1)` over the depth d in tension: Weibull (1951)."""
    colder = FREE - COLD
    return off(answer, risk(modulus, colder, THICK * colder / COLDER / (modulus + 1.0)))


def shocked_plate(order: int):
    def work(modulus: float, element: float) -> Work:
        """One step, in which heat reaches so many elements."""
        mesh = {"depth_spacing": element * REACH, "order": order}
        warm = COLD + COLDER
        return held(modulus, mesh, 16.0 * REACH, warm, warm, REACH**2 / DIFFUSIVITY)

    return work


def shock_depth(modulus: float) -> float:
    """`∫ erfc(z/2)^m dz`: Carslaw & Jaeger (1959), § 2.4, of the warm rest."""
    return quad(lambda z: erfc(0.5 * z) ** modulus, 0.0, 16.0, points=[0.1, 1.0, 4.0])[0]


def of_shock(answer: Answer, modulus: float, _: float) -> float:
    return off(answer, risk(modulus, COLDER, REACH * shock_depth(modulus)))


def risk_of_linear_stress() -> Map:
    return Map(
        name="risk_of_linear_stress",
        title="Risk of failure of a plate with a linear stress",
        x=Axis("Weibull's modulus m", "1", MODULI),
        y=Axis("elements through the thickness", "1", [1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 16.0]),
        outcome="error of the risk",
        unit="1",
        bad=0.1,
        work=linear_plate,
        run=run_unit,
        judge=of_linear,
        colours=(1e-12, 0.1),
    )


def shocked(name: str, title: str, order: int) -> Map:
    return Map(
        name=name,
        title=title,
        x=Axis("Weibull's modulus m", "1", MODULI),
        y=Axis("element over √(at)", "1", [16.0 / n for n in (128, 64, 32, 24, 16, 12, 8, 6, 4)]),
        outcome="error of the risk",
        unit="1",
        bad=0.1,
        work=shocked_plate(order),
        run=run_unit,
        judge=of_shock,
        colours=(1e-3, 1.0),
    )


def risk_of_shock() -> Map:
    return shocked("risk_of_shock", "Risk of failure after a sudden cooling", 2)


def risk_of_shock_linear() -> Map:
    return shocked("risk_of_shock_linear", "The same with linear elements", 1)
