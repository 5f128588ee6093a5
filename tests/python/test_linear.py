"""Linear maps, realisations, sensitivities over a step, and plans."""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from impinge import ImpingeError, Unit, UnitError, linear_map, step_sensitivity
from impinge.linear import LinearMap, NotLinear, NotRealised, plan
from impinge.linear.command import main
from impinge.study import Sobol
from impinge.study.distributions import Uniform
from linear_unit import make
from slab import AREA, HEAT_CAPACITY, SCENE, top_temperature

ROOT = Path(__file__).resolve().parents[2]
BED = ROOT / "examples/heated_bed/scene.toml"
INPUTS = ["heater.heat_flux", "fan.heat_flux", "bed.top.ambient"]
OUTPUTS = ["thermocouple.temperature", "rim.temperature", "bed.heat_stored"]

PRESSED = """
[[load]]
name = "press"
on = "plate.top"
footprint = { tiles = { count = [2, 1], size = [4e-3, 4e-3] } }
carries = ["pressure", "heat_flux"]
"""
ELASTIC = "conductivity = 10.0, young = 100e9, poisson = 0.25, expansion = 1e-5 }"
RADIATING = """
[body.plate.faces.bottom]
radiation = { emissivity = 0.9, ambient = 300.0 }

[fidelity]
tolerance = 1e-4
"""


@pytest.fixture(scope="module")
def scenes(tmp_path_factory):
    """The slab: as it is, under pressure between rollers, radiating."""
    folder = tmp_path_factory.mktemp("slab")
    pressed = SCENE.replace("conductivity = 10.0 }", ELASTIC) + PRESSED
    pressed = pressed.replace('gives = ["temperature"]', 'gives = ["temperature", "stress"]')
    pressed = pressed.replace(
        "top = { flux = 0.0 }",
        "top = { flux = 0.0 }\nbottom = { roller = true }\nsides = { roller = true }",
    )
    texts = {"plain": SCENE, "pressed": pressed, "radiating": SCENE + RADIATING}
    for name, text in texts.items():
        (folder / f"{name}.toml").write_text(text)
    return {name: folder / f"{name}.toml" for name in texts}


@pytest.fixture(scope="module")
def bed():
    """The heated bed, warmed unevenly, and its map over eight steps."""
    with Unit(BED) as unit:
        unit["fan.heat_flux"] = -3e3
        unit["heater.heat_flux"] = 8e3
        unit.step(60.0)
        yield unit, linear_map(unit, INPUTS, OUTPUTS, 10.0, 16, ramps=True)


def test_responses_are_those_of_closed_forms(scenes):
    """Heat grows by A H for each step under q = 1; the face's temperature comes to
    H / (ρ c L) and, once the start has died out, keeps L / (3 k) above what is stored."""
    with Unit(scenes["plain"]) as unit:
        found = linear_map(unit, ["plate.top.flux"], ["plate.heat_in", "top.temperature"], 0.5, 8)
    assert found.held[:, 0, 0] == pytest.approx(0.5 * AREA, rel=1e-11)
    risen = np.array([top_temperature(1e3, t) for t in found.times[1:]]) - 300.0
    assert found.step_response[:, 1, 0] * 1e3 == pytest.approx(risen, rel=1e-4)
    assert found.held[-1, 1, 0] == pytest.approx(0.5 / (HEAT_CAPACITY * 1e-3), rel=1e-6)
    assert found.defect <= 1e-9
    assert found.units == {"plate.top.flux": "W/m2", "plate.heat_in": "J", "top.temperature": "K"}


