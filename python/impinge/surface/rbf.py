"""Interpolation between scattered points by compactly supported radial functions.

Around centres that cover the source points, the `neighbours` nearest ones carry

    s(x) = p(x) + Σ wₖ φ(|x − xₖ| / R) ,   s(xₖ) = vₖ ,

with p the polynomial that is nearest to the values, so that linear fields are met to rounding; φ is
Wendland's function of the smoothness that is asked for. The pieces are joined by weights that sum
to one (partition of unity), which leaves a sparse matrix and work in proportion to the number of
points.

Sources: H. Wendland (1995), doi 10.1007/BF02123482 (functions); H. Wendland (2002), in
Approximation Theory X, 473–483 (partition of unity).
"""

from __future__ import annotations

from itertools import product

import numpy as np
from scipy.sparse import csr_matrix
from scipy.spatial import cKDTree
from scipy.spatial.distance import cdist

from .errors import SurfaceError

# Radius of support over that of the piece
SUPPORT = 8.0
# Part of a piece's radius that is to be covered by one of them
COVER = 0.6


def wendland(r: np.ndarray, smoothness: int) -> np.ndarray:
    """Wendland's functions in up to three dimensions, of smoothness C2, C4 or C6; 1 at r = 0.

    ``(1−r)⁴ (4r+1)``, ``(1−r)⁶ (35r²+18r+3)/3``, ``(1−r)⁸ (32r³+25r²+8r+1)`` for r < 1, else 0.
    """
    left = np.maximum(1.0 - r, 0.0)
    match smoothness:
        case 2:
            return left**4 * (4 * r + 1)
        case 4:
            return left**6 * (35 * r**2 + 18 * r + 3) / 3
        case 6:
            return left**8 * (32 * r**3 + 25 * r**2 + 8 * r + 1)
    raise SurfaceError(f"smoothness: {smoothness} is none of 2, 4, 6")


def matrix(
    source: np.ndarray,
    target: np.ndarray,
    smoothness: int = 6,
    degree: int | None = None,
    neighbours: int = 80,
    support: float | None = None,
) -> tuple[csr_matrix, np.ndarray]:
    """Matrix from values at `source`, shape (n, d), to those at `target`, shape (m, d), and whether
    each target lies off the source: farther from all of its points than three times their usual
    distance.

    Parameters
    ----------
    smoothness
        2, 4 or 6 of φ. The smoother, the more accurate where values are smooth, and the more noise
        of single values grows between points that lie unevenly: there 2 is safer.
    degree
        Degree of the polynomial; by default 3 on planes, 1 on curved surfaces.
    neighbours
        Number of points that carry a piece.
    support
        R [m]; by default 8 times the radius of the piece.
    """
    wendland(np.zeros(1), smoothness)
    tree = cKDTree(source)
    _check_apart(source, tree)
    many = min(neighbours, len(source))
    spacing = np.median(
        tree.query(source, k=min(2, len(source)))[0].reshape(len(source), -1)[:, -1]
    )
    nearest = tree.query(target)[0]
    off = nearest > 3.0 * spacing
    centres = _cover(np.concatenate([source, target[~off]]), tree, many, spacing)
    if degree is None:
        degree = 3 if source.shape[1] == 2 else 1
    degree = _degree(degree, source.shape[1], many)
    reach, members = tree.query(centres, k=many)
    reach, members = reach.reshape(len(centres), many), members.reshape(len(centres), many)
    # Within it lie none but the piece's own points: there each piece meets the values.
    radius = reach[:, -1] if many < len(source) else reach[:, -1] + 4.0 * spacing
    places, pieces, shares = _shares(target, off, centres, radius)
    order = np.argsort(pieces, kind="stable")
    places, pieces, shares = places[order], pieces[order], shares[order]
    begin = np.searchsorted(pieces, np.arange(len(centres) + 1))
    weights = np.empty((len(places), many))
    for k, centre in enumerate(centres):
        use = slice(begin[k], begin[k + 1])
        if use.start < use.stop:
            local = (source[members[k]] - centre) / radius[k]
            at = (target[places[use]] - centre) / radius[k]
            scale = radius[k] / support if support else 1.0 / SUPPORT
            weights[use] = _weights(local, at, scale, smoothness, degree)
    data = ((weights * shares[:, None]).ravel(), (np.repeat(places, many), members[pieces].ravel()))
    return csr_matrix(data, shape=(len(target), len(source))), off


