"""What is common to instances of FMI 2.0 and 3.0: a component, and calls that must not fail."""

import ctypes
import os
from collections.abc import Callable
from ctypes import c_char_p
from functools import partial
from pathlib import Path
from typing import Any

import fmpy
import numpy as np

from impinge.errors import StepDiscarded, UnitError
from impinge.unit.log import STATUS, Log
from impinge.unit.package import Package

_LIBRARIES: dict[Path, ctypes.CDLL] = {}


def load(package: Package) -> ctypes.CDLL:
    """The package's shared library; it stays loaded."""
    platform = fmpy.platform_tuple if package.fmi == 3 else fmpy.platform
    name = package.description.coSimulation.modelIdentifier + fmpy.sharedLibraryExtension
    path = package.folder / "binaries" / platform / name
    if path in _LIBRARIES:
        return _LIBRARIES[path]
    if not path.is_file():
        raise UnitError(f"{package.source} holds no library for {platform}: {path.name}")
    before = Path.cwd()
    os.chdir(path.parent)  # some libraries look for others there
    try:
        _LIBRARIES[path] = ctypes.CDLL(str(path))
    except OSError as error:
        raise UnitError(f"{package.source}: its library does not load: {error}") from error
    finally:
        os.chdir(before)
    return _LIBRARIES[path]


def pointer(array: np.ndarray) -> int:
    """The address of an array's first element, for ctypes; the array must stay alive."""
    return array.ctypes.data


class Slave:
    """An instance of a unit. Subclasses name the functions of their version of FMI.

    Arguments of calls are addresses of arrays that callers keep, so that nothing is converted.
    """

    prefix = ""

    def __init__(self, package: Package, log: Log):
        self.package = package
        self.log = log
        self._library = load(package)
        self.component: int | None = None
        self._functions_found: dict[str, Callable[..., Any]] = {}

    def function(self, name: str, *types: Any, result: Any = ctypes.c_int) -> Callable[..., Any]:
        """The function of this name, whose first argument is the component."""
        known = self._functions_found.get(name)
        if known is not None:
            return known
        try:
            found = self._library[self.prefix + name]
        except AttributeError as error:
            raise UnitError(
                f"{self.package.name} lacks the function {self.prefix}{name}"
            ) from error
        found.argtypes = [ctypes.c_void_p, *types]
        found.restype = result
        self._functions_found[name] = partial(found, self.component)
        return self._functions_found[name]

    def call(self, name: str, *arguments: Any, types: tuple[Any, ...] = ()) -> None:
        """Calls a function that is not called often."""
        self.check(self.function(name, *types)(*arguments), name)

    def check(self, status: int, what: str) -> None:
        """Raises what the unit says if it refuses a call."""
        if status > 1:
            raise UnitError(self.refusal(status, what), self.log.take())

    def refusal(self, status: int, what: str) -> str:
        word = STATUS[status] if 0 <= status < len(STATUS) else f"status {status}"
        return f"{self.log.name}: {self.prefix}{what}: {word}"

    def discarded(self, time: float, terminated: bool) -> StepDiscarded:
        return StepDiscarded(
            f"{self.log.name}: the step was discarded at {time!r} s",
            time,
            self.log.take(),
            terminated,
        )

    def set_debug_logging(self) -> None:
        """Asks for warnings and errors alone, where the unit declares them as categories."""
        declared = {category.name for category in self.package.description.logCategories}
        levels = ("Warning", "Discard", "Error", "Fatal")
        wanted = sorted(declared & {f"logStatus{level}" for level in levels})
        if wanted:
            names = (c_char_p * len(wanted))(*(word.encode() for word in wanted))
            types = (self.boolean, ctypes.c_size_t, ctypes.c_void_p)
            self.function("SetDebugLogging", *types)(True, len(wanted), ctypes.addressof(names))

    boolean: Any = ctypes.c_int
