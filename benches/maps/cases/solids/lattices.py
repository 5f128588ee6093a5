"""A notched beam of concrete, D3 of Asadollahi (2014), as lattices of several directions."""

from dataclasses import replace
from itertools import accumulate
from math import sqrt

from plan import Answer, Axis, Map, Work
from references import Reference
from unit_run import run_unit, unit_work

DEPTH, THICKNESS, STEP = 76.2e-3, 0.1524, 0.1  # m, m, s
SOFTENING = {"model": "openings", "strength": 4.5e6, "openings": [9.05e-6, 197e-6], "share": 0.13}
MATERIAL = {"density": 2323.0, "young": 30e9, "poisson": 0.2, "softening": SOFTENING}
FINE, LAST = 56e-6, 0.6e-3
"""Openings of the notch up to which steps are fine, and at the end [m]."""


def openings(count: int) -> list[float]:
    """Steps of 2 µm over the peak, then so many."""
    fine = [2e-6 * place for place in range(1, 29)]
    step = round((LAST - FINE) / count, 12)
    return fine + [FINE + place * step for place in range(1, count + 1)]


USUAL = 68
OUTPUTS = ["beam.force", "beam.dissipated_energy", "beam.mechanical_work"]
KINDS = [("across", 0), ("along", 0), ("random", 0), ("random", 1), ("random", 2)]
ROWS = [10.0, 12.0, 14.0, 17.0, 20.0]
FINEST = 24.0


def bent(rows: float, kind: float, count: int = USUAL) -> Work:
    """A beam with so many rows of particles over its depth."""
    path = openings(count)
    arrangement, seed = KINDS[int(kind)]
    spacing = DEPTH / rows / (0.5 * sqrt(3.0) if arrangement == "along" else 1.0)
    body = {
        "kind": "lattice",
        "length": 3.0 * DEPTH + 4.0 * spacing,
        "depth": DEPTH,
        "thickness": THICKNESS,
        "spacing": spacing,
        "arrangement": arrangement,
        "seed": seed,
        "notch": {"depth": DEPTH / 3.0},
        "support": {"three_point": {"span": 3.0 * DEPTH}},
        "control": "opening",
        "material": MATERIAL,
    }
    stop = STEP * len(path)
    told = {"name": "Beam", "stop_time": stop, "step": STEP, "body": {"beam": body}}
    return unit_work(told, OUTPUTS, [STEP] * len(path), {"beam.opening": path})


def run_beam(work: Work) -> Answer:
    """The same with the largest load so far."""
    answer = run_unit(work)
    peaks = list(accumulate(answer.values["beam.force"], max))
    return replace(answer, values=answer.values | {"peak": peaks})


SAMPLES = [
    Reference(
        f"beam of {FINEST:g} rows, seed {KINDS[place][1]}", bent(FINEST, float(place)), run_beam
    )
    for place in (2, 3, 4)
]


def of(output: str):
    def judge(answer: Answer, *_) -> float:
        """Beside the mean of fine lattices without order, which have no direction."""
        expected = sum(sample.value(output) for sample in SAMPLES) / len(SAMPLES)
        return abs(answer.values[output][-1] / expected - 1.0)

    return judge


def map_of(name: str, title: str, outcome: str, bad: float, output: str) -> Map:
    return Map(
        name=name,
        title=title,
        x=Axis("rows of particles over the depth", "1", ROWS),
        y=Axis(
            "arrangement",
            "",
            [float(place) for place in range(len(KINDS))],
            is_logarithmic=False,
            labels=["across", "along", "random", "random,\nseed 1", "random,\nseed 2"],
        ),
        outcome=outcome,
        unit="1",
        bad=bad,
        work=bent,
        run=run_beam,
        judge=of(output),
        must_speak=False,
        references=SAMPLES,
        colours=(1e-2, 1.0),
    )


def lattice_peak() -> Map:
    title = "Peak of a notched beam of concrete"
    return map_of("lattice_peak", title, "deviation of the peak", 0.1, "peak")


def lattice_work() -> Map:
    title = "Work on a notched beam of concrete"
    return map_of("lattice_work", title, "deviation of the work", 0.15, "beam.mechanical_work")


COUNTS = [136, 68, 34, 24, 17, 8, 4]
COARSE = 10.0
SHORT = [
    Reference(f"beam in short steps, {arrangement} {seed}", bent(COARSE, float(place)), run_beam)
    for place, (arrangement, seed) in enumerate(KINDS)
]


def in_steps(length: float, kind: float) -> Work:
    """Beyond the peak in steps of so much [µm], of a beam of ten rows."""
    return bent(COARSE, kind, round((LAST - FINE) * 1e6 / length))


def of_steps(answer: Answer, _: float, kind: float) -> float:
    """Beside steps of 8 µm; not all beams find equilibrium in shorter ones."""
    expected = SHORT[int(kind)].value("beam.mechanical_work")
    return abs(answer.values["beam.mechanical_work"][-1] / expected - 1.0)


def lattice_steps() -> Map:
    return Map(
        name="lattice_steps",
        title="Work on a notched beam, in long steps of its opening",
        x=Axis(
            "step of the opening beyond the peak",
            "µm",
            [float(f"{(LAST - FINE) * 1e6 / count:.4g}") for count in COUNTS],
        ),
        y=lattice_work().y,
        outcome="deviation of the work",
        unit="1",
        bad=0.1,
        work=in_steps,
        run=run_beam,
        judge=of_steps,
        must_speak=False,
        references=SHORT,
        colours=(1e-3, 1.0),
    )
