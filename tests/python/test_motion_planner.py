"""The planner of `examples/motion_planner`: its motion, its axes, and what its nozzle lays."""

import sys
from importlib.util import module_from_spec, spec_from_file_location

import numpy as np
import pytest
from conftest import ROOT
from scipy.integrate import solve_ivp
from scipy.signal import find_peaks

pytest.importorskip("pythonfmu")
FOLDER = ROOT / "examples/motion_planner"


def module(name, monkeypatch):
    monkeypatch.syspath_prepend(FOLDER)
    monkeypatch.delitem(sys.modules, "planner", raising=False)
    spec = spec_from_file_location(f"motion_planner_{name}", FOLDER / f"{name}.py")
    made = module_from_spec(spec)
    spec.loader.exec_module(made)
    return made


@pytest.fixture(scope="module")
def laid(pack, tmp_path_factory):
    """The example's module, and the strands of its machines."""
    with pytest.MonkeyPatch.context() as patch:
        run = module("run", patch)
    folder = tmp_path_factory.mktemp("planner")
    machine = run.FmuBuilder.build_FMU(FOLDER / "planner.py", dest=folder)
    unit = pack(FOLDER / "scene.toml")
    strands = {name: run.lay(unit, machine, own) for name, own in run.MACHINES.items()}
    return run, strands, run.by_code(folder / "coded")


def test_motion_keeps_its_limits_and_ends_at_rest(monkeypatch):
    planner = module("planner", monkeypatch)
    motion = planner.Motion(planner.DRAWING, 0.1, 5.0, 8e-3)
    times = np.linspace(0.0, motion.end, 4001)
    places, velocities = (np.array(of) for of in zip(*map(motion.at, times), strict=True))
    speeds = np.hypot(*velocities.T)
    assert speeds.max() == pytest.approx(0.1) and speeds[0] == pytest.approx(0.0, abs=1e-12)
    assert np.allclose(places[[0, -1]], [planner.DRAWING[0], planner.DRAWING[-1]], atol=1e-12)
    assert np.hypot(*motion.at(motion.end + 1.0)[1]) < 1e-12
    # Corners: of a right angle the corner speed, of 45° by the rule of the junction deviation.
    corner = times[np.argmin(np.hypot(*(places - planner.DRAWING[1]).T))]
    assert np.hypot(*motion.at(corner)[1]) == pytest.approx(8e-3, rel=0.1)
    sine = np.cos(np.pi / 8)
    corner = times[np.argmin(np.hypot(*(places - planner.DRAWING[2]).T))]
    most = 8e-3 * np.sqrt((np.sqrt(2) - 1) * sine / (1 - sine))
    assert np.hypot(*motion.at(corner)[1]) == pytest.approx(most, rel=0.05)
    # Along legs the speed changes by the acceleration at most.
    within = np.abs(np.diff(speeds)) / np.diff(times)
    assert within.max() < 5.0 * (1 + 1e-6)


def test_axes_ring_as_a_mass_on_a_spring(monkeypatch):
    """The closed form beside an integration of the equation of motion in time."""
    planner = module("planner", monkeypatch)
    motion = planner.Motion(planner.DRAWING, 0.1, 5.0, 8e-3)
    undamped, damping = 2 * np.pi * 40.0, 0.05

    def pulled(time, state):
        place, velocity = motion.at(time)
        off, slower = state[:2] - place, state[2:] - velocity
        return np.r_[state[2:], -(undamped**2) * off - 2 * damping * undamped * slower]

    state = np.r_[motion.start, 0.0, 0.0]
    for begin, end in zip(motion.times, [*motion.times[1:], motion.end + 0.05], strict=True):
        times = np.linspace(begin, end, 9)
        # Steps do not cross kinks; the planner's speed jumps at corners.
        inner = np.clip(times, begin + 1e-12, end - 1e-12)
        ran = solve_ivp(pulled, inner[[0, -1]], state, t_eval=inner, rtol=1e-10, atol=1e-13)
        off = ran.y[:2].T - [motion.at(time)[0] for time in inner]
        known = [motion.ringing(time, 40.0, damping) for time in inner]
        assert np.allclose(off, known, atol=1e-8)
        state = ran.y[:, -1]


def test_a_stiff_machine_lays_what_the_unit_plans_from_code(laid):
    run, strands, coded = laid
    stiff = strands["stiff"]
    for key, allowed in [("largest_deviation", 2e-7), ("deviation", 2e-8), ("volume", 1e-14)]:
        assert stiff.of(key)[-1] == pytest.approx(coded.of(key)[-1], abs=allowed)
    assert stiff.of("largest_deviation")[-1] < 10e-6
    assert np.ptp(stiff.even) < 1e-6 and np.ptp(coded.even) < 1e-6
    # The target of the scene is the drawing of the planner.
    assert run.DRAWING.length == pytest.approx(stiff.aside[0][-1], abs=1e-6)


def test_what_is_laid_rings_with_the_axes(laid):
    run, strands, _ = laid
    along, distance = strands["40 Hz"].aside
    begin, end = run.DRAWING.ends[3:5]
    own = (along > begin + 1e-3) & (along < end - 2.5e-3)
    along, distance = along[own], distance[own]
    crests = [n for sign in (1, -1) for n in find_peaks(sign * distance)[0]]
    crests = np.sort(crests)
    assert len(crests) >= 5
    root = np.sqrt(1 - run.DAMPING**2)
    half = 0.5 * run.SPEED / (run.FREQUENCY * root)
    assert np.allclose(np.mean(np.diff(along[crests])), half, rtol=0.02)
    fading = np.exp(-np.pi * run.DAMPING / root)
    heights = np.abs(distance[crests])
    assert np.allclose(heights[1:] / heights[:-1], fading, rtol=0.02)


def test_shaping_leaves_no_ringing(laid):
    run, strands, _ = laid
    along, distance = strands["40 Hz, shaped"].aside
    for begin, end in zip(run.DRAWING.ends[1:], run.DRAWING.ends[2:], strict=False):
        own = (along > begin + 1e-3) & (along < end - 1e-3)
        assert own.sum() > 50 and np.abs(distance[own]).max() < 0.5e-6
