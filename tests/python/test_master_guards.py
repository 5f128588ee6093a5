"""What a master must not get wrong in silence: scales, dead units, times and names."""

import re

import numpy as np
import pytest
from impinge import Connection, Master, Unit
from impinge.master import Bond, Graded, MasterError, MasterWarning
from impinge.reporting.coupled import coupled
from linear_unit import make
from python_unit import BODY, CUBE, LATE, LINK, STAGES, python_unit


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("guards")


STIFF = [("a.T", "s.x1"), ("b.T", "s.x2"), ("s.f1", "a.q"), ("s.f2", "b.q")]


def backward_euler(conductance, step, count):
    """C₁ T₁' = G (T₂ − T₁), C₂ T₂' = G (T₁ − T₂) with 10 and 20 J/K from 400 and 300 K."""
    rates = conductance * np.array([[-0.1, 0.1], [0.05, -0.05]])
    states = [np.array([400.0, 300.0])]
    for _ in range(count):
        states.append(np.linalg.solve(np.eye(2) - step * rates, states[-1]))
    return np.array(states)


@pytest.mark.parametrize("scaled", [False, True])
@pytest.mark.parametrize("conductance", [4e2, 4e4, 4e6])
def test_guesses_that_are_thrown_away_leave_no_scale_behind(folder, conductance, scaled):
    """Joined so stiffly that first guesses are off by up to 1e8 K."""
    body = python_unit(folder / "declared", "Body", BODY, declared=True)
    scales = {"T": 400.0, "f": 100 * conductance}
    links = [Connection(*pair, scale=scales[pair[0][2]] if scaled else None) for pair in STIFF]
    link = python_unit(folder, "Link", LINK)
    parameters = {
        "a": {"T0": 400.0, "cap": 10.0},
        "b": {"T0": 300.0, "cap": 20.0},
        "s": {"k": conductance},
    }
    options = {"step": 0.2, "order": 0, "parameters": parameters}
    with Master({"a": body, "b": body, "s": link}, links, **options) as master:
        result = master.run(2.0)
    wanted = backward_euler(conductance, 0.2, 10)
    for i, name in enumerate("ab"):
        assert np.abs(result[f"{name}.T"].values - wanted[:, i]).max() < 1e-3
    heat = 10 * result["a.T"] + 20 * result["b.T"]
    assert np.abs(heat - 10000.0).max() < 0.05
    assert result.attrs["unconverged"] == 0


NAN, INF = float("nan"), float("inf")


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        *[({"step": step}, "step is ") for step in (-0.1, 0.0, 0, NAN, INF, "1", True)],
        *[({"tolerance": each}, "tolerance is ") for each in (-1e-3, 0.0, NAN, INF)],
        *[
            ({"largest_step": each, "adaptive": True}, "largest_step is ")
            for each in (0.0, -1, NAN)
        ],
        ({"least_step": 0.0, "adaptive": True}, "least_step is 0.0 s; it must be a number above 0"),
        ({"least_step": 1.0, "largest_step": 0.5}, "least_step (1.0 s) is above largest_step"),
        ({"relaxation": 0.0}, "relaxation is 0.0; it must be a number above 0"),
        ({"jumps": [0.1, NAN]}, "jumps: nan is no time in s"),
        ({"jumps": [INF]}, "jumps: inf is no time in s"),
        ({"jumps": [-1.0]}, "jumps: -1.0 s is before the start at 0.0 s"),
        (
            {"inputs": {"b.k": 1.0}},
            "b.k is no input, but parameter; parameters={unit: {name: value}}",
        ),
        ({"inputs": {"b.f1": 1.0}}, "inputs: b.f1 is no input, but output"),
        ({"parameters": {"c": {"k": 1.0}}}, "parameters: `c` names none of the units a, b"),
    ],
)
def test_lengths_times_and_names_that_make_no_sense_are_refused(folder, wrong, told):
    """Some of them once made runs that never came to an end."""
    link = python_unit(folder, "Link", LINK)
    store = make(folder, "store", [-1.0], [1.0], [1.0])
    with pytest.raises(MasterError) as refused:
        with Master({"a": store, "b": link}, **{"step": 0.1, **wrong}) as master:
            master.run(0.2)
    assert told in str(refused.value)


