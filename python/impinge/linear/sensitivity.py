"""How outputs at the end of a step follow inputs that are held over it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from impinge.errors import UnitError
from impinge.points import tell_of_points
from impinge.unit import Unit

from .rollout import Rollout, sizes_of_changes

Central = Callable[[float], tuple[np.ndarray, np.ndarray, np.ndarray]]

_RATIO = 2.0  # between changes of a tableau
_LONGEST = 12  # columns of one
_SMALLER = 8  # times that a change which the unit refuses is made ten times smaller


@dataclass(frozen=True, eq=False)
class Sensitivity:
    """∂y(t+H)/∂u: `matrix` (outputs, inputs), in units of the output per unit of the input.

    error: estimated error of each entry, in the same units. is_linear: whether the output answers
    to changes of the input in proportion, (outputs, inputs); these entries are exact to rounding.
    """

    matrix: np.ndarray
    error: np.ndarray
    is_linear: np.ndarray
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    step: float


def step_sensitivity(
    unit: Unit, inputs: Sequence[str], outputs: Sequence[str], step: float
) -> Sensitivity:
    """∂y(t+H)/∂u of a unit that can restore its state, at its present state and inputs, for inputs
    that are held over a step of H = `step` [s]; the unit is left as it was.

    Central differences over nominal values, or as much as bounds allow, where three changes of an
    input say that outputs are in proportion to them: that is exact. Elsewhere the change is halved
    until the tableau of differences extrapolated to zero gets no better.

    C. J. F. Ridders, Adv. Eng. Softw. 4 (1982), doi 10.1016/S0141-1195(82)80057-0.
    """
    tell_of_points(unit.package, outputs, inputs)
    with Rollout(unit, inputs, outputs, step, 1) as rollout:
        columns = [
            _column(rollout, number, size)
            for number, size in enumerate(np.abs(sizes_of_changes(rollout)))
        ]
        matrix, error, is_linear = (np.array(part) for part in zip(*columns, strict=True))
        return Sensitivity(
            matrix.T,
            error.T,
            is_linear.T,
            tuple(rollout.input_names),
            tuple(rollout.output_names),
            step,
        )


def _column(
    rollout: Rollout, column: int, size: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    size = _allowed(rollout, column, size)
    for attempt in range(_SMALLER + 1):
        try:
            return _differences(rollout, column, size / 10.0**attempt)
        except UnitError:
            if attempt == _SMALLER:
                raise
    raise AssertionError("unreachable")


def _allowed(rollout: Rollout, column: int, size: float) -> float:
    """A change that stays within the bounds of the input on both sides."""
    places = zip(rollout.inputs, rollout.write.slices, strict=True)
    variable = next(v for v, place in places if place.start <= column < place.stop)
    value = rollout.base[column]
    up = np.inf if variable.max is None else variable.max - value
    down = np.inf if variable.min is None else value - variable.min
    room = min(up, down) / 2.0
    if room <= 0.0:
        raise ValueError(
            f"{rollout.input_names[column]} = {value} is at a bound"
            " (allowed: room on both sides for differences)"
        )
    return min(size, room)


def _end(rollout: Rollout, column: int, change: float) -> np.ndarray:
    inputs = rollout.base.copy()
    inputs[column] += change
    return rollout.run(inputs[None, :])[1]


def _differences(
    rollout: Rollout, column: int, size: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    middle = _end(rollout, column, 0.0)

    def central(change: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The slope, what rounding does to it, and what it misses if the response is no line."""
        up, down = _end(rollout, column, change), _end(rollout, column, -change)
        seen = np.maximum(np.maximum(np.abs(up), np.abs(down)), np.abs(middle))
        rounding = 8.0 * np.finfo(float).eps * seen / change
        return (up - down) / (2.0 * change), rounding, np.abs(up + down - 2.0 * middle) / change

    slope, rounding, bend = central(size)
    other, _, _ = central(size / _RATIO)
    limit = 1e-9 * np.abs(slope) + 8.0 * rounding
    is_linear = (bend <= limit) & (np.abs(other - slope) <= limit)
    if is_linear.all():
        return slope, rounding, is_linear
    best, error = _extrapolated(central, size)
    return np.where(is_linear, slope, best), np.where(is_linear, rounding, error), is_linear


def _extrapolated(central: Central, size: float) -> tuple[np.ndarray, np.ndarray]:
    """Neville's tableau of central differences, entry by entry the one of least error."""
    slope, rounding, _ = central(size)
    row = [slope]
    best, error = slope, np.full_like(slope, np.inf)
    for number in range(1, _LONGEST):
        change = size / _RATIO**number
        slope, rounding, _ = central(change)
        above, row = row, [slope]
        factor = 1.0
        for order in range(number):
            factor *= _RATIO**2
            row.append((factor * row[order] - above[order]) / (factor - 1.0))
            near = np.maximum(np.abs(row[-1] - row[-2]), np.abs(row[-1] - above[order]))
            near = np.maximum(near, rounding)
            better = near < error
            best, error = np.where(better, row[-1], best), np.where(better, near, error)
        if np.all(np.abs(row[-1] - above[-1]) >= 4.0 * error):
            break
    return best, error
