"""A plate of steel that is held flat, heated by a pulse and left alone: what stress stays?

Each depth goes a bilinear way by itself, so the closed forms of temperature and of a film are all.
"""

import math

from chart import Chart, Method, Point, ProgramRun, Quantity
from problems import plates
from problems.half_spaces import ierfc
from problems.materials import STEEL, diffusivity
from problems.plates import probe

YOUNG, POISSON, EXPANSION, YIELD, HARDENING = 210e9, 0.3, 12e-6, 250e6, 2e9
MATERIAL = {
    "model": "elastoplastic",
    "young": YOUNG,
    "poisson": POISSON,
    "expansion": EXPANSION,
    "yield_stress": YIELD,
    "isotropic_hardening": HARDENING,
}
FLUX, STOP, THICKNESS, WIDE, DEPTH = 1.5e7, 40e-3, 1e-3, 0.5e-3, 0.25e-3
"""The flux is there for half the time."""
FACE, INSIDE = "stress left at the face", "stress left in a quarter of the depth"
OUTPUTS = {FACE: "face.stress_xx", INSIDE: "inside.stress_xx"}
STEPS, PARTS = 32, 64
"""Steps where meshes are swept, parts of the thickness where steps are."""


def rise(depth: float, time: float) -> float:
    """Above the start [K], under a flux that begins at 0 (Carslaw & Jaeger 1959, § 3.8).

    `2q√(at)/k Σ ierfc(x/(2√(at)))` over the images of the face in the insulated back."""
    if time <= 0.0:
        return 0.0
    reach = 2.0 * math.sqrt(diffusivity(STEEL) * time)
    mirrored = 2.0 * THICKNESS - depth
    places = [2.0 * n * THICKNESS + side for n in range(5) for side in (depth, mirrored)]
    total = sum(ierfc(place / reach) for place in places)
    return FLUX * reach / STEEL["conductivity"] * total


def pulsed(depth: float, time: float) -> float:
    return rise(depth, time) - rise(depth, time - STOP / 2)


def warmest(depth: float) -> float:
    """Highest rise of a depth [K], which comes after the pulse; by golden section."""
    low, high = STOP / 2, STOP
    ratio = (math.sqrt(5.0) - 1.0) / 2.0
    for _ in range(80):
        left, right = high - ratio * (high - low), low + ratio * (high - low)
        if pulsed(depth, left) > pulsed(depth, right):
            high = right
        else:
            low = left
    return pulsed(depth, low)


def left_over(depth: float) -> float:
    """Stress of a film [Pa] that goes to the warmest rise and to the last, both directions alike.

    `E/(1 − ν)` within the yield surface, `M H/(M + H)` with twice the hardening beyond it (Hill
    1950, § II)."""
    modulus, hardening = YOUNG / (1.0 - POISSON), 2.0 * HARDENING
    radius, stress, strain = YIELD, 0.0, 0.0
    for goal in (-EXPANSION * warmest(depth), -EXPANSION * pulsed(depth, STOP)):
        sign = math.copysign(1.0, goal - strain)
        beyond = max((goal - strain) * sign - (radius - sign * stress) / modulus, 0.0)
        plastic = beyond * modulus / (modulus + hardening)
        stress += modulus * (goal - strain - sign * plastic)
        radius, strain = radius + hardening * plastic, goal
    return stress


def scene(steps: int, mesh: dict | None, **more) -> dict:
    plate = {
        "shape": {"disc": {"radius": WIDE, "thickness": THICKNESS}},
        "material": MATERIAL | STEEL,
        "faces": {"top": {"flux": FLUX}} | {s: {"roller": True} for s in ("bottom", "sides")},
    }
    plate |= {"mesh": mesh} if mesh else {}
    probes = [
        probe(name, [0.0, 0.0, -depth], "stress")
        for name, depth in (("face", 0.0), ("inside", DEPTH))
    ]
    return plates.scene(plate, STOP, STOP / steps, "Pulse", probe=probes) | more


def run(steps: int, mesh: dict | None, **more) -> ProgramRun:
    told = {"scene": scene(steps, mesh, **more), "steps": steps, "outputs": OUTPUTS}
    return ProgramRun(
        "scheduled_unit.py", told | {"schedule": [[steps // 2, {"plate.top.flux": 0.0}]]}
    )


def equal(parts: int, order: int) -> dict:
    """Nodes at equal distances, so many in the thickness."""
    size = THICKNESS / parts
    return {"spacing": WIDE / 2, "depth_spacing": size, "growth": 1.0, "order": order}


def yielding() -> Chart:
    source = "closed forms, Carslaw & Jaeger 1959, § 3.8, and Hill 1950, § II"
    quantities = [
        Quantity(name, "Pa", left_over(depth), YIELD, source, title=f"residual stress {place}")
        for name, depth, place in (
            (FACE, 0.0, "at the face"),
            (INSIDE, DEPTH, "at a quarter of the depth"),
        )
    ]
    tolerances = (1e-1, 3e-2, 1e-2)
    methods = [
        Method(
            f"by tolerance, {STEPS} steps",
            [Point(f"{t:g}", run(STEPS, None, fidelity={"tolerance": t}), t) for t in tolerances],
        )
    ]
    for order, name in ((1, "linear"), (2, "quadratic")):
        points = [Point(f"1/{n}", run(STEPS, equal(n, order))) for n in (8, 16, 32, 64, 128)]
        methods.append(Method(f"{name} elements, {STEPS} steps", points))
    points = [Point(f"{n}", run(n, equal(PARTS, 2))) for n in (2, 4, 8, 16, 64, 128)]
    methods.append(Method(f"quadratic elements of 1/{PARTS}, by steps", points))
    settings = (
        "At the ends of curves: tolerance; elements over the thickness; or, of the curve by steps,"
        " their number."
    )
    title = "Steel that yields under a pulse of heat"
    return Chart("yielding", title, quantities, methods, settings)
