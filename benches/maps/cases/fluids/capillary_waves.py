"""What free surfaces ask of time steps: capillary waves."""

from math import inf

from plan import Answer, Axis, Map

from cases.fluids.flow_limits import run_flow

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
            [0.06, 0.12, 0.25, 0.5, 1.0, 2.0, 4.0],
        ),
        y=Axis(
            "speed of sound over √(2σ/(ρΔx))",
            "1",
            [0.3, 0.5, 0.7, 1.0, 1.4, 2.0, 3.0, 5.0, 10.0],
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


MAPS = {of.__name__: of for of in (capillary_step,)}
