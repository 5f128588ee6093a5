"""Areas that cells share: closed forms, sums, and an independent code that cuts."""

import medcoupling as mc
import numpy as np
import pytest
from impinge.surface import Surface, SurfaceError
from impinge.surface.circles import in_discs, lens
from impinge.surface.overlap import cut, cut_polygons
from scipy.sparse import csr_matrix
from scipy.spatial import Delaunay


def random_triangles(seed, points, low=-1.0, high=1.0, **options):
    """A mesh of random triangles that fills a square."""
    inside = np.random.default_rng(seed).uniform(low, high, (points, 2))
    corners = [[low, low], [low, high], [high, low], [high, high]]
    nodes = np.concatenate([inside, corners])
    return Surface.triangles(nodes, Delaunay(nodes).simplices, **options)


def random_quads(seed, count=12, size=2.0):
    """A mesh of quadrilaterals whose inner nodes are shaken."""
    rng = np.random.default_rng(seed)
    tiles = Surface.tiles((count, count), (size, size)).cells
    nodes = tiles.nodes.copy()
    inner = (np.abs(nodes) < 0.499 * size).all(axis=1)
    nodes[inner] += rng.uniform(-0.3, 0.3, (inner.sum(), 2)) * size / count
    return Surface.quads(nodes, tiles.corners)


SURFACES = {
    "triangles": lambda: random_triangles(1, 300),
    "quads": lambda: random_quads(2),
    "tiles": lambda: Surface.tiles((9, 7), (2.0, 2.0)),
    "rings": lambda: Surface.rings(11, 0.8, (0.1, -0.05)),
    "hollow rings": lambda: Surface.ring_edges([0.2, 0.25, 0.6, 0.61], (0.0, 0.3)),
}


def shared(a, b):
    pieces = cut(a.cells, b.cells)
    assert (pieces.area > 0).all()
    return csr_matrix((pieces.area, (pieces.i, pieces.j)), (a.size, b.size)).toarray()


@pytest.mark.parametrize("first", SURFACES)
@pytest.mark.parametrize("second", ["triangles", "quads", "tiles"])
def test_pieces_of_a_cell_make_up_the_cell(first, second):
    a, b = SURFACES[first](), SURFACES[second]()
    areas = shared(a, b)
    # b fills the square that a lies in.
    assert np.abs(areas.sum(axis=1) - a.areas.ravel()).max() < 1e-15
    assert np.abs(shared(b, a).T - areas).max() < 1e-16


def test_a_mesh_cut_from_itself_is_itself():
    for make in SURFACES.values():
        surface = make()
        areas = shared(surface, surface)
        diagonal = np.diag(areas)
        assert np.abs(diagonal / surface.areas.ravel() - 1).max() < 1e-11
        assert np.abs(areas - np.diag(diagonal)).max() < 1e-15


def oracle_mesh(nodes, cells, kinds):
    mesh = mc.MEDCouplingUMesh("mesh", 2)
    mesh.setCoords(mc.DataArrayDouble(np.ascontiguousarray(nodes)))
    mesh.allocateCells(len(cells))
    for kind, cell in zip(kinds, cells, strict=True):
        mesh.insertNextCell(kind, [int(node) for node in cell])
    mesh.finishInsertingCells()
    return mesh


def oracle_ring(inner, outer, sectors=4):
    """A ring as sectors with arcs; their sense is the one in which medcoupling's areas add up."""
    nodes, cells = [], []
    for k in range(sectors):
        begin, end = 2 * np.pi * k / sectors, 2 * np.pi * (k + 1) / sectors
        middle, mean = 0.5 * (begin + end), 0.5 * (inner + outer)
        places = [(inner, begin), (outer, begin), (outer, end), (inner, end)]
        places += [(mean, begin), (outer, middle), (mean, end), (inner, middle)]
        cells.append(range(len(nodes), len(nodes) + 8))
        nodes += [(r * np.cos(t), r * np.sin(t)) for r, t in places]
    return oracle_mesh(np.array(nodes), cells, [mc.NORM_QPOLYG] * sectors)