def test_predictions_are_runs_of_the_unit(bed):
    unit, found = bed
    random = np.random.default_rng(5)
    low, high = np.array([0.0, -5e3, 280.0]), np.array([2e4, 5e3, 320.0])
    begins = random.uniform(low, high, (16, 3))
    ends = random.uniform(low, high, (16, 3))
    before = unit.get(OUTPUTS)
    for last in (None, ends):
        with unit.state() as start:
            rows = [unit.get(OUTPUTS)]
            for number, values in enumerate(begins):
                unit.set(dict(zip(INPUTS, values, strict=True)))
                if last is not None:
                    slopes = (last[number] - values) / 10.0
                    given = {n: [s] for n, s in zip(INPUTS, slopes, strict=True)}
                    unit.set_input_derivatives(given)
                unit.step(10.0)
                rows.append(unit.get(OUTPUTS))
            unit.restore(start)
        rows = np.array(rows)
        missed = np.abs(found.predict(begins, last) - rows).max(axis=0) / np.ptp(rows, axis=0)
        assert missed.max() < 1e-11
        matrix, offset = found.matrices(7)
        if last is None:
            by_matrix = (offset + matrix @ begins[:7].ravel()).reshape(7, 3)
            assert by_matrix == pytest.approx(rows[1:8], rel=1e-11)
    assert np.array_equal(unit.get(OUTPUTS), before)


def test_a_free_response_is_that_of_the_present_state(bed):
    unit, found = bed
    with unit.state() as start:
        unit["heater.heat_flux"] = 2e4
        unit.step(10.0)
        free = found.free_response(unit)
        inputs = np.tile(found.base, (16, 1)) + [1e3, 0.0, 0.0]
        said = found.predict(inputs, free=free)
        unit.set(dict(zip(INPUTS, inputs[0], strict=True)))
        for _ in range(16):
            unit.step(10.0)
        assert said[-1] == pytest.approx(unit.get(OUTPUTS), rel=1e-12)
        unit.restore(start)


def test_what_outputs_follow_at_once_is_told_apart(scenes):
    """A pressure over the whole face is the normal stress below it, at once; of two tiles each
    takes a share, and what is at rest before stays."""
    names = ["press.pressure", "press.heat_flux"]
    with Unit(scenes["pressed"]) as unit:
        found = linear_map(unit, names, ["top.stress_zz", "top.temperature"], 0.1, 4)
        assert found.inputs[:2] == ("press.pressure[1,1]", "press.pressure[2,1]")
        assert found.direct[0, :2].sum() == pytest.approx(-1.0, rel=1e-9)
        assert np.abs(found.held[:, 0, :2]).max() < 1e-9
        inputs = np.random.default_rng(0).uniform(0.0, 1e5, (4, 4))
        for values in inputs:
            unit["press.pressure"] = values[:2].reshape(2, 1)
            unit["press.heat_flux"] = values[2:].reshape(2, 1)
            unit.step(0.1)
        last = unit.get(["top.stress_zz", "top.temperature"])
    assert found.predict(inputs)[-1] == pytest.approx(last, rel=1e-9)


def test_a_realisation_meets_its_tolerance(bed):
    _, found = bed
    random = np.random.default_rng(1)
    orders = []
    for tolerance in (1e-2, 1e-4, 1e-8):
        space = found.state_space(tolerance)
        orders.append(space.order)
        assert space.error <= tolerance
        changes = random.uniform(-1.0, 1.0, (16, 3)) * found.changes
        said = found.predict(found.base + changes) - found.free
        seen = space.simulate(changes)
        largest = np.abs(found.held * np.abs(found.changes)).sum(axis=(0, 2))
        # Outputs here follow nothing at once, so y_k is w_k.
        assert np.all(np.abs(seen[1:] - said[1:-1]).max(axis=0) <= tolerance * largest)
    assert orders == sorted(orders) and orders[0] < orders[-1]
    with pytest.raises(NotRealised) as refused:
        found.state_space(1e-30)
    assert 0.0 < refused.value.error < 1e-8


def test_a_unit_that_only_passes_on_has_a_model_without_dynamics(tmp_path):
    """y = 0.7 u of each step, whatever stood before."""
    unit = make(tmp_path, "Gain", [[-2.0]], [0.0], [0.0], d=0.7)
    space = linear_map(unit, ["u"], ["y"], 0.5, 8).state_space(1e-10)
    assert space.error == 0.0 and space.spectral_radius == 0.0
    assert space.simulate(np.ones((3, 1))).ravel() == pytest.approx([0.7] * 3, rel=1e-12)


