"""Instances of FMI 2.0."""

import ctypes
from collections.abc import Callable
from ctypes import byref, c_char_p, c_double, c_int, c_size_t, c_void_p
from functools import partial
from math import nan
from typing import Any

import numpy as np

from impinge.errors import UnitError
from impinge.unit.log import Log, callbacks
from impinge.unit.package import Package
from impinge.unit.slave import Slave, pointer
from impinge.unit.temporary import temporary_folder
from impinge.unit.variable import NUMBERS

_CO_SIMULATION = 1
_LAST_SUCCESSFUL_TIME, _TERMINATED = 2, 3
_DISCARD, _FATAL = 2, 4


class Fmi2(Slave):
    """An instance by the functions of FMI 2.0."""

    prefix = "fmi2"
    state = "FMUstate"
    deserialize = "DeSerialize"
    types = {key: NUMBERS[key] for key in ("Real", "Integer", "Boolean", "Enumeration")}
    _functions = {"Enumeration": "Integer"}

    def __init__(self, package: Package, log: Log):
        super().__init__(package, log)
        self._callbacks = callbacks(log, temporary_folder().path)
        instantiate = self._library["fmi2Instantiate"]
        instantiate.argtypes = [c_char_p, c_int, c_char_p, c_char_p, c_void_p, c_int, c_int]
        instantiate.restype = c_void_p
        self.component = instantiate(
            log.name.encode(),
            _CO_SIMULATION,
            package.description.guid.encode(),
            (package.folder / "resources").as_uri().encode(),
            ctypes.addressof(self._callbacks),
            False,
            True,
        )
        if not self.component:
            raise UnitError(f"{package.source}: no instance could be made", log.take())
        self.set_debug_logging()
        # Filled by the call itself: an exception of a signal cannot come between.
        self._statuses: list[int] = []
        self._began = nan
        types = (c_double, c_double, c_int)
        self._do_step = self.function("DoStep", *types, result=self._statuses.append)
        self._keep_past = not package.can.states

    def setup(self, start: float, stop: float | None) -> None:
        types = (c_int, c_double, c_double, c_int, c_double)
        arguments = (False, 0.0, start, stop is not None, stop or 0.0)
        self.call("SetupExperiment", *arguments, types=types)

    def initialise(self, start: float, stop: float | None) -> None:
        self.call("EnterInitializationMode")
        self.call("ExitInitializationMode")

    def access(
        self, verb: str, kind: str, references: np.ndarray, values: np.ndarray
    ) -> Callable[[], int]:
        """A call that gets or sets numbers of one kind, from or into `values`."""
        name = verb + self._functions.get(kind, kind)
        call = self.function(name, c_void_p, c_size_t, c_void_p)
        return partial(call, pointer(references), len(references), pointer(values))

    def get_text(self, kind: str, references: np.ndarray) -> list[Any]:
        values = (c_char_p * len(references))()
        types = (c_void_p, c_size_t, c_void_p)
        arguments = (pointer(references), len(references), ctypes.addressof(values))
        self.call("GetString", *arguments, types=types)
        return [(value or b"").decode() for value in values]

    def set_text(self, kind: str, references: np.ndarray, texts: list[Any]) -> None:
        values = (c_char_p * len(texts))(*(text.encode() for text in texts))
        types = (c_void_p, c_size_t, c_void_p)
        arguments = (pointer(references), len(references), ctypes.addressof(values))
        self.call("SetString", *arguments, types=types)

    def do_step(self, time: float, size: float) -> None:
        self.must_live()
        self._statuses.clear()
        self._began = time
        self._do_step(time, size, self._keep_past)
        status = self._statuses[0]
        if status <= 1:
            return
        if status == _DISCARD:
            raise self.discarded(self._last_time(time), self._has_terminated())
        self.check(status, "DoStep")

    def reached(self, time: float, size: float) -> float:
        """The time [s] after a step from `time` that an exception from elsewhere has broken off."""
        is_done = self._began == time and self._statuses and self._statuses[0] <= 1
        return time + size if is_done else time

    def _last_time(self, time: float) -> float:
        value = c_double(time)
        ask = self.function("GetRealStatus", c_int, c_void_p)
        return value.value if self._answers(ask(_LAST_SUCCESSFUL_TIME, byref(value))) else time

    def _has_terminated(self) -> bool:
        value = c_int(0)
        ask = self.function("GetBooleanStatus", c_int, c_void_p)
        return self._answers(ask(_TERMINATED, byref(value))) and bool(value.value)

    def _answers(self, status: int) -> bool:
        if status == _FATAL:
            self.check(status, "GetStatus")
        return status <= 1

    # Derivatives

    def input_derivatives(
        self, references: np.ndarray, orders: np.ndarray, values: np.ndarray
    ) -> Callable[[], int]:
        """A call that sets derivatives in time; `orders` are int32 beside references."""
        call = self.function("SetRealInputDerivatives", c_void_p, c_size_t, c_void_p, c_void_p)
        count = len(references)
        return partial(call, pointer(references), count, pointer(orders), pointer(values))

    def output_derivatives(
        self, references: np.ndarray, orders: np.ndarray, values: np.ndarray
    ) -> Callable[[], int]:
        call = self.function("GetRealOutputDerivatives", c_void_p, c_size_t, c_void_p, c_void_p)
        count = len(references)
        return partial(call, pointer(references), count, pointer(orders), pointer(values))

    def directional_derivative(
        self, unknowns: np.ndarray, knowns: np.ndarray, change: np.ndarray, result: np.ndarray
    ) -> None:
        types = (c_void_p, c_size_t, c_void_p, c_size_t, c_void_p, c_void_p)
        places = (pointer(unknowns), len(unknowns), pointer(knowns), len(knowns))
        values = (pointer(change), pointer(result))
        self.call("GetDirectionalDerivative", *places, *values, types=types)
