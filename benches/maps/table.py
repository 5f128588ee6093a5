"""The table of a map: a row for each pair of settings, kept as soon as it is known."""

import csv
import hashlib
import json
from dataclasses import astuple, fields
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
        for line in csv.DictReader(file):
            x, y = float(line["x"]), float(line["y"])
            if line["key"] != key(of, x, y):
                continue
            numbers = float(line["outcome"]), line["said"], line["message"], float(line["seconds"])
            known[x, y] = Cell(x, y, *numbers, line["is_search"] == "True")
    return known


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
