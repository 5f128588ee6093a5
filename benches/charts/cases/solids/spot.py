"""A hot spot on alumina: how warm is its centre, how stressed is what lies below it?

The same question to every level of model: closed form, reduced unit, column, meridian section,
quarter, whole box, elements and particles at equal distances.
"""

from chart import Chart, Formula, Measured, Method, Point, ProgramRun, Quantity, UnitRun
from problems import plates
from problems.half_spaces import disc_flux_rise
from problems.materials import ALUMINA, ELASTIC_ALUMINA, thermoelastic
from problems.plates import CENTRE, START, disc, load, probe

FLUX, RADIUS, STOP, STEPS = 5e8, 50e-6, 10e-6, 10  # W/m², m, s
HALF, THICKNESS, DEPTH = 0.25e-3, 0.25e-3, 5e-6  # m
MATERIAL = thermoelastic(ALUMINA, ELASTIC_ALUMINA)
TEMPERATURE, STRESS = "temperature of the centre", "von Mises stress 5 µm below"
BOX_REFERENCE, DISC_REFERENCE = "NGSolve, box", "NGSolve, disc"
OUTPUTS = {TEMPERATURE: "centre.temperature", STRESS: "below.von_mises"}
TOLERANCES = (1e-1, 3e-2, 1e-2, 3e-3, 1e-3)


def closed_form() -> dict[str, float]:
    return {TEMPERATURE: START + disc_flux_rise(FLUX, RADIUS, 0.0, STOP, ALUMINA)}


def scene(shape: dict, mesh: dict | None = None, **more) -> dict:
    """A plate under the spot; its sides do not move."""
    plate = {"shape": shape, "material": MATERIAL, "faces": {"sides": {"clamped": True}}}
    plate |= {"mesh": mesh} if mesh else {}
    plate |= more.pop("body", {})
    spot = load(disc(RADIUS), "heat_flux", FLUX)
    probes = [CENTRE, probe("below", [0.0, 0.0, -DEPTH], "von_mises")]
    told = plates.scene(plate, STOP, STOP / STEPS, "Spot", load=[spot], probe=probes)
    return told | more


BOX = {"box": [2 * HALF, 2 * HALF, THICKNESS]}
DISC = {"disc": {"radius": HALF, "thickness": THICKNESS}}


def asked(shape: dict, level: str = "full", **body) -> list[Point]:
    """A point for each tolerance that a scene may ask for."""
    return [
        Point(
            f"{tolerance:g}",
            UnitRun(
                scene(shape, body=body, fidelity={"level": level, "tolerance": tolerance}),
                OUTPUTS,
                steps=STEPS,
            ),
            tolerance,
        )
        for tolerance in TOLERANCES
    ]


def spaced(shape: dict, spacings: list[float], mesh: dict, heat: str = "fem") -> list[Point]:
    """A point for each distance of nodes, equal all over."""
    return [
        Point(
            f"{1e6 * spacing:g} µm",
            UnitRun(
                scene(shape, {"spacing": spacing, "growth": 1.0} | mesh, body={"heat": heat}),
                OUTPUTS,
                steps=STEPS,
            ),
        )
        for spacing in spacings
    ]


def column() -> list[Point]:
    """The spot's flux all over the top of a plate whose sides move along themselves alone."""
    points = []
    for tolerance in TOLERANCES:
        told = scene(
            {"box": [THICKNESS, THICKNESS, THICKNESS]},
            body={
                "faces": {"top": {"flux": FLUX}}
                | dict.fromkeys(("bottom", "sides"), {"roller": True})
            },
            fidelity={"tolerance": tolerance},
        )
        del told["load"]
        points.append(Point(f"{tolerance:g}", UnitRun(told, OUTPUTS, steps=STEPS)))
    return points


def plain(spacings: list[float]) -> list[Point]:
    """Particles that exchange heat pair by pair."""
    points = []
    for spacing in spacings:
        body = {"heat": "sph", "sph": {"operator": "plain"}}
        told = scene(BOX, {"spacing": spacing, "growth": 1.0, "order": 1}, body=body)
        points.append(Point(f"{1e6 * spacing:g} µm", UnitRun(told, OUTPUTS, steps=STEPS)))
    return points


