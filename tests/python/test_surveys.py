"""Charts and maps are measured as they are declared, explained, and silent about no failure."""

import csv
import re
import subprocess
import sys
from pathlib import Path

import pytest
from PIL import Image

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("kind", ["charts", "maps"])
def test_everything_declared_is_measured(kind):
    command = [sys.executable, ROOT / "benches" / kind / "run.py", "--check"]
    checked = subprocess.run(command, capture_output=True, text=True)
    assert checked.returncode == 0, checked.stderr


def test_no_failure_that_a_user_can_reach_is_silent():
    with (ROOT / "docs/maps/limits.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) > 40
    silent = {row["map"]: int(row["bad and silent"] or 0) for row in rows}
    assert {name: count for name, count in silent.items() if count} == {}


def rows_of(chart: str) -> list[dict[str, str]]:
    with (ROOT / "docs/charts" / f"{chart}.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def rows_under(head: str, page: Path) -> list[list[str]]:
    """Cells of the page's tables whose columns go from `head` to `test`."""
    tables = rf"^\| {head} .*\| test \|\n\|-.*\n((?:\|.*\n)+)"
    found = re.findall(tables, page.read_text(), re.MULTILINE)
    return [line.strip("|").split("|") for line in "".join(found).splitlines()]


def errors_of(row: dict[str, str]) -> dict[str, float]:
    return {name: float(text) for name, text in row.items() if name.startswith("error") and text}


def test_no_point_of_a_chart_has_failed():
    charts = [path.stem for path in (ROOT / "docs/charts").glob("*.csv")]
    assert len(charts) > 10
    failed = {
        (chart, row["method"], row["setting"]): row["failure"]
        for chart in charts
        for row in rows_of(chart)
        if row["failure"]
    }
    assert failed == {}


@pytest.mark.parametrize("chart", ["spot", "alumina_plate", "pressure", "layers", "contact"])
def test_tolerances_that_were_asked_for_are_kept(chart):
    asked = [row for row in rows_of(chart) if row["asked"]]
    assert len(asked) > 2
    for row in asked:
        errors = errors_of(row)
        assert errors
        assert max(errors.values()) < float(row["asked"]), (row["method"], row["setting"])


@pytest.mark.parametrize("chart", ["spot", "alumina_plate"])
@pytest.mark.parametrize("shape", ["box", "disc"])
def test_stresses_of_references_have_settled(chart, shape):
    coarse, fine = (row for row in rows_of(chart) if row["method"] == f"NGSolve, {shape}")
    names = [name for name in coarse if name.startswith("value") and "stress" in name]
    assert names
    for name in names:
        assert float(coarse[name]) == pytest.approx(float(fine[name]), rel=1e-5)


@pytest.mark.parametrize("kind", ["charts", "maps"])
def test_every_picture_is_explained(kind):
    folder = ROOT / "docs" / kind
    text = "".join(path.read_text() for path in folder.glob("*.md"))
    pictures = [path.name for path in folder.glob("*.png")]
    assert pictures
    assert [name for name in pictures if f"]({name})" not in text] == []


def test_every_map_has_a_picture_or_a_row_with_its_guard_and_test():
    pages = list((ROOT / "docs/maps").glob("*.md"))
    text = "".join(path.read_text() for path in pages)
    rows = {row[0].strip(): row[1:] for page in pages for row in rows_under("map", page)}
    with (ROOT / "docs/maps/limits.csv").open(newline="") as file:
        maps = [row["map"] for row in csv.DictReader(file)]
    for name in maps:
        shown = f"]({name}.png)" in text
        assert shown != (f"[{name}]({name}.csv)" in rows), name
        assert shown == (ROOT / "docs/maps" / f"{name}.png").is_file(), name
    for name, row in rows.items():
        assert len(row) == 4 and all(cell.strip() for cell in row), name


@pytest.mark.parametrize("kind", ["charts", "maps"])
def test_pictures_are_as_wide_as_a_page_and_small(kind):
    for path in (ROOT / "docs" / kind).glob("*.png"):
        with Image.open(path) as image:
            assert image.width >= 1200, path.name
        assert path.stat().st_size < 200_000, path.name


def test_guards_name_tests_that_exist():
    packages = ["src", "assessments", "build-fmu", "cli", "closed-form", "fmu-lint"]
    folders = [(ROOT / "tests", "*.*"), *((ROOT / package, "*.rs") for package in packages)]
    paths = [path for folder, files in folders for path in folder.rglob(files)]
    sources = [path.read_text() for path in paths if path.suffix in (".rs", ".py", ".toml")]
    tests = re.findall(r'^\s*(?:fn |def |what = ")([^("]+)', "\n".join(sources), re.MULTILINE)
    named = set()
    for page in (ROOT / "docs/maps").glob("*.md"):
        for row in [*rows_under("limit", page), *rows_under("map", page)]:
            cell = row[-1].strip()
            assert cell == "the same" or "`" in cell, row
            named.update(re.findall("`([^`]+)`", cell))
    assert len(named) > 20
    assert named - set(tests) == set()
