"""Studies: designs, scenes, inputs, what is kept, what fails."""

import os
import re
import shlex
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from impinge import Study, StudyWarning, Unit, UnitError, linear_map
from impinge.study import (
    Grid,
    LatinHypercube,
    Levels,
    LogUniform,
    Normal,
    Paired,
    Sobol,
    Table,
    Uniform,
    maximum,
    minimum,
    of_run,
    over_time,
    sobol_indices,
)
from impinge.study.identity import told
from impinge.study.runner import Runner
from linear_unit import make
from slab import AREA, SCENE, top_temperature

SCRIPT = """
from impinge import Study
given = {{"plate.top.flux": ten}}
table = Study("{}", {{}}, inputs=given, outputs=["plate.heat_in"]).run(1, progress=False)
print(table.attrs["command"])
print(repr(table.attrs["inputs"]))
"""


@pytest.fixture(scope="module")
def slab(tmp_path_factory):
    """The scene of the slab."""
    path = tmp_path_factory.mktemp("slab") / "slab.toml"
    path.write_text(SCENE)
    return path


def test_a_grid_has_the_values_of_single_runs_and_of_the_closed_form(slab):
    study = Study(
        slab,
        {
            "plate.conductivity": [5.0, 10.0, 20.0],
            "plate.top.flux": (1e3, 2e3),
            "plate.density": 4000.0,
        },
        outputs=["top.temperature", "plate.heat_in"],
        sampler=Grid(2),
    )
    table = study.run(2)
    assert table["top.temperature"].dims == ("plate.conductivity", "plate.top.flux")
    assert table.sizes == {"plate.conductivity": 3, "plate.top.flux": 2}
    assert (table.status == 0).all()
    for k in table["plate.conductivity"].values:
        for q in table["plate.top.flux"].values:
            found = table.sel({"plate.conductivity": k, "plate.top.flux": q})
            with Unit(slab, parameters={"plate.conductivity": k}) as unit:
                unit["plate.top.flux"] = q
                for _ in range(10):
                    unit.step(0.1)
                assert found["top.temperature"] == unit["top.temperature"]
            expected = top_temperature(q, 1.0, conductivity=k)
            assert found["top.temperature"] == pytest.approx(expected, abs=2e-4 * (expected - 300))
            assert found["plate.heat_in"] == pytest.approx(q * AREA, rel=1e-12)


def test_keys_of_scenes_make_units_of_their_own(slab):
    """The thickness of a box, and an index in a list, go by dotted paths."""
    study = Study(
        slab,
        {"body.plate.shape.box.2": [0.5e-3, 1e-3, 2e-3], "probe.top.at.0": [0.0, 1e-3]},
        inputs={"plate.top.flux": 1e3},
        outputs=["top.temperature", "plate.heat_stored"],
        stop=2.0,
    )
    table = study.run(2)
    assert (table.status == 0).all(), table.message.values
    assert table["body.plate.shape.box.2"].attrs["units"] == "m"
    for thickness in table["body.plate.shape.box.2"].values:
        found = table.sel({"body.plate.shape.box.2": thickness})
        expected = top_temperature(1e3, 2.0, thickness)
        # A uniform flux heats alike everywhere.
        assert found["top.temperature"].values == pytest.approx(expected, rel=1e-4 * 0.01)
        assert found["plate.heat_stored"].values == pytest.approx(1e3 * AREA * 2.0, rel=1e-11)


@pytest.mark.parametrize("fmi", [2, 3])
def test_inputs_over_time_bring_in_their_integral(slab, fmi):
    """Heat is the area times ∫ q dt: exact for parabolas and tables with jumps where inputs are
    interpolated, for straight lines where they are held at their middle."""
    study = Study(
        slab,
        {"slope": [0.0, 1e3]},
        inputs={
            "plate.top.flux": lambda t, p: 500.0 + p["slope"] * t + (3e3 * t**2 if fmi == 2 else 0)
        },
        outputs=["plate.heat_in", over_time("plate.heat_in")],
        step=0.25,
        fmi=fmi,
    )
    table = study.run(1)
    cubic = 1e3 if fmi == 2 else 0.0
    t = table.time.values
    for slope in (0.0, 1e3):
        expected = AREA * (500.0 * t + slope * t**2 / 2 + cubic * t**3)
        found = table.sel(slope=slope)
        assert found["plate.heat_in(t)"].values == pytest.approx(expected, rel=1e-12, abs=1e-15)
        assert found["plate.heat_in"] == found["plate.heat_in(t)"][-1]
    jumps = Table([0.0, 0.3, 0.3, 0.41, 0.9], [1e3, 1e3, -500.0, -500.0, 2e3])
    table = Study(
        slab,
        {},
        inputs={"plate.top.flux": jumps},
        outputs=["plate.heat_in"],
        step=0.25,
        fmi=fmi,
    ).run(1)
    expected = AREA * (300.0 - 55.0 + 0.49 * 750.0 + 0.1 * 2e3)
    assert table["plate.heat_in"].item() == pytest.approx(expected, rel=1e-12)
    assert Table([0.0, 0.5], [1.0, 2.0], hold=True).at(0.5, "left") == 1.0
    with pytest.raises(ValueError, match="go back"):
        Table([1.0, 0.0], [1.0, 1.0])


