"""The optional capabilities as FMPy uses them: states, and derivatives of inputs and outputs."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import EXAMPLES, every_scene, order_of_output_derivatives
from fmpy import read_model_description
from impinge import UnitError
from impinge.unit import State
from master import Unit

STEP = 1e-5
LOADS = {"spot.heat_flux": 1e8, "spot.pressure": 25e6, "spot.shear_x": 1e6, "spot.x": 4e-5}


def go_on(unit, steps=3):
    """Rows of all outputs over steps of different lengths, with a load that grows and moves."""
    rows = []
    for i in range(steps):
        unit["spot.pressure"] = 25e6 + 1e6 * i
        unit.set_input_derivatives({"spot.heat_flux": [1e12], "spot.x": [-0.5]})
        unit.step(STEP / (i + 1))
        rows.append(unit.all_outputs())
    return np.array(rows)


@every_scene
def test_every_unit_declares_all_capabilities(pack_small, scene):
    offers = read_model_description(pack_small(scene)).coSimulation
    text = scene.read_text()
    assert offers.canHandleVariableCommunicationStepSize
    assert offers.canGetAndSetFMUstate and offers.canSerializeFMUstate
    assert offers.providesDirectionalDerivative and offers.canInterpolateInputs
    # Droplets have no exact derivatives in time, nor have solids below other bodies.
    assert offers.maxOutputDerivativeOrder == order_of_output_derivatives(text)
    assert not offers.needsExecutionTool and not offers.canBeInstantiatedOnlyOncePerProcess


def test_a_restored_state_goes_on_bit_for_bit(pack):
    with Unit(pack("plate"), {**LOADS, "plate.conductivity": 12.0}) as unit:
        unit.step(STEP)
        state, before = unit.state(), unit.all_outputs()
        first = go_on(unit)
        unit.restore(state)
        assert np.array_equal(unit.all_outputs(), before)
        assert np.array_equal(go_on(unit), first)
        unit.reset()
        unit.restore(state)
        assert np.array_equal(go_on(unit), first)
        state.free()
        assert not state.handle.value


def test_a_state_goes_on_bit_for_bit_in_another_instance(pack):
    file = pack("plate")
    with Unit(file, {**LOADS, "plate.conductivity": 12.0}) as unit:
        unit.step(STEP)
        state = unit.save()
        first = go_on(unit)
    with Unit(file, {"solver.threads": 2}) as other:
        other.load(state)
        assert other["plate.conductivity"] == 12.0
        assert np.array_equal(go_on(other), first)


RESTART = """
import sys
from pathlib import Path
import numpy as np
sys.path.insert(0, sys.argv[1])
from master import Unit
from test_capabilities import go_on
with Unit(sys.argv[2]) as unit:
    unit.load(Path(sys.argv[3]).read_bytes())
    np.save(sys.argv[4], go_on(unit))
"""


def test_a_state_goes_on_bit_for_bit_in_another_process(pack, tmp_path):
    with Unit(pack("plate"), LOADS) as unit:
        unit.step(STEP)
        state = unit.save()
        (tmp_path / "state").write_bytes(state)
        first = go_on(unit)
    arguments = [Path(__file__).parent, pack("plate"), tmp_path / "state", tmp_path / "rows.npy"]
    ran = subprocess.run(
        [sys.executable, "-c", RESTART, *arguments], capture_output=True, text=True, check=False
    )
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert np.array_equal(np.load(tmp_path / "rows.npy"), first)


def content(unit):
    """A state as the unit's own bytes; `Unit.save` adds a checksum, which would tell first."""
    with unit.state() as state:
        return unit.slave.to_bytes(state.handle)


def take(unit, content):
    with State(unit, unit.time) as state:
        unit.slave.from_bytes(content, state.handle)
        unit.restore(state)


@pytest.mark.parametrize("damage", ["cut", "flip", "other scene"])
def test_a_bad_state_is_refused_and_changes_nothing(pack, damage):
    with Unit(pack("plate"), LOADS) as unit, Unit(pack("tiles")) as other:
        unit.step(STEP)
        state = content(unit)
        if damage == "cut":
            state = state[:-1]
        elif damage == "flip":
            state = state[:300] + bytes([state[300] ^ 4]) + state[301:]
        else:
            state = content(other)
        before = unit.all_outputs()
        with pytest.raises(UnitError):
            take(unit, state)
        assert any("saved state" in line for line in unit.log), unit.log
        assert np.array_equal(unit.all_outputs(), before)
        unit.step(STEP)