def test_runs_stop_at_times_to_come(folder):
    store = make(folder, "store", [-1.0], [1.0], [1.0])
    with Master({"a": store}, step=0.1, outputs=["a.y"]) as master:
        for stop in (NAN, INF, "1", None):
            with pytest.raises(MasterError, match="is no time in s to stop at"):
                master.run(stop)
        master.run(0.3)
        with pytest.raises(MasterError, match="0.2 s is before 0.3 s, where the run stands"):
            master.run(0.2)
        assert len(master.run(0.3).time) == 4
    with pytest.raises(MasterError, match="must be above 0"):
        Master({"a": store}, step=0.1, graded=Graded(NAN)).run(1.0)
    with Unit(store, start_time=1e6) as unit:
        for adaptive in (False, True):
            with pytest.raises(MasterError, match="is lost in rounding at 1e"):
                Master({"a": unit}, step=1e-12, adaptive=adaptive).run(1e6 + 1e-4)


@pytest.mark.parametrize("start", [-1.0, -3.7, -1e4, 2.5])
def test_steps_of_one_length_go_on_from_any_start(folder, start):
    store = make(folder, "store", [-1.0], [1.0], [1.0])
    with Unit(store, start_time=start) as unit:
        with Master({"a": unit}, step=0.1, outputs=["a.y"]) as master:
            time = master.run(start + 2.0).time.values
    assert time == pytest.approx(start + 0.1 * np.arange(21), rel=1e-12, abs=1e-12)


def test_units_with_steps_of_one_length_get_no_others(folder):
    equal = make(folder, "equal", [-1.0], [1.0], [1.0], variable=False)
    allowed = "a take steps of one length alone, 0.1 s; allowed: "
    with pytest.raises(MasterError, match=f"jumps: 0.53 s .* {allowed}0.5 s or 0.6 s"):
        Master({"a": equal}, step=0.1, jumps=[0.2, 0.53])
    with Master({"a": equal}, step=0.1, jumps=[0.3], outputs=["a.y"]) as master:
        with pytest.raises(MasterError, match=f"run: 0.25 s .* {allowed}0.2 s or 0.3 s"):
            master.run(0.25)
        master.run(0.4)
        with pytest.raises(MasterError, match=f"run: 0.95 s .* {allowed}0.9 s or 1 s"):
            master.run(0.95)
        sizes = np.diff(master.run(1.0).time)
    assert sizes == pytest.approx(np.full(10, 0.1), rel=1e-9)


def test_one_unit_has_one_name_and_parameters_are_of_units_to_be_made(folder):
    link = python_unit(folder, "Link", LINK)
    with Unit(link) as unit:
        with pytest.raises(MasterError, match="a and b are one and the same unit"):
            Master({"a": unit, "b": unit}, step=0.1)
        with pytest.raises(MasterError, match="a is a Unit that has been initialised already"):
            Master({"a": unit}, step=0.1, parameters={"a": {"k": 2.0}})
        assert unit.is_open
    with Master({"a": link}, step=0.1, parameters={"a": {"k": 2.0}}) as master:
        assert master.units["a"]["k"] == 2.0


def bodies(folder, body, **options):
    link = python_unit(folder, "Link", LINK)
    parameters = {
        "a": {"T0": 400.0, "cap": 10.0},
        "b": {"T0": 300.0, "cap": 20.0},
        "s": {"k": 4.0},
    }
    units = {"a": body, "b": body, "s": link}
    with Master(units, STIFF, parameters=parameters, **options) as master:
        result = master.run(4.0)
    exact = 10000 / 30 + 200 / 3 * np.exp(-0.6 * result.time.values)
    heat = 10 * result["a.T"] + 20 * result["b.T"]
    assert np.abs(heat - 10000.0).max() < 0.02
    return float(np.abs(result["a.T"].values - exact).max()), result


