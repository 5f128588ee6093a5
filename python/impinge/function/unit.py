"""A unit that calls a Python function: what masters do with units, in Python alone."""

from __future__ import annotations

import copy
from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass
from math import inf
from typing import TYPE_CHECKING, Any

import numpy as np

from impinge.errors import FunctionError, UnitError
from impinge.function.results import Fault, read_outputs, split_state
from impinge.function.signature import BEFORE, STATE, STEP, TIME
from impinge.jumps import near
from impinge.measure import Measure, parse
from impinge.proposal import proposal
from impinge.unit.access import Reader, Writer
from impinge.unit.variable import Capabilities, Variable, element_of, stem_of

if TYPE_CHECKING:
    from impinge.function.function import Function

_ATOMS = (bool, int, float, complex, str, bytes, type(None), np.generic)  # never changed in place
_SHOWN = 6  # inputs that an error shows


@dataclass
class FunctionState:
    """A state of one unit at `time` [s]: its values, and its memory at both ends of the step."""

    time: float
    size: float
    values: np.ndarray
    before: np.ndarray
    means: np.ndarray
    memory: tuple[Any, Any]

    def free(self) -> None:
        """There is nothing to give up."""


class FunctionUnit:
    """A Python function at `time` [s]: `values` of its inputs, then of its outputs.

    The function is called when outputs are read that belong to other inputs, or to an earlier time,
    than it was called with last. Its memory goes on from the beginning of the last step, however
    often that is taken; `settle` ends the step.
    """

    types = {"Float64": np.float64}

    def __init__(self, function: Function, name: str, time: float):
        self.function, self.name = function, name
        self._label = name if name == function.name else f"{name} (function {function.name})"
        self.time = time
        self._places: dict[int, slice] = {}
        count = 0
        for variable in self.variables.values():
            self._places[int(variable.references[0])] = slice(count, count + variable.size)
            count += variable.size
        self._count = sum(variable.size for variable in self.inputs.values())
        starts = [np.ravel(variable.start) for variable in self.variables.values()]
        self.values = np.concatenate(starts).astype(float)
        self._before = self._means = self.values[: self._count].copy()
        self._path: tuple[np.ndarray, np.ndarray] | None = None
        memory = self._copied(function.state) if function.rollback else function.state
        self._memory = self._next_memory = memory
        self._size = 0.0
        self._has_begun = False
        self._follows = self._dependency_mask()
        self._is_started = self._output_mask(function.started)
        self._changed = np.zeros(self._count, bool)
        self._is_new = True  # no output belongs to this time
        self._calls = {False: 0, True: 0}  # before and after the first step
        self._called_with = self.values[: self._count].copy()
        self.ends_at_jump = self.begins_at_jump = False

    def _dependency_mask(self) -> np.ndarray:
        """True where values of outputs (rows) follow those of inputs (columns) at once."""
        mask = np.zeros((len(self.values) - self._count, self._count), bool)
        for output, inputs in self.function.dependencies.items():
            for name in inputs:
                mask[self._output_mask({output}), self._place(self.variables[name])] = True
        return mask

    def _output_mask(self, names: Collection[str]) -> np.ndarray:
        mask = np.zeros(len(self.values), bool)
        for name in names:
            mask[self._place(self.variables[name])] = True
        return mask[self._count :]

    def _place(self, variable: Variable) -> slice:
        return self._places[int(variable.references[0])]

    # Variables

    @property
    def scene(self) -> str:
        """A function is packed from no scene."""
        return ""

    @property
    def variables(self) -> dict[str, Variable]:
        """Inputs and outputs by name."""
        return self.function.variables

    @property
    def inputs(self) -> dict[str, Variable]:
        """Inputs by name."""
        return self.function.inputs

    @property
    def outputs(self) -> dict[str, Variable]:
        """Outputs by name."""
        return self.function.outputs

    def variable(self, name: str) -> Variable:
        """The variable of this name, or the element `name[i,j]` of one, counted from 1."""
        found, array = self.variables.get(name), self.variables.get(stem_of(name))
        if found is None and array is not None:
            found = element_of(array, name)
        if found is None:
            near = proposal(name, self.variables)
            if array is not None:
                near = f"; `{array.name}` has the shape {array.shape}"
            raise UnitError(f"{self._label} has no variable `{name}`{near}")
        return found

    @property
    def can(self) -> Capabilities:
        """Its capabilities: all that concern states, unless it has no rollback."""
        return Capabilities(
            states=self.function.rollback,
            serialise=False,
            interpolates=0 if self.takes_ends or self.takes_means else 2,
            output_derivatives=0,
            variable_steps=True,
            directional_derivatives=False,
            adjoint_derivatives=False,
            early_return=False,
            once_per_process=False,
        )

    @property
    def takes_ends(self) -> bool:
        """True if its memory knows of inputs at the ends of steps alone."""
        function = self.function
        return function.has_state and BEFORE not in function.takes and function.follows_inputs

    @property
    def takes_means(self) -> bool:
        """True if it is called with the means of inputs over steps."""
        function = self.function
        return function.has_state and BEFORE not in function.takes and not function.follows_inputs

    @property
    def default_step(self) -> None:
        """It proposes no step."""
        return None

    @property
    def identity(self) -> str:
        """Its name in records."""
        return f"function {self.function.name}"

    def depends_on(self, output: str) -> set[str]:
        """The inputs that an output follows at once."""
        return set(self.function.dependencies[self.variable(stem_of(output)).name])

    def measure(self, unit: str | None) -> Measure | None:
        """The unit of measurement of this name."""
        return None if unit is None else parse(unit)

    def is_mean(self, name: str) -> bool:
        """No output is a mean over the last step unless a connection says so."""
        return False

    def cells(self, name: str) -> dict[str, Any]:
        """A function has no cells."""
        raise UnitError(f"{self._label} tells no cells of `{name}`")

    def areas(self, name: str) -> np.ndarray:
        """A function has no areas."""
        raise UnitError(f"{self._label} tells no areas of `{name}`")

    def placement(self, name: str) -> dict[str, Variable]:
        """A function has no loads."""
        return {}

    def coordinates(self, name: str) -> dict[str, np.ndarray]:
        """A function has no places."""
        raise UnitError(f"{self._label} tells no places of `{name}`")

    def __repr__(self) -> str:
        return f"<impinge.FunctionUnit {self._label} at {self.time!r} s>"

    # Values

    def reader(self, names: Iterable[str]) -> Reader:
        """A call that reads these names into one flat array, over and over."""
        return Reader(self, [self.variable(name) for name in names], self._array)

    def writer(self, names: Iterable[str]) -> Writer:
        """A call that sets these inputs from one flat array, over and over."""
        variables = [self.variable(name) for name in names]
        for variable in variables:
            if variable.causality != "input":
                raise UnitError(f"{self._label}: `{variable.name}` is no input, but an output")
        return Writer(self, variables, self._array)

    def _array(self, name: str) -> Variable:
        return self.variables[stem_of(name)]

    def access(
        self, verb: str, kind: str, references: np.ndarray, values: np.ndarray
    ) -> Callable[[], int]:
        """A call that gets or sets values, from or into `values`."""
        spans = [self._places[int(reference)] for reference in references]
        index = np.concatenate([np.arange(span.start, span.stop) for span in spans])
        reads_outputs = verb == "Get" and bool((index >= self._count).any())

        def get() -> int:
            if reads_outputs:
                self.settle()
            values[:] = self.values[index]
            return 0

        def put() -> int:
            self._changed[index] |= self.values[index] != values
            self.values[index] = values
            return 0

        return get if verb == "Get" else put

    def __getitem__(self, name: str) -> Any:
        variable = self.variable(name)
        values = self.reader([name])()
        return values.reshape(variable.shape).copy() if variable.shape else values.item()

    def __setitem__(self, name: str, value: Any) -> None:
        writer = self.writer([name])
        writer.fill([value])
        writer()

    # Time

    def places(self, names: Iterable[str]) -> np.ndarray:
        """The places of these inputs among all of them, for `follow`."""
        found = [np.zeros(0, int)]
        for name in names:
            variable = self.variable(name)
            span = self._place(variable)
            every = np.arange(span.start, span.stop)
            found.append(every if variable.element is None else every[[variable.element]])
        return np.concatenate(found)

    def follow(
        self, places: np.ndarray, before: np.ndarray, end: np.ndarray, means: np.ndarray
    ) -> None:
        """Sets inputs for the next step: at both its ends, and their means over it."""
        self.settle()
        path = self.values[: self._count].copy(), self.values[: self._count].copy()
        path[0][places], path[1][places] = before, means
        self._path = path
        self.values[places] = end

    def step_to(self, time: float) -> None:
        """Advances to `time` [s], on what `follow` has set, or on inputs as they are."""
        size = time - self.time
        if not 0.0 <= size < inf:
            raise UnitError(f"{self._label}: step size {size!r} s is not positive and finite")
        self.settle()
        inputs = self.values[: self._count]
        self._before, self._means = self._path or (inputs.copy(), inputs.copy())
        self._path = None
        self._memory = self._next_memory
        self.time, self._size, self._has_begun = time, size, True
        self._is_new, self.begins_at_jump = True, False
        if not self.function.follows_inputs:
            self.settle()  # inputs that are set from now on are of the next step

    def cross_jump(self) -> None:
        """Goes over to what a function of time is just after a jump, and to inputs that jump.

        A function with a state ends its step with the inputs of before; new ones are a step of
        zero length. What is sampled takes the sample of this time with them instead.
        """
        function = self.function
        if self.ends_at_jump and TIME in function.takes and not function.has_state:
            self._is_new = self.begins_at_jump = True
        self.ends_at_jump = False
        if self._follows_jumps and self._has_begun:
            self.settle()
            self._memory, self._size = self._next_memory, 0.0

    @property
    def _follows_jumps(self) -> bool:
        function = self.function
        return (
            function.has_state
            and function.follows_inputs
            and function.rollback
            and not function.sampled
        )

    # States

    def state(self, into: FunctionState | None = None) -> FunctionState:
        """The present state."""
        if not self.function.rollback:
            raise UnitError(f"{self._label} cannot save and restore its state")
        self.settle()
        return FunctionState(
            self.time,
            self._size,
            self.values.copy(),
            self._before,
            self._means,
            (self._memory, self._next_memory),
        )

    def restore(self, state: FunctionState) -> None:
        """Goes back to a state of this unit."""
        self.time, self._size = state.time, state.size
        self.values[:] = state.values
        self._before, self._means = state.before, state.means
        self._memory, self._next_memory = state.memory
        self._changed[:] = False
        self._is_new = False

    # Calls

    def settle(self) -> None:
        """Calls the function, if its outputs do not belong to the present inputs and time."""
        if self._is_new:
            self._evaluate(np.ones(len(self._follows), bool))
        elif self._changed.any() and self.function.rollback and self.function.follows_inputs:
            rows = self._follows[:, self._changed].any(axis=1)
            if rows.any() or self.function.has_state or self._is_to_be_checked():
                self._follow_changes(rows)
        self._is_new = False
        self._changed[:] = False

    def _follow_changes(self, rows: np.ndarray) -> None:
        """Calls the function for other inputs at the same time. One that cannot bear a step of zero
        length goes on with what it gave before the jump."""
        try:
            self._evaluate(rows)
        except FunctionError as error:
            is_behind_jump = self._follows_jumps and self._has_begun and not self._size
            if not (is_behind_jump and error.is_refusal):
                raise

    def _evaluate(self, rows: np.ndarray) -> None:
        """Calls the function for the values in these rows; others do not follow what changed."""
        if not self._has_begun:
            rows = rows & ~self._is_started
            if self._is_started.all():
                return
        is_to_be_checked = self._is_to_be_checked()
        outputs, memory = self._call()
        if is_to_be_checked:
            self._check_again(outputs)
            self._check_dependencies(outputs)
        self._calls[self._has_begun] += 1
        self._called_with[:] = self.values[: self._count]
        kept = ~rows if self._has_begun else ~rows & ~self._is_started
        held = self.values[self._count :]
        if not self.function.has_state and not np.array_equal(held[kept], outputs[kept]):
            raise self._misdeclared(kept & (held != outputs))
        held[rows] = outputs[rows]
        self._next_memory = memory

    def _is_to_be_checked(self) -> bool:
        """True for the first call, the second, the fourth and so on, which cost little in all."""
        function = self.function
        count = self._calls[self._has_begun] + 1
        is_called = self._has_begun or not self._is_started.all()
        return function.rollback and is_called and count & (count - 1) == 0

    def _check_again(self, outputs: np.ndarray) -> None:
        """Finds what the function remembers beside its state, which no step could take back."""
        again, _ = self._call()
        if not np.array_equal(outputs, again):
            name = self._name_of(np.flatnonzero(outputs != again)[0])
            remedy = "a parameter `state` holds what it remembers, random generators included"
            if self.function.has_state:
                remedy += "; rollback=False calls it once a step"
            raise self._error(f"`{name}` differs when it is called twice: {remedy}", name)

    def _check_dependencies(self, outputs: np.ndarray) -> None:
        """Finds outputs that follow inputs which they are declared not to follow, among those that
        have changed since the last call."""
        if self.function.has_state:
            return
        inputs = self.values[: self._count]
        present = inputs.copy()
        for follows in np.unique(self._follows, axis=0):
            inputs[:] = np.where(follows, present, self._called_with)
            try:
                others = outputs if np.array_equal(inputs, present) else self._call()[0]
            except FunctionError:  # it cannot bear inputs that do not go together
                continue
            finally:
                inputs[:] = present
            rows = (self._follows == follows).all(axis=1) & (outputs != others)
            if rows.any():
                raise self._misdeclared(rows)

    def _misdeclared(self, rows: np.ndarray) -> FunctionError:
        name = self._name_of(np.flatnonzero(rows)[0])
        return self._error(f"`{name}` follows inputs that `depends_on` does not name", name)

    def _call(self) -> tuple[np.ndarray, Any]:
        arguments = self._arguments()
        try:
            returned = self.function.f(**arguments)
        except Exception as error:
            told = f"{type(error).__name__}: {error}".rstrip(": ")
            raised = self._error(f"fails with {told}{self._hint()}")
            raised.is_refusal = isinstance(error, ArithmeticError | ValueError)
            raise raised from error
        try:
            memory = None
            if self.function.has_state:
                returned, memory = split_state(returned)
            return np.concatenate(read_outputs(returned, self.outputs)), memory
        except Fault as fault:
            raised = self._error(str(fault), fault.variable)
            raised.is_refusal = fault.is_refusal
            raise raised from fault.__cause__

    def _hint(self) -> str:
        if self._has_begun or STEP not in self.function.takes:
            return ""
        return " (the step is 0 at the start; `start` values of all outputs spare this call)"

    def _arguments(self) -> dict[str, Any]:
        taken, inputs = self.function.takes, self.values[: self._count]
        bad = np.flatnonzero(~np.isfinite(inputs))
        if bad.size:
            name = self._name_of(int(bad[0]) - self._count)
            raised = self._error(f"its input `{name}` is {inputs[bad[0]]}", name)
            raised.is_refusal = True
            raise raised
        if self._has_begun and self.takes_means:
            inputs = self._means
        arguments = self._named(inputs)
        if TIME in taken:
            arguments[TIME] = self._seen_time()
        if STATE in taken:
            rollback = self.function.rollback
            arguments[STATE] = self._copied(self._memory) if rollback else self._memory
        if STEP in taken:
            arguments[STEP] = self._size
        if BEFORE in taken:
            arguments[BEFORE] = self._named(self._before if self._size else inputs)
        return arguments

    def _seen_time(self) -> float:
        """The time, or just before or after it where a function of time jumps."""
        if self.function.has_state or not (self.ends_at_jump or self.begins_at_jump):
            return self.time
        apart = near(self.time, self._size)
        return self.time + (apart if self.begins_at_jump else -apart)

    def _named(self, inputs: np.ndarray) -> dict[str, Any]:
        found: dict[str, Any] = {}
        for name, variable in self.inputs.items():
            values = inputs[self._place(variable)]
            shaped = values.reshape(variable.shape).copy() if variable.shape else values.item()
            found[name] = shaped
        return found

    def _copied(self, memory: Any) -> Any:
        if isinstance(memory, _ATOMS):
            return memory
        try:
            return copy.deepcopy(memory)
        except Exception as error:
            raise self._error(f"its state cannot be copied: {error}") from error

    def _name_of(self, row: int) -> str:
        """The variable of an output's value; of an input's, counted back from the outputs."""
        place = int(row) + self._count
        for variable in self.variables.values():
            span = self._place(variable)
            if span.start <= place < span.stop:
                return variable.name
        raise AssertionError("unreachable")

    def _error(self, what: str, variable: str | None = None) -> FunctionError:
        with_inputs = [
            f"{name} = {_brief(self.values[self._place(each)])}"
            for name, each in list(self.inputs.items())[:_SHOWN]
        ]
        told = f" with {', '.join(with_inputs)}" if with_inputs else ""
        return FunctionError(
            f"{self._label}, at {self.time:.9g} s{told}: {what}", self.name, self.time, variable
        )


def _brief(values: np.ndarray) -> str:
    if values.size == 1:
        return f"{values.item():.9g}"
    return f"{values.min():.6g} to {values.max():.6g}"
