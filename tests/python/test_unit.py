"""`Unit`: the same by FMI 2.0 and 3.0, from scenes, files and folders, and by units of others."""

import gc
import logging
import os
import subprocess
import sys
import zipfile
from math import exp

import numpy as np
import pytest
from impinge import StepDiscarded, Unit, UnitError
from impinge.unit import build, open_package
from linear_unit import make

STEP = 1e-5
FLUX = np.arange(6.0).reshape(2, 3) * 1e7
both = pytest.mark.parametrize("fmi", [2, 3])


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("units")


@pytest.fixture(autouse=True)
def cache(folder, monkeypatch, programs):
    monkeypatch.setenv("IMPINGE_CACHE", str(folder / "cache"))
    monkeypatch.setenv("IMPINGE_BIN", str(programs))


def test_both_versions_give_the_same_bits_and_shapes(pack):
    rows = []
    for fmi in (2, 3):
        with Unit(pack("tiles", fmi=fmi), parameters={"block.conductivity": 12.0}) as unit:
            assert unit.inputs["patch.heat_flux"].shape == (2, 3)
            assert unit.inputs["patch.heat_flux"].unit == "W/m2"
            assert unit.inputs["patch.heat_flux"].nominal == 1e6
            assert unit.parameters["block.conductivity"].start == 10.0
            assert unit["block.conductivity"] == 12.0
            unit["patch.heat_flux"] = FLUX
            unit["patch.heat_flux[1,1]"] = 5e6  # one element
            unit.set({"patch.pressure": 1e6, "patch.x": 1e-5})  # one number fills an array
            assert unit["patch.heat_flux"].tolist() == [[5e6, 1e7, 2e7], [3e7, 4e7, 5e7]]
            assert unit["patch.heat_flux[2,3]"] == 5e7
            unit.step(STEP)
            unit.step_to(5 * STEP)
            assert unit.time == 5 * STEP
            rows.append(unit.get(list(unit.outputs)))
    assert np.array_equal(*rows)


@both
def test_arrays_and_numbers_come_in_one_call_in_order(pack, fmi):
    with Unit(pack("plate", fmi=fmi), parameters={"spot.heat_flux": 1e8}) as unit:
        unit.step(STEP)
        values = unit.get(["centre.temperature", "surface.temperature", "solver.threads"])
        assert values.shape == (10,)
        assert values[0] == unit["centre.temperature"]
        assert np.array_equal(values[1:9].reshape(4, 2), unit["surface.temperature"])
        assert isinstance(unit["solver.threads"], int)
        assert unit["output.directory"] == ""
        x = unit.coordinates("surface.temperature")
        assert x["x"].size in (4, 8) and np.ptp(x["x"]) > 0


@both
def test_elements_that_are_set_together_all_keep_their_values(pack, fmi):
    """In any order and beside the whole array; those without a value stay as they are."""
    with Unit(pack("tiles", fmi=fmi)) as unit:
        unit["patch.heat_flux"] = FLUX
        names = ["patch.heat_flux[2,3]", "patch.heat_flux[1,2]", "patch.heat_flux[2,1]"]
        unit.set({names[0]: 9e6, "patch.pressure": 1e6, names[1]: 7e6, names[2]: 8e6})
        wanted = np.array(FLUX)
        wanted[1, 2], wanted[0, 1], wanted[1, 0] = 9e6, 7e6, 8e6
        assert np.array_equal(unit["patch.heat_flux"], wanted)
        read = unit.get([*names, "patch.heat_flux", "patch.pressure[1,1]", names[0]])
        assert read.tolist() == [9e6, 7e6, 8e6, *wanted.ravel(), 1e6, 9e6]


def test_elements_of_an_array_of_fmi_3_are_set_by_one_reference(pack, monkeypatch):
    """However many they are: one copy of the array passes, not one for each of them."""
    names = [f"patch.heat_flux[{i},{j}]" for i in (1, 2) for j in (1, 2, 3)]
    with Unit(pack("tiles", fmi=3)) as unit:
        passed = []
        access = unit.slave.access
        monkeypatch.setattr(
            unit.slave,
            "access",
            lambda verb, kind, references, values: (
                passed.append((verb, references.size, values.size))
                or access(verb, kind, references, values)
            ),
        )
        unit.set(dict.fromkeys(names, 1e6))
        unit.set(dict.fromkeys(names[:4], 2e6))
        assert passed == [("Set", 1, 6), ("Set", 1, 6), ("Get", 1, 6)]
        assert unit["patch.heat_flux"].ravel().tolist() == [2e6] * 4 + [1e6] * 2


