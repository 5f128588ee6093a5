"""Which boxes of two sets overlap."""

from __future__ import annotations

import numpy as np

# Pairs of boxes in one bin beyond which it is cut into smaller bins
MOST_PAIRS = 4096


def overlapping(a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pairs (i, j) of boxes ``a[i]``, ``b[j]`` that overlap or touch, each once.

    Boxes have shape (n, 2, 2): lower and upper corners. The plane is cut into square bins; a pair
    is compared in the bin that holds the larger of its lower corners alone. Bins with many pairs
    are cut further, so that graded meshes cost no more than even ones.
    """
    if not len(a) or not len(b):
        return np.empty(0, int), np.empty(0, int)
    low = np.minimum(a[:, 0].min(axis=0), b[:, 0].min(axis=0))
    high = np.maximum(a[:, 1].max(axis=0), b[:, 1].max(axis=0))
    found = _search(a, b, np.arange(len(a)), np.arange(len(b)), low, high, 0)
    i = np.concatenate([pair[0] for pair in found])
    j = np.concatenate([pair[1] for pair in found])
    order = np.lexsort((j, i))
    return i[order], j[order]


def _search(
    a: np.ndarray,
    b: np.ndarray,
    ia: np.ndarray,
    ib: np.ndarray,
    low: np.ndarray,
    high: np.ndarray,
    depth: int,
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Pairs among boxes `ia`, `ib` whose larger lower corner lies in the window."""
    count, size = _bins(max(len(ia), len(ib)), low, high)
    bin_a, ia = _fill(a, ia, low, size, count)
    bin_b, ib = _fill(b, ib, low, size, count)
    shared, first_a, many_a, first_b, many_b = _join(bin_a, bin_b)
    pairs = many_a * many_b
    crowded = (pairs > MOST_PAIRS) & (depth < 12) & (np.prod(count) > 1)
    found = [
        _compare(a, b, ia, ib, first_a, many_a, first_b, many_b, shared, low, size, count, ~crowded)
    ]
    for k in np.flatnonzero(crowded):
        corner = low + size * np.array(np.unravel_index(shared[k], count))
        inside_a = ia[first_a[k] : first_a[k] + many_a[k]]
        inside_b = ib[first_b[k] : first_b[k] + many_b[k]]
        if min(len(inside_a), len(inside_b)) < 8:
            one = np.arange(len(shared)) == k
            found.append(
                _compare(
                    a, b, ia, ib, first_a, many_a, first_b, many_b, shared, low, size, count, one
                )
            )
            continue
        for i, j in _search(a, b, inside_a, inside_b, corner, corner + size, depth + 1):
            keep = _home(a, b, i, j, low, size, count) == shared[k]
            found.append((i[keep], j[keep]))
    return found


def _bins(boxes: int, low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    extent = np.maximum(high - low, 1e-300)
    size = max(np.sqrt(extent[0] * extent[1] / boxes), extent.max() / max(4 * boxes, 4), 1e-300)
    count = np.clip(np.ceil(extent / size).astype(int), 1, 4 * boxes)
    return count, extent / count


def _place(points: np.ndarray, low: np.ndarray, size: np.ndarray, count: np.ndarray) -> np.ndarray:
    return np.clip(((points - low) / size).astype(int), 0, count - 1)


def _fill(
    boxes: np.ndarray, index: np.ndarray, low: np.ndarray, size: np.ndarray, count: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Bins of the boxes `index`, sorted, and the boxes in them."""
    first = _place(boxes[index, 0], low, size, count)
    last = _place(boxes[index, 1], low, size, count)
    wide = last - first + 1
    who, place = spread(wide[:, 0] * wide[:, 1])
    column = first[who, 0] + place // wide[who, 1]
    row = first[who, 1] + place % wide[who, 1]
    bins = column * count[1] + row
    order = np.argsort(bins, kind="stable")
    return bins[order], index[who[order]]


def _join(bin_a: np.ndarray, bin_b: np.ndarray) -> tuple[np.ndarray, ...]:
    """Bins that both have, with where they begin and how many boxes they hold."""
    in_a, first_a, many_a = np.unique(bin_a, return_index=True, return_counts=True)
    in_b, first_b, many_b = np.unique(bin_b, return_index=True, return_counts=True)
    shared, at_a, at_b = np.intersect1d(in_a, in_b, assume_unique=True, return_indices=True)
    return shared, first_a[at_a], many_a[at_a], first_b[at_b], many_b[at_b]


def _compare(
    a: np.ndarray,
    b: np.ndarray,
    ia: np.ndarray,
    ib: np.ndarray,
    first_a: np.ndarray,
    many_a: np.ndarray,
    first_b: np.ndarray,
    many_b: np.ndarray,
    shared: np.ndarray,
    low: np.ndarray,
    size: np.ndarray,
    count: np.ndarray,
    which: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    first_a, many_a, first_b, many_b = (v[which] for v in (first_a, many_a, first_b, many_b))
    who, place = spread(many_a * many_b)
    i = ia[first_a[who] + place // many_b[who]]
    j = ib[first_b[who] + place % many_b[who]]
    overlap = ((a[i, 0] <= b[j, 1]) & (b[j, 0] <= a[i, 1])).all(axis=1)
    i, j, who = i[overlap], j[overlap], who[overlap]
    keep = _home(a, b, i, j, low, size, count) == shared[which][who]
    return i[keep], j[keep]


def _home(
    a: np.ndarray,
    b: np.ndarray,
    i: np.ndarray,
    j: np.ndarray,
    low: np.ndarray,
    size: np.ndarray,
    count: np.ndarray,
) -> np.ndarray:
    column, row = _place(np.maximum(a[i, 0], b[j, 0]), low, size, count).T
    return column * count[1] + row


def spread(counts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Each number k `counts[k]` times, with 0, 1, … within each."""
    who = np.repeat(np.arange(len(counts)), counts)
    begin = np.cumsum(counts) - counts
    return who, np.arange(len(who)) - begin[who]


def boxes_of(polygons: np.ndarray) -> np.ndarray:
    """Boxes, shape (n, 2, 2), around polygons of shape (n, m, 2)."""
    return np.stack([polygons.min(axis=1), polygons.max(axis=1)], axis=1)
