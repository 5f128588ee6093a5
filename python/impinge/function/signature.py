"""What a Python function takes: the inputs that are declared, and what a master adds to them."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Collection
from typing import Any

from impinge.errors import FunctionError
from impinge.proposal import proposal

# Parameters that have a meaning of their own, if a function has them
STATE, TIME, STEP, BEFORE = "state", "time", "step", "before"
RESERVED = (STATE, TIME, STEP, BEFORE)
_BY_NAME = (inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY)


def read_signature(name: str, f: Callable[..., Any], inputs: Collection[str]) -> set[str]:
    """Returns which of the parameters of `RESERVED` the function takes.

    Raises `FunctionError` if it does not take all inputs by their names, or needs more than these.
    """
    try:
        parameters = inspect.signature(f).parameters.values()
    except (TypeError, ValueError) as error:
        raise FunctionError(
            f"{name}: Python does not know the parameters of {f!r}: call it from a function whose"
            " parameters are named as the inputs",
            name,
        ) from error
    taken = {p.name for p in parameters if p.kind in _BY_NAME}
    takes_any = any(p.kind is inspect.Parameter.VAR_KEYWORD for p in parameters)
    missing = [each for each in inputs if each not in taken]
    needed = [
        p.name
        for p in parameters
        if p.default is inspect.Parameter.empty
        and p.kind not in (inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD)
        and not (p.kind in _BY_NAME and p.name in (*inputs, *RESERVED))
    ]
    if missing and not takes_any:
        raise FunctionError(
            f"{name} has no parameter for its input `{missing[0]}`{proposal(missing[0], needed)}",
            name,
            variable=missing[0],
        )
    if needed:
        raise FunctionError(
            f"{name} takes `{needed[0]}`, which is none of its inputs"
            f" {', '.join(inputs) or '(it has none)'}, nor {', '.join(RESERVED)}"
            f"{proposal(needed[0], [*inputs, *RESERVED])}",
            name,
            variable=needed[0],
        )
    return taken & set(RESERVED)
