"""Units of impinge, and of any tool that makes FMI co-simulation units, from Python.

`Unit` drives one unit by names, `Master` couples several, `Function` makes a unit of a Python
function, `Surface` maps fields between cells of units and foreign meshes, `Study` runs many,
`linear_map` is what a linear unit makes of its inputs. Nothing here computes physics: units do.
"""

from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from typing import TYPE_CHECKING, Any

from impinge import errors
from impinge.errors import (
    FunctionError,
    ImpingeError,
    StepDiscarded,
    StudyError,
    StudyWarning,
    UnitError,
)
from impinge.unit import State, Unit, Variable

if TYPE_CHECKING:
    from impinge.function import Function
    from impinge.linear import linear_map, step_sensitivity
    from impinge.master import Connection, Master
    from impinge.reporting import report
    from impinge.study import Study
    from impinge.surface import Surface

try:
    __version__ = version("impinge")
except PackageNotFoundError:  # run from a checkout that is not installed
    __version__ = "0"

__all__ = [
    "Connection",
    "Function",
    "FunctionError",
    "ImpingeError",
    "Master",
    "State",
    "StepDiscarded",
    "Study",
    "StudyError",
    "StudyWarning",
    "Surface",
    "Unit",
    "UnitError",
    "Variable",
    "linear_map",
    "report",
    "step_sensitivity",
]

# Where names live that are imported when they are first asked for, and the extra that they need.
_LATER = {
    "Connection": ("impinge.master", None),
    "Function": ("impinge.function", None),
    "Master": ("impinge.master", None),
    "Surface": ("impinge.surface", "surface"),
    "Study": ("impinge.study", "study"),
    "linear_map": ("impinge.linear", "control"),
    "report": ("impinge.reporting", None),
    "step_sensitivity": ("impinge.linear", "control"),
}


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        raise AttributeError(f"module 'impinge' has no attribute '{name}'")
    module, extra = _LATER[name]
    try:
        return getattr(import_module(module), name)
    except ModuleNotFoundError as error:
        if extra is None or (error.name or "").split(".")[0] == "impinge":
            raise
        raise ImportError(
            f"impinge.{name} needs `{error.name}`, which is not installed: {errors.extra(extra)}"
        ) from error


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
