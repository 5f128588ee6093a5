"""Slopes by central differences: of steep, kinked, noisy, straight and resting responses."""

import warnings

import numpy as np
import pytest
from impinge import Unit, step_sensitivity
from impinge.linear.differences import slopes

CHILLED = """
name = "Chilled"
stop_time = 10.0
step = 1.0

[body.p]
kind = "solid"
shape = { box = [20e-3, 20e-3, 10e-3] }
initial_temperature = 300.0
stress_free_temperature = 300.0

[body.p.material]
model = "thermoelastic"
density = 2500.0
specific_heat = 800.0
conductivity = 200.0
young = 70e9
poisson = 0.22
expansion = 9e-6
toughness = 0.75e6
weibull.modulus = 10.0
weibull.strength = 100e6
weibull.volume = 1e-9
weibull.slow_growth = { exponent = 16.0, constant = 3.4e12 }

[body.p.faces]
left = { roller = true }
right = { roller = true }
front = { roller = true }
bottom = { roller = true, temperature = 300.0 }
top = { temperature = 300.0 }

[[flaw]]
name = "g"
in = "p"
at = [0.0, 0.0, 0.0]
normal = [1.0, 0.0, 0.0]
depth = 20e-6
gives = ["stress_intensity"]
growth = { exponent = 16.0, speed = 6e-3 }
"""
CHILL = ["p.top.temperature", "p.bottom.temperature"]


@pytest.fixture(scope="module")
def chilled(tmp_path_factory):
    """A plate between rollers, whose risk of failure rises by the tenth power of its chill."""
    path = tmp_path_factory.mktemp("chilled") / "chilled.toml"
    path.write_text(CHILLED)
    return path


def found(function, at=280.0, change=2.8):
    """The slope of a function of the input, its error and whether it is a line."""
    ran = slopes(lambda by: np.array([function(at + by)]), at, change, at / 2.0)
    return ran.value[0], ran.error[0], bool(ran.is_linear[0])


def power(exponent):
    """A risk that falls to nothing at 300, and its slope at 280."""
    return lambda t: 1e-6 * (max(300.0 - t, 0.0) / 20.0) ** exponent, -1e-6 * exponent / 20.0


@pytest.mark.parametrize("exponent", [3.0, 10.0, 16.0, 50.0])
def test_steep_outputs_have_their_slope(exponent):
    function, slope = power(exponent)
    value, error, is_linear = found(function)
    assert value == pytest.approx(slope, rel=1e-6) and not is_linear
    assert abs(value - slope) <= error < 1e-6 * abs(slope)


def test_outputs_that_saturate_have_their_slope():
    value, error, _ = found(lambda t: -np.expm1(-min(((300.0 - t) / 20.0) ** 50, 1e3)))
    assert value == pytest.approx(-2.5 / np.e, rel=1e-7) and error < 1e-6


@pytest.mark.parametrize("distance", [0.01, 0.1, 1.0])
def test_changes_shrink_until_kinks_and_jumps_are_out_of_reach(distance):
    assert found(lambda t: abs(t - 280.0 - distance))[:2] == pytest.approx((-1.0, 0.0), abs=1e-9)
    for output in (lambda t: max(t - 280.0 - distance, 0.0), lambda t: t > 280.0 + distance):
        value, error, _ = found(lambda t, output=output: float(output(t)))
        assert value == 0.0 and error < 1e-9


def test_kinks_and_jumps_at_the_input_are_in_the_error():
    value, error, _ = found(lambda t: abs(t - 280.0))
    assert value == 0.0 and error == pytest.approx(1.0, rel=1e-3)
    value, error, _ = found(lambda t: max(t - 280.0, 0.0))
    assert value == pytest.approx(0.5) and error == pytest.approx(0.5, rel=1e-3)
    value, error, _ = found(lambda t: float(t > 280.0))
    assert error > abs(value)


@pytest.mark.parametrize("level", [1e-2, 1e-4, 1e-6, 1e-9])
def test_errors_cover_noise(level):
    """Of 200 random noises, the error covers what a slope misses in at least 190, five times the
    error in all; and it is no more than 100 times that of a difference over the first change."""
    ratios, errors = [], []
    for seed in range(200):
        random = np.random.default_rng(seed)
        value, error, _ = found(lambda t, r=random: np.sin(t / 50.0) + level * r.normal())
        ratios.append(abs(value - np.cos(280.0 / 50.0) / 50.0) / error)
        errors.append(error)
    assert np.quantile(ratios, 0.95) < 1.0 and max(ratios) < 5.0
    assert np.median(errors) < 100.0 * level / 2.8


@pytest.mark.parametrize("width", [0.137, 0.0137, 0.00137])
def test_steps_of_a_solver_that_keeps_its_solution_are_noise(width):
    value, error, _ = found(lambda t: 2.0 * width * np.floor(t / width + 0.3))
    assert abs(value - 2.0) <= error < 2.0 * width


def test_lines_are_exact_and_constants_have_no_slope():
    value, error, is_linear = found(lambda t: 300.0 + 1e-5 * t)
    assert is_linear and abs(value - 1e-5) <= error < 1e-11
    assert found(lambda t: 0.0) == (0.0, 0.0, True)
    value, error, is_linear = found(lambda t: (t - 280.0) ** 2)
    assert value == 0.0 and error < 1e-9 and not is_linear


def test_sensitivities_of_a_risk_are_its_central_differences(chilled, caplog):
    """The unit is never taken to temperatures that it warns of."""
    names = ["p.present_failure_risk", "p.failure_risk", "g.stress_intensity"]
    with Unit(chilled) as unit, warnings.catch_warnings():
        warnings.simplefilter("error")
        unit.set(dict.fromkeys(CHILL, 280.0))
        unit.step(1.0)
        caplog.clear()
        sensitivity = step_sensitivity(unit, CHILL[:1], names, 1.0)
        assert not any("is plausible" in each.message for each in caplog.records)
        with unit.state() as start:
            ends = []
            for change in (0.01, -0.01):
                unit[CHILL[0]] = 280.0 + change
                unit.step(1.0)
                ends.append(unit.get(names))
                unit.restore(start)
    expected = (ends[0] - ends[1]) / 0.02
    assert sensitivity.matrix[:, 0] == pytest.approx(expected, rel=1e-4) and expected[0] < 0.0
    assert np.all(sensitivity.error[:, 0] <= 1e-6 * np.abs(expected))


def test_slopes_that_are_lost_in_their_error_are_warned_of(chilled):
    """At 300 K the flaw begins to open: there is no slope."""
    with Unit(chilled) as unit:
        unit.step(1.0)
        with pytest.warns(UserWarning, match=r"∂\(g.stress_intensity\)/∂\(p.top.temp.* exceeds"):
            step_sensitivity(unit, CHILL[:1], ["g.stress_intensity"], 1.0)