def test_states_whose_dependencies_are_not_declared_are_of_second_order(folder):
    """As those that are declared: what responds to a short step in proportion is a state."""
    open_one = python_unit(folder, "Body", BODY)
    declared = python_unit(folder / "declared", "Body", BODY, declared=True)
    errors = []
    for step in (0.4, 0.2, 0.1):
        error, result = bodies(folder, open_one, step=step)
        errors.append(error)
        assert error == pytest.approx(bodies(folder, declared, step=step)[0], rel=1e-4)
        assert result.attrs["notes"] == ""
    assert np.log2(errors[1] / errors[2]) == pytest.approx(2.0, abs=0.1), errors
    for tolerance in (1e-3, 1e-4, 1e-5):
        error, _ = bodies(folder, open_one, step=0.2, adaptive=True, tolerance=tolerance)
        assert error < tolerance * 400.0


def test_what_cannot_be_told_from_a_state_is_noted(folder):
    stuck = python_unit(folder / "stuck", "Body", BODY, states=False)
    with pytest.warns(MasterWarning, match="no iterations"):
        error, result = bodies(folder, stuck, step=0.1)
    assert (
        "a cannot go back, so that its outputs are taken as computed in its steps"
        in (result.attrs["notes"])
    )


def test_each_note_of_a_master_is_a_warning_of_its_own_once(folder):
    """In the result, too, each has a line, and in its report a place."""
    stuck = python_unit(folder / "stuck", "Body", BODY, states=False)
    with pytest.warns(MasterWarning) as told:
        _, result = bodies(folder, stuck, step=0.1)
    notes = [str(each.message) for each in told]
    assert len(notes) > 1 and len(set(notes)) == len(notes)
    assert result.attrs["warnings"].splitlines() == notes
    assert result.attrs["notes"] == "; ".join(notes)
    assert [warning["message"] for warning in coupled(result)["warnings"]] == notes
    older = result.copy()
    del older.attrs["warnings"]
    assert [warning["message"] for warning in coupled(older)["warnings"]] == ["; ".join(notes)]
    assert re.findall(r"^  note +(.*)$", repr(result.impinge), re.M) == notes


def test_what_is_computed_in_steps_is_still_known_for_that(folder):
    """y = u/2 + 1 of the input at the end of a step, in a ring with u = y: 2 from the first step
    on."""
    late = python_unit(folder, "Late", LATE)
    same = make(folder, "same", d=1.0)
    with Master({"l": late, "g": same}, [("l.y", "g.u"), ("g.y", "l.u")], step=0.1) as master:
        result = master.run(1.0)
        assert master.participants["l"].held == "end" and master.notes == []
    assert result["l.y"].values[1:] == pytest.approx(np.full(10, 2.0), rel=1e-4)


@pytest.mark.parametrize("is_connected", [False, True])
@pytest.mark.parametrize("is_late", [False, True])
def test_outputs_that_follow_driven_inputs_belong_to_the_ends_of_steps(
    folder, is_late, is_connected
):
    """y = u/2 + 1 of an input 2t, at once or computed in steps, for the record and for others."""
    if is_late:
        unit = python_unit(folder, "Late", LATE)
    else:
        unit = make(folder, "half", d=0.5, e=1.0, interpolates=False)
    units, connections = {"h": unit}, []
    if is_connected:
        units["count"] = make(folder, "sum", [0.0], [1.0], [1.0], x=[0.0])
        connections = [("h.y", "count.u")]
    with Master(
        units,
        connections,
        inputs={"h.u": lambda time: 2.0 * time},
        outputs=["h.y", "count.y"] if is_connected else ["h.y"],
        step=0.1,
    ) as master:
        result = master.run(1.0)
        assert master.participants["h"].held == ("end" if is_late else "mean")
    assert result.attrs["held_inputs"] == "h"
    assert result["h.y"].values[1:] == pytest.approx(1.0 + result.time.values[1:], rel=1e-12)
    if is_connected:
        # A unit that follows its inputs late has its first answer only after the first step.
        expected = 1.5 + (0.5 * 0.1**2 if is_late else 0.0)
        assert result["count.y"].values[-1] == pytest.approx(expected, rel=1e-9)


