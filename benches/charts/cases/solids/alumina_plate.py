"""The plate of `examples/alumina_plate` under the heat and pressure that its `run.py` plays."""

import sys
import tomllib
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

from chart import Chart, Measured, Method, Point, ProgramRun, Quantity
from problems.half_spaces import disc_flux_rise
from problems.materials import thermal

FOLDER = Path(__file__).resolve().parents[4] / "examples/alumina_plate"


def example():
    """The module `run.py`."""
    spec = spec_from_file_location("alumina_plate_run", FOLDER / "run.py")
    module = module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


IMPACT = example()
SCENE = tomllib.loads((FOLDER / "scene.toml").read_text())
ENDS = [IMPACT.STOP * (n / IMPACT.STEPS) ** 3 for n in range(1, IMPACT.STEPS + 1)]
"""Of steps [s]."""
LOADS = [
    (end, IMPACT.mean_flux(begin, end), IMPACT.pressure(end))
    for begin, end in zip([0.0, *ENDS], ENDS, strict=False)
]
BLOW, LAST = 10, IMPACT.STEPS
"""Steps after which is read: under half of the first blow, and at the end."""
DEEP = 5e-6
TEMPERATURE = "temperature of the centre at the end"
UNDER_BLOW = "stress of the centre under the blow"
BELOW = "stress 5 µm below at the end"
CENTRE = "stress of the centre at the end"
READINGS = {
    TEMPERATURE: (LAST, 0.0, "temperature"),
    UNDER_BLOW: (BLOW, 0.0, "stress"),
    CENTRE: (LAST, 0.0, "stress"),
    BELOW: (LAST, DEEP, "stress"),
}
OUTPUTS = {
    TEMPERATURE: "centre.temperature",
    UNDER_BLOW: "centre.stress_xx",
    CENTRE: "centre.stress_xx",
    BELOW: "depth_5.stress_xx",
}
START = SCENE["body"]["plate"]["initial_temperature"]
WIDTH, _, THICKNESS = SCENE["body"]["plate"]["shape"]["box"]
BOX, DISC = "NGSolve, box", "NGSolve, disc"


def warmed() -> float:
    """Rise of the centre at the end [K], a sum over jumps of the flux."""
    alumina = thermal(IMPACT.DENSITY, IMPACT.SPECIFIC_HEAT, IMPACT.CONDUCTIVITY)
    rise, begin, before = 0.0, 0.0, 0.0
    for end, flux, _ in LOADS:
        rise += disc_flux_rise(flux - before, IMPACT.RADIUS, 0.0, ENDS[-1] - begin, alumina)
        begin, before = end, flux
    return rise


def scene(shape: dict | None = None, mesh: dict | None = None, **more) -> dict:
    """The example's, of another shape or mesh; without one, it follows from a tolerance."""
    plate = {name: of for name, of in SCENE["body"]["plate"].items() if name != "mesh"}
    plate |= {"shape": shape} if shape else {}
    plate |= {"mesh": mesh} if mesh else {}
    probes = [probe for probe in SCENE["probe"] if probe["name"] in ("centre", "depth_5")]
    # Nothing drags here, and what is round takes no shear along x.
    load = SCENE["load"][0] | {"carries": ["heat_flux", "pressure"]}
    plate |= more.pop("body", {})
    of = {"body": {"plate": plate}, "load": [load], "probe": probes}
    return {name: SCENE[name] for name in ("name", "stop_time", "step")} | of | more


def run(told: dict) -> ProgramRun:
    schedule = [
        [n, {"spot.heat_flux": flux, "spot.pressure": pressure}]
        for n, (_, flux, pressure) in enumerate(LOADS)
    ]
    moments = {name: step for name, (step, *_) in READINGS.items()}
    work = {"scene": told, "ends": ENDS, "outputs": OUTPUTS, "moments": moments}
    return ProgramRun("scheduled_unit.py", work | {"schedule": schedule})


ROUND = {"disc": {"radius": WIDTH / 2, "thickness": THICKNESS}}


def asked(shape: dict | None, tolerances=(1e-1, 3e-2, 1e-2, 3e-3, 1e-3), **body) -> list[Point]:
    told = [(t, scene(shape, body=body, fidelity={"tolerance": t})) for t in tolerances]
    return [Point(f"{t:g}", run(of), t) for t, of in told]


