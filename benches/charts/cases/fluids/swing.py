"""A drop that swings by surface tension: how right are its frequency and decay?"""

from chart import Chart, Method, Point, ProgramRun, Quantity

OHNESORGE, STOP = 0.1, 1.3
FREQUENCY, DECAY = "frequency over that of the normal mode", "decay over that of the normal mode"
NAMES = {"frequency": FREQUENCY, "decay": DECAY}


def swings(across: list[float], **settings) -> list[Point]:
    work = {"flow": "swing", "ohnesorge": OHNESORGE, "stop": STOP, "names": NAMES}
    return [
        Point(f"{d:g}", ProgramRun("flow_limits.py", work | {"across": d} | settings))
        for d in across
    ]


def swing() -> Chart:
    source = "normal mode of a viscous drop, Reid 1960, doi 10.1090/qam/114449"
    quantities = [
        Quantity(FREQUENCY, "1", 1.0, 1.0, source, title="the frequency"),
        Quantity(DECAY, "1", 1.0, 1.0, source, title="the rate of decay"),
    ]
    methods = [
        Method("rings", swings([12, 16, 20, 28, 40], model="rings")),
        Method("rings, double precision", swings([12, 20, 28], model="rings", precision="double")),
        Method("rings, H = 4Δx", swings([12, 16, 20, 28, 40], model="rings", support=4.0)),
        Method("rings, Wendland C4", swings([12, 20, 28], model="rings", kernel="wendland_c4")),
        Method("quarter", swings([10, 12, 16, 20], model="quarter")),
        Method("whole", swings([10, 12, 16], model="whole")),
    ]
    points = "At the ends of curves: particles over the diameter."
    title = "A drop that swings, Oh 0.1, over 1.3 periods"
    return Chart("swing", title, quantities, methods, points)
