"""Drops of six liquids on six substrates: what do heat and temperature below err by?

Beside finer particles; both depend on the liquid (how thin its layers of shear and heat are beside
particles), and on which of the two bounds the heat: a good conductor takes what the drop brings, an
insulator hardly any.
"""

from functools import partial
from statistics import mean

from plan import Answer, Axis, Map
from problems.drops import droplet, on_plate
from problems.materials import ALUMINA, COPPER, STEEL, diffusivity, liquid, thermal, thermoelastic
from problems.plates import CENTRE
from unit_run import equal_steps, run_unit, unit_work

DIAMETER, SPEED = 1e-4, 15.0
HOT, COLD = 350.0, 293.15  # K
STOP, STEPS = 2.0, 40
"""D/U, and steps over them."""
ACROSS, FINE = 20.0, 48.0
BAD, BAD_OF_FILMS = 0.1, 0.3
HEAT, TEMPERATURE = "plate.heat_in", "centre.temperature"


LIQUIDS = {
    "mercury": liquid(13534.0, 1.53e-3, 139.0, 8.5, 0.485),
    "tin": liquid(6980.0, 1.85e-3, 240.0, 30.0, 0.55),
    "steel melt": liquid(7000.0, 6e-3, 800.0, 30.0, 1.7),
    "water": liquid(998.0, 1e-3, 4182.0, 0.6, 0.072),
    "wax": liquid(780.0, 4e-3, 2200.0, 0.15, 0.027),
    "glycerol": liquid(1260.0, 0.1, 2500.0, 0.285, 0.06),
}
SOLIDS = {
    "aerogel": thermal(120.0, 1000.0, 0.015),
    "PMMA": thermal(1190.0, 1470.0, 0.19),
    "glass": thermal(2500.0, 800.0, 1.0),
    "alumina": ALUMINA,
    "steel": STEEL,
    "copper": COPPER,
}


def scene(fluid: str, solid: str, across: float, tolerance: float) -> dict:
    time = STOP * DIAMETER / SPEED
    rings = {"symmetry": "axisymmetric", "spacing": DIAMETER / across}
    drop = droplet(DIAMETER, SPEED, HOT, LIQUIDS[fluid], **rings)
    plate = {
        "kind": "solid",
        "shape": {"disc": {"radius": 5e-4, "thickness": 2e-4}},
        "material": thermoelastic(SOLIDS[solid]),
        "initial_temperature": COLD,
        # As deep as heat goes in a step.
        "mesh": {
            "spacing": 4e-6,
            "depth_spacing": min(0.5 * (diffusivity(SOLIDS[solid]) * time / STEPS) ** 0.5, 1e-5),
            "growth": 1.4,
        },
    }
    return {
        "name": "Pair",
        "stop_time": time,
        "step": time / STEPS,
        "body": {"drop": drop, "plate": plate},
        "coupling": [on_plate(1.8e-4)],
        "probe": [CENTRE],
        "solver": {"threads": 1},
        "fidelity": {"tolerance": tolerance},
    }


def work(
    x: float, y: float, across: float = ACROSS, tolerance: float = BAD, method: str = "sph"
) -> dict:
    fluid, solid = list(LIQUIDS)[round(y)], list(SOLIDS)[round(x)]
    made = scene(fluid, solid, across, tolerance)
    if method == "film":
        drop = made["body"]["drop"]
        del drop["spacing"], drop["symmetry"]
        drop["method"] = method
    steps = equal_steps(made["stop_time"], STEPS)
    return unit_work(made, [HEAT, TEMPERATURE], steps, about="body.drop")


def read(answer: Answer) -> tuple[float, float]:
    """Heat at the end [J], and how warm the middle is over the second half [K]."""
    later = answer.values[TEMPERATURE][STEPS // 2 :]
    return answer.values[HEAT][-1], mean(later) - COLD


def off(which: int, answer: Answer, x: float, y: float) -> float:
    """One of what is read beside finer particles."""
    fluid, solid = list(LIQUIDS)[round(y)], list(SOLIDS)[round(x)]
    return abs(read(answer)[which] / FINER[fluid][list(SOLIDS).index(solid)][which] - 1.0)


def pairs(name: str, title: str, outcome: str, which: int, method: str = "sph") -> Map:
    return Map(
        name=name,
        title=title,
        x=Axis("substrate", "", list(range(len(SOLIDS))), False, list(SOLIDS)),
        y=Axis("liquid", "", list(range(len(LIQUIDS))), False, list(LIQUIDS)),
        outcome=f"{outcome}, relative difference to {FINE:g} particles across",
        unit="1",
        bad=BAD_OF_FILMS if method == "film" else BAD,
        work=partial(work, method=method),
        run=run_unit,
        judge=partial(off, which),
        colours=(0.0, 0.8 if method == "film" else 0.4),
    )


def heat_of_pairs() -> Map:
    title = f"Error of heat up to {STOP:g} D/U, {ACROSS:g} particles across"
    return pairs("coupling_pairs_heat", title, "heat", 0)


def temperature_of_pairs() -> Map:
    title = f"Rise under the middle from 1 to {STOP:g} D/U, {ACROSS:g} particles across"
    return pairs("coupling_pairs_temperature", title, "rise", 1)


def heat_of_films() -> Map:
    title = f"Error of heat up to {STOP:g} D/U, film of closed forms"
    return pairs("coupling_films_heat", title, "heat", 0, "film")


def temperature_of_films() -> Map:
    title = f"Rise under the middle from 1 to {STOP:g} D/U under a film of closed forms"
    return pairs("coupling_films_temperature", title, "rise", 1, "film")


FINER = {
    "mercury": [
        (1.8716e-06, 56.590),
        (1.2779e-05, 53.467),
        (2.1204e-05, 49.094),
        (3.6501e-05, 33.361),
        (3.8711e-05, 29.591),
        (4.7046e-05, 8.873),
    ],
    "tin": [
        (1.0088e-06, 56.667),
        (1.0420e-05, 54.440),
        (1.9123e-05, 51.244),
        (3.5196e-05, 38.617),
        (3.7530e-05, 35.243),
        (4.6503e-05, 12.631),
    ],
    "steel melt": [
        (6.8101e-07, 56.754),
        (8.5159e-06, 55.567),
        (1.8974e-05, 53.785),
        (5.5721e-05, 45.600),
        (6.4758e-05, 43.035),
        (1.1701e-04, 20.308),
    ],
    "water": [
        (7.0634e-07, 55.927),
        (6.9641e-06, 46.264),
        (1.2330e-05, 36.296),
        (2.0734e-05, 16.464),
        (2.1765e-05, 13.587),
        (2.5191e-05, 3.156),
    ],
    "wax": [
        (4.7236e-07, 53.165),
        (2.9162e-06, 29.201),
        (3.9141e-06, 17.160),
        (4.7844e-06, 5.321),
        (4.8605e-06, 4.210),
        (5.0843e-06, 0.872),
    ],
    "glycerol": [
        (2.0368e-07, 54.479),
        (1.5622e-06, 35.858),
        (2.3658e-06, 23.344),
        (3.2654e-06, 8.088),
        (3.3556e-06, 6.477),
        (3.6388e-06, 1.243),
    ],
}
"""Heat [J] and rise [K] with so many particles across, by `references` below."""


def references() -> None:
    """Prints what the numbers above come from."""
    for y, fluid in enumerate(LIQUIDS):
        for x in range(len(SOLIDS)):
            print(fluid, read(run_unit(work(x, y, FINE, 0.9))), flush=True)