def spaced(shape: dict | None) -> list[Point]:
    """Quadratic elements by their nodes over the spot's radius."""
    points = []
    for nodes, depth in ((4, 0.2e-6), (6, 0.1e-6), (12, 0.05e-6), (20, 0.03e-6)):
        mesh = {"spacing": IMPACT.RADIUS / nodes, "depth_spacing": depth, "growth": 1.3, "order": 2}
        points.append(Point(f"R/{nodes}", run(scene(shape, mesh))))
    return points


CASE = {
    "spot": IMPACT.RADIUS,
    "half": WIDTH / 2,
    "thickness": THICKNESS,
    "young": IMPACT.YOUNG,
    "poisson": IMPACT.POISSON,
    "expansion": IMPACT.EXPANSION,
    "capacity": IMPACT.DENSITY * IMPACT.SPECIFIC_HEAT,
    "conductivity": IMPACT.CONDUCTIVITY,
    "initial": START,
    "is_clamped": True,
    "schedule": LOADS,
    "readings": READINGS,
}
FINE = {"order": 8, "radial": 1e-6, "depth": 1e-7, "growth": 1.7, "parts": 6}
FINER = {"order": 8, "radial": 5e-7, "depth": 5e-8, "growth": 1.6, "parts": 8}
WIDER = {"half": 0.8 * WIDTH, "box": WIDTH / 2}


def by_ngsolve(program: str, setting: str, **told) -> Point:
    return Point(setting, ProgramRun(program, CASE | told, environment=".venv-peers"))


def references() -> list[Method]:
    """Each twice: half as long elements and steps tell how good the first one is."""
    return [
        Method(
            BOX,
            [
                by_ngsolve("box_ngsolve.py", "1 µm", **FINE, **WIDER, blocks=3),
                by_ngsolve("box_ngsolve.py", "0.5 µm", **FINER, **WIDER, blocks=4),
            ],
            is_reference=True,
        ),
        Method(
            DISC,
            [
                by_ngsolve("plate_ngsolve.py", "1 µm", **FINE),
                by_ngsolve("plate_ngsolve.py", "0.5 µm", **FINER),
            ],
            is_reference=True,
        ),
    ]


MESHES = ((4, 4e-7, 0.4, 1), (8, 2e-7, 0.25, 1), (16, 1e-7, 0.15, 2))
"""Elements of peers over the spot's radius, where these are smallest, depth of the first, by what
share quadratic ones grow, and steps of heat in a step of the load."""


def ngsolve(order: int) -> list[Point]:
    points = []
    for elements, depth, growth, parts in MESHES:
        mesh = {"radial": IMPACT.RADIUS / elements, "depth": depth, "parts": parts, "order": order}
        mesh |= {"growth": 1.0 + 0.5 * order * growth}
        points.append(by_ngsolve("plate_ngsolve.py", f"R/{elements}", **mesh))
    return points


def scikit() -> list[Point]:
    points = []
    for elements, depth, growth, parts in MESHES:
        mesh = {"radial": IMPACT.RADIUS / elements, "depth": depth, "parts": parts}
        work = ProgramRun("plate_scikit.py", CASE | mesh | {"growth": 1.0 + growth})
        points.append(Point(f"R/{elements}", work))
    return points


def alumina_plate() -> Chart:
    rise = warmed()
    closed = "closed form, Carslaw & Jaeger 1959, § 10.5"
    finer = "NGSolve, elements of order 8"
    quantities = [Quantity(TEMPERATURE, "K", START + rise, rise, closed)]
    for name in (UNDER_BLOW, BELOW, CENTRE):
        of_box = Measured(BOX, "0.5 µm", name)
        quantities.append(Quantity(name, "Pa", of_box, None, finer, has_panel=name != CENTRE))
    of_disc = {name: Measured(DISC, "0.5 µm", name) for name in (UNDER_BLOW, BELOW, CENTRE)}
    methods = [
        *references(),
        # Of a box no mesh finer than the usual one is tried, whatever the tolerance.
        Method("quarter, by tolerance", asked(None, (1e-1,))),
        Method("meridian section, by tolerance", asked(ROUND), of_disc),
        Method("quarter, quadratic elements", spaced(None)),
        Method("meridian section, quadratic elements", spaced(ROUND), of_disc),
        Method("NGSolve, order 2", ngsolve(2), of_disc),
        Method("NGSolve, order 4", ngsolve(4), of_disc),
        Method("scikit-fem, PARDISO", scikit(), of_disc),
    ]
    title = "The alumina plate under an impact's heat and pressure"
    points = (
        "At the ends of curves: tolerance; or distance of nodes (of NGSolve and scikit-fem, the"
        " smallest elements) over the spot's radius R."
    )
    return Chart("alumina_plate", title, quantities, methods, points)
