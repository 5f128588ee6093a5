"""What a coupled run leaves: values of outputs over time as an xarray dataset with units."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray

import impinge.results  # noqa: F401 - gives datasets `result.impinge`
from impinge.errors import UnitError
from impinge.master.any_unit import AnyUnit
from impinge.master.connection import split
from impinge.master.energy import Balance
from impinge.unit import Variable

_ENERGIES = {
    "passed": "energy that has left by the connection since the start",
    "residual": "the part of it that has not arrived",
}


class Record:
    """Rows of values at accepted points of time."""

    def __init__(self, units: Mapping[str, AnyUnit], names: Sequence[str]):
        self._units = units
        wanted: dict[str, list[str]] = {}
        for name in dict.fromkeys(names):
            unit, variable = split(name, units)
            wanted.setdefault(unit, []).append(variable)
        self.names = [f"{unit}.{name}" for unit, names in wanted.items() for name in names]
        self._readers = {unit: units[unit].reader(names) for unit, names in wanted.items()}
        self.clear()

    def clear(self) -> None:
        """Forgets all rows."""
        self.times: list[float] = []
        self._rows: dict[str, list[np.ndarray]] = {unit: [] for unit in self._readers}
        self._energies: list[list[tuple[float, float]]] = []

    def add(self, time: float, balances: Sequence[Balance]) -> None:
        """A row of what all units say now."""
        self.times.append(time)
        for unit, reader in self._readers.items():
            self._rows[unit].append(reader().copy())
        self._energies.append([(balance.passed, balance.residual) for balance in balances])

    def dataset(self, balances: Sequence[Balance], attributes: Mapping[str, Any]) -> xarray.Dataset:
        """All rows. Arrays have dimensions of their own, with the places of their cells where the
        unit tells them."""
        arrays: dict[str, Any] = {}
        coordinates: dict[str, Any] = {"time": ("time", self.times, {"units": "s"})}
        for unit, reader in self._readers.items():
            width = sum(variable.size for variable in reader.variables)
            rows = np.array(self._rows[unit]).reshape(len(self.times), width)
            for variable, place in zip(reader.variables, reader.slices, strict=True):
                name = f"{unit}.{variable.name}"
                dimensions = [f"{name}:{axis}" for axis in range(len(variable.shape))]
                values = rows[:, place].reshape(len(self.times), *variable.shape)
                arrays[name] = (["time", *dimensions], values, _attributes(variable))
                coordinates.update(_coordinates(self._units[unit], variable, dimensions))
        for i, balance in enumerate(balances):
            for j, what in enumerate(("passed", "residual")):
                series = [row[i][j] for row in self._energies]
                about = {"units": balance.unit, "description": _ENERGIES[what]}
                arrays[f"energy_{what}.{balance.name}"] = ("time", series, about)
        return xarray.Dataset(arrays, coordinates, dict(attributes))


def _attributes(variable: Variable) -> dict[str, str]:
    told = {
        "units": variable.unit,
        "quantity": variable.quantity,
        "description": variable.description,
    }
    return {key: value for key, value in told.items() if value}


def _coordinates(unit: AnyUnit, variable: Variable, dimensions: Sequence[str]) -> dict[str, Any]:
    if not variable.shape:
        return {}
    return {**_radii(unit, variable, dimensions), **_places(unit, variable, dimensions)}


def _radii(unit: AnyUnit, variable: Variable, dimensions: Sequence[str]) -> dict[str, Any]:
    """Of rings: the mean radius `r`, and the radii `inner` and `outer` [m]."""
    try:
        cells = unit.cells(variable.name)
    except UnitError:
        return {}
    if "inner" not in cells or "outer" not in cells:
        return {}
    inner, outer = (np.asarray(cells[key], float).ravel() for key in ("inner", "outer"))
    if variable.shape != inner.shape:
        return {}
    key = dimensions[0].rpartition(":")[0]
    radii = {"r": (inner + outer) / 2, "inner": inner, "outer": outer}
    return {f"{key}:{what}": (dimensions, radius, {"units": "m"}) for what, radius in radii.items()}


def _places(unit: AnyUnit, variable: Variable, dimensions: Sequence[str]) -> dict[str, Any]:
    try:
        places = unit.coordinates(variable.name)
    except UnitError:
        return {}
    found = {}
    for axis, values in places.items():
        key = f"{dimensions[0].rpartition(':')[0]}:{axis}"
        if len(variable.shape) == 1 and values.shape == variable.shape:
            found[key] = (dimensions, values, {"units": "m"})
        elif values.shape == variable.shape:
            found[key] = (dimensions, values, {"units": "m"})
        elif values.size == np.prod(variable.shape) and values.size > 1:
            found[key] = (dimensions, values.reshape(variable.shape), {"units": "m"})
    if not found and len(variable.shape) == 2:  # the axes of a grid
        lines = [(a, v) for a, v in places.items() if v.size > 1]
        if [v.size for _, v in lines] == list(variable.shape):
            for dimension, (axis, values) in zip(dimensions, lines, strict=True):
                key = f"{dimension.rpartition(':')[0]}:{axis}"
                found[key] = (dimension, values, {"units": "m"})
    return found
