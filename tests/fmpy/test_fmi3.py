"""Units of FMI 3.0: valid, run in FMPy with arrays, and the same as those of FMI 2.0 to the bit."""

import subprocess
import zipfile
from pathlib import Path

import numpy as np
import pytest
from conftest import EVERY_SCENE, every_scene, name_of, order_of_output_derivatives
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.fmi1 import FMICallException
from fmpy.fmi3 import FMU3Slave
from fmpy.util import read_csv
from fmpy.validation import validate_fmu

LARGE = ["alumina_plate", "droplet_impact", "moving_spot"]
STEP = 1e-5


# Two models each; the large ones are of no other kind than these.
quick_scenes = pytest.mark.parametrize(
    "scene",
    [scene for scene in EVERY_SCENE if name_of(scene) not in LARGE],
    ids=name_of,
)


class Unit:
    """One instance of a unit in Step Mode, its variables by name, arrays as numpy arrays."""

    def __init__(self, file, folder, start=None, update=None):
        description = read_model_description(str(file))
        self.variables = {v.name: v for v in description.modelVariables}
        self.outputs = [v.name for v in description.modelVariables if v.causality == "output"]
        self.log = []
        self.slave = FMU3Slave(
            guid=description.guid,
            modelIdentifier=description.coSimulation.modelIdentifier,
            unzipDirectory=extract(str(file), str(folder)),
            instanceName="unit",
        )
        self.slave.instantiate(
            loggingOn=True,
            logMessage=self._hear,
            earlyReturnAllowed=update is not None,
            intermediateUpdate=update,
        )
        for name, value in (start or {}).items():
            self[name] = value
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()
        self.time = 0.0

    def _hear(self, _environment, _status, _category, message):
        self.log.append(message.decode())

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.slave.terminate()
        self.slave.freeInstance()

    def references(self, names):
        return [self.variables[name].valueReference for name in names]

    def size(self, names):
        return sum(int(np.prod(self.variables[name].shape or ())) for name in names)

    def read(self, names):
        """Values of variables, those of arrays one after another."""
        return np.array(self.slave.getFloat64(self.references(names), nValues=self.size(names)))

    def __getitem__(self, name):
        return self.read([name]).reshape(self.variables[name].shape or ())

    def __setitem__(self, name, value):
        self.slave.setFloat64(self.references([name]), np.ravel(value).tolist())

    def set(self, values):
        for name, value in values.items():
            self[name] = value

    def step(self, size=STEP):
        answer = self.slave.doStep(self.time, size)
        self.time += size
        assert answer == (False, False, False, self.time)


@pytest.fixture
def make(pack, tmp_path):
    """Makes instances of a small scene's unit."""
    count = iter(range(100))
    return lambda scene, start=None, update=None: Unit(
        pack(scene, fmi=3), tmp_path / str(next(count)), start, update
    )


@every_scene
def test_fmpy_finds_no_fault(pack_small, scene):
    unit = pack_small(scene, fmi=3)
    assert validate_fmu(str(unit)) == []
    offers = read_model_description(str(unit)).coSimulation
    assert offers.canHandleVariableCommunicationStepSize
    assert offers.canGetAndSetFMUstate and offers.canSerializeFMUstate
    assert offers.providesAdjointDerivatives
    text = scene.read_text()
    droplets = 'kind = "droplet"' in text
    assert offers.maxOutputDerivativeOrder == order_of_output_derivatives(text)
    assert offers.providesIntermediateUpdate == droplets
    assert offers.canReturnEarlyAfterIntermediateUpdate == droplets


def scalar(result, name):
    """The series of a scalar of FMI 2.0 in a result of FMI 3.0."""
    stem, _, indices = name.rstrip("]").partition("[")
    if not indices:
        return result[name]
    place = tuple(int(index) - 1 for index in indices.split(","))
    return result[stem][(slice(None), *place)]


@quick_scenes
def test_the_run_is_that_of_fmi_2_to_the_bit(pack_small, scene):
    units = {fmi: str(pack_small(scene, fmi)) for fmi in (2, 3)}
    descriptions = {fmi: read_model_description(unit) for fmi, unit in units.items()}
    stop = 2 * float(descriptions[2].defaultExperiment.stepSize)
    runs = {
        fmi: simulate_fmu(
            unit,
            stop_time=stop,
            output=[v.name for v in descriptions[fmi].modelVariables if v.causality == "output"],
        )
        for fmi, unit in units.items()
    }
    assert len(runs[3]) == 3
    for name in runs[2].dtype.names:
        found = scalar(runs[3], name)
        assert np.isfinite(found).all(), name
        assert np.array_equal(found, runs[2][name]), name


def test_the_zip_file_has_the_layout_of_fmi_3(pack):
    with zipfile.ZipFile(pack("plate", fmi=3)) as unit:
        names = unit.namelist()
    for name in [
        "modelDescription.xml",
        "binaries/x86_64-linux/Plate.so",
        "resources/scene.toml",
        "documentation/index.html",
        "documentation/licenses/LICENSE-MIT.txt",
        "terminalsAndIcons/icon.png",
    ]:
        assert name in names, name
    assert "model.png" not in names


