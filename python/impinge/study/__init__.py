"""Many runs of a unit or a scene: sweeps, Latin hypercubes, Sobol's indices, paths of nozzles.

Names are imported when they are first asked for: processes that run rows need few of them.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from impinge import errors

if TYPE_CHECKING:
    from impinge.study.distributions import Levels, LogUniform, Normal, Uniform
    from impinge.study.outputs import Output, final, maximum, minimum, of_run, over_time
    from impinge.study.paths import FoundPath, path
    from impinge.study.sampling import Grid, LatinHypercube, Paired, Sobol
    from impinge.study.sensitivity import sobol_indices
    from impinge.study.signals import Table
    from impinge.study.study import Study

__all__ = [
    "FoundPath",
    "Grid",
    "LatinHypercube",
    "Levels",
    "LogUniform",
    "Normal",
    "Output",
    "Paired",
    "Sobol",
    "Study",
    "Table",
    "Uniform",
    "final",
    "maximum",
    "minimum",
    "of_run",
    "over_time",
    "path",
    "sobol_indices",
]

_MODULES = {
    "distributions": ("Levels", "LogUniform", "Normal", "Uniform"),
    "outputs": ("Output", "final", "maximum", "minimum", "of_run", "over_time"),
    "paths": ("FoundPath", "path"),
    "sampling": ("Grid", "LatinHypercube", "Paired", "Sobol"),
    "sensitivity": ("sobol_indices",),
    "signals": ("Table",),
    "study": ("Study",),
}
_OF_PATHS = _MODULES["paths"]
_PLACES = {name: module for module, names in _MODULES.items() for name in names}


def __getattr__(name: str) -> Any:
    if name not in _PLACES:
        raise AttributeError(f"module 'impinge.study' has no attribute '{name}'")
    try:
        return getattr(import_module(f"impinge.study.{_PLACES[name]}"), name)
    except ModuleNotFoundError as error:
        if name not in _OF_PATHS or error.name is None or error.name.startswith("impinge"):
            raise
        message = f"impinge.study.{name} needs `{error.name}`, which is not installed"
        raise ImportError(f"{message}: {errors.extra('path')}") from error


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
