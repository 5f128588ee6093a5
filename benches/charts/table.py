"""The table of a chart: a row for each point, kept as soon as it is known, so runs can go on."""

import csv
import hashlib
import json
from dataclasses import asdict
from math import isfinite
from pathlib import Path

from chart import Chart, Formula, Method, Outcome, Point, Quantity

NUMBERS = ("pack", "start", "steps", "memory", "size")


def key(point: Point) -> str:
    """What a row is of: rows of other scenes, inputs or outputs are measured again."""
    told = {} if isinstance(point.work, Formula) else asdict(point.work)
    text = json.dumps([point.setting, told], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def columns(chart: Chart) -> list[str]:
    of_quantities = [f"{what} of {q.name} [{u}]" for q in chart.quantities for what, u in told(q)]
    units = ("pack [s]", "start [s]", "steps [s]", "memory [B]", "size [B]")
    return ["method", "setting", "asked", *of_quantities, *units, "failure", "key"]


def told(quantity: Quantity) -> tuple[tuple[str, str], ...]:
    return ("value", quantity.unit), ("error", "1")


def error(quantity: Quantity, method: Method, outcome: Outcome) -> float | None:
    """Relative to the quantity's scale; nothing where the method does not give it."""
    value = outcome.values.get(quantity.name)
    reference = method.references.get(quantity.name, quantity.reference)
    return None if value is None else abs(value - reference) / quantity.scale


def row(chart: Chart, method: Method, point: Point, outcome: Outcome) -> list[str]:
    cells = []
    for quantity in chart.quantities:
        value = outcome.values.get(quantity.name)
        cells += (
            ["", ""] if value is None else [repr(value), f"{error(quantity, method, outcome):.3e}"]
        )
    asked = "" if point.asked is None else f"{point.asked:g}"
    numbers = [f"{getattr(outcome, name):.4g}" for name in NUMBERS]
    return [method.name, point.setting, asked, *cells, *numbers, outcome.failure, key(point)]


def read(path: Path, chart: Chart) -> dict[tuple[str, str], Outcome]:
    """What is known already, by method and key."""
    if not path.is_file():
        return {}
    known = {}
    with path.open(newline="") as file:
        lines = csv.reader(file)
        try:
            if next(lines, None) != columns(chart):
                return {}
            for line in lines:
                name, point, outcome = parsed(line, chart)
                known[name, point] = outcome
        except ValueError as error:
            raise SystemExit(
                f"{path}:{lines.line_num}: {error}; allowed: the row as it was measured, or none of"
                " that point, which is measured anew"
            ) from None
    return known


def parsed(line: list[str], chart: Chart) -> tuple[str, str, Outcome]:
    """Method, key and outcome of a row. Raises ValueError where it is damaged."""
    cells = dict(zip(columns(chart), line, strict=True))
    texts = {q.name: cells[f"value of {q.name} [{q.unit}]"] for q in chart.quantities}
    values = {name: float(text) for name, text in texts.items() if text}
    first = columns(chart).index("pack [s]")
    numbers = dict(zip(NUMBERS, map(float, line[first : first + 5]), strict=True))
    if not all(map(isfinite, values.values())):
        raise ValueError("a value that is not finite")
    numbers["size"] = int(numbers["size"])
    return cells["method"], cells["key"], Outcome(values, **numbers, failure=cells["failure"])


def write(path: Path, chart: Chart, known: dict[tuple[str, str], Outcome]):
    """All points that are known, in the order of the chart."""
    beside = path.with_suffix(".csv.part")
    with beside.open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(columns(chart))
        for method in chart.methods:
            for point in method.points:
                if outcome := known.get((method.name, key(point))):
                    table.writerow(row(chart, method, point, outcome))
    beside.replace(path)
