"""A drop that hits a wall: how right are its peak force and its largest spread?"""

from chart import Chart, Method, Point, ProgramRun, Quantity

FORCE = "peak force over ρU²D²"
NARROW, WIDE = "spread over D, We 51, Re 27", "spread over D, We 70, Re 234"
CASES = {
    FORCE: {"of": "force", "weber": 250.0, "reynolds": 6000.0},
    NARROW: {"of": "spread", "weber": 51.0, "reynolds": 27.0},
    WIDE: {"of": "spread", "weber": 70.0, "reynolds": 234.0},
}
BAND = 0.81, 0.85
"""Measured and computed peaks of force of drops of high We and Re (Zhang et al. 2022)."""


def impacts(across: list[float], **body) -> list[Point]:
    """Every case with so many particles across the drop."""
    points = []
    for name, case in CASES.items():
        for d in across:
            work = case | {"name": name, "across": d, "body": body}
            points.append(Point(f"{d:g}", ProgramRun("impact.py", work)))
    return points


def impact() -> Chart:
    middle = sum(BAND) / 2.0
    zhang = "0.81 to 0.85, Zhang et al. 2022, doi 10.1103/PhysRevLett.129.104501"
    volumes = "OpenFOAM's interFoam, cells of D/100, tests/verification/volume_of_fluid.py"
    quantities = [
        Quantity(FORCE, "1", middle, middle, zhang),
        Quantity(NARROW, "1", 1.64, 1.64, volumes),
        Quantity(WIDE, "1", 2.39, 2.39, volumes),
    ]
    rings, quarter = {"symmetry": "axisymmetric"}, {"symmetry": "quarter"}
    methods = [
        Method("rings", impacts([12, 16, 24, 36, 48], **rings)),
        Method("rings, double precision", impacts([24], **rings, precision="double")),
        Method("rings, H = 4Δx", impacts([16, 24, 36], **rings, support=4.0)),
        Method("rings, Wendland C4", impacts([24, 36], **rings, kernel="wendland_c4")),
        Method("quarter", impacts([12, 16, 20, 24], **quarter)),
        Method("whole", impacts([16], symmetry="none")),
    ]
    points = "At the ends of curves: particles over the diameter."
    return Chart("impact", "A drop that hits a wall", quantities, methods, points)
