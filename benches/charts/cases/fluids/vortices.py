"""Taylor and Green's vortices at Re 100: how right are velocities and decay, beside PySPH?"""

from chart import Chart, Method, Point, ProgramRun, Quantity

REYNOLDS, STOP = 100.0, 0.5
ERROR, DECAY = "error of velocities", "rate of decay"
NAMES = {"velocity_error": ERROR, "decay": DECAY}
SCATTER = 0.2
"""Share of their distance by which particles are moved off a lattice that would line them up."""


def ours(sides: list[int], **settings) -> list[Point]:
    """So many particles along the side, on a tilted lattice of 5 m² particles."""
    points = []
    for m in sides:
        work = {
            "flow": "vortices",
            "across": m,
            "reynolds": REYNOLDS,
            "stop": STOP,
            "shifting": True,
            "names": NAMES,
        }
        across = f"{5**0.5 * m:.0f}"
        points.append(Point(across, ProgramRun("flow_limits.py", work | settings)))
    return points


def theirs(scheme: str, sides: list[int], scatter: float = 0.0, **settings) -> list[Point]:
    """So many particles along the side, on a square lattice or a little off it."""
    points = []
    for side in sides:
        work = {
            "scheme": scheme,
            "side": side,
            "scatter": scatter,
            "reynolds": REYNOLDS,
            "stop": STOP,
        }
        run = ProgramRun("pysph_vortices.py", work | settings, environment=".venv-peers")
        points.append(Point(str(side), run))
    return points


def vortices() -> Chart:
    source = "closed form, Taylor & Green 1937, doi 10.1098/rspa.1937.0036"
    quantities = [
        Quantity(ERROR, "1", 0.0, 1.0, source, title="velocities"),
        Quantity(DECAY, "1", 1.0, 1.0, source, title="the rate of decay"),
    ]
    sides = [5, 7, 10, 14, 20]
    methods = [
        Method("H = 3Δx", ours(sides)),
        Method("H = 4Δx", ours(sides, support=4.0)),
        Method("H = 4Δx, double", ours(sides, support=4.0, precision="double")),
        Method("Wendland C4, H = 4Δx", ours(sides, support=4.0, kernel="wendland_c4")),
        Method("H = 3Δx, not shifted", ours(sides, shifting=False)),
        Method("PySPH, damped", theirs("edac", [18, 25])),
        Method("PySPH, damped, scattered", theirs("edac", [12, 18, 25, 36], SCATTER)),
        Method("PySPH, transport, scattered", theirs("tvf", [25], SCATTER)),
        Method("PySPH, transport, settled", theirs("tvf", [18, 25, 36], SCATTER, is_settled=True)),
        Method("PySPH, compressible, scattered", theirs("wcsph", [25], SCATTER)),
    ]
    return Chart(
        "vortices",
        "Taylor and Green's vortices, Re 100, after half a turn",
        quantities,
        methods,
        "At the ends of curves: particles along the side of the square.",
    )
