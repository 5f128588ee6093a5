"""References of charts and maps that are measured: which value they take, and what they renew."""

import csv
import importlib
import sys
from math import isnan
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture
def modules(monkeypatch):
    """Imports modules of `benches/charts` or `benches/maps`, whose names are alike."""
    imported = []

    def of(kind: str, *names: str):
        monkeypatch.syspath_prepend(ROOT / "benches" / kind)
        imported.extend(names)
        return [importlib.import_module(name) for name in names]

    before = set(sys.modules)
    yield of
    for name in set(sys.modules) - before:
        del sys.modules[name]


def a_chart(chart):
    """A coarse point, and a fine one by which it is measured."""

    def method(name: str, setting: str, **more):
        return chart.Method(name, [chart.Point(setting, chart.Formula(dict))], **more)

    quantity = chart.Quantity("heat", "J", chart.Measured("fine", "64", "heat"), None, "64 across")
    methods = [method("fine", "64", is_reference=True), method("coarse", "8")]
    return chart.Chart("heat", "Heat", [quantity], methods)


def outcome(chart, heat: float):
    return chart.Outcome({"heat": heat}, 0.0, 0.0, 1.0, 0.0, 0)


def test_a_measured_reference_is_the_value_of_its_point(modules):
    chart, table, references = modules("charts", "chart", "table", "references")
    made = a_chart(chart)
    known = {
        (method.name, table.key(method.points[0])): outcome(chart, heat)
        for method, heat in zip(made.methods, (-2.0, -1.5), strict=True)
    }
    (quantity,) = references.resolved(made, known).quantities
    assert (quantity.reference, quantity.scale) == (-2.0, 2.0)
    assert table.error(quantity, made.methods[1], outcome(chart, -1.5)) == 0.25


def test_a_reference_that_is_not_measured_yet_is_not_a_number(modules):
    chart, references = modules("charts", "chart", "references")
    (quantity,) = references.resolved(a_chart(chart), {}).quantities
    assert isnan(quantity.reference)


def test_a_reference_to_no_point_is_an_error(modules):
    chart, references = modules("charts", "chart", "references")
    with pytest.raises(KeyError, match="fine has no point 32"):
        references.value(a_chart(chart), chart.Measured("fine", "32", "heat"), {})


@pytest.fixture
def maps(modules, monkeypatch, tmp_path):
    """`plan`, `table` and `references` of maps, whose references are kept elsewhere."""
    plan, table, references = modules("maps", "plan", "table", "references")
    monkeypatch.setattr(references, "FILE", tmp_path / "references.csv")
    return plan, table, references


def fine(plan, references, across: int):
    def run(work):
        return plan.Answer({"drop.heat": [0.0, float(work["across"])]})

    return references.Reference("fine", {"across": across}, run)


def test_a_map_reads_what_its_reference_ended_with(maps):
    plan, _, references = maps
    reference = fine(plan, references, 64)
    with pytest.raises(LookupError, match="fine is not measured"):
        reference.value("drop.heat")
    reference.measure()
    assert reference.is_known
    assert reference.value("drop.heat") == 64.0


def test_a_reference_of_other_work_takes_the_place_of_what_it_was(maps):
    plan, _, references = maps
    for across in (48, 64):
        fine(plan, references, across).measure()
    with references.FILE.open(newline="") as file:
        assert [row["value"] for row in csv.DictReader(file)] == ["64"]
    assert not fine(plan, references, 48).is_known


def test_cells_are_measured_again_where_their_reference_changes(maps):
    plan, table, references = maps

    def key(across: int) -> str:
        axis = plan.Axis("x", "1", [1.0])
        of = plan.Map("heat", "Heat", axis, axis, "off", "1", 0.1, work=lambda x, y: {}, run=None,
                      judge=None, references=[fine(plan, references, across)])  # fmt: skip
        return table.key(of, 1.0, 1.0)

    assert key(48) != key(64)
