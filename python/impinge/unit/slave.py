"""What is common to instances of FMI 2.0 and 3.0: a component, and calls that must not fail."""

import ctypes
import os
from collections.abc import Callable
from ctypes import byref, c_char_p, c_size_t, c_void_p
from functools import partial
from pathlib import Path
from typing import Any
from weakref import WeakSet

import fmpy
import numpy as np

from impinge.errors import StepDiscarded, UnitError
from impinge.reading import reading
from impinge.unit.library import check_library
from impinge.unit.log import STATUS, Log
from impinge.unit.package import Package

_FATAL = 4
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
    with reading(f"{package.source}: its library {name}", UnitError):
        check_library(path)
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
    # What both versions call states, and the word before that for reading one from bytes.
    state = ""
    deserialize = ""

    def __init__(self, package: Package, log: Log):
        self.package = package
        self.log = log
        self._library = load(package)
        self.component: int | None = None
        self._functions_found: dict[str, Callable[..., Any]] = {}
        self.fatal: str | None = None  # what the unit said when it failed fatally
        self.accesses: WeakSet[Any] = WeakSet()  # readers and writers, which hold calls of it

    def must_live(self) -> None:
        """Bars further calls after a fatal failure, which FMI allows none of: they may crash."""
        if self.fatal is not None:
            raise UnitError(
                f"{self.fatal}; a unit that failed fatally cannot be used any more: make another"
            )

    def function(self, name: str, *types: Any, result: Any = ctypes.c_int) -> Callable[..., Any]:
        """The function of this name, whose first argument is the component."""
        self.must_live()
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
            refusal = self.refusal(status, what)
            if status == _FATAL:
                self._die(refusal)
            raise UnitError(refusal, self.log.take())

    def _die(self, refusal: str) -> None:
        self.fatal = refusal
        self._functions_found.clear()
        for access in list(self.accesses):
            access.close()

    def refusal(self, status: int, what: str) -> str:
        word = STATUS[status] if 0 <= status < len(STATUS) else f"status {status}"
        return f"{self.log.name}: {self.prefix}{what}: {word}"

    def discarded(self, time: float, terminated: bool, reason: str = "") -> StepDiscarded:
        return StepDiscarded(
            f"{self.log.name}: the step was discarded at {time!r} s" + (reason and f": {reason}"),
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
            arguments = (True, len(wanted), ctypes.addressof(names))
            status = self.function("SetDebugLogging", *types)(*arguments)
            if status == _FATAL:
                self.check(status, "SetDebugLogging")

    boolean: Any = ctypes.c_int

    # Life

    def terminate(self) -> None:
        """Ends the run. Whether the unit has anything against it does not matter any more."""
        if self.fatal is None:
            status = self.function("Terminate")()
            if status == _FATAL:
                self._die(self.refusal(status, "Terminate"))

    def reset(self) -> None:
        self.call("Reset")

    def free(self) -> None:
        """Frees the instance; one that failed fatally is left as it is."""
        if self.component and self.fatal is None:
            self.function("FreeInstance", result=None)()
        self.component = None

    # States

    def get_state(self, handle: c_void_p) -> None:
        self.call(f"Get{self.state}", byref(handle), types=(c_void_p,))

    def set_state(self, handle: c_void_p) -> None:
        self.call(f"Set{self.state}", handle, types=(c_void_p,))

    def free_state(self, handle: c_void_p) -> None:
        self.call(f"Free{self.state}", byref(handle), types=(c_void_p,))

    def to_bytes(self, handle: c_void_p) -> bytes:
        size = c_size_t()
        self.call(f"Serialized{self.state}Size", handle, byref(size), types=(c_void_p, c_void_p))
        buffer = ctypes.create_string_buffer(size.value)
        types = (c_void_p, c_void_p, c_size_t)
        self.call(f"Serialize{self.state}", handle, buffer, size, types=types)
        return buffer.raw

    def from_bytes(self, content: bytes, handle: c_void_p) -> None:
        types = (c_char_p, c_size_t, c_void_p)
        arguments = (content, len(content), byref(handle))
        self.call(f"{self.deserialize}{self.state}", *arguments, types=types)
