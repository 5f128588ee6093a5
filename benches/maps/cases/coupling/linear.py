"""Linear units that are joined by a master, and what the master says of it."""

import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

from impinge import Master
from impinge.errors import UnitError
from impinge.master import MasterError
from plan import Answer

sys.path.append(str(Path(__file__).resolve().parents[4] / "tests/python"))
from linear_unit import make  # noqa: E402

RING = [("a.y", "b.u"), ("b.y", "a.u")]


def lumps(folder: str, first: float, second: float, conductance: float = 1.0) -> dict:
    """A body of heat capacity `first` that takes a flux, and one of `second` [J/K] behind a
    conductance [W/K] that takes a temperature and gives the flux. One is 1 K warmer at first."""
    rate = conductance / second
    a = make(folder, "store", [0.0], [1 / first], [1.0], x=[1.0], f=[first])
    b = make(folder, "bath", [-rate], [rate], [conductance], d=-conductance, x=[0.0])
    return {"a": a, "b": b}


def coupled(make_units: Callable, ring: list, stop: float, read: list[str], **options) -> Answer:
    """A run of a master over units that are made for it: outputs at the ends of steps."""
    with TemporaryDirectory() as folder, warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        try:
            with Master(make_units(folder), ring, **options) as master:
                result = master.run(stop)
        except (MasterError, UnitError) as refusal:
            return Answer(refused=str(refusal))
    said = [
        str(warning.message) for warning in heard if warning.category.__module__[:7] == "impinge"
    ]
    return Answer({name: result[name].values.tolist() for name in read}, said[0] if said else "")
