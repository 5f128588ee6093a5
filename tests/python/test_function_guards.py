"""Refusals of wrong declarations, results and memories of functions in a master."""

import pickle
import signal
from functools import partial

import numpy as np
import pytest
from impinge import Connection, Function, FunctionError, Master, UnitError
from impinge.master import MasterError
from linear_unit import make

K, Q = {"T": "K"}, {"q": "W/m2"}


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("function_guards")


def zero(T):
    return 0.0


def kept(T, state):
    return 0.0, state


@pytest.mark.parametrize(
    ("f", "options", "told"),
    [
        (5, {}, "5 is no function"),
        (max, {}, "Python does not know the parameters of <built-in function max>"),
        (lambda T, /: T, {}, "takes `T` by position alone"),
        (lambda temperature: 0, {"inputs": {"temprature": "K"}}, "is it `temperature`?"),
        (lambda T, h: 0, {}, "takes `h`, which is none of its inputs T, nor state, time, step"),
        (lambda T, Time: 0, {}, "takes `Time`, which is none of its inputs T, nor state, time"),
        (zero, {"inputs": ["T"]}, "inputs is ['T']; a unit of measurement by name is needed"),
        (zero, {"outputs": {}}, "has no outputs"),
        (zero, {"outputs": {"T": "K"}}, "`T` is an input and an output"),
        (lambda time: 0, {"inputs": {"time": "s"}}, "`time` has a meaning of its own"),
        (lambda **each: 0, {"inputs": {"a.b": "s"}}, "'a.b' is no name of a parameter"),
        (zero, {"inputs": {"T": "k"}}, "`T`: `k` is no unit of measurement: `k` is no unit that"),
        (zero, {"inputs": {"T": 300.0}}, "`T`: 300.0 is no unit of measurement"),
        (zero, {"inputs": {"T": ("K", 0)}}, "`T` has the shape (0,) (allowed: whole numbers above"),
        (zero, {"inputs": {"T": ("K", (2, 0.5))}}, "`T` has the shape (2, 0.5)"),
        (zero, {"start": {"t": 1.0}}, "start: there is no `t`; is it `T`?"),
        (zero, {"start": {"T": "hot"}}, "start: `T` holds no real numbers"),
        (zero, {"start": {"T": np.nan}}, "start: `T` is not finite"),
        (zero, {"start": {"T": [1.0, 2.0]}}, "start: `T` has the shape (2,), not ()"),
        (zero, {"depends_on": {"Q": []}}, "depends_on: there is no output `Q`; is it `q`?"),
        (zero, {"depends_on": {"q": ["t"]}}, "depends_on: there is no input `t`; is it `T`?"),
        (kept, {}, "takes `state`; Function(…, state=…) says what it is at the start"),
        (zero, {"state": 1.0}, "takes no parameter `state`, but there is one at the start"),
        (lambda T, step: 0, {}, "takes `step`, but no parameter `state`"),
        (lambda T, before: 0, {}, "takes `before`, but no parameter `state`"),
        (zero, {"rollback": False}, "rollback=False is of functions with a `state` alone"),
        (kept, {"state": iter([1])}, None),
        (kept, {"state": (i for i in [1])}, "its state cannot be copied"),
    ],
)
def test_declarations_that_do_not_fit_are_refused(f, options, told):
    options = {"inputs": K, "outputs": Q, **options}
    if told is None:
        Function(f, **options)
        return
    with pytest.raises(FunctionError) as refused:
        Function(f, **options)
    assert told in str(refused.value)


def run(f, stop=1.0, inputs=K, outputs=Q, drives=None, **more):
    """One function alone, of a temperature 300 K + t K/s."""
    told = {key: more.pop(key) for key in ("state", "rollback", "start", "name") if key in more}
    drives = {"f.T": lambda time: 300.0 + time} if drives is None else drives
    function = Function(f, inputs, outputs, **told)
    names = [f"f.{name}" for name in outputs]
    with Master({"f": function}, step=0.1, inputs=drives, outputs=names, **more) as master:
        return master.run(stop)


def fails(T):
    raise KeyError("no such gas")


def spoilt(T):
    return np.nan if T > 300.55 else 1.0


