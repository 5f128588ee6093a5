"""What units log, and to whom it goes."""

import ctypes
import itertools
import logging
import os
import shutil
from collections import deque
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from weakref import WeakValueDictionary

import fmpy
from fmpy.fmi2 import (
    fmi2CallbackAllocateMemoryTYPE,
    fmi2CallbackFreeMemoryTYPE,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
)
from fmpy.fmi3 import fmi3LogMessageCallback

STATUS = ["ok", "warning", "discarded", "error", "fatal", "pending"]
Listener = Callable[[int, str, str], None]  # status, category, message
_LEVELS = [logging.DEBUG, logging.WARNING, logging.WARNING, logging.ERROR, logging.CRITICAL]
_KEYS = itertools.count(1)


class Log:
    """The messages of one instance: kept for errors to repeat, and told to a listener.

    Without a listener, warnings that no exception repeats go to Python's logger `impinge`.
    """

    def __init__(self, name: str, listener: Listener | logging.Logger | None):
        self.name = name
        self.key = next(_KEYS)
        self._messages: deque[tuple[int, str]] = deque(maxlen=100)
        self._fresh = 0  # those that no error has repeated
        self._listener = listener if callable(listener) else None
        self._logger = (
            listener if isinstance(listener, logging.Logger) else logging.getLogger("impinge")
        )
        _LOGS[self.key] = self

    def hear(self, status: int, category: str, message: str) -> None:
        """Takes a message in."""
        message = message.rstrip()
        if self._listener is not None:
            self._listener(status, category, message)
        if status >= 1:
            self._messages.append((status, message))
            self._fresh = min(self._fresh + 1, 100)
        if self._listener is None and status <= 1:
            self._logger.log(_LEVELS[status], "%s: %s", self.name, message)

    def take(self) -> list[str]:
        """The worst of the messages since this was last asked for; warnings only if no others."""
        messages = list(self._messages)[len(self._messages) - self._fresh :]
        self._fresh = 0
        errors = [message for status, message in messages if status >= 2]
        return errors or [message for _, message in messages]

    def __iter__(self) -> Iterator[str]:
        """The last hundred warnings and errors."""
        return iter([message for _, message in self._messages])


_LOGS: WeakValueDictionary[int, Log] = WeakValueDictionary()


def _text(raw: Any) -> str:
    return raw.decode("utf-8", errors="replace") if raw else ""


def _hear(environment: int | None, name: Any, status: int, category: Any, message: Any) -> None:
    log = _LOGS.get(environment or 0)
    if log is None:  # units that lose the environment still know their name
        log = next((each for each in list(_LOGS.values()) if each.name == _text(name)), None)
    if log is not None:
        log.hear(status, _text(category), _text(message))


def _hear3(environment: int | None, status: int, category: Any, message: Any) -> None:
    _hear(environment, None, status, category, message)


LOG_MESSAGE = fmi3LogMessageCallback(_hear3)
_LOGGER = fmi2CallbackLoggerTYPE(_hear)
_ALLOCATE = fmi2CallbackAllocateMemoryTYPE(fmpy.calloc)
_FREE = fmi2CallbackFreeMemoryTYPE(fmpy.free)
_WITH_PROXY: list[fmi2CallbackFunctions] = []


def callbacks(log: Log, folder: Path) -> fmi2CallbackFunctions:
    """The callbacks of an instance of FMI 2.0. The caller keeps them alive."""
    if not _WITH_PROXY:
        first = fmi2CallbackFunctions(
            logger=_LOGGER, allocateMemory=_ALLOCATE, freeMemory=_FREE, componentEnvironment=None
        )
        _add_proxy(first, folder)
        _WITH_PROXY.append(first)
    copy = fmi2CallbackFunctions.from_buffer_copy(_WITH_PROXY[0])
    copy.componentEnvironment = log.key
    return copy


def _add_proxy(functions: fmi2CallbackFunctions, folder: Path) -> None:
    """Lets FMPy's library put a message's arguments into it, which ctypes cannot.

    That library knows one logger at a time, so this is a copy of it: FMPy keeps its own.
    """
    name = "logging" + fmpy.sharedLibraryExtension
    library = Path(fmpy.__file__).parent / "logging" / fmpy.platform / name
    copy = folder / f"{os.getpid()}-{name}"
    try:
        shutil.copyfile(library, copy)
        add = ctypes.CDLL(str(copy)).addLoggerProxy
    except OSError:
        return  # messages come without their arguments
    add.argtypes = [ctypes.c_void_p]
    add.restype = None
    add(ctypes.byref(functions))
