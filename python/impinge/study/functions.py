"""Hashes of functions and of what they hold."""

from __future__ import annotations

import copyreg
import functools
import hashlib
import os
import pickle
import sys
import types
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

_LEAVES = int | float | complex | str | bytes | types.NoneType
_CONSTANTS = int | float | str | bytes | tuple | np.ndarray
_RANDOM = np.random.mtrand._rand  # of the process; distributions of SciPy hold it
_INSTALLED = {"site-packages", "dist-packages"}


def hash_of_function(function: Callable[..., Any]) -> str:
    """Returns a hash of a function's instructions, its constants and what it holds from where it
    was made, be it in modules and classes of the user's, but not of what other functions that it
    calls do.

    Of a callable object these are the methods of its class, unless that is installed, and its
    state. What cannot be described has another hash every time: its rows run again.
    """
    description = _Description()
    try:
        description.add(function)
    except Exception:  # whatever a class raises that has no state to tell
        return os.urandom(32).hex()
    return description.digest.hexdigest()


class _Description:
    """A hash of things in the order in which they are added, the same in any process."""

    def __init__(self) -> None:
        self.digest = hashlib.sha256()
        self._open: set[int] = set()  # things that hold what is being added
        self._kept: dict[int, tuple[int, Any]] = {}  # objects and classes by id, with their number

    def add(self, thing: Any) -> None:
        if id(thing) in self._open:
            return
        self._open.add(id(thing))
        self._add(thing)
        self._open.remove(id(thing))

    def _add(self, thing: Any) -> None:
        if isinstance(thing, types.MethodType):
            self.add(thing.__func__)
            self.add(thing.__self__)
            if isinstance(thing.__func__, types.FunctionType):
                self._add_attributes("self", thing.__self__, _names(thing.__func__.__code__))
        elif isinstance(thing, types.FunctionType):
            self._add_function(thing)
        elif isinstance(thing, types.CodeType):
            self._add_code(thing)
        elif isinstance(thing, functools.partial):
            self._add_text("partial")
            for part in (thing.func, thing.args, thing.keywords):
                self.add(part)
        elif type(thing) is np.ndarray and not thing.dtype.hasobject:
            self._add_word(str((thing.dtype, thing.shape)).encode() + thing.tobytes())
        elif type(thing) in (list, tuple):
            self._add_text(f"{type(thing).__name__} {len(thing)}")
            for item in thing:
                self.add(item)
        elif type(thing) in (dict, types.MappingProxyType):
            self._add_text(f"dict {len(thing)}")
            self._add_items(thing)
        elif type(thing) in (set, frozenset):
            self._add_set(thing)
        elif isinstance(thing, _LEAVES):
            self._add_text(repr(thing))
        elif thing is _RANDOM:
            self._add_text("numpy.random")
        elif isinstance(thing, type | types.ModuleType):
            self._add_text(_name_of(thing))
        else:
            self._add_object(thing)

    def _add_word(self, content: bytes) -> None:
        self.digest.update(word(content))

    def _add_text(self, text: str) -> None:
        self._add_word(text.encode())

    def _add_function(self, function: types.FunctionType) -> None:
        self._add_code(function.__code__)
        self.add([cell.cell_contents for cell in function.__closure__ or ()])
        self.add(function.__defaults__)
        if function.__kwdefaults__ is None:
            self.add(None)
        else:
            self._add_items(function.__kwdefaults__)
        is_installed = _is_installed(function.__module__)
        names = _names(function.__code__)
        for name in sorted(names & set(function.__globals__)):
            value = function.__globals__[name]
            if isinstance(value, _CONSTANTS) or not (is_installed or _is_called_by_name(value)):
                self.add((name, value))
            self._add_attributes(name, value, names)
        given = [*(function.__defaults__ or ()), *(function.__kwdefaults__ or {}).values()]
        held = [cell.cell_contents for cell in function.__closure__ or ()]
        for number, holder in enumerate([*given, *held]):
            self._add_attributes(str(number), holder, names)

    def _add_attributes(self, path: str, holder: Any, names: set[str], within: Any = ()) -> None:
        """Adds data that a function reaches by name through a module or a class, which nobody
        installed, and through those in it."""
        if not isinstance(holder, type | types.ModuleType) or _is_installed(_module_of(holder)):
            return
        for name in sorted(names):
            value = _attribute(holder, name)
            if isinstance(value, type | types.ModuleType):
                if value not in within:
                    self._add_attributes(f"{path}.{name}", value, names, (*within, holder))
            elif not _is_called_by_name(value) and _unwrapped(value)[0] is value:
                self.add((f"{path}.{name}", value))

    def _add_code(self, code: types.CodeType) -> None:
        self._add_word(code.co_code)
        self._add_text(repr((code.co_names, code.co_varnames, code.co_freevars)))
        for constant in code.co_consts:
            self.add(constant)

    def _add_items(self, items: Any) -> None:
        for key in sorted(items, key=repr):
            self.add(key)
            self.add(items[key])

    def _add_set(self, items: Any) -> None:
        if all(isinstance(item, _LEAVES) for item in items):
            self.add(sorted(map(repr, items)))
            return
        hashes = []
        for item in items:
            description = _Description()
            description.add(item)
            hashes.append(description.digest.hexdigest())
        self.add(sorted(hashes))

    def _is_new(self, thing: Any) -> bool:
        """Returns true if a thing was not added before; else adds its number."""
        if id(thing) in self._kept:
            number, _ = self._kept[id(thing)]
            self._add_text(f"again {number}")
            return False
        self._kept[id(thing)] = len(self._kept), thing
        return True

    def _add_object(self, thing: Any) -> None:
        """Adds the class of an object and its state, as `pickle` would take it."""
        reduce = copyreg.dispatch_table.get(type(thing))
        reduced = reduce(thing) if reduce else thing.__reduce_ex__(2)
        if isinstance(reduced, str):
            self._add_named(thing)
            return
        if not self._is_new(thing):
            return
        self._add_text(type(thing).__qualname__)
        self._add_class(type(thing))
        maker, given, state, items, pairs, *_ = (*reduced, None, None, None)
        self._add_text(f"{maker.__module__}.{_name_of(maker)}")
        self.add([given, state, list(items or ()), list(pairs or ())])

    def _add_named(self, thing: Any) -> None:
        """Adds the name of a thing, and the function that it wraps, if any."""
        if not hasattr(thing, "__wrapped__"):
            pickle.dumps(thing)  # fails where the name belongs to another thing or to none
        if hasattr(thing, "__dict__"):
            self._add_text(type(thing).__qualname__)
            self._add_items(vars(thing))
        else:
            self._add_text(_name_of(thing))

    def _add_class(self, kind: type) -> None:
        """Adds the methods and constants of a class and of those that it inherits from."""
        for base in kind.__mro__:
            if _is_installed(base.__module__) or not self._is_new(base):
                continue
            for name, value in sorted(vars(base).items()):
                own = _unwrapped(value)
                if callable(own[0]) or not (name.startswith("__") or name == "_abc_impl"):
                    self._add_text(name)
                    self.add(own)


