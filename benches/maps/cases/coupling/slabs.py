"""Two slabs whose steps are iterated without acceleration: one takes the temperature of the wall
and gives its flux, the other takes that. By how much does an iteration shrink what is left?

Walls rise linearly over a step H and fluxes are held at their mean. For steps tiny beside what heat
takes through a cell the factor is the ratio of heat capacities; for moderate ones, while slabs are
half spaces, `8/(3π)` of that of effusivities, as the mean flux into a half space whose wall rises
by ΔT is `4/3 e ΔT/√(πH)` and a held flux q warms one by `2 q √(H/π)/e`; for huge ones half of that
of conductivities, where far faces are held. After A. Monge, P. Birken (2018), doi
10.1007/s00466-017-1511-3, whose fluxes are those at ends of steps.
"""

import warnings
from math import nan, pi
from tempfile import TemporaryDirectory

import numpy as np
from impinge import Connection, Master
from impinge.master import MasterError
from plan import Answer, Axis, Boundary, Map, Work

from cases.coupling.linear import make

CELLS = 60
RATIOS = [0.2, 0.5, 0.8, 1.1, 1.4, 2.0, 5.0]
STEPS = [1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1, 1.0, 1e1, 1e2, 1e3]
OF_CAPACITY, OF_CONDUCTIVITY = 0.5, 1.5  # powers of the ratio of effusivities
RING = [("n.y", "d.u"), Connection("d.z", "n.u", gain=-1.0, mean=True)]


def slab(folder: str, name: str, conductivity: float, capacity: float, is_wall_given: bool):
    """Linear elements with lumped capacities over a thickness of 1 m; the wall is node 0, the far
    face is held at zero. Heat that leaves there counts too: one more state, its integral."""
    width = 1.0 / CELLS
    mass = np.full(CELLS, capacity * width)
    mass[0] /= 2
    stiffness = 2 * np.eye(CELLS) - np.eye(CELLS, k=1) - np.eye(CELLS, k=-1)
    stiffness[0, 0] = 1
    rates = stiffness * conductivity / width / mass[:, None]
    if not is_wall_given:
        first = np.eye(CELLS)[0]
        return make(folder, name, -rates, first / mass[0], first, x=np.ones(CELLS))
    a = np.zeros((CELLS, CELLS))
    a[:-1, :-1] = -rates[1:, 1:]
    a[-1, -2] = conductivity / width
    b = np.append(-rates[1:, 0], 0.0)
    return make(folder, name, a, b, np.zeros(CELLS), f=np.append(mass[1:], 1.0), g=mass[0])


def one_step(units: dict, step: float, residuals: list[float], **options) -> None:
    """A step without acceleration; what was left after each iteration."""
    with Master(units, RING, step=step, acceleration="none", **options) as master:
        (component,) = master.components
        forward = component.acceleration.next

        def watched(x, g, weight):
            residuals.append(float(np.abs(g - x).max()))
            return forward(x, g, weight)

        component.acceleration.next = watched
        master.run(step)


def contraction(of: Work) -> Answer:
    """The median factor of later iterations; and what the product says of such a step."""
    ratio, residuals, refused = of["ratio"], [], ""
    with TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        given = ratio**OF_CONDUCTIVITY, ratio**OF_CAPACITY
        units = {
            "d": slab(folder, "given", *given, True),
            "n": slab(folder, "taking", 1.0, 1.0, False),
        }
        one_step(units, of["step"], residuals, strict=False, tolerance=1e-30, max_iterations=12)
        try:
            one_step(units, of["step"], [])
        except MasterError as refusal:
            refused = str(refusal)
    factors = np.array(residuals[1:]) / np.array(residuals[:-1])
    return Answer({"factor": float(np.median(factors[3:8]))}, warned=refused)


def limit(step: float) -> float:
    """The ratio of effusivities at which what is left stays as large, in the three regimes."""
    if step < 2e-6:
        return 1.0
    if 2e-3 < step < 2e-2:
        return 3 * pi / 8
    return 2 ** (1 / OF_CONDUCTIVITY) if step > 5.0 else nan


def slabs() -> Map:
    return Map(
        name="coupling_slabs",
        title="Two slabs, iterated without acceleration",
        x=Axis("step H a/L²", "1", STEPS),
        y=Axis("effusivity that takes a temperature over that which takes a flux", "1", RATIOS),
        outcome="factor of an iteration",
        unit="1",
        bad=1.0,
        work=lambda step, ratio: {"step": step, "ratio": ratio},
        run=contraction,
        judge=lambda answer, step, ratio: answer.values["factor"],
        theory=[Boundary("capacities, effusivities, conductivities", limit, "after Monge, Birken")],
        guards="the master refuses steps that do not converge; with acceleration they do",
        refine=1.02,
        colours=(0.03, 30.0),
    )
