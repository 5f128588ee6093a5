"""Coupled units against closed forms: stability, contraction, order, energy; and refusals."""

from math import exp, pi, sqrt

import numpy as np
import pytest
from impinge import Connection, Master, StepDiscarded, Unit
from impinge.master import Bond, Graded, MasterError, MasterWarning
from linear_unit import make

RING = [("a.y", "b.u"), ("b.y", "a.u")]


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("linear")


def lumps(folder, first, second, conductance=2.0):
    """A store of heat capacity `first` that takes a flux (Neumann side), and one of `second` behind
    a conductance that takes a temperature and gives the flux (Dirichlet side)."""
    rate = conductance / second
    a = make(folder, "store", [0.0], [1 / first], [1.0], x=[1.0], f=[first])
    b = make(folder, "bath", [-rate], [rate], [conductance], d=-conductance, x=[0.0])
    return {"a": a, "b": b}


@pytest.mark.parametrize(("ratio", "known"), [(1.0, 1.27846), (10.0, 1.83256)])
def test_held_jacobi_is_stable_as_far_as_theory_says(folder, ratio, known):
    """λ = e^{−GH/C₂} − GH/C₁: stable below GH/C₁ = 1 + e^{−GH/C₂}."""
    units = lumps(folder, 1.0, ratio)

    def growth(step):
        with Master(units, RING, scheme="jacobi", step=step) as master:
            flux = master.run(4 * step)["b.y"].values
        return abs(flux[-1] / flux[-2])

    low, high = 0.2, 2.0  # steps, with G = 2 and C₁ = 1
    for _ in range(20):
        middle = (low + high) / 2
        low, high = (middle, high) if growth(middle) < 1 else (low, middle)
    assert 2.0 * low == pytest.approx(known, rel=1e-4)
    step = 0.3
    decay = exp(-2.0 * step / ratio) - 2.0 * step
    assert growth(step) == pytest.approx(abs(decay), rel=1e-9)


@pytest.mark.parametrize("ratio", [0.1, 1.0, 10.0])
@pytest.mark.parametrize(("acceleration", "most"), [("aitken", 3), ("anderson", 3), ("iqn-ils", 3)])
def test_both_directions_converge_with_acceleration(folder, ratio, acceleration, most):
    """At a step where the fixed point alone contracts by 0.1 to 2 and held Jacobi is unstable."""
    units = lumps(folder, 1.0, ratio)
    with Master(units, RING, step=2.0, acceleration=acceleration, energy=["b.y"]) as master:
        result = master.run(40.0)
    assert result.attrs["most_iterations"] <= most
    assert result.attrs["iterations"] <= 3 * result.attrs["steps"]
    assert result.attrs["energy_residual.b.y"] < 1e-5
    assert abs(result["b.y"].values[-1]) < 1e-3
    if ratio == 10.0:
        with Master(units, RING, step=2.0, acceleration="none") as plain:
            with pytest.raises(MasterError, match="does not converge: the residual is"):
                plain.run(2.0)


def test_runs_without_convergence_go_on_from_what_units_have_borne(folder):
    """Where the fixed point diverges, the guess after the last iteration is far from that."""
    options = {"acceleration": "none", "max_iterations": 5, "strict": False, "order": 0}
    with Master(lumps(folder, 1.0, 10.0), RING, step=4.0, **options) as master:
        with pytest.warns(MasterWarning, match="does not converge"):
            result = master.run(4.0)
        place = master.participants["a"].place
        assert master._march.engine.inputs[place] == pytest.approx(master.units["a"]["u"])
    assert result.attrs["unconverged"] == 1


@pytest.mark.parametrize("most", [1, 5])
def test_units_behind_a_ring_without_convergence_take_their_steps(folder, most):
    """Behind two rings that diverge, an integral counts what the first one gives."""
    options = {"acceleration": "none", "max_iterations": most, "strict": False, "order": 0}
    rings = lumps(folder, 1.0, 10.0)
    units = {**rings, "c": rings["a"], "d": rings["b"]}
    units["sum"] = make(folder, "sum", [0.0], [1.0], [1.0], x=[0.0])
    links = [*RING, ("c.y", "d.u"), ("d.y", "c.u"), ("a.y", "sum.u")]
    with Master(units, links, step=4.0, outputs=["sum.y"], **options) as master:
        with pytest.warns(MasterWarning, match=r"does not converge: .* iterations; the residual"):
            result = master.run(8.0)
        assert {unit.time for unit in master.units.values()} == {8.0}
    assert result.attrs["unconverged"] == 2
    assert result["sum.y"].values[-1] == pytest.approx(4.0 * result["a.y"].values[1:].sum())


