"""Saved states of a unit."""

from __future__ import annotations

from ctypes import c_void_p
from typing import TYPE_CHECKING
from weakref import ref

from impinge.errors import UnitError

if TYPE_CHECKING:
    from impinge.unit.unit import Unit


class State:
    """A state of one instance at `time` [s]; `Unit.restore` brings it back, `free` gives it up.

    It is freed, too, at the end of a `with` statement, when nobody holds it any more, and with the
    unit.
    """

    def __init__(self, unit: Unit, time: float):
        self.time = time
        self.handle = c_void_p()
        self._unit = ref(unit)

    def belongs_to(self, unit: Unit) -> bool:
        """Whether this is a state of that instance, and not freed."""
        return self._unit() is unit and bool(self.handle)

    def free(self) -> None:
        """Gives the state up."""
        unit = self._unit()
        if unit is not None and unit.is_open and self.handle:
            try:
                unit.slave.free_state(self.handle)
            except UnitError:
                pass  # a unit that fails here has nothing left to free
        self.handle = c_void_p()

    def __enter__(self) -> State:
        return self

    def __exit__(self, *_: object) -> None:
        self.free()

    def __del__(self) -> None:
        try:
            self.free()
        except Exception:  # the interpreter is ending
            pass
