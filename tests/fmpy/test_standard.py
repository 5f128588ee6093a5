"""What other tools say about the units, and whether they run in them."""

import ctypes
import json
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import EXAMPLES, SCENES, build, every_scene, name_of
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.validation import validate_fmu
from fmu_manipulation_toolbox.cli.fmutool import fmutool
from master import Unit


@every_scene
def test_fmpy_finds_no_fault(pack_small, scene):
    assert validate_fmu(str(pack_small(scene))) == []


@pytest.mark.parametrize("fmi", [2, 3])
@every_scene
def test_fmu_manipulation_toolbox_finds_no_fault(pack_small, scene, fmi, monkeypatch, capfd):
    unit = str(pack_small(scene, fmi))
    monkeypatch.setattr(sys, "argv", ["fmutool", "-input", unit, "-check"])
    code = fmutool()
    said = "".join(capfd.readouterr())
    assert not code, said
    assert f"seems to be compliant with FMI-{fmi}.0" in said
    assert "No semantic error" in said
    assert "WARNING" not in said and "ERROR" not in said, said


@every_scene
def test_the_unit_runs(pack_small, scene):
    """Examples on their own meshes do so in tests/verification/test_units.py."""
    unit = str(pack_small(scene))
    experiment = read_model_description(unit).defaultExperiment
    result = simulate_fmu(unit, stop_time=float(experiment.stepSize))
    assert len(result) == 2
    for name in result.dtype.names:
        assert np.isfinite(result[name]).all(), name


FIELD = """
[[field]]
name = "surface"
on = "block.top"
grid = [40, 40]
gives = ["von_mises"]
"""


def test_ten_thousand_variables_open_quickly(pack):
    """Tiles with a flux and a pressure each, and stresses that follow every pressure at once."""
    gives = 'gives = ["temperature", "stress", "displacement"]'
    many = {
        "count = [2, 3]": "count = [100, 100]",
        '"pressure", "shear"]': '"pressure"]',
        gives: gives + FIELD,
    }
    file = str(pack("tiles", many))
    # Not of the clock, which others stop too.
    begin = time.process_time()
    with Unit(file) as unit:
        assert time.process_time() - begin < 2.0
        assert len(unit.package.description.modelVariables) > 20_000


STEP, STEPS = 1e-5, 12
WATCHED = ["centre.temperature", "centre.stress_xx", "right.displacement_z", "plate.heat_stored"]


def spot(t):
    """Inputs over time: all of them jump in the middle of the run."""
    late = t > 5.5 * STEP
    return {
        "spot.heat_flux": 2e8 if late else 5e7,
        "spot.pressure": 1e6 if late else 25e6,
        "spot.x": 5e-5 if late else -3e-5,
    }


@pytest.fixture(scope="module")
def trajectory(pack):
    """From a master of our own, with inputs held over each step."""
    rows = []
    with Unit(pack("plate"), {"plate.conductivity": 12.0}) as unit:
        for i in range(STEPS):
            unit.set(spot(i * STEP))
            unit.step(STEP)
            rows.append(unit.get(WATCHED))
    return np.array(rows)


def test_fmpy_simulation_gives_the_same_trajectory(pack, trajectory):
    first = spot(0.0)
    times = [i * STEP for i in range(STEPS)]
    kinds = [("time", float), *((name, float) for name in first)]
    inputs = np.array([(t, *spot(t).values()) for t in times], kinds)
    result = simulate_fmu(
        str(pack("plate")),
        start_values={"plate.conductivity": 12.0, **first},
        stop_time=STEPS * STEP,
        output_interval=STEP,
        input=inputs,
        output=WATCHED,
    )
    # FMPy's times differ from whole multiples by rounding, and so do the inputs it interpolates.
    for column, name in enumerate(WATCHED):
        assert result[name][1:] == pytest.approx(trajectory[:, column], rel=1e-9), name


ECOS = """
import ctypes, json, sys
tbb, unit, step, steps, inputs, watched = json.loads(sys.argv[1])
# ecospy loads libtbb.so.12 but does not bring it.
ctypes.CDLL(tbb, mode=ctypes.RTLD_GLOBAL)
from ecospy import EcosSimulation, EcosSimulationStructure
with EcosSimulationStructure() as structure:
    structure.add_model("unit", unit)
    structure.add_parameter_set("start", {"unit::plate.conductivity": 12.0})
    with EcosSimulation(step, structure=structure) as simulation:
        assert simulation.init(0, "start")
        rows = []
        for i in range(steps):
            for name, value in inputs[i].items():
                simulation.set_real(f"unit::{name}", value)
            simulation.step()
            rows.append([simulation.get_real(f"unit::{name}") for name in watched])
        simulation.terminate()
print("rows", json.dumps(rows))
"""


