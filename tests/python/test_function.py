"""Python functions as units: closed forms, compiled laws, and loops that are written by hand."""

import numpy as np
import pytest
from impinge import Connection, Function, Master, Unit
from impinge.master import Bond, Graded, MasterWarning
from linear_unit import make
from slab import SCENE

RING = [("body.y", "law.u"), ("law.y", "body.u")]
SCHEMES = ["jacobi", "gauss-seidel", "iterate"]


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("function")


def body(folder, **more):
    """A store of 1 J/K at 400 K that takes a heat flux over 1 m² and gives its temperature."""
    told = {"u_unit": "W/m2", "y_unit": "K", "x": [400.0], **more}
    return make(folder, f"body{len(more)}", [0.0], [1.0], [1.0], **told)


def cooling(u):
    return 2.0 * (300.0 - u)


LAW = Function(cooling, {"u": "K"}, {"y": "W/m2"})


# Laws


@pytest.mark.parametrize("acceleration", ["none", "aitken", "anderson", "iqn-ils"])
def test_a_lump_under_a_coefficient_that_depends_on_temperature_is_of_second_order(
    folder, acceleration
):
    """x' = −2 x (1 + x/100) of x = T − 300 K: x = 100 e^(−2t)/(2 − e^(−2t))."""

    def convection(u):
        rise = u - 300.0
        return {"y": -2.0 * (1.0 + rise / 100.0) * rise}

    law = Function(convection, {"u": "K"}, {"y": "W/m2"})
    errors = []
    for steps in (25, 50, 100):
        options = {"acceleration": acceleration, "energy": ["law.y"]}
        with Master({"body": body(folder), "law": law}, RING, step=1 / steps, **options) as master:
            result = master.run(1.0)
        decay = np.exp(-2.0 * result.time.values)
        errors.append(np.abs(result["body.y"].values - 300.0 - 100.0 * decay / (2.0 - decay)).max())
        left = result["energy_passed.law.y"].values
        assert left == pytest.approx(result["body.y"].values - 400.0, abs=0.5)
        assert result.attrs["energy_residual.law.y"] < 1e-6
    assert np.log2(errors[:-1] / np.array(errors[1:])) == pytest.approx([2.0, 2.0], abs=0.1)


@pytest.mark.parametrize(
    "options",
    [
        *({"scheme": scheme, "order": order} for scheme in SCHEMES for order in (0, 1, 2)),
        *({"scheme": scheme, "extrapolation": 1} for scheme in SCHEMES[:2]),
        *({"acceleration": each} for each in ("none", "aitken", "anderson")),
        {"adaptive": True, "tolerance": 1e-4},
        {"graded": Graded(0.3), "jumps": [0.33]},
    ],
    ids=str,
)
def test_a_law_is_worth_the_same_compiled_or_not(folder, options):
    """Values, energies, and all that a master counts."""
    compiled = make(folder, "law", d=-2.0, e=600.0, u_unit="K", y_unit="W/m2")
    store = body(folder)
    results = []
    for law in (compiled, LAW):
        units = {"body": store, "law": law}
        with Master(units, RING, energy=["law.y"], **{"step": 0.05, **options}) as master:
            results.append(master.run(1.0))
    one, other = results
    for name in one.data_vars:
        assert other[name].values == pytest.approx(one[name].values, rel=1e-12), name
        assert other[name].attrs.get("units") == one[name].attrs.get("units")
    own = {"unit.law", "seconds"}
    assert {k: v for k, v in one.attrs.items() if k not in own} == pytest.approx(
        {k: v for k, v in other.attrs.items() if k not in own}
    )