def oracle_of(surface):
    cells = surface.cells.corners
    is_triangle = cells[:, 2] == cells[:, 3]
    kinds = [mc.NORM_TRI3 if three else mc.NORM_QUAD4 for three in is_triangle]
    cells = [cell[:3] if three else cell for cell, three in zip(cells, is_triangle, strict=True)]
    return oracle_mesh(surface.cells.nodes, cells, kinds)


def oracle_areas(a, b, shape):
    """Areas that cells of a and b share, shape (cells of a, cells of b), by medcoupling."""
    remapper = mc.MEDCouplingRemapper()
    remapper.setPrecision(1e-14)
    remapper.setIntersectionType(mc.Geometric2D)
    remapper.prepare(b, a, "P0P0")
    areas = np.zeros(shape)
    for i, row in enumerate(remapper.getCrudeMatrix()):
        for j, area in row.items():
            areas[i, j] = abs(area)
    return areas


@pytest.mark.parametrize("first", ["triangles", "quads", "tiles"])
def test_polygons_are_cut_as_an_independent_code_cuts_them(first):
    a, b = SURFACES[first](), random_triangles(5, 60, -0.9, 1.3)
    expected = oracle_areas(oracle_of(a), oracle_of(b), (a.size, b.size))
    assert np.abs(shared(a, b) - expected).max() < 1e-15


@pytest.mark.parametrize("second", ["triangles", "quads", "tiles"])
def test_rings_are_cut_as_an_independent_code_cuts_them(second):
    ring, other = Surface.ring_edges([0.3, 0.9]), SURFACES[second]()
    sectors = oracle_areas(oracle_ring(0.3, 0.9), oracle_of(other), (4, other.size))
    assert np.abs(shared(ring, other)[0] - sectors.sum(axis=0)).max() < 1e-15


def test_discs_share_lenses():
    # Unit discs whose centres are on each other's rims: 2π/3 − √3/2
    assert lens(1.0, 1.0, 1.0) == pytest.approx(2 * np.pi / 3 - np.sqrt(3) / 2, abs=1e-15)
    assert lens(1.0, 3.0, 0.5) == pytest.approx(np.pi, abs=1e-15)
    assert lens(1.0, 3.0, 4.0) == 0
    # Disc of radius 2 about the origin, of radius 1 about (2, 0): 60° sectors less their triangles
    angle_a, angle_b = np.arccos(7 / 8), np.arccos(1 / 4)
    area = 4 * angle_a + angle_b - 0.5 * np.sqrt(15)
    assert lens(2.0, 1.0, 2.0) == pytest.approx(area, abs=1e-14)


def test_rings_about_different_axes_share_what_a_fine_mesh_says():
    a, b = Surface.rings(3, 0.6, (0.1, 0.0)), Surface.rings(4, 0.7, (-0.1, 0.2))
    areas = shared(a, b)
    fine = Surface.tiles((800, 800), (2.0, 2.0)).cells.centroids
    i, j = a.cells.contains(fine), b.cells.contains(fine)
    on = (i >= 0) & (j >= 0)
    counted = np.bincount(i[on] * 4 + j[on], minlength=12).reshape(3, 4) * (2 / 800) ** 2
    assert np.abs(areas - counted).max() < 2e-3
    assert areas.sum() == pytest.approx(float(lens(0.6, 0.7, np.hypot(0.2, 0.2))), abs=1e-15)


