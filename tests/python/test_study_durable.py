"""Studies that are killed, interrupted, or run on a cluster."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from impinge import Study
from impinge.study import LatinHypercube, over_time
from impinge.study.journal import Finished, Journal, read
from slab import AREA, SCENE

PACKAGE = Path(__file__).resolve().parents[2] / "python"
ROWS = 60

# The same study in another process, whose rows wait a little so that it can be hit half-way.
SCRIPT = """
import sys, time
from impinge import Study
from impinge.study import LatinHypercube, over_time

def flux(t, p):
    if t == 0.0:
        time.sleep(0.03)
    return p["plate.conductivity"] * 10.0

study = Study(
    sys.argv[1],
    {"plate.conductivity": (5.0, 20.0), "plate.density": (3e3, 5e3)},
    inputs={"plate.top.flux": flux},
    outputs=["top.temperature", over_time("plate.heat_in")],
    sampler=LatinHypercube(60, seed=1),
)
"""


def study_of(scene):
    """The study of the script, in this process."""
    names = {}
    given, sys.argv = sys.argv, ["test", str(scene)]
    try:
        exec(SCRIPT, names)
    finally:
        sys.argv = given
    return names["study"]


def start(scene, folder):
    """Runs the script's study in a process of its own, and waits for its first rows."""
    # Shells let what they start in the background ignore Ctrl-C.
    heeded = "import signal\nsignal.signal(signal.SIGINT, signal.default_int_handler)\n"
    script = heeded + SCRIPT + "study.run(2, folder=sys.argv[2])\n"
    process = subprocess.Popen(
        [sys.executable, "-c", script, scene, folder],
        env={**os.environ, "PYTHONPATH": str(PACKAGE), "STUDY": str(folder)},
        stderr=subprocess.PIPE,
        start_new_session=True,
    )
    journal = folder / "rows.jsonl"
    limit = time.monotonic() + 30.0
    while not (journal.is_file() and journal.read_bytes().count(b"\n") >= 10):
        assert time.monotonic() < limit and process.poll() is None, process.stderr.read().decode()
        time.sleep(0.005)
    return process


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "slab.toml"
    path.write_text(SCENE)
    return path


def keys(folder):
    lines = (folder / "rows.jsonl").read_text().splitlines()
    return [json.loads(line)["key"] for line in lines]


def test_a_study_goes_on_after_it_was_killed(scene, tmp_path):
    folder = tmp_path / "study"
    process = start(scene, folder)
    assert len(processes_of(folder)) == 3
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    limit = time.monotonic() + 10.0
    while processes_of(folder):  # workers end by themselves
        assert time.monotonic() < limit, processes_of(folder)
        time.sleep(0.05)
    with open(folder / "rows.jsonl", "ab") as journal:
        journal.write(b'{"key": "torn')
    study = study_of(scene)
    done = read(folder / "rows.jsonl")
    assert 10 <= len(done) < ROWS
    partial = study.results(folder)
    assert (partial.status == 2).sum() == ROWS - len(done)
    resumed = study.run(2, folder=folder)
    assert len(keys(folder)) == len(set(keys(folder))) == ROWS  # none twice
    whole = study.run(2)
    xr.testing.assert_identical(resumed.drop_attrs(deep=False), whole.drop_attrs(deep=False))
    conductivity = whole["plate.conductivity"].values
    expected = 10.0 * AREA * conductivity[:, None] * whole.time.values
    assert whole["plate.heat_in(t)"].values == pytest.approx(expected, rel=1e-11, abs=1e-18)


def processes_of(folder):
    """Processes that were started for a study, by the mark in their environment."""
    found = []
    for entry in Path("/proc").iterdir():
        try:
            if entry.name.isdigit() and f"STUDY={folder}".encode() in (
                (entry / "environ").read_bytes()
            ):
                found.append(int(entry.name))
        except OSError:
            pass  # it has ended meanwhile
    return found


