"""What a master must not get wrong in silence: scales, dead units, times and names."""

import numpy as np
import pytest
from impinge import Connection, Master
from python_unit import BODY, LINK, python_unit


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
