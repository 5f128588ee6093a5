"""Elements that hardly change their volume, and thin plates of few elements."""

from plan import Answer, Axis, Map, Work
from problems.half_spaces import pressed_disc_stress
from problems.materials import ALUMINA, ELASTIC_ALUMINA, thermoelastic
from problems.plates import load, probe, scene
from unit_run import equal_steps, run_unit, unit_work

RADIUS, PRESSURE, STOP = 50e-6, 25e6, 1e-6  # m, Pa, s
WIDE = 12.0 * RADIUS
DEPTH = 0.8 * RADIUS
COMPRESSIBILITIES = [0.58, 0.1, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12]


def poisson(compressibility: float) -> float:
    """ν of 1 − 2ν."""
    return 0.5 * (1.0 - compressibility)


def pressed(order: int):
    """A disc of pressure on a block twelve radii deep, stress read on its axis."""

    def work(compressibility: float, nodes: float) -> Work:
        soft = {"poisson": poisson(compressibility)}
        body = {
            "shape": {"disc": {"radius": WIDE, "thickness": WIDE}},
            "material": thermoelastic(ALUMINA, ELASTIC_ALUMINA, soft),
            "mesh": {"spacing": RADIUS / nodes, "growth": 1.3, "order": order},
            "faces": {"bottom": {"roller": True}, "sides": {"roller": True}},
        }
        told = scene(
            body,
            STOP,
            STOP,
            load=[load({"disc": {"radius": RADIUS}}, "pressure", PRESSURE)],
            probe=[probe("below", [0.0, 0.0, -DEPTH], "stress")],
        )
        outputs = ["below.stress_zz", "below.stress_xx"]
        return unit_work(told, outputs, equal_steps(STOP, 1))

    return work


def of_pressure(answer: Answer, compressibility: float, _: float) -> float:
    wanted = pressed_disc_stress(PRESSURE, RADIUS, DEPTH, poisson(compressibility))
    found = (answer.values[f"below.stress_{way}"][-1] for way in ("zz", "xx"))
    return max(abs(a - b) for a, b in zip(found, wanted, strict=True)) / PRESSURE


def incompressible(order: int, name: str, words: str) -> Map:
    return Map(
        name=name,
        title=f"A pressed disc, nearly incompressible: {words}",
        x=Axis("compressibility 1 − 2ν", "1", COMPRESSIBILITIES[::-1]),
        y=Axis("nodes over the disc's radius", "1", [1.0, 2.0, 3.0, 4.0, 6.0, 10.0]),
        outcome="error of stress on the axis, over the pressure",
        unit="1",
        bad=0.05,
        work=pressed(order),
        run=run_unit,
        judge=of_pressure,
        colours=(3e-3, 1.0),
    )


def incompressible_linear() -> Map:
    return incompressible(1, "incompressible_linear", "linear elements")


def incompressible_quadratic() -> Map:
    return incompressible(2, "incompressible_quadratic", "quadratic elements")


SPAN, POISSON, BENDING = 1e-3, 0.3, 1e3  # m, 1, Pa


def plate(order: int):
    """A clamped round plate under pressure all over, deflection read in the middle."""

    def work(slenderness: float, elements: float) -> Work:
        thickness = SPAN / slenderness
        body = {
            "shape": {"disc": {"radius": SPAN, "thickness": thickness}},
            "material": thermoelastic(ALUMINA, ELASTIC_ALUMINA, {"poisson": POISSON}),
            "mesh": {
                "spacing": SPAN / (elements * order),
                "depth_spacing": thickness / (2.0 * order),
                "growth": 1.0,
                "order": order,
            },
            "faces": {"sides": {"clamped": True}},
        }
        told = scene(
            body,
            STOP,
            STOP,
            load=[load({"disc": {"radius": SPAN}}, "pressure", BENDING / slenderness**3)],
            probe=[probe("middle", [0.0, 0.0, -0.5 * thickness], "displacement")],
        )
        return unit_work(told, ["middle.displacement_z"], equal_steps(STOP, 1))

    return work


def of_plate(answer: Answer, slenderness: float, _: float) -> float:
    """Against `w = p R⁴/64D + p R²/(4κGh)`: Mindlin (1951), doi 10.1115/1.4010217."""
    thickness, pressure = SPAN / slenderness, BENDING / slenderness**3
    young = ELASTIC_ALUMINA["young"]
    rigidity = young * thickness**3 / (12.0 * (1.0 - POISSON**2))
    shear = young / (2.0 * (1.0 + POISSON))
    wanted = pressure * SPAN**4 / (64.0 * rigidity)
    wanted += pressure * SPAN**2 / (4.0 * 5.0 / 6.0 * shear * thickness)
    return abs(-answer.values["middle.displacement_z"][-1] / wanted - 1.0)


def bending(order: int, name: str, words: str) -> Map:
    return Map(
        name=name,
        title=f"A clamped plate under pressure: {words}",
        x=Axis("radius over thickness", "1", [10.0, 30.0, 100.0, 1e3, 1e4, 1e6]),
        y=Axis("elements over the radius", "1", [2.0, 4.0, 8.0, 20.0]),
        outcome="error of the deflection",
        unit="1",
        bad=0.05,
        work=plate(order),
        run=run_unit,
        judge=of_plate,
        colours=(1e-3, 1.0),
    )


def thin_linear() -> Map:
    return bending(1, "thin_linear", "linear elements")


def thin_quadratic() -> Map:
    return bending(2, "thin_quadratic", "quadratic elements")