def test_nothing_is_lost_on_ctrl_c(scene, tmp_path):
    folder = tmp_path / "study"
    process = start(scene, folder)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=20.0)
    assert process.returncode != 0 and b"KeyboardInterrupt" in said, said.decode()
    count = len(keys(folder))
    assert 10 <= count < ROWS
    resumed = study_of(scene).run(2, folder=folder)
    assert (resumed.status == 0).all()
    assert len(set(keys(folder))) == len(keys(folder)) == ROWS


def test_a_larger_study_takes_the_rows_of_a_smaller_one(scene, tmp_path):
    def study(levels):
        return Study(
            scene,
            {"plate.conductivity": levels},
            inputs={"plate.top.flux": 10.0},
            outputs=["top.temperature"],
        )

    study([5.0, 10.0]).run(1, folder=tmp_path)
    table = study([5.0, 7.0, 10.0]).run(1, folder=tmp_path)
    assert len(keys(tmp_path)) == 3
    assert np.isfinite(table["top.temperature"].values).all()
    # Another step is another experiment.
    other = Study(
        scene,
        {"plate.conductivity": [5.0]},
        inputs={"plate.top.flux": 10.0},
        outputs=["top.temperature"],
        step=0.5,
    )
    other.run(1, folder=tmp_path)
    assert len(keys(tmp_path)) == 4


def test_a_journal_keeps_all_digits_and_has_one_writer(tmp_path):
    values = [np.array(1 / 3), np.array([[np.pi, np.inf], [5e-324, -0.0]]), np.zeros((0, 2))]
    with Journal(tmp_path) as journal:
        journal.append([("a", Finished(values, "", 0.5)), ("b", Finished(None, "no\nsuch"))])
        with pytest.raises(RuntimeError, match="another process"):
            Journal(tmp_path)
    with open(tmp_path / "rows.jsonl", "ab") as file:
        file.write(b'garbage\n{"key": "c", "val')
    with pytest.warns(UserWarning, match="line 3 is damaged"), Journal(tmp_path) as journal:
        assert set(journal.rows) == {"a", "b"}
        for kept, given in zip(journal.rows["a"].values, values, strict=True):
            assert kept.tobytes() == given.tobytes() and kept.shape == given.shape
        assert journal.rows["b"].failed and journal.rows["b"].message == "no\nsuch"
        journal.append([("c", Finished([np.array(1.0)]))])
    with pytest.warns(UserWarning):
        assert set(read(tmp_path / "rows.jsonl")) == {"a", "b", "c"}


def test_a_cluster_gives_the_same_table(scene, tmp_path):
    """By address, with rows of changed scenes, rows that fail, and one that kills its process."""
    distributed = pytest.importorskip("distributed")

    def flux(t, p):
        if p["way"] == 3:
            os.kill(os.getpid(), signal.SIGSEGV)
        return 100.0 * (1.0 + p["way"])

    study = Study(
        scene,
        {"body.plate.shape.box.2": [1e-3, 2e-3, -1.0], "way": [0, 1, 2, 3, 4]},
        inputs={"plate.top.flux": flux},
        outputs=["top.temperature", over_time("plate.heat_in")],
    )
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=2, dashboard_address=None, processes=True
    ) as cluster:
        table = study.run(dask=cluster.scheduler_address, folder=tmp_path)
    here = study.run(2)
    assert here.status.values.tolist() == [[0, 0, 0, 1, 0]] * 2 + [[1] * 5]
    xr.testing.assert_equal(table.drop_vars("message"), here.drop_vars("message"))
    assert "SIGSEGV" in str(table.message[0, 3].values)
    assert "-1" in str(table.message[2, 0].values)


def test_latin_hypercubes_are_the_same_in_every_process(scene):
    first, second = study_of(scene), study_of(scene)
    assert first.keys == second.keys and len(set(first.keys)) == ROWS
    assert isinstance(first.sampler, LatinHypercube)
    assert over_time("a") == over_time("a")
