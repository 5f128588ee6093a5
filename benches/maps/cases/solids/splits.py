"""A block in plane strain that is pulled or pressed until damage begins, for each split."""

from math import inf, sqrt

from plan import Answer, Axis, Map, Work
from problems.materials import ALUMINA, thermoelastic
from problems.plates import scene
from unit_run import run_unit, unit_work

YOUNG, ENERGY, LENGTH, WIDTH = 300e9, 40.0, 50e-6, 1e-3  # Pa, J/m², m, m
SIDE = 4.0 * LENGTH
STRENGTH = sqrt(0.375 * YOUNG * ENERGY / LENGTH)
"""Of a bar of AT1 without a split [Pa]: Pham et al. (2011), doi 10.1177/1056789510386852."""
STEP, FINE, MOST = 1.0, 0.005, 30.0
"""Communication step [s], step of the load near its limit, and load of blocks without one."""
SPLITS = ["none", "no_tension", "spectral", "volumetric"]
KINDS = [(split, sign) for sign in (1.0, -1.0) for split in SPLITS]


def released(split: str, sign: float, poisson: float) -> float:
    """`2Eψ⁺/σ²` of the stress σ along z in plane strain, free along x; all of it is `1 − ν²`.

    `Eε_z/σ = 1 − ν²`, `Eε_x/σ = −ν(1 + ν)`, `E tr ε/σ = (1 + ν)(1 − 2ν)`. Opened along z, a body
    without tension keeps `ε_x²/(1 − ν²)`; pressed, all."""
    nu = poisson
    along, across, volume = 1.0 - nu**2, -nu * (1.0 + nu), (1.0 + nu) * (1.0 - 2.0 * nu)
    if split == "no_tension":
        return along - across**2 / along if sign > 0.0 else 0.0
    if split == "spectral":
        if sign < 0.0:
            return across**2 / (1.0 + nu)
        return nu / volume * volume**2 + along**2 / (1.0 + nu)
    if split == "volumetric" and sign < 0.0:
        return along - volume**2 / (3.0 * (1.0 - 2.0 * nu))
    return along


def limit(split: str, sign: float, poisson: float) -> float:
    """Stress over the bar's strength at which damage begins: `2Eψ⁺ = σ_t²`."""
    part = released(split, sign, poisson)
    return 1.0 / sqrt(part) if part > 1e-12 else inf


def path(split: str, sign: float, poisson: float) -> list[float]:
    """Loads over the bar's strength: up to a tenth more than the limit, or to `MOST`."""
    most = limit(split, sign, poisson)
    if most > MOST:
        return [0.5, 1.0, 2.0, 5.0, 10.0, MOST]
    near = [1.0 + FINE * (place + 0.5) for place in range(-20, 20)]
    return [part * most for part in (0.3, 0.6, *near)]


def loaded(poisson: float, kind: float) -> Work:
    split, sign = KINDS[int(kind)]
    elastic = {"young": YOUNG, "poisson": poisson, "expansion": 8e-6}
    fracture = {"model": "at1", "length": LENGTH, "energy": ENERGY, "split": split}
    body = {
        "shape": {"box": [SIDE, WIDTH, SIDE]},
        "section": "plane_strain",
        "material": thermoelastic(ALUMINA, elastic, {"fracture": fracture}),
        "faces": dict.fromkeys(("left", "bottom"), {"roller": True}),
    }
    pull = {
        "name": "pull",
        "on": "plate.top",
        "footprint": {"tiles": {"count": [1, 1], "size": [SIDE, WIDTH]}},
        "carries": ["pressure"],
    }
    loads = path(split, sign, poisson)
    told = scene(body, STEP * len(loads), STEP, load=[pull])
    inputs = {"pull.pressure[1,1]": [-sign * part * STRENGTH for part in loads]}
    return unit_work(told, ["plate.max_damage"], [STEP] * len(loads), inputs)


def of_limit(answer: Answer, poisson: float, kind: float) -> float:
    """Of the middle between the last load without damage and the first with it."""
    split, sign = KINDS[int(kind)]
    expected, loads = limit(split, sign, poisson), path(split, sign, poisson)
    damage = answer.values["plate.max_damage"][1:]
    first = next((place for place, most in enumerate(damage) if most > 1e-3), None)
    if first is None or expected > MOST:
        return 0.0 if first is None and expected > MOST else inf
    below = loads[first - 1] if first else 0.0
    return abs(0.5 * (below + loads[first]) / expected - 1.0)


def splits() -> Map:
    return Map(
        name="splits",
        title="Stress at which a block in plane strain breaks",
        x=Axis(
            "Poisson's ratio",
            "1",
            [0.0, 0.1, 0.2, 0.3, 0.4, 0.45, 0.49],
            is_logarithmic=False,
        ),
        y=Axis(
            "split and load",
            "",
            [float(place) for place in range(len(KINDS))],
            is_logarithmic=False,
            labels=[f"{split},\n{'pulled' if sign > 0.0 else 'pressed'}" for split, sign in KINDS],
        ),
        outcome="error of the stress",
        unit="1",
        bad=0.05,
        work=loaded,
        run=run_unit,
        judge=of_limit,
        colours=(1e-3, 0.2),
    )