def test_states_under_driven_inputs_follow_their_means(folder):
    """T' = q/C under a ramp, of a unit that declares nothing: exact, and known for a state."""
    body = python_unit(folder, "Body", BODY)
    with Master(
        {"b": body}, inputs={"b.q": lambda time: 6.0 * time}, outputs=["b.T"], step=0.1
    ) as master:
        result = master.run(1.0)
        assert master.notes == []
    assert result["b.T"].values == pytest.approx(300.0 + 0.3 * result.time.values**2, rel=1e-12)


def test_units_that_cannot_be_asked_are_not_asked_for_constants(folder):
    """T' = q/C of a unit that cannot go back, and y = u/2 + 1, of constants."""
    body = python_unit(folder / "stuck", "Body", BODY, states=False)
    half = make(folder, "half", d=0.5, e=1.0, interpolates=False)
    store = make(folder, "sum", [0.0], [1.0], [1.0], x=[0.0])
    same = make(folder, "same", d=1.0, interpolates=False)
    with Master(
        {"b": body, "h": half, "same": same, "sum": store},
        [("h.y", "same.u"), ("same.y", "sum.u")],
        inputs={"b.q": 6.0, "h.u": 4.0},
        outputs=["b.T", "sum.y"],
        step=0.1,
    ) as master:
        result = master.run(1.0)
        assert master.notes == [] and master.participants["b"].held == "mean"
    assert result["b.T"].values == pytest.approx(300.0 + 0.6 * result.time.values, rel=1e-12)
    assert result["sum.y"].values == pytest.approx(3.0 * result.time.values, abs=1e-12)


def test_what_is_held_at_ends_of_steps_of_one_length_gets_means_of_jumps(folder):
    """x' = u counts u = 1 from 0.53 s on: 0.47, though y follows u, too."""
    unit = make(
        folder, "mixed", [0.0], [1.0], [1.0], d=1.0, x=[0.0], variable=False, interpolates=False
    )
    with Master(
        {"m": unit}, inputs={"m.u": lambda time: float(time >= 0.53)}, outputs=["m.y"], step=0.1
    ) as master:
        master.run(0.1)
        master.participants["m"].held = "end"  # as of a unit that could not be asked
        with pytest.warns(MasterWarning, match="its mean over the step is held"):
            result = master.run(1.0)
    assert result["m.y"].values[-1] == pytest.approx(0.47 + 1.0, rel=1e-12)


@pytest.mark.parametrize("order", [0, 1, 2])
def test_whole_numbers_that_jump_within_steps_of_one_length_stay_whole(folder, order):
    """y = 10 n of an n that is 3 until 0.17 s, then 7: held at 3 until 0.2 s."""
    unit = python_unit(folder / "fixed", "Stages", STAGES, variable=False)
    with Master(
        {"s": unit},
        inputs={"s.n": lambda time: 3 if time < 0.17 else 7},
        outputs=["s.y"],
        step=0.1,
        order=order,
    ) as master:
        with pytest.warns(MasterWarning, match="0.17 s, .* what it was before is held"):
            result = master.run(0.4)
    assert result["s.y"].values.tolist() == [0.0, 30.0, 30.0, 70.0, 70.0]