RELEASE = """
name = "Release"
stop_time = 2e-5
step = 1e-6

[body.drop]
kind = "droplet"
diameter = 6e-5
impact_velocity = 20.0
initial_temperature = 350.0
spacing = 1e-5
release = "input"
most = 3
fluid = { density = 1000.0, viscosity = 1e-3, specific_heat = 4180.0, conductivity = 0.6 }
"""


@pytest.mark.parametrize("fmi", [2, 3])
def test_counts_hold_the_value_of_the_last_row(tmp_path, fmi):
    """A drop is there from the end of the step on that begins with a row that asks for it; so it
    is with a function, which is asked at the beginning of each step."""
    scene = tmp_path / "release.toml"
    scene.write_text(RELEASE)
    for asked in (
        Table([0.0, 5e-6, 1.15e-5, 3e-5], [0.0, 1.0, 2.0, 3.0]),
        lambda t: float(t >= 5e-6) + float(t >= 1.15e-5),
    ):
        given = {"drop.release": asked}
        options = {"outputs": [over_time("drop.released")], "step": 1e-6, "fmi": fmi}
        table = Study(scene, {}, inputs=given, **options).run(1)
        assert (table.status == 0).all(), table.message.values
        found, time = table["drop.released(t)"].values.ravel(), table.time.values
        expected = (time > 5.5e-6).astype(float) + (time > 1.16e-5)
        assert found == pytest.approx(expected)


def test_extremes_and_functions_of_runs(slab, tmp_path):
    """Under q = q₀ sin 2πt, the heat in a slab is largest at half a period, and back at the end."""
    table = Study(
        slab,
        {"plate.specific_heat": [900.0, 1800.0]},
        inputs={"plate.top.flux": lambda t: 1e3 * np.sin(2 * np.pi * t)},
        outputs=[
            maximum("plate.heat_stored"),
            minimum("plate.heat_stored"),
            of_run("never", lambda t, y: np.nan, ["plate.heat_stored"]),
            of_run(
                "peak", lambda t, y: t[y["plate.heat_stored"].argmax()], ["plate.heat_stored"], "s"
            ),
        ],
        step=0.01,
    ).run(1, folder=tmp_path)
    assert np.isnan(table["never"].values).all() and (table.status == 0).all()
    largest = 1e3 * AREA / np.pi
    assert table["max(plate.heat_stored)"].values == pytest.approx(largest, rel=1e-6)
    assert table["min(plate.heat_stored)"].values == pytest.approx(0.0, abs=1e-6 * largest)
    assert table["peak"].values == pytest.approx(0.5)
    assert table["peak"].attrs["units"] == "s"
    assert table["max(plate.heat_stored)"].attrs["units"] == "J"


def test_what_is_asked_for_at_the_stop_is_read_there_alone(slab, monkeypatch):
    """A stress may cost a solve whenever it is read."""
    from impinge.unit.access import Reader

    study = Study(slab, {}, outputs=["top.temperature", over_time("plate.heat_in")], step=0.05)
    counts = {}
    original = Reader.__call__

    def counted(self):
        for variable in self.variables:
            counts[variable.name] = counts.get(variable.name, 0) + 1
        return original(self)

    monkeypatch.setattr(Reader, "__call__", counted)
    assert not Runner(study.package.folder, study.experiment).run(study.rows[0]).failed
    assert counts == {"top.temperature": 1, "plate.heat_in": 21}


