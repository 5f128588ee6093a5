"""Instances of FMI 3.0."""

import ctypes
import os
from collections.abc import Callable
from ctypes import byref, c_bool, c_char_p, c_double, c_size_t, c_void_p
from functools import partial
from typing import Any

import numpy as np

from impinge.errors import UnitError
from impinge.unit.log import LOG_MESSAGE, Log
from impinge.unit.package import Package
from impinge.unit.slave import Slave, pointer
from impinge.unit.variable import NUMBERS

_DISCARD = 2
# A step is given up after so many parts in a row that end early, each below this share of it.
_MOST_SHORT_PARTS = 3
_SHORT_PART = 1e-4
_Flag = c_bool


class Fmi3(Slave):
    """An instance by the functions of FMI 3.0, without Event Mode."""

    prefix = "fmi3"
    state = "FMUState"
    deserialize = "Deserialize"
    boolean = c_bool
    types = {**NUMBERS, "Boolean": np.bool_, "Enumeration": np.int64}
    _functions = {"Enumeration": "Int64"}

    def __init__(self, package: Package, log: Log):
        super().__init__(package, log)
        instantiate = self._library["fmi3InstantiateCoSimulation"]
        instantiate.argtypes = [
            *(c_char_p, c_char_p, c_char_p),
            *(c_bool, c_bool, c_bool, c_bool),
            *(c_void_p, c_size_t, c_void_p, c_void_p, c_void_p),
        ]
        instantiate.restype = c_void_p
        self.component = instantiate(
            log.name.encode(),
            package.description.instantiationToken.encode(),
            (str(package.folder / "resources") + os.sep).encode(),
            *(False, True, False, package.can.early_return),
            *(None, 0, log.key, ctypes.cast(LOG_MESSAGE, c_void_p), None),
        )
        if not self.component:
            raise UnitError(f"{package.source}: no instance could be made", log.take())
        self.set_debug_logging()
        self._flags = [c_bool() for _ in range(3)]
        self._last = c_double()
        addresses = [byref(flag) for flag in self._flags]
        types = (c_double, c_double, c_bool, *(c_void_p,) * 4)
        self._do_step = self.function("DoStep", *types)
        self._results = (*addresses, byref(self._last))
        self._keep_past = not package.can.states

    def setup(self, start: float, stop: float | None) -> None:
        """FMI 3.0 tells times on entering initialization mode."""

    def initialise(self, start: float, stop: float | None) -> None:
        types = (c_bool, c_double, c_double, c_bool, c_double)
        arguments = (False, 0.0, start, stop is not None, stop or 0.0)
        self.call("EnterInitializationMode", *arguments, types=types)
        self.call("ExitInitializationMode")

    def configure(self, change: Callable[[], None]) -> None:
        """Sets structural parameters, which Configuration Mode alone allows."""
        self.call("EnterConfigurationMode")
        change()
        self.call("ExitConfigurationMode")

    def access(
        self, verb: str, kind: str, references: np.ndarray, values: np.ndarray
    ) -> Callable[[], int]:
        """A call that gets or sets numbers of one kind, from or into `values`."""
        name = verb + self._functions.get(kind, kind)
        call = self.function(name, c_void_p, c_size_t, c_void_p, c_size_t)
        return partial(call, pointer(references), len(references), pointer(values), values.size)

    def get_text(self, kind: str, references: np.ndarray) -> list[Any]:
        count = len(references)
        values = (c_void_p * count)()
        where = (pointer(references), count)
        if kind == "Binary":
            sizes = (c_size_t * count)()
            types = (c_void_p, c_size_t, c_void_p, c_void_p, c_size_t)
            arguments = (ctypes.addressof(sizes), ctypes.addressof(values), count)
            self.call("GetBinary", *where, *arguments, types=types)
            return [
                ctypes.string_at(v or 0, n) if n else b""
                for v, n in zip(values, sizes, strict=True)
            ]
        types = (c_void_p, c_size_t, c_void_p, c_size_t)
        self.call("GetString", *where, ctypes.addressof(values), count, types=types)
        return [ctypes.string_at(value).decode() if value else "" for value in values]

    def set_text(self, kind: str, references: np.ndarray, texts: list[Any]) -> None:
        where = (pointer(references), len(references))
        if kind == "Binary":
            values = (c_char_p * len(texts))(*texts)
            sizes = (c_size_t * len(texts))(*(len(text) for text in texts))
            types = (c_void_p, c_size_t, c_void_p, c_void_p, c_size_t)
            arguments = (ctypes.addressof(sizes), ctypes.addressof(values), len(texts))
            self.call("SetBinary", *where, *arguments, types=types)
            return
        values = (c_char_p * len(texts))(*(text.encode() for text in texts))
        types = (c_void_p, c_size_t, c_void_p, c_size_t)
        self.call("SetString", *where, ctypes.addressof(values), len(texts), types=types)

    def reached(self, time: float, size: float) -> float:
        """The time [s] after a step from `time` that an exception from elsewhere has broken off."""
        last = self._last.value
        return last if time <= last <= time + size else time

    def do_step(self, time: float, size: float) -> None:
        self.must_live()
        event, terminate, early = self._flags
        # Not `end - time`, which differs by rounding: the unit goes as it would under FMI 2.
        end, rest = time + size, size
        short_parts = 0
        while True:
            self._last.value = time
            status = self._do_step(time, rest, self._keep_past, *self._results)
            last = self._last.value
            if status == _DISCARD:
                raise self.discarded(last, terminate.value)
            self.check(status, "DoStep")
            if terminate.value:
                raise self.discarded(last, True)
            if not early.value or last >= end:
                return
            if last <= time:
                raise UnitError(f"{self.log.name}: a step ends early at {last!r} s, where it began")
            short_parts = short_parts + 1 if last - time < _SHORT_PART * size else 0
            if short_parts == _MOST_SHORT_PARTS:
                raise self.discarded(
                    last, False, f"it ends early after {last - time:.1g} s; take shorter steps"
                )
            time, rest = last, end - last

    # Derivatives

    def output_derivatives(
        self, references: np.ndarray, orders: np.ndarray, values: np.ndarray
    ) -> Callable[[], int]:
        types = (c_void_p, c_size_t, c_void_p, c_void_p, c_size_t)
        call = self.function("GetOutputDerivatives", *types)
        where = (pointer(references), len(references), pointer(orders))
        return partial(call, *where, pointer(values), values.size)

    def directional_derivative(
        self, unknowns: np.ndarray, knowns: np.ndarray, change: np.ndarray, result: np.ndarray
    ) -> None:
        types = (c_void_p, c_size_t, c_void_p, c_size_t, *(c_void_p, c_size_t) * 2)
        places = (pointer(unknowns), len(unknowns), pointer(knowns), len(knowns))
        values = (pointer(change), change.size, pointer(result), result.size)
        self.call("GetDirectionalDerivative", *places, *values, types=types)