def test_a_body_that_only_stores_is_an_integrator(scenes):
    found = linear_map(scenes["plain"], ["plate.top.flux"], ["plate.heat_in"], 0.5, 8)
    space = found.state_space(1e-10)
    assert space.order == 1
    assert space.A[0, 0] == pytest.approx(1.0, abs=1e-12)
    assert (space.C @ space.B).item() == pytest.approx(0.5 * AREA, rel=1e-11)


@pytest.mark.parametrize("direct", [0.0, 0.7])
def test_units_of_other_tools_have_maps(tmp_path, direct):
    """x' = A x + b u, y = c x + d u: exponentials of matrices, and what a controller sees of them;
    u goes straight over a step too."""
    expm = pytest.importorskip("scipy.linalg").expm
    a, b, c = np.array([[-1.0, 0.5], [0.0, -0.3]]), np.array([1.0, 2.0]), np.array([1.0, -0.5])
    values = {"d": direct, "e": 4.0, "x": [1.0, 0.0]}
    step, steps = 0.4, 12
    # [x, u, u'] with u' held: all integrals at once.
    whole = np.zeros((4, 4))
    whole[:2, :2], whole[:2, 2], whole[2, 3] = a, b, 1.0
    turned = expm(whole * step)
    with Unit(make(tmp_path, "Two", a, b, c, **values)) as unit:
        unit["u"] = 0.5
        found = linear_map(unit, ["u"], ["y"], step, steps, ramps=True, tolerance=1e-8)
    powers = [np.linalg.matrix_power(turned[:2, :2], k) for k in range(steps)]
    assert found.held[:, 0, 0] == pytest.approx([c @ p @ turned[:2, 2] for p in powers], abs=1e-9)
    ramp = [c @ p @ turned[:2, 3] / step for p in powers]
    assert found.ramp[:, 0, 0] == pytest.approx(ramp, abs=1e-9)
    assert found.direct.item() == pytest.approx(direct, abs=1e-12)
    space = found.state_space(1e-7)
    assert space.order == 2 and space.D.item() == pytest.approx(direct, abs=1e-12)
    poles = np.sort(np.linalg.eigvals(space.A).real)
    assert poles == pytest.approx(np.exp([-step, -0.3 * step]), abs=1e-7)
    with Unit(make(tmp_path, "None", a, b, c, states=False, **values)) as unit:
        with pytest.raises(UnitError, match="cannot save its state"):
            linear_map(unit, ["u"], ["y"], step, steps)


def test_maps_models_and_plans_print_in_a_line(bed):
    _, found = bed
    planned = plan(found, 330.0, weights=[1.0, 0.0, 0.0], lower=[0.0, -5e3, 290.0], upper=9e3)
    for thing, words in (
        (found, "heater.heat_flux, fan.heat_flux, bed.top.ambient to .* 16 steps of 10 s"),
        (found.state_space(1e-6), "states, step 10 s, error [0-9.]+e-"),
        (planned, "16 steps of 3 inputs, 3 outputs, cost"),
    ):
        assert "\n" not in repr(thing) and len(repr(thing)) < 220
        assert re.search(words, repr(thing))


def test_what_is_not_installed_is_named_with_what_installs_it(bed, monkeypatch):
    _, found = bed
    # What a test before this one has imported is there still.
    parts = ("SALib", "SALib.sample", "SALib.sample.sobol")
    for module in ("control", "casadi", "quadprog", "osqp", "distributed", *parts):
        monkeypatch.setitem(sys.modules, module, None)
    for call, words in (
        (found.to_control, r'to_control\(\) needs `control`.*pip install "./python\[control\]"'),
        (found.to_casadi, "needs `casadi`.*: pip install casadi"),
        (lambda: plan(found, 330.0, solver="quadprog"), r'quadprog.*pip install "./python\[con'),
        (lambda: plan(found, 330.0, solver="osqp"), "osqp.*: pip install osqp"),
        (lambda: Sobol(4).design({"a": Uniform(0.0, 1.0)}), r'pip install "./python\[study\]"'),
    ):
        with pytest.raises(ImportError, match=words):
            call()
    extras = tomllib.loads((ROOT / "python/pyproject.toml").read_text())["project"]
    assert any(word.startswith("control") for word in extras["optional-dependencies"]["control"])


