"""Calls that get and set many values at once, through arrays that are made once.

A unit's functions take an array of references and an array of values. `Reader` and `Writer` make
both once for a list of names, so that a call converts nothing and makes no list.
"""

from collections.abc import Callable, Sequence
from numbers import Real
from typing import Any

import numpy as np

from impinge.errors import UnitError
from impinge.unit.variable import Variable

_PLAIN = frozenset({float, int, bool, np.float64, np.int64, np.bool_})  # single real numbers


class _Part:
    """The values of one kind: a call, its array, and the places that its values have among all.

    An array of FMI 3.0 occurs once, however many of its elements go by names of their own.
    """

    def __init__(self, slave: Any, verb: str, kind: str):
        self.slave, self.verb, self.kind = slave, verb, kind
        self.references: list[np.ndarray] = []
        self.sources: list[np.ndarray] = []  # places in `values`
        self.targets: list[np.ndarray] = []  # places among all values
        self.begins: dict[bytes, int] = {}  # where the values of references begin in `values`
        self.count = 0

    def add(self, variable: Variable, array: Variable, target: int) -> None:
        key = array.references.tobytes()
        if key not in self.begins:
            self.begins[key] = self.count
            self.references.append(array.references)
            self.count += array.size
        places = np.arange(array.size) if variable.element is None else np.array([variable.element])
        self.sources.append(self.begins[key] + places)
        self.targets.append(target + np.arange(len(places)))

    def close(self) -> None:
        self.reference_array = np.concatenate(self.references)
        self.values = np.zeros(self.count, dtype=self.slave.types[self.kind])
        self.source = np.concatenate(self.sources)
        self.target = np.concatenate(self.targets)
        self.is_whole = np.array_equal(self.source, np.arange(self.count))
        bound = (self.kind, self.reference_array, self.values)
        self.call = self.slave.access(self.verb, *bound)
        has_rest = len(np.unique(self.source)) < self.count  # elements without a name here
        self.look = self.slave.access("Get", *bound) if has_rest else None

    def refusal(self, new: np.ndarray) -> str:
        """What values of this kind must be, if these are not."""
        dtype = self.values.dtype
        if self.kind == "Boolean":
            return "" if np.isin(new, (0.0, 1.0)).all() else "true or false"
        if dtype.kind == "f":
            if dtype == np.float64:
                return ""
            too_large = np.isfinite(new) & (np.abs(new) > np.finfo(dtype).max)
            return f"within the range of {self.kind}" if too_large.any() else ""
        if not np.array_equal(new, np.rint(new)):
            return "whole numbers"
        low, high = np.iinfo(dtype).min, np.iinfo(dtype).max
        if (new < low).any() or (new >= float(high) + 1).any():
            return f"whole numbers from {low} to {high}"
        return ""


class Access:
    """What `Reader` and `Writer` share: names, slices of a flat array, and parts by kind.

    `values` (float64, flat) holds the values of all names one after another, arrays in C order;
    `slices` are the places of each name in it.
    """

    verb = ""

    def __init__(
        self, slave: Any, variables: Sequence[Variable], resolve: Callable[[str], Variable]
    ):
        self.slave = slave
        self.variables = list(variables)
        self.slices: list[slice] = []
        parts: dict[str, _Part] = {}
        count = 0
        for variable in variables:
            if variable.kind not in slave.types:
                raise UnitError(f"`{variable.name}` is a {variable.kind}, not a number")
            array = variable if variable.element is None else resolve(variable.name)
            parts.setdefault(variable.kind, _Part(slave, self.verb, variable.kind)).add(
                variable, array, count
            )
            self.slices.append(slice(count, count + variable.size))
            count += variable.size
        self._parts = list(parts.values())
        for part in self._parts:
            part.close()
        simple = len(self._parts) == 1 and self._parts[0].is_whole
        self._only = self._parts[0] if simple and self._parts[0].values.dtype == float else None
        self.values = self._only.values if self._only else np.zeros(count)
        self._call: Callable[[], int] = self._only.call if self._only else self._all

    def _all(self) -> int:
        raise NotImplementedError

    def close(self) -> None:
        """Bars further calls: the instance is gone, or must not be called any more."""
        self._call = self._closed

    def _closed(self) -> int:
        self.slave.must_live()
        raise UnitError("the unit is closed")


