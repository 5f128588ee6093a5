"""What a study keeps of every run."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

Series = Mapping[str, np.ndarray]


@dataclass(frozen=True)
class Output:
    """Something to keep of every run.

    needs: variables that it is made of. kind: `final` for the value at the stop, `over_time` for
    those at all multiples of the step, `maximum` and `minimum` over all times that the run stops
    at, its beginning included, `function` for `function(times, series)`, where `times` [s] has
    shape (n,) and `series[name]` (n, *shape of the variable), to a number or an array.
    """

    name: str
    needs: tuple[str, ...]
    kind: str = "final"
    function: Callable[[np.ndarray, Series], Any] | None = None
    unit: str | None = None

    @property
    def needs_all_times(self) -> bool:
        return self.kind != "final"

    def value(self, times: np.ndarray, series: Series, is_multiple: np.ndarray) -> np.ndarray:
        """Its value for a run; `is_multiple` marks times that are multiples of the step."""
        if self.function is not None:
            return np.asarray(self.function(times, series), float)
        values = series[self.needs[0]]
        match self.kind:
            case "over_time":
                return values[is_multiple]
            case "maximum":
                return values.max(axis=0)
            case "minimum":
                return values.min(axis=0)
            case _:
                return values[-1]


def final(variable: str, name: str | None = None) -> Output:
    """The value at the stop."""
    return Output(name or variable, (variable,))


def over_time(variable: str, name: str | None = None) -> Output:
    """Values at zero, all multiples of the step, and the stop."""
    return Output(name or f"{variable}(t)", (variable,), "over_time")


def maximum(variable: str, name: str | None = None) -> Output:
    """The largest value, element by element of a family, over the beginning and ends of steps."""
    return Output(name or f"max({variable})", (variable,), "maximum")


def minimum(variable: str, name: str | None = None) -> Output:
    """The smallest value, element by element of a family, over the beginning and ends of steps."""
    return Output(name or f"min({variable})", (variable,), "minimum")


def of_run(
    name: str,
    function: Callable[[np.ndarray, Series], Any],
    needs: Sequence[str],
    unit: str = "",
) -> Output:
    """`function(times, series)` of a whole run, to a number or an array of one shape."""
    return Output(name, tuple(needs), "function", function, unit)


def output_of(given: Any) -> Output:
    """What `given` means: an output, or the name of a variable, whose value at the stop it is."""
    if isinstance(given, Output):
        return given
    if isinstance(given, str):
        return final(given)
    raise ValueError(f"output {given!r} (allowed: a name, final, over_time, maximum, of_run, …)")