def test_python_control_and_casadi_take_the_model(bed):
    control, casadi = pytest.importorskip("control"), pytest.importorskip("casadi")
    _, found = bed
    space = found.state_space(1e-8)
    changes = np.random.default_rng(2).uniform(-1.0, 1.0, (16, 3)) * found.changes
    expected = space.simulate(changes)
    system = found.to_control(1e-8)
    assert system.dt == 10.0 and system.nstates == space.order
    answer = control.forced_response(system, inputs=changes.T)
    assert answer.outputs.T == pytest.approx(expected, rel=1e-9, abs=1e-9)
    step, state, rows = space.to_casadi(), casadi.DM.zeros(space.order), []
    for change in changes:
        state, output = step(state, change)
        rows.append(np.array(output).ravel())
    assert np.array(rows) == pytest.approx(expected, rel=1e-9, abs=1e-9)
    whole = found.to_casadi()
    inputs = found.base + changes
    answer = np.array(whole(inputs.T, found.free[1:].T)).T
    assert answer == pytest.approx(found.predict(inputs)[1:], rel=1e-12)


def test_do_mpc_finds_the_plan(bed):
    """The example of `StateSpace`: the same moves by do-mpc's program and by `plan`."""
    casadi, do_mpc = pytest.importorskip("casadi"), pytest.importorskip("do_mpc")
    unit, _ = bed
    names = (["heater.heat_flux"], ["thermocouple.temperature"])
    found = linear_map(unit, *names, 10.0, 6)
    space = found.state_space(1e-6)
    model = do_mpc.model.Model("discrete")
    x = model.set_variable("_x", "x", shape=(space.order, 1))
    v = model.set_variable("_u", "v", shape=(1, 1))
    f = model.set_variable("_tvp", "f", shape=(1, 1))
    model.set_rhs("x", casadi.DM(space.A) @ x + casadi.DM(space.B * 1e4) @ v)
    model.set_expression("y", casadi.DM(space.C) @ x + f)
    model.setup()
    mpc = do_mpc.controller.MPC(model)
    mpc.settings.n_horizon = 6
    mpc.settings.t_step = 10.0
    mpc.settings.store_full_solution = False
    mpc.settings.supress_ipopt_output()
    mpc.settings.nlpsol_opts["ipopt.tol"] = 1e-11
    missed = (model.aux["y"] - 345.0) ** 2
    mpc.set_objective(mterm=missed, lterm=missed)
    mpc.set_rterm(v=1.0)
    # v is the change in units of 1e4 W/m²; at the base of 8e3 the heater may do 0 to 2e4.
    mpc.bounds["lower", "_u", "v"] = -0.8
    mpc.bounds["upper", "_u", "v"] = 1.2
    template = mpc.get_tvp_template()
    for k in range(7):
        template["_tvp", k, "f"] = found.free[k]
    mpc.set_tvp_fun(lambda _: template)
    mpc.setup()
    mpc.x0 = np.zeros(space.order)
    mpc.u0 = 0.0
    mpc.set_initial_guess()
    move = 8e3 + 1e4 * mpc.make_step(np.zeros((space.order, 1))).item()
    terms = {"changes": 1e-8, "lower": 0.0, "upper": 2e4, "previous": 8e3}
    assert move == pytest.approx(plan(found, 345.0, **terms).inputs[0, 0], rel=1e-4)


def test_sensitivities_of_linear_units_are_their_first_responses(bed):
    unit, found = bed
    names = [*INPUTS, "heater.radius"]
    before = unit.get(OUTPUTS)
    sensitivity = step_sensitivity(unit, names, [*OUTPUTS, "bed.heat_in"], 10.0)
    assert sensitivity.is_linear[:, :3].all()
    assert sensitivity.matrix[:3, :3] == pytest.approx(found.held[0], rel=1e-9, abs=1e-12)
    # Heat goes with the area of the heater, π r² q H, of r = 30 mm and q = 8e3 W/m².
    assert sensitivity.matrix[3, 3] == pytest.approx(2 * np.pi * 30e-3 * 8e3 * 10.0, rel=1e-6)
    assert sensitivity.error[3, 3] < 1e-5 * sensitivity.matrix[3, 3]
    assert np.array_equal(unit.get(OUTPUTS), before)


