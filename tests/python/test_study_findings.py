"""Warnings and failures of studies: each once, with the rows that it concerns."""

import json
import re
import warnings

import numpy as np
import pytest
import xarray as xr
from impinge import Study, StudyWarning, report
from impinge.reporting.studied import studied
from impinge.study import Paired
from impinge.study.findings import failure, findings, joined
from slab import SCENE

GOOD, WARNS, FAILS = 50.0, 1.0, -1.0
STEP = "plate: a step of .* is shorter than"


def table_of(messages, status=None, dims=("row",), shape=None):
    """A table of a study with these messages, whose parameter is ten times the number of a row."""
    shape = shape or (len(messages),)
    status = np.array(status or [0] * len(messages), np.int8).reshape(shape)
    data = {"status": (dims, status), "message": (dims, np.array(messages).reshape(shape))}
    coordinates = {dim: np.arange(n) * 10.0 for dim, n in zip(dims, shape, strict=True)}
    if dims == ("row",):
        coordinates = {"p": ("row", coordinates["row"])}
    return xr.Dataset(data, coordinates, {"varying": [*coordinates]})


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """30 rows on a coarse mesh, of which 7 warn, each of another time, and 2 fail."""
    folder = tmp_path_factory.mktemp("coarse")
    path = folder / "coarse.toml"
    path.write_text(SCENE.replace("depth_spacing = 0.05e-3", "depth_spacing = 0.5e-3"))
    values = [GOOD + row for row in range(30)]
    for row in range(3, 24, 3):
        values[row] = WARNS + row / 10
    values[5], values[28] = FAILS, 2 * FAILS
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of values out of range
        study = Study(
            path,
            {"plate.conductivity": values},
            outputs=["top.temperature"],
            stop=0.02,
            step=0.01,
            sampler=Paired(),
        )
    with pytest.warns(StudyWarning) as told:
        table = study.run(1, folder=folder)
    return study, folder, table, told


def test_each_warning_and_failure_comes_once_with_its_rows(study):
    _, _, table, told = study
    failed, warned = (str(each.message) for each in told)
    assert failed.startswith("2 of 30 rows failed: UnitError: ")
    assert re.match(f"7 of 30 rows warned: {STEP}", warned)
    for row in (3, 6, 9):
        assert f"\n  row {row}: plate.conductivity = {WARNS + row / 10:g}\n" in warned
    assert "\n  and 4 more\n" in warned and "row 12" not in warned
    assert told[1].message.rows == tuple(range(3, 24, 3))
    assert told[0].message.rows == (5, 28) and told[0].filename == __file__
    assert [told[0].message.rows, told[1].message.rows] == [
        finding.rows for finding in table.impinge.findings
    ]


def test_findings_stand_in_the_table_its_file_and_its_summary(study):
    _, folder, table, told = study
    assert table.attrs["failures"] == [str(told[0].message)]
    assert table.attrs["warnings"] == [str(told[1].message)]
    with xr.open_dataset(folder / "study.nc") as stored:
        assert stored.attrs["warnings"] == str(told[1].message)
        assert stored.impinge.findings == table.impinge.findings
    summary = repr(table.impinge)
    assert "7 of 30 rows: 3, 6, 9 and 4 more" in summary and "2 of 30 rows: 5, 28" in summary


def test_a_table_read_again_warns_of_what_its_folder_holds(study):
    made, folder, table, _ = study
    with pytest.warns(StudyWarning) as told:
        xr.testing.assert_equal(made.run(1, folder=folder), table)
    assert [len(each.message.rows) for each in told] == [2, 7]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert made.results(folder).attrs["warnings"] == table.attrs["warnings"]


def test_the_report_lists_each_finding_once(study, programs, tmp_path):
    _, _, table, _ = study
    page = report(table, tmp_path / "page.html").read_text(encoding="utf-8")
    document = json.loads(re.search(r'id="document">(.*?)</script>', page, re.DOTALL)[1])
    failed, warned = document["warnings"]
    assert failed["place"] == "2 of 30 rows failed"
    assert warned["place"] == "7 of 30 rows warned" and "and 4 more" in warned["message"]
    assert any("will fail" in note for note in document["notes"])


def test_warnings_that_differ_in_numbers_alone_are_one():
    text = "bed: the error is about {} %, more than 1.0e-3 [mesh_beyond_tolerance]"
    (found,) = findings(table_of([text.format(number) for number in ("2.5", "3", "-1e-2")]))
    assert found.rows == (0, 1, 2) and found.id == "mesh_beyond_tolerance"
    assert found.text == text.format("2.5") and not found.is_alike
    assert "numbers are those of row 0" in str(found)
    (same,) = findings(table_of([text, text]))
    assert same.is_alike and "numbers are those" not in str(same)


def test_a_scene_as_written_and_with_parameters_set_warns_of_one_thing():
    """A warning of what was not changed has a line, and numbers as they were written."""
    texts = [
        "the scene with its parameters as set: flaw[0].depth = 2e-5: missed [a]",
        "scene.toml: flaw[0].depth = 2e-05: missed [a]",
        "scene.toml:22: flaw[0].depth = 0.00002: missed [a]",
    ]
    (found,) = findings(table_of(texts))
    assert found.rows == (0, 1, 2) and found.is_alike and found.text == texts[0]
    (found,) = findings(table_of([*texts, texts[1].replace("2e-05", "3e-05")]))
    assert found.rows == (0, 1, 2, 3) and not found.is_alike
    (found,) = findings(table_of([f"UnitError: no\n  {text}" for text in texts], [1, 1, 1]))
    assert found.rows == (0, 1, 2)


def test_bodies_keys_and_ids_tell_warnings_apart():
    found = findings(
        table_of(["bed1: hot [a]", "bed2: hot [a]", "bed1: hot [b]", "layers.0.k: hot"])
    )
    assert [each.rows for each in found] == [(0,), (1,), (2,), (3,)]


def test_no_warning_of_a_row_counts_for_another_of_it():
    two = joined(["load 1 is unresolved", "load 2 is unresolved"])
    found = findings(table_of([two, "load 3 is unresolved", ""]))
    assert [(each.text, each.rows) for each in found] == [
        ("load 1 is unresolved", (0, 1)),
        ("load 2 is unresolved", (0,)),
    ]


def test_a_warning_of_several_lines_stays_whole():
    (found,) = findings(table_of([joined(["first\nsecond"])]))
    assert found.text == "first\n  second"


def test_rows_that_warn_and_fail_are_counted_as_both():
    message = failure("UnitError: no\n  a note", ["too hot", "UnitError: no"])
    found = findings(table_of([message, "too hot", ""], [1, 0, 2]))
    assert [(each.text, each.has_failed, each.rows) for each in found] == [
        ("UnitError: no\n  a note", True, (0,)),
        ("too hot", False, (0, 1)),
    ]


def test_rows_of_grids_are_named_by_all_that_varies():
    table = table_of(["", "", "", "", "hot", ""], dims=("a", "b"), shape=(2, 3))
    (found,) = findings(table)
    assert found.rows == (4,) and found.places == ("a = 10, b = 10",)


def test_reports_of_older_files_name_their_rows(study):
    _, _, table, _ = study
    old = table.copy()
    old.attrs = {k: v for k, v in table.attrs.items() if k not in ("warnings", "failures", "notes")}
    assert studied(old)["warnings"] == studied(table)["warnings"]
