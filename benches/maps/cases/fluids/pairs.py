"""Where particles form pairs under pressure and clump under tension."""

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


def pairing() -> Map:
    """Long after pairs have formed, if any form; with shifting and without."""
    rows = [(kernel, shifting) for kernel in KERNELS for shifting in (False, True)]
    labels = [f"{kernel}{', shifted' if shifting else ''}" for kernel, shifting in rows]

    def settings(x: float, y: float) -> dict:
        kernel, shifting = rows[round(y)]
        return work(
            courant=COURANT,
            support=x,
            kernel=kernel,
            shifting=shifting,
            pressure=PRESSURE,
            cells="hexagonal",
            steps=3000,
            across=14,
        )

    return Map(
        name="pairing",
        title="Pairs of particles under pressure of 0.05 ρc₀²",
        x=Axis(
            "support H over the distance of particles Δx",
            "1",
            [2.0, 2.25, 2.5, 3.0, 4.0, 5.0],
            False,
        ),
        y=Axis("kernel", "", list(range(len(rows))), False, labels),
        outcome="Δx over the mean distance to the nearest particle",
        unit="1",
        bad=1.5,
        work=settings,
        run=run_flow,
        judge=lambda answer, x, y: 1.0 / answer.values["nearest"],
        must_speak=False,
        colours=(0.9, 4.0),
    )


MAPS = {of.__name__: of for of in (pairing, pairing_cubic_spline, tension)}
