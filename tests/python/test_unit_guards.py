"""What `Unit` must not do: call what has failed fatally, or pass on what units cannot take."""

import subprocess
import sys
from fractions import Fraction

import numpy as np
import pytest
from impinge import Unit, UnitError
from linear_unit import make
from python_unit import LATE, python_unit

NAN, INF = float("nan"), float("inf")
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


@pytest.mark.parametrize(
    ("name", "value", "told"),
    [
        ("n", 3e9, "must be whole numbers from -2147483648 to 2147483647"),
        ("n", -(2**31) - 1, "must be whole numbers from"),
        ("n", INF, "must be whole numbers from"),
        ("n", NAN, "must be whole numbers"),
        ("n", 2.5, "must be whole numbers"),
        pytest.param("n", 10**400, "takes one number", id="huge n"),
        pytest.param("u", 10**400, "takes one number", id="huge u"),
        ("u", None, "takes one number, not None"),
        ("u", [None], "takes one number"),
        ("u", 1 + 2j, "takes one number"),
        ("u", "3.5", "takes one number, not '3.5'"),
        ("u", b"3", "takes one number"),
        ("u", np.datetime64("2020-01-01"), "takes one number"),
    ],
)
def test_values_that_are_no_numbers_of_their_kind_are_refused(folder, name, value, told):
    with Unit(python_unit(folder, "Late", LATE)) as unit:
        unit.set({"u": 1.0, "n": 7})
        for set_it in (lambda: unit.set({name: value}), lambda: unit.__setitem__(name, value)):
            for _ in range(2):
                with pytest.raises(UnitError) as refused:
                    set_it()
                assert told in str(refused.value)
        with pytest.raises(UnitError):
            unit.set({"u": 1.0, "n": 7, name: value})
        assert unit["u"] == 1.0
        for given in (2, np.float32(2.0), np.int8(2), Fraction(2), [2.0], np.array([2])):
            unit.set({"u": given, "n": given})
            assert unit["u"] == 2.0


@both
def test_steps_backward_or_without_length_are_refused_before_the_call(pack, fmi):
    with Unit(pack("plate", fmi=fmi)) as unit:
        unit.step(1e-5)
        called = []
        do_step, unit.slave.do_step = unit.slave.do_step, lambda *told: called.append(told)
        for size in (-1e-5, NAN, INF, -INF):
            with pytest.raises(UnitError, match="step size .* s is not positive and finite"):
                unit.step(size)
        unit.slave.do_step = do_step
        assert called == [] and unit.time == 1e-5
        with pytest.raises(UnitError, match="step size"):
            unit.step_to(0.5e-5)
        unit.step(1e-5)
        assert unit.time == 2e-5


@both
def test_saved_states_that_are_damaged_are_refused(pack, folder, fmi):
    for source in (pack("plate", fmi=fmi), make(folder, "decay", [[-3.0]], [1.0], [2.0], x=[1.0])):
        with Unit(source) as unit:
            unit.step(1e-5)
            whole = unit.save()
            unit.step(1e-5)
            for length in (0, 5, 10, 15, 25, len(whole) - 1):
                with pytest.raises(UnitError):
                    unit.load(whole[:length])
            for place in (0, 9, 12, 14, 19, 30, len(whole) // 2, len(whole) - 1):
                damaged = bytearray(whole)
                damaged[place] ^= 8
                with pytest.raises(UnitError, match="damaged|not what Unit.save"):
                    unit.load(bytes(damaged))
            assert unit.time == 2e-5
            unit.load(whole)
            assert unit.time == 1e-5


DROPS = """
name = "Drops"
stop_time = 2e-5
step = 5e-6
[body.drop]
kind = "droplet"
method = "film"
diameter = 1e-4
impact_velocity = 10.0
initial_temperature = 350.0
height = 1e-5
arrivals = [{ x = -APART }, { time = 1e-6, x = APART }]
[body.drop.fluid]
density = 1000.0
viscosity = 4e-3
specific_heat = 4180.0
conductivity = 0.6
surface_tension = 0.05
[body.plate]
kind = "solid"
shape = { box = [1.6e-3, 8e-4, 1e-4] }
material = { model = "thermoelastic", density = 3950.0, specific_heat = 900.0, conductivity = 10.0 }
initial_temperature = 300.0
mesh = { spacing = 4e-5, depth_spacing = 4e-6, growth = 1.4, order = 1 }
[[coupling]]
from = "drop"
to = "plate.top"
traction = false
radius = 1.6e-4
"""


@pytest.mark.parametrize(("apart", "is_told"), [("2e-5", True), ("4e-4", False)])
def test_drops_on_the_film_of_others_are_told_of_as_a_run_ends(folder, apart, is_told):
    """Records and films know nothing of each other: what they give is not what such drops would."""
    path = folder / f"drops{apart}.toml"
    path.write_text(DROPS.replace("APART", apart))
    heard = []
    with Unit(path, logger=lambda *told: heard.append(told)) as unit:
        for _ in range(4):
            unit.step(5e-6)
        assert (unit["drop.overlapping"] > 0) == is_told
    told = [text for status, _, text in heard if "came down on the film of another" in text]
    assert len(told) == is_told


@both
@pytest.mark.parametrize("is_done", [False, True])
def test_a_step_that_ctrl_c_breaks_into_leaves_a_unit_that_goes_on(pack, monkeypatch, fmi, is_done):
    with Unit(pack("tiles", fmi=fmi)) as unit, Unit(pack("tiles", fmi=fmi)) as other:
        for each in (unit, other):
            each["patch.heat_flux"] = 1e7
            each.step(1e-5)
        call = unit.slave._do_step

        def interrupted(*arguments):
            if is_done:
                call(*arguments)
            raise KeyboardInterrupt

        monkeypatch.setattr(unit.slave, "_do_step", interrupted)
        with pytest.raises(KeyboardInterrupt):
            unit.step(1e-5)
        monkeypatch.setattr(unit.slave, "_do_step", call)
        assert unit.time == (2e-5 if is_done else 1e-5)
        unit.step(1e-5)
        for _ in range(2 if is_done else 1):
            other.step(1e-5)
        names = list(unit.outputs)
        assert unit.time == other.time
        assert np.array_equal(unit.get(names), other.get(names))


def test_what_is_no_state_is_refused(pack):
    with Unit(pack("tiles")) as unit, pytest.raises(UnitError, match="NoneType is no state"):
        unit.restore(None)
