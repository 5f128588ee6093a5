"""What inputs do over a run: values that are held, functions of time, tables."""

from __future__ import annotations

import inspect
import itertools
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from impinge.jumps import Watched

_SAME = 1e-9  # of a step or of the largest value: what is no difference


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

    def mean(self, begin: float, end: float) -> np.ndarray:
        """The mean from one time to another, exactly."""
        edges = [begin, *np.unique(self._between(begin, end)), end]
        parts = (
            0.5 * (b - a) * (self.at(a, "right") + self.at(b, "left"))
            for a, b in itertools.pairwise(edges)
        )
        return sum(parts, np.zeros(self.values.shape[1:])) / (end - begin)

    def bend(self, begin: float, end: float) -> float | None:
        """The first time within a step at which the table leaves the line from its beginning to its
        end; `None` if it never does."""
        apart = _SAME * (end - begin)
        first, last = self.at(begin, "right"), self.at(end, "left")
        allowed = _SAME * np.abs(self.values).max(initial=0.0)
        for time in self._between(begin + apart, end - apart):
            line = first + (time - begin) / (end - begin) * (last - first)
            for side in ("left", "right"):
                if np.abs(self.at(time, side) - line).max(initial=0.0) > allowed:
                    return float(time)
        return None

    def _between(self, begin: float, end: float) -> np.ndarray:
        first, last = np.searchsorted(self.times, begin, "right"), np.searchsorted(self.times, end)
        return self.times[first:last]


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

    def hold(self, part: int, value: np.ndarray) -> None:
        """Takes one value for the whole of a part."""
        for rows in (self.begins, self.middles, self.ends):
            rows[part] = value.ravel()


def watched(name: str, function: Function, parameters: Mapping[str, Any]) -> Watched:
    """A function of time, and of the row's parameters where it asks for them."""
    if takes_parameters(function):
        return Watched(name, lambda time: function(time, parameters))
    return Watched(name, function)


@dataclass(frozen=True)
class Timeline:
    """When steps begin and end [s], and what inputs do over them.

    notes: what functions and tables do that steps cannot follow, in words.
    """

    times: np.ndarray
    courses: dict[str, Course]
    notes: tuple[str, ...] = ()


def timeline(
    stop: float,
    step: float,
    signals: Mapping[str, Signal],
    cut: bool,
    parameters: Mapping[str, Any],
    discrete: Collection[str] = (),
) -> Timeline:
    """Steps and what inputs that are no constants do over them.

    Where a function of time jumps within a step, or a table jumps or changes its slope, the step is
    cut there; the mean over the step is held where the unit takes no steps of other lengths.
    `discrete` inputs hold over a step what they are at its beginning; of their tables, the last
    value.
    """
    signals = {
        name: replace(signal, hold=True)
        if name in discrete and isinstance(signal, Table)
        else signal
        for name, signal in signals.items()
    }
    times = parts(stop, step, signals, cut)
    notes: list[str] = []
    functions = {
        name: watched(name, signal, parameters)
        for name, signal in signals.items()
        if callable(signal)
    }
    jumps: dict[str, list[list[float]]] = {}
    for name, function in functions.items():
        steps = list(zip(times[:-1].tolist(), times[1:].tolist(), strict=True))
        for begin, end in steps:
            function.look(begin, end)
        jumps[name] = [function.jumps(begin, end) for begin, end in steps]
        smooth = (s for s, at in zip(steps, jumps[name], strict=True) if not at)
        steep = next((each for each in smooth if function.is_steep(*each)), None)
        if steep is not None:
            notes.append(
                f"input {name} changes within the step from {steep[0]:.6g} to {steep[1]:.6g} s as"
                " no parabola does: what it brings in is not exact (shorter steps help)"
            )
    if cut:
        knots = [np.array(at) for each in jumps.values() for at in each if at]
        times = _with_knots(times, np.concatenate([np.empty(0), *knots]), step)
    courses = {}
    for name, signal in signals.items():
        mean: Callable[[float, float], np.ndarray]
        if name in functions:
            courses[name] = _course_of_function(functions[name], times)
            inside = {k: at[0] for k, at in enumerate(jumps[name]) if at and not cut}
            mean, does = functions[name].mean, "jumps"
        else:
            assert isinstance(signal, Table)
            table = _on_steps(signal, times, step)
            courses[name] = _course_of_table(table, times)
            inside = {} if cut else _bends(table, times)
            mean, does = table.mean, "bends or jumps"
        if name in discrete:
            courses[name] = replace(courses[name], middles=courses[name].begins)
            held = "what it was before"
        else:
            for k in inside:
                courses[name].hold(k, mean(times[k], times[k + 1]))
            held = "its mean over the step"
        if inside:
            notes.append(
                f"input {name} {does} at {next(iter(inside.values())):.6g} s, within a step, and"
                f" the unit takes steps of one length: {held} is held"
            )
    return Timeline(times, courses, tuple(notes))


def _on_steps(table: Table, times: np.ndarray, step: float) -> Table:
    """The table with jumps where steps begin, if rounding alone sets them apart."""
    after = np.clip(np.searchsorted(times, table.times), 1, len(times) - 1)
    before, after = times[after - 1], times[after]
    nearest = np.where(table.times - before < after - table.times, before, after)
    is_same = np.abs(nearest - table.times) <= _SAME * step
    return Table(np.where(is_same, nearest, table.times), table.values, table.hold)


def _bends(table: Table, times: np.ndarray) -> dict[int, float]:
    """Steps within which a table is no line, and when it first leaves that."""
    bends = ((k, table.bend(*step)) for k, step in enumerate(itertools.pairwise(times)))
    return {k: time for k, time in bends if time is not None}


def _course_of_table(table: Table, times: np.ndarray) -> Course:
    middles = (times[1:] + times[:-1]) / 2
    return Course(
        _rows(table.at(t, "right") for t in times[:-1]),
        _rows(table.at(t, "right") for t in middles),
        _rows(table.at(t, "left") for t in times[1:]),
    )


def _course_of_function(function: Watched, times: np.ndarray) -> Course:
    """The function at the beginnings and ends of steps, one-sided, and in their middles."""
    steps = list(zip(times[:-1].tolist(), np.diff(times).tolist(), strict=True))
    ends = zip(times[1:].tolist(), np.diff(times).tolist(), strict=True)
    return Course(
        _rows(function.after(begin, size) for begin, size in steps),
        _rows(function(begin + size / 2) for begin, size in steps),
        _rows(function.before(end, size) for end, size in ends),
    )


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
    return _with_knots(times, np.concatenate([np.empty(0), *knots]), step)


def _with_knots(times: np.ndarray, extra: np.ndarray, step: float) -> np.ndarray:
    """Times and knots between them, but those that are as good as one of the times."""
    extra = extra[(extra > 0.0) & (extra < times[-1])]
    if len(extra):
        nearest = times[np.abs(times[:, None] - extra[None, :]).argmin(axis=0)]
        extra = extra[np.abs(nearest - extra) > _SAME * step]
    return np.unique(np.concatenate([times, extra]))