@pytest.mark.parametrize(
    ("f", "more", "time", "variable", "told"),
    [
        (fails, {"name": "law"}, 0.0, None, "f (function law), at 0 s with T = 300: fails with"),
        (spoilt, {}, 0.6, "q", "at 0.6 s with T = 300.6: `q` is nan"),
        (lambda T: [1.0, 2.0], {}, 0.0, "q", "`q` has the shape (2,), where one number is"),
        (lambda T: T, {"outputs": {"q": ("K", 3)}}, 0.0, "q", "where the shape (3,) is declared"),
        (lambda T: [1, np.inf], {"outputs": {"q": ("K", 2)}}, 0.0, "q", "inf at place 1 of 2"),
        (lambda T: None, {}, 0.0, "q", "`q` is None, which is no real number"),
        (lambda T: 1j, {}, 0.0, "q", "`q` is 1j, which is no real number"),
        (lambda T: {}, {}, 0.0, "q", "returns no `q`"),
        (lambda T: {"Q": 1.0}, {}, 0.0, "Q", "returns `Q`, which is none of its outputs; is it"),
        (lambda T: 1.0, {"outputs": {"p": "W", "q": "W"}}, 0.0, None, "a mapping of its outputs"),
        (lambda T, state: T, {"state": 0.0}, 0.0, None, "not a pair (outputs, new state)"),
        (
            lambda T, state, step: (1.0 / step, 0.0),
            {"state": 0.0},
            0.0,
            None,
            "ZeroDivisionError: float division by zero (the step is 0 at the start; `start` values",
        ),
    ],
)
def test_what_a_function_does_wrong_names_it_and_the_time(f, more, time, variable, told):
    with pytest.raises(FunctionError) as failed:
        run(f, **more)
    assert told in str(failed.value)
    assert failed.value.function == "f" and isinstance(failed.value, UnitError)
    assert failed.value.time == pytest.approx(time) and failed.value.variable == variable
    again = pickle.loads(pickle.dumps(failed.value))
    assert str(again) == str(failed.value) and again.variable == variable


def test_what_a_function_raises_is_the_cause():
    with pytest.raises(FunctionError, match="KeyError: 'no such gas'") as failed:
        run(fails)
    assert isinstance(failed.value.__cause__, KeyError)


def test_start_values_of_outputs_spare_the_call_at_the_start():
    """A rate over a step of none has no value."""
    found = run(
        lambda T, state, step: ((T - state) / step, T), state=300.0, start={"q": 7.0}, name="rate"
    )
    assert found["f.q"].values == pytest.approx([7.0, *[1.0] * 10])


def test_inputs_without_a_value_and_wrong_names_are_refused():
    law = Function(zero, K, Q)
    for options, kind, told in [
        ({"inputs": {}}, MasterError, "f.T has no value: no connection and no `inputs` set it"),
        ({"inputs": {"f.t": 1.0}}, UnitError, "f has no variable `t`; is it `T`?"),
        ({"inputs": {"f.q": 1.0}}, MasterError, "f.q is no input, but output"),
        ({"parameters": {"f": {"h": 1}}}, MasterError, "f is a Function, which has none"),
        ({"memoryless": ["f"]}, MasterError, "a Function says itself whether it has a state"),
        ({"connections": [("f.q", "f.T")]}, MasterError, "f.q is in W/m2, f.T in K"),
        (
            {"connections": [("f.q[1]", "f.T")]},
            UnitError,
            "f has no variable `q[1]`; `q` has the shape ()",
        ),
        ({"units": {"f": zero}}, MasterError, "Function(f, inputs={…}, outputs={…}) makes a unit"),
        ({"step": None}, MasterError, "no unit proposes a step"),
    ]:
        call = {"units": {"f": Function(zero, K, Q, name="f")}, "step": 0.1} | options
        with pytest.raises(kind) as refused:
            Master(**{"inputs": {"f.T": 1.0}, **call} if "connections" not in call else call)
        assert told in str(refused.value)
    with Master({"f": law}, step=0.1, inputs={"f.T": 1.0}) as master:
        with pytest.raises(UnitError, match="`q` is no input, but an output"):
            master.units["f"]["q"] = 1.0
    # A start value is enough.
    assert run(zero, drives={}, start={"T": 300.0})["f.q"].values[-1] == 0.0


def test_inputs_that_are_not_finite_are_named():
    with Master({"f": Function(zero, K, Q)}, step=0.1, inputs={"f.T": 1.0}) as master:
        unit = master.units["f"]
        unit["T"] = np.nan
        with pytest.raises(FunctionError, match="its input `T` is nan"):
            unit["q"]