def test_the_linter_says_that_it_knows_fmi_2(programs, pack):
    said = subprocess.run(
        [programs / "build-fmu", "--lint", pack("plate", fmi=3)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert said.returncode == 0, said.stdout
    assert "a unit of FMI 3.0: only its zip file has been checked" in said.stdout


def test_arrays_are_set_and_read_as_a_whole(make):
    with make("tiles", {"patch.heat_flux": np.full((2, 3), 1e6)}) as unit:
        assert np.array_equal(unit["patch.heat_flux"], np.full((2, 3), 1e6))
        flux = np.arange(6.0).reshape(2, 3) * 1e7
        unit["patch.heat_flux"] = flux
        unit.step()
        assert np.array_equal(unit["patch.heat_flux"], flux)
        area = 1.1e-4 * 0.9e-4 / 6
        assert unit["block.heat_in"] == pytest.approx(flux.sum() * area * STEP, rel=1e-12)
        with pytest.raises(FMICallException):
            unit["patch.heat_flux"] = np.zeros((2, 2))
        assert "nValues is 4; these variables have 6 elements" in unit.log[-1]
        assert np.array_equal(unit["patch.heat_flux"], flux)


def test_fmpy_sets_start_values_of_rings(pack):
    result = simulate_fmu(
        str(pack("rings", fmi=3)),
        stop_time=5 * STEP,
        output_interval=STEP,
        start_values={"splat.heat_flux": [4e7, 3e7, 2e7, 1e7]},
        output=["plate.heat_in"],
    )
    edges = np.linspace(0, 8e-5, 5)
    power = (np.pi * np.diff(edges**2) * [4e7, 3e7, 2e7, 1e7]).sum()
    assert result["plate.heat_in"] == pytest.approx(power * result["time"], rel=1e-12)


def test_fields_come_with_the_coordinates_of_their_points(make):
    with make("plate", {"spot.heat_flux": 1e8, "spot.x": 6e-5, "spot.y": -9e-5}) as unit:
        unit.step()
        x, y, field = unit["surface.x"], unit["surface.y"], unit["surface.temperature"]
        assert field.shape == (len(x), len(y)) == (4, 2)
        i, j = np.unravel_index(field.argmax(), field.shape)
        assert (x[i], y[j]) == pytest.approx((6e-5, -9e-5))
        constants = [
            variable
            for name, variable in unit.variables.items()
            if variable.variability == "constant" and name.startswith("surface.")
        ]
        assert [v.name for v in constants] == ["surface.x", "surface.y", "surface.z"]
        for variable in constants:
            told = [float(value) for value in variable.start.split()]
            assert unit[variable.name].ravel().tolist() == told


def go_on(unit):
    """Rows of all outputs over steps of different lengths, with a load that grows."""
    rows = []
    for i in range(3):
        unit["patch.pressure"] = np.full((2, 3), 1e6 * (i + 1))
        unit.step(STEP / (i + 1))
        rows.append(unit.read(unit.outputs))
    return np.array(rows)


def test_states_go_on_bit_for_bit_here_and_elsewhere(make):
    with make("tiles", {"block.conductivity": 12.0}) as unit:
        unit["patch.heat_flux"] = np.arange(6.0) * 1e7
        unit.step()
        state, time = unit.slave.getFMUState(), unit.time
        sent = unit.slave.serializeFMUState(state)
        first = go_on(unit)
        unit.slave.setFMUState(state)
        unit.time = time
        assert np.array_equal(go_on(unit), first)
        unit.slave.freeFMUState(state)
    with make("tiles") as other:
        other.slave.setFMUState(other.slave.deserializeFMUState(sent))
        other.time = time
        assert other["block.conductivity"] == 12.0
        assert np.array_equal(go_on(other), first)


def test_derivatives_forwards_and_backwards(make):
    with make("tiles") as unit:
        unit["patch.heat_flux"] = np.arange(6.0) * 1e7
        unit["patch.pressure"] = np.arange(6.0) * 1e6
        unit.step()
        outputs = ["centre.stress_xx", "centre.displacement_z", "centre.von_mises"]
        unknowns = unit.references(outputs)
        knowns = unit.references(["patch.pressure", "patch.x"])
        change = np.array([1e5, -2e5, 3e5, 1e5, 2e5, -1e5, 1e-7])
        weights = np.array([1e-5, 1e10, -2e-5])
        forwards = unit.slave.getDirectionalDerivative(unknowns, knowns, change, 3)
        backwards = unit.slave.getAdjointDerivative(unknowns, knowns, weights, 7)
        assert np.dot(weights, forwards) == pytest.approx(np.dot(backwards, change), rel=1e-11)
        before = unit.read(outputs)
        unit["patch.pressure"] = unit["patch.pressure"].ravel() + 1e-4 * change[:6]
        unit["patch.x"] = unit["patch.x"] + 1e-4 * change[6]
        difference = (unit.read(outputs) - before) / 1e-4
        assert forwards == pytest.approx(difference, rel=1e-4)
        power = unit.slave.getOutputDerivatives(unit.references(["block.heat_in"]), [1])
        area = 1.1e-4 * 0.9e-4 / 6
        assert power == pytest.approx([15e7 * area], rel=1e-12)


def test_a_wrong_call_tells_why_and_changes_nothing(make):
    with make("tiles") as unit:
        before = unit.read(unit.outputs)
        with pytest.raises(FMICallException):
            unit.slave.doStep(1.0, STEP)
        assert "communication point" in unit.log[-1]
        with pytest.raises(FMICallException):
            unit.slave.enterEventMode()
        assert "no Event Mode" in unit.log[-1]
        assert np.array_equal(unit.read(unit.outputs), before)
        unit.step()


@pytest.mark.parametrize("scene", ["plate", "rings", "tiles", "drop"])
def test_reference_results_are_read_by_fmpy_and_come_again(pack, scene, tmp_path):
    file = pack(scene, None, 3, "--reference")
    step = float(read_model_description(str(file)).defaultExperiment.stepSize)
    with Unit(file, tmp_path) as unit:
        folder = tmp_path / "extra/org.fmi-standard.fmi-ls-ref"
        stimuli, wanted = (read_csv(folder / f"default_{part}.csv") for part in ("in", "ref"))
        assert wanted.dtype.names == ("time", *unit.outputs)
        for name in stimuli.dtype.names[1:]:
            unit[name] = stimuli[name][0]
        for row in wanted:
            if row["time"] > 0:
                unit.step(step)
            assert unit.time == pytest.approx(row["time"], rel=1e-12)
            for name in unit.outputs:
                assert np.array_equal(unit.read([name]), np.ravel(row[name])), (unit.time, name)


def test_fmpy_handles_the_event_of_a_first_crack(pack):
    # A strip between rollers, suddenly colder by more than it bears.
    unit = str(pack("crack", fmi=3))
    assert read_model_description(unit).coSimulation.hasEventMode
    times, step = {}, 0.1
    for use_event_mode in (False, True):
        result = simulate_fmu(
            unit,
            stop_time=2 * step,
            output_interval=step,
            start_values={f"plate.{face}.temperature": 470.0 for face in ("top", "bottom")},
            output=["plate.crack_count"],
            use_event_mode=use_event_mode,
            early_return_allowed=True,
        )
        assert result["plate.crack_count"][-1] >= 1
        times[use_event_mode] = result["time"]
    assert times[False] == pytest.approx([0.0, step, 2 * step])
    assert len(times[True]) > 3 and 0.0 < times[True][1] < step


def test_flat_names_are_those_of_the_same_arrays(pack):
    said = "step = 1e-5\n"
    flat = read_model_description(str(pack("tiles", {said: said + 'naming = "flat"\n'}, fmi=3)))
    plain = read_model_description(str(pack("tiles", fmi=3)))
    conventions = [d.variableNamingConvention for d in (flat, plain)]
    assert conventions == ["flat", "structured"]
    for one, other in zip(flat.modelVariables, plain.modelVariables, strict=True):
        assert one.name == other.name.replace(".", "_")
        assert one.name.isidentifier()
        assert (one.shape, one.valueReference) == (other.shape, other.valueReference)


def test_instances_of_both_versions_share_a_process(pack, make):
    two = Path(pack("tiles"))
    with make("tiles") as three:
        result = simulate_fmu(str(two), stop_time=2 * STEP, output=["centre.temperature"])
        three.step()
        three.step()
        assert result["centre.temperature"][-1] == three["centre.temperature"]


def test_a_master_ends_a_long_step_of_a_droplet(make):
    told = []

    def update(_environment, time, may_set, may_get, finished, can_return_early, wanted, end):
        told.append((time, may_set, may_get, finished, can_return_early))
        if len(told) == 2:
            wanted[0], end[0] = True, time

    with make("drop", update=update) as unit:
        size = 1.0
        event, terminate, early, reached = unit.slave.doStep(0.0, size)
        assert (event, terminate, early) == (False, False, True)
        assert 0.0 < told[0][0] < told[1][0] == reached < size
        assert {tuple(flags) for _, *flags in told} == {(False, False, True, True)}
        assert unit["time"] == reached
        # It goes on from there.
        unit.time = reached
        unit.step(1e-7)
        assert np.isfinite(unit["drop.kinetic_energy"])
        assert len(told) == 2


def test_fmpy_simulates_with_early_return_allowed(pack):
    unit = str(pack("drop", fmi=3))
    runs = [
        simulate_fmu(
            unit, stop_time=2e-7, output=["drop.kinetic_energy"], early_return_allowed=early
        )
        for early in (False, True)
    ]
    assert np.array_equal(*[run["drop.kinetic_energy"] for run in runs])