def test_a_plate_under_a_law_is_one_with_a_convective_face(folder, monkeypatch, programs):
    """Within 1e-3 of its rise, from a jump on: the unit has the same law inside."""
    monkeypatch.setenv("IMPINGE_BIN", str(programs))
    monkeypatch.setenv("IMPINGE_CACHE", str(folder / "cache"))
    coefficient, ambient = 1e4, 400.0
    whole = SCENE.replace(
        "flux = 0.0", f"convection = {{ coefficient = {coefficient}, ambient = {ambient} }}"
    )
    load = '[[load]]\nname = "face"\non = "plate.top"\ncarries = ["heat_flux"]\n'
    tile = "footprint = { tiles = { count = [1, 1], size = [4e-3, 4e-3] } }\n"
    for name, text in (("split", SCENE + load + tile), ("whole", whole)):
        (folder / f"{name}.toml").write_text(text)

    def convection(temperature):
        return coefficient * (ambient - temperature)

    law = Function(convection, {"temperature": "K"}, {"heat_flux": ("W/m2", (1, 1))})
    links = [
        ("plate.top.temperature", "law.temperature"),
        ("law.heat_flux", "plate.face.heat_flux"),
    ]
    units = {"plate": folder / "split.toml", "law": law}
    options = {"step": 0.02, "order": 2, "graded": Graded(0.4, 3.0), "energy": ["law.heat_flux"]}
    with Master(units, links, **options) as master:
        result = master.run(0.4)
    found = result["plate.top.temperature"].values
    wanted = []
    with Unit(folder / "whole.toml") as unit:
        for time in result.time.values:
            if time:
                unit.step_to(time)
            wanted.append(unit["top.temperature"])
    assert wanted[-1] > 350.0
    assert np.abs(found - wanted).max() < 1e-3 * (wanted[-1] - 300.0)
    passed = result["energy_passed.law.heat_flux"].values[-1]
    with Unit(folder / "whole.toml") as unit:
        unit.step_to(0.4)
        assert passed == pytest.approx(unit["plate.heat_stored"], rel=1e-3)


def test_schedules_of_time_keep_to_declared_jumps(folder, monkeypatch, programs):
    """100 W until 0.35 s and 300 W + 1 kW/s × (t − 0.35 s) from then on, into 1 J/K."""

    def schedule(time):
        return 100.0 if time < 0.35 else 300.0 + 1e3 * (time - 0.35)

    for scheme in SCHEMES:
        source = Function(schedule, {}, {"y": "W/m2"})
        units = {"body": body(folder), "schedule": source}
        options = {"scheme": scheme, "step": 0.1, "jumps": [0.35], "energy": ["schedule.y"]}
        options["outputs"] = ["body.y"]
        with Master(units, [("schedule.y", "body.u")], **options) as master:
            result = master.run(1.0)
        exact = 400.0 + 100.0 * 0.35 + 300.0 * 0.65 + 1e3 * 0.65**2 / 2
        if scheme != "jacobi":
            assert result["body.y"].values[-1] == pytest.approx(exact, rel=1e-7)
            assert result.attrs["energy_residual.schedule.y"] < 1e-7
        assert result["schedule.y"].sel(time=0.35).item() == pytest.approx(300.0, rel=1e-6)


def test_arrays_connect_whole_and_by_their_elements(folder):
    """Three bodies in one function, each with its own flux from a law of arrays."""

    def store(flux, state, step):
        new = state + step * flux
        return new, new

    bodies = Function(
        store,
        {"flux": ("W/m2", 3)},
        {"temperature": ("K", 3)},
        state=np.array([400.0, 350.0, 320.0]),
        depends_on={"temperature": ()},
    )
    law = Function(cooling, {"u": ("K", 3)}, {"y": ("W/m2", (3,))})
    units = {"bodies": bodies, "law": law}
    whole = [("bodies.temperature", "law.u"), ("law.y", "bodies.flux")]
    with Master(units, whole, step=0.02, energy=["law.y"]) as master:
        result = master.run(1.0)
    assert result["bodies.temperature"].dims == ("time", "bodies.temperature:0")
    rises = np.array([100.0, 50.0, 20.0]) * np.exp(-2.0 * result.time.values)[:, None]
    assert np.abs(result["bodies.temperature"].values - 300.0 - rises).max() < 0.02
    assert result["law.y"].values == pytest.approx(-2.0 * (result["bodies.temperature"] - 300.0))
    parts = [(f"{a}[{i}]", f"{b}[{4 - i}]") for a, b in whole for i in (1, 2, 3)]
    with Master(units, parts, step=0.02, outputs=["bodies.temperature"]) as master:
        same = master.run(1.0)["bodies.temperature"]
    # The law of each element goes back to the one that it came from.
    assert same.values == pytest.approx(result["bodies.temperature"].values, rel=1e-9)


