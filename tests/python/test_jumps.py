"""Functions of time that jump: what they bring in is area times ∫ q dt, wherever they jump."""

import warnings

import numpy as np
import pytest
from impinge import Function, Master, Study
from impinge.jumps import Watched
from impinge.master import Graded, MasterWarning
from impinge.study import Table, over_time
from impinge.study.signals import timeline
from linear_unit import make
from slab import AREA, SCENE

# A name, a function of time, and its integral from 0 to 1 s.
COURSES = [
    ("before", lambda t: 7e3 if t < 0.5 else 0.0, 3500.0),
    ("until", lambda t: 7e3 if t <= 0.5 else 0.0, 3500.0),
    ("within", lambda t: 7e3 if t < 0.53 else 0.0, 3710.0),
    ("up", lambda t: 0.0 if t < 0.1 * 3 else 2e3, 1400.0),
    ("twice", lambda t: 5e3 if 0.512 < t < 0.57 else 1e3, 942.0 + 290.0),
    ("saw", lambda t: 1e3 * ((t / 0.25) % 1.0), 500.0),
    ("bent", lambda t: 3e3 * t**2 if t < 0.64 else 500.0, 1e3 * 0.64**3 + 180.0),
]


CUTS = {"bent": [0.64], "saw": [0.25, 0.75]}


def as_held(name, function, order):
    """The integral of what is held at ends of steps (order 0), goes straight over them (1), or is
    held in their middles ("middle"), with steps that are cut at jumps."""
    times = np.union1d(np.linspace(0.0, 1.0, 11).round(9), CUTS[name])
    total = 0.0
    for begin, end in zip(times[:-1], times[1:], strict=True):
        first, middle, last = (function(t) for t in (begin + 1e-9, (begin + end) / 2, end - 1e-9))
        total += (end - begin) * {0: last, 1: (first + last) / 2, "middle": middle}[order]
    return total


@pytest.fixture(scope="module")
def slab(tmp_path_factory):
    path = tmp_path_factory.mktemp("jumps") / "slab.toml"
    path.write_text(SCENE)
    return path


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize(("name", "function", "integral"), COURSES, ids=[c[0] for c in COURSES])
def test_studies_bring_in_what_jumping_functions_say(slab, fmi, name, function, integral):
    """Units of FMI 3.0 hold inputs at the middle of a step: exact for what is straight."""
    heat = over_time("plate.heat_in")
    study = Study(
        slab, {}, inputs={"plate.top.flux": function}, outputs=["plate.heat_in", heat], fmi=fmi
    )
    table = study.run(1)
    if fmi == 3 and name == "bent":
        integral = as_held(name, function, "middle")
    assert table["plate.heat_in"].item() == pytest.approx(integral * AREA, rel=1e-7)
    if name == "within":
        expected = 7e3 * np.minimum(table.time.values, 0.53) * AREA
        assert table["plate.heat_in(t)"].values[0] == pytest.approx(expected, rel=1e-7, abs=1e-15)


def test_functions_of_a_row_may_jump_where_the_row_says(slab):
    """The step is cut at another time in every row."""
    times = [0.31, 0.5, 0.777]
    table = Study(
        slab,
        {"until": times},
        inputs={"plate.top.flux": lambda t, row: 1e3 if t < row["until"] else 0.0},
        outputs=["plate.heat_in"],
    ).run(1)
    assert table["plate.heat_in"].values == pytest.approx(1e3 * AREA * np.array(times), rel=1e-7)


@pytest.mark.parametrize("order", [0, 1, 2])
@pytest.mark.parametrize(("name", "function", "integral"), COURSES, ids=[c[0] for c in COURSES])
def test_masters_bring_in_what_jumping_functions_say(slab, order, name, function, integral):
    """Of the degree in time that is asked for: straight pieces from the first degree on."""
    inputs = {"p.plate.top.flux": function}
    with Master({"p": slab}, inputs=inputs, order=order, outputs=["p.plate.heat_in"]) as master:
        heat = master.run(1.0)["p.plate.heat_in"].values[-1]
    if (name == "saw" and order == 0) or (name == "bent" and order < 2):
        integral = as_held(name, function, order)
    assert heat == pytest.approx(integral * AREA, rel=1e-7)