def test_columns_of_earlier_steps_save_iterations(folder):
    counts = []
    for reuse in (0, 8):
        with Master(lumps(folder, 1.0, 1.0), RING, step=0.3, reuse=reuse) as master:
            counts.append(master.run(3.0).attrs["iterations"])
    assert counts[0] >= 28 and counts[1] <= 21, counts  # of ten steps


def slab(folder, name, material, thickness, cells, is_wall_given, is_held):
    """A slab by linear elements with lumped capacities: its wall is node 0. The far face is
    insulated, or held at zero. Fluxes are into the slab."""
    conductivity, capacity = material
    width = thickness / cells
    count = cells if is_held else cells + 1
    mass = np.full(count, capacity * width)
    mass[0] /= 2
    if not is_held:
        mass[-1] /= 2
    k = np.zeros((count + 1, count + 1))
    for i in range(cells):
        k[i : i + 2, i : i + 2] += conductivity / width * np.array([[1, -1], [-1, 1]])
    k = k[:count, :count]
    if not is_wall_given:
        a, b = -k / mass[:, None], np.eye(count)[0] / mass[0]
        return make(folder, name, a, b, np.eye(count)[0])
    inner = k[1:, 1:] / mass[1:, None]
    coupling = -k[1:, 0] / mass[1:]
    a, b, f, g = -inner, coupling, mass[1:], mass[0]
    if is_held:  # what leaves by the far face counts too: one more state, its integral
        size = len(a) + 1
        a = np.block([[a, np.zeros((size - 1, 1))], [np.zeros((1, size))]])
        a[-1, size - 2] = conductivity / width
        b, f = np.append(b, 0.0), np.append(f, 1.0)
    return make(folder, name, a, b, np.zeros(len(b)), f=f, g=g)


def contraction(folder, given, taking, step, is_held=False, thickness=(1e-3, 1e-3)):
    """By how much an iteration without acceleration shrinks residuals: a wall that rises linearly
    over a step gives the mean of its flux to the slab that takes it."""
    d = slab(folder, "given", given, thickness[0], 60, True, is_held)
    n = slab(folder, "taking", taking, thickness[1], 60, False, is_held)
    ring = [
        ("n.y", "d.u"),
        Connection("d.z", "n.u", gain=-1.0, mean=True),
    ]
    residuals = []
    master = Master(
        {"d": d, "n": n}, ring, step=step, acceleration="none", strict=False, tolerance=1e-30
    )
    (component,) = master.components
    forward = component.acceleration.next

    def watched(x, g, weight):
        residuals.append(float(np.abs(g - x).max()))
        return forward(x, g, weight)

    component.acceleration.next = watched
    with master:
        master._march.engine.inputs[:] = 0.0
        master._march.engine.max_iterations = 12
        master._march.begin()
        master._march.engine.history.nodes[-1][1][:] = 1.0  # something to iterate on
        with pytest.warns(MasterWarning, match="does not converge"):
            master._march.step(step)
    ratios = np.array(residuals[1:]) / np.array(residuals[:-1])
    return float(np.median(ratios[3:8]))


WATER, ALUMINA = (0.6, 4.2e6), (10.0, 3.6e6)  # conductivity, capacity per volume


def effusivity(material):
    return sqrt(material[0] * material[1])


