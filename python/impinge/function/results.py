"""Conversion of the results of a Python function to values of its outputs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from impinge.proposal import proposal
from impinge.unit.access import real_values
from impinge.unit.variable import Variable


class Fault(Exception):
    """Why what a function has returned does not fit; `variable` names the output at fault.

    `is_refusal` is true of values that are not finite: other inputs may have others.
    """

    def __init__(self, what: str, variable: str | None = None, is_refusal: bool = False):
        super().__init__(what)
        self.variable, self.is_refusal = variable, is_refusal


def split_state(returned: Any) -> tuple[Any, Any]:
    """The outputs and the new state of a function that has one."""
    if not isinstance(returned, tuple) or len(returned) != 2:
        raise Fault(f"returns {_shown(returned)}, not a pair (outputs, new state)")
    return returned


def read_outputs(returned: Any, outputs: Mapping[str, Variable]) -> list[np.ndarray]:
    """Flat values of all outputs, in their order. Raises `Fault`."""
    if not isinstance(returned, Mapping):
        if len(outputs) > 1:
            raise Fault(
                f"returns {_shown(returned)}, not a mapping of its outputs {', '.join(outputs)}"
            )
        returned = dict.fromkeys(outputs, returned)
    for name in returned:
        if name not in outputs:
            near = proposal(str(name), outputs)
            raise Fault(f"returns `{name}`, which is none of its outputs{near}", str(name))
    for name in outputs:
        if name not in returned:
            raise Fault(f"returns no `{name}`", name)
    return [_values(returned[name], variable) for name, variable in outputs.items()]


def _values(value: Any, variable: Variable) -> np.ndarray:
    name = variable.name
    try:
        array = real_values(value)
    except (OverflowError, TypeError, ValueError) as error:
        raise Fault(f"`{name}` is {_shown(value)}, which is no real number", name) from error
    if array.shape != variable.shape and not array.size == variable.size == 1:
        shape = f"the shape {variable.shape}" if variable.shape else "one number"
        raise Fault(f"`{name}` has the shape {array.shape}, where {shape} is declared", name)
    flat = array.ravel()
    if not np.isfinite(flat).all():
        raise Fault(f"`{name}` is {_first_of(flat)}", name, is_refusal=True)
    return flat


def _first_of(flat: np.ndarray) -> str:
    place = int(np.flatnonzero(~np.isfinite(flat))[0])
    return f"{flat[place]}" if flat.size == 1 else f"{flat[place]} at place {place} of {flat.size}"


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}…"
