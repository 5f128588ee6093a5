"""What inputs do over a run: values that are held, functions of time, tables."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True, eq=False)
class Table:
    """Values at ascending times [s], linear between, held before and after.

    values: shape (times,) or (times, *shape of the input). A time that stands twice is a jump.
    hold: every value holds up to the next time.
    """

    times: Any
    values: Any
    hold: bool = False

    def __post_init__(self) -> None:
        times = np.array(self.times, float)
        values = np.array(self.values, float)
        if times.ndim != 1 or len(times) < 1 or len(values) != len(times):
            raise ValueError(f"{times.shape} times, {values.shape} values (allowed: one by one)")
        if np.any(np.diff(times) < 0.0) or not np.all(np.isfinite(times)):
            raise ValueError("times of a table go back (allowed: ascending, finite)")
        object.__setattr__(self, "times", times)
        object.__setattr__(self, "values", values)

    def at(self, time: float, side: str) -> np.ndarray:
        """The value just before (`left`) or just after (`right`) a time."""
        before = int(np.searchsorted(self.times, time, side="left" if side == "left" else "right"))
        if before == 0:
            return self.values[0]
        if before == len(self.times):
            return self.values[-1]
        if self.hold:
            return self.values[before - 1]
        start, end = self.times[before - 1], self.times[before]
        weight = (time - start) / (end - start)
        return (1.0 - weight) * self.values[before - 1] + weight * self.values[before]


Function = Callable[..., Any]
Signal = float | np.ndarray | Table | Function


def signal_of(name: str, given: Any) -> Signal:
    """What `given` means: a number or an array is held, a function is of time [s] or of time and
    the row's parameters, a table or a pair (times, values) is linear between its times."""
    if isinstance(given, Table):
        return given
    if callable(given):
        return given
    try:
        if isinstance(given, tuple) and len(given) == 2 and np.ndim(given[0]) == 1:
            return Table(*given)
        value = np.array(given, float)
    except (TypeError, ValueError) as error:
        raise ValueError(f"input {name}: {error}") from None
    if not np.all(np.isfinite(value)):
        raise ValueError(f"input {name}: {given!r} (allowed: finite numbers)")
    return float(value) if value.ndim == 0 else value


def takes_parameters(function: Function) -> bool:
    """Whether a function of time asks for the row's parameters too."""
    try:
        required = [
            p
            for p in inspect.signature(function).parameters.values()
            if p.default is p.empty and p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD)
        ]
    except (TypeError, ValueError):  # builtin functions without a signature
        return False
    return len(required) == 2


@dataclass(frozen=True)
class Course:
    """An input at the beginnings, middles and ends of all parts of a run, shape (parts, size)."""

    begins: np.ndarray
    middles: np.ndarray
    ends: np.ndarray


def course(signal: Signal, times: np.ndarray, parameters: Mapping[str, Any]) -> Course:
    """What an input that is no constant does between `times` [s], ascending."""
    middles = (times[1:] + times[:-1]) / 2
    if isinstance(signal, Table):
        return Course(
            _rows(signal.at(t, "right") for t in times[:-1]),
            _rows(signal.at(t, "right") for t in middles),
            _rows(signal.at(t, "left") for t in times[1:]),
        )
    assert callable(signal)
    more = (parameters,) if takes_parameters(signal) else ()
    nodes = _rows(signal(float(t), *more) for t in times)
    return Course(nodes[:-1], _rows(signal(float(t), *more) for t in middles), nodes[1:])


def _rows(values: Any) -> np.ndarray:
    rows = np.array([np.ravel(value) for value in values], float)
    if not np.all(np.isfinite(rows)):
        raise ValueError("an input is not finite")
    return rows


def parts(stop: float, step: float, signals: Mapping[str, Signal], cut: bool) -> np.ndarray:
    """The times [s] at which steps begin and end: multiples of `step`, `stop`, and where the unit
    takes steps of any length (`cut`) the times of tables."""
    count = max(1, int(np.ceil(stop / step * (1.0 - 1e-12))))
    times = np.minimum(step * np.arange(count + 1), stop)
    times[-1] = stop
    if not cut:
        return times
    knots = [s.times for s in signals.values() if isinstance(s, Table)]
    extra = np.concatenate([np.empty(0), *knots])
    extra = extra[(extra > 0.0) & (extra < stop)]
    if len(extra):
        nearest = times[np.abs(times[:, None] - extra[None, :]).argmin(axis=0)]
        extra = extra[np.abs(nearest - extra) > 1e-9 * step]
    return np.unique(np.concatenate([times, extra]))
