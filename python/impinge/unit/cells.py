"""`resources/cells.json`: where the cells lie that arrays of a unit belong to."""

from __future__ import annotations

import re
from collections.abc import Mapping
from math import isfinite, prod
from typing import Any

import numpy as np

from impinge.reading import parse_json
from impinge.unit.variable import indices_of, stem_of

PLACE = "resources/cells.json"
_PER_CELL = ("area", "inner", "outer", "x", "y", "z")


def parse_cells(content: bytes) -> dict[str, dict[str, Any]]:
    """Returns the families of a file by name.

    Raises `ValueError` with the family and the key for what is none: counts that are not whole or
    go with another number of places, numbers that are not finite, extents that are not positive.
    """
    told = parse_json(content)
    families = told.get("families") if isinstance(told, dict) else None
    if not isinstance(families, dict):
        raise ValueError("holds no table `families`")
    for name, family in families.items():
        try:
            _check(family)
        except ValueError as error:
            raise ValueError(f"family `{name}`: {error}") from None
    return families


def place_of(
    families: Mapping[str, dict[str, Any]], name: str
) -> tuple[str, tuple[int, ...]] | None:
    """Finds the family that `name` denotes, its own name or that of one of its variables, and
    the indices of the element, from 1; there are none for a whole array. Names are structured,
    `patch.heat_flux[1,2]`, or flat, `patch_heat_flux_1_2`. Returns None if no family matches.
    """
    stem, indices = stem_of(name), indices_of(name)
    for key in (name, stem, stem.rpartition(".")[0]):
        if key in families:
            return key, indices
    for key, family in families.items():
        for quantity in family["quantities"]:
            flat = re.escape(f"{key}.{quantity}".replace(".", "_"))
            found = re.fullmatch(rf"{flat}((?:_[1-9][0-9]*)*)", stem)
            if found:
                return key, indices or tuple(map(int, found[1].split("_")[1:]))
    return None


def areas_of(family: Mapping[str, Any], indices: tuple[int, ...]) -> np.ndarray:
    """The areas [m²] of all cells, or of the one with these indices, counted from 1; none where
    the family does not tell them.
    """
    areas = np.asarray(family.get("area", []), float).ravel()
    count = tuple(family.get("count", ()))
    if len(indices) != len(count) or prod(count) != len(areas) or not indices:
        return areas
    place = np.ravel_multi_index([index - 1 for index in indices], count)
    return areas[[place]]


def is_per_depth(family: Mapping[str, Any]) -> bool:
    """True if areas are per metre of depth [m]: widths of tiles, as of walls of plane drops."""
    areas, size = family.get("area", []), family.get("size")
    if family.get("kind") != "wall" or not len(areas) or size is None:
        return False
    return np.allclose(areas, size[0], rtol=1e-9, atol=0.0)


def _check(family: Any) -> None:
    if not isinstance(family, dict):
        raise ValueError("is no table")
    if not isinstance(family.get("footprint"), str):
        raise ValueError("has no `footprint`")
    for key in ("inputs", "outputs"):
        words = family.get(key, [])
        if not (isinstance(words, list) and all(isinstance(word, str) for word in words)):
            raise ValueError(f"`{key}` is no list of names")
    lists = {key: _numbers(key, family[key]) for key in _PER_CELL if key in family}
    cells = _cells(family["count"]) if "count" in family else None
    for key, values in lists.items():
        cells = len(values) if cells is None else cells
        if len(values) != cells:
            raise ValueError(f"`{key}` has {len(values)} values for {cells} cells")
    if "at" in family and len(_numbers("at", family["at"])) != 2:
        raise ValueError("`at` is no place [x, y]")
    if "size" in family:
        size = _numbers("size", family["size"])
        if len(size) != 2 or min(size) <= 0.0:
            raise ValueError("`size` is no pair of lengths above 0 m")
    if min(lists.get("area", []), default=0.0) < 0.0:
        raise ValueError("`area` has a value below 0 m2")


def _cells(count: Any) -> int:
    is_count = isinstance(count, list) and len(count) <= 2
    if not (is_count and all(isinstance(n, int) and 1 <= n < 2**31 for n in count)):
        raise ValueError("`count` is none of [], [n] and [n, m] with whole numbers above 0")
    return prod(count)


def _numbers(key: str, values: Any) -> list[float]:
    if not isinstance(values, list):
        raise ValueError(f"`{key}` is no list of numbers")
    for value in values:
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        if not (is_number and isfinite(value)):
            raise ValueError(f"`{key}` holds {str(value)[:40]}, which is no finite number")
    return values
