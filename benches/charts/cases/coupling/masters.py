"""Two thick slabs of different temperature that touch, as two units: how good is each scheme of a
master for the time that it takes?

Units are exact within a step, so all errors are the master's. The flux begins at once and falls as
one over the root of time.
"""

from chart import Chart, Method, Point, ProgramRun, Quantity

WALL, END = "temperature of the wall", "the same at the end"
STEPS = (8, 32, 128, 512)
TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5)
SOURCE = "matrix exponential of both slabs together (SciPy)"


def run(steps: int, **options) -> ProgramRun:
    told = {"master": "impinge", "steps": steps, "options": options}
    return ProgramRun("two_slabs.py", told)


def equal(**options) -> list[Point]:
    return [Point(f"{steps} steps", run(steps, **options)) for steps in STEPS]


def adaptive(order: int) -> list[Point]:
    """The first step is what a tolerance leaves open."""
    return [
        Point(
            f"{tolerance:g}", run(100, order=order, adaptive=True, tolerance=tolerance), tolerance
        )
        for tolerance in TOLERANCES
    ]


def masters() -> Chart:
    """Values are distances from the reference, over the first difference of temperatures."""
    peer = [
        Point(f"{steps} steps", ProgramRun("two_slabs.py", {"master": "libcosim", "steps": steps}))
        for steps in (*STEPS, 2000)
    ]
    iterated = {"scheme": "iterate"}
    methods = [
        Method("libcosim, side by side", peer),
        Method("side by side, held", equal(scheme="jacobi")),
        Method("side by side, straight on", equal(scheme="jacobi", extrapolation=1)),
        Method("one after the other", equal(scheme="gauss-seidel")),
        Method("iterated, held", equal(order=0, **iterated)),
        Method("iterated, straight", equal(order=1, **iterated)),
        Method("iterated, graded", equal(order=1, graded=0.5, **iterated)),
        Method("iterated, adaptive, order 1", adaptive(1)),
        Method("iterated, adaptive, order 2", adaptive(2)),
    ]
    quantities = [
        Quantity(WALL, "K", 0.0, 1.0, SOURCE),
        Quantity(END, "K", 0.0, 1.0, SOURCE),
    ]
    return Chart("masters", "Two slabs that touch, as two units", quantities, methods)
