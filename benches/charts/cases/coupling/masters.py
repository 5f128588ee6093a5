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
        Method("libcosim, Jacobi", peer),
        Method("Jacobi, held inputs", equal(scheme="jacobi")),
        Method("Jacobi, extrapolated inputs", equal(scheme="jacobi", extrapolation=1)),
        Method("Gauss-Seidel", equal(scheme="gauss-seidel")),
        Method("iterated, held inputs", equal(order=0, **iterated)),
        Method("iterated, linear inputs", equal(order=1, **iterated)),
        Method("iterated, graded steps", equal(order=1, graded=0.5, **iterated)),
        Method("iterated, adaptive, order 1", adaptive(1)),
        Method("iterated, adaptive, order 2", adaptive(2)),
    ]
    quantities = [
        Quantity(WALL, "K", 0.0, 1.0, SOURCE, title="the wall, at most after a tenth of the time"),
        Quantity(END, "K", 0.0, 1.0, SOURCE, title="the wall at the end"),
    ]
    points = (
        "Points from left to right: 8, 32, 128 and 512 steps (libcosim 2000, too), or tolerances of"
        " 0.01 to 1e-5. Arrows: errors above 1."
    )
    title = "Two slabs that touch, as two units"
    return Chart("masters", title, quantities, methods, points, has_settings=False)
