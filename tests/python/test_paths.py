"""Paths of nozzles: geometry, runs that branch off, searches, what is kept, G-code."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
from impinge import StudyError, Unit, gcode
from impinge.study import path, paths
from impinge.study.corrections import Line, Waypoints, nozzle
from impinge.study.optimisers import Outcome, gauss_newton, swarm
from impinge.study.paths import _Study
from impinge.study.printing import Printer

SCENE = """
name = "Hairpin"
stop_time = 1.0
step = 0.02
[body.ink]
kind = "filament"
fluid = { density = 800.0, viscosity = 0.1, specific_heat = 2e3, conductivity = 0.0 }
nozzle = { diameter = 0.7e-3, height = 4.5e-3, temperature = 293.15, flow = 7.7e-9 }
path = "input"
most = 2e-8
spacing = 0.5e-3
[[target]]
of = "ink"
line = HAIRPIN
"""
ANGLES = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 17)
BEND = np.c_[8e-3 + 1.5e-3 * np.cos(ANGLES), 1.5e-3 + 1.5e-3 * np.sin(ANGLES)]
HAIRPIN = [[0.0, 0.0], *BEND.tolist(), [0.0, 3e-3]]
SCENE = SCENE.replace("HAIRPIN", str(HAIRPIN))
SPEED = 20e-3
WHERE = {"region": (0.3, 0.8), "speed": SPEED}


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    path = tmp_path_factory.mktemp("paths") / "hairpin.toml"
    path.write_text(SCENE)
    return path


PARTICLES = """
name = "Corner"
stop_time = 0.5
step = 0.02
[body.ink]
kind = "filament"
method = "particles"
fluid = { density = 1000.0, viscosity = 10.0, specific_heat = 2e3, conductivity = 0.0 }
nozzle = { diameter = 0.8e-3, height = 0.8e-3, temperature = 293.15, flow = 1e-8 }
path = "input"
most = 6e-9
spacing = 0.2e-3
[[target]]
of = "ink"
line = [[0.0, 0.0], [2.4e-3, 0.0], [2.4e-3, 2.4e-3]]
"""


@pytest.fixture(scope="module")
def particles(tmp_path_factory):
    path = tmp_path_factory.mktemp("particles") / "corner.toml"
    path.write_text(PARTICLES)
    return path


@pytest.fixture(scope="module")
def found(scene, tmp_path_factory):
    """A path by Gauss–Newton, and the folder of its runs."""
    folder = tmp_path_factory.mktemp("runs")
    found = path(scene, by="gauss-newton", simulations=60, waypoints=4, folder=folder, **WHERE)
    return found, folder


def test_offsets_move_a_path_along_its_normal():
    """Between waypoints they are monotone; at a corner the path connects both normals."""
    line = Line([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])
    ranges = Waypoints(((0.25, 0.25), (0.75, 0.75)), ((-0.2, 0.2), (-0.2, 0.2)), (0.1, 0.9))
    assert np.array_equal(nozzle(line, ranges, ranges.naive(), 0.1, 0.0)[:11, 1], np.zeros(11))
    places = nozzle(line, ranges, np.array([0.5, 0.5, 1.0, 0.5]), 0.01, 0.0)
    on_first = places[places[:, 0] < 0.94]
    assert np.isclose(on_first[:, 1].max(), 0.2, atol=1e-3) and (places[:20, 1] == 0.0).all()
    rises = np.diff(on_first[on_first[:, 0] < 0.5, 1])
    assert (rises >= 0.0).all()
    steps = np.hypot(*np.diff(places, axis=0).T)
    assert (steps[:-1] <= 0.01 + 1e-12).all() and np.allclose(places[-1], [1.0, 1.0])
    beyond = nozzle(line, ranges, ranges.naive(), 0.01, 0.3)
    assert np.allclose(beyond[-1], [1.0, 1.3])


def test_distances_are_signed_and_those_of_the_nearest_part():
    line = Line([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0]])
    way, distance = line.beside(np.array([[1.0, 0.3], [1.0, -0.3], [2.5, 1.0], [2.3, -0.4]]))
    assert np.allclose(way, [1.0, 1.0, 3.0, 2.0])
    assert np.allclose(distance, [0.3, -0.3, -0.5, -0.5])


@pytest.mark.parametrize("of", ["scene", "particles"])
def test_a_run_from_a_saved_state_is_that_from_the_start(of, request):
    study = _Study(request.getfixturevalue(of), None, SPEED, None, None)
    ranges = Waypoints(((0.5, 0.5),), ((-1e-3, 1e-3),), (0.4, 0.9))
    naive, other = (
        nozzle(study.line, ranges, np.array([0.5, offset]), study.spacing, 0.0)
        for offset in (0.5, 0.4)
    )
    printers = [Printer(study.job(1.0)) for _ in range(2)]
    try:
        printers[0].run(naive, keep=True)
        branched, whole = (printer.run(other) for printer in printers)
        again = printers[0].run(naive)
    finally:
        for printer in printers:
            printer.close()
    assert branched.steps < 0.75 * whole.steps
    assert np.array_equal(branched.numbers()[:-1], whole.numbers()[:-1])
    assert np.array_equal(branched.distances, whole.distances)
    assert again.steps < 5 and again.part == 1.0


def assert_laid(scene, best, steps):
    """A unit that follows the reported path in the given steps [s] gives the reported values."""
    with Unit(scene) as unit:
        unit["ink.nozzle_z"] = best.height
        for place, after, step in zip(best.places, best.places[1:], steps, strict=False):
            unit["ink.nozzle_x"], unit["ink.nozzle_y"] = place
            rates = dict(zip(["ink.nozzle_x", "ink.nozzle_y"], (after - place) / step, strict=True))
            unit.set_input_derivatives({name: [rate] for name, rate in rates.items()})
            unit.step(step)
        assert np.isclose(unit["ink.largest_deviation"], best.best.largest, rtol=1e-6)
        assert np.isclose(unit["ink.gap"], best.best.gap, rtol=1e-6)


def test_few_runs_find_the_path_of_a_hairpin(found, scene):
    best, _ = found
    assert best.simulations <= 60 and best.ratio > 7.3
    assert best.best.largest < 0.15 * best.diameter and best.best.gap < 0.1 * best.diameter
    # Objectives of coarser segments are no best ones of finer ones.
    history = best.history
    assert history.best[-1] == best.best.objective(best.diameter)
    fine = history.factor.values == 1.0
    assert history.best.values[fine][0] == history.objective.values[fine][0]
    # The report has the values that the unit gives on that path.
    steps = np.diff(best.times)
    assert_laid(scene, best, steps)


def test_coarse_runs_save_fine_ones(scene):
    """A search that begins with coarse segments needs fewer runs of fine ones to a tenth of the
    drawing's objective; and as many runs take fewer steps, as those of coarse ones are longer."""
    needed, steps, ratios = {}, {}, {}
    for coarse in (1.0, 2.0):
        settings = {"by": "gauss-newton", "simulations": 60, "waypoints": 4, "coarse": coarse}
        found = path(scene, **settings, **WHERE)
        history = found.history
        fine = history.factor.values == 1.0
        assert set(history.factor.values) == {1.0, coarse}
        assert np.sum(~fine) == (0 if coarse == 1.0 else 30)
        naive = history.objective.values[fine][0]
        reached = np.flatnonzero(fine & (history.objective.values < 0.1 * naive))[0]
        needed[coarse] = int(fine[: reached + 1].sum())
        steps[coarse] = float(np.sum(history.share_of_steps.values / history.factor.values))
        ratios[coarse] = found.ratio
    assert needed[2.0] < 0.5 * needed[1.0], needed
    assert steps[2.0] < 0.85 * steps[1.0], steps
    assert ratios[2.0] > 0.5 * ratios[1.0] > 7.3, ratios