def test_states_are_restored_where_inputs_alone_change(slab, monkeypatch):
    study = Study(
        slab,
        {"plate.top.flux": np.linspace(0.0, 1e3, 20), "plate.conductivity": [5.0, 10.0]},
        outputs=["top.temperature"],
    )
    from impinge.study.study import _groups

    (group,) = _groups(study.rows)
    runner = Runner(study.package.folder, study.experiment)
    calls = {"reset": 0, "restore": 0}
    for name in calls:
        original = getattr(Unit, name)

        def counted(self, *given, name=name, original=original):
            calls[name] += 1
            return original(self, *given)

        monkeypatch.setattr(Unit, name, counted)
    answers = {row.index: runner.run(row) for row in group}
    runner.close()
    assert calls == {"reset": 1, "restore": 38}
    table = study.run(2)
    again = np.array([answers[i].values[0] for i in range(40)]).reshape(20, 2)
    assert np.array_equal(table["top.temperature"].values, again)


def test_rows_that_fail_keep_their_message_and_can_be_retried(slab, tmp_path):
    study = Study(
        slab,
        {"plate.specific_heat": [900.0, -1.0], "body.plate.shape.box.2": [1e-3, -1e-3]},
        outputs=["top.temperature"],
    )
    table = study.run(2, folder=tmp_path)
    assert table.status.values.tolist() == [[0, 1], [1, 1]]
    assert "specific_heat" in str(table.message[1, 0].values)
    assert "-1e-3" in str(table.message[0, 1].values).replace("-0.001", "-1e-3")
    assert np.isnan(table["top.temperature"].values[0, 1])
    assert table.attrs["failed"] == 3
    before = (tmp_path / "rows.jsonl").stat().st_size
    study.run(2, folder=tmp_path)
    assert (tmp_path / "rows.jsonl").stat().st_size == before
    again = study.run(2, folder=tmp_path, retry=True)
    assert (tmp_path / "rows.jsonl").stat().st_size > before
    xr.testing.assert_equal(table, again)


@pytest.mark.parametrize("name", ["plate.conductivity", "body.plate.material.conductivity"])
def test_warnings_of_a_run_stand_in_its_row(tmp_path, caplog, name):
    """A unit warns of a thing once in its life, but of each row it is told; so with states that are
    restored, with parameters that change, and with scenes of their own."""
    path = tmp_path / "coarse.toml"
    path.write_text(SCENE.replace("depth_spacing = 0.05e-3", "depth_spacing = 0.5e-3"))
    study = Study(
        path,
        {name: [5.0, 10.0], "plate.top.flux": [0.0, 1e3]},
        outputs=["top.temperature"],
        stop=0.02,
        step=0.01,
    )
    with caplog.at_level("INFO", "impinge"), pytest.warns(StudyWarning, match="4 of 4") as told:
        table = study.run(1, folder=tmp_path)
    assert len(told) == 1
    assert (table.status == 0).all()
    messages = table.message.values.ravel().tolist()
    assert all(re.match(r"plate: a step of 1.0e-2 s is shorter than", text) for text in messages)
    assert messages[0] == messages[1] != messages[2] == messages[3]
    records = [r.getMessage() for r in caplog.records]
    for conductivity in (5.0, 10.0):
        begin = f"({name} = {conductivity}, plate.top.flux = 1000.0): plate: a step"
        assert sum(begin in text for text in records) == 1
    with pytest.warns(StudyWarning, match="4 of 4"):
        xr.testing.assert_equal(study.run(1, folder=tmp_path), table)


DROP = """
name = "Drop"
stop_time = 3.5e-6
step = 5e-8
[body.drop]
kind = "droplet"
method = "sph"
diameter = 0.1e-3
impact_velocity = 50.0
initial_temperature = 373.15
spacing = 5e-6
[body.drop.fluid]
density = 1000.0
viscosity = 3e-4
specific_heat = 4000.0
conductivity = 0.6
surface_tension = 0.059
sound_speed = 500.0
[[wall]]
name = "wall"
under = "drop"
footprint = { rings = { count = 30, radius = 150e-6 } }
start = { temperature = 293.15 }
"""


@pytest.mark.parametrize(
    ("name", "place"),
    [("drop.impact_velocity", "scene.toml:11: "), ("body.drop.spacing", "scene.toml: ")],
)
def test_warnings_name_no_temporary_folder(tmp_path, name, place):
    """Lines are those of the scene as it was written, and of a changed one none."""
    path = tmp_path / "drop.toml"
    path.write_text(DROP)
    values = {"drop.impact_velocity": [50.0], "body.drop.spacing": [4e-6]}
    given = {name: values[name]}
    table = Study(path, given, outputs=["drop.mass"], stop=2e-8, step=1e-8).run(1)
    assert table.message.item().startswith(f"{place}body.drop.spacing = ")


