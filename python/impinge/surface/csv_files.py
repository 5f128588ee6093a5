"""Tables with columns x, y, z, time and values, as text."""

from __future__ import annotations

import csv
import re
from pathlib import Path

import numpy as np

from ..measure import Measure, conversion, parse
from ..reading import read_bytes, reading
from .errors import SurfaceError
from .placement import METRES

_UNIT = re.compile(r"\s+\[([^\]]*)\]\s*$")
_AS_IT_IS = ("", "-", "1", "Pa.m(1/2)")  # pure numbers, and SI with an exponent that is not whole
_KINDS = {"x": "m", "y": "m", "z": "m", "time": "s"}


def read_table(path: Path, metres: float = 1.0) -> tuple[list[str], np.ndarray]:
    """Names of the columns without their units, and numbers, shape (rows, columns).

    The first line that is no comment (#) names the columns: ``x [mm], y [mm], heat_flux``. Columns
    are parted by commas, semicolons or tabs. Numbers of a column with a unit are converted to SI
    units (kg, m, s, K, rad), those of x, y and z to lengths of `metres`; others stay as they are.

    Raises
    ------
    SurfaceError
        With file, line and column of what is not a number, or of a unit that is unknown or of
        another quantity.
    """
    with reading(path, SurfaceError):
        return _read_table(path, metres)


def _read_table(path: Path, metres: float) -> tuple[list[str], np.ndarray]:
    lines = _lines(path)
    if not lines:
        raise SurfaceError(f"{path}: is empty")
    line, header = lines[0]
    mark = next((m for m in (";", "\t") if m in header), ",")
    titles = _cells(header, mark)
    names = [_UNIT.sub("", title).strip() for title in titles]
    if len(set(names)) < len(names):
        twice = next(n for n in names if names.count(n) > 1)
        raise SurfaceError(f"{path}: line {line}: column `{twice}` stands twice")
    if all(_is_number(n) for n in names):
        raise SurfaceError(
            f"{path}: line {line}: names of columns are needed, such as x,y,heat_flux"
        )
    rows = np.empty((len(lines) - 1, len(names)))
    for k, (line, text) in enumerate(lines[1:]):
        rows[k] = numbers(path, line, _cells(text, mark), names)
    for k, (name, title) in enumerate(zip(names, titles, strict=True)):
        factor, shift = _conversion(f"{path}: line {lines[0][0]}", name, title, metres)
        rows[:, k] = factor * rows[:, k] + shift
    return names, rows


def _conversion(place: str, name: str, title: str, metres: float) -> tuple[float, float]:
    """Factor and shift from the unit in a column's title."""
    found = _UNIT.search(title)
    unit = found[1].strip() if found else ""
    if unit in _AS_IT_IS:
        return 1.0, 0.0
    try:
        given = Measure(parse("m").exponents, METRES[unit]) if unit in METRES else parse(unit)
        taken = parse(_KINDS[name]) if name in _KINDS else Measure(given.exponents)
        if name in ("x", "y", "z"):
            taken = taken._replace(factor=metres)
        return conversion(given, taken)
    except ValueError as error:
        raise SurfaceError(f"{place}: column {name} [{unit}]: {error}") from None


def read_matrix(path: Path) -> np.ndarray:
    """Numbers without names of columns; shape (lines, columns)."""
    with reading(path, SurfaceError):
        return _read_matrix(path)


def _read_matrix(path: Path) -> np.ndarray:
    lines = _lines(path)
    if not lines:
        raise SurfaceError(f"{path}: is empty")
    mark = next((m for m in (";", "\t", ",") if m in lines[0][1]), None)
    width = len(_cells(lines[0][1], mark))
    return np.array([numbers(path, line, _cells(text, mark), width) for line, text in lines])


def numbers(path: Path, line: int, cells: list[str], names: list[str] | int) -> list[float]:
    """Numbers of a line; an error names the column of what is none."""
    columns = names if isinstance(names, list) else [str(k + 1) for k in range(names)]
    if len(cells) != len(columns):
        raise SurfaceError(
            f"{path}: line {line}: {len(cells)} columns, where there are {len(columns)}"
        )
    values = []
    for name, text in zip(columns, cells, strict=True):
        if not _is_number(text):
            raise SurfaceError(f"{path}: line {line}: column {name}: `{text}` is not a number")
        values.append(float(text))
        if not np.isfinite(values[-1]):
            raise SurfaceError(f"{path}: line {line}: column {name}: {text} is not finite")
    return values


def _lines(path: Path) -> list[tuple[int, str]]:
    try:
        text = read_bytes(path).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise SurfaceError(f"{path}: no text: {error}") from None
    kept = ((k, line) for k, line in enumerate(text.splitlines(), 1))
    return [(k, line) for k, line in kept if line.strip() and not line.lstrip().startswith("#")]


def _cells(line: str, mark: str | None) -> list[str]:
    if mark is None:
        return line.split()
    return [cell.strip() for cell in next(csv.reader([line], delimiter=mark))]


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
