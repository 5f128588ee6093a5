"""Kernels and particles on parts from files: disordered nodes, and cells that grow from the faces.

The body is a cantilever under a small shear. Its Poisson's ratio is zero, so a clamp does not pinch
it, and its deflection is within 1e-4 of the closed form.
"""

from collections.abc import Callable, Iterator
from math import sqrt
from random import Random

from plan import Answer, Axis, Map, Work
from unit_run import equal_steps, run_unit, unit_work

from cases.solids.large_strain import HEIGHT, LOAD, PLAIN, SLENDER, YOUNG, deflection, solid

ROWS = 8  # cells over the height
SAMPLES = 3  # of the disorder
NARROWEST = 0.05  # smallest area at a corner of a cell, over that on the lattice
PART = "beam.vtu"
Place = tuple[float, float]


def heights(growth: float) -> list[float]:
    """Heights of the rows of nodes [m]; cells grow from the top and the bottom to the middle."""
    half = [1.0]
    for _ in range(ROWS // 2 - 1):
        half.append(half[-1] * growth)
    places = [0.0]
    for cell in half + half[::-1]:
        places.append(places[-1] + cell)
    return [HEIGHT * place / places[-1] for place in places]


def disordered(columns: int, disorder: float, seed: int) -> dict[tuple[int, int], Place]:
    """Nodes of a lattice with the distance 1; inner ones are moved by `disorder` in any direction.

    A node is moved anew as long as it nearly folds one of its cells."""
    drawn = Random(seed)
    lattice = [(i, k) for k in range(ROWS + 1) for i in range(columns + 1)]
    nodes = {(i, k): (float(i), float(k)) for i, k in lattice}
    inside = [(i, k) for i, k in lattice if 0 < i < columns and 0 < k < ROWS]
    for i, k in inside if disorder else []:
        while True:
            a, b = direction(drawn)
            nodes[i, k] = i + disorder * a, k + disorder * b
            if all(area > NARROWEST for area in corners(nodes, i, k)):
                break
    return nodes


def direction(drawn: Random) -> Place:
    """A unit vector; it is the same on all platforms, as it takes no sine."""
    while True:
        a, b = 2.0 * drawn.random() - 1.0, 2.0 * drawn.random() - 1.0
        length = sqrt(a * a + b * b)
        if 0.1 < length < 1.0:
            return a / length, b / length


def corners(nodes: dict[tuple[int, int], Place], i: int, k: int) -> Iterator[float]:
    """Areas of the parallelograms at the corners of the four cells around a node."""
    for left in (i - 1, i):
        for low in (k - 1, k):
            cell = [(left, low), (left + 1, low), (left + 1, low + 1), (left, low + 1)]
            for n in range(4):
                (x, z), (a, b), (c, d) = (nodes[cell[m % 4]] for m in (n, n + 1, n + 3))
                yield (a - x) * (d - z) - (b - z) * (c - x)


def mesh(disorder: float, growth: float, seed: int) -> str:
    """A file of the cantilever's cells, which are square at the top and the bottom."""
    rows = heights(growth)
    columns = round(SLENDER * HEIGHT / rows[1])
    points = []
    for (_, k), (x, z) in sorted(disordered(columns, disorder, seed).items(), key=in_rows):
        # Between the rows of the lattice, whose nodes are moved by less than one distance.
        low = max(k - 1, 0) if z < k else min(k, ROWS - 1)
        height = rows[low] + (z - low) * (rows[low + 1] - rows[low])
        points.append(f"{SLENDER * HEIGHT * x / columns:.9g} 0 {height - HEIGHT:.9g}")
    cells = []
    for k in range(ROWS):
        for i in range(columns):
            first = i + (columns + 1) * k
            cells.append([first, first + 1, first + columns + 2, first + columns + 1])
    arrays = [
        array("connectivity", "Int64", " ".join(str(node) for cell in cells for node in cell)),
        array("offsets", "Int64", " ".join(str(4 * n) for n in range(1, len(cells) + 1))),
        array("types", "UInt8", " ".join("9" for _ in cells)),
    ]
    return (
        '<VTKFile type="UnstructuredGrid"><UnstructuredGrid><Piece>'
        f"<Points>{array('points', 'Float64', ' '.join(points), 3)}</Points>"
        f"<Cells>{''.join(arrays)}</Cells></Piece></UnstructuredGrid></VTKFile>"
    )


def in_rows(node: tuple[tuple[int, int], Place]) -> tuple[int, int]:
    (column, row), _ = node
    return row, column


def array(name: str, kind: str, numbers: str, components: int = 1) -> str:
    head = f'type="{kind}" Name="{name}" NumberOfComponents="{components}" format="ascii"'
    return f"<DataArray {head}>{numbers}</DataArray>"


def cantilever(method: dict, disorder: float, growth: float = 1.0) -> Work:
    """A cantilever of a method; its file is written as it is run."""
    keys = {
        "dimension": 2,
        "shape": {"part": {"file": PART}},
        "material": PLAIN | {"model": "neo_hookean", "young": YOUNG, "poisson": 0.0},
        "faces": {"left": {"clamped": True}, "right": {"traction": [0.0, 0.0, 0.0]}},
        **method,
    }
    end = {"name": "end", "in": "pad", "at": [SLENDER * HEIGHT, 0.0, -0.5 * HEIGHT]}
    told = solid(keys, {"probe": [end | {"gives": ["displacement"]}]})
    shear = {"pad.right.traction_z": -LOAD}
    work = unit_work(told, ["end.displacement_z"], equal_steps(1.0, 1), shear)
    return work | {"disorder": disorder, "growth": growth, "samples": SAMPLES}


def run_samples(work: Work) -> Answer:
    """The last deflection of each sample; what one is refused for or warns of, all are."""
    ends, warned = [], ""
    for seed in range(work["samples"]):
        files = {PART: mesh(work["disorder"], work["growth"], seed)}
        answer = run_unit(work | {"scene": work["scene"] | {"files": files}})
        if answer.refused:
            return answer
        warned = warned or answer.warned
        ends.append(answer.values["end.displacement_z"][-1])
        if not work["disorder"]:
            break
    return Answer({"ends": ends}, warned)


def worst(answer: Answer, *_: float) -> float:
    """Of the samples, against the closed form."""
    return max(abs(-end / deflection(poisson=0.0) - 1.0) for end in answer.values["ends"])


DISORDERS = [0.0, 1e-4, 1e-3, 1e-2, 0.03, 0.1, 0.2, 0.3, 0.4, 0.45]


def over_disorder(
    name: str,
    title: str,
    of: str,
    supports: list[float],
    method: Callable[[float], dict],
) -> Map:
    """A map of the settings `method(support)` over the disorder of the nodes."""
    labels = [f"{disorder:g}" for disorder in DISORDERS]
    places = [float(n) for n in range(len(labels))]
    return Map(
        name=name,
        title=title,
        x=Axis("distance of nodes from a lattice over its spacing", "", places, False, labels),
        y=Axis(f"support, distances of {of}", "1", supports),
        outcome="error of the deflection, worst of three samples",
        unit="1",
        bad=0.05,
        work=lambda place, support: cantilever(method(support), DISORDERS[int(place)]),
        run=run_samples,
        judge=worst,
        colours=(1e-4, 1.0),
    )


def kernels(support: float, **more) -> dict:
    return {"mechanics": "rkpm", "rkpm": {"support": support, **more}}


def particles(support: float) -> dict:
    return {"mechanics": "sph", "sph": {"support": support}}


def disordered_kernels() -> Map:
    supports = [0.9, 1.01, 1.1, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0, 4.0, 6.0]
    title = "Kernels on a disordered part"
    return over_disorder("disordered_kernels", title, "nodes", supports, kernels)


def disordered_kernels_gauss() -> Map:
    supports = [0.9, 1.01, 1.25, 1.75, 2.5, 3.0, 4.0, 5.0, 6.0]
    return over_disorder(
        "disordered_kernels_gauss",
        "Kernels with Gauss points on a disordered part",
        "nodes",
        supports,
        lambda support: kernels(support, integration="gauss"),
    )


def disordered_particles() -> Map:
    supports = [1.4, 1.5, 1.6, 1.7, 1.8, 1.9, 2.0, 2.1, 2.2, 2.5, 3.0, 3.5, 4.0]
    title = "Particles on a disordered part"
    return over_disorder("disordered_particles", title, "particles", supports, particles)


def graded_part() -> Map:
    return Map(
        name="graded_part",
        title="Particles on a part whose cells grow from its faces",
        x=Axis("growth from row to row of cells", "1", [1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6], False),
        y=Axis(
            "support, distances of particles",
            "1",
            [1.5, 1.75, 2.0, 2.2, 2.4, 2.6, 2.8, 3.0, 3.5, 4.0],
            False,
        ),
        outcome="error of the deflection, disorder of 0.001 spacings",
        unit="1",
        bad=0.05,
        work=lambda growth, support: cantilever(particles(support), 1e-3, growth),
        run=run_samples,
        judge=worst,
        colours=(1e-4, 1.0),
    )
