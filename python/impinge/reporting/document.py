"""Parts of the document of a report; `cli/src/report/document.rs` has their meaning."""

from __future__ import annotations

import base64
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

import impinge

FORMAT = 1
MISSING = 65535
MOST_NUMBERS = 50_000
"""Of all curves together."""
FEWEST_ROWS = 200
MOST_VALUES = 200_000
"""Of all maps together."""
GROUPS = {
    "K": "Temperature",
    "Pa": "Stress and pressure",
    "W/m2": "Heat flux",
    "W": "Heat flow",
    "J": "Heat and energy",
    "m": "Length",
    "m/s": "Speed",
    "1/s": "Shear rate",
    "N": "Force",
    "N.s": "Impulse",
    "kg": "Mass",
    "kg.m/s": "Momentum and impulse",
    "1": "Shares and counts",
}


def document(title: str, description: str, **parts: Any) -> dict[str, Any]:
    """A document with these parts; the others are empty."""
    made = {"format": FORMAT, "title": title, "description": description}
    return {**made, "made_by": f"impinge {impinge.__version__} for Python", **parts}


def fact(label: str, text: Any) -> dict[str, str]:
    return {"label": label, "text": str(text)}


def warning(message: str, place: str = "", id: str = "") -> dict[str, str]:
    return {"kind": "warning", "place": place, "message": message, "remedy": "", "id": id}


def numbers(values: Any) -> list[float | None]:
    """Numbers of seven digits; those that are not finite are missing."""
    flat = np.asarray(values, float).ravel()
    return [float(f"{value:.7g}") if np.isfinite(value) else None for value in flat]


def packed(values: Any) -> dict[str, Any]:
    """Values to 1/65534 of their range."""
    flat = np.asarray(values, float).ravel()
    is_there = np.isfinite(flat)
    low, high = (flat[is_there].min(), flat[is_there].max()) if is_there.any() else (0.0, 0.0)
    scale = (MISSING - 1) / (high - low) if high > low else 0.0
    codes = np.full(flat.shape, MISSING, dtype="<u2")
    codes[is_there] = np.rint((flat[is_there] - low) * scale).astype("<u2")
    data = base64.b64encode(codes.tobytes()).decode()
    return {"low": float(low), "high": float(high), "data": data}


def unit_of(attributes: Mapping[str, Any]) -> str:
    return str(attributes.get("units") or "1")


def about(attributes: Mapping[str, Any]) -> str:
    return str(attributes.get("long_name") or attributes.get("description") or "")


def group(unit: str) -> str:
    """Title of the chart of values of a unit."""
    return GROUPS.get(unit, f"Values in {unit}")


def series(name: str, unit: str, meaning: str, values: Any) -> dict[str, Any]:
    """A curve."""
    told = {"name": name, "unit": unit, "group": group(unit), "about": meaning}
    return {**told, "values": numbers(values)}


def axis(name: str, unit: str, values: Any, ends: Sequence[float] | None = None) -> dict[str, Any]:
    told = {"name": name, "unit": unit, "values": numbers(values)}
    return told if ends is None else {**told, "ends": [float(end) for end in ends]}


def thinned(count: int, most: int) -> np.ndarray:
    """At most so many of `count` places, evenly, with the first and the last."""
    most = max(most, 2)
    if count <= most:
        return np.arange(count)
    return np.arange(most) * (count - 1) // (most - 1)


def cell(value: float, unit: str) -> Any:
    """A number of a table with its unit; nothing where it is not finite."""
    return {"value": float(value), "unit": unit} if np.isfinite(value) else None


def ranges(rows: Sequence[tuple[str, str, str, np.ndarray]]) -> dict[str, Any]:
    """Lowest, highest and last values of variables: name, unit, meaning, values over time."""
    table = []
    for name, unit, meaning, values in rows:
        finite = values[np.isfinite(values)]
        low, high = (finite.min(), finite.max()) if finite.size else (np.nan, np.nan)
        last = values[-1] if values.ndim == 1 and values.size else np.nan
        table.append([name, *(cell(value, unit) for value in (low, high, last)), meaning])
    head = ["variable", "lowest", "highest", "at the end", "meaning"]
    return {"title": "", "head": [{"name": name, "unit": ""} for name in head], "rows": table}