def test_bad_members_are_stopped_early(scene, monkeypatch):
    """A run ends with the step in which it is off by the limit; a search takes fewer steps by it,
    and no run that was given up is its best."""
    study = _Study(scene, None, SPEED, None, None)
    ranges = Waypoints(((0.5, 0.5),), ((-2e-3, 2e-3),), (0.3, 0.9))
    bad = nozzle(study.line, ranges, np.array([0.5, 1.0]), study.spacing, 0.0)
    printer = Printer(study.job(1.0))
    try:
        whole, stopped = printer.run(bad), printer.run(bad, give_up=1e-3)
    finally:
        printer.close()
    assert whole.part == 1.0 and whole.largest > 1.2e-3
    assert stopped.part < 0.7 and stopped.steps < 0.7 * whole.steps
    assert 1e-3 < stopped.largest < 1.2e-3
    assert stopped.objective(study.diameter) > 1e-3 / study.diameter

    settings = {"by": "swarm", "simulations": 30, "size": 8, "coarse": 1.0, **WHERE}
    found = path(scene, **settings)
    monkeypatch.setattr(paths, "_GIVE_UP", np.inf)
    patient = path(scene, **settings)
    shares = [one.history.share_of_steps.values for one in (found, patient)]
    # Behind the bend's beginning, 0.77 of the steps are left.
    assert np.all(shares[1][3:] > 0.7)
    assert shares[0][3:].sum() < 0.75 * shares[1][3:].sum()
    assert found.best.part == 1.0 and found.ratio > 1.2