@pytest.mark.parametrize(("given", "taking"), [(WATER, ALUMINA), (ALUMINA, WATER)])
def test_slabs_contract_as_their_materials_say(folder, given, taking):
    """With a wall that rises linearly and a flux that is constant over a step H: capacities at
    tiny steps; `4/3 · 2/π` of effusivities at moderate ones, as the mean flux into a half space is
    `4/3 e ΔT/√(πH)` and a flux warms one by `2 q √(H/π)/e`; half of conductivities at huge ones,
    where far faces are held, as the mean rise is half the last."""
    tiny = contraction(folder, given, taking, 1e-9)
    assert tiny == pytest.approx(given[1] / taking[1], rel=1e-2)
    step = 0.02
    depths = [6 * sqrt(step * material[0] / material[1]) for material in (given, taking)]
    moderate = contraction(folder, given, taking, step, thickness=depths)
    wanted = 8 / (3 * pi) * effusivity(given) / effusivity(taking)
    assert moderate == pytest.approx(wanted, rel=3e-2)
    huge = contraction(folder, given, taking, 1e5, is_held=True)
    assert huge == pytest.approx(given[0] / taking[0] / 2, rel=1e-2)


MASSES, STIFFNESS = (1.0, 2.0), 3.0


def masses(folder):
    """A mass that takes a force and gives its velocity, and one with a spring that takes a velocity
    and gives the spring's force."""
    (one, two), k = MASSES, STIFFNESS
    a = make(folder, "mass", [[0.0]], [1 / one], [1.0], x=[1.0])
    spring = [[0.0, 1.0], [-k / two, 0.0]]
    return {"a": a, "b": make(folder, "spring", spring, [-1.0, 0.0], [k, 0.0], x=[0.5, 0.0])}


def velocity(time):
    """Of the first mass at times, exactly."""
    (one, two), k = MASSES, STIFFNESS
    motion = np.array([[0.0, k / one, 0.0], [-1.0, 0.0, 1.0], [0.0, -k / two, 0.0]])
    values, modes = np.linalg.eig(motion)
    weights = np.linalg.solve(modes, [1.0, 0.5, 0.0])
    return np.real(modes[0] * weights @ np.exp(np.outer(values, time)))


