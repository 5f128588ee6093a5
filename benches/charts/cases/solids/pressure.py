"""A pressed disc on a block: how stressed is what lies on its axis?"""

from chart import Chart, Method, Point, ProgramRun, Quantity, UnitRun
from problems import plates
from problems.half_spaces import pressed_disc_stress
from problems.materials import ALUMINA, ELASTIC_ALUMINA, thermoelastic
from problems.plates import disc, load, probe

RADIUS, DEPTH, PRESSURE, POISSON = 50e-6, 40e-6, 25e6, 0.3
YOUNG = ELASTIC_ALUMINA["young"]
FAR = 100.0 * RADIUS
"""The block's radius and depth: what a half space has beyond is worth 1e-4 of the pressure."""
AXIAL, SIDE = "axial stress", "side stress"
OUTPUTS = {AXIAL: "below.stress_zz", SIDE: "below.stress_xx"}
STOP = 1e-6
MATERIAL = thermoelastic(ALUMINA, ELASTIC_ALUMINA, {"poisson": POISSON})


def love() -> dict[str, float]:
    """Stress on the axis of a half space [Pa]."""
    axial, side = pressed_disc_stress(PRESSURE, RADIUS, DEPTH, POISSON)
    return {AXIAL: axial, SIDE: side}


def scene(**more) -> dict:
    plate = {
        "shape": {"disc": {"radius": FAR, "thickness": FAR}},
        "material": MATERIAL,
        "faces": {"bottom": {"roller": True}, "sides": {"roller": True}},
    }
    plate |= more.pop("body", {})
    press = load(disc(RADIUS), "pressure", PRESSURE, "press")
    below = probe("below", [0.0, 0.0, -DEPTH], "stress")
    return plates.scene(plate, STOP, STOP, "Press", load=[press], probe=[below]) | more


def asked() -> list[Point]:
    def work(tolerance: float) -> UnitRun:
        return UnitRun(scene(fidelity={"tolerance": tolerance}), OUTPUTS)

    return [Point(f"{t:g}", work(t), t) for t in (1e-1, 3e-2, 1e-2, 3e-3, 1e-3)]


def spaced(order: int) -> list[Point]:
    """A point for each distance of nodes at the load."""

    def work(nodes: float) -> UnitRun:
        mesh = {"spacing": RADIUS / nodes, "growth": 1.0 + 1.2 / nodes, "order": order}
        return UnitRun(scene(body={"mesh": mesh}), OUTPUTS)

    return [Point(f"R/{nodes:g}", work(nodes)) for nodes in (3.0, 6.0, 12.0, 24.0)]


def peer() -> list[Point]:
    case = {"spot": RADIUS, "half": FAR, "thickness": FAR, "young": YOUNG, "poisson": POISSON}
    case |= {"pressure": PRESSURE, "below": DEPTH}

    def work(elements: float) -> ProgramRun:
        size = RADIUS / elements
        mesh = {"radial": size, "depth": size, "growth": 1.0 + 0.6 / elements}
        return ProgramRun("pressure_scikit.py", case | mesh)

    return [Point(f"R/{2 * elements:g}", work(elements)) for elements in (1.5, 3.0, 6.0, 12.0)]


def ngsolve(order: int) -> list[Point]:
    """Elements over the radius, where these are smallest: at the edge of the disc."""
    case = {"spot": RADIUS, "half": FAR, "thickness": FAR, "young": YOUNG, "poisson": POISSON}
    case |= {"pressure": PRESSURE, "below": DEPTH, "order": order}

    def work(elements: float) -> ProgramRun:
        size = RADIUS / elements
        mesh = {"radial": size, "depth": size, "growth": 1.0 + 0.6 * order / elements**0.8}
        return ProgramRun("pressure_ngsolve.py", case | mesh, environment=".venv-peers")

    return [Point(f"R/{elements:g}", work(elements)) for elements in (4.0, 8.0, 16.0)]


def pressure() -> Chart:
    wanted = love()
    source = "closed form, Love 1929"
    quantities = [Quantity(name, "Pa", wanted[name], PRESSURE, source) for name in wanted]
    methods = [
        Method("by tolerance", asked()),
        Method("quadratic elements", spaced(2)),
        Method("linear elements", spaced(1)),
        Method("scikit-fem, PARDISO", peer()),
        Method("NGSolve, order 2", ngsolve(2)),
        Method("NGSolve, order 4", ngsolve(4)),
    ]
    points = (
        "At the ends of curves: tolerance; or distance of nodes (of NGSolve, the smallest elements)"
        " over the disc's radius R."
    )
    return Chart("pressure", "A pressed disc on a deep block", quantities, methods, points)