def test_particles_are_at_most_as_coarse_as_the_scene_allows(particles):
    """A quarter of the nozzle's diameter, and not above its outlet; the nozzle moves from place to
    place by half of its diameter."""
    text = particles.read_text()
    for spacing, height, coarsest in [
        ("spacing = 0.1e-3", 0.8e-3, 0.2e-3),
        ("spacing = 0.15e-3", 0.8e-3, 0.2e-3),
        ("spacing = 0.15e-3", 0.16e-3, 0.16e-3),
        ("spacing = 0.2e-3", 0.8e-3, 0.2e-3),
        ("", 0.8e-3, 0.2e-3),
    ]:
        changed = text.replace("spacing = 0.2e-3", spacing)
        particles.with_name("other.toml").write_text(
            changed.replace("height = 0.8e-3", f"height = {height}")
        )
        study = _Study(particles.with_name("other.toml"), None, SPEED, None, None)
        assert study.spacing == pytest.approx(0.4e-3)
        factor = study.coarser(2.0)
        folder = Path(study.job(factor).folder)
        body = tomllib.loads((folder / "resources/scene.toml").read_text())["body"]["ink"]
        assert body["spacing"] == pytest.approx(coarsest)
    # A scene at its limit has runs of its own particles alone.
    study = _Study(particles, None, SPEED, None, None)
    assert study.coarser(2.0) == 1.0 and study.coarser(1.0) == 1.0


def test_a_path_of_particles_is_found(particles):
    """A few runs: the report has the values that the unit gives on the best path."""
    best = path(
        particles,
        by="swarm",
        speed=SPEED,
        region=(0.2, 0.9),
        waypoints=[((0.5, 0.5), (-0.8e-3, 0.8e-3))],
        simulations=8,
        size=3,
        spread=0.1,
    )
    assert set(best.history.factor.values) == {1.0} and best.simulations == 8
    assert best.ratio > 1.02
    assert 0.0 < best.naive.lag < 1e-3
    # Of the same durations to rounding, on which the iterations of particles depend.
    steps = np.hypot(*np.diff(best.places, axis=0).T) / SPEED
    assert_laid(particles, best, steps)


def test_finished_runs_are_not_repeated(found, scene, monkeypatch):
    best, folder = found

    def refuse(*_, **__):
        raise AssertionError("a run is repeated")

    monkeypatch.setattr(Printer, "run", refuse)
    again = path(scene, by="gauss-newton", simulations=60, waypoints=4, folder=folder, **WHERE)
    assert np.array_equal(again.places, best.places) and again.best.mean == best.best.mean
    assert again.history.equals(best.history)


def test_processes_change_nothing(scene):
    settings = {"by": "swarm", "simulations": 14, "size": 4, "coarse": 1.0, **WHERE}
    one, two = (path(scene, processes=n, **settings) for n in (1, 2))
    assert np.array_equal(one.history.objective, two.history.objective)


def test_a_generation_of_cma_improves_the_path(scene):
    pytest.importorskip("cma")
    best = path(scene, by="cma", simulations=60, waypoints=2, **WHERE)
    assert best.ratio > 1.5


