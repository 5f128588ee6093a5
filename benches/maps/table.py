"""The table of a map: a row for each pair of settings, kept as soon as it is known."""

import csv
import hashlib
import json
from dataclasses import astuple, fields
from math import isfinite
from pathlib import Path

from plan import Cell, Map

COLUMNS = [*(field.name for field in fields(Cell)), "key"]
Known = dict[tuple[float, float], Cell]


def key(place: Map, x: float, y: float) -> str:
    """What a row is of: rows of other work are measured again, and those with other references."""
    told = [place.name, place.work(x, y), *(reference.key for reference in place.references)]
    text = json.dumps(told, sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def read(path: Path, of: Map) -> Known:
    """What is known already, of work that has not changed."""
    if not path.is_file():
        return {}
    known = {}
    with path.open(newline="") as file:
        lines = csv.reader(file)
        try:
            if next(lines, None) != COLUMNS:
                return {}
            for line in lines:
                cell, point = parsed(line)
                if point == key(of, cell.x, cell.y):
                    known[cell.x, cell.y] = cell
        except ValueError as error:
            raise SystemExit(
                f"{path}:{lines.line_num}: {error}; allowed: the row as it was measured, or none of"
                " that pair, which is measured anew"
            ) from None
    return known


def parsed(row: list[str]) -> tuple[Cell, str]:
    """Cell and key of a row. Raises ValueError where it is damaged."""
    line = dict(zip(COLUMNS, row, strict=True))
    x, y = float(line["x"]), float(line["y"])
    if not (isfinite(x) and isfinite(y)):
        raise ValueError("a setting that is not finite")
    numbers = float(line["outcome"]), line["said"], line["message"], float(line["seconds"])
    return Cell(x, y, *numbers, line["is_search"] == "True"), line["key"]


def write(path: Path, of: Map, known: Known) -> None:
    """All pairs that are known, in the order of x and y."""
    beside = path.with_suffix(".csv.part")
    with beside.open("w", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(COLUMNS)
        for (x, y), cell in sorted(known.items()):
            told = (
                f"{value:.6g}" if name in ("outcome", "seconds") else value
                for name, value in zip(COLUMNS, astuple(cell), strict=False)
            )
            rows.writerow([*told, key(of, x, y)])
    beside.replace(path)