def test_ends_that_are_refused_are_told_before_rows_fail(slab):
    base = {"outputs": ["top.temperature"]}
    with pytest.warns(UserWarning, match="rows with plate.conductivity = -1.0 will fail.*at least"):
        Study(slab, {"plate.conductivity": (-1.0, 5.0)}, **base)
    with pytest.warns(UserWarning, match="rows with body.plate.shape.box.2 = -1.0 will fail"):
        Study(slab, {"body.plate.shape.box.2": [1e-3, -1.0, 2e-3]}, **base)


def test_processes_that_die_and_rows_that_hang_do_not_end_a_study(slab):
    def odd(t, p):
        if p["way"] == 1:
            os.kill(os.getpid(), signal.SIGSEGV)
        if p["way"] == 2:
            time.sleep(60)
        if p["way"] == 3:
            raise RuntimeError("no such laser")
        return 1e3

    study = Study(
        slab,
        {"way": [0, 1, 0.1, 2, 0.2, 3, 0.3, 0.4]},
        inputs={"plate.top.flux": odd},
        outputs=["plate.heat_in"],
    )
    table = study.run(2, timeout=3.0)
    assert table.status.values.tolist() == [0, 1, 0, 1, 0, 1, 0, 0]
    messages = table.message.values
    assert "SIGSEGV" in messages[1] and "longer than 3 s" in messages[3]
    assert "no such laser" in messages[5]
    good = table["plate.heat_in"].values[table.status.values == 0]
    assert good == pytest.approx(1e3 * AREA, rel=1e-12)


def test_samplers_fill_their_ranges(slab):
    parameters = {
        "plate.conductivity": LogUniform(1.0, 100.0),
        "plate.density": Normal(4000.0, 100.0),
        "plate.top.flux": Levels((1.0, 2.0, 4.0)),
        "plate.specific_heat": 900.0,
    }
    study = Study(slab, parameters, outputs=["top.temperature"], sampler=LatinHypercube(90, seed=3))
    columns = {name: np.array([r[name] for r in study.design.rows]) for name in parameters}
    slices = np.floor(np.log10(columns["plate.conductivity"]) / 2 * 90).astype(int)
    assert sorted(slices) == list(range(90))
    assert np.unique(columns["plate.top.flux"], return_counts=True)[1].tolist() == [30, 30, 30]
    assert columns["plate.density"].mean() == pytest.approx(4000.0, abs=2.0)
    assert columns["plate.density"].std() == pytest.approx(100.0, rel=0.05)
    assert set(columns["plate.specific_heat"]) == {900.0}
    paired = Study(
        slab,
        {"plate.conductivity": [1.0, 2.0], "plate.top.flux": [3.0, 4.0]},
        outputs=["top.temperature"],
        sampler=Paired(),
    )
    assert [list(row.values()) for row in paired.design.rows] == [[1.0, 3.0], [2.0, 4.0]]


@pytest.mark.parametrize("sampler", [LatinHypercube(32), Sobol(16)])
@pytest.mark.parametrize("values", [("a", 1, 2.5), (1, 2.5, True), tuple(np.arange(3))])
def test_samplers_take_levels_as_they_are(sampler, values):
    parameters = {"a": Levels(values), "b": Uniform(0.0, 1.0)}
    found = {repr(row["a"]) for row in sampler.design(parameters).rows}
    assert found == {repr(row["a"]) for row in Grid().design(parameters).rows}
    assert found == {repr(v.item() if isinstance(v, np.generic) else v) for v in values}