def test_runs_that_stop_at_a_jump_go_on_behind_it(slab):
    inputs = {"p.plate.top.flux": lambda t: 7e3 if t < 0.5 else 1e3}
    with Master({"p": slab}, inputs=inputs, outputs=["p.plate.heat_in"]) as master:
        master.run(0.5)
        result = master.run(1.0)
    expected = AREA * (7e3 * np.minimum(result.time, 0.5) + 1e3 * np.maximum(result.time - 0.5, 0))
    assert result["p.plate.heat_in"].values == pytest.approx(expected.values, rel=1e-7, abs=1e-15)
    assert result.attrs["steps"] == 10  # a jump at a communication point costs none


def sum_up(v, state, step):
    return state + v * step, state + v * step


INTEGRAL = Function(
    sum_up, {"v": "1"}, {"s": "1"}, state=0.0, start={"s": 0.0}, depends_on={"s": []}
)


@pytest.mark.parametrize("is_declared", [False, True])
@pytest.mark.parametrize(
    "options",
    [
        {},
        {"order": 0},
        {"order": 2},
        {"scheme": "gauss-seidel"},
        {"scheme": "jacobi", "extrapolation": 1},
        {"adaptive": True},
    ],
    ids=str,
)
@pytest.mark.parametrize("at", [0.5, 0.53])
def test_what_follows_a_jump_at_once_jumps_for_those_behind_it(at, options, is_declared):
    with Master(
        {"law": Function(lambda u: u, {"u": "1"}, {"y": "1"}), "integral": INTEGRAL},
        [("law.y", "integral.v")],
        inputs={"law.u": lambda t: float(t >= at)},
        jumps=[at] if is_declared else [],
        outputs=["integral.s"],
        step=0.1,
        **options,
    ) as master:
        result = master.run(1.0)
    assert result["integral.s"].values[-1] == pytest.approx(1.0 - at, abs=1e-9)


def by_ends(u, state, step):
    return state + u * step, state + u * step


def by_both_ends(u, before, state, step):
    total = state + (before["u"] + u) / 2 * step
    return total, total


def by_time(u, time, state):
    total = state[1] + u * (time - state[0])
    return total, (time, total)


@pytest.mark.parametrize("is_declared", [False, True])
@pytest.mark.parametrize(
    "options",
    [{}, {"scheme": "jacobi", "extrapolation": 1}, {"adaptive": True, "least_step": 1e-9}],
    ids=str,
)
@pytest.mark.parametrize(
    ("law", "first"), [(by_ends, 0.0), (by_both_ends, 0.0), (by_time, (0.0, 0.0))]
)
def test_memories_that_follow_inputs_count_jumps_from_then_on(law, first, options, is_declared):
    law = Function(law, {"u": "1"}, {"y": "1"}, state=first, start={"y": 0.0})
    same = Function(lambda u: u, {"u": "1"}, {"y": "1"})
    with Master(
        {"law": law, "same": same},
        [("law.y", "same.u")],
        inputs={"law.u": lambda t: 1.0 if t < 0.3 else float(t >= 0.5)},
        jumps=[0.3, 0.5] if is_declared else [],
        step=0.1,
        **options,
    ) as master:
        result = master.run(1.0)
    times = result.time.values
    exact = np.minimum(times, 0.3) + np.maximum(times - 0.5, 0.0)
    assert result["law.y"].values == pytest.approx(exact, abs=1e-9)


def test_what_cannot_bear_a_step_of_zero_length_goes_on_as_before_a_jump():
    def slope(u, state, step):
        return {"y": (u - state) / step, "all": state}, u

    law = Function(
        slope, {"u": "1"}, {"y": "1", "all": "1"}, state=0.0, start={"y": 0.0, "all": 0.0}
    )
    with Master(
        {"law": law}, inputs={"law.u": lambda t: float(t >= 0.5)}, outputs=["law.y"], step=0.1
    ) as master:
        result = master.run(1.0)
    expected = np.zeros(11)
    expected[6] = 10.0
    assert result["law.y"].values == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("has_state", [False, True])