def _check_apart(source: np.ndarray, tree: cKDTree) -> None:
    twice = tree.query_pairs(1e-12 * max(np.ptp(source, axis=0).max(), 1e-300))
    if twice:
        i, j = min(twice)
        raise SurfaceError(f"points: {i} and {j} are the same place, {source[i]} m")


def _cover(points: np.ndarray, tree: cKDTree, many: int, spacing: float) -> np.ndarray:
    """Centres among `points` within a part of whose reach all of them lie."""
    everyone = cKDTree(points)
    free = np.ones(len(points), bool)
    centres = []
    for k in range(len(points)):
        if not free[k]:
            continue
        centres.append(k)
        reach = np.max(tree.query(points[k], k=many)[0])
        reach = reach if many < tree.n else reach + 4.0 * spacing
        free[everyone.query_ball_point(points[k], COVER * reach)] = False
    return points[centres]


def _shares(
    target: np.ndarray, off: np.ndarray, centres: np.ndarray, radius: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Targets, pieces and the weights by which these are joined; they sum to one for each
    target.
    """
    tree = cKDTree(centres)
    on = np.flatnonzero(~off)
    near = tree.query_ball_point(target[on], radius.max())
    count = np.fromiter((len(n) for n in near), int, len(near))
    places = np.repeat(on, count)
    pieces = np.concatenate([*near, []]).astype(int)
    distance = np.linalg.norm(target[places] - centres[pieces], axis=1) / radius[pieces]
    share = wendland(distance, 2)
    some = share > 1e-6
    places, pieces, share = places[some], pieces[some], share[some]
    total = np.bincount(places, share, minlength=len(target))
    return places, pieces, share / total[places]


def _weights(
    local: np.ndarray, at: np.ndarray, scale: float, smoothness: int, degree: int
) -> np.ndarray:
    """Weights of values at `local` points in the value at each of `at`; shape (len(at),
    len(local)).

    The linear field nearest to the values, the polynomial nearest to what is left of them, and the
    kernel's interpolant of the rest: ``p₁ P₁⁺ + [p P⁺ + k K⁻¹ (1 − P P⁺)] (1 − P₁ P₁⁺)`` with K
    the kernel between the points, k that to the target, P and p polynomials there. So the condition
    of K, or of P where points all but lie on a plane, costs linear fields nothing.
    """
    kernel = wendland(cdist(local, local) * scale, smoothness)
    reach = wendland(cdist(at, local) * scale, smoothness)
    try:
        weights = np.linalg.solve(kernel, reach.T).T
    except np.linalg.LinAlgError:
        weights = np.linalg.lstsq(kernel, reach.T)[0].T
    for order in sorted({degree, min(degree, 1)}, reverse=True):
        powers = _powers(local.shape[1], order)
        left, singular, right = np.linalg.svd(_terms(local, powers), full_matrices=False)
        # On a line, a plane or a quadric terms depend on each other: those that do are left out.
        some = singular > 1e-10 * singular[0]
        left, right = left[:, some], right[some].T / singular[some]
        weights = weights + (_terms(at, powers) @ right - weights @ left) @ left.T
    return weights


def _degree(degree: int, dimensions: int, many: int) -> int:
    """The degree, or the highest one that so few points leave well determined."""
    while degree > 1 and 2 * len(_powers(dimensions, degree)) > many:
        degree -= 1
    return degree if len(_powers(dimensions, degree)) <= many else 0


def _powers(dimensions: int, degree: int) -> np.ndarray:
    """Exponents of all monomials up to a degree; shape (terms, dimensions)."""
    every = product(range(degree + 1), repeat=dimensions)
    return np.array([powers for powers in every if sum(powers) <= degree])


def _terms(points: np.ndarray, powers: np.ndarray) -> np.ndarray:
    return np.prod(points[:, None, :] ** powers, axis=2)
