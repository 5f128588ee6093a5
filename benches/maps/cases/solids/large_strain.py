"""Solids of large strain that lock, creep over long steps, and turn far in one of them."""

from math import exp, pi

from plan import Answer, Axis, Map, Work
from unit_run import equal_steps, run_unit, unit_work

YOUNG = 1e6  # Pa
PLAIN = {"density": 1000.0, "specific_heat": 1900.0, "conductivity": 0.2}
METHODS = {
    "elements": {},
    "kernels, nodal": {"mechanics": "rkpm"},
    "kernels, Gauss": {"mechanics": "rkpm", "rkpm": {"integration": "gauss"}},
    "Galerkin": {"mechanics": "efg"},
    "particles": {"mechanics": "sph"},
}
COMPRESSIBILITIES = [0.4, 0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6]


def solid(keys: dict, more: dict | None = None) -> dict:
    """A scene of one body of large strain."""
    body = {"kind": "solid", "strain": "finite", "initial_temperature": 293.15, **keys}
    scene = {"name": "LargeStrain", "stop_time": 1.0, "step": 1.0, "body": {"pad": body}}
    return scene | (more or {})


HEIGHT, SLENDER, LOAD = 1e-2, 10.0, 20.0  # m, 1, Pa


def beam(method: float, compressibility: float) -> Work:
    """A cantilever in plane strain, eight spacings high, under a small shear at its end."""
    rubber = {"model": "neo_hookean", "young": YOUNG, "poisson": 0.5 * (1.0 - compressibility)}
    keys = {
        "dimension": 2,
        "shape": {"box": [SLENDER * HEIGHT, 1.0, HEIGHT]},
        "mesh": {"spacing": HEIGHT / 8.0},
        "material": PLAIN | rubber,
        "faces": {"left": {"clamped": True}, "right": {"traction": [0.0, 0.0, 0.0]}},
        **list(METHODS.values())[int(method)],
    }
    end = {"name": "end", "in": "pad", "at": [0.5 * SLENDER * HEIGHT, 0.0, -0.5 * HEIGHT]}
    told = solid(keys, {"probe": [end | {"gives": ["displacement"]}]})
    shear = {"pad.right.traction_z": -LOAD}
    return unit_work(told, ["end.displacement_z"], equal_steps(1.0, 1), shear)


def of_beam(answer: Answer, _: float, compressibility: float) -> float:
    wanted = deflection(0.5 * (1.0 - compressibility))
    return abs(-answer.values["end.displacement_z"][-1] / wanted - 1.0)


def deflection(poisson: float) -> float:
    """`F L³/3E′I + 6FL/5GA` in plane strain [m]: Timoshenko and Goodier (1970)."""
    length, plane = SLENDER * HEIGHT, YOUNG / (1.0 - poisson**2)
    bent = LOAD * HEIGHT * length**3 / (3.0 * plane * HEIGHT**3 / 12.0)
    sheared = 6.0 * LOAD * length / (5.0 * YOUNG / (2.0 * (1.0 + poisson)))
    return bent + sheared


def locking_at_large_strain() -> Map:
    labels = list(METHODS)
    return Map(
        name="locking_at_large_strain",
        title="A cantilever that hardly changes its volume",
        x=Axis("method", "", [float(n) for n in range(len(labels))], False, labels),
        y=Axis("compressibility 1 − 2ν", "1", COMPRESSIBILITIES[::-1]),
        outcome="error of the deflection",
        unit="1",
        bad=0.1,
        work=beam,
        run=run_unit,
        judge=of_beam,
        colours=(1e-3, 1.0),
    )


POISSON, FRACTION, TIME, LASTS, STRESS = 0.45, 0.6, 2.0, 5.0, 0.5  # 1, 1, s, relaxation times, Pa