def word(content: bytes) -> bytes:
    """Bytes after their number, so that no others look the same when words follow each other."""
    return f"{len(content)} ".encode() + content


def _names(code: types.CodeType) -> set[str]:
    """Names that a function looks up, and those inside it: comprehensions, generators, lambdas."""
    inner = (_names(part) for part in code.co_consts if isinstance(part, types.CodeType))
    return set(code.co_names).union(*inner)


def _unwrapped(value: Any) -> list[Any]:
    """An attribute of a class, or the functions that make it."""
    match value:
        case staticmethod() | classmethod():
            return [value.__func__]
        case property():
            return [value.fget, value.fset]
        case functools.cached_property():
            return [value.func]
        case _:
            return [value]


def _is_called_by_name(value: Any) -> bool:
    """Returns True if a global is a function, a class or a module rather than data, or None."""
    held = getattr(value, "__self__", None)
    holds_data = held is not None and not isinstance(held, type | types.ModuleType)
    return value is None or (hasattr(value, "__name__") and not holds_data)


def _is_installed(module: str | None) -> bool:
    """Returns True if a module belongs to Python or to an installed package, which nobody edits."""
    if not module or module.partition(".")[0] in sys.stdlib_module_names:
        return bool(module) and module != "__main__"
    file = getattr(sys.modules.get(module), "__file__", None)
    return bool(file) and not _INSTALLED.isdisjoint(Path(file).parts)


def _module_of(holder: type | types.ModuleType) -> str:
    return holder.__name__ if isinstance(holder, types.ModuleType) else holder.__module__


def _attribute(holder: type | types.ModuleType, name: str) -> Any:
    """An attribute of a class or module, None if it has none; modules make none on demand."""
    if isinstance(holder, types.ModuleType):
        return vars(holder).get(name)
    return getattr(holder, name, None)


def _name_of(thing: Any) -> str:
    named = getattr(thing, "__qualname__", None) or getattr(thing, "__name__", None)
    return str(named or type(thing).__qualname__)