def test_sobol_indices_are_those_of_a_product(slab, tmp_path):
    """Heat is q A t: of y = q t², uniform q and held t, the index of q is 1, and for y = a b with
    independent factors S_a = E[b]² V[a] / V[ab], T_a = E[b²] V[a] / V[ab]."""
    study = Study(
        slab,
        {"a": (1.0, 2.0), "b": (1.0, 3.0), "plate.conductivity": (5.0, 20.0)},
        inputs={"plate.top.flux": lambda t, p: 1e3 * p["a"] * p["b"]},
        outputs=["plate.heat_in", over_time("top.temperature")],
        stop=0.2,
        sampler=Sobol(256),
    )
    table = study.run(2, folder=tmp_path)
    indices = sobol_indices(xr.load_dataset(tmp_path / "study.nc"), ["plate.heat_in"])
    mean_a, mean_b, var_a, var_b = 1.5, 2.0, 1 / 12, 4 / 12
    whole = (var_a + mean_a**2) * (var_b + mean_b**2) - (mean_a * mean_b) ** 2
    first = [mean_b**2 * var_a / whole, mean_a**2 * var_b / whole, 0.0]
    total = [(var_b + mean_b**2) * var_a / whole, (var_a + mean_a**2) * var_b / whole, 0.0]
    assert indices["first"].sel(output="plate.heat_in").values == pytest.approx(first, abs=0.03)
    assert indices["total"].sel(output="plate.heat_in").values == pytest.approx(total, abs=0.03)
    half = indices["first_confidence"].values[0]
    assert np.all(np.abs(indices["first"].values[0] - first) <= 2 * half + 1e-12)
    assert half[:2].max() < 0.2
    with pytest.warns(UserWarning, match="same in all rows"):  # at time zero
        over = sobol_indices(table, ["top.temperature(t)"])
    assert over.sizes["output"] == table.sizes["time"]
    assert over["output"].values[0] == "top.temperature(t)[1]"
    with pytest.raises(ValueError, match="Sobol"):
        sobol_indices(table.assign_attrs(sampler_kind="Grid"))


def test_tables_tell_where_they_come_from(slab, tmp_path):
    study = Study(
        slab,
        {"plate.conductivity": (5.0, 20.0)},
        inputs={"plate.top.flux": lambda t: 1e3 if t < 0.5 else 0.0},
        outputs=["top.temperature"],
        sampler=LatinHypercube(3),
    )
    study.run(1, folder=tmp_path)
    stored = xr.load_dataset(tmp_path / "study.nc")
    assert stored["top.temperature"].attrs["units"] == "K"
    assert stored["plate.conductivity"].attrs["units"] == "W/(m.K)"
    assert stored.attrs["scene"] == SCENE
    assert stored.attrs["unit_sha256"] == study.unit_hash
    assert any(text.startswith("numpy ") for text in stored.attrs["versions"])
    (function,) = np.atleast_1d(stored.attrs["inputs"])
    assert "lambda t: 1e3 if t < 0.5 else 0.0" in function and " at 0x" not in function
    assert re.search("sha256 [0-9a-f]{64}", function)
    for call in (np.sin, eval("lambda t: t")):  # without a source
        assert re.search("(sin|<lambda>), sha256 [0-9a-f]{64}$", told(call))
    program, *_ = shlex.split(stored.attrs["command"])
    assert Path(program).is_absolute() and Path(stored.attrs["working_folder"]) == Path.cwd()
    script = tmp_path / "script.py"
    script.write_text("def ten(t): return 10.0\n" + SCRIPT.format(slab))
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    ran = subprocess.run(
        [sys.executable, "script.py", "a b"],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    )
    command, function = ran.stdout.splitlines()
    assert shlex.split(command) == [sys.executable, str(script.resolve()), "a b"]
    assert "function __main__.ten, sha256" in function and "def ten(t): return 10.0" in function
    assert {"command", "date", "stop", "step", "generation_tool"} <= set(stored.attrs)


@pytest.mark.parametrize("states", [True, False])
def test_units_of_other_tools_are_studied(tmp_path, states):
    """x' = −2 x + u with u = s (1 + t) or held, whether or not states can be restored."""
    unit = make(tmp_path, "Decay", [[-2.0]], [1.0], [1.0], x=[3.0], states=states)
    study = Study(
        unit,
        {"s": [-1.0, 0.0, 2.0]},
        inputs={"u": lambda t, p: p["s"] * (1.0 + t)},
        outputs=["y", over_time("y")],
        stop=2.0,
        step=0.25,
    )
    table = study.run(2)
    assert (table.status == 0).all(), table.message.values
    t = table.time.values
    for s in (-1.0, 0.0, 2.0):
        expected = s * (0.25 + t / 2) + (3.0 - s / 4) * np.exp(-2.0 * t)
        assert table["y(t)"].sel(s=s).values == pytest.approx(expected, abs=1e-8)
    held = Study(unit, {"u": [1.0, 2.0, 4.0]}, outputs=["y"], stop=2.0, step=0.25).run(1)
    u = held["u"].values
    expected = u / 2 + (3.0 - u / 2) * np.exp(-4.0)
    assert held["y"].values == pytest.approx(expected, abs=1e-8)