def test_sampled_functions_sample_what_an_input_is_just_after_a_jump(has_state):
    def counted(u, state):
        return u, state + 1

    memory = {"state": 0} if has_state else {}
    law = counted if has_state else lambda u: u
    held = Function(law, {"u": "1"}, {"y": "1"}, sampled=True, **memory)
    with Master(
        {"held": held, "integral": INTEGRAL},
        [("held.y", "integral.v")],
        inputs={"held.u": lambda t: float(t >= 0.5)},
        outputs=["integral.s"],
        step=0.1,
    ) as master:
        assert master.run(1.0)["integral.s"].values[-1] == pytest.approx(0.5, rel=1e-12)


def test_units_with_steps_of_one_length_get_the_mean_and_it_is_said_once(tmp_path):
    """x' = u counts what comes in; u jumps at 0.53 and 0.77 s, within steps of 0.1 s."""
    unit = make(tmp_path, "count", [0.0], [1.0], [1.0], x=[0.0], variable=False)
    function = lambda t: 2.0 if 0.53 < t < 0.77 else 1.0  # noqa: E731
    with pytest.warns(UserWarning, match="u jumps at 0.53 s, within a step") as told:
        study = Study(unit, {}, inputs={"u": function}, outputs=["y"], stop=1.0, step=0.1)
    assert len(told) == 1
    assert study.run(1)["y"].item() == pytest.approx(1.24, rel=1e-7)
    with Master({"a": unit}, inputs={"a.u": function}, outputs=["a.y"], step=0.1) as master:
        with pytest.warns(MasterWarning, match="a.u jumps at 0.53 s, within a step") as told:
            result = master.run(1.0)
    assert len(told) == 1
    assert result["a.y"].values[-1] == pytest.approx(1.24, rel=1e-7)
    assert "jumps at 0.53" in result.attrs["notes"]


@pytest.mark.parametrize("interpolates", [True, False])
def test_units_with_steps_of_one_length_get_all_that_tables_bring(tmp_path, interpolates):
    """x' = u counts what comes in; tables jump, bend and have pulses within steps of 1 s."""
    unit = make(
        tmp_path, "count", [0.0], [1.0], [1.0], x=[0.0], variable=False, interpolates=interpolates
    )
    tables = {
        0.7: (Table([0.0, 0.7, 0.7, 10.0], [0.0, 0.0, 1.0, 1.0]), 3.3),
        0.3: (Table([0.0, 0.3, 0.3, 0.45, 0.45, 4.0], [0.0, 0.0, 2.0, 2.0, 0.0, 0.0]), 0.3),
        1.2: (Table([0.0, 1.2, 4.0], [0.0, 2.4, 2.4]), 1.2 * 1.2 + 2.8 * 2.4),
        2.6: (Table([0.0, 2.6, 2.8], [1.0, 5.0, 2.0], hold=True), 2.6 + 0.2 * 5.0 + 1.2 * 2.0),
    }
    for time, (table, expected) in tables.items():
        words = f"u bends or jumps at {time:g} s, within a step"
        with pytest.warns(UserWarning, match=words) as told:
            study = Study(unit, {}, inputs={"u": table}, outputs=["y"], stop=4.0, step=1.0)
        assert len(told) == 1
        assert study.run(1)["y"].item() == pytest.approx(expected, rel=1e-12)


def test_tables_that_are_straight_within_steps_are_followed_without_a_word():
    straight = Table([0.0, 0.5, 1.0, 1.5, 3.0], [0.0, 1.0, 2.0, 1.5, 0.0])
    line = timeline(3.0, 1.0, {"u": straight}, False, {})
    assert line.notes == ()
    assert line.courses["u"].begins.ravel() == pytest.approx([0.0, 2.0, 1.0])
    assert line.courses["u"].ends.ravel() == pytest.approx([2.0, 1.0, 0.0])