@both
def test_states_go_on_to_the_bit_here_there_and_as_bytes(pack, fmi):
    file = pack("plate", fmi=fmi)
    with Unit(file, parameters={"spot.heat_flux": 1e8, "plate.young": 2e11}) as unit:
        unit.step(STEP)
        sent = unit.save()
        with unit.state() as state:
            unit.step(STEP)
            wanted = unit.get(list(unit.outputs))
            unit["spot.heat_flux"] = 0.0
            unit.step(STEP)
            unit.restore(state)
            assert (unit.time, unit["spot.heat_flux"]) == (STEP, 1e8)
            unit.step(STEP)
            assert np.array_equal(unit.get(list(unit.outputs)), wanted)
            again = unit.state(into=state)  # the same place
            assert again is state and state.time == 2 * STEP
        with pytest.raises(UnitError, match="has been freed"):
            unit.restore(state)
        with Unit(file) as other:
            other.load(sent)
            assert other.time == STEP
            other.step(STEP)
            assert np.array_equal(other.get(list(other.outputs)), wanted)
            with pytest.raises(UnitError, match="not what Unit.save returns"):
                other.load(b"something else")
            with pytest.raises(UnitError, match="saved state"):
                other.load(sent[:-9] + b"123456789")


@both
def test_reset_begins_anew_as_the_unit_was_made(pack, fmi):
    own = {"patch.heat_flux": FLUX, "block.conductivity": 12.0}
    with Unit(pack("tiles", fmi=fmi), parameters=own) as unit:
        unit.step(STEP)
        first = unit["centre.temperature"]
        unit.reset({"block.conductivity": 20.0})
        assert (unit.time, unit["block.conductivity"]) == (0.0, 20.0)
        unit.step(STEP)
        assert unit["centre.temperature"] < first
        unit.reset()
        unit.step(STEP)
        assert unit["centre.temperature"] == first


@both
def test_what_is_wrong_is_told_in_the_units_own_words(pack, fmi):
    with Unit(pack("tiles", fmi=fmi)) as unit:
        unit.step(STEP)
        before = unit.get(list(unit.outputs))
        for wrong, told in [
            (lambda: unit["centre.temprature"], "is it `centre.temperature`"),
            (lambda: unit["patch.heat_flux[3,1]"], "no variable `patch.heat_flux[3,1]`"),
            (lambda: unit.set({"block.conductivity": 3.0}), "may be set until initialisation"),
            (lambda: unit.set({"patch.heat_flux": np.zeros((2, 2))}), "takes (2, 3), not an array"),
            (lambda: unit.set({"patch.x": "far"}), "takes one number, not 'far'"),
            (lambda: unit.set({"patch.x": np.nan}), "patch.x"),
            (lambda: unit.set({"output.directory": 3}), "takes str, not 3"),
            (lambda: unit.step(-1.0), "step size -1.0 s is not positive"),
            (lambda: unit.depends_on("centre.nothing"), "has no output `centre.nothing`"),
            (lambda: unit.cells("centre"), "tells no cells of `centre`"),
        ]:
            with pytest.raises(UnitError) as refused:
                wrong()
            assert told in "\n".join([str(refused.value), *getattr(refused.value, "__notes__", [])])
            assert np.array_equal(unit.get(list(unit.outputs)), before)
        unit.step(STEP)
    with pytest.raises(UnitError, match="the unit is closed"):
        unit["patch.x"]
    with pytest.raises(UnitError, match="must be whole numbers"):
        Unit(pack("tiles", fmi=fmi), parameters={"solver.threads": 0.5})
    with pytest.raises(UnitError, match="must be at least"):
        Unit(pack("tiles", fmi=fmi), parameters={"block.conductivity": -1.0})


@both
def test_steps_far_too_long_are_discarded(pack, fmi):
    """Units of FMI 3.0 end them early, again and again."""
    with Unit(pack("drop", fmi=fmi)) as unit:
        with pytest.raises(StepDiscarded, match="take shorter") as stopped:
            unit.step(1e3)
        assert unit.time == stopped.value.time < 1.0


