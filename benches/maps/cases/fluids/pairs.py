"""Where particles form pairs under pressure and clump under tension."""

from collections.abc import Callable

from plan import Axis, Map

from cases.fluids.flow_limits import run_flow
from cases.fluids.small_waves import COURANT, KERNELS, map_of_pressures, work

PRESSURE = 0.05


def pairing_cubic_spline() -> Map:
    return map_of_pressures(
        "pairing_cubic_spline",
        "Pairs under pressure, cubic spline",
        "cubic_spline",
        1.0,
        "hexagonal",
    )


def tension() -> Map:
    return map_of_pressures("tension", "Clumps under tension", "wendland_c2", -1.0, "hexagonal")


def map_of_crowding(
    name: str, title: str, supports: list[float], setting: Callable[[float, str, bool], dict]
) -> Map:
    """How close particles are after a flow, by support, kernel and whether they are shifted."""
    rows = [(kernel, shifting) for kernel in KERNELS for shifting in (False, True)]
    labels = [f"{kernel}{', shifted' if shifting else ''}" for kernel, shifting in rows]
    return Map(
        name=name,
        title=title,
        x=Axis("support H over the distance of particles Δx", "1", supports, False),
        y=Axis("kernel", "", list(range(len(rows))), False, labels),
        outcome="Δx over the mean distance to the nearest particle",
        unit="1",
        bad=1.5,
        work=lambda x, y: setting(x, *rows[round(y)]),
        run=run_flow,
        judge=lambda answer, x, y: 1.0 / answer.values["nearest"],
        must_speak=False,
        colours=(0.9, 4.0),
    )


def pairing() -> Map:
    """Long after pairs have formed, if any form; with shifting and without."""

    def setting(support: float, kernel: str, shifting: bool) -> dict:
        return work(
            courant=COURANT,
            support=support,
            kernel=kernel,
            shifting=shifting,
            pressure=PRESSURE,
            cells="hexagonal",
            steps=3000,
            across=14,
        )

    supports = [2.0, 2.25, 2.5, 3.0, 4.0, 5.0]
    title = "Pairs of particles under pressure of 0.05 ρc₀²"
    return map_of_crowding("pairing", title, supports, setting)


def turning_square() -> Map:
    """A quarter of a turn of a square whose inside is under tension."""

    def setting(support: float, kernel: str, shifting: bool) -> dict:
        square = {"flow": "square", "across": 30, "stop": 0.25}
        return square | {"support": support, "kernel": kernel, "shifting": shifting}

    supports = [2.0, 2.5, 3.0, 3.5, 4.0, 5.0]
    return map_of_crowding("turning_square", "Clumps in a square that turns", supports, setting)


MAPS = {of.__name__: of for of in (pairing, pairing_cubic_spline, tension, turning_square)}
