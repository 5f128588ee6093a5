"""What `Unit` must not do: call what has failed fatally, or pass on what units cannot take."""

import subprocess
import sys

import pytest
from impinge import Unit, UnitError
from python_unit import LATE, python_unit

both = pytest.mark.parametrize("fmi", [2, 3])


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("guards")


FATAL = """
import sys
from impinge import Master, Unit, UnitError

unit = Unit(sys.argv[1], parameters={"fail_at": 0.25})
before = unit.state()
reader = unit.reader(["y"])
uses = {
    "read": lambda: unit["y"], "read again": reader, "set": lambda: unit.set({"u": 1.0}),
    "step": lambda: unit.step(0.1), "state": unit.state, "save": unit.save,
    "restore": lambda: unit.restore(before), "reset": unit.reset,
}
unit["u"], _ = 1.0, unit["y"]
for name in ("first", "second"):
    try:
        for _ in range(5):
            unit.step(0.1)
    except UnitError as error:
        print(name, "fatal" in str(error))
for name, use in uses.items():
    try:
        use()
        print(name, "was called")
    except UnitError as error:
        assert "DoStep: fatal; a unit that failed fatally cannot be used" in str(error), error
before.free()
unit.close()
other = Unit(sys.argv[1], parameters={"fail_at": 0.05})
try:
    other.step(0.1)
except UnitError:
    pass
del other
for adaptive in (False, True):
    units = {"one": sys.argv[1], "two": sys.argv[1]}
    ring = [("one.y", "two.u"), ("two.y", "one.u")]
    parameters = {"two": {"fail_at": 0.55}}
    try:
        with Master(units, ring, step=0.1, adaptive=adaptive, parameters=parameters) as master:
            master.run(1.0)
        print("went on")
    except UnitError as error:
        assert "failed fatally" in str(error), error
print("ended")
"""


def test_a_unit_that_failed_fatally_is_called_no_more(folder):
    """Not even to terminate or free it, as FMI asks for: the process would crash."""
    late = python_unit(folder, "Late", LATE)
    command = [sys.executable, "-c", FATAL, str(late)]
    ran = subprocess.run(command, capture_output=True, text=True)
    assert ran.returncode == 0, (ran.returncode, ran.stderr[-2000:])
    assert ran.stdout.split("\n")[:3] == ["first True", "second True", "ended"], ran.stdout


@both
def test_fatal_is_for_good_in_both_versions(pack, fmi):
    unit = Unit(pack("plate", fmi=fmi))
    names = list(unit.outputs)[:2]
    unit.get(names)
    with pytest.raises(UnitError, match="fatal"):
        unit.slave.check(4, "GetFloat64")
    for use in (lambda: unit.get(names), lambda: unit.step(1e-5), unit.state, unit.reset):
        with pytest.raises(UnitError, match="GetFloat64: fatal; a unit that failed fatally"):
            use()
    unit.close()
    with pytest.raises(UnitError, match="closed"):
        unit.step(1e-5)
