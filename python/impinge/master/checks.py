"""What a master is asked for, before anything is made of it."""

from __future__ import annotations

import os
from collections.abc import Collection, Mapping, Sequence
from math import ceil, floor, isfinite, isnan
from numbers import Real
from typing import Any

import numpy as np

from impinge.function import Function, FunctionUnit
from impinge.master.any_unit import AnyUnit
from impinge.master.errors import MasterError
from impinge.master.stepping import SLIVER
from impinge.unit import Unit
from impinge.unit.variable import stem_of

# More would take weeks of the quickest units.
MOST_STEPS = 1e9
SCHEMES = ("jacobi", "gauss-seidel", "iterate")


def check_choices(
    scheme: str, order: int, extrapolation: int | None, max_iterations: int, relaxation: Any
) -> None:
    """Words and counts."""
    if scheme not in SCHEMES:
        raise MasterError(f"scheme is `{scheme}`; it may be {', '.join(SCHEMES)}")
    for name, value in (("order", order), ("extrapolation", extrapolation)):
        if value not in (None, 0, 1, 2):
            raise MasterError(f"{name} is {value}; it may be 0, 1 or 2")
    if max_iterations < 1:
        raise MasterError(f"max_iterations is {max_iterations}; it must be at least 1")
    _check_positive("relaxation", relaxation)


def check_lengths(step: Any, tolerance: Any, least: Any, largest: Any) -> None:
    """Numbers that must be above zero: steps of zero or less never come to an end."""
    _check_positive("step", step, "s")
    _check_positive("tolerance", tolerance)
    _check_positive("least_step", least, "s")
    if not _is_number(largest) or isnan(largest) or largest <= 0:
        raise MasterError(f"largest_step is {largest!r} s; it must be above 0")
    if least is not None and least > largest:
        raise MasterError(f"least_step ({least!r} s) is above largest_step ({largest!r} s)")


def check_names(what: str, names: Any) -> None:
    """A list of names, which one text is not."""
    if isinstance(names, str):
        raise MasterError(f"{what} is {names!r}; a list of names is needed: [{names!r}]")


def flat_numbers(name: str, value: Any, shape: tuple[int, ...]) -> np.ndarray:
    """The finite numbers of an input, flat, of one number or of an array of its shape."""
    try:
        numbers = np.broadcast_to(np.asarray(value, float), shape).ravel()
    except (OverflowError, TypeError, ValueError):
        wanted = f"numbers of the shape {shape}" if shape else "a number"
        raise MasterError(f"inputs: {name} is {value!r}; {wanted} or a function of time") from None
    if not np.isfinite(numbers).all():
        raise MasterError(f"inputs: {name} is {value!r}, which is not finite")
    return numbers


def check_jumps(jumps: Sequence[Any], start: float) -> None:
    """Times that a run can come to."""
    for jump in jumps:
        if not _is_number(jump) or not isfinite(jump):
            raise MasterError(f"jumps: {jump!r} is no time in s")
        if jump < start:
            raise MasterError(f"jumps: {jump!r} s is before the start at {start!r} s")


def check_stop(stop: Any, time: float) -> None:
    """Where a run is to end."""
    if not _is_number(stop) or not isfinite(stop):
        raise MasterError(f"run: {stop!r} is no time in s to stop at")
    if stop < time:
        raise MasterError(f"run: {stop!r} s is before {time!r} s, where the run stands")


def check_count(step: float | None, left: float) -> None:
    """How many steps a run takes, where these are of one length [s]."""
    if step is not None and left > MOST_STEPS * step:
        raise MasterError(
            f"run: {left / step:.3g} steps of {step:g} s; allowed: {left / MOST_STEPS:.3g} s or"
            f" more, for at most {MOST_STEPS:.0e} steps"
        )


def check_end(what: str, time: float, begin: float, step: float, fixed: Sequence[str]) -> None:
    """Checks that a step ends at `time` [s], where units (`fixed`) take steps of one length alone,
    from `begin` [s] on."""
    count = (time - begin) / step
    if fixed and abs(count - round(count)) > SLIVER:
        before, after = (begin + step * whole for whole in (floor(count), ceil(count)))
        raise MasterError(
            f"{what}: {time!r} s is within a step, and {', '.join(fixed)} take steps of one length"
            f" alone, {step:g} s; allowed: {before:.9g} s or {after:.9g} s"
        )