def test_units_of_measurement_convert_and_must_agree_in_kind(folder):
    def celsius(temperature):
        return 2e-3 * (26.85 - temperature)

    law = Function(celsius, {"temperature": "degC"}, {"heat_flux": "kW/m2"})
    links = [("body.y", "law.temperature"), ("law.heat_flux", "body.u")]
    results = []
    for each, ring in ((LAW, RING), (law, links)):
        with Master({"body": body(folder), "law": each}, ring, step=0.05) as master:
            results.append(master.run(1.0))
    assert results[1]["body.y"].values == pytest.approx(results[0]["body.y"].values, rel=1e-9)
    assert results[1]["law.heat_flux"].attrs["units"] == "kW/m2"
    assert results[1]["law.heat_flux"].values[0] == pytest.approx(-0.2)


def test_what_a_function_makes_of_means_arrives_whole(folder):
    """A mean flux belongs to the whole step; so does a share of it, behind two functions."""
    share = Function(lambda u: 0.5 * u, {"u": None}, {"y": None}, name="share")
    source = make(folder, "mean", [0.0], [1.0], [1.0], f=[1.0], x=[0.0])
    links = [
        Connection("source.z", "one.u", mean=True),
        ("one.y", "two.u"),
        ("two.y", "body.u"),
    ]
    units = {"source": source, "one": share, "two": share, "body": body(folder)}
    options = {"inputs": {"source.u": lambda time: 40.0 * time}, "energy": ["two.y"]}
    options["outputs"] = ["body.y"]
    with Master(units, links, step=0.1, **options) as master:
        result = master.run(1.0)
    assert [link.is_mean for link in master.links] == [True] * 3
    assert result["body.y"].values == pytest.approx(400.0 + 5.0 * result.time.values**2, rel=1e-9)
    assert result.attrs["energy_residual.two.y"] == pytest.approx(0.0, abs=1e-12)


def with_time(q, time):
    return {"y": q * time}


def times_temperature(q, temperature):
    return {"y": q * temperature}


@pytest.mark.parametrize(
    ("f", "inputs"),
    [(with_time, {}), (times_temperature, {"law.temperature": lambda t: t})],
    ids=["time", "input"],
)
def test_what_a_function_makes_of_a_mean_and_of_time_is_no_mean(folder, f, inputs):
    """q = 1 as a mean, times t: 1/2 after 1 s, with steps of any length."""
    names = {"q": None, "temperature": None} if inputs else {"q": None}
    units = {
        "source": make(folder, "one", [0.0], [1.0], [1.0], f=[1.0], x=[0.0], u=1.0),
        "law": Function(f, names, {"y": None}),
        "store": make(folder, "store", [0.0], [1.0], [1.0], x=[0.0]),
    }
    links = [Connection("source.z", "law.q", mean=True), ("law.y", "store.u")]
    with Master(units, links, step=0.1, inputs=inputs, outputs=["store.y"]) as master:
        result = master.run(1.0)
    assert result["store.y"].values[-1] == pytest.approx(0.5, rel=1e-9)
    assert [link.is_mean for link in master.links] == [True, False]


