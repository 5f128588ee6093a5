"""Parameters of a Python function: its declared inputs, and those that a master adds."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Collection
from typing import Any

from impinge.errors import FunctionError
from impinge.proposal import proposal

# Parameters that have a meaning of their own, if a function has them
STATE, TIME, STEP, BEFORE = "state", "time", "step", "before"
RESERVED = (STATE, TIME, STEP, BEFORE)
_SINGLE = (
    inspect.Parameter.POSITIONAL_ONLY,
    inspect.Parameter.POSITIONAL_OR_KEYWORD,
    inspect.Parameter.KEYWORD_ONLY,
)
_BY_NAME = _SINGLE[1:]


def read_signature(name: str, f: Callable[..., Any], inputs: Collection[str]) -> set[str]:
    """Returns which of the parameters of `RESERVED` the function takes.

    Raises `FunctionError` if it does not take all inputs by their names, or needs more than these.
    """
    try:
        parameters = inspect.signature(f).parameters.values()
    except (TypeError, ValueError) as error:
        raise FunctionError(
            f"Function {name}: Python does not know the parameters of {f!r}: call it from a"
            " function whose parameters are named as the inputs",
            name,
        ) from error
    taken = {p.name for p in parameters if p.kind in _BY_NAME}
    needed = [p for p in parameters if p.default is inspect.Parameter.empty and p.kind in _SINGLE]
    unknown = [p.name for p in needed if p.name not in (*inputs, *RESERVED)]
    for parameter in needed:
        if parameter.kind is inspect.Parameter.POSITIONAL_ONLY:
            told = f"takes `{parameter.name}` by position alone; inputs are passed by their names"
            raise FunctionError(f"Function {name} {told}", name, variable=parameter.name)
    if not any(p.kind is inspect.Parameter.VAR_KEYWORD for p in parameters):
        for each in inputs:
            if each not in taken:
                told = f"has no parameter for its input `{each}`{proposal(each, unknown)}"
                raise FunctionError(f"Function {name} {told}", name, variable=each)
    for each in unknown:
        known = ", ".join(inputs) or "(it has none)"
        told = f"takes `{each}`, which is none of its inputs {known}, nor {', '.join(RESERVED)}"
        near = proposal(each, [*inputs, *RESERVED])
        raise FunctionError(f"Function {name} {told}{near}", name, variable=each)
    return taken & set(RESERVED)
