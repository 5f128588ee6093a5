"""Every kind of unit in communication steps of any length, with inputs that jump in each of them:
does heat balance, and are all values finite?
"""

from math import isfinite, nan

from plan import Answer, Axis, Map, Work
from problems.drops import droplet, wall
from problems.materials import ALUMINA, ELASTIC_ALUMINA, liquid, thermoelastic
from problems.plates import CENTRE
from unit_run import run_unit, unit_work

STEPS = [1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 1e-3, 1.0, 1e3]
COUNT = 12
MATERIAL = thermoelastic(ALUMINA, ELASTIC_ALUMINA)
PLATE = {
    "kind": "solid",
    "shape": {"disc": {"radius": 1e-3, "thickness": 0.3e-3}},
    "material": MATERIAL,
    "initial_temperature": 300.0,
    "faces": {"bottom": {"convection": {"coefficient": 1e3, "ambient": 300.0}, "clamped": True}},
}
SPOT = {
    "name": "spot",
    "on": "plate.top",
    "footprint": {"disc": {"radius": 2e-4}},
    "carries": ["heat_flux"],
}
COARSE = {"mesh": {"spacing": 5e-5, "depth_spacing": 5e-5, "growth": 1.2}}
DROP = droplet(1e-4, 5.0, 350.0, liquid(1000.0, 1e-3), spacing=1e-5, symmetry="axisymmetric")
WALL = wall(1, 3e-4, 300.0)
CHUCK = {"kind": "reservoir", "heat_capacity": 1e-3, "initial_temperature": 300.0}
LOSS = {"conductance": 1e-2, "ambient": 300.0}


def heated(**more) -> dict:
    return {"body": {"plate": PLATE | more}, "load": [SPOT], "probe": [CENTRE]}


MELTING = {"melting": {"solidus": 320.0, "liquidus": 325.0, "latent_heat": 1e5}}
STACK = {"from": "chuck.top", "to": "plate.bottom", "conductance": 1e4}
KINDS = {
    "reservoir": {"body": {"chuck": CHUCK | LOSS}},
    "finite elements": heated(**COARSE),
    "particles of heat": heated(
        heat="sph",
        shape={"box": [1.2e-3, 1.2e-3, 0.3e-3]},
        mesh={"spacing": 1e-4, "depth_spacing": 1e-4, "growth": 1.0},
        faces={},
    ),
    "reduced": heated(**COARSE) | {"fidelity": {"level": "reduced"}},
    "melting": heated(material=MATERIAL | MELTING, **COARSE),
    "on a reservoir": {
        "body": {"chuck": CHUCK | LOSS, "plate": PLATE | COARSE | {"faces": {}}},
        "coupling": [STACK],
        "load": [SPOT],
    },
    "drop on a wall": {"body": {"drop": DROP}, "wall": [WALL]},
    "drop on a plate": {
        "body": {"drop": DROP, "plate": PLATE | COARSE},
        "coupling": [{"from": "drop", "to": "plate.top", "traction": False}],
    },
}
NAMES = list(KINDS)
LONGEST = 1e-5  # s, of drops: `impinge check` foretells hours for longer ones
PRESENT = {"reservoir": "chuck", "drop on a wall": "drop"}


def work(length: float, kind: float) -> Work:
    """Heat that is switched on and off, or an ambient or wall that jumps, in every step."""
    name = NAMES[int(kind)]
    scene = {"name": "Lengths", "stop_time": COUNT * length, "step": length} | KINDS[name]
    scene["fidelity"] = {"tolerance": 0.9} | scene.get("fidelity", {})
    body = PRESENT.get(name, "plate")
    flips = [n % 2 for n in range(COUNT)]
    if name == "drop on a wall":
        inputs = {"wall.temperature[1]": [300.0 + 20.0 * flip for flip in flips]}
        outputs = ["drop.heat", "drop.heat_stored", "drop.min_temperature", "drop.max_temperature"]
    else:
        outputs = [f"{body}.{key}" for key in ("heat_in", "heat_stored", "heat_lost")]
        inputs = {}
    if name == "reservoir":
        inputs = {"chuck.heating": [float(flip) for flip in flips]}
        outputs.append("chuck.temperature")
    elif "load" in scene:
        inputs = {"spot.heat_flux": [1e6 * flip for flip in flips]}
    if "probe" in scene:
        outputs.append("centre.temperature")
    return unit_work(scene, outputs, [length] * COUNT, inputs)


def run(of: Work) -> Answer:
    """Drops do not take steps of hours here."""
    if "drop" in of["scene"]["body"] and of["steps"][0] > LONGEST:
        return Answer({})
    return run_unit(of)


def imbalance(answer: Answer, length: float, kind: float) -> float:
    """Heat that is neither stored nor lost, over the largest of what there is; one where a value
    is not finite."""
    values = answer.values
    if not values:
        return nan
    if not all(isfinite(value) for row in values.values() for value in row):
        return 1.0
    if "drop.heat" in values:
        rows = zip(values["drop.heat"], values["drop.heat_stored"], strict=True)
        parts = [(0.0, stored, given) for given, stored in rows]
    else:
        parts = list(zip(*list(values.values())[:3], strict=True))
    largest = max(abs(part) for row in parts for part in row)
    return max(abs(a - b - c) for a, b, c in parts) / largest if largest else 0.0


def lengths() -> Map:
    return Map(
        name="coupling_lengths",
        title="Steps of any length under inputs that jump",
        x=Axis("communication step", "s", STEPS),
        y=Axis("kind of unit", "–", list(range(len(NAMES))), False, NAMES),
        outcome="heat that is missing, relative",
        unit="1",
        bad=1e-6,
        work=work,
        run=run,
        judge=imbalance,
        colours=(1e-16, 1e-6),
    )