def test_algebraic_loops_of_functions_are_found_and_solved():
    """y₁ = 3 − 2 y₂ and y₂ = 1 + 0.9 y₁ at once: y₁ = 1/2.8. Outputs that follow nothing make no
    loop."""
    one = Function(lambda u: 3.0 - 2.0 * u, {"u": "1"}, {"y": "1"})
    two = Function(
        lambda u, time: {"y": 1.0 + 0.9 * u, "clock": time},
        {"u": "1"},
        {"y": "1", "clock": "s"},
        depends_on={"clock": []},
    )
    for scheme in SCHEMES:
        units = {"a": one, "b": two}
        with Master(
            units, [("a.y", "b.u"), ("b.y", "a.u")], scheme=scheme, step=1.0, outputs=["b.clock"]
        ) as master:
            assert sorted(master.algebraic_loops[0]) == ["a.y", "b.y"]
            result = master.run(3.0)
        assert result["a.y"].values == pytest.approx(np.full(4, 1 / 2.8), rel=1e-5)
        assert result["b.clock"].values.tolist() == [0.0, 1.0, 2.0, 3.0]
    with Master({"a": one, "b": two}, [("a.y", "b.u")], step=1.0, inputs={"a.u": 1.0}) as master:
        assert master.algebraic_loops == []
        assert master.run(1.0).attrs["order_of_units"] == "a b"


def test_a_large_pressure_does_not_decide_on_a_small_displacement():
    """p = 10⁹ Pa + 10⁸ Pa/m u and u = 1 mm + 0.9 u + s at once: u = 10 mm, and s, a displacement
    of a half of itself, is zero."""
    law = Function(
        lambda p, u, s: {"force": 1e9 + 1e8 * u, "way": 1e-3 + 0.9 * u + s, "slip": 0.5 * s},
        {"p": "Pa", "u": "m", "s": "m"},
        {"force": "Pa", "way": "m", "slip": "m"},
    )
    same = Function(
        lambda force, way, slip: {"p": force, "u": way, "s": slip},
        {"force": "Pa", "way": "m", "slip": "m"},
        {"p": "Pa", "u": "m", "s": "m"},
    )
    ring = [(f"law.{a}", f"same.{a}") for a in ("force", "way", "slip")]
    ring += [(f"same.{a}", f"law.{a}") for a in ("p", "u", "s")]
    outputs = ["law.way", "law.force", "law.slip"]
    with Master({"law": law, "same": same}, ring, step=1.0, outputs=outputs) as master:
        result = master.run(2.0)
    assert result["law.way"].values == pytest.approx(np.full(3, 1e-2), rel=1e-5)
    assert result["law.force"].values == pytest.approx(np.full(3, 1e9 + 1e6), rel=1e-6)
    assert np.abs(result["law.slip"].values).max() < 1e-8


# Memories


class Store:
    """A heat store as an object that changes in place."""

    def __init__(self, temperature):
        self.temperature = temperature

    def take(self, before, after, step):
        self.temperature += step * (before + after) / 2


def kept(u, state, step, before):
    state.take(before["u"], u, step)
    return state.temperature, state


def integral(u, state, step):
    new = state + step * u
    return {"y": new}, new


ENDS = {"inputs": {"u": "W/m2"}, "outputs": {"y": "K"}}
STORES = {
    "means": Function(integral, **ENDS, state=400.0, depends_on={"y": []}),
    "both ends": Function(kept, **ENDS, state=Store(400.0), depends_on={"y": []}),
}


@pytest.mark.parametrize("kind", list(STORES))
@pytest.mark.parametrize(
    "options",
    [
        *({"scheme": scheme, "order": order} for scheme in SCHEMES for order in (0, 1)),
        *({"acceleration": each} for each in ("none", "aitken", "anderson")),
        {"adaptive": True, "tolerance": 1e-4},
        {"graded": Graded(0.3), "jumps": [0.33]},
    ],
    ids=str,
)
def test_a_store_in_python_goes_as_a_compiled_one(folder, kind, options):
    """Repeated steps start from its memory at their beginning."""
    results = []
    for store in (body(folder), STORES[kind]):
        units = {"body": store, "law": LAW}
        with Master(units, RING, energy=["law.y"], **{"step": 0.05, **options}) as master:
            results.append(master.run(1.0))
    one, other = results
    for name in one.data_vars:
        assert other[name].values == pytest.approx(one[name].values, rel=1e-9), name
    assert one.attrs["iterations"] == other.attrs["iterations"]
    assert one.attrs["path_error"] == pytest.approx(other.attrs["path_error"])