CASE = {
    "spot": RADIUS,
    "half": HALF,
    "thickness": THICKNESS,
    "capacity": ALUMINA["density"] * ALUMINA["specific_heat"],
    "conductivity": ALUMINA["conductivity"],
    **ELASTIC_ALUMINA,
    "initial": START,
    "is_clamped": True,
}


def graded(steps: int) -> dict:
    """Steps whose ends are as cubes, since temperatures rise with the root of time at first."""
    ends = [STOP * (n / steps) ** 3 for n in range(1, steps + 1)]
    readings = {TEMPERATURE: (steps, 0.0, "temperature"), STRESS: (steps, DEPTH, "von_mises")}
    return {"schedule": [(end, FLUX, 0.0) for end in ends], "readings": readings, "parts": 1}


def fine(name: str, program: str, **more) -> Method:
    """A reference, and one of elements twice as long that tells how good it is."""
    points = []
    for size, growth, steps in ((2e-6, 1.7, 80), (1e-6, 1.6, 160)):
        mesh = {"order": 8, "radial": size, "depth": size / 5.0, "growth": growth}
        work = ProgramRun(program, CASE | mesh | graded(steps) | more, environment=".venv-peers")
        points.append(Point(f"{1e6 * size:g} µm", work))
    return Method(name, points, is_reference=True)


MESHES = ((4, 2e-6, 0.3, 10), (8, 1e-6, 0.2, 20), (16, 5e-7, 0.12, 40))
"""Elements of peers over the spot's radius, where these are smallest, depth of the first, by what
share quadratic ones grow, and steps."""


def ngsolve(order: int) -> list[Point]:
    points = []
    for elements, depth, growth, steps in MESHES:
        mesh = {"radial": RADIUS / elements, "depth": depth, "order": order}
        mesh |= {"growth": 1.0 + 0.5 * order * growth}
        work = ProgramRun("plate_ngsolve.py", CASE | mesh | graded(steps), ".venv-peers")
        points.append(Point(f"R/{elements}", work))
    return points


def scikit() -> list[Point]:
    points = []
    for elements, depth, growth, steps in MESHES:
        mesh = {"radial": RADIUS / elements, "depth": depth, "growth": 1.0 + growth}
        work = ProgramRun("plate_scikit.py", CASE | mesh | graded(steps))
        points.append(Point(f"R/{elements}", work))
    return points


def spot() -> Chart:
    rise = closed_form()[TEMPERATURE] - START
    closed = "closed form, Carslaw & Jaeger 1959, § 10.5"
    of_box, of_disc = (Measured(name, "1 µm", STRESS) for name in (BOX_REFERENCE, DISC_REFERENCE))
    quantities = [
        Quantity(TEMPERATURE, "K", START + rise, rise, closed),
        Quantity(STRESS, "Pa", of_box, None, "NGSolve, elements of order 8"),
    ]
    coarse = [25e-6, 12.5e-6, 10e-6]
    wider = {"half": 1.6 * HALF, "box": HALF}
    of_disc = {STRESS: of_disc}
    methods = [
        fine(BOX_REFERENCE, "box_ngsolve.py", **wider, blocks=3),
        fine(DISC_REFERENCE, "plate_ngsolve.py"),
        Method("closed form", [Point("", Formula(closed_form))]),
        Method("reduced unit", asked(BOX, "reduced")),
        Method("column", column()),
        Method("meridian section", asked(DISC), of_disc),
        Method("quarter", asked(BOX)),
        Method("whole box", asked(BOX, symmetry="none")),
        Method("uniform finite elements", spaced(BOX, [*coarse, 6.25e-6, 5e-6], {"order": 1})),
        Method("uniform particles, corrected", spaced(BOX, coarse, {"order": 1}, "sph")),
        Method("uniform particles, plain", plain(coarse)),
        Method("scikit-fem, PARDISO", scikit(), of_disc),
        Method("NGSolve, order 2", ngsolve(2), of_disc),
        Method("NGSolve, order 4", ngsolve(4), of_disc),
    ]
    points = (
        "At the ends of curves: tolerance; distance of nodes or particles; or the smallest elements"
        " over the spot's radius R."
    )
    return Chart("spot", "A hot spot on alumina for 10 µs", quantities, methods, points)