@pytest.mark.parametrize("acceleration", ["none", "aitken", "anderson", "iqn-ils"])
def test_whole_numbers_arrive_in_rings_that_iterate(folder, acceleration):
    """A unit that counts its steps for itself: each step heats by 10 W more, 0.5 W/K get lost."""
    stages = python_unit(folder, "Stages", STAGES)
    store = make(folder, "pot", [0.0], [1.0], [1.0])
    ring = [("p.y", "s.u"), ("s.y", "p.u"), ("s.count", "s.n")]
    options = {"step": 0.1, "order": 0, "acceleration": acceleration, "outputs": ["s.n"]}
    with Master({"p": store, "s": stages}, ring, **options) as master:
        result = master.run(1.0)
    assert result["s.n"].values.tolist() == list(range(1, 12))
    heat, wanted = 0.0, [0.0]
    for count in range(1, 11):  # T₁ = T₀ + H (10 n₀ − T₁/2)
        heat = (heat + 0.1 * 10.0 * count) / 1.05
        wanted.append(heat)
    assert result["p.y"].values == pytest.approx(wanted, rel=1e-5)


@pytest.mark.parametrize("scheme", ["jacobi", "gauss-seidel"])
@pytest.mark.parametrize("k", [20.0, 50.0, 200.0])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-3])
def test_algebraic_loops_end_at_what_was_checked(folder, scheme, k, tolerance):
    """x = 3 − k x³: what units are left with misses it by what the tolerance allows; one more turn
    would multiply that by the slope of −14 to −36."""
    cube = python_unit(folder, "Cube", CUBE)
    same = make(folder, "same", d=1.0)
    ring = [("c.f", "g.u"), ("g.y", "c.x")]
    options = {"tolerance": tolerance, "parameters": {"c": {"k": k}}, "outputs": ["c.x"]}
    with Master({"c": cube, "g": same}, ring, step=0.1, scheme=scheme, **options) as master:
        x = master.run(0.3)["c.x"].values
    (root,) = (each.real for each in np.roots([k, 0, 1, -3]) if abs(each.imag) < 1e-9)
    assert np.abs(3 - k * x**3 - x).max() <= 1.02 * tolerance * np.abs(x).max()
    assert x == pytest.approx(np.full(len(x), root), rel=tolerance)


def test_an_array_of_one_is_as_good_as_a_number(pack, folder):
    edits = {"count = [2, 3]": "count = [1, 1]"}
    law = make(folder, "law", d=-4e3, e=4e3 * 350.0)
    whole = [("plate.centre.temperature", "law.u"), ("law.y", "plate.patch.heat_flux")]
    units = {"plate": pack("tiles", edits), "law": law}
    with Master(units, whole, step=1e-5, outputs=["plate.block.heat_in"]) as master:
        result = master.run(1e-4)
    element = [whole[0], ("law.y", "plate.patch.heat_flux[1,1]")]
    with Master(units, element, step=1e-5, outputs=["plate.block.heat_in"]) as master:
        same = master.run(1e-4)
    assert result["plate.block.heat_in"].values[-1] > 1e-8
    assert np.array_equal(result["plate.block.heat_in"], same["plate.block.heat_in"])


def test_what_is_no_power_has_no_energy_to_balance(pack, folder):
    units = {
        "plate": pack("tiles", {"count = [2, 3]": "count = [1, 1]"}),
        "law": make(folder, "law", d=-4e3, e=4e3 * 350.0, y_unit="W/m2", u_unit="K"),
        "mass": make(folder, "mass", [[0.0]], [1.0], [1.0], u_unit="N", y_unit="m/s"),
        "spring": make(folder, "spring", [[0.0]], [-1.0], [3.0], u_unit="m/s", y_unit="N"),
    }
    links = [
        ("plate.centre.temperature", "law.u"),
        ("law.y", "plate.patch.heat_flux"),
        ("mass.y", "spring.u"),
        ("spring.y", "mass.u"),
    ]
    for energy, told in [
        ("plate.centre.temperature", "plate.centre.temperature is in K, and no power"),
        ("spring.y", "spring.y is in kg m s-2, and no power"),
        (("spring.y", "spring.y"), "spring.y times spring.y is in kg2 m2 s-4, and no power"),
        (("law.y", "mass.y"), "law.y times mass.y is in kg m s-4, and no power"),
        (Bond("law.y", total="plate.centre.temperature"), "is in K, not in J"),
    ]:
        with pytest.raises(MasterError) as refused:
            Master(units, links, step=1e-5, energy=[energy])
        assert told in str(refused.value)
    good = [
        "law.y",
        ("law.y", "plate.centre.temperature"),
        ("spring.y", "mass.y"),
        Bond("law.y", total="plate.block.heat_in"),
    ]
    with Master(units, links, step=1e-5, energy=good) as master:
        result = master.run(3e-5)
    assert result.attrs["energy_residual.law.y"] < 1e-6