@pytest.mark.parametrize("cut", [True, False])
def test_tables_jump_where_steps_begin_but_for_rounding(cut):
    assert 3 * 0.3 < 0.9
    jump = Table([0.0, 0.9, 0.9, 5.0], [0.0, 0.0, 1.0, 1.0])
    line = timeline(1.8, 0.3, {"u": jump}, cut, {})
    for part in ("begins", "middles", "ends"):
        assert getattr(line.courses["u"], part).ravel().tolist() == [0, 0, 0, 1, 1, 1]


def test_counts_hold_what_they_are_as_steps_of_one_length_begin():
    table = Table([0.0, 0.7, 2.0], [0.0, 1.0, 3.0])
    line = timeline(2.0, 1.0, {"u": table}, False, {}, ["u"])
    assert line.courses["u"].begins.ravel().tolist() == [0.0, 1.0]
    assert line.courses["u"].middles.ravel().tolist() == [0.0, 1.0]
    assert "at 0.7 s, within a step" in line.notes[0] and "before is held" in line.notes[0]


def test_means_of_tables_are_those_of_all_elements():
    table = Table([0.0, 0.7, 0.7, 2.0], [[0.0, 1.0], [0.0, 1.0], [1.0, 5.0], [1.0, 5.0]])
    line = timeline(2.0, 1.0, {"u": table}, False, {})
    for part in ("begins", "middles", "ends"):
        rows = getattr(line.courses["u"], part)
        assert rows == pytest.approx(np.array([[0.3, 2.2], [1.0, 5.0]]), rel=1e-12)


def test_smooth_functions_do_not_jump_and_steep_ones_are_told(slab):
    """Neither curved ones, nor kinks, nor square roots; a ramp of a hundredth of a step is told."""
    smooth = [
        np.sin,
        np.exp,
        lambda t: abs(t - 0.5123),
        lambda t: np.interp(t, [0.0, 0.111, 0.222, 1.0], [1.0, 5.0, -2.0, 0.0]),
        lambda t: 300.0 + 1e-3 * np.sin(9 * t),
        lambda t: np.full((2, 3), t**3),
    ]
    for function in smooth:
        watched = Watched("u", function)
        watched.look(0.0, 1.0)
        for k in range(10):
            begin, end = k / 10, (k + 1) / 10
            watched.look(begin, end)
            assert watched.jumps(begin, end) == []
            assert np.array_equal(watched.before(end, 0.1), watched(end))
            assert np.array_equal(watched.after(begin, 0.1), watched(begin))
    ramp = lambda t: float(np.clip((t - 0.53) / 1e-3, 0.0, 1.0))  # noqa: E731
    with pytest.warns(UserWarning, match="changes within the step from 0.5 to 0.6 s"):
        Study(slab, {}, inputs={"plate.top.flux": ramp}, outputs=["plate.heat_in"])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        Study(slab, {}, inputs={"plate.top.flux": np.sin}, outputs=["plate.heat_in"])
    with pytest.raises(ValueError, match="input u is not finite at 0.25 s"):
        Watched("u", lambda t: np.nan if t == 0.25 else 1.0).look(0.0, 1.0)


def test_all_elements_are_watched_and_found_where_they_jump():
    def function(t):
        return [t, 1.0 if t < 0.3141 else 2.0, 5.0 if t < 0.7182 else 4.0]

    watched = Watched("u", function)
    watched.look(0.0, 1.0)
    assert watched.jumps(0.0, 1.0) == pytest.approx([0.3141, 0.7182], abs=1e-11)
    mean = [0.5, 0.3141 + 2 * 0.6859, 5 * 0.7182 + 4 * 0.2818]
    assert watched.mean(0.0, 1.0) == pytest.approx(mean, rel=1e-8)