def test_tunable_parameters_are_set_as_inputs_are(tmp_path):
    scene = tmp_path / "tunable.toml"
    scene.write_text(
        SCENE.replace("top = { flux = 0.0 }", 'top = { flux = 0.0, role = "parameter" }')
    )
    with Unit(scene) as unit:
        assert unit.variable("plate.top.flux").variability == "tunable"
        found = linear_map(unit, ["plate.top.flux"], ["plate.heat_in"], 0.5, 4)
    assert found.held.ravel() == pytest.approx(0.5 * AREA, rel=1e-11)
    given = {"plate.top.flux": lambda t: 1e3 * t}
    table = Study(scene, {}, inputs=given, outputs=["plate.heat_in"]).run(1)
    assert table["plate.heat_in"].item() == pytest.approx(500.0 * AREA, rel=1e-11)
    table = Study(scene, {"plate.top.flux": [1e3, 2e3]}, outputs=["plate.heat_in"]).run(1)
    assert table["plate.heat_in"].values == pytest.approx([1e3 * AREA, 2e3 * AREA], rel=1e-11)


@pytest.mark.parametrize(
    ("given", "what"),
    [
        ({"parameters": {"plate.conductivty": [1.0]}}, "conductivity"),
        ({"parameters": {"body.plate.nothing.here": [1.0]}}, "no parameter, input or key"),
        ({"parameters": {"top.temperature": [1.0]}}, "cannot be set"),
        ({"parameters": {"stop_time": [1.0]}}, "study's stop"),
        ({"parameters": {"probe.top.att": [1.0]}}, "unknown key `att`.*did you mean `at`"),
        ({"parameters": {"body.plate.mesh.spacin": (1e-4, 1e-3)}}, "`spacin`.*allowed: .*spacing"),
        ({"parameters": {"body.plate.shape.box.2": (-2.0, -1.0)}}, "box.2 = -2.0: .*allowed: "),
        ({"parameters": {"plate.conductivity": -1.0}}, "conductivity = -1.0: .*at least 0"),
        ({"parameters": {"plate.conductivity": (-3.0, -1.0)}}, "conductivity = -3.0: .*at least 0"),
        ({"parameters": {"plate.conductivity": ["a"]}}, "= 'a' .allowed: numbers"),
        ({"parameters": {"plate.conductivity": [5.0, "a"]}}, "= 'a' .allowed: numbers"),
        ({"parameters": {"plate.top.flux": "1e3"}}, "= '1e3' .allowed: numbers"),
        ({"parameters": {"solver.threads": [1, 1.5]}}, "= 1.5 .allowed: whole numbers"),
        ({"parameters": {"output.directory": [1.0]}}, "= 1.0 .allowed: texts"),
        ({"stop": 0.5, "step": 0.6}, "step = 0.6 s .allowed: at most the stop, 0.5 s"),
        ({"parameters": {"plate.poisson": [0.7, 0.9]}}, "no parameter, input or key"),
        ({"parameters": {"plate.density": (2.0, 1.0)}}, "range that grows"),
        ({"parameters": {"plate.density": [np.nan]}}, "finite"),
        ({"inputs": {"plate.density": 1.0}}, "fixed|parameter"),
        ({"inputs": {"plate.top.flux": np.inf}}, "finite"),
        ({"outputs": []}, "at least one"),
        ({"step": 1e-30}, "for at most 1e[+]08 steps"),
        ({"outputs": ["no.such"]}, "no variable"),
        ({"outputs": ["plate.density"]}, "has not yet"),
        ({"outputs": ["output.directory"]}, "no number"),
        ({"outputs": ["top.temperature"] * 2}, "twice"),
        ({"stop": -1.0}, "above 0"),
        ({"sampler": LatinHypercube(0)}, "at least 1"),
        ({"sampler": Sobol(6)}, "powers of two"),
    ],
)
def test_what_does_not_fit_is_refused_before_anything_runs(slab, given, what):
    base = {"parameters": {"plate.density": (1.0, 2.0)}, "outputs": ["top.temperature"]}
    with pytest.raises((ValueError, UnitError), match="(?s)" + what):
        Study(slab, **{**base, **given})