def stores(folder, ratio):
    """Two bodies of 1 and `ratio` J/K and a conductance of 1 W/K between them, 1 K apart."""
    rate = 1.0 / ratio
    a = make(folder, "store", [0.0], [1.0], [1.0], x=[1.0])
    return {"a": a, "b": make(folder, "bath", [-rate], [rate], [1.0], d=-1.0, x=[0.0])}


PAIR = [("a.y", "b.u"), ("b.y", "a.u")]


@pytest.mark.parametrize("scheme", ["jacobi", "gauss-seidel", "iterate"])
@pytest.mark.parametrize("ratio", [0.1, 1.0, 10.0])
def test_steps_that_are_too_long_are_warned_of(folder, scheme, ratio):
    """From the length on at which temperatures at ends of steps are off by an eighth of their way;
    a step is named that is shorter."""

    def off(step):
        with Master(stores(folder, ratio), PAIR, scheme=scheme, step=step) as master:
            result = master.run(40 * step)
        share = ratio / (1 + ratio)
        exact = 1 - share * -np.expm1(-result.time.values / share)
        return float(np.abs(result["a.y"].values - exact).max() / share), master.notes

    for step in np.geomspace(0.01, 30.0, 12):
        error, notes = off(step)
        assert notes or error < 0.125, (step, error)
        if notes:
            (note,) = notes
            assert f"what is passed on over steps of {step:.6g} s is off by" in note
            named = float(note.split("; steps of ")[1].split(" s")[0])
            assert named < step
    calm, notes = off(0.02 * min(ratio, 1.0))
    assert calm < 0.05 and notes == []


def test_steps_that_are_not_stable_are_told_to_be(folder):
    """|λ| = |e^(−GH/C₂) − GH/C₁| = 1.63 at GH = 2."""
    with pytest.warns(
        MasterWarning, match="change 1.[0-9]* times as much in every step: this is not"
    ):
        with Master(stores(folder, 1.0), PAIR, scheme="jacobi", step=2.0) as master:
            master.run(40.0)


def swing(folder, step, known=True, **options):
    """A mass of 1 kg on a spring of 1 N/m, for two turns; by how much its energy grew, and what
    was told."""
    there, back = ({"u_unit": "N", "y_unit": "m/s"}, {"u_unit": "m/s", "y_unit": "N"})
    mass = make(folder, f"mass{known}", [[0.0]], [1.0], [1.0], x=[1.0], **(there if known else {}))
    spring = make(folder, f"spring{known}", [[0.0]], [-1.0], [1.0], **(back if known else {}))
    ring = [("m.y", "s.u"), ("s.y", "m.u")]
    with Master({"m": mass, "s": spring}, ring, step=step, **options) as master:
        result = master.run(4 * np.pi)
    energy = result["m.y"].values[-1] ** 2 + result["s.y"].values[-1] ** 2
    return energy - 1.0, result.attrs, master.notes


def test_what_swings_and_gains_energy_between_units_is_told_of(folder):
    """Held over steps H, force and velocity bring 1 + (ωH)² of the energy in each of them, though
    their paths are right to 2 %."""
    with pytest.warns(MasterWarning, match="m.y\\*s.y: .* of what swings between the units"):
        gain, told, (note,) = swing(folder, 0.1, scheme="jacobi")
    assert gain == pytest.approx(1.01**126 - 1.0, rel=0.02)
    assert told["path_error"] < 0.03
    assert told["energy_error"] == pytest.approx(gain / (1.0 + gain), rel=0.2)
    named = float(note.split("; steps of ")[1].split(" s")[0])
    gain, told, notes = swing(folder, named, scheme="jacobi")
    assert abs(gain) < 0.2 and told["energy_error"] < 0.15, (named, gain, notes)
    for options in ({}, {"order": 2}, {"scheme": "jacobi", "extrapolation": 1}):
        gain, told, notes = swing(folder, 0.1, **options)
        assert abs(gain) < 0.03 and told["energy_error"] < 0.03 and notes == []
    # Of what has no units of measurement it is not known whether it is a power.
    assert swing(folder, 0.1, known=False, scheme="jacobi")[1]["energy_error"] == 0.0