@both
def test_a_discarded_step_leaves_the_unit_where_it_was(pack, fmi):
    with Unit(pack("tiles", fmi=fmi), parameters={"patch.heat_flux": -1e12}) as unit:
        state = unit.state()
        with pytest.raises(StepDiscarded, match="below absolute zero") as stopped:
            unit.step(1e-3)
        assert (stopped.value.time, stopped.value.terminated, unit.time) == (0.0, False, 0.0)
        assert unit["block.heat_in"] == 0.0
        if fmi == 2:  # which lets units go on from saved states alone
            unit.restore(state)
        unit["patch.heat_flux"] = 1e7
        unit.step(STEP)
        assert unit["block.heat_in"] == pytest.approx(1e7 * 1.1e-4 * 0.9e-4 * STEP, rel=1e-9)


def test_inputs_follow_polynomials_where_units_can(pack):
    area = 1.1e-4 * 0.9e-4
    with Unit(pack("tiles")) as unit:
        assert (unit.can.interpolates, unit.can.states, unit.can.output_derivatives) == (2, True, 1)
        unit["patch.heat_flux"] = 1e6
        unit.set_input_derivatives({"patch.heat_flux": [2e11, 3e16]})
        unit.step(STEP)
        exact = 1e6 * STEP + 2e11 * STEP**2 / 2 + 3e16 * STEP**3 / 6
        assert unit["block.heat_in"] == pytest.approx(area * exact, rel=1e-10)
        path = unit.path_writer(["patch.heat_flux"], 1)
        path.values[:], path.first[:] = 1e6, 4e11
        path()
        before = unit["block.heat_in"]
        unit.step(STEP)
        exact = 1e6 * STEP + 4e11 * STEP**2 / 2
        assert unit["block.heat_in"] - before == pytest.approx(area * exact, rel=1e-10)
        assert unit["patch.heat_flux[1,1]"] == pytest.approx(1e6 + 4e11 * STEP)
        power = unit.output_derivatives(["block.heat_in"])
        assert power[0] == pytest.approx(area * (1e6 + 4e11 * STEP), rel=1e-9)
        change = unit.directional_derivative(["centre.stress_xx"], {"patch.pressure": 1.0})
        before = unit["centre.stress_xx"]
        unit["patch.pressure"] = 1e5
        assert unit["centre.stress_xx"] - before == pytest.approx(1e5 * change[0], rel=1e-6)
    with Unit(pack("tiles", fmi=3)) as unit:
        assert unit.can.interpolates == 0
        with pytest.raises(UnitError, match="holds its inputs over a step"):
            unit.set_input_derivatives({"patch.heat_flux": [1.0]})


@both
def test_dependencies_go_by_families(pack, fmi):
    with Unit(pack("tiles", fmi=fmi)) as unit:
        assert unit.depends_on("centre.temperature") == {"block.bottom.temperature"}
        assert "patch.pressure" in unit.depends_on("centre.stress_xx")
        assert "patch.heat_flux" not in unit.depends_on("centre.stress_xx")


def test_cells_tell_where_they_are_and_how_large(pack):
    with Unit(pack("tiles")) as unit:
        cells = unit.cells("patch.heat_flux[1,2]")
        assert cells["count"] == [2, 3] and "pressure" in cells["quantities"]
        assert np.sum(cells["area"]) == pytest.approx(1.1e-4 * 0.9e-4)
        assert unit.coordinates("patch")["y"][1] == 0.0


@both
def test_flat_names_have_the_cells_of_structured_ones(pack, fmi):
    said = "stop_time = 1e-4"
    named = pack("tiles", {said: f'{said}\nnaming = "flat"'}, fmi)
    with Unit(pack("tiles", fmi=fmi)) as unit, Unit(named) as flat:
        for name in ("patch_heat_flux_2_3", "patch_heat_flux[2,3]", "patch_heat_flux", "patch"):
            assert flat.cells(name) == unit.cells("patch.heat_flux")
        one = "patch_heat_flux_2_3" if fmi == 2 else "patch_heat_flux[2,3]"
        assert flat.areas(one) == unit.areas("patch.heat_flux[2,3]")
        assert flat.areas(one) == pytest.approx([1.1e-4 * 0.9e-4 / 6])
        assert flat.areas("patch").sum() == pytest.approx(1.1e-4 * 0.9e-4)
        for wrong in ("patch_heat_flux_3_1", "patch_x", "centre_temperature"):
            with pytest.raises(UnitError):
                flat.areas(wrong)