def test_held_jacobi_feeds_a_spring_at_any_step(folder):
    for steps in (200, 800):
        with Master(masses(folder), RING, scheme="jacobi", step=20 / steps) as master:
            speed = master.run(20.0)["a.y"].values
        assert np.abs(speed[-steps // 5 :]).max() > 1.05 * np.abs(speed[: steps // 5]).max()


def test_iterated_masses_are_stable_and_of_second_order(folder):
    errors = []
    for steps in (100, 200, 400):
        energy = [("b.y", "a.y")]
        with Master(masses(folder), RING, step=20 / steps, energy=energy) as master:
            result = master.run(20.0)
        errors.append(abs(result["a.y"].values[-1] - velocity(20.0)[0]))
        assert np.abs(result["a.y"].values).max() < 1.4
        assert result.attrs["energy_residual.b.y*a.y"] < 1e-9
    assert np.log2(errors[1] / errors[2]) == pytest.approx(2.0, abs=0.1), errors


def test_the_energy_residual_falls_with_the_tolerance(folder):
    found = []
    for tolerance in (1e-2, 1e-4, 1e-6):
        options = {"acceleration": "none", "tolerance": tolerance, "energy": [("b.y", "a.y")]}
        with Master(masses(folder), RING, step=0.1, **options) as master:
            found.append(master.run(10.0).attrs["energy_residual.b.y*a.y"])
    assert found[0] > 10 * found[1] > 100 * found[2] > 0, found
    with Master(masses(folder), RING, scheme="jacobi", step=0.1, energy=["b.y"]) as held:
        assert held.run(10.0).attrs["energy_residual.b.y"] > 0.01


def test_adaptive_steps_keep_to_their_tolerance(folder):
    rows = []
    for tolerance in (1e-2, 1e-3, 1e-4):
        options = {"adaptive": True, "tolerance": tolerance}
        with Master(masses(folder), RING, step=1.0, **options) as master:
            result = master.run(20.0)
        error = np.abs(result["a.y"] - velocity(result.time.values)).max()
        rows.append((result.attrs["steps"], float(error), result.attrs["rejected"]))
        assert result.time.values[-1] == 20.0
    steps, errors, rejected = np.array(rows).T
    assert (rejected > 0).all()  # the first proposal is far too long
    assert (errors < 50 * np.array([1e-2, 1e-3, 1e-4])).all(), errors
    assert np.log(errors[0] / errors[2]) / np.log(steps[2] / steps[0]) > 1.7, rows


@pytest.mark.parametrize("order", [0, 1, 2])
def test_adaptive_steps_start_where_a_connected_value_is_zero(folder, order):
    """x' = 1 and z' = x from zero: x changes by all that it is over any first step."""
    integral = make(folder, "integral", [0.0], [1.0], [1.0], x=[0.0])
    options = {"adaptive": True, "tolerance": 1e-2, "step": 0.1, "outputs": ["b.y"]}
    options |= {"inputs": {"a.u": 1.0}, "order": order}
    units = {"a": integral, "b": integral}
    with Master(units, [("a.y", "b.u")], **options) as master:
        result = master.run(1.0)
    assert result["b.y"].values[-1] == pytest.approx(0.5, abs=1e-2)
    assert result.attrs["steps"] < 1000
    link = Connection("a.y", "b.u", scale=1e-30)
    with Master(units, [link], **options) as master:
        with pytest.raises(MasterError, match="still too long .*the error of b.u is .* `scale` of"):
            master.run(1.0)


def test_adaptive_steps_of_held_values_change_by_the_tolerance_at_most(folder):
    """x = 1 + t in shares of 1: steps of 0.01 s for a tolerance of 0.01."""
    units = {
        "ramp": make(folder, "ramp", [0.0], [1.0], [1.0], x=[1.0], u=1.0),
        "store": make(folder, "held", [0.0], [1.0], [1.0], x=[0.0]),
    }
    links = [Connection("ramp.y", "store.u", scale=1.0)]
    options = {"adaptive": True, "tolerance": 1e-2, "step": 1e-3, "order": 0}
    with Master(units, links, **options) as master:
        change = np.diff(master.run(1.0)["ramp.y"].values)
    assert 8e-3 < change.max() < 1.001e-2


def test_a_count_of_energy_agrees_with_the_paths_that_were_set(pack, folder):
    """A plate's own count of heat against what its tile was told to take over each step."""
    count = Bond("law.y", total="plate.block.heat_in")
    for fmi in (2, 3):
        units = plate_and_law(pack, folder)
        units["plate"] = pack("tiles", {"count = [2, 3]": "count = [1, 1]"}, fmi=fmi)
        for scheme in ("gauss-seidel", "iterate"):
            with Master(units, SPLIT, scheme=scheme, step=1e-5, energy=[count]) as master:
                result = master.run(1e-4)
            assert result["energy_passed.law.y"].values[-1] > 1e-8
            assert result.attrs["energy_residual.law.y"] < 1e-9


LAW = {"d": -4e3, "e": 4e3 * 350.0}


def plate_and_law(pack, folder, **more):
    """The patch of tiles as one, under q = h (T∞ − T) of the temperature at a point."""
    plate = pack("tiles", {"count = [2, 3]": "count = [1, 1]", "spacing = 4e-5": "spacing = 2e-5"})
    return {"plate": plate, "law": make(folder, "law", **LAW, **more)}


SPLIT = [("plate.centre.temperature", "law.u"), ("law.y", "plate.patch.heat_flux[1,1]")]


def test_graded_steps_are_of_second_order_after_a_jump(pack, folder):
    """The law's heat begins at once, so temperatures start like √t."""
    ends = []
    for step in (2e-5, 1e-5, 5e-6, 1.25e-6):
        with Master(plate_and_law(pack, folder), SPLIT, step=step, graded=Graded(1e-4)) as master:
            ends.append(float(master.run(1e-4)["plate.centre.temperature"][-1]))
    errors = np.abs(np.array(ends[:3]) - ends[3])
    assert (np.log2(errors[:-1] / errors[1:]) > 1.8).all(), errors
    equal = []
    for step in (2e-5, 1e-5):
        with Master(plate_and_law(pack, folder), SPLIT, step=step) as master:
            equal.append(float(master.run(1e-4)["plate.centre.temperature"][-1]) - ends[3])
    assert abs(equal[1]) > 2 * errors[1]


def test_steps_that_a_unit_refuses_are_shortened(pack, folder):
    """A law near absolute zero: the heat that leaves at first, if it went on so over a step, would
    take more than the plate holds."""
    units = plate_and_law(pack, folder)
    cold = make(folder, "cold", d=-3e6, e=3e6 * 20.0)
    with Master({**units, "law": cold}, SPLIT, scheme="gauss-seidel", step=4e-4) as master:
        with pytest.raises(StepDiscarded, match="below absolute zero"):
            master.run(2e-3)
        assert master.record.time.values[-1] == master.time
        assert len(master.record["plate.centre.temperature"]) == master.record.steps + 1
    options = {"adaptive": True, "tolerance": 1e-2, "energy": ["law.y"]}
    with Master({**units, "law": cold}, SPLIT, step=4e-4, **options) as master:
        result = master.run(2e-3)
    temperature = result["plate.centre.temperature"].values
    assert (temperature > 0).all() and temperature[-1] < 200.0
    assert result.attrs["rejected"] > 2
    assert result.attrs["energy_residual.law.y"] < 1e-3


def test_guesses_that_a_unit_refuses_are_halved(pack, folder):
    """A bottom at 400 K − 5 (T − 293 K) of the top's temperature: at rest T = 1865/6 K; the second
    guess without relaxation is far below absolute zero."""
    law = make(folder, "steep", d=-5.0, e=400.0 + 5 * 293.0)
    units = {"plate": pack("tiles"), "law": law}
    ring = [("plate.centre.temperature", "law.u"), ("law.y", "plate.block.bottom.temperature")]
    options = {"acceleration": "aitken", "relaxation": 1.0, "order": 0, "step": 0.1}
    with Master(units, ring, **options) as master:
        result = master.run(0.3)
    assert result["plate.centre.temperature"].values[-1] == pytest.approx(1865 / 6, rel=1e-4)


def test_units_of_fmi_3_are_held_and_say_so(pack, folder):
    units = plate_and_law(pack, folder)
    two = Master(units, SPLIT, step=1e-5, energy=["law.y"]).run(1e-4)
    three = pack("tiles", {"count = [2, 3]": "count = [1, 1]"}, fmi=3)
    result = Master({**units, "plate": three}, SPLIT, step=1e-5, energy=["law.y"]).run(1e-4)
    assert (two.attrs["held_inputs"], result.attrs["held_inputs"]) == ("", "plate")
    rise = two["plate.centre.temperature"] - 293.15
    assert np.abs(result["plate.centre.temperature"] - 293.15 - rise)[1:].max() < 0.2 * rise.max()
    # Held at the mean of the path, they get the same heat.
    assert result.attrs["energy_residual.law.y"] < 1e-5
    assert result["plate.centre.temperature"].attrs["units"] == "K"


@pytest.mark.parametrize("options", [{"order": 2}, {"order": 1, "extrapolation": 2}], ids=str)
def test_units_that_follow_straight_lines_get_the_mean_of_a_parabola(folder, options):
    """A store of 1 J/K takes the heat that the master accounts for: ∫ 4t (1 − t) dt = 2/3 in the
    first case, and that of a curve through three earlier values in the second."""
    rates = [[0.0, 1.0], [-4.0, 0.0]]
    units = {
        "swing": make(folder, "swing", rates, [0.0, 0.0], [1.0, 0.0], x=[1.0, 0.0]),
        "store": make(folder, "line", [0.0], [1.0], [1.0], x=[0.0]),
    }
    links, inputs, step = [], {"store.u": lambda time: 4 * time * (1 - time)}, 1.0
    if "extrapolation" in options:
        links, inputs, step = [("swing.y", "store.u")], {}, 0.25
    with Master(
        units, links, inputs=inputs, scheme="jacobi", step=step, outputs=["store.y"], **options
    ) as master:
        engine, march, heat = master._march.engine, master._march, 0.0
        march.begin(1.0)
        place = master.participants["store"].place
        while march.time < 1.0:
            march.step(1.0)
            heat += step * engine.arrived[place].item()
            assert master.units["store"]["y"] == pytest.approx(heat, rel=1e-9)
    if not links:
        assert heat == pytest.approx(2 / 3, rel=1e-9)


def test_units_that_cannot_go_back_take_single_steps_and_say_so(folder):
    units = lumps(folder, 1.0, 1.0)
    stuck = make(folder, "stuck", [-2.0], [2.0], [2.0], d=-2.0, states=False)
    with pytest.warns(MasterWarning, match="b cannot go back: no iterations"):
        master = Master({**units, "b": stuck}, RING, step=0.1)
    with master:
        result = master.run(5.0)
    assert result.attrs["notes"].startswith("b cannot go back")
    assert result.attrs["iterations"] == 0
    assert result["a.y"].values[-1] == pytest.approx(0.5, abs=0.1)
    with pytest.warns(MasterWarning, match="steps of one length"):
        Master({**units, "b": stuck}, RING, step=0.1, adaptive=True, scheme="gauss-seidel").close()
    # A law without a state of its own may say that it can step again.
    law = make(folder, "static", d=-2.0, e=1.0, states=False)
    with Master({"a": units["a"], "b": law}, RING, step=0.1, memoryless={"b"}) as master:
        assert master.run(5.0)["a.y"].values[-1] == pytest.approx(0.5 + 0.5 * exp(-10.0), abs=1e-4)
    assert master.notes == []


def test_orders_follow_from_dependencies(folder):
    """The unit whose output follows its input at once comes after the one that sets it; units
    outside of rings come once, before or after."""
    units = lumps(folder, 1.0, 1.0)
    source = make(folder, "source", [-1.0], [0.0], [1.0], x=[300.0])
    gauge = make(folder, "gauge", [-1.0], [1.0], [1.0])
    whole = {"gauge": gauge, "b": units["b"], "a": units["a"], "source": source}
    with Master(whole, [*RING, ("a.y", "gauge.u")], step=0.1) as master:
        result = master.run(1.0)
    order = result.attrs["order_of_units"].split()
    assert order.index("a") < order.index("b") < order.index("gauge")
    assert result.attrs["unit_steps.gauge"] == 10
    assert result.attrs["unit_steps.a"] == result.attrs["iterations"] > 10


def test_algebraic_loops_are_found_and_solved(folder):
    """y₁ = 3 − 2 y₂ and y₂ = 1 + 0.9 y₁ at once: y₁ = 1/2.8, where exchanges in turn diverge."""
    one = make(folder, "one", d=-2.0, e=3.0)
    two = make(folder, "two", d=0.9, e=1.0)
    for scheme in ("jacobi", "gauss-seidel", "iterate"):
        with Master({"a": one, "b": two}, RING, scheme=scheme, step=1.0) as master:
            assert sorted(master.algebraic_loops[0]) == ["a.y", "b.y"]
            result = master.run(3.0)
        assert result["a.y"].values == pytest.approx(np.full(4, 1 / 2.8), rel=1e-5)
        assert result["b.y"].values == pytest.approx(np.full(4, 1 + 0.9 / 2.8), rel=1e-5)


def test_gains_maps_and_units_of_measurement(folder):
    store = make(folder, "warm", [-1.0], [1.0], [1.0], x=[300.0], y_unit="K")
    celsius = make(folder, "celsius", d=1.0, u_unit="degC")
    kilo = make(folder, "kilo", d=1.0, u_unit="kW/m2")
    flux = make(folder, "flux", d=1.0, e=5e3, y_unit="W/m2")
    links = [Connection("a.y", "b.u", gain=2.0, offset=1.0), ("c.y", "d.u")]
    units = {"a": store, "b": celsius, "c": flux, "d": kilo}
    with Master(units, links, step=0.1, inputs={"a.u": 300.0}, outputs=["b.u"]) as master:
        result = master.run(0.2)
    assert result["b.u"].values == pytest.approx(np.full(3, 2 * (300.0 - 273.15) + 1.0))
    assert master.units == {} or result["c.y"].values[-1] == 5e3
    with Master(units, [("c.y", "d.u")], step=0.1, outputs=["d.y"]) as master:
        assert master.run(0.1)["d.y"].values[-1] == pytest.approx(5.0)
    doubled = Connection("a.y", "b.u", map=lambda values: values * 3)
    with Master(units, [doubled], step=0.1, inputs={"a.u": 300.0}, outputs=["b.u"]) as master:
        assert master.run(0.1)["b.u"].values[-1] == pytest.approx(3 * (300.0 - 273.15))


def cooled(folder, y_unit, u_unit, per_watt, **more):
    """A store of 1 J/K at 400 K that loses 2 W/K to 300 K by the map of its one connection."""
    store = make(
        folder, "cooled", [0.0], [per_watt], [1.0], x=[400.0], u_unit=u_unit, y_unit=y_unit
    )
    with Master({"a": store}, [Connection("a.y", "a.u", **more)], step=0.02, energy=["a.y"]) as m:
        return m.run(1.0)


def test_a_map_may_change_the_kind_of_quantity(folder):
    """T = 300 K + 100 K e^(−2 t), with fluxes in W/m2 and kW/m2; what has left is 1 J/K × ΔT."""
    law = {"map": lambda kelvin: 2.0 * (300.0 - kelvin), "unit": "W/m2"}
    plain = cooled(folder, "K", "W/m2", 1.0, **law)
    assert plain["a.y"].values == pytest.approx(
        300 + 100 * np.exp(-2 * plain.time.values), abs=0.01
    )
    passed = plain["energy_passed.a.y"].values
    assert passed == pytest.approx(plain["a.y"].values - 400.0, abs=0.01)
    kilo = cooled(folder, "K", "kW/m2", 1e3, **law)
    assert kilo["a.y"].values == pytest.approx(plain["a.y"].values, rel=1e-9)
    assert kilo["energy_passed.a.y"].values == pytest.approx(passed, abs=1e-6)
    # It gets what the source says, in the source's own unit.
    celsius = cooled(folder, "degC", "W/m2", 1.0, **law)
    assert celsius["a.y"].values == pytest.approx(plain["a.y"].values, rel=1e-12)


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        ({}, "a.y is in K, a.u in W/m2; a `map` may lead there, whose `unit` is that of what"),
        ({"map": np.negative}, "a.y is in K, a.u in W/m2; a `map` may lead there"),
        ({"map": np.negative, "unit": "W"}, "the map of a.y -> a.u gives W, a.u in W/m2"),
        ({"map": np.negative, "unit": "w/m2"}, "`w` is no unit that is known here; is it `W`?"),
        ({"unit": "W/m2"}, "a.y -> a.u: `unit` is that of a `map`, and there is none"),
    ],
)
def test_maps_to_other_quantities_name_their_unit(folder, wrong, told):
    with pytest.raises(MasterError) as refused:
        cooled(folder, "K", "W/m2", 1.0, **wrong)
    assert told in str(refused.value)