def test_another_target_takes_the_place_of_the_scenes(scene):
    line = [[0.0, 0.0], [8e-3, 0.0], [8e-3, 5e-3]]
    best = path(scene, line, by="gauss-newton", simulations=40, speed=SPEED, region=(0.3, 0.9))
    assert np.allclose(best.along[0], [0.0, 0.0]) and np.isclose(best.along[-1, 0], 8e-3)
    assert best.ratio > 2.0


def test_searches_minimise_a_bowl():
    """A swarm of Clerc and Kennedy contracts; Gauss–Newton solves a linear problem in one step."""
    goal = np.array([0.3, 0.8])

    def outcome(unknowns):
        return Outcome(float(np.sum((unknowns - goal) ** 2)), unknowns - goal)

    for search, rounds, most in [
        (swarm(np.full(2, 0.5), size=8, spread=0.3, seed=1), 60, 1e-8),
        (gauss_newton(np.full(2, 0.5), size=3, spread=0.0, seed=0), 6, 1e-7),
    ]:
        asked, best = next(search), np.inf
        for _ in range(rounds):
            outcomes = [outcome(unknowns) for unknowns in asked]
            best = min(best, *(one.objective for one in outcomes), best)
            asked = search.send(outcomes)
        assert best < most


def test_code_that_is_written_lays_the_same_strand(found, scene, tmp_path):
    best, _ = found
    best.write_gcode(tmp_path / "best.gcode")
    text = scene.read_text().replace('path = "input"', 'path = { file = "best.gcode" }')
    by_code = tmp_path / "code.toml"
    by_code.write_text(text.replace(", flow = 7.7e-9", ""))
    table = ", ".join(f"{key} = {values}" for key, values in best.table().items())
    by_table = tmp_path / "table.toml"
    text = scene.read_text().replace('path = "input"', f"path = {{ {table} }}")
    by_table.write_text(text.replace(", flow = 7.7e-9", ""))
    for source in (by_code, by_table):
        with Unit(source) as unit:
            for _ in range(10):
                unit.step(0.1 * best.times[-1] * (1 + 1e-9))
            largest = unit["ink.largest_deviation"]
            assert np.isclose(largest, best.best.largest, rtol=1e-3, atol=1e-7)
            assert np.isclose(unit["ink.volume"], best.flow * best.times[-1], rtol=1e-6)
    # A changed file makes another unit.
    code = (tmp_path / "best.gcode").read_text()
    (tmp_path / "best.gcode").write_text(code.rsplit("G1", 1)[0])
    with Unit(by_code) as unit:
        unit.step(1.1 * best.times[-1])
        assert unit["ink.volume"] < 0.999 * best.flow * best.times[-1]


