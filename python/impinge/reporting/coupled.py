"""The document of a coupled run."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from impinge.reporting.document import (
    FEWEST_ROWS,
    MOST_NUMBERS,
    MOST_VALUES,
    about,
    axis,
    document,
    fact,
    numbers,
    packed,
    ranges,
    series,
    thinned,
    unit_of,
    warning,
)
from impinge.results import notes_of_master

ENERGY = "energy_"
MOST_FIGURES = 6
MAP_TIMES, PROFILE_TIMES = 30, 200


def coupled(result: xr.Dataset) -> dict[str, Any]:
    """The record of a master, with balances and notes."""
    told = result.attrs
    names = [key.removeprefix("unit.") for key in told if key.startswith("unit.")]
    recorded = {str(n): a for n, a in result.data_vars.items() if not str(n).startswith(ENERGY)}
    single = {name: array for name, array in recorded.items() if array.dims == ("time",)}
    arrays = {name: array for name, array in recorded.items() if array.ndim > 1}
    seconds = float(told.get("seconds", 0.0))
    return document(
        f"Coupled run of {_joined(names)}",
        f"{told['steps']} steps to {result['time'].values[-1]:g} s, scheme {told['scheme']}",
        source=[fact("impinge", told.get("impinge", "")), *_units(told, names)],
        scenes=[
            {"name": key.removeprefix("scene."), "text": str(text)}
            for key, text in told.items()
            if key.startswith("scene.") and text
        ],
        figures=_figures(recorded),
        warnings=[warning(note) for note in notes_of_master(told)],
        model=[{"title": "Coupling", "facts": _coupling(told), "lines": [], "tables": []}],
        maps=[made for made in (_map(result, a, len(arrays)) for a in arrays.values()) if made],
        histories=_histories(result, single),
        tables=[
            ranges([(n, unit_of(a.attrs), about(a.attrs), a.values) for n, a in recorded.items()])
        ],
        balances=_balances(result),
        timings=[{"label": "all steps of all units", "seconds": seconds}] if seconds else [],
    )


def _joined(names: list[str]) -> str:
    return " and ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)


def _units(told: dict[str, Any], names: list[str]) -> list[dict[str, str]]:
    return [fact(f"unit {name}", told[f"unit.{name}"]) for name in names]


def _coupling(told: dict[str, Any]) -> list[dict[str, str]]:
    """Facts on the coupling of units and its cost."""
    words = {
        "scheme": "scheme",
        "acceleration": "acceleration",
        "order": "degree of inputs over a step",
        "extrapolation": "degree of extrapolation",
        "tolerance": "tolerance",
        "order_of_units": "order of units",
        "algebraic_loops": "algebraic loops",
        "steps": "steps",
        "rejected": "steps repeated shorter",
        "iterations": "iterations",
        "most_iterations": "most iterations of a step",
        "unconverged": "steps without convergence",
        "path_error": "error of paths over steps, share of their range",
        "energy_error": "error of energies, share of a swing",
        "held_inputs": "units whose inputs are held over steps",
    }
    return [fact(label, told[key]) for key, label in words.items() if told.get(key, "") != ""]


def _figures(recorded: dict[str, xr.DataArray]) -> list[dict[str, Any]]:
    """The highest temperatures and stresses."""
    found = []
    for name, array in recorded.items():
        unit = unit_of(array.attrs)
        if unit not in ("K", "Pa") or not np.isfinite(array.values).any():
            continue
        place = np.unravel_index(np.nanargmax(array.values), array.shape)
        when = f"at {array['time'].values[place[0]]:.4g} s"
        value = float(array.values[place])
        found.append({"label": f"Highest {name}", "value": value, "unit": unit, "note": when})
    return found[:MOST_FIGURES]


def _histories(result: xr.Dataset, single: dict[str, xr.DataArray]) -> dict[str, Any] | None:
    if not single:
        return None
    times = result["time"].values
    rows = thinned(len(times), max(MOST_NUMBERS // (len(single) + 1), FEWEST_ROWS))
    note = f"{len(rows)} of {len(times)} rows are drawn." if len(rows) < len(times) else ""
    curves = [
        series(name, unit_of(array.attrs), about(array.attrs), array.values[rows])
        for name, array in single.items()
    ]
    return {"axis": axis("time", "s", times[rows]), "note": note, "series": curves}


def _map(result: xr.Dataset, array: xr.DataArray, count: int) -> dict[str, Any] | None:
    """An array over time: a profile of one dimension, a map of cells of two."""
    name, unit, times = str(array.name), unit_of(array.attrs), array["time"].values
    size = int(np.prod(array.shape[1:]))
    most = MOST_VALUES // count // max(size, 1)
    title = ": ".join(filter(None, (name, about(array.attrs))))
    told = {"title": title, "is_cells": True, "marks": [], "focus": None}
    value = {"name": name, "unit": unit}
    if array.ndim == 2:
        rows = thinned(len(times), min(PROFILE_TIMES, most))
        across, up = axis("time", "s", times[rows]), _radii(result, name, array.shape[1])
        fields = [{**value, "values": packed(array.values[rows].T)}]
        return {**told, "layout": "profile", "axes": [across, up], "times": [], "fields": fields}
    axes = [_along(result, array, dim) for dim in (1, 2)] if array.ndim == 3 else [None]
    if None in axes:
        return None
    rows = thinned(len(times), min(MAP_TIMES, most))
    fields = [{**value, "values": packed(array.values[rows].transpose(0, 2, 1))}]
    told |= {"layout": "grid", "axes": axes, "times": numbers(times[rows])}
    return {**told, "fields": fields}


def _radii(result: xr.Dataset, name: str, count: int) -> dict[str, Any]:
    """Radii of rings; places by number where the unit has none."""
    keys = [f"{name}:{what}" for what in ("r", "inner", "outer")]
    if all(key in result.coords for key in keys):
        middle, inner, outer = (result.coords[key].values for key in keys)
        return axis("r", "m", middle, [inner[0], outer[-1]])
    return axis("place", "1", np.arange(1, count + 1))


def _along(result: xr.Dataset, array: xr.DataArray, dim: int) -> dict[str, Any] | None:
    """Middles of cells along a dimension: the coordinate that ascends along it."""
    for letter in "xyz":
        key = f"{array.name}:{letter}"
        if key not in result.coords:
            continue
        places = result.coords[key]
        if array.dims[dim] not in places.dims:
            continue
        others = {d: 0 for d in places.dims if d != array.dims[dim]}
        line = places.isel(others).values
        if len(line) == 1 or (np.diff(line) > 0).all():
            return axis(letter, "m", line)
    return None


def _balances(result: xr.Dataset) -> list[dict[str, Any]]:
    """Energies that have left by connections, and what of them has not arrived."""
    found = []
    for key in result.data_vars:
        name = str(key).removeprefix(f"{ENERGY}passed.")
        missing = f"{ENERGY}residual.{name}"
        if name == str(key) or missing not in result:
            continue
        terms = [
            {"label": "has left", "value": float(result[key].values[-1])},
            {"label": "has not arrived", "value": float(result[missing].values[-1])},
        ]
        unit = result[key].attrs.get("units", "J")
        told = {"title": f"Energy by {name}", "unit": unit, "terms": terms, "expected": None}
        about_it = "The share is the largest at any time, of all that was moved."
        residual = float(result.attrs[missing])
        found.append({**told, "residual": residual, "about": about_it})
    return found
