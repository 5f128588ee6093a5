"""What free surfaces ask of time steps and particles: capillary waves, and a square that turns."""

from math import inf

from plan import Answer, Axis, Map

from cases.fluids.flow_limits import run_flow
from cases.fluids.small_waves import KERNELS

STIRRED = 0.01
"""Kinetic energy over that of the surface at which a drop that should rest does not."""


def capillary_step() -> Map:
    """A drop at rest for a period of its swing, in which tension acts once in several steps."""

    def work(x: float, y: float) -> dict:
        drop = {"flow": "swing", "model": "rings", "across": 16, "stretch": 1.0, "stop": 1.0}
        return drop | {"ohnesorge": 0.01, "sound": x, "capillary": y}

    def motion(answer: Answer, x: float, y: float) -> float:
        return min(answer.values.get("motion", inf), 1e3)

    return Map(
        name="capillary_step",
        title="A drop at rest: steps of tension, speeds of sound",
        x=Axis(
            "step of tension over half a capillary period",
            "1",
            [0.06, 0.12, 0.25, 0.5, 1, 2, 4],
        ),
        y=Axis(
            "speed of sound over √(2σ/(ρΔx))",
            "1",
            [0.3, 0.5, 0.7, 1, 1.4, 2, 3, 5, 10],
        ),
        outcome="motion over the energy of the surface",
        unit="1",
        bad=STIRRED,
        work=lambda x, y: work(y, x),
        run=run_flow,
        judge=motion,
        must_speak=False,
        refine=1.05,
        colours=(1e-5, 1.0),
    )


def turning_square() -> Map:
    """A quarter of a turn of a square whose inside is under tension."""
    rows = [(kernel, shifting) for kernel in KERNELS for shifting in (False, True)]
    labels = [f"{kernel}{', shifted' if shifting else ''}" for kernel, shifting in rows]

    def work(x: float, y: float) -> dict:
        kernel, shifting = rows[round(y)]
        square = {"flow": "square", "across": 30, "stop": 0.25}
        return square | {"support": x, "kernel": kernel, "shifting": shifting}

    return Map(
        name="turning_square",
        title="Clumps in a square that turns",
        x=Axis(
            "support H over the distance of particles Δx",
            "1",
            [2.0, 2.5, 3.0, 3.5, 4.0, 5.0],
            False,
        ),
        y=Axis("kernel", "", list(range(len(rows))), False, labels),
        outcome="Δx over the mean distance to the nearest particle",
        unit="1",
        bad=1.5,
        work=work,
        run=run_flow,
        judge=lambda answer, x, y: 1.0 / answer.values.get("nearest", 1e-3),
        must_speak=False,
        colours=(0.9, 4.0),
    )


MAPS = {of.__name__: of for of in (capillary_step, turning_square)}
