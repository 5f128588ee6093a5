"""A reduced plate beside the full one and beside pyMOR's balanced truncation of the same operators:
what does a tolerance cost, and what is kept of it?

All step alike under a flux that flickers, which is held within each step, so all are exact in time.
"""

from chart import Chart, Method, Point, ProgramRun, Quantity
from programs import disc_section as disc

MESH = {"spacing": disc.SPACING, "depth_spacing": disc.SPACING, "growth": 1.0, "order": 2}
TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4)
ORDERS = (2, 8, 12, 16)


def unit(mesh: dict | None, **fidelity) -> ProgramRun:
    return ProgramRun("reduced_unit.py", {"fidelity": fidelity, "mesh": mesh})


def reduced() -> Chart:
    rise = disc.answer(disc.STOP)
    modes = "all modes of the same elements, assembled apart (NumPy, SciPy)"
    quantities = [
        Quantity(disc.DIFFERENCE, "K", 0.0, rise, modes, title="the reduction alone"),
        Quantity(disc.BOUND, "K", 0.0, rise, "none: what the unit says it errs by", False),
        Quantity(
            disc.CENTRE, "K", disc.half_space(), rise, "closed form, Carslaw & Jaeger 1959, § 10.5"
        ),
    ]
    peer = [
        Point(f"order {order}", ProgramRun("reduced_pymor.py", {"order": order}, ".venv-peers"))
        for order in ORDERS
    ]
    asked = [Point(f"{t:g}", unit(MESH, level="reduced", tolerance=t), t) for t in TOLERANCES]
    finer = [Point(f"{t:g}", unit(None, tolerance=t), t) for t in TOLERANCES[:3]]
    both = [Point(f"{t:g}", unit(None, level="reduced", tolerance=t), t) for t in TOLERANCES[:3]]
    methods = [
        Method("reduced unit", asked),
        Method("reduced unit, elements by tolerance", both),
        Method("full unit, same elements", [Point("", unit(MESH))]),
        Method("full unit, elements by tolerance", finer),
        Method("pyMOR, balanced truncation", peer),
    ]
    points = "At the ends of curves: tolerance, or number of unknowns."
    title = "A plate under a flickering spot, reduced"
    return Chart("reduced", title, quantities, methods, points)
