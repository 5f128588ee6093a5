"""Drops that are repeated: what is lost of heat and momentum beside drops of particles?

Heats of 28 and 40 particles across differ by 1.6 %: errors near that are the reference's own.
What is repeated is measured by the drop of particles as fine, a point of the same chart.
"""

from math import pi

from chart import Chart, Measured, Method, Point, Quantity, UnitRun
from problems.drops import droplet, on_plate
from problems.materials import ALUMINA, INK, thermoelastic

DIAMETER, SPEED, DENSITY = 1e-4, 20.0, INK["density"]  # m, m/s, kg/m³
TIME = DIAMETER / SPEED
STOP, STEPS = 4.0, 40
"""End over D/U, and communication steps."""
HEAT, OWN, IMPULSE = "heat given", "heat beside particles as fine", "momentum given"
BROUGHT = -pi / 6.0 * DENSITY * DIAMETER**3 * SPEED
"""Momentum of the drop, which the plate gets where no fluid rises [N s]."""
FINEST, ACROSS = 40, 20
PLATE = {
    "kind": "solid",
    "shape": {"box": [8e-4, 5e-4, 1e-4]},
    "material": thermoelastic(ALUMINA),
    "initial_temperature": 300.0,
    "mesh": {"spacing": 1e-5, "depth_spacing": 1e-6, "growth": 1.4, "order": 1},
}


def scene(method: str, **body) -> dict:
    """A drop of ink, Re 500 and We 800, of 350 K on a plate of alumina of 300 K."""
    drop = droplet(DIAMETER, SPEED, 350.0, INK, method=method)
    return {
        "name": "Drop",
        "stop_time": STOP * TIME,
        "step": STOP * TIME / STEPS,
        "solver": {"threads": 1},
        "body": {"drop": drop | body, "plate": PLATE},
        "coupling": [on_plate(1.6e-4)],
    }


def point(setting: str, heat: str, method: str, **body) -> Point:
    outputs = {heat: "drop.heat", IMPULSE: "drop.impulse_z"}
    return Point(setting, UnitRun(scene(method, **body), outputs, steps=STEPS))


def drops(method: str, across: list[int]) -> list[Point]:
    return [point(f"{d}", HEAT, method, spacing=DIAMETER / d) for d in across]


def cut_short(durations: list[float]) -> list[Point]:
    """Records of so many D/U."""
    points = []
    for d in durations:
        record = {"duration": round(d * TIME, 12)}
        body = {"spacing": DIAMETER / ACROSS, "record": record}
        points.append(point(f"{d:g} D/U", OWN, "record", **body))
    return points


def exchanged(intervals: list[float]) -> list[Point]:
    """Particles that meet the plate anew after so many D/U."""
    points = []
    for share in intervals:
        of = scene("sph", spacing=DIAMETER / ACROSS)
        of["coupling"][0]["interval"] = round(share * TIME, 12)
        points.append(Point(f"{share:g} D/U", UnitRun(of, {OWN: "drop.heat"}, steps=STEPS)))
    return points


def records() -> Chart:
    finest = f"{FINEST} particles across"
    of_finest = Measured(finest, f"{FINEST}", HEAT)
    as_fine = Measured("particles", f"{ACROSS}", HEAT)
    quantities = [
        Quantity(HEAT, "J", of_finest, None, finest, title="the transferred heat"),
        Quantity(
            OWN,
            "J",
            as_fine,
            None,
            f"{ACROSS} particles across",
            title=f"heat, against {ACROSS} particles across",
        ),
        Quantity(
            IMPULSE,
            "N s",
            BROUGHT,
            -BROUGHT,
            "ρπD³U/6, of a drop that comes to rest",
            title="the transferred momentum",
        ),
    ]
    methods = [
        Method(finest, drops("sph", [FINEST]), is_reference=True),
        Method("particles", drops("sph", [10, 14, 20, 28])),
        Method("record of 5 D/U", drops("record", [10, 14, 20, 28])),
        Method("film", [point("film", HEAT, "film")]),
        Method(f"record of D/Δx {ACROSS}, cut short", cut_short([1.0, 2.0, 3.0, 5.0])),
        Method(f"particles of D/Δx {ACROSS}, in other steps", exchanged([0.02])),
    ]
    settings = (
        "At the ends of curves: particles over the diameter D; or, over the time D/U of the impact,"
        " the duration of a record and the interval of exchanges."
    )
    title = "A recorded drop of ink on alumina, compared with particles"
    return Chart("records", title, quantities, methods, settings)