def test_ecos_gives_the_same_trajectory(pack, trajectory):
    tbb = Path(sys.prefix) / "lib/libtbb.so.12"
    ctypes.CDLL(str(tbb))
    inputs = [spot(i * STEP) for i in range(STEPS)]
    job = json.dumps([str(tbb), str(pack("plate")), STEP, STEPS, inputs, WATCHED])
    ran = subprocess.run(
        [sys.executable, "-c", ECOS, job], capture_output=True, text=True, check=False
    )
    assert ran.returncode == 0, ran.stdout + ran.stderr
    rows = next(line for line in ran.stdout.splitlines() if line.startswith("rows "))
    # Ecos sums its times up, ours does too: the same bits.
    assert np.array_equal(np.array(json.loads(rows[5:])), trajectory)


COSIM = """
import json, sys
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimManipulator import CosimManipulator
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave
unit, step, start, inputs, watched = json.loads(sys.argv[1])
execution = CosimExecution.from_step_size(round(1e9 * step))
slave = execution.add_local_slave(CosimLocalSlave(fmu_path=unit, instance_name="unit"))
for reference, value in start:
    execution.real_initial_value(slave, reference, value)
manipulator, observer = CosimManipulator.create_override(), CosimObserver.create_last_value()
execution.add_manipulator(manipulator)
execution.add_observer(observer)
rows = []
for values in inputs:
    if values:
        manipulator.slave_real_values(slave, *map(list, zip(*values)))
    assert execution.step()
    rows.append(list(observer.last_real_values(slave, watched)))
print("rows", json.dumps(rows))
"""


def by_libcosim(file, step, start, inputs, watched):
    """Rows of the watched outputs after each step; variables are given by reference."""
    job = json.dumps([str(file), step, start, inputs, watched])
    ran = subprocess.run(
        [sys.executable, "-c", COSIM, job], capture_output=True, text=True, check=False
    )
    assert ran.returncode == 0, ran.stdout + ran.stderr
    rows = next(line for line in ran.stdout.splitlines() if line.startswith("rows "))
    return np.array(json.loads(rows[5:]))


def test_libcosim_gives_the_same_trajectory(pack, trajectory):
    file = pack("plate")
    variables = read_model_description(file).modelVariables
    reference = {variable.name: variable.valueReference for variable in variables}
    start = [(reference["plate.conductivity"], 12.0)]
    given = [spot(i * STEP).items() for i in range(STEPS)]
    inputs = [[(reference[name], value) for name, value in values] for values in given]
    rows = by_libcosim(file, STEP, start, inputs, [reference[name] for name in WATCHED])
    # Libcosim counts nanoseconds, so that its steps differ in the last bit.
    assert np.allclose(rows, trajectory, rtol=1e-12, atol=0.0)


@pytest.mark.parametrize("scene", EXAMPLES, ids=name_of)
def test_libcosim_runs_the_examples_as_fmpy_does(pack_small, scene):
    file, steps = pack_small(scene), 2
    step = float(read_model_description(file).defaultExperiment.stepSize)
    rows = []
    with Unit(file) as unit:
        for _ in range(steps):
            unit.step(step)
            rows.append(unit.all_outputs())
        watched = unit.references(unit.every_output)
    assert np.array_equal(by_libcosim(file, step, [], [[]] * steps, watched), np.array(rows))


def test_paths_with_spaces_and_unicode(programs, pack, tmp_path):
    folder = tmp_path / "Plättchen 板 50% #1"
    folder.mkdir()
    file = folder / "Ein Heft.fmu"
    build(programs, SCENES / "plate.toml", file)
    fields = folder / "Felder ∇T"
    flux = {"spot.heat_flux": 1e8}
    with Unit(pack("plate"), flux) as plain:
        plain.step(STEP)
        expected = plain.all_outputs()
    unpacked = extract(file, folder / "ausgepackt ü")
    with Unit(unpacked, {**flux, "output.directory": str(fields)}) as u:
        u.step(STEP)
        assert np.array_equal(u.all_outputs(), expected)
    assert list(fields.glob("*.pvd"))