def test_sensitivities_of_nonlinear_units_have_an_error_estimate(scenes):
    """A thin plate that radiates, of one temperature: its variational equation."""
    solve_ivp = pytest.importorskip("scipy.integrate").solve_ivp
    parameters = {"plate.conductivity": 5e3, "plate.initial_temperature": 900.0}
    capacity, radiated, ambient, flux, step = (
        HEAT_CAPACITY * 1e-3,
        0.9 * 5.670374419e-8,
        300.0,
        2e4,
        20.0,
    )

    def rates(_, y):
        temperature, by_flux = y
        fall = 4.0 * radiated * temperature**3
        lost = radiated * (temperature**4 - ambient**4)
        return [(flux - lost) / capacity, (1.0 - fall * by_flux) / capacity]

    expected = solve_ivp(rates, (0.0, step), [900.0, 0.0], rtol=1e-11, atol=1e-13).y[1, -1]
    assert expected < 0.9 * step / capacity  # radiation counts
    with Unit(scenes["radiating"], parameters=parameters) as unit:
        unit["plate.top.flux"] = flux
        names = ["plate.top.flux"]
        found = step_sensitivity(unit, names, ["top.temperature"], step)
        assert found.matrix[0, 0] == pytest.approx(expected, rel=1e-4)
        assert np.all(found.error[0] < 1e-3 * np.abs(found.matrix[0]))
        assert not found.is_linear.any()
        with pytest.raises(NotLinear, match="top.temperature") as refused:
            linear_map(unit, names, ["top.temperature"], step, 5)
        assert refused.value.defect > 1e-3


def test_plans_are_those_of_the_units_own_roll_outs(bed):
    """Bounds that hold: the same moves by Gauss and Newton on roll-outs of the unit, with exact
    derivatives by roll-outs too."""
    least_squares = pytest.importorskip("scipy.optimize").least_squares
    unit, _ = bed
    names = (["heater.heat_flux"], ["thermocouple.temperature"])
    found = linear_map(unit, *names, 10.0, 8)
    target = np.concatenate([np.full(4, 345.0), np.full(4, 315.0)])[:, None]
    smooth = 1e-4  # square root of the weight of changes

    def outputs(moves):
        with unit.state() as start:
            rows = []
            for move in moves:
                unit["heater.heat_flux"] = move
                unit.step(10.0)
                rows.append(unit["thermocouple.temperature"])
            unit.restore(start)
        return np.array(rows)

    def residual(moves):
        return np.concatenate([outputs(moves) - target[:, 0], smooth * np.diff(moves)])

    def jacobian(moves):
        base = outputs(moves)
        columns = [outputs(moves + 1e4 * row) - base for row in np.eye(8)]
        return np.vstack([np.array(columns).T / 1e4, smooth * np.diff(np.eye(8), axis=0)])

    terms = {"changes": smooth**2, "lower": 0.0, "upper": 1.5e4}
    made = {s: plan(found, target, solver=s, **terms) for s in ("quadprog", "osqp", "scipy")}
    peer = least_squares(
        residual, np.full(8, 7e3), jacobian, (0.0, 1.5e4), method="dogbox", xtol=1e-14, ftol=1e-14
    )
    for answer in made.values():
        assert answer.inputs[:, 0] == pytest.approx(peer.x, abs=1e-5 * 1.5e4)
        assert answer.cost == pytest.approx(2.0 * peer.cost, rel=1e-7)
        assert answer.outputs[1:, 0] == pytest.approx(outputs(answer.inputs[:, 0]), rel=1e-10)
    assert made["quadprog"].inputs.max() == pytest.approx(1.5e4)
    assert made["quadprog"].inputs.min() == pytest.approx(0.0, abs=1e-6)


