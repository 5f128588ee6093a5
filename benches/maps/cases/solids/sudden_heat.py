"""Heat that has not gone as far as an element: what elements and particles do meanwhile."""

from plan import Answer, Axis, Map, Work
from problems.plates import START, probe, scene
from unit_run import run_unit, unit_work

from cases.solids.plates import DIFFUSIVITY

SPACING, LAYERS, WARMER, FLUX = 10e-6, 16, 100.0, 1e7  # m, 1, K, W/m²
KINDS = [
    ("linear,\nflux", {"order": 1}, "fem", {"flux": FLUX}),
    ("quadratic,\nflux", {"order": 2}, "fem", {"flux": FLUX}),
    ("particles,\nflux", {}, "sph", {"flux": FLUX}),
    ("linear,\nheld", {"order": 1}, "fem", {"temperature": START + WARMER}),
    ("quadratic,\nheld", {"order": 2}, "fem", {"temperature": START + WARMER}),
    ("particles,\nheld", {}, "sph", {"temperature": START + WARMER}),
]
DEPTHS = [0.25 * SPACING * place for place in range(25)]


def slab(kind: float, reach: float) -> Work:
    """One step of such a length that √(aΔt) is so many distances of nodes."""
    _, mesh, heat, face = KINDS[int(kind)]
    step = (reach * SPACING) ** 2 / DIFFUSIVITY
    body = {
        "shape": {"box": [4 * SPACING, 4 * SPACING, LAYERS * SPACING]},
        "heat": heat,
        "mesh": {"spacing": SPACING, "growth": 1.0} | mesh,
        "faces": {"top": face},
    }
    probes = [probe(f"p{n}", [0.0, 0.0, -z], "temperature") for n, z in enumerate(DEPTHS)]
    outputs = [f"{one['name']}.temperature" for one in probes]
    return unit_work(scene(body, step, step, probe=probes), outputs, [step])


def undershoot(answer: Answer, *_) -> float:
    """How far the coldest place is below the start, over the warmest above it."""
    rises = [values[-1] - START for values in answer.values.values()]
    return max(-min(rises), 0.0) / max(rises)


def sudden_heat() -> Map:
    return Map(
        name="sudden_heat",
        title="Cold beside sudden heat",
        x=Axis(
            "elements or particles, and the face",
            "",
            [float(place) for place in range(len(KINDS))],
            is_logarithmic=False,
            labels=[kind[0] for kind in KINDS],
        ),
        y=Axis("√(aΔt) over the distance of nodes", "1", [0.03, 0.0754, 0.189, 0.475, 1.19, 3.0]),
        outcome="undershoot below the start, over the rise",
        unit="1",
        bad=0.01,
        work=slab,
        run=run_unit,
        judge=undershoot,
        colours=(1e-4, 0.3),
    )
