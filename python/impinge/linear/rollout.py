"""Roll-outs of a unit: what its outputs do under inputs of some steps, from a state that is
restored afterwards."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from impinge.errors import ImpingeError, UnitError
from impinge.unit import Unit, Variable


class NotLinear(ImpingeError):
    """Responses of a unit do not add up; `defect` is by how much, relative to the responses."""

    def __init__(self, what: str, defect: float):
        super().__init__(what)
        self.defect = defect


class Rollout:
    """Roll-outs of `steps` steps of `step` [s] from the unit's present state.

    inputs, outputs: names of scalars, of elements or of whole families, whose elements count one
    after another; `base` are the inputs' present values, shape (inputs,).
    """

    def __init__(
        self, unit: Unit, inputs: Sequence[str], outputs: Sequence[str], step: float, steps: int
    ):
        if not unit.can.states:
            raise UnitError(f"{unit.name} cannot save its state, which roll-outs start from")
        if not (np.isfinite(step) and step > 0.0):
            raise ValueError(f"step = {step} (allowed: above 0 s)")
        if steps < 1:
            raise ValueError(f"steps = {steps} (allowed: at least 1)")
        _check(unit, inputs, "input")
        _check(unit, outputs, "output")
        self.unit, self.step, self.steps = unit, float(step), steps
        self.read = unit.reader(outputs)
        self.write = unit.writer(inputs)
        self.inputs = [unit.variable(name) for name in inputs]
        self.input_names = flat_names(self.inputs)
        self.output_names = flat_names([unit.variable(name) for name in outputs])
        self.base: np.ndarray = unit.get(list(inputs))
        self.start = unit.state()

    def close(self) -> None:
        """Leaves the unit as it was."""
        self.unit.restore(self.start)
        self.start.free()

    def __enter__(self) -> Rollout:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def set(self, values: np.ndarray) -> None:
        self.write.values[:] = values
        self.write()

    def advance(self, begin: np.ndarray, end: np.ndarray | None = None) -> None:
        """One step under inputs that are held, or go straight to `end`."""
        self.set(begin)
        if end is not None:
            slopes = (end - begin) / self.step
            self.unit.set_input_derivatives(
                {
                    variable.name: [slopes[place].reshape(variable.shape)]
                    for variable, place in zip(self.inputs, self.write.slices, strict=True)
                }
            )
        self.unit.step(self.step)

    def run(self, begins: np.ndarray, ends: np.ndarray | None = None) -> np.ndarray:
        """Outputs at all ends of steps, shape (steps + 1, outputs), for inputs (steps, inputs) that
        are held over each step, or go from `begins` to `ends`.

        Row 0 is read under the base inputs, row k at the end of step k, before inputs change."""
        self.unit.restore(self.start)
        rows = np.empty((len(begins) + 1, len(self.read.values)))
        self.set(self.base)
        rows[0] = self.read()
        for number, begin in enumerate(begins):
            self.advance(begin, None if ends is None else ends[number])
            rows[number + 1] = self.read()
        return self._finite(rows)

    def free(self) -> np.ndarray:
        """Outputs under the present inputs, held: shape (steps + 1, outputs)."""
        return self.run(np.tile(self.base, (self.steps, 1)))

    def pulse(self, column: int, size: float, ramp: bool = False) -> tuple[np.ndarray, np.ndarray]:
        """Outputs under a change of one input over the first step, held or growing from nothing:
        at its beginning (outputs,), and at the ends of steps, once the input is back,
        (steps, outputs)."""
        self.unit.restore(self.start)
        changed = self.base.copy()
        changed[column] += size
        self.set(self.base if ramp else changed)
        begin = self.read().copy()
        rows = np.empty((self.steps, len(begin)))
        if ramp:
            self.advance(self.base, changed)
        else:
            self.advance(changed)
        for number in range(self.steps):
            if number:
                self.unit.step(self.step)
            else:
                self.set(self.base)
            rows[number] = self.read()
        self._finite(np.vstack([begin, rows]))
        return begin, rows

    def _finite(self, rows: np.ndarray) -> np.ndarray:
        """The rows, shape (steps + 1, outputs), unless some are no numbers."""
        wrong = np.argwhere(~np.isfinite(rows))
        if len(wrong):
            row, column = wrong[0]
            raise UnitError(
                f"{self.unit.name}: `{self.output_names[column]}` is {rows[row, column]} at"
                f" {self.start.time + row * self.step:.6g} s of a roll-out (allowed: finite)"
            )
        return rows


def flat_names(variables: Sequence[Variable]) -> list[str]:
    """Names of all elements, in the order of their values."""
    names = []
    for variable in variables:
        if not variable.shape:
            names.append(variable.name)
            continue
        for place in np.ndindex(variable.shape):
            names.append(f"{variable.name}[{','.join(str(i + 1) for i in place)}]")
    return names


def sizes_of_changes(rollout: Rollout) -> np.ndarray:
    """By how much each input is changed: its nominal value, as far as its bounds have room for
    twice that; negative where there is more room below."""
    sizes = []
    for variable, place in zip(rollout.inputs, rollout.write.slices, strict=True):
        for value in rollout.base[place]:
            up = np.inf if variable.max is None else variable.max - value
            down = np.inf if variable.min is None else value - variable.min
            if up >= min(2.0 * variable.nominal, down):
                sizes.append(min(variable.nominal, up / 2.0))
            else:
                sizes.append(-min(variable.nominal, down / 2.0))
    return np.array(sizes)


def _check(unit: Unit, names: Sequence[str], causality: str) -> None:
    if isinstance(names, str) or not names:
        raise ValueError(f"{causality}s {names!r} (allowed: a list of names)")
    for name in names:
        variable = unit.variable(name)
        is_tunable = causality == "input" and variable.variability == "tunable"
        if variable.causality != causality and not is_tunable:
            raise UnitError(f"`{name}` is a {variable.causality} (allowed here: {causality}s)")
        if not variable.is_number:
            raise UnitError(f"`{name}` is a {variable.kind} (allowed here: numbers)")