def test_scenes_are_built_once_for_each_content(pack, folder, tmp_path):
    scene = tmp_path / "scene.toml"
    text = (pack("drop").parent / "scene.toml").read_text()
    scene.write_text(text)
    first = build(scene)
    stamp = first.stat().st_mtime_ns
    with Unit(scene) as unit, Unit(first) as other:
        assert unit.folder == other.folder  # one folder for the same content
        assert unit.package is other.package
    assert build(scene).stat().st_mtime_ns == stamp
    assert build(scene, fmi=3) != first
    scene.write_text(text.replace("conductivity = 0.6", "conductivity = 0.7"))
    assert build(scene) != first
    scene.write_text(text.replace("conductivity = 0.6", "conductivty = 0.7"))
    with pytest.raises(UnitError, match="conductivty"):
        build(scene)
    with pytest.raises(UnitError, match="no such file"):
        Unit(tmp_path / "nothing.fmu")
    with pytest.raises(UnitError, match="not 3"):
        Unit(first, fmi=3)


def test_a_scene_that_is_saved_while_it_is_built_makes_the_unit_of_its_key(
    pack, tmp_path, monkeypatch
):
    monkeypatch.setenv("IMPINGE_CACHE", str(tmp_path / "cache"))
    scene = tmp_path / "scene.toml"
    text = (pack("drop").parent / "scene.toml").read_text()
    scene.write_text(text)
    module = sys.modules["impinge.unit.build"]

    def save(content, folder):  # after the scene was read
        scene.write_text(text.replace('"Drop"', '"Other"'))
        return {}

    with monkeypatch.context() as patched:
        patched.setattr(module, "files_of", save)
        built = build(scene)
    scene.write_text(text)
    assert build(scene) == built
    with Unit(built) as unit:
        assert unit.name == "Drop"


