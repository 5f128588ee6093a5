"""Drops that are repeated: what is lost of heat and momentum beside drops of particles?"""

from math import pi

from chart import Chart, Method, Point, Quantity, UnitRun

DIAMETER, SPEED, DENSITY = 1e-4, 20.0, 1000.0  # m, m/s, kg/m³
TIME = DIAMETER / SPEED
STOP, STEPS = 4.0, 40
"""End over D/U, and communication steps."""
HEAT, IMPULSE = "heat given", "momentum given"
OUTPUTS = {HEAT: "drop.heat", IMPULSE: "drop.impulse_z"}
BROUGHT = -pi / 6.0 * DENSITY * DIAMETER**3 * SPEED
"""Momentum of the drop, which the plate gets where no fluid rises [N s]."""
HEATS = {14: 1.8203653e-5, 20: 2.2355984e-5, 28: 2.3430958e-5, 40: 2.3064485e-5}
"""Of drops of particles, by how many of them lie across [J]."""
FINEST = max(HEATS)
PLATE = {
    "kind": "solid",
    "shape": {"box": [8e-4, 5e-4, 1e-4]},
    "material": {
        "model": "thermoelastic",
        "density": 3950.0,
        "specific_heat": 900.0,
        "conductivity": 10.0,
    },
    "initial_temperature": 300.0,
    "mesh": {"spacing": 1e-5, "depth_spacing": 1e-6, "growth": 1.4, "order": 1},
}


def scene(method: str, **body) -> dict:
    """A drop of ink, Re 500 and We 800, of 350 K on a plate of alumina of 300 K."""
    fluid = {
        "density": DENSITY,
        "viscosity": 4e-3,
        "specific_heat": 4180.0,
        "conductivity": 0.6,
        "surface_tension": 0.05,
    }
    drop = {
        "kind": "droplet",
        "method": method,
        "diameter": DIAMETER,
        "impact_velocity": SPEED,
        "initial_temperature": 350.0,
        "fluid": fluid,
    }
    coupling = {"from": "drop", "to": "plate.top", "traction": False, "radius": 1.6e-4}
    return {
        "name": "Drop",
        "stop_time": STOP * TIME,
        "step": STOP * TIME / STEPS,
        "solver": {"threads": 1},
        "body": {"drop": drop | body, "plate": PLATE},
        "coupling": [coupling],
    }


def point(setting: str, method: str, **body) -> Point:
    return Point(setting, UnitRun(scene(method, **body), OUTPUTS, steps=STEPS))


def drops(method: str, across: list[int]) -> list[Point]:
    return [point(f"{d}", method, spacing=DIAMETER / d) for d in across]


def beside_particles(across: int, durations: list[float]) -> Method:
    """Records of so many D/U, beside the drop of particles that is as fine."""
    points = [
        point(
            f"{d:g} D/U",
            "record",
            spacing=DIAMETER / across,
            record={"duration": round(d * TIME, 12)},
        )
        for d in durations
    ]
    name = f"record of D/{across} beside its particles"
    return Method(name, points, references={HEAT: HEATS[across]})


def records() -> Chart:
    quantities = [
        Quantity(HEAT, "J", HEATS[FINEST], HEATS[FINEST], f"{FINEST} particles across"),
        Quantity(IMPULSE, "N s", BROUGHT, -BROUGHT, "ρπD³U/6, of a drop that comes to rest"),
    ]
    methods = [
        Method("particles", drops("sph", [10, 14, 20, 28])),
        Method("record", drops("record", [10, 14, 20, 28])),
        Method("film", [point("film", "film")]),
        beside_particles(14, [1.0, 2.0, 3.0, 5.0]),
        beside_particles(20, [1.0, 2.0, 3.0, 5.0]),
    ]
    return Chart("records", "A drop of ink on alumina, repeated", quantities, methods)
