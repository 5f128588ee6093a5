"""From an output of one unit to an input of another: units of measurement, gains and maps."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from impinge.function import FunctionUnit
from impinge.function.signature import TIME
from impinge.master.any_unit import AnyUnit
from impinge.master.errors import MasterError
from impinge.measure import Measure, conversion, parse
from impinge.proposal import proposal
from impinge.unit import Variable


@dataclass(frozen=True)
class Connection:
    """`target = offset + gain · (source, converted to the target's unit of measurement)`.

    source, target: `unit.variable`, single variables or whole families (arrays) of equal shape; an
        array of one is as good as a single variable.
    gain, offset: numbers or arrays of the target's shape; the offset is in the target's unit.
    map: what makes the target's values (flat) of the source's (flat), where the shapes or the kinds
        of quantity differ; before the gain.
    mean: whether the source is a mean over the last step, so that it belongs to the whole step
        rather than to its end. What is left out is read from the description of impinge's units.
    scale: of which residuals and errors are a share; if left out, the largest magnitude at the
        start, at the ends of accepted steps and of what is judged, but not of earlier guesses. As
        long as it is zero, adaptive steps compare with the nominal value of the target. In an
        algebraic loop it is the largest magnitude of what is judged, among the connections
        whose targets have the same unit of measurement.
    unit: the unit of measurement of what `map` returns, such as "W/m2". With it, `map` takes the
        source's values in the source's own unit; without it, in the target's.
    """

    source: str
    target: str
    gain: Any = 1.0
    offset: Any = 0.0
    map: Callable[[np.ndarray], np.ndarray] | None = None
    mean: bool | None = None
    scale: float | None = None
    unit: str | None = None


class Link:
    """A connection whose names have been found: the transfer between two units' flat arrays.

    `place` are the target's places among all inputs that the master sets.
    """

    def __init__(self, connection: Connection, units: Mapping[str, AnyUnit]):
        self.connection = connection
        self.source_unit, self.source = split(connection.source, units)
        self.target_unit, self.target = split(connection.target, units)
        source = units[self.source_unit].variable(self.source)
        target = units[self.target_unit].variable(self.target)
        self._check(source, target)
        self.size = target.size
        gain = np.broadcast_to(np.asarray(connection.gain, float), target.shape).ravel()
        offset = np.broadcast_to(np.asarray(connection.offset, float), target.shape).ravel()
        factor, shift = self._conversion(source, target, units)
        is_before = connection.map is not None and connection.unit is None
        self._factor, self._shift = (factor, shift) if is_before else (1.0, 0.0)
        self._gain = gain if is_before else gain * factor
        self._offset = offset if is_before else offset + gain * shift
        self.is_plain = not connection.map and (self._gain == 1).all() and not self._offset.any()
        # Others hold over steps what they are at their beginning.
        self.is_real = (
            source.is_real
            and target.is_real
            and target.variability == "continuous"
            and source.variability != "discrete"
        )
        told = units[self.source_unit].is_mean(self.source)
        self.is_mean = told if connection.mean is None else connection.mean
        self.nominal = abs(target.nominal)
        self.unit = target.unit
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

    def _conversion(
        self, source: Variable, target: Variable, units: Mapping[str, AnyUnit]
    ) -> tuple[float, float]:
        """Factor and shift from the unit of measurement of what is passed on to the target's."""
        given, what = self.connection.unit, f"{self.connection.source} -> {self.connection.target}"
        if given is not None and self.connection.map is None:
            raise MasterError(f"{what}: `unit` is that of a `map`, and there is none")
        own, other = units[self.source_unit], units[self.target_unit]
        if given is None:
            self.measure = own.measure(source.unit)
        else:
            self.measure = other.measure(given) or own.measure(given)
            if self.measure is None and given != target.unit:
                self.measure = _parsed(given, what)
        if target.unit in (given, source.unit if given is None else None):
            return 1.0, 0.0
        try:
            return conversion(self.measure, other.measure(target.unit))
        except ValueError:
            end = f"{self.target_unit}.{target.name} in {target.unit}"
            if given is not None:
                raise MasterError(f"the map of {what} gives {given}, {end}") from None
            raise MasterError(
                f"{self.source_unit}.{source.name} is in {source.unit}, {end}; a `map` may lead"
                " there, whose `unit` is that of what it returns: Connection(…, map=…, unit=…)"
            ) from None

    def transfer(self, values: np.ndarray) -> np.ndarray:
        """The target's values that follow from the source's."""
        if self.is_plain:
            return values
        if self.connection.map is not None:
            values = self._mapped(self._factor * values + self._shift)
            if values.size != self.size:
                raise MasterError(
                    f"the map of {self.connection.source} -> {self.connection.target} gives"
                    f" {values.size} values for {self.size}"
                )
        return self._gain * values + self._offset

    def _mapped(self, values: np.ndarray) -> np.ndarray:
        what = f"the map of {self.connection.source} -> {self.connection.target}"
        try:
            mapped = self.connection.map(values)
        except Exception as error:
            raise MasterError(f"{what} fails with {type(error).__name__}: {error}") from error
        try:
            return np.ravel(np.asarray(mapped, dtype=float))
        except (OverflowError, TypeError, ValueError) as error:
            raise MasterError(f"{what} gives {mapped!r}, which is no real numbers") from error

    def scale(self, present: np.ndarray | None = None) -> float:
        """What residuals are a share of: as given, else the largest magnitude among values that
        have been accepted and those that are `present`, of all inputs, else the nominal value."""
        if self.connection.scale:
            return self.connection.scale
        now = 0.0 if present is None else float(np.abs(present[self.place]).max())
        return max(self.largest, now) or self.nominal

    def step_scale(self, present: np.ndarray) -> float:
        """Returns the scale of errors in time: after zeros alone, at least the nominal value, since
        the first change from zero is as large as the scale."""
        scale = self.scale(present)
        return scale if self.connection.scale or self.largest else max(scale, self.nominal)


def _parsed(unit: str, what: str) -> Measure:
    try:
        return parse(unit)
    except ValueError as error:
        raise MasterError(f"{what}: {error}") from None


def links(
    connections: Iterable[Any], units: Mapping[str, AnyUnit], inputs: Mapping[str, Any]
) -> list[Link]:
    """Connections, or pairs of names, as links between these units.

    inputs: values or functions of time of inputs that no connection sets.
    """
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
    _pass_means_on(found, units, inputs)
    return found


def _pass_means_on(
    links: list[Link], units: Mapping[str, AnyUnit], inputs: Mapping[str, Any]
) -> None:
    """Results of a function without a state that gets means and constants alone are means over the
    step, too."""
    driven = {split(name, units)[0] for name, value in inputs.items() if callable(value)}
    memoryless = {
        name
        for name, unit in units.items()
        if isinstance(unit, FunctionUnit)
        and not unit.function.has_state
        and TIME not in unit.function.takes
        and name not in driven
    }
    open_links = [
        link for link in links if link.source_unit in memoryless and link.connection.mean is None
    ]
    for _ in links:  # as many as a chain of functions can have
        for link in open_links:
            given = [each.is_mean for each in links if each.target_unit == link.source_unit]
            link.is_mean = bool(given) and all(given)


def split(name: str, units: Mapping[str, AnyUnit]) -> tuple[str, str]:
    """The unit and the variable that `unit.variable` names."""
    unit, dot, variable = name.partition(".")
    if not dot or unit not in units:
        near = proposal(unit, units)
        raise MasterError(
            f"`{name}` names none of the units {', '.join(units)}: unit.variable{near}"
        )
    return unit, variable