def test_what_makes_no_sense_is_refused(scene, tmp_path):
    for settings, error, words in [
        ({"by": "luck"}, ValueError, "allowed: 'cma', 'swarm', 'gauss-newton'"),
        ({"target": "glue"}, StudyError, "no filament glue"),
        ({"region": (0.5, 0.2)}, ValueError, "0 <= low < high <= 1"),
        ({"waypoints": [((0.0, 0.1), (0.0, 1e-3))]}, ValueError, "parts within"),
        ({"waypoints": 0}, ValueError, "one or more"),
        ({"simulations": 2}, ValueError, "3 or more"),
        ({"processes": 0}, ValueError, "1 or more"),
        ({"size": 1}, ValueError, "2 or more"),
        ({"size": 10**9}, ValueError, "whole numbers"),
        ({"processes": 1.5}, ValueError, "whole numbers"),
        ({"seed": -1}, ValueError, "seed = -1"),
        ({"waypoints": 10**6}, ValueError, "waypoints = 1000000"),
        ({"waypoints": 3.5}, ValueError, "whole numbers"),
        ({"waypoints": [((0.0, 1.0), (1,))]}, ValueError, "ranges of a part"),
        ({"region": ()}, ValueError, "two parts"),
        ({"speed": True}, ValueError, "speed = True"),
        ({"spacing": 1e30}, ValueError, "a part of the target"),
        ({"target": []}, ValueError, "two or more places"),
        ({"target": [[0.0, 0.0], [1e-30, 0.0]]}, ValueError, "apart"),
        ({"target": [[0.0, 0.0], [0.0, 0.0], [1e-2, 0.0]]}, ValueError, r"target\[1\] .* repeats"),
        ({"target": [[0, 0], [1e-2, 0], [1e-2, 1e-12]]}, ValueError, r"repeats target\[1\]"),
        ({"coarse": float("nan")}, ValueError, "1 or more"),
        ({"run_out": -1e-3}, ValueError, "0 or more"),
        ({"flow": 0.0}, ValueError, "above 0"),
        ({"spread": float("nan")}, ValueError, "spread = nan .* above 0"),
        ({"spacing": "1 mm"}, ValueError, "spacing = '1 mm' .* above 0"),
    ]:
        with pytest.raises(error, match=words):
            path(scene, **{"by": "swarm", **WHERE, **settings})
    other = tmp_path / "other.toml"
    other.write_text(SCENE.split("[[target]]")[0])
    with pytest.raises(StudyError, match=r"no \[\[target\]\]"):
        path(other, by="swarm", **WHERE)
    places, times = np.zeros((3, 3)), np.arange(3.0)
    for wrong, words in [
        ((places[:, :2], times, times), "shapes"),
        ((places, -times, times), "ascend"),
        ((places, times, -times), "negative"),
    ]:
        with pytest.raises(ValueError, match=words):
            gcode.write(tmp_path / "a.gcode", *wrong)


@pytest.mark.parametrize("volume", [1e-9, 1e-15, 1e-20])
def test_strands_of_any_size_keep_their_flow_and_speed(tmp_path, volume):
    """Equal volumes on 2000 pieces of 1 µm, which take 100 s each."""
    places = np.c_[1e-6 * np.arange(2001), np.zeros((2001, 2))]
    file = tmp_path / "a.gcode"
    gcode.write(file, places, 100.0 * np.arange(2001), np.full(2001, volume))
    moves = [line.split() for line in file.read_text().splitlines() if line.startswith("G1")]
    fed = np.array([float(words[4][1:]) for words in moves])
    comes = 1e-3 * np.diff(fed, prepend=0.0) * 0.25 * np.pi * 1.75e-3**2
    assert comes == pytest.approx(np.full(2000, volume), rel=2e-6)
    assert {words[5] for words in moves} == {"F0.0006000000"}


def test_a_path_that_begins_late_waits_and_none_begins_before_zero(scene, tmp_path):
    places = np.array([[0.0, 0.0, 4.5e-3], [2e-3, 0.0, 4.5e-3]])
    gcode.write(tmp_path / "late.gcode", places, np.array([0.3, 0.5]), np.array([0.0, 2e-9]))
    assert "\nG4 P300.000000\nG1" in (tmp_path / "late.gcode").read_text()
    text = scene.read_text().replace('path = "input"', 'path = { file = "late.gcode" }')
    late = tmp_path / "late.toml"
    late.write_text(text.replace(", flow = 7.7e-9", ""))
    with Unit(late) as unit:
        volumes = []
        for _ in range(6):
            unit.step(0.1)
            volumes.append(unit["ink.volume"])
    assert np.allclose(volumes, [0.0, 0.0, 0.0, 1e-9, 2e-9, 2e-9], rtol=1e-6, atol=1e-18)
    with pytest.raises(ValueError, match=r"times begin at -0.1 s \(allowed: 0 s and later\)"):
        gcode.write(tmp_path / "a.gcode", places, np.array([-0.1, 0.5]), np.zeros(2))


def test_a_wait_is_written_where_places_differ_by_rounding_alone(tmp_path):
    places = np.array([[0.0, 0.0, 0.0], [0.1 + 0.2, 0.0, 0.0], [0.3, -1e-17, 0.0]])
    gcode.write(tmp_path / "a.gcode", places, np.arange(3.0), np.zeros(3))
    *_, move, wait = (tmp_path / "a.gcode").read_text().splitlines()
    assert move == "G0 X300.000000 Y0.000000 Z0.000000 F18000.000000"
    assert wait == "G4 P1000.000000"