def creeping(step: float, tolerance: float) -> Work:
    """A bar under a small constant stress, in steps of so many relaxation times."""
    branch = {"fraction": FRACTION, "time": TIME}
    law = {"model": "viscoelastic", "young": YOUNG, "poisson": POISSON}
    keys = {
        "shape": {"box": [10e-3, 8e-3, 12e-3]},
        "symmetry": "quarter",
        "mesh": {"spacing": 4e-3},
        "material": PLAIN | law | {"shear_relaxation": [branch]},
        "faces": {"top": {"traction": [0.0, 0.0, 0.0]}, "bottom": {"roller": True}},
    }
    told = solid(keys, {"fidelity": {"tolerance": tolerance}})
    count = max(1, round(LASTS / step))
    steps = equal_steps(count * step * TIME, count)
    return unit_work(told, ["pad.height"], steps, {"pad.top.traction_z": STRESS})


def of_creep(answer: Answer, step: float, tolerance: float) -> float:
    """Against `ε = σ/9K + σ/3µ (1 − γ exp(−(1 − γ)t/τ))` with the lasting modulus µ."""
    shear, bulk = YOUNG / (2.0 * (1.0 + POISSON)), YOUNG / (3.0 * (1.0 - 2.0 * POISSON))
    worst = 0.0
    heights = answer.values["pad.height"][1:]
    for place, height in enumerate(heights, start=1):
        decay = exp(-(1.0 - FRACTION) * place * step)
        wanted = STRESS / (9.0 * bulk)
        wanted += STRESS / (3.0 * shear * (1.0 - FRACTION)) * (1.0 - FRACTION * decay)
        worst = max(worst, abs((height / 12e-3 - 1.0) / wanted - 1.0))
    return worst / tolerance


def creep_over_steps() -> Map:
    return Map(
        name="creep_over_steps",
        title="Creep of a bar at large strain",
        x=Axis("step over the relaxation time", "1", [0.03, 0.3, 1.0, 3.0, 10.0, 100.0]),
        y=Axis("tolerance", "1", [1e-5, 1e-4, 1e-3, 1e-2, 0.1]),
        outcome="largest error of the strain over the tolerance",
        unit="1",
        bad=1.0,
        work=creeping,
        run=run_unit,
        judge=of_creep,
        colours=(1e-3, 10.0),
    )


LAYER, ACROSS = 0.5e-3, 8.0  # m, spacings over the height
RISE = 100.0  # K


def turning(angle: float, slenderness: float) -> Work:
    """A strip of two layers, one of which swells, so that its end turns by an angle in one step."""
    length = 2.0 * LAYER * slenderness

    def layer(expansion: float) -> dict:
        law = {"model": "neo_hookean", "young": YOUNG, "poisson": 0.0, "expansion": expansion}
        return {"thickness": LAYER, "material": PLAIN | law}

    # Timoshenko (1925) with two layers alike: κ = 3 Δε/(2 h), h of both.
    mismatch = pi * angle / 180.0 / length * 2.0 * 2.0 * LAYER / 3.0
    keys = {
        "dimension": 2,
        "shape": {"box": [length, 1.0, 2.0 * LAYER]},
        "mesh": {"spacing": 2.0 * LAYER / ACROSS},
        "layers": [layer(0.0), layer(mismatch / RISE)],
        "faces": {"left": {"clamped": True}},
    }
    warm = {"pad.temperature": 293.15 + RISE}
    return unit_work(solid(keys), ["pad.curvature"], equal_steps(1.0, 1), warm)


def of_turn(answer: Answer, angle: float, slenderness: float) -> float:
    wanted = pi * angle / 180.0 / (2.0 * LAYER * slenderness)
    return abs(abs(answer.values["pad.curvature"][-1]) / wanted - 1.0)


def turns_in_one_step() -> Map:
    return Map(
        name="turns_in_one_step",
        title="A strip that bends in one step",
        x=Axis("angle by which its end turns", "°", [10.0, 45.0, 90.0, 180.0, 360.0]),
        y=Axis("length over height", "1", [40.0, 80.0, 120.0]),
        outcome="error of the curvature",
        unit="1",
        bad=0.1,
        work=turning,
        run=run_unit,
        judge=of_turn,
        colours=(1e-3, 1.0),
        refusal_is_edge=True,
    )