def test_memories_that_no_step_could_take_back_are_found():
    random = np.random.default_rng(0)
    with pytest.raises(FunctionError, match="`q` differs when it is called twice: a parameter"):
        run(lambda T: T + random.normal())
    sums = [0.0]

    def hidden(T, state, step):
        sums[0] += step * T
        return sums[0], state

    with pytest.raises(FunctionError, match="rollback=False calls it once a step"):
        run(hidden, state=0.0)
    assert run(hidden, state=0.0, rollback=False, scheme="jacobi")["f.q"].values[-1] > 300.0

    def noisy(T, state):
        return T + state.normal(), state

    one, other = (run(noisy, state=np.random.default_rng(3))["f.q"].values for _ in range(2))
    assert np.array_equal(one, other) and np.ptp(one) > 1.5


@pytest.mark.parametrize("options", [{}, {"scheme": "gauss-seidel", "adaptive": True}])
def test_functions_without_rollback_are_refused_where_steps_are_taken_again(folder, options):
    store = make(folder, "store", [0.0], [1.0], [1.0], x=[300.0])
    calls = []

    def logged(T, state, step):
        calls.append(step)
        return 2.0 * (280.0 - T), state

    once = Function(logged, {"T": None}, {"q": None}, state=[], rollback=False)
    ring = [("s.y", "f.T"), ("f.q", "s.u")]
    with pytest.raises(MasterError) as refused:
        Master({"s": store, "f": once}, ring, step=0.1, **options)
    assert "f: " in str(refused.value) and "rollback=False" in str(refused.value)
    assert ("adaptive=True" if options else 'scheme="iterate"') in str(refused.value)
    assert calls == []
    for scheme in ("jacobi", "gauss-seidel"):
        calls.clear()
        with Master({"s": store, "f": once}, ring, step=0.1, scheme=scheme) as master:
            master.run(1.0)
        assert calls == pytest.approx([0.0, *[0.1] * 10])  # once at the start and once a step


def test_functions_whose_outputs_nobody_reads_are_called_once_a_step():
    """A log, say, at the start and at the end of each step."""
    rows = []

    def log(T, time, state):
        rows.append((time, T))
        return 0.0, state

    once = Function(log, K, Q, state=rows, rollback=False)
    with Master({"f": once}, step=0.25, inputs={"f.T": lambda time: 300.0 + time}) as master:
        master.run(1.0)
    assert rows == [(time, 300.0 + time) for time in (0.0, 0.25, 0.5, 0.75, 1.0)]


def test_steps_that_a_function_refuses_are_shortened(folder):
    """x' = −40 √x from 1, by a law that has no value below 0: x = (1 − 20 t)²."""
    store = make(folder, "pool", [0.0], [1.0], [1.0], x=[1.0])
    refused = []

    def outflow(x):
        if x < 0.0:
            refused.append(x)
            raise ValueError(f"there is no level of {x}")
        return -40.0 * x**0.5

    law = Function(outflow, {"x": None}, {"q": None})
    units, ring = {"s": store, "f": law}, [("s.y", "f.x"), ("f.q", "s.u")]
    with Master(units, ring, step=0.2, adaptive=True, tolerance=1e-4) as master:
        result = master.run(0.04)
    assert refused and result.attrs["rejected"] > 0
    exact = (1.0 - 20.0 * result.time.values) ** 2
    assert np.abs(result["s.y"].values - exact).max() < 1e-3


def test_a_step_that_is_still_too_long_names_what_the_function_raised(folder):
    store = make(folder, "rising", [0.0], [1.0], [1.0], x=[0.3])

    def limited(x):
        if x > 0.5:
            raise ValueError("beyond the table")
        return 1.0

    law = Function(limited, {"x": None}, {"q": None})
    options = {"step": 0.05, "adaptive": True, "least_step": 1e-3, "tolerance": 1e-2}
    with Master({"s": store, "f": law}, [("s.y", "f.x"), ("f.q", "s.u")], **options) as master:
        with pytest.raises(MasterError, match="still too long .*beyond the table") as failed:
            master.run(1.0)
    assert isinstance(failed.value.__cause__, FunctionError)


