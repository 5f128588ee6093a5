"""How outputs at the end of a step follow inputs that are held over it."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain

import numpy as np

from impinge.errors import UnitError
from impinge.points import tell_of_points
from impinge.unit import Unit

from .differences import Slopes, slopes
from .rollout import Rollout

_FIRST = 1e-2  # change, relative to the value of an input or to its nominal value
_SMALLER = 8  # times that a change which the unit refuses is made ten times smaller
_NOTHING = 1e-9  # of an output: an error of this size under the first change is no matter


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

    Central differences, first over 1 % of the input's value or nominal value, whichever is larger:
    3 K of a temperature. Outputs in proportion to the input are exact at once. For others the
    change is made smaller until their error is small. A warning names entries whose error exceeds
    them: noise hides these, or the slope jumps at the present input.
    """
    tell_of_points(unit.package, outputs, inputs)
    with Rollout(unit, inputs, outputs, step, 1) as rollout:
        columns = [_column(rollout, number) for number in range(len(rollout.input_names))]
        parts = ((found.value, found.error, found.is_linear) for found in columns)
        matrix, error, is_linear = (np.array(part) for part in zip(*parts, strict=True))
        doubts = [_doubts(rollout, number, found) for number, found in enumerate(columns)]
        sensitivity = Sensitivity(
            matrix.T,
            error.T,
            is_linear.T,
            tuple(rollout.input_names),
            tuple(rollout.output_names),
            step,
        )
    for text in chain.from_iterable(doubts):
        warnings.warn(text, stacklevel=2)
    return sensitivity


def _column(rollout: Rollout, column: int) -> Slopes:
    size, room = _sizes(rollout, column)
    value = rollout.base[column]

    def response(change: float) -> np.ndarray:
        inputs = rollout.base.copy()
        inputs[column] += change
        return rollout.run(inputs[None, :])[1]

    for attempt in range(_SMALLER + 1):
        try:
            return slopes(response, value, size / 10.0**attempt, room if attempt == 0 else 0.0)
        except UnitError:
            if attempt == _SMALLER:
                raise
    raise AssertionError("unreachable")


def _sizes(rollout: Rollout, column: int) -> tuple[float, float]:
    """The first change, and the largest that stays within the bounds of the input on both sides."""
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
    return min(_FIRST * max(abs(variable.nominal), abs(value)), room), room


def _doubts(rollout: Rollout, column: int, found: Slopes) -> list[str]:
    """Warnings of outputs whose slope is less than its error, unless they hardly change at all."""
    is_lost = (found.error > 0.0) & (found.error >= np.abs(found.value))
    is_lost &= found.error * _sizes(rollout, column)[0] > _NOTHING * found.scale
    name = rollout.input_names[column]
    return [
        f"∂({rollout.output_names[row]})/∂({name}) = {found.value[row]:.3g}"
        f" ± {found.error[row]:.2g} at {name} = {rollout.base[column]:g}: the error exceeds the"
        " value; do not use it. The output jumps here, changes its slope, or has noise that hides"
        " how it follows the input. Choose another state, or a smaller tolerance of its solver"
        for row in np.flatnonzero(is_lost)
    ]
