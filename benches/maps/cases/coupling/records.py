"""Two drops of ink on alumina, repeated from a record of one, beside both computed of particles:
how far apart, in place and in time, do they have to be?
"""

from plan import Answer, Axis, Map, Work
from problems.drops import droplet, on_plate
from problems.materials import ALUMINA, INK, thermoelastic
from unit_run import equal_steps, run_unit, unit_work

DIAMETER, SPEED, ACROSS = 1e-4, 20.0, 8
TIME = DIAMETER / SPEED
HOT, COLD = 350.0, 300.0
STEPS = 10
DISTANCES = [0.0, 1.1, 1.5, 2.2, 3.0]
DELAYS = [0.0, 2.0, 4.0]


def work(distance: float, delay: float) -> Work:
    """Drops start clear of the film of those before, and 4 D/U after the second has been let go."""
    half = 0.5 * distance * DIAMETER
    stop = (delay + 5.5) * TIME
    drop = droplet(
        DIAMETER,
        SPEED,
        HOT,
        INK,
        spacing=DIAMETER / ACROSS,
        height=1.5 * DIAMETER,
        symmetry="none",
        arrivals=[{"time": 0.0, "x": -half}, {"time": delay * TIME, "x": half}],
    )
    plate = {
        "kind": "solid",
        "shape": {"box": [9e-4, 5e-4, 1e-4]},
        "material": thermoelastic(ALUMINA),
        "initial_temperature": COLD,
        "mesh": {"spacing": 2e-5, "depth_spacing": 2e-6, "growth": 1.5, "order": 1},
    }
    scene = {
        "name": "Drops",
        "stop_time": stop,
        "step": stop / STEPS,
        "solver": {"threads": 1},
        "fidelity": {"tolerance": 0.3},
        "body": {"drop": drop, "plate": plate},
        "coupling": [on_plate(1.6e-4)],
    }
    return {"scene": scene, "stop": stop}


def run(of: Work) -> Answer:
    """Heat of both over time; what the record's unit says."""
    heat = {}
    for method in ("sph", "record"):
        body = of["scene"]["body"]
        drop = body["drop"] | {"method": method}
        scene = of["scene"] | {"body": body | {"drop": drop}}
        answer = run_unit(unit_work(scene, ["drop.heat"], equal_steps(of["stop"], STEPS)))
        if answer.refused:
            return answer
        heat[method] = answer.values["drop.heat"]
    return Answer(heat, answer.warned)


def error(answer: Answer, distance: float, delay: float) -> float:
    wanted, found = answer.values["sph"], answer.values["record"]
    return max(abs(a - b) for a, b in zip(found, wanted, strict=True)) / wanted[-1]


def records() -> Map:
    return Map(
        name="coupling_records",
        title="Two recorded drops beside two of particles",
        x=Axis("distance over D", "1", DISTANCES, False),
        y=Axis("delay over D/U", "1", DELAYS, False),
        outcome="error of the heat given",
        unit="1",
        bad=0.1,
        work=work,
        run=run,
        judge=error,
        colours=(0.01, 0.3),
    )