def check_units(
    units: Mapping[str, Unit | Function | str | os.PathLike[str]], parameters: Mapping[str, Any]
) -> None:
    """Names, and that each unit stands under one of them; parameters are of units that are made."""
    if not isinstance(units, Mapping):
        raise MasterError(f"units is {units!r}; a mapping of names to units is needed")
    given: dict[int, str] = {}
    for name, unit in units.items():
        if not isinstance(name, str) or not name or "." in name:
            raise MasterError(f"`{name}`: names of units are texts without dots")
        if callable(unit) and not isinstance(unit, Function):
            raise MasterError(
                f"{name} is {unit!r}: Function(f, inputs={{…}}, outputs={{…}}) makes a unit of it"
            )
        if not isinstance(unit, Unit):
            continue
        if id(unit) in given:
            raise MasterError(
                f"{given[id(unit)]} and {name} are one and the same unit: make two of its source"
            )
        given[id(unit)] = name
    for name in parameters:
        if name not in units:
            raise MasterError(f"parameters: `{name}` names none of the units {', '.join(units)}")
        if isinstance(units[name], Function):
            raise MasterError(
                f"parameters: {name} is a Function, which has none; functools.partial(f, …) sets"
                " those of f"
            )
        if name in given.values():
            raise MasterError(
                f"parameters: {name} is a Unit that has been initialised already;"
                " Unit(…, parameters={…}) sets them"
            )


def check_input(unit: AnyUnit, name: str, variable: str) -> None:
    """Whether a value over time may be set: of inputs alone, and of numbers."""
    target = unit.variable(variable)
    if target.causality != "input":
        hint = ""
        if target.causality in ("parameter", "structuralParameter"):
            hint = "; parameters={unit: {name: value}} sets it before the start"
        raise MasterError(f"inputs: {name} is no input, but {target.causality}{hint}")
    if not target.is_number:
        raise MasterError(f"inputs: {name} is a {target.kind}; only numbers are set")


def check_memoryless(names: Collection[str], units: Mapping[str, AnyUnit]) -> None:
    """Whether these are names of units."""
    unknown = set(names) - set(units)
    if unknown:
        raise MasterError(f"memoryless: no unit is called {', '.join(sorted(unknown))}")
    functions = [name for name in names if isinstance(units[name], FunctionUnit)]
    if functions:
        raise MasterError(
            f"memoryless: {', '.join(sorted(functions))}: a Function says itself whether it has a"
            " state"
        )


def check_set(function: FunctionUnit, names: Collection[str]) -> None:
    """Checks that a connection, `inputs` or its start gives every input of a function a value."""
    stems = {stem_of(name) for name in names}
    for name in function.inputs:
        if name not in stems and name not in function.function.started:
            raise MasterError(
                f"{function.name}.{name} has no value: no connection and no `inputs` set it, and"
                f" Function(…, start={{{name!r}: …}}) gives none"
            )


def check_rollback(
    functions: Collection[FunctionUnit], repeated: Collection[str], is_adaptive: bool
) -> None:
    """Checks that functions that are called once a step are in no step that may be repeated."""
    for function in functions:
        if function.can.states or not (is_adaptive or function.name in repeated):
            continue
        why = "adaptive=True" if is_adaptive else 'scheme="iterate"'
        raise MasterError(
            f"{function.name}: {why} takes steps again, but this Function was made with"
            " rollback=False: leave that out if `state` is all that it remembers; else take"
            ' scheme="gauss-seidel" with steps of one length'
        )


def _check_positive(name: str, value: Any, unit: str = "") -> None:
    if value is None:
        return
    if not _is_number(value) or not isfinite(value) or value <= 0:
        told = f"{value!r} {unit}".strip()
        raise MasterError(f"{name} is {told}; it must be a number above 0")


def _is_number(value: Any) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)
