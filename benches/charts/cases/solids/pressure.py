"""A pressed disc on a block: how stressed is what lies on its axis?"""

from chart import Chart, Method, Point, ProgramRun, Quantity, UnitRun

RADIUS, DEPTH, PRESSURE, POISSON, YOUNG = 50e-6, 40e-6, 25e6, 0.3, 300e9
FAR = 100.0 * RADIUS
"""The block's radius and depth: what a half space has beyond is worth 1e-4 of the pressure."""
AXIAL, SIDE = "axial stress", "side stress"
OUTPUTS = {AXIAL: "below.stress_zz", SIDE: "below.stress_xx"}
STOP = 1e-6
MATERIAL = {
    "model": "thermoelastic",
    "density": 3950.0,
    "specific_heat": 900.0,
    "conductivity": 10.0,
    "young": YOUNG,
    "poisson": POISSON,
    "expansion": 8.1e-6,
}


def love() -> dict[str, float]:
    """Stress on the axis of a half space [Pa].

    `σ_zz = −p (1 − c³)`, `σ_rr = −p/2 [1 + 2ν − 2(1 + ν) c + c³]`, `c = z/√(R² + z²)`: Love
    (1929), Phil. Trans. R. Soc. A 228, 377–420, doi 10.1098/rsta.1929.0009."""
    c = DEPTH / (DEPTH**2 + RADIUS**2) ** 0.5
    side = 1.0 + 2.0 * POISSON - 2.0 * (1.0 + POISSON) * c + c**3
    return {AXIAL: -PRESSURE * (1.0 - c**3), SIDE: -0.5 * PRESSURE * side}


def scene(**more) -> dict:
    plate = {
        "kind": "solid",
        "shape": {"disc": {"radius": FAR, "thickness": FAR}},
        "material": MATERIAL,
        "initial_temperature": 293.15,
        "faces": {"bottom": {"roller": True}, "sides": {"roller": True}},
    }
    plate |= more.pop("body", {})
    press = {
        "name": "press",
        "on": "plate.top",
        "footprint": {"disc": {"radius": RADIUS}},
        "carries": ["pressure"],
        "start": {"pressure": PRESSURE},
    }
    probe = {"name": "below", "in": "plate", "at": [0.0, 0.0, -DEPTH], "gives": ["stress"]}
    general = {"name": "Press", "stop_time": STOP, "step": STOP}
    return general | {"body": {"plate": plate}, "load": [press], "probe": [probe]} | more


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
    return Chart("pressure", "A pressed disc on a deep block", quantities, methods)
