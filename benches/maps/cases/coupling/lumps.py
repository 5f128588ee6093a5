"""Two lumped bodies that pass heat through a conductance, one step after the other: from which
length of step on does each scheme of a master fail?

`C₁ T₁' = q`, `C₂ T₂' = −q`, `q = G (T₂ − T₁)`, inputs held over a step H, units exact within it.
"""

from math import atanh, exp, inf, sqrt

from plan import Answer, Axis, Boundary, Map, Work

from cases.coupling.linear import RING, coupled, lumps

STEPS = 40
RATIOS = [0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0]
LENGTHS = [0.1, 0.2, 0.4, 0.7, 1.0, 1.4, 2.0, 3.0, 5.0, 10.0]


def work(scheme: str):
    def of(ratio: float, length: float) -> Work:
        return {"scheme": scheme, "ratio": ratio, "length": length, "steps": STEPS}

    return of


def run(of: Work) -> Answer:
    """C₁ = 1 J/K, G = 1 W/K: the length of the step is G H/C₁."""
    return coupled(
        lambda folder: lumps(folder, 1.0, of["ratio"]),
        RING,
        of["steps"] * of["length"],
        ["a.y", "b.y"],
        scheme=of["scheme"],
        step=of["length"],
    )


def growth(answer: Answer, ratio: float, length: float) -> float:
    """Amplification of the flux in the first step: two bodies have one mode."""
    flux = answer.values["b.y"]
    return abs(flux[2] / flux[1])


def error(answer: Answer, ratio: float, length: float) -> float:
    """Of the first temperature at ends of steps, over its first distance from rest."""
    rate, share = 1.0 + 1.0 / ratio, ratio / (1.0 + ratio)
    exact = (1.0 - share * (1.0 - exp(-rate * n * length)) for n in range(STEPS + 1))
    pairs = zip(answer.values["a.y"], exact, strict=True)
    return max(abs(found - wanted) for found, wanted in pairs) / share


def root(function, low: float, high: float) -> float:
    """Where a function changes its sign, on a logarithmic scale."""
    for _ in range(60):
        middle = sqrt(low * high)
        low, high = (middle, high) if function(middle) < 0 else (low, middle)
    return low


def jacobi_limit(ratio: float) -> float:
    """G H/C₁ = 1 + e^(−G H/C₂)."""
    return root(lambda z: z - 1.0 - exp(-z / ratio), 0.5, 4.0)


def gauss_seidel_limit(ratio: float) -> float:
    """C₂/C₁ (1 − e^(−G H/C₂)) = 1 + e^(−G H/C₂): of one that follows how the other's temperature
    went over the step, in a straight line; there is none where it has the smaller capacity."""
    return 2.0 * ratio * atanh(1.0 / ratio) if ratio > 1.0 else inf


def lumped(name: str, title: str, scheme: str, **more) -> Map:
    return Map(
        name=name,
        title=title,
        x=Axis("heat capacity that takes a temperature over that which takes a flux", "1", RATIOS),
        y=Axis("step G H/C₁", "1", LENGTHS),
        work=work(scheme),
        run=run,
        guards="the master warns of steps that are too long for what is passed on",
        **more,
    )


AMPLIFICATION = {
    "outcome": "amplification of a step",
    "unit": "1",
    "bad": 1.0,
    "judge": growth,
    "refine": 1.005,
    "colours": (0.01, 10.0),
}


def jacobi() -> Map:
    limit = Boundary("G H/C₁ = 1 + exp(−G H/C₂)", jacobi_limit, "amplification of held inputs")
    title = "Two bodies, all units at once"
    return lumped("coupling_jacobi", title, "jacobi", theory=[limit], **AMPLIFICATION)


def gauss_seidel() -> Map:
    limit = Boundary("G H/C₂ = 2 artanh(C₁/C₂)", gauss_seidel_limit, "amplification, straight path")
    title = "Two bodies, one after the other"
    return lumped("coupling_gauss_seidel", title, "gauss-seidel", theory=[limit], **AMPLIFICATION)


def iterate() -> Map:
    return lumped(
        "coupling_iterate",
        "Error of two bodies in iterated steps",
        "iterate",
        outcome="largest error over the first temperature difference",
        unit="1",
        bad=0.1,
        judge=error,
        colours=(1e-3, 1.0),
    )