def test_first_moments_of_what_circles_cut_are_those_of_closed_forms():
    # Half disc x > 0 of radius R: area πR²/2, moment 2R³/3 along x
    square = np.array([[[0, -5.0], [5, -5], [5, 5], [0, 5]]])
    area, moment = in_discs(np.array([2.0]), square)
    assert area[0] == pytest.approx(2 * np.pi, rel=1e-15)
    assert moment[0] == pytest.approx([16 / 3, 0], abs=1e-14)
    # The other way round, with the other sign
    area, moment = in_discs(np.array([2.0]), square[:, ::-1])
    assert area[0] == pytest.approx(-2 * np.pi, rel=1e-15)
    # Moments of all pieces of a mesh about the axis add up to those of the ring: nothing
    mesh = random_triangles(7, 200)
    pieces = cut_polygons(Surface.ring_edges([0.1, 0.9]).cells, mesh.cells.points)
    assert np.abs(pieces.moment.sum(axis=0)).max() < 1e-15


@pytest.mark.parametrize("metres", [1e-9, 1e-6, 1.0, 1e6])
@pytest.mark.parametrize("far", [0.0, 1e3])
def test_cutting_does_not_depend_on_size_or_place(metres, far):
    """Far away, places themselves are rounded to 1e-16 of their distance."""
    mesh = random_triangles(3, 150)
    nodes = metres * (mesh.cells.nodes + far)
    moved = Surface.triangles(nodes, mesh.cells.corners[:, :3])
    at = (metres * far, metres * far)
    for target in (
        Surface.rings(7, 0.9 * metres, at),
        Surface.tiles((5, 8), (2 * metres, 2 * metres), at),
        Surface.triangles(nodes, mesh.cells.corners[:, :3]),
    ):
        areas = shared(target, moved).sum(axis=1) / target.areas.ravel()
        assert np.abs(areas - 1).max() < (1e-8 if far else 1e-11)


def test_graded_meshes_cost_what_even_ones_do():
    """Cells that differ a millionfold in size, on both sides."""
    rng = np.random.default_rng(4)
    radius, angle = 10 ** rng.uniform(-6, 0, 4000), rng.uniform(0, 2 * np.pi, 4000)
    nodes = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
    hull = [[-2, -2], [-2, 2], [2, -2], [2, 2]]
    a = np.concatenate([nodes[::2], hull])
    b = np.concatenate([nodes[1::2], hull])
    a, b = (Surface.triangles(n, Delaunay(n).simplices) for n in (a, b))
    areas = shared(a, b)
    assert np.count_nonzero(areas) < 20 * (a.size + b.size)
    assert np.abs(areas.sum(axis=0) / b.areas - 1).max() < 1e-9
    assert areas.sum() == pytest.approx(16, rel=1e-14)


@pytest.mark.parametrize(
    ("nodes", "cells", "words"),
    [
        ([[0, 0], [1, 0], [1, 1]], [[0, 1, 3]], "cell 0 names node 3 of 3"),
        ([[0, 0], [1, 0], [2, 0]], [[0, 1, 2]], "cell 0 at .* has no area"),
        ([[0, 0], [2, 0], [0.5, 0.5], [0, 2]], [[0, 1, 2, 3]], "cell 0 at .* is not convex"),
        ([[0, 0], [1, np.nan], [1, 1]], [[0, 1, 2]], "point 1 is .* no place"),
        ([[0, 0, 0], [1, 0, 0], [1, 1, 1e-3]], [[0, 1, 2]], "node 2 at z = 0.001 m lies 0.001 m"),
        ([[0, 0], [1, 0], [1, 1]], [[0.0, 1.0, 2.0]], "numbers of nodes are needed"),
    ],
)
def test_cells_that_are_none_are_refused(nodes, cells, words):
    make = Surface.quads if len(cells[0]) == 4 else Surface.triangles
    with pytest.raises(SurfaceError, match=words):
        make(np.array(nodes, float), np.array(cells))


def test_cells_may_go_round_either_way():
    nodes = np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])
    for cells in ([[0, 1, 2, 3]], [[3, 2, 1, 0]]):
        assert Surface.quads(nodes, np.array(cells)).areas == pytest.approx([1.0])
    assert Surface.triangles(nodes, np.array([[2, 1, 0], [0, 2, 3]])).areas == pytest.approx(
        [0.5, 0.5]
    )