def test_functions_are_descriptions_that_masters_share(folder):
    """Two stores of one function in one master, and the next master starts anew."""
    units = {"a": STORES["both ends"], "b": STORES["both ends"]}
    inputs = {"a.u": 1.0, "b.u": lambda time: 2.0 * time}
    for _ in range(2):
        with Master(units, step=0.1, inputs=inputs, outputs=["a.y", "b.y"]) as master:
            result = master.run(0.5)
            result = master.run(1.0)  # runs go on
        assert result["a.y"].values == pytest.approx(400.0 + result.time.values)
        assert result["b.y"].values == pytest.approx(400.0 + result.time.values**2)
    with Unit(body(folder), start_time=5.0) as unit:
        with Master({"u": unit, "a": STORES["means"]}, step=0.1, inputs={"a.u": 1.0}) as master:
            assert master.units["a"].time == 5.0


def lag(temperature, state, step, before):
    """T' = (u − T)/τ, exact for inputs that are linear over a step; τ = 0.5 s."""
    u0, u1 = before["temperature"], temperature
    slope = (u1 - u0) / step if step else 0.0
    decay = np.exp(-step / 0.5)
    new = u1 - 0.5 * slope + (state - u0 + 0.5 * slope) * decay
    return new, float(new)


THERMOCOUPLE = Function(
    lag, {"temperature": "K"}, {"reading": "K"}, state=300.0, depends_on={"reading": []}
)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_thermocouple_lags_behind_a_ramp_as_it_must(scheme):
    """T = r (t − τ (1 − e^(−t/τ))) of a ramp r t, to rounding, whatever the steps."""
    for step in (0.5, 0.07):
        options = {"scheme": scheme, "step": step, "outputs": ["sensor.reading"]}
        inputs = {"sensor.temperature": lambda time: 300.0 + 20.0 * time}
        with Master({"sensor": THERMOCOUPLE}, inputs=inputs, **options) as master:
            result = master.run(3.0)
        time = result.time.values
        exact = 300.0 + 20.0 * (time - 0.5 * (1.0 - np.exp(-time / 0.5)))
        assert result["sensor.reading"].values == pytest.approx(exact, rel=1e-12)


def test_a_lag_on_means_is_of_second_order():
    def held(temperature, state, step):
        new = temperature + (state - temperature) * np.exp(-step / 0.5)
        return new, float(new)

    sensor = Function(
        held, {"temperature": "K"}, {"reading": "K"}, state=0.0, depends_on={"reading": []}
    )
    errors = []
    for step in (0.1, 0.05):
        inputs = {"s.temperature": np.sin}
        with Master({"s": sensor}, inputs=inputs, step=step, outputs=["s.reading"]) as master:
            result = master.run(2.0)
        time = result.time.values
        exact = (np.sin(time) - 0.5 * np.cos(time) + 0.5 * np.exp(-time / 0.5)) / 1.25
        errors.append(np.abs(result["s.reading"].values - exact).max())
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.1)


class Pid:
    """A controller written by hand, with a derivative of the measurement."""

    def __init__(self):
        self.integral, self.last = 0.0, None

    def power(self, temperature, step):
        error = 350.0 - temperature
        self.integral += error * step
        rate = 0.0 if self.last is None or not step else (temperature - self.last) / step
        self.last = temperature
        return 8.0 * error + 3.0 * self.integral - 0.1 * rate


def control(temperature, state, step):
    return state.power(temperature, step), state


CONTROLLED = [("body.y", "pid.temperature"), ("pid.power", "body.u")]


def by_hand(unit, step, count):
    pid, temperatures, powers = Pid(), [unit["y"]], []
    powers.append(pid.power(unit["y"], 0.0))
    for _ in range(count):
        unit["u"] = powers[-1]
        unit.step(step)
        temperatures.append(unit["y"])
        powers.append(pid.power(unit["y"], step))
    return np.array(temperatures), np.array(powers)