def test_families_connect_whole_and_inputs_follow_functions(pack, folder):
    """Rings of a plate get what a drop gives its wall; a flux jumps in the middle of a run."""
    rings = pack("rings")
    drop = pack("drop")
    wall = Unit(drop).outputs["wall.heat_flux"]
    assert wall.shape == (4,)
    links = [("drop.wall.heat_flux", "plate.splat.heat_flux")]
    with Master(
        {"drop": drop, "plate": rings}, links, step=1e-5, energy=[Bond("drop.wall.heat_flux")]
    ) as m:
        result = m.run(1e-4)
    assert result["drop.wall.heat_flux"].shape == (11, 4)
    assert result.attrs["order_of_units"] == "drop plate"
    # A mean over a step arrives whole in the same step.
    assert result.attrs["energy_residual.drop.wall.heat_flux"] == 0.0
    assert (result["energy_residual.drop.wall.heat_flux"] == 0.0).all()
    assert result["energy_passed.drop.wall.heat_flux"].attrs["units"] == "J"
    radius = result["drop.wall.heat_flux:r"]
    assert radius.dims == ("drop.wall.heat_flux:0",) and radius.attrs["units"] == "m"
    outer, inner = result["drop.wall.heat_flux:outer"], result["drop.wall.heat_flux:inner"]
    assert inner[0] == 0.0 and (outer[:-1].values == inner[1:].values).all()
    assert radius.values == pytest.approx((inner.values + outer.values) / 2)

    def flux(time):
        return 1e6 if time < 5e-5 else 3e6 + 1e10 * (time - 5e-5)

    plate = pack("tiles", {"count = [2, 3]": "count = [1, 1]", "spacing = 4e-5": "spacing = 2e-5"})
    options = {"inputs": {"plate.patch.heat_flux": flux}, "jumps": [5e-5], "step": 2e-5}
    with Master({"plate": plate}, outputs=["plate.block.heat_in"], **options) as master:
        heat = float(master.run(1e-4)["plate.block.heat_in"][-1])
    area = 1.1e-4 * 0.9e-4
    exact = area * (1e6 * 5e-5 + 3e6 * 5e-5 + 1e10 * 5e-5**2 / 2)
    assert heat == pytest.approx(exact, rel=1e-8)


