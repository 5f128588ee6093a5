"""A plate that is cooled suddenly: its first crack, in long and short steps."""

from functools import cache
from math import cos, exp, inf, log, pi, sin

from plan import Answer, Axis, Boundary, Map, Work
from problems.materials import ALUMINA, thermoelastic
from problems.plates import scene
from references import Reference
from scipy.optimize import brentq, minimize_scalar
from unit_run import equal_steps, run_unit, unit_work

from cases.solids.plates import DIFFUSIVITY

YOUNG, POISSON, EXPANSION = 300e9, 0.22, 8e-6  # Pa, 1, 1/K
STRENGTH, HALF, WIDTH, BIOT = 200e6, 1e-3, 1e-3, 10.0  # Pa, m, m, 1
LENGTH = HALF / 8.0
ENERGY = STRENGTH**2 * 8.0 * LENGTH / (3.0 * YOUNG)
WARM = 2500.0  # K
OUTPUTS = ["plate.first_crack_time", "plate.crack_length"]
SEEN = 10.0
"""Time of a run over that of the highest stress; longer steps are taken once."""
TOLD = "thermal shock"


@cache
def eigenvalues() -> list[float]:
    """`ζ tan ζ = Bi`."""

    def excess(zeta: float) -> float:
        return zeta * sin(zeta) - BIOT * cos(zeta)

    return [brentq(excess, n * pi, (n + 0.5) * pi) for n in range(60)]


def stress(fourier: float) -> float:
    """Of the surface over EαΔT: mean less surface temperature of a slab in a fluid.

    Carslaw & Jaeger (1959), § 3.11."""
    total = 0.0
    for zeta in eigenvalues():
        part = 4.0 * sin(zeta) / (2.0 * zeta + sin(2.0 * zeta)) * exp(-(zeta**2) * fourier)
        total += part * (sin(zeta) / zeta - cos(zeta))
    return total


@cache
def highest() -> tuple[float, float]:
    """Fourier number of the highest stress, and this stress."""
    found = minimize_scalar(
        lambda place: -stress(exp(place)), bounds=(log(1e-3), 0.0), method="bounded"
    )
    return exp(found.x), -found.fun


def moment() -> float:
    """Time of the highest stress [s]."""
    return highest()[0] * HALF**2 / DIFFUSIVITY


def cooled(severity: float, part: float) -> Work:
    """Half of a plate whose elastic stress would come to so many times its strength."""
    colder = severity * STRENGTH / (YOUNG * EXPANSION * highest()[1])
    fracture = {"model": "at1", "length": LENGTH, "energy": ENERGY, "scatter": 0.05, "seed": 1}
    elastic = {"young": YOUNG, "poisson": POISSON, "expansion": EXPANSION}
    coefficient = BIOT * ALUMINA["conductivity"] / HALF
    body = {
        "shape": {"box": [1.5 * HALF, WIDTH, HALF]},
        "section": "plane_stress",
        "material": thermoelastic(ALUMINA, elastic, {"fracture": fracture}),
        "initial_temperature": WARM,
        "faces": {
            "left": {"roller": True},
            "bottom": {"roller": True},
            "top": {"convection": {"coefficient": coefficient, "ambient": WARM - colder}},
        },
    }
    count = max(round(SEEN / part), 1)
    step = part * moment()
    told = scene(body, count * step, step)
    return unit_work(told, OUTPUTS, equal_steps(count * step, count), about=TOLD)


PARTS = [0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0]
SEVERITIES = [1.3, 1.6, 2.0, 3.0, 4.0]
REFERENCES = {
    severity: Reference(f"shock of {severity:g} strengths", cooled(severity, 0.1), run_unit)
    for severity in SEVERITIES
}


def time_of(answer: Answer, severity: float, _: float) -> float:
    """Returns how late the first crack is, over the time of the highest stress; zero is none."""
    found = answer.values["plate.first_crack_time"][-1]
    expected = REFERENCES[severity].value("plate.first_crack_time")
    if (found > 0.0) != (expected > 0.0):
        return inf
    return abs(found - expected) / moment()


def length_of(answer: Answer, severity: float, _: float) -> float:
    """Over the length itself, or that of damage where cracks are shorter."""
    expected = REFERENCES[severity].value("plate.crack_length")
    return abs(answer.values["plate.crack_length"][-1] - expected) / max(expected, LENGTH)


def map_of(name: str, title: str, outcome: str, bad: float, judge) -> Map:
    warned = 0.04 * HALF**2 / DIFFUSIVITY / moment()
    return Map(
        name=name,
        title=title,
        x=Axis("highest elastic stress over strength", "1", SEVERITIES),
        y=Axis("step over the time of the highest stress", "1", PARTS),
        outcome=outcome,
        unit="1",
        bad=bad,
        work=cooled,
        run=run_unit,
        judge=judge,
        theory=[Boundary("κt/H² = 0.04", lambda _: warned, "`check` warns beyond", False)],
        references=list(REFERENCES.values()),
        colours=(1e-3, 3.0),
    )


def first_crack() -> Map:
    title = "First crack after a sudden cooling"
    outcome = "how late it is, over the time of the highest stress"
    return map_of("first_crack", title, outcome, 0.5, time_of)


def shock_cracks() -> Map:
    title = "Cracks after a sudden cooling"
    return map_of("shock_cracks", title, "error of their length", 0.1, length_of)
