"""A column of water that is let go beside a wall: how far does it get, beside two other codes?"""

from chart import Chart, Measured, Method, Point, ProgramRun, Quantity

STOP = 2.5
"""End over √(a/2g), a the width of the column; its front has not come to the next wall."""
FRONT, MIDDLE = "front over the width", "middle over the width"
NAMES = {"front": FRONT, "middle": MIDDLE}
FINEST, ACROSS = "H = 3Δx, finest", 64


def ours(across: list[int], **settings) -> list[Point]:
    """So many particles over the width."""
    points = []
    for n in across:
        work = {"flow": "dam", "across": n, "stop": STOP, "names": NAMES, "shifting": True}
        points.append(Point(f"{n}", ProgramRun("flow_limits.py", work | settings)))
    return points


def theirs(program: str, across: list[int], **settings) -> list[Point]:
    points = []
    for n in across:
        work = {"across": n, "stop": STOP, "names": NAMES} | settings
        points.append(Point(f"{n}", ProgramRun(program, work, environment=".venv-peers")))
    return points


def dam() -> Chart:
    front, middle = (Measured(FINEST, f"{ACROSS}", name) for name in (FRONT, MIDDLE))
    source = f"{ACROSS} particles over the width"
    quantities = [
        Quantity(FRONT, "1", front, None, source, title="the position of the front"),
        Quantity(MIDDLE, "1", middle, None, source, title="the position of the middle"),
    ]
    sides = [10, 14, 20, 28, 40]
    pysph = "pysph_dam.py"
    methods = [
        Method(FINEST, ours([ACROSS]), is_reference=True),
        Method("H = 3Δx", ours(sides)),
        Method("H = 4Δx", ours(sides, support=4.0)),
        Method("H = 3Δx, double", ours([10, 14, 20], precision="double")),
        Method("H = 3Δx, not shifted", ours(sides, shifting=False)),
        Method("PySPH, compressible", theirs(pysph, [10, 14, 20, 28], scheme="wcsph")),
        Method("PySPH, inviscid", theirs(pysph, [10, 14, 20, 28], scheme="wcsph", alpha=0.0)),
        Method("PySPH, Adami", theirs(pysph, [10, 14, 20], scheme="aha")),
        Method("PySPH, damped", theirs(pysph, [10, 20], scheme="edac")),
        Method("SPlisHSPlasH, DFSPH", theirs("splishsplash_dam.py", [10, 14, 20, 28, 40])),
    ]
    points = "At the ends of curves: particles over the width of the column."
    return Chart("dam", "A column of water that is let go", quantities, methods, points)