def test_whole_numbers_do_not_keep_others_from_following_paths(pack):
    """The place of the load is set as if it were a whole number; its flux is a ramp."""
    plate = pack("tiles", {"count = [2, 3]": "count = [1, 1]", "spacing = 4e-5": "spacing = 2e-5"})
    inputs = {"p.patch.heat_flux": lambda time: 1e12 * time, "p.patch.x": 1e-5}
    with Master({"p": plate}, inputs=inputs, step=2e-5, outputs=["p.block.heat_in"]) as master:
        (participant,) = master.participants.values()
        participant.connect(participant.names, np.array([True, False]), 1)
        heat = master.run(1e-4)["p.block.heat_in"].values[-1]
    assert heat == pytest.approx(1.1e-4 * 0.9e-4 * 1e12 * 1e-4**2 / 2, rel=1e-9)


def test_runs_go_on_and_units_may_be_shared(folder):
    whole = lumps(folder, 1.0, 1.0)
    with Master(whole, RING, step=0.1) as once, Master(whole, RING, step=0.1) as twice:
        end = once.run(2.0)
        twice.run(1.0)
        parts = twice.run(2.0)
    assert parts["a.y"].values == pytest.approx(end["a.y"].values, rel=1e-12)
    with Unit(whole["a"]) as a, Unit(whole["b"]) as b:
        with Master({"a": a, "b": b}, RING, step=0.1) as master:
            master.run(1.0)
        assert a.time == 1.0 and a.is_open  # units that were given stay open


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        ({"scheme": "euler"}, "scheme is `euler`; it may be jacobi, gauss-seidel, iterate"),
        ({"acceleration": "newton"}, "it may be none, aitken, anderson or iqn-ils"),
        ({"order": 3}, "order is 3; it may be 0, 1 or 2"),
        ({"connections": [("a.y", "c.u")]}, "`c.u` names none of the units a, b"),
        ({"connections": [("a.u", "b.u")]}, "the source is no output, but input"),
        ({"connections": [("a.y", "b.y")]}, "the target is no input, but output"),
        ({"connections": [*RING, ("a.z", "b.u")]}, "b.u is the target of two connections"),
        ({"energy": ["a.z"]}, "a.z is the end of no connection"),
        ({"inputs": {"a.u": 1.0}}, "a.u is set by a connection already"),
        ({"step": None}, "no unit proposes a step"),
        ({"memoryless": {"x"}}, "no unit is called x"),
    ],
)
def test_what_does_not_fit_is_refused(folder, wrong, told):
    options = {"connections": RING, "step": 0.1, **wrong}
    with pytest.raises(MasterError) as refused:
        Master(lumps(folder, 1.0, 1.0), **options)
    assert told in str(refused.value)


def test_a_run_of_steps_without_end_is_refused(folder):
    with Master(lumps(folder, 1.0, 1.0), RING, step=1e-300) as master:
        with pytest.raises(MasterError, match="allowed: 3e-15 s or more, for at most 1e.09 steps"):
            master.run(3e-6)


def test_units_of_measurement_and_shapes_must_agree(pack, folder):
    hot = make(folder, "hot", d=1.0, y_unit="K")
    flux = make(folder, "taker", d=1.0, u_unit="W/m2")
    with pytest.raises(MasterError, match="is in K, b.u in W/m2"):
        Master({"a": hot, "b": flux}, [("a.y", "b.u")], step=0.1)
    with pytest.raises(MasterError, match=r"shapes \(\) and \(2, 3\) differ"):
        Master({"a": flux, "p": pack("tiles")}, [("a.y", "p.patch.heat_flux")], step=0.1)
