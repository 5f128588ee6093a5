"""Densities from nodes to nodes: products of linear functions, against closed forms."""

import numpy as np
import pytest
from impinge.surface import Surface, SurfaceError
from impinge.surface.conservative import nodal_areas
from impinge.surface.products import nodes_by_nodes
from test_surface_cutting import random_quads, random_triangles

MESHES = {
    "triangles": lambda: random_triangles(1, 300).on_points(),
    "others": lambda: random_triangles(2, 90).on_points(),
    "quads": lambda: random_quads(3).on_points(),
    "even quads": lambda: even(8, 2.0, -1.0),
}
PAIRS = [(a, b) for a in MESHES for b in MESHES]


def even(count, size, low=0.0):
    """A regular grid of count² nodes and the quadrilaterals between them."""
    line = low + np.linspace(0, size, count)
    x, y = np.meshgrid(line, line, indexing="ij")
    i = np.arange(count * count).reshape(count, count)
    corners = [i[:-1, :-1], i[1:, :-1], i[1:, 1:], i[:-1, 1:]]
    cells = np.column_stack([each.ravel() for each in corners])
    return Surface.quads(np.column_stack([x.ravel(), y.ravel()]), cells, values="points")


def linear_moments(surface, values):
    """``∫ φ_n f dA`` of a function f that is linear on each triangle: A/12 (Σ f + f_n)."""
    corners, _ = surface.cells.triangles
    p = surface.cells.nodes[corners]
    a, b = (p[:, 1:] - p[:, :1]).transpose(1, 0, 2)
    area = (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2
    f = values[corners]
    parts = area[:, None] / 12 * (f.sum(axis=1, keepdims=True) + f)
    return np.bincount(corners.ravel(), parts.ravel(), minlength=surface.size)


@pytest.mark.parametrize(("source", "target"), PAIRS)
def test_products_of_linear_functions_are_exact(source, target):
    """A linear function is what its nodal values say on both meshes: so are its moments."""
    source, target = MESHES[source](), MESHES[target]()
    matrix = nodes_by_nodes(target.cells, source.cells, 1e-9)
    assert matrix.min() >= -1e-17
    for f in (lambda x, y: 1 + 0 * x, lambda x, y: x, lambda x, y: 3 * x - 2 * y):
        on_source = f(*source.cells.nodes.T)
        on_target = f(*target.cells.nodes.T)
        size = np.abs(on_source).max()
        columns, rows = matrix.T @ on_target, matrix @ on_source
        assert np.abs(columns - linear_moments(source, on_source)).max() < 1e-13 * size
        assert np.abs(rows - linear_moments(target, on_target)).max() < 1e-13 * size


@pytest.mark.parametrize(("source", "target"), PAIRS)
def test_constants_stay_constants_and_integrals_are_kept(source, target):
    source, target = MESHES[source](), MESHES[target]()
    move = source.map_to(target)
    assert move(np.ones(source.size)) == pytest.approx(np.ones(target.size), rel=1e-12)
    values = np.random.default_rng(4).uniform(1.0, 2.0, (3, source.size))
    result = move(values)
    assert target.integral(result) == pytest.approx(source.integral(values), rel=1e-12)
    assert result.min() >= 1.0 - 1e-12 and result.max() <= 2.0 + 1e-12  # means of values


@pytest.mark.parametrize(("coarse", "fine"), [(5, 8), (8, 5), (5, 9), (3, 40)])
def test_grids_of_millimetres_far_from_the_origin(coarse, fine):
    source, target = even(coarse, 1e-3, 0.25), even(fine, 1e-3, 0.25)
    result = source.map_to(target)(np.full(source.size, 7e6))
    assert result == pytest.approx(np.full(target.size, 7e6), rel=1e-10)
    total = nodal_areas(target.cells) @ result
    assert total == pytest.approx(7e6 * 1e-6, rel=1e-12)


def test_what_lies_off_is_told_and_counted():
    source, target = even(9, 1.0), even(5, 0.5)
    with pytest.raises(SurfaceError, match="lies off the target"):
        source.map_to(target)(np.ones(source.size))
    drop = source.map_to(target, outside="drop")
    assert drop(np.ones(source.size)) == pytest.approx(np.ones(target.size), rel=1e-12)
    assert drop.lost(np.ones(source.size)) == pytest.approx(0.75, rel=1e-12)
    apart = even(4, 0.5, 3.0).map_to(target, outside="drop")
    assert apart(np.ones(16)) == pytest.approx(np.zeros(target.size))
    # A seam below the tolerance is no loss.
    wider = even(7, 1.0 + 1e-8)
    kept = wider.map_to(source)(np.ones(wider.size))
    assert source.integral(kept) == pytest.approx(wider.integral(np.ones(wider.size)), rel=1e-12)


@pytest.mark.parametrize(
    ("make", "told"),
    [
        (lambda: Surface.rings(2.7, 1.0), "rings: a count of 2.7; whole numbers are needed"),
        (lambda: Surface.rings(np.nan, 1.0), "rings: a count of nan"),
        (lambda: Surface.rings("3", 1.0), "rings: a count of '3'"),
        (lambda: Surface.tiles((2.5, 2), (1.0, 1.0)), "tiles: a count of 2.5"),
        (lambda: Surface.grid((2, 2.5), (1.0, 1.0)), "tiles: a count of 2.5"),
        (lambda: Surface.tiles((2,), (1.0, 1.0)), r"tiles: counts \(nx, ny\) are needed"),
        (lambda: triangle([0, 1, -1]), "cell 0 names node -1 of 3, which count from 0 to 2"),
        (lambda: triangle([0, 1, 3]), "cell 0 names node 3 of 3, which count from 0 to 2"),
    ],
)
def test_counts_and_numbers_of_nodes_that_are_none_are_refused(make, told):
    with pytest.raises(SurfaceError, match=told):
        make()


def triangle(corners):
    return Surface.triangles(np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]), np.array([corners]))


def test_whole_numbers_of_any_type_are_counts():
    assert Surface.rings(np.float64(3.0), 1.0).shape == (3,)
    assert Surface.tiles(np.array([2, 3]), (1.0, 1.0)).shape == (2, 3)