def test_a_step_can_be_rejected(pack):
    with Unit(pack("plate"), LOADS) as twice, Unit(pack("plate"), LOADS) as once:
        state = twice.state()
        twice.step(3 * STEP)
        twice.restore(state)
        for unit in (twice, once):
            unit.step(STEP)
        assert np.array_equal(twice.all_outputs(), once.all_outputs())


DIRECT = ["spot.pressure", "spot.shear_x", "spot.x", "spot.radius"]


def test_directional_derivatives_are_the_slopes_of_outputs(pack):
    with Unit(pack("plate"), LOADS) as unit:
        unit.step(STEP)
        outputs = unit.every_output
        for name in DIRECT:
            value, size = unit[name], 1e-9 if name in ("spot.x", "spot.radius") else 1e3
            found = unit.directional_derivative(outputs, {name: 1.0})
            unit[name] = value + size
            above = unit.all_outputs()
            unit[name] = value - size
            wanted = (above - unit.all_outputs()) / (2 * size)
            unit[name] = value
            for quantity in ("stress", "von_mises", "displacement", "temperature", "heat"):
                rows = [i for i, output in enumerate(outputs) if quantity in output]
                scale = np.abs(wanted[rows]).max()
                assert np.abs(found[rows] - wanted[rows]).max() <= 1e-4 * scale, name


def test_a_ramp_needs_one_step(pack):
    """A flux that grows linearly: one step with its slope, and many that follow it in stairs."""
    slope, duration = 1e12, 1e-4
    flux = 0.5 * slope * duration
    with Unit(pack("plate")) as ramp:
        ramp.set_input_derivatives({"spot.heat_flux": [slope]})
        ramp.step(duration)
        heat = ramp["plate.heat_in"]
        rise = ramp["centre.temperature"] - 293.15
        assert ramp["spot.heat_flux"] == pytest.approx(slope * duration, rel=1e-12)
    errors = []
    for steps in (20, 40):
        with Unit(pack("plate")) as stairs:
            for i in range(steps):
                stairs["spot.heat_flux"] = 2 * flux * (i + 0.5) / steps
                stairs.step(duration / steps)
            assert stairs["plate.heat_in"] == pytest.approx(heat, rel=1e-12)
            errors.append(abs(stairs["centre.temperature"] - 293.15 - rise) / rise)
    assert errors[1] < 1e-3 and errors[0] / errors[1] > 2.5, errors


def test_output_derivatives_balance_heat_and_lead_ahead(pack):
    with Unit(pack("plate"), LOADS) as unit:
        unit.step(5 * STEP)
        names = ["plate.heat_in", "plate.heat_stored", "plate.heat_lost", "centre.temperature"]
        brought, stored, lost, heating = unit.output_derivatives(names)
        assert brought == pytest.approx(stored + lost, rel=1e-11)
        before, ahead = unit["centre.temperature"], 1e-9
        unit.step(ahead)
        assert (unit["centre.temperature"] - before) / ahead == pytest.approx(heating, rel=1e-3)


def test_hosts_that_ground_what_is_not_connected_step_where_ambients_are_parameters(pack):
    """Block diagrams set inputs that nothing is connected to to zero, which is no temperature."""
    scene = next(path for path in EXAMPLES if path.parent.name == "heated_bed")
    faces = {
        "coefficient = 30.0, ambient = 293.15 } }": "coefficient = 30.0, ambient = 293.15 }, "
        'role = "parameter" }',
        "coefficient = 15.0, ambient = 293.15 } }": "coefficient = 15.0, ambient = 293.15 }, "
        'role = "parameter" }',
        "radius = 30e-3 } }": 'radius = 30e-3 } }\nrole = "parameter"',
        "radius = 10e-3 } }": 'radius = 10e-3 } }\nrole = "parameter"',
    }
    for edits, steps in (({}, False), (faces, True)):
        with Unit(pack(scene, edits)) as unit:
            inputs = [v.name for v in unit.variables.values() if v.causality == "input"]
            if not steps:
                with pytest.raises(UnitError, match="bed.top.ambient = 0.0: must be above 0"):
                    unit["bed.top.ambient"] = 0.0
                continue
            for name in inputs:
                unit[name] = 0.0
            assert inputs == ["heater.heat_flux", "fan.heat_flux"]
            unit["heater.heat_flux"] = 7e3
            unit.step(0.5)
            assert unit["bed.heat_in"] > 9.0