def test_what_is_wrong_with_a_scene_is_said_of_its_own_file(tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text("stop_time = 1\n")
    with pytest.raises(UnitError) as refused:
        build(scene)
    assert f"{scene}:1: name: " in str(refused.value)
    assert "cache" not in str(refused.value)


def test_files_that_a_scene_names_belong_to_it(tmp_path):
    """G-code and parts in the scene's folder or below it; others are refused by `build-fmu`."""
    files_of = sys.modules["impinge.unit.build"].files_of
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts/ring.vtu").write_bytes(b"cells")
    (tmp_path / "square.gcode").write_bytes(b"G1")
    content = """
    [body.ring]
    shape = { part = { file = "parts/ring.vtu" } }
    [body.ink]
    path = { file = "square.gcode" }
    [body.other]
    shape = { part = { file = "../ring.vtu" } }
    [body.box]
    shape = { box = [1.0, 1.0, 1.0] }
    """
    found = files_of(content.encode(), tmp_path)
    assert found == {"parts/ring.vtu": b"cells", "square.gcode": b"G1"}
    assert files_of(f"{content}\n[files]\na = 'b'".encode(), tmp_path) == {}


def test_units_of_others(folder):
    file = make(folder, "decay", [[-3.0]], [1.0], [2.0], d=0.5, x=[1.0], u_unit="K")
    with Unit(file) as unit:
        assert (unit.can.interpolates, unit.depends_on("y")) == (1, {"u"})
        for _ in range(3):
            unit.step(0.1)
        assert unit["y"] == pytest.approx(2 * exp(-0.9), rel=1e-12)
        unit["u"] = 4.0
        assert unit["y"] == pytest.approx(2 * exp(-0.9) + 2.0, rel=1e-12)
    unzipped = folder / "unzipped"
    with zipfile.ZipFile(file) as archive:
        archive.extractall(unzipped)
    with Unit(unzipped) as unit:
        assert unit.folder == unzipped
        unit.step(0.1)
    stuck = make(folder, "stuck", [[-3.0]], [1.0], [2.0], states=False)
    with Unit(stuck) as unit, pytest.raises(UnitError, match="cannot save and restore its state"):
        unit.state()


PYTHON_UNIT = """
from pythonfmu import Boolean, Fmi2Causality, Fmi2Slave, Fmi2Variability, Integer, Real, String

class Counter(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.u, self.y, self.count, self.is_on, self.name = 0.0, 0.0, 0, False, "none"
        self.register_variable(Real("u", causality=Fmi2Causality.input))
        self.register_variable(Real("y", causality=Fmi2Causality.output))
        told = {"causality": Fmi2Causality.output, "variability": Fmi2Variability.discrete}
        self.register_variable(Integer("count", **told))
        told = {"causality": Fmi2Causality.input, "variability": Fmi2Variability.discrete}
        self.register_variable(Boolean("is_on", **told))
        told = {"causality": Fmi2Causality.parameter, "variability": Fmi2Variability.fixed}
        self.register_variable(String("name", **told))

    def do_step(self, time, step):
        if self.u > 1e3:
            return False
        self.count += 1
        self.y += self.u * step
        return True
"""


def test_a_unit_of_pythonfmu(folder):
    (folder / "counter.py").write_text(PYTHON_UNIT)
    command = [sys.executable, "-m", "pythonfmu", "build", "-f", "counter.py"]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    with Unit(folder / "Counter.fmu", parameters={"name": "Zähler"}) as unit:
        unit.set({"u": 2.0, "is_on": True})
        unit.step(0.5)
        assert (unit["y"], unit["count"], unit["is_on"], unit["name"]) == (1.0, 1, True, "Zähler")
        assert not unit.can.states
        assert unit.depends_on("y") == {"u", "is_on"}  # it declares nothing
        unit["u"] = 1e4
        with pytest.raises(StepDiscarded):
            unit.step(0.5)


def test_messages_go_where_they_are_wanted(pack, caplog):
    heard = []
    with Unit(pack("plate"), logger=lambda *told: heard.append(told)) as unit:
        unit["centre.temperature"]
        unit["spot.heat_flux"] = -1.0
        with pytest.raises(UnitError):
            unit.step(0.0)
    assert any(status == 3 and "step size" in message for status, _, message in heard)
    with caplog.at_level(logging.WARNING, logger="impinge"):
        with Unit(pack("plate"), parameters={"plate.initial_temperature": 20.0}) as unit:
            unit.step(STEP)
            assert any("20" in line for line in unit.log)
    assert "plate.initial_temperature" in caplog.text


def test_units_end_with_their_last_reference_and_leave_no_thread(pack):
    threads = len(os.listdir("/proc/self/task"))
    unit = Unit(pack("plate"))
    state, reader = unit.state(), unit.reader(["centre.temperature"])
    slave = unit.slave
    del unit
    gc.collect()
    assert slave.component is None
    state.free()
    with pytest.raises(UnitError, match="closed"):
        reader()
    assert len(os.listdir("/proc/self/task")) == threads


def test_a_package_can_be_looked_at_without_an_instance(pack):
    package = open_package(pack("tiles"))
    assert package.fmi == 2 and package.name == "Tiled"
    assert package.variables["patch.shear_x"].shape == (2, 3)
    assert package.variable("patch.shear_x[2,3]").shape == ()
    assert package.variables["patch.shear_x"].references.size == 6


def test_programs_are_found_from_within_a_checkout(tmp_path, monkeypatch):
    """As after `pip install ./python`, where the package lies in no checkout."""
    build = sys.modules["impinge.unit.build"]
    package = tmp_path / "site-packages/impinge/unit/build.py"
    monkeypatch.setattr(build, "__file__", str(package))
    monkeypatch.delenv("IMPINGE_BIN", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    checkout, other = tmp_path / "work/checkout", tmp_path / "work/other"
    for folder, name in ((checkout, "impinge"), (other, "other")):
        (folder / "target/release").mkdir(parents=True)
        (folder / "inner").mkdir()
        (folder / "Cargo.toml").write_text(f'[package]\nname = "{name}"\n')
        (folder / "target/release" / build.PROGRAM).write_text("")
    monkeypatch.chdir(checkout / "inner")
    assert build.find_program() == checkout / "target/release" / build.PROGRAM
    for folder in (other / "inner", tmp_path):  # of another project, and of none
        monkeypatch.chdir(folder)
        with pytest.raises(UnitError, match=r"export IMPINGE_BIN=\$PWD/target/release"):
            build.find_program()
    (checkout / "target/release" / build.PROGRAM).unlink()
    monkeypatch.chdir(checkout)
    with pytest.raises(UnitError, match="nor on PATH, nor in .*checkout/target/release"):
        build.find_program()