def test_plans_keep_limits_of_outputs(bed):
    unit, found = bed
    terms = {
        "lower": [0.0, -1e4, 293.15],
        "upper": [2e4, 0.0, 293.15],
        "changes": [1e-9, 1e-9, 0.0],
    }
    target, weights = [345.0, 0.0, 0.0], [1.0, 0.0, 0.0]
    loose = plan(found, target, weights=weights, solver="quadprog", **terms)
    highest = [np.inf, 322.0, np.inf]
    tight = plan(found, target, weights=weights, highest=highest, solver="quadprog", **terms)
    assert loose.outputs[1:, 1].max() > 323.0
    assert tight.outputs[1:, 1].max() == pytest.approx(322.0, abs=1e-6)
    assert tight.cost > loose.cost
    with pytest.raises(ImpingeError, match="no inputs keep"):
        plan(found, target, weights=weights, lowest=[400.0, 0.0, 0.0], solver="quadprog", **terms)


def test_maps_are_kept_in_files(bed, tmp_path):
    _, found = bed
    found.save(tmp_path / "map.npz")
    again = LinearMap.load(tmp_path / "map.npz")
    for name, value in vars(found).items():
        assert np.array_equal(getattr(again, name), value), name


def test_the_command_writes_map_and_states(tmp_path, capsys):
    target = tmp_path / "map.npz"
    options = ["--step", "10", "--steps", "20", "--states", "1e-6", "-o", str(target)]
    names = ["--inputs", "heater.heat_flux", "--outputs", "rim.temperature", "middle.temperature"]
    assert main([str(BED), *names, *options, "--set", "bed.conductivity=60"]) == 0
    found = LinearMap.load(target)
    with Unit(BED, parameters={"bed.conductivity": 60.0}) as unit:
        unit["heater.heat_flux"] = 1e4
        unit.step(10.0)
        assert found.predict([[1e4]])[1] == pytest.approx(unit.get(found.outputs), rel=1e-12)
    states = np.load(tmp_path / "map.states.npz")
    assert states["A"].shape[0] == states["B"].shape[0] and states["error"] <= 1e-6
    assert main([str(BED), *names, *options, "--set", "nonsense"]) == 1
    assert main([str(BED), "--inputs", "no.such", "--outputs", "rim.temperature"]) == 1
    assert "no.such" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("given", "what"),
    [
        ((["heater.heat_flux"], [], 1.0, 4), "list of names"),
        (("heater.heat_flux", ["rim.temperature"], 1.0, 4), "list of names"),
        ((["rim.temperature"], ["rim.temperature"], 1.0, 4), "inputs"),
        ((["heater.heat_flux"], ["rim.temperature"], 0.0, 4), "above 0"),
        ((["heater.heat_flux"], ["rim.temperature"], 1.0, 0), "at least 1"),
        ((["heater.heat_flux"], ["bed.max_temperature"], 9.0, 9), "not linear"),
        ((["heater.heat_flux", "heater.radius"], ["rim.temperature"], 9.0, 9), "not linear"),
    ],
)
def test_what_has_no_map_is_refused(bed, given, what):
    unit, _ = bed
    with pytest.raises((ValueError, UnitError, NotLinear), match=what):
        linear_map(unit, *given)


def test_the_package_starts_without_its_extras():
    """Neither xarray's peers nor solvers are loaded before they are asked for."""
    code = "import sys, impinge, impinge.linear; print(*sys.modules)"
    environment = {"PYTHONPATH": str(ROOT / "python")}
    ran = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True
    )
    loaded = set(ran.stdout.split())
    assert not loaded & {"SALib", "dask", "casadi", "control", "quadprog", "osqp", "scipy"}


def test_outputs_that_are_no_numbers_have_no_map(tmp_path):
    """A unit that grows beyond all numbers: superposition of NaN says nothing."""
    store = make(tmp_path, "store", [[0.0]], [1.0], [1.0], x=[float("nan")])
    with Unit(store) as unit:
        with pytest.raises(UnitError, match=r"`y` is nan at 0 s of a roll-out \(allowed: finite\)"):
            linear_map(unit, ["u"], ["y"], 0.1, 4)
        with pytest.raises(UnitError, match="`y` is nan"):
            step_sensitivity(unit, ["u"], ["y"], 0.1)
    grows = make(tmp_path, "grows", [[500.0]], [1.0], [1.0], x=[1.0])
    with Unit(grows) as unit, pytest.raises(UnitError, match=r"`y` is inf at .* s of a roll-out"):
        linear_map(unit, ["u"], ["y"], 0.5, 4)