@pytest.mark.parametrize("step", [0.01, 0.5])
@pytest.mark.parametrize(("order", "least"), [(0, 500), (1, 30), (2, 5)])
def test_adaptive_steps_follow_functions_of_time(tmp_path, order, least, step):
    """x' = sin πt, without any connection: 2/π after 1 s."""
    unit = make(tmp_path, "count", [0.0], [1.0], [1.0], x=[0.0])
    options = {"adaptive": True, "tolerance": 1e-3, "step": step, "order": order}
    inputs = {"a.u": lambda t: np.sin(np.pi * t)}
    with Master({"a": unit}, inputs=inputs, outputs=["a.y"], **options) as master:
        result = master.run(1.0)
    assert result["a.y"].values[-1] == pytest.approx(2 / np.pi, abs=1e-3)
    assert least < result.attrs["steps"] < 10 * least
    assert master.notes == []


def test_adaptive_steps_take_no_rounding_for_a_change(tmp_path):
    unit = make(tmp_path, "count", [0.0], [1.0], [1.0], x=[0.0])
    inputs = {"a.u": lambda t: 300.0 * (1.0 + 1e-16 * np.sin(1e3 * t)), "b.u": lambda _: 1.0}
    options = {"adaptive": True, "tolerance": 1e-6, "step": 0.1, "outputs": ["a.y"]}
    with Master({"a": unit, "b": unit}, inputs=inputs, **options) as master:
        result = master.run(1.0)
    assert result["a.y"].values[-1] == pytest.approx(300.0, rel=1e-12)
    assert result.attrs["steps"] < 10


@pytest.mark.parametrize(
    ("order", "function", "path"),
    [
        (0, lambda t: t, "constant"),
        (1, lambda t: t * (1 - t), "straight line"),
        (2, lambda t: t * (1 - t) * (1 - 2 * t), "parabola"),
        (1, lambda t: t, None),
        (2, lambda t: t * (1 - t), None),
    ],
)
def test_functions_that_leave_the_path_of_their_input_are_told(tmp_path, order, function, path):
    """One step over all that the function does; of the parabola the chord brings in nothing."""
    unit = make(tmp_path, "count", [0.0], [1.0], [1.0], x=[0.0])
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        with Master({"a": unit}, inputs={"a.u": function}, step=1.0, order=order) as master:
            master.run(1.0)
    steep = [str(each.message) for each in told if "changes within the step" in str(each.message)]
    assert len(steep) == (path is not None)
    assert path is None or f"from 0 s as no {path} does" in steep[0]


def test_ranges_of_functions_are_those_of_the_whole_run(tmp_path):
    """The chord of cos t over a first short step misses a quarter of its change, not of all."""
    unit = make(tmp_path, "count", [0.0], [1.0], [1.0], x=[0.0])
    with Master({"a": unit}, inputs={"a.u": np.cos}, step=0.01) as master:
        master.run(1.0)
    assert master.notes == []


@pytest.mark.parametrize("jumps", [[], [0.35]], ids=["found", "declared"])
@pytest.mark.parametrize(
    ("options", "size"),
    [({"step": 0.1, "graded": Graded(0.5, 2.0)}, 0.005), ({"step": 0.01, "adaptive": True}, 0.01)],
    ids=["graded", "adaptive"],
)
def test_the_first_step_after_a_jump_is_as_short_as_that_after_the_start(
    tmp_path, options, size, jumps
):
    """It is the same for a jump that is declared and for one that is found before its step."""
    unit = make(tmp_path, "count", [0.0], [1.0], [1.0], x=[0.0])
    inputs = {"a.u": lambda t: 1.0 if t < 0.35 else 2.0}
    with Master({"a": unit}, inputs=inputs, jumps=jumps, outputs=["a.y"], **options) as master:
        time = master.run(1.0).time.values
    k = np.flatnonzero(np.isclose(time, 0.35, atol=1e-9)).item()
    assert time[k + 1] - time[k] == pytest.approx(size, rel=1e-6)
    if "graded" in options:
        assert np.diff(time)[k : k + 4] == pytest.approx(np.diff(time)[:4], rel=1e-6)
    else:
        assert time[k] - time[k - 1] > 5 * size  # steps had grown
