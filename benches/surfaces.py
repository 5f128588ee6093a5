"""Maps between surfaces: processor time to cut cells, beside medcoupling, and errors of radial
functions.

The blade of preCICE's own example is not here. Its function, distances of points, radial function
and measure are; the surfaces are the unit square and a tube of elliptic section as long and about
as large as the blade, with points where a random sequence of low discrepancy has them.
"""

import argparse
import time

import medcoupling as mc
import numpy as np
from impinge.surface import Surface
from impinge.surface.overlap import cut
from scipy.spatial import Delaunay

PUBLISHED = 9.588e-8  # preCICE, tutorials/aste-turbine, root of the mean square at 3458 points


def median_time(function, repetitions):
    times = []
    for _ in range(repetitions):
        begin = time.process_time()
        function()
        times.append(time.process_time() - begin)
    return float(np.median(times))


def print_row(name, *cells):
    print(name.ljust(16), *(str(cell).rjust(15) for cell in cells))


def triangles(points):
    """Random triangles that fill a square: twice as many as points, and two."""
    inside = np.random.default_rng(1).uniform(-1, 1, (points, 2))
    nodes = np.concatenate([inside, [[-1, -1], [-1, 1], [1, -1], [1, 1]]])
    return Surface.triangles(nodes, Delaunay(nodes).simplices)


def of_medcoupling(surface):
    mesh = mc.MEDCouplingUMesh("mesh", 2)
    mesh.setCoords(mc.DataArrayDouble(surface.cells.nodes))
    cells = surface.cells.corners
    three = cells[:, 2] == cells[:, 3]
    count = np.where(three, 3, 4)
    ends = np.concatenate([[0], np.cumsum(count + 1)])
    flat = np.empty(ends[-1], dtype=np.int64)
    flat[ends[:-1]] = np.where(three, mc.NORM_TRI3, mc.NORM_QUAD4)
    for k in range(4):
        some = k < count
        flat[ends[:-1][some] + 1 + k] = cells[some, k]
    mesh.setConnectivity(mc.DataArrayInt64(flat), mc.DataArrayInt64(ends.astype(np.int64)))
    return mesh


def cut_by_medcoupling(a, b):
    remapper = mc.MEDCouplingRemapper()
    remapper.setIntersectionType(mc.Triangulation)
    remapper.prepare(a, b, "P0P0")


def cutting(repetitions):
    mesh = triangles(50_000)
    targets = {
        "40 × 40 tiles": Surface.tiles((40, 40), (2.0, 2.0)),
        "40 rings": Surface.rings(40, 1.0),
        "6 002 triangles": triangles(3000),
    }
    print(f"{mesh.size} triangles on")
    print_row("", "pieces", "cut [s]", "medcoupling [s]", "map [s]", "lost")
    values = np.random.default_rng(0).normal(size=mesh.size)
    foreign = of_medcoupling(mesh)
    for name, target in targets.items():
        pieces = len(cut(target.cells, mesh.cells).i)
        own = median_time(lambda target=target: cut(target.cells, mesh.cells), repetitions)
        built = median_time(lambda target=target: mesh.map_to(target, outside="drop"), repetitions)
        other = "arcs apart"
        if name != "40 rings":
            cells = of_medcoupling(target)
            other = median_time(lambda cells=cells: cut_by_medcoupling(foreign, cells), repetitions)
            other = f"{other:.3f}"
        flux = mesh.map_to(target, outside="drop")
        total = np.abs(values) @ mesh.areas
        rest = flux.integral(values) - flux.lost(values) - target.integral(flux(values))
        lost = f"{abs(rest) / total:.1e}"
        print_row(name, pieces, f"{own:.3f}", other, f"{built:.3f}", lost)


def franke(p):
    """Franke's function in three dimensions, with the exponents of that example."""
    x, y, z = (9 * p).T
    return (
        0.75 * np.exp(-((x - 2) ** 2 + (y - 2) ** 2 + (z - 2) ** 2) / 4)
        + 0.75 * np.exp(-((x + 1) ** 2) / 49 - (y + 1) / 10 - (z + 1) / 10)
        + 0.5 * np.exp(-((x - 7) ** 2 + (y - 3) ** 2 + (z - 5) ** 2) / 4)
        - 0.2 * np.exp(-((x - 4) ** 2) - (y - 7) ** 2 - (z - 5) ** 2)
    )


def square(distance):
    line = np.linspace(0, 1, round(1 / distance) + 1)
    flat = np.stack(np.meshgrid(line, line, indexing="ij"), axis=2).reshape(-1, 2)
    return np.column_stack([flat, np.zeros(len(flat))])


def tube(distance):
    """Points on a tube of half axes 0.06 and 0.03, a unit long, as many as a lattice of
    triangles of that distance has.
    """
    angle = np.linspace(0, 2 * np.pi, 2001)
    around = np.column_stack([0.06 * np.cos(angle), 0.03 * np.sin(angle)])
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(around, axis=0), axis=1))])
    count = round(length[-1] / (np.sqrt(3) / 2 * distance**2))
    # The sequence of low discrepancy of Roberts, by the plastic number
    plastic = 1.32471795724474602596
    u, v = np.modf(np.outer([1 / plastic, 1 / plastic**2], np.arange(count)))[0]
    where = u * length[-1]
    section = [np.interp(where, length, around[:, k]) for k in (0, 1)]
    return np.column_stack([v, *section])


def radial():
    print(f"\nFranke's function, 0.01 to 0.006; published for a blade: {PUBLISHED:.2e}")
    print_row("", "smoothness", "points", "onto", "rms", "max", "99 %", "linear", "[s]")
    for name, make in (("square", square), ("tube", tube)):
        source, target = make(0.01), make(0.006)
        for smoothness in (2, 4, 6):
            begin = time.process_time()
            there = Surface.points(source).map_to(
                Surface.points(target), "consistent", smoothness=smoothness, outside="nearest"
            )
            taken = time.process_time() - begin
            error = np.abs(there(franke(source)) - franke(target))
            linear = np.abs(there(source @ [1, 2, 3]) - target @ [1, 2, 3]).max()
            numbers = [np.sqrt((error**2).mean()), error.max(), np.percentile(error, 99), linear]
            numbers = [f"{number:.1e}" for number in numbers]
            points = len(source), len(target)
            print_row(name, f"C{smoothness}", *points, *numbers, f"{taken:.1f}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repetitions", type=int, default=5)
    cutting(parser.parse_args().repetitions)
    radial()
