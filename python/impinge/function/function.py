"""Declaration of a Python function as a unit of a master."""

from __future__ import annotations

import copy
import keyword
from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np

from impinge.errors import FunctionError
from impinge.function.signature import BEFORE, RESERVED, STATE, STEP, read_signature
from impinge.function.unit import FunctionUnit
from impinge.measure import parse
from impinge.proposal import proposal
from impinge.unit.access import real_values
from impinge.unit.variable import Variable


class Function:
    """A Python function as a unit of a `Master`: a law, a characteristic, a sensor, a controller.

    f: takes its inputs by their names, numbers or arrays, and returns a mapping of its outputs, or
        the value alone where there is one output. It takes `time` [s], too, if it has a parameter
        of that name.
    inputs, outputs: by name, the unit of measurement ("W/m2", "degC", "1" of pure numbers, None
        where it is left open) or, of arrays, a pair of it and the shape: ("W/m2", 24).
    start: start values of inputs, and of outputs where f cannot give them at the start.
    state: the memory of a function that has a parameter `state`, at the start: any object. It then
        returns a pair (outputs, new state). It gets the length of the `step` [s] that ends at
        `time`, if it has this parameter, 0 at the start and where an input has just jumped.
    depends_on: by output, the inputs that it follows at once: all if left out.
    rollback: whether `state` is all that f remembers, so that a step can be taken again from a copy
        of it. If not, f is called once a step, which iterations and `adaptive` refuse.
    sampled: whether outputs hold over each step what f gave at its beginning, as those of a digital
        controller; if not, paths lead from one value to the next.
    name: of errors and records; that of f if left out.

    f gets its inputs at the end of the step. With a parameter `before`, it gets a dict of them at
    the beginning, too. A function with a state whose outputs all follow no input at once, and that
    has no `before`, gets the means over the step instead: that is of second order for what
    integrates its inputs.

    A `Function` is a description: each master starts with a memory of its own from `state`.
    Raises `FunctionError` for what does not fit together.
    """

    def __init__(
        self,
        f: Callable[..., Any],
        inputs: Mapping[str, Any],
        outputs: Mapping[str, Any],
        *,
        start: Mapping[str, Any] | None = None,
        state: Any = None,
        depends_on: Mapping[str, Iterable[str]] | None = None,
        rollback: bool = True,
        sampled: bool = False,
        name: str | None = None,
    ):
        self.name = _name(f) if name is None else name
        if not callable(f):
            raise self._fault(f"{f!r} is no function")
        self.f, self.rollback, self.sampled, self.state = f, rollback, sampled, state
        self._check_names(inputs, outputs)
        self.takes = read_signature(self.name, f, inputs)
        self._check_memory()
        variability = "discrete" if sampled else "continuous"
        variables = [self._variable(each, inputs[each], "input", "continuous") for each in inputs]
        variables += [
            self._variable(each, outputs[each], "output", variability) for each in outputs
        ]
        self.variables = {variable.name: variable for variable in self._started(variables, start)}
        self.inputs = {n: v for n, v in self.variables.items() if v.causality == "input"}
        self.outputs = {n: v for n, v in self.variables.items() if v.causality == "output"}
        self.started = frozenset(start or ())
        self.dependencies = self._dependencies(depends_on or {})

    @property
    def has_state(self) -> bool:
        """True if it has a memory."""
        return STATE in self.takes

    @property
    def follows_inputs(self) -> bool:
        """True if any output follows an input at once."""
        return any(self.dependencies.values())

    def open(self, name: str | None = None, time: float = 0.0) -> FunctionUnit:
        """A unit of this function, with its own memory, at `time` [s]; masters do this."""
        return FunctionUnit(self, self.name if name is None else name, time)

    def __repr__(self) -> str:
        ends = [", ".join(map(_written, each.values())) for each in (self.inputs, self.outputs)]
        words = []
        if self.has_state:
            words.append("with a state" if self.rollback else "with a state, without rollback")
        if self.sampled:
            words.append("sampled")
        more = f", {', '.join(words)}" if words else ""
        return f"<impinge.Function {self.name}({ends[0]}) -> {ends[1]}{more}>"

    # Declaration

    def _fault(self, what: str, variable: str | None = None) -> FunctionError:
        return FunctionError(f"Function {self.name}: {what}", self.name, variable=variable)

    def _check_names(self, inputs: Mapping[str, Any], outputs: Mapping[str, Any]) -> None:
        for what, given in (("inputs", inputs), ("outputs", outputs)):
            if not isinstance(given, Mapping):
                raise self._fault(f"{what} is {given!r}; a unit of measurement by name is needed")
        if not outputs:
            raise self._fault("has no outputs")
        for name in (*inputs, *outputs):
            if not isinstance(name, str) or not name.isidentifier() or keyword.iskeyword(name):
                raise self._fault(f"{name!r} is no name of a parameter (letters, digits and _)")
            if name in RESERVED:
                raise self._fault(f"`{name}` has a meaning of its own; name the variable otherwise")
            if name in inputs and name in outputs:
                raise self._fault(f"`{name}` is an input and an output", name)

    def _check_memory(self) -> None:
        if not self.has_state:
            if self.state is not None:
                raise self._fault("takes no parameter `state`, but there is one at the start")
            for each in (STEP, BEFORE):
                if each in self.takes:
                    raise self._fault(f"takes `{each}`, but no parameter `state`")
            if not self.rollback:
                raise self._fault("rollback=False is of functions with a `state` alone")
            return
        if self.state is None:
            raise self._fault("takes `state`; Function(…, state=…) says what it is at the start")
        if not self.rollback:
            return
        try:
            copy.deepcopy(self.state)
        except Exception as error:
            raise self._fault(
                f"its state cannot be copied ({error}): rollback=False calls it once a step"
            ) from error

    def _variable(self, name: str, told: Any, causality: str, variability: str) -> Variable:
        unit, shape = told if isinstance(told, tuple) and len(told) == 2 else (told, ())
        try:
            if unit is not None:
                parse(unit)
        except ValueError as error:
            raise self._fault(f"`{name}`: {error}", name) from None
        shape = shape if isinstance(shape, tuple) else (shape,)
        if not all(isinstance(n, int) and not isinstance(n, bool) and n >= 1 for n in shape):
            raise self._fault(
                f"`{name}` has the shape {shape} (allowed: whole numbers above 0)", name
            )
        return Variable(
            name=name,
            causality=causality,
            variability=variability,
            kind="Float64",
            unit=unit,
            quantity=None,
            start=np.zeros(shape) if shape else 0.0,
            nominal=1.0,
            min=None,
            max=None,
            shape=shape,
            description=f"{causality} of the function {self.name}",
            references=np.zeros(1, dtype=np.uint32),
        )

    def _started(
        self, variables: list[Variable], start: Mapping[str, Any] | None
    ) -> list[Variable]:
        """The variables with their start values, and a reference for each."""
        names = [variable.name for variable in variables]
        values = dict(start or {})
        for name in values:
            if name not in names:
                raise self._fault(f"start: there is no `{name}`{proposal(name, names)}", name)
        made = []
        for i, variable in enumerate(variables):
            begin = variable.start
            if variable.name in values:
                begin = self._start(variable, values[variable.name])
            references = np.array([i], dtype=np.uint32)
            made.append(Variable(**{**vars(variable), "start": begin, "references": references}))
        return made

    def _start(self, variable: Variable, value: Any) -> Any:
        try:
            array = real_values(value)
            array = np.broadcast_to(array, variable.shape) if array.size == 1 else array
            if array.shape != variable.shape:
                raise ValueError(f"has the shape {array.shape}, not {variable.shape}")
            if not np.isfinite(array).all():
                raise ValueError("is not finite")
        except (TypeError, ValueError) as error:
            raise self._fault(f"start: `{variable.name}` {error}", variable.name) from None
        return array.copy() if variable.shape else float(array)

    def _dependencies(self, given: Mapping[str, Iterable[str]]) -> dict[str, set[str]]:
        found = {name: set(self.inputs) for name in self.outputs}
        for output, inputs in given.items():
            if output not in found:
                told = f"depends_on: there is no output `{output}`{proposal(output, found)}"
                raise self._fault(told, output)
            names = [inputs] if isinstance(inputs, str) else list(inputs)
            for name in names:
                if name not in self.inputs:
                    told = f"depends_on: there is no input `{name}`{proposal(name, self.inputs)}"
                    raise self._fault(told, name)
            found[output] = set(names)
        return found


def _name(f: Any) -> str:
    inner = getattr(f, "func", f)  # of functools.partial
    name = getattr(inner, "__name__", type(inner).__name__)
    return "lambda" if name == "<lambda>" else name


def _written(variable: Variable) -> str:
    shape = f"[{','.join(map(str, variable.shape))}]" if variable.shape else ""
    return f"{variable.name}{shape} [{variable.unit or '?'}]"