@pytest.mark.parametrize(
    ("scheme", "rollback"),
    [("jacobi", True), *((s, r) for s in SCHEMES[1:] for r in (True, False))],
)
def test_a_sampled_controller_goes_as_a_loop_by_hand(folder, scheme, rollback):
    """The power holds over each step what it was at its beginning, whatever the scheme."""
    plant = make(folder, "plant", [-0.5], [1.0], [1.0], x=[300.0], u_unit="W/m2", y_unit="K")
    with Unit(plant) as unit:
        temperatures, powers = by_hand(unit, 0.05, 100)
    pid = Function(
        control,
        {"temperature": "K"},
        {"power": "W/m2"},
        state=Pid(),
        sampled=True,
        rollback=rollback,
    )
    units = {"body": plant, "pid": pid}
    options = {"scheme": scheme, "step": 0.05, "energy": [Bond("pid.power", area=1.0)]}
    with Master(units, CONTROLLED, **options) as master:
        result = master.run(5.0)
    assert result["body.y"].values == pytest.approx(temperatures, rel=1e-12)
    assert result["pid.power"].values == pytest.approx(powers, rel=1e-10)
    assert abs(temperatures[-1] - 350.0) < 5.0
    assert result.attrs["energy_residual.pid.power"] < 1e-12
    assert result.attrs["iterations"] == 0 and result.attrs["notes"] == ""


def test_a_sampled_controller_holds_in_rings_that_iterate():
    """T₁ = T₀ + H (u₀ + (q(T₀) + q(T₁))/2) by hand, with a law q that is iterated."""

    def store(power, loss, state, step):
        new = state + step * (power + loss)
        return new, new

    plant = Function(
        store,
        {"power": "W", "loss": "W"},
        {"y": "K"},
        state=300.0,
        depends_on={"y": []},
    )
    law = Function(lambda u: -0.5 * (u - 280.0), {"u": "K"}, {"y": "W"})
    pid = Function(control, {"temperature": "K"}, {"power": "W"}, state=Pid(), sampled=True)
    links = [
        ("body.y", "pid.temperature"),
        ("pid.power", "body.power"),
        ("body.y", "law.u"),
        ("law.y", "body.loss"),
    ]
    by_loop, temperature, hand = [300.0], 300.0, Pid()
    power = hand.power(temperature, 0.0)
    for _ in range(40):
        loss = -0.5 * (temperature - 280.0)
        # T₁ (1 + H/4) = T₀ + H (u₀ + q(T₀)/2 + 280/4)
        temperature = (temperature + 0.05 * (power + loss / 2 + 70.0)) / (1 + 0.05 / 4)
        by_loop.append(temperature)
        power = hand.power(temperature, 0.05)
    units = {"body": plant, "pid": pid, "law": law}
    for order_of_units in (["body", "pid", "law"], ["pid", "law", "body"]):
        chosen = {name: units[name] for name in order_of_units}
        with Master(chosen, links, step=0.05, tolerance=1e-9) as master:
            result = master.run(2.0)
        assert result.attrs["iterations"] > 40
        assert result["body.y"].values == pytest.approx(by_loop, rel=1e-7)


def test_a_controller_that_is_not_sampled_is_solved_with_its_plant(folder):
    """P control of a store: T' = 8 (350 − T), to second order where a held power is of first."""
    law = Function(
        lambda temperature: 8.0 * (350.0 - temperature), {"temperature": "K"}, {"power": "W/m2"}
    )
    plant = make(folder, "store", [0.0], [1.0], [1.0], x=[300.0])
    errors = []
    for step in (0.02, 0.01):
        with Master({"body": plant, "pid": law}, CONTROLLED, step=step) as master:
            result = master.run(0.5)
        exact = 350.0 - 50.0 * np.exp(-8.0 * result.time.values)
        errors.append(np.abs(result["body.y"].values - exact).max())
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.1)


def test_steps_too_long_for_a_ring_with_a_function_are_warned_of(folder):
    with Master({"body": body(folder), "law": LAW}, RING, scheme="jacobi", step=0.8) as master:
        with pytest.warns(MasterWarning, match="values jump to and fro"):
            master.run(8.0)