def test_too_few_steps_to_tell_are_told_of(folder):
    """Two steps, after which a temperature is wrong by more than its way."""
    with pytest.warns(MasterWarning, match="2 steps cannot tell whether .* changed by"):
        with Master(stores(folder, 1.0), PAIR, scheme="jacobi", step=2.0) as master:
            result = master.run(4.0)
    exact = 0.5 + 0.5 * np.exp(-2.0 * result.time.values)
    assert np.abs(result["a.y"].values - exact).max() > 0.5
    assert np.isnan(result.attrs["path_error"])
    # Of what goes on nearly as it did, two and three can, and what hardly changes needs no more.
    for steps in (2, 3):
        with Master(stores(folder, 1.0), PAIR, scheme="jacobi", step=0.01) as master:
            result = master.run(0.01 * steps)
        exact = 0.5 + 0.5 * np.exp(-2.0 * result.time.values)
        assert np.abs(result["a.y"].values - exact).max() < 5e-3 * (1.0 - exact[-1]) / 0.02
        assert master.notes == []
    warm = make(folder, "warm", [0.0], [1.0], [1.0], x=[301.0])
    cool = make(folder, "cool", [-1.0], [1.0], [1.0], x=[300.0], u=300.0)
    with Master({"a": warm, "b": cool}, PAIR, scheme="gauss-seidel", step=1e-3) as master:
        master.run(2e-3)
    assert master.notes == []


def test_rings_at_rest_and_what_goes_one_way_are_not_warned_of(folder):
    a = make(folder, "still", [0.0], [1.0], [1.0], x=[300.0])
    b = make(folder, "calm", [-1.0], [1.0], [1.0], d=-1.0, x=[300.0], u=300.0)
    with Master({"a": a, "b": b}, PAIR, scheme="jacobi", step=2.0) as master:
        master.run(40.0)
    assert master.notes == []
    gauge = make(folder, "gauge", [-1.0], [1.0], [1.0])
    source = make(folder, "source", [-1.0], [0.0], [1.0], x=[300.0])
    with Master({"s": source, "g": gauge}, [("s.y", "g.u")], scheme="jacobi", step=2.0) as master:
        master.run(40.0)
    assert master.notes == []


def test_values_that_are_not_finite_end_a_run(folder):
    with Master(stores(folder, 10.0), PAIR, scheme="jacobi", step=1e3) as master:
        with pytest.raises(MasterError, match="are not finite"):
            master.run(3e5)


def test_errors_that_follow_a_jump_are_told_of_with_graded_steps(folder):
    """A change of which each step leaves a half has most of its error in the first ones."""
    with pytest.warns(MasterWarning, match="right after the start or a jump.*Graded\\(0.3, 4\\)"):
        with Master(stores(folder, 1.0), PAIR, scheme="jacobi", step=0.3) as master:
            master.run(20.0)


def test_errors_of_input_functions_name_the_input(folder):
    def broken(time):
        return 1.0 / (0.3 - time) if time < 0.25 else {}["missing"]

    unit = make(folder, "a", d=1.0)
    with Master({"a": unit}, inputs={"a.u": broken}, outputs=["a.y"], step=0.1) as master:
        with pytest.raises(KeyError) as failed:
            master.run(1.0)
        assert any("input `a.u` at 0." in note for note in failed.value.__notes__)
        assert master.record["a.y"].shape == (len(master.record.time),)