def test_functions_say_what_they_are():
    law = Function(partial(lambda T, h: h * T, h=3.0), {"T": ("K", (2, 3))}, {"q": None})
    assert repr(law) == "<impinge.Function lambda(T[2,3] [K]) -> q [?]>"
    pid = Function(kept, K, Q, state=0.0, rollback=False, sampled=True, name="pid")
    assert repr(pid) == (
        "<impinge.Function pid(T [K]) -> q [W/m2], with a state, without rollback, sampled>"
    )
    assert repr(pid.open("left", 2.0)) == "<impinge.FunctionUnit left (function pid) at 2.0 s>"


def store(folder):
    """A store of 1 J/K that takes a heat flow and gives its temperature."""
    told = {"u_unit": "W", "y_unit": "K", "x": [400.0]}
    return make(folder, "store", [0.0], [1.0], [1.0], **told)


RING = [("body.y", "law.T"), ("law.q", "body.u")]


def coupled(folder, f, stop=1.0, scheme="iterate", outputs=None, **options):
    law = Function(f, {"T": "K"}, outputs or {"q": "W"}, **options)
    units = {"body": store(folder), "law": law}
    with Master(units, RING, step=0.05, scheme=scheme) as master:
        return master.run(stop)


@pytest.mark.parametrize("scheme", ["jacobi", "gauss-seidel"])
def test_a_false_declaration_of_no_dependence_is_found(folder, scheme):
    with pytest.raises(FunctionError, match="`q` follows inputs that `depends_on` does not name"):
        coupled(folder, lambda T: 2.0 * (300.0 - T), scheme=scheme, depends_on={"q": []})


@pytest.mark.parametrize("first", [3, 20, 50])
def test_memory_that_shows_late_is_found(folder, first):
    calls = []

    def law(T):
        calls.append(T)
        return 2.0 * (300.0 - T) + (1e-3 * len(calls) if len(calls) >= first else 0.0)

    with pytest.raises(FunctionError, match="`q` differs when it is called twice"):
        coupled(folder, law, stop=3.0)


def test_an_exception_that_no_other_input_would_spare_ends_the_run(folder):
    calls = []

    def law(T):
        calls.append(T)
        if len(calls) == 20:
            raise KeyError("table")
        return 2.0 * (300.0 - T)

    with pytest.raises(FunctionError, match="fails with KeyError: 'table'"):
        coupled(folder, law)


@pytest.fixture
def default_interrupt():
    """The handler of programs in the foreground; those in the background ignore the signal."""
    handler = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, handler)


def test_ctrl_c_ends_a_run_after_a_step_and_another_goes_on(folder, default_interrupt):
    pressed = []

    def law(T, time):
        if time > 0.5 and not pressed:
            pressed.append(time)
            signal.raise_signal(signal.SIGINT)
        return 2.0 * (300.0 - T)

    units = {"body": store(folder), "law": Function(law, {"T": "K"}, {"q": "W"})}
    with Master(units, RING, step=0.05) as master:
        with pytest.raises(KeyboardInterrupt):
            master.run(1.0)
        assert 0.5 < master.time < 0.7
        result = master.run(1.0)
    whole = coupled(folder, lambda T: 2.0 * (300.0 - T))
    assert result["body.y"].values == pytest.approx(whole["body.y"].values, rel=1e-12)
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"units": [1]}, "units is \\[1\\]; a mapping of names to units is needed"),
        ({"units": {"": 1}}, "names of units are texts without dots"),
        ({"outputs": "body.y"}, "outputs is 'body.y'; a list of names is needed"),
        ({"inputs": {"body.u": "warm"}}, "inputs: body.u is 'warm'; a number or a function"),
        ({"inputs": {"body.u": np.nan}}, "inputs: body.u is nan, which is not finite"),
    ],
)
def test_wrong_arguments_of_masters_are_named(folder, options, told):
    units = options.pop("units", {"body": store(folder)})
    with pytest.raises(MasterError, match=told), Master(units, step=0.1, **options) as master:
        master.run(0.1)


@pytest.mark.parametrize(
    ("mapped", "told"),
    [
        (lambda q: 1 / 0, "the map of law.q -> body.u fails with ZeroDivisionError"),
        (lambda q: "much", "the map of law.q -> body.u gives 'much', which is no real numbers"),
    ],
)
def test_maps_that_fail_are_named(folder, mapped, told):
    law = Function(lambda T: 1.0, {"T": "K"}, {"q": "W"})
    links = [("body.y", "law.T"), Connection("law.q", "body.u", map=mapped)]
    with pytest.raises(MasterError, match=told):
        with Master({"body": store(folder), "law": law}, links, step=0.1) as master:
            master.run(0.1)
