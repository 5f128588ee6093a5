"""A bar between rollers that cools until it breaks: its stress, and the energy of its crack."""

from math import inf, log, sqrt

from plan import Answer, Axis, Map, Work
from problems.materials import ALUMINA, thermoelastic
from problems.plates import probe, scene
from unit_run import run_unit, unit_work

YOUNG, POISSON, EXPANSION = 300e9, 0.2, 8e-6  # Pa, 1, 1/K
ENERGY, LENGTH, WIDTH = 40.0, 50e-6, 1e-3  # J/m², m, m
LONG, HIGH = 24.0, 3.0
"""Extents of the bar over the length of damage."""
WARM = 1000.0  # K
STEP = 5.0
"""Communication step, in which the bar takes the temperature of the fluid [s]."""
SETTINGS = [("at1", "none"), ("at1", "no_tension"), ("at2", "none"), ("at2", "no_tension")]
FINENESS = [3.0, 4.0, 5.0, 6.0, 8.0, 10.0]
OUTPUTS = ["middle.stress_xx", "plate.max_damage", "plate.dissipated_energy", "plate.first_crack_x"]


def strength(model: str, split: str) -> float:
    """`√(3EG_c/(8ℓ))` and `9/16 √(EG_c/(3ℓ))`: Pham et al. (2011), doi 10.1177/1056789510386852.

    `no_tension` keeps the energy `ν²σ²/(2E)` of the lateral contraction."""
    whole = YOUNG * ENERGY / LENGTH
    own = sqrt(0.375 * whole) if model == "at1" else 0.5625 * sqrt(whole / 3.0)
    return own / sqrt(1.0 - POISSON**2) if split == "no_tension" else own


def cooled(model: str, split: str, fineness: float, scatter: float, path: list[float]) -> Work:
    """`path` is the strain that is held back over σ_t/E."""
    fracture = {"model": model, "length": LENGTH, "energy": ENERGY, "split": split}
    if scatter:
        fracture |= {"scatter": scatter, "seed": 1}
    elastic = {"young": YOUNG, "poisson": POISSON, "expansion": EXPANSION}
    roller = {"roller": True}
    body = {
        "shape": {"box": [LONG * LENGTH, WIDTH, HIGH * LENGTH]},
        "section": "plane_stress",
        "material": thermoelastic(ALUMINA, elastic, {"fracture": fracture}),
        "initial_temperature": WARM,
        "mesh": {"spacing": LENGTH / fineness},
        "faces": dict.fromkeys(("left", "right", "bottom"), roller)
        | {"top": {"convection": {"coefficient": 1e3, "ambient": WARM}}},
    }
    middle = probe("middle", [0.0, 0.0, -0.5 * HIGH * LENGTH], "stress")
    colder = strength(model, split) / (YOUNG * EXPANSION)
    inputs = {"plate.top.ambient": [WARM - part * colder for part in path]}
    told = scene(body, STEP * len(path), STEP, probe=[middle])
    return unit_work(told, OUTPUTS, [STEP] * len(path), inputs)


def rising(first: float, last: float, step: float) -> list[float]:
    """Equal steps from beyond `first` to `last`."""
    count = round((last - first) / step)
    return [first + (last - first) * place / count for place in range(1, count + 1)]


def slowly(fineness: float, setting: float) -> Work:
    """In steps of a hundredth of the strain at the strength, with little scatter."""
    model, split = SETTINGS[int(setting)]
    first, last = (0.9, 1.2) if model == "at1" else (1.5, 2.1)
    path = [0.3, 0.6, 0.9, *rising(0.9, first, 0.1), *rising(first, last, 0.01)]
    return cooled(model, split, fineness, 0.02, path)


def expected(model: str, fineness: float, at_end: bool) -> float:
    """Energy of damage over that of a crack through the bar.

    A broken row of elements and the profile on one side of it or on both; bars of AT2 are damaged
    all over before they break, to d = 1/4 (Pham et al. 2011), which stays."""
    normal, base = (8.0 / 3.0, 0.0) if model == "at1" else (2.0, 0.25)
    sides, row = (1.0 if at_end else 2.0), 1.0 / (normal * fineness)
    crack = 0.5 * sides * (1.0 - row) * (1.0 - base**2) + row
    if not base:
        return crack
    beside = LONG - 1.0 / fineness + sides * (1.0 - row) * log(base)
    return crack + 0.5 * base**2 * beside


def of_energy(answer: Answer, model: str, fineness: float) -> float:
    """Infinite if the bar has not broken."""
    last = {name: values[-1] for name, values in answer.values.items()}
    if last["plate.max_damage"] < 0.99:
        return inf
    found = last["plate.dissipated_energy"] / (ENERGY * WIDTH * HIGH * LENGTH)
    at_end = abs(last["plate.first_crack_x"]) > (0.5 * LONG - 1.5 / fineness) * LENGTH
    return abs(found / expected(model, fineness, at_end) - 1.0)


def energy_of(answer: Answer, fineness: float, setting: float) -> float:
    return of_energy(answer, SETTINGS[int(setting)][0], fineness)


def stress_of(answer: Answer, _: float, setting: float) -> float:
    """The largest stress beside the strength."""
    return abs(max(answer.values["middle.stress_xx"]) / strength(*SETTINGS[int(setting)]) - 1.0)


def map_of(name: str, title: str, outcome: str, judge) -> Map:
    return Map(
        name=name,
        title=title,
        x=Axis("length of damage over element ℓ/h", "1", FINENESS),
        y=Axis(
            "model and split",
            "",
            [float(place) for place in range(len(SETTINGS))],
            is_logarithmic=False,
            labels=[f"{model},\n{split}" for model, split in SETTINGS],
        ),
        outcome=outcome,
        unit="1",
        bad=0.1,
        work=slowly,
        run=run_unit,
        judge=judge,
        colours=(1e-3, 0.3),
    )


def broken_bar_energy() -> Map:
    title = "Energy of the crack of a bar"
    return map_of("broken_bar_energy", title, "error of the energy", energy_of)


def broken_bar_stress() -> Map:
    title = "Stress at which a bar breaks"
    return map_of("broken_bar_stress", title, "error of the stress", stress_of)


SCATTERS = [0.0, 0.001, 0.003, 0.01, 0.03, 0.1, 0.3]


def evenly(step: float, scatter: float) -> Work:
    """AT1 from 0.9 of the strength to 1.3, in steps of so much."""
    return cooled("at1", "none", 3.0, SCATTERS[int(scatter)], [0.45, 0.9, *rising(0.9, 1.3, step)])


def even_bar() -> Map:
    return Map(
        name="even_bar",
        title="Energy of the crack of a bar that is strained evenly",
        x=Axis("step of strain over σ_t/E", "1", [0.005, 0.01, 0.02, 0.04, 0.1, 0.2, 0.4]),
        y=Axis(
            "scatter",
            "1",
            [float(place) for place in range(len(SCATTERS))],
            is_logarithmic=False,
            labels=[f"{scatter:g}" for scatter in SCATTERS],
        ),
        outcome="error of the energy",
        unit="1",
        bad=0.1,
        work=evenly,
        run=run_unit,
        judge=lambda answer, *_: of_energy(answer, "at1", 3.0),
        colours=(1e-3, 3.0),
    )
