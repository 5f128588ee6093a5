"""Slopes of responses by central differences, with estimates of their error."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from impinge.errors import UnitError

Response = Callable[[float], np.ndarray]
"""Outputs under a change of one input."""

_RATIO = 4.0  # between the changes of two levels
_LEVELS = 10
_LARGER = 2  # levels above the first, where differences are lost in noise
_ROUNDING = 8.0 * np.finfo(float).eps  # of an output, relative
_SETTLED = 1e-7  # relative error of a slope below which changes shrink no further
_FINE = 1e-6  # relative error of a slope above which larger changes are tried against noise
_LINEAR = 1e-9  # relative difference of two slopes of a line


@dataclass(frozen=True, eq=False)
class Slopes:
    """Derivatives of outputs, their estimated errors, and whether a response is a line, whose slope
    is exact to rounding. scale: the largest value of each output that the differences come from."""

    value: np.ndarray
    error: np.ndarray
    is_linear: np.ndarray
    scale: np.ndarray


@dataclass(frozen=True, eq=False)
class _Level:
    """Differences at one `change`: the central `slope`, the second difference `bend`, what rounding
    does to the slope, and the smallest step of the output, infinite if it does not move."""

    change: float
    slope: np.ndarray
    bend: np.ndarray
    rounding: np.ndarray
    smallest: np.ndarray
    seen: np.ndarray


def slopes(response: Response, at: float, change: float, room: float) -> Slopes:
    """The derivative of each output, at no change.

    at: the input's value. change: where differences start; they shrink until the error of each
    derivative is small. room: the largest change allowed, up to which noise makes it larger.

    Neville's tableau extrapolates central differences to no change. The error of an entry is the
    larger of twice its distance from its neighbours and the noise of its smallest change. Half the
    jump between the slopes of the two sides is added, extrapolated likewise. Second differences of
    smooth outputs shrink by 16 from level to level; noise is what remains of them.

    C. J. F. Ridders, Adv. Eng. Softw. 4 (1982), doi 10.1016/S0141-1195(82)80057-0.
    """
    middle = response(0.0)
    changes = [change / _RATIO**number for number in range(_LEVELS)]
    changes = [exact for exact in ((at + each) - at for each in changes) if exact > 0.0]
    if len(changes) < 2:
        raise ValueError(f"a change of {change:g} is lost in the rounding of {at:g}")
    levels = [_level(response, middle, each) for each in changes[:2]]
    first, second = levels
    limit = _LINEAR * np.abs(first.slope) + 8.0 * second.rounding
    is_linear = np.abs(first.bend) <= first.change * limit
    is_linear &= np.abs(second.slope - first.slope) <= limit
    for each in changes[2:]:
        if is_linear.all():
            break
        levels.append(_level(response, middle, each))
        value, error = _extrapolated(levels)
        rounding = 4.0 * np.min([level.rounding for level in levels], axis=0)
        if np.all(is_linear | (error <= np.maximum(_SETTLED * np.abs(value), rounding))):
            break
    value, error = _joined(levels, is_linear)
    for _ in range(_LARGER):
        larger = (at + levels[0].change * _RATIO) - at
        rough = np.where(is_linear, 0.0, _noise(levels) / levels[0].change)
        is_lost = error <= 16.0 * np.maximum(rough, levels[0].rounding)
        is_lost &= (error > _FINE * np.abs(value)) & (value != 0.0)
        if larger > room or not is_lost.any():
            break
        try:
            levels.insert(0, _level(response, middle, larger))
        except UnitError:
            break
        top = levels[0]
        is_linear &= np.abs(top.bend) <= top.change * limit
        is_linear &= np.abs(top.slope - first.slope) <= limit
        value, error = _joined(levels, is_linear)
    scale = np.max([level.seen for level in levels], axis=0)
    return Slopes(value, error, is_linear, scale)


def _level(response: Response, middle: np.ndarray, change: float) -> _Level:
    up, down = response(change), response(-change)
    seen = np.maximum(np.maximum(np.abs(up), np.abs(down)), np.abs(middle))
    moves = np.abs([up - middle, middle - down])
    smallest = np.where(moves > 0.0, moves, np.inf).min(axis=0)
    return _Level(
        change,
        (up - down) / (2.0 * change),
        up + down - 2.0 * middle,
        _ROUNDING * seen / change,
        smallest,
        seen,
    )


def _joined(levels: list[_Level], is_linear: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Slopes and errors, those of lines by the largest change."""
    top = levels[0]
    if len(levels) == 2 or is_linear.all():
        return top.slope, top.rounding
    value, error = _extrapolated(levels)
    return np.where(is_linear, top.slope, value), np.where(is_linear, top.rounding, error)


def _noise(levels: list[_Level]) -> np.ndarray:
    """Size of second differences that is no smooth output's, from the smallest changes."""
    pairs = list(zip(levels[:-1], levels[1:], strict=True))[-3:]
    remainders = [np.abs(small.bend - large.bend / _RATIO**2) for large, small in pairs]
    return np.maximum(np.max(remainders, axis=0), _quantum(levels))


def _quantum(levels: list[_Level]) -> np.ndarray:
    """Height of the steps of outputs that rest under small changes, yet follow larger ones at one
    rate, as a solver does that accepts its last solution; else zero."""
    is_at_rest = np.isinf(levels[-1].smallest)
    follows = np.zeros_like(is_at_rest)
    for large, small in zip(levels[:-1], levels[1:], strict=True):
        rate = np.abs(large.slope)
        is_even = np.abs(large.bend) <= 0.5 * rate * large.change
        follows |= (rate > 0.0) & is_even & (np.abs(small.slope - large.slope) <= 0.5 * rate)
    height = np.min([level.smallest for level in levels], axis=0)
    return np.where(is_at_rest & follows & np.isfinite(height), height, 0.0)


def _tableau(rows: list[np.ndarray], first: int) -> list[list[np.ndarray]]:
    """Returns Neville's tableau of values with errors of orders `first`, `first` + 2, …"""
    tableau: list[list[np.ndarray]] = []
    for number, value in enumerate(rows):
        row = [value]
        for order in range(number):
            factor = _RATIO ** (2 * order + first)
            row.append((factor * row[order] - tableau[-1][order]) / (factor - 1.0))
        tableau.append(row)
    return tableau


def _extrapolated(levels: list[_Level]) -> tuple[np.ndarray, np.ndarray]:
    """Entry by entry that of the tableau with the least error."""
    noise = _noise(levels)
    slopes_to_zero = _tableau([level.slope for level in levels], 2)
    jumps = _tableau([level.bend / level.change for level in levels], 1)
    best, error = levels[0].slope, np.full_like(levels[0].slope, np.inf)
    for number, row in enumerate(slopes_to_zero):
        level = levels[number]
        rough = np.maximum(noise / level.change, level.rounding)
        is_last = number + 1 == len(levels)
        for order, value in enumerate(row):
            near = [row[order - 1], slopes_to_zero[number - 1][order - 1]] if order else []
            near += [] if is_last else [slopes_to_zero[number + 1][order]]
            if not near:
                continue
            miss = 2.0 * np.max([np.abs(value - other) for other in near], axis=0)
            jump = jumps[number][order] if order else jumps[number + 1][1]
            miss = np.maximum(miss, rough) + 0.5 * np.abs(jump)
            is_better = miss < error
            best, error = np.where(is_better, value, best), np.where(is_better, miss, error)
    return best, error
