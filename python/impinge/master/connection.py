"""From an output of one unit to an input of another: units of measurement, gains and maps."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from impinge.master.errors import MasterError
from impinge.unit import Unit, Variable


@dataclass(frozen=True)
class Connection:
    """`target = offset + gain · (source, converted to the target's unit of measurement)`.

    source, target: `unit.variable`, single variables or whole families (arrays) of equal shape; an
        array of one is as good as a single variable.
    gain, offset: numbers or arrays of the target's shape; the offset is in the target's unit.
    map: what makes the target's values (flat) of the source's (flat), where the shapes differ;
        after the conversion of units, before the gain.
    mean: whether the source is a mean over the last step, so that it belongs to the whole step
        rather than to its end. What is left out is read from the description of impinge's units.
    scale: of which residuals and errors are a share; if left out, the largest magnitude at the
        start, at the ends of accepted steps and of what is judged, but not of earlier guesses.
    """

    source: str
    target: str
    gain: Any = 1.0
    offset: Any = 0.0
    map: Callable[[np.ndarray], np.ndarray] | None = None
    mean: bool | None = None
    scale: float | None = None


class Link:
    """A connection whose names have been found: the transfer between two units' flat arrays.

    `place` are the target's places among all inputs that the master sets.
    """

    def __init__(self, connection: Connection, units: Mapping[str, Unit]):
        self.connection = connection
        self.source_unit, self.source = split(connection.source, units)
        self.target_unit, self.target = split(connection.target, units)
        source = units[self.source_unit].variable(self.source)
        target = units[self.target_unit].variable(self.target)
        self._check(source, target)
        self.size = target.size
        factor, shift = conversion(units, self.source_unit, source, self.target_unit, target)
        gain = np.broadcast_to(np.asarray(connection.gain, float), target.shape).ravel()
        offset = np.broadcast_to(np.asarray(connection.offset, float), target.shape).ravel()
        self._factor, self._shift = (factor, shift) if connection.map else (1.0, 0.0)
        self._gain = gain if connection.map else gain * factor
        self._offset = offset if connection.map else offset + gain * shift
        self.is_plain = not connection.map and (self._gain == 1).all() and not self._offset.any()
        self.is_real = source.is_real and target.is_real and target.variability == "continuous"
        own = (units[self.source_unit].package.description.generationTool or "").startswith(
            "impinge"
        )
        told = own and "mean over the last step" in source.description
        self.is_mean = told if connection.mean is None else connection.mean
        self.nominal = abs(target.nominal)
        self.place = slice(0, 0)
        self.largest = 0.0  # magnitude at the start and at the ends of accepted steps

    def _check(self, source: Variable, target: Variable) -> None:
        what = f"{self.connection.source} -> {self.connection.target}"
        if target.causality != "input":
            raise MasterError(f"{what}: the target is no input, but {target.causality}")
        if source.causality in ("parameter", "structuralParameter", "input"):
            raise MasterError(f"{what}: the source is no output, but {source.causality}")
        if not (source.is_number and target.is_number):
            raise MasterError(f"{what}: only numbers are passed on")
        same = source.shape == target.shape or source.size == target.size == 1
        if self.connection.map is None and not same:
            raise MasterError(
                f"{what}: shapes {source.shape} and {target.shape} differ; a `map` may lead from"
                " one to the other"
            )

    def transfer(self, values: np.ndarray) -> np.ndarray:
        """The target's values that follow from the source's."""
        if self.is_plain:
            return values
        if self.connection.map is not None:
            values = np.ravel(self.connection.map(self._factor * values + self._shift))
            if values.size != self.size:
                raise MasterError(
                    f"the map of {self.connection.source} -> {self.connection.target} gives"
                    f" {values.size} values for {self.size}"
                )
        return self._gain * values + self._offset

    def scale(self, present: np.ndarray | None = None) -> float:
        """What residuals are a share of: as given, else the largest magnitude among values that
        have been accepted and those that are `present`, of all inputs, else the nominal value."""
        if self.connection.scale:
            return self.connection.scale
        now = 0.0 if present is None else float(np.abs(present[self.place]).max())
        return max(self.largest, now) or self.nominal


def links(connections: Iterable[Any], units: Mapping[str, Unit]) -> list[Link]:
    """Connections, or pairs of names, as links between these units."""
    found = []
    for each in connections:
        connection = each if isinstance(each, Connection) else Connection(*each)
        found.append(Link(connection, units))
    targets: set[str] = set()
    for link in found:
        target = link.connection.target
        if target in targets:
            raise MasterError(f"{target} is the target of two connections")
        targets.add(target)
    return found


def split(name: str, units: Mapping[str, Unit]) -> tuple[str, str]:
    """The unit and the variable that `unit.variable` names."""
    unit, dot, variable = name.partition(".")
    if not dot or unit not in units:
        raise MasterError(f"`{name}` names none of the units {', '.join(units)}: unit.variable")
    return unit, variable


def conversion(
    units: Mapping[str, Unit], one: str, source: Variable, other: str, target: Variable
) -> tuple[float, float]:
    """Factor and shift from the source's unit of measurement to the target's."""
    if source.unit == target.unit or source.unit is None or target.unit is None:
        return 1.0, 0.0
    first, second = _base(units[one], source.unit), _base(units[other], target.unit)
    if first is None or second is None:
        return 1.0, 0.0
    if first[0] != second[0]:
        raise MasterError(
            f"{one}.{source.name} is in {source.unit}, {other}.{target.name} in {target.unit}"
        )
    return first[1] / second[1], (first[2] - second[2]) / second[1]


def exponents(unit: Unit, variable: Variable) -> tuple[int, ...] | None:
    """Exponents of kg, m, s, A, K, mol, cd and rad of a variable's unit of measurement, as far as
    the unit defines it."""
    known = None if variable.unit is None else _base(unit, variable.unit)
    return None if known is None else known[0]


def _base(unit: Unit, name: str) -> tuple[tuple[int, ...], float, float] | None:
    """Exponents of SI units, factor and offset of a unit of measurement."""
    for definition in unit.package.description.unitDefinitions:
        if definition.name == name and definition.baseUnit is not None:
            base = definition.baseUnit
            exponents = tuple(
                int(getattr(base, key) or 0)
                for key in ("kg", "m", "s", "A", "K", "mol", "cd", "rad")
            )
            return exponents, float(base.factor or 1.0), float(base.offset or 0.0)
    return None
