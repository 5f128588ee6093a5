"""Hot alumina set down on cold copper: how warm is its lower face, how much heat has passed?

Both are so deep that heat comes to the end of neither.
"""

import math

from chart import Chart, Method, Point, ProgramRun, Quantity, UnitRun
from problems.half_spaces import face_at_contact, heat_through_contact
from problems.materials import ALUMINA, COPPER, effusivity, thermoelastic
from problems.plates import probe

HOT, COLD, CONDUCTANCE, STOP, WIDE = 500.0, 300.0, 1e5, 1e-2, 0.5e-3
DEEP = 5.0
"""Depth of a body over √(at): what comes back from its end is 1e-12 of the whole."""
FACE, HEAT = "temperature of the hot face", "heat passed"
OUTPUTS = {FACE: "face.temperature", HEAT: "bed.heat_in"}
INTERVAL = STOP / 100


def depth(material: dict) -> float:
    """√(at) [m]"""
    return material["conductivity"] / effusivity(material) * math.sqrt(STOP)


def closed_form() -> dict[str, float]:
    face = face_at_contact(CONDUCTANCE, HOT, COLD, STOP, ALUMINA, COPPER)
    passed = heat_through_contact(CONDUCTANCE, HOT - COLD, STOP, ALUMINA, COPPER)
    return {FACE: face, HEAT: passed * math.pi * WIDE**2}


def body(material: dict, temperature: float, mesh: dict | None) -> dict:
    told = {
        "kind": "solid",
        "shape": {"disc": {"radius": WIDE, "thickness": DEEP * depth(material)}},
        "material": thermoelastic(material),
        "initial_temperature": temperature,
    }
    return told | ({"mesh": mesh} if mesh else {})


def scene(meshes: tuple = (None, None), interval: float = INTERVAL, **more) -> dict:
    at = [0.0, 0.0, -DEEP * depth(ALUMINA)]
    bodies = {"bed": body(COPPER, COLD, meshes[0]), "plate": body(ALUMINA, HOT, meshes[1])}
    contact = {"from": "bed.top", "to": "plate.bottom"}
    contact |= {"conductance": CONDUCTANCE, "interval": interval}
    general = {"name": "SetDown", "stop_time": STOP, "step": STOP / 10}
    face = probe("face", at, "temperature")
    return general | {"body": bodies, "coupling": [contact], "probe": [face]} | more


def equal(parts: float, order: int) -> tuple:
    """Nodes at equal distances, so many to √(at) of each body."""
    return tuple(
        {"spacing": WIDE / 2, "depth_spacing": depth(material) / parts, "growth": 1.0}
        | {"order": order}
        for material in (COPPER, ALUMINA)
    )


def run(*arguments, steps: int = 10, **more) -> UnitRun:
    return UnitRun(scene(*arguments, **more), OUTPUTS, steps=steps)


def peer() -> list[Point]:
    """scikit-fem: nodes to √(at), steps."""
    case = {"conductance": CONDUCTANCE, "stop": STOP, "area": math.pi * WIDE**2, "deep": DEEP}
    case |= {"bodies": [COPPER | {"initial": COLD}, ALUMINA | {"initial": HOT}]}
    points = []
    for parts, steps in ((4, 20), (8, 80), (16, 320), (32, 1280)):
        work = ProgramRun("contact_scikit.py", case | {"parts": parts, "steps": steps})
        points.append(Point(f"√(at)/{parts}, {steps} steps", work))
    return points


def contact() -> Chart:
    wanted = closed_form()
    source = "closed form of half spaces, Carslaw & Jaeger 1959, § 2.7"
    quantities = [
        Quantity(FACE, "K", wanted[FACE], HOT - wanted[FACE], source),
        Quantity(HEAT, "J", wanted[HEAT], wanted[HEAT], source),
    ]
    tolerances = (1e-1, 3e-2, 1e-2, 3e-3, 1e-3)
    asked = [Point(f"{t:g}", run(fidelity={"tolerance": t}), t) for t in tolerances]
    methods = [Method("by tolerance, 100 exchanges", asked)]
    for order, name in (
        (1, "linear elements, 100 exchanges"),
        (2, "quadratic elements, 100 exchanges"),
    ):
        points = [Point(f"√(at)/{parts}", run(equal(parts, order))) for parts in (2, 4, 8, 16, 32)]
        methods.append(Method(name, points))
    points = [
        Point(f"{count}", run(equal(32, 2), STOP / count, steps=min(count, 10)))
        for count in (1, 3, 10, 30, 100, 300, 1000)
    ]
    methods.append(Method("quadratic elements of √(at)/32, by exchanges", points))
    methods.append(Method("scikit-fem, PARDISO", peer()))
    settings = (
        "At the ends of curves: tolerance; distance of nodes over the depth √(at) of the heat;"
        " or number of exchanges."
    )
    title = "Hot alumina set down on cold copper"
    return Chart("contact", title, quantities, methods, settings)
