"""A hot drop hits a plate: how warm does it get, how much heat has it got, how stressed is it?

The same impact to every level of model: closed form of a film, recorded drop, particles in the
meridian plane and in a quarter of the drop.
"""

from chart import Chart, Method, Point, Quantity, UnitRun

DIAMETER, SPEED, STOP, STEPS = 0.1e-3, 50.0, 3.5e-6, 7
START, HOT = 293.15, 373.15  # K
TEMPERATURE = "highest temperature of the plate"
HEAT = "heat given"
STRESS = "von Mises stress 3 µm below"
OUTPUTS = {TEMPERATURE: "plate.max_temperature", HEAT: "plate.heat_in", STRESS: "below.von_mises"}
ALUMINA = {
    "model": "thermoelastic",
    "density": 3950.0,
    "specific_heat": 900.0,
    "conductivity": 10.0,
    "young": 300e9,
    "poisson": 0.21,
    "expansion": 8.1e-6,
}
WATER = {
    "density": 1000.0,
    "viscosity": 3e-4,
    "specific_heat": 4000.0,
    "conductivity": 0.6,
    "surface_tension": 0.059,
    "sound_speed": 500.0,
}


def scene(drop: dict) -> dict:
    """The drop above a disc of alumina that is clamped round its edge."""
    plate = {
        "kind": "solid",
        "shape": {"disc": {"radius": 1e-3, "thickness": 0.26e-3}},
        "material": ALUMINA,
        "initial_temperature": START,
        "mesh": {"spacing": 2.5e-6, "depth_spacing": 0.3e-6, "growth": 1.4},
        "faces": {"sides": {"clamped": True}},
    }
    falling = {
        "kind": "droplet",
        "diameter": DIAMETER,
        "impact_velocity": SPEED,
        "initial_temperature": HOT,
        "fluid": WATER,
    }
    probes = [
        {"name": "below", "in": "plate", "at": [0.0, 0.0, -3e-6], "gives": ["von_mises"]},
    ]
    return {
        "name": "Drop",
        "stop_time": STOP,
        "step": 5e-8,
        "body": {"drop": falling | drop, "plate": plate},
        "coupling": [{"from": "drop", "to": "plate.top", "radius": 150e-6}],
        "probe": probes,
    }


def point(setting: str, **drop) -> Point:
    return Point(setting, UnitRun(scene(drop), OUTPUTS, steps=STEPS))


def resolved(counts: tuple[int, ...], **drop) -> list[Point]:
    """A point for each number of particles over the diameter."""
    return [point(f"D/{count}", spacing=DIAMETER / count, **drop) for count in counts]


def drop() -> Chart:
    quantities = [
        Quantity(TEMPERATURE, "K", HIGHEST, HIGHEST - START, FINEST),
        Quantity(HEAT, "J", GIVEN, GIVEN, FINEST),
        Quantity(STRESS, "Pa", BORNE, BORNE, FINEST),
    ]
    methods = [
        Method("film", [point("", method="film")]),
        Method("recorded drop", resolved((14, 20, 28), method="record")),
        Method(
            "particles in the meridian plane", resolved((20, 40, 80, 160), symmetry="axisymmetric")
        ),
        Method("particles in a quarter", resolved((14, 20, 28, 40), symmetry="quarter")),
    ]
    return Chart("drop", "A hot drop on alumina at 50 m/s, 3.5 µs", quantities, methods)


FINEST = "meridian plane, 320 particles over the diameter"
HIGHEST, GIVEN, BORNE = 1.0, 1.0, 1.0