class Reader(Access):
    """Reads the present values of a list of names: `reader()` returns its own array `values`."""

    verb = "Get"

    def __call__(self) -> np.ndarray:
        status = self._call()
        if status > 1:
            self.slave.check(status, "Get: " + ", ".join(v.name for v in self.variables))
        return self.values

    def _all(self) -> int:
        for part in self._parts:
            status = part.call()
            if status > 1:
                return status
            self.values[part.target] = part.values[part.source]
        return 0


class Writer(Access):
    """Sets values of a list of names: those that stand in its array `values`."""

    verb = "Set"

    def __call__(self) -> None:
        status = self._call()
        if status > 1:
            self.slave.check(status, "Set: " + ", ".join(v.name for v in self.variables))

    def _all(self) -> int:
        for part in self._parts:
            if part.look is not None:
                status = part.look()  # the other elements stay as they are
                if status > 1:
                    return status
            new = self.values[part.target]
            allowed = part.refusal(new)
            if allowed:
                names = ", ".join(v.name for v in self.variables if v.kind == part.kind)
                raise UnitError(f"{names}: {new.tolist()} must be {allowed}")
            part.values[part.source] = new
            status = part.call()
            if status > 1:
                return status
        return 0

    def fill(self, values: Sequence[Any]) -> None:
        """Puts a value for each name into `values`; single numbers fill arrays."""
        if len(self.values) == len(values) and all(type(value) in _PLAIN for value in values):
            try:
                self.values[:] = values
                return
            except OverflowError:
                pass  # an integer that no float64 holds
        for variable, place, value in zip(self.variables, self.slices, values, strict=True):
            try:
                array = real_values(value)
                whole = array.size == variable.size and array.shape in (
                    variable.shape,
                    (array.size,),
                )
                self.values[place] = (
                    array.ravel() if whole else np.broadcast_to(array, variable.shape).ravel()
                )
            except (TypeError, ValueError, OverflowError) as error:
                shape = f"{variable.shape}" if variable.shape else "one number"
                raise UnitError(f"`{variable.name}` takes {shape}, not {_tell(value)}") from error


def real_values(value: Any) -> np.ndarray:
    """Real numbers alone: NumPy would make numbers of texts, and NaN of None."""
    array = np.asarray(value)
    if array.dtype.kind == "O" and all(isinstance(each, Real) for each in array.flat):
        array = array.astype(float)
    if array.dtype.kind not in "fiub":
        raise TypeError(f"holds no real numbers, but {array.dtype}")
    return array.astype(float)


def _tell(value: Any) -> str:
    shape = getattr(value, "shape", None)
    return f"an array of shape {shape}" if shape else repr(value)


class PathWriter:
    """Sets inputs and their time derivatives for the next step, by FMI 2.0.

    `values`, `first` and `second` (float64, flat) are the inputs at the beginning of the step, and
    their derivatives per s and per s²; `second` is None where `order` is 1.
    """

    def __init__(self, slave: Any, writer: Writer, order: int):
        self._slave, self._writer = slave, writer
        self.values = writer.values
        references = np.concatenate([v.references for v in writer.variables])
        count = len(references)
        self._rates = np.zeros(order * count)
        self.first = self._rates[:count]
        self.second = self._rates[count:] if order > 1 else None
        self._references = np.tile(references, order)
        self._orders = np.repeat(np.arange(1, order + 1, dtype=np.int32), count)
        self._call = slave.input_derivatives(self._references, self._orders, self._rates)

    def __call__(self) -> None:
        self._writer()
        status = self._call()
        if status > 1:
            self._slave.check(status, "SetRealInputDerivatives")
