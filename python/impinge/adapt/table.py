"""Tables of inputs over time: first column ``time`` [s], one more for each input, by its name."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import TextIO

import numpy as np

from ..surface import Series, SurfaceError
from ..surface.csv_files import read_table

# Quantities of loads by the last parts of their names, and their units
UNITS = {
    "heat_flux": "W/m2",
    "pressure": "Pa",
    "shear_x": "Pa",
    "shear_y": "Pa",
    "shear_r": "Pa",
    "temperature": "K",
    "ambient": "K",
    "x": "m",
    "y": "m",
    "speed": "m/s",
    "angle": "rad",
    "direction": "rad",
}


def names(variable: str, shape: tuple[int, ...]) -> list[str]:
    """Names of the elements of an array of a unit, last index fastest: ``laser.heat_flux[1,2]``."""
    if shape == ():
        return [variable]
    return [f"{variable}[{','.join(str(i + 1) for i in index)}]" for index in np.ndindex(*shape)]


def write_inputs(
    out: str | Path | TextIO, frames: dict[str, Series], *, held: bool = False, single: bool = False
) -> None:
    """Writes inputs over time; `frames` gives for each array's name its series, values of the
    array's shape.

    Between rows inputs are linear in time. With `held` each frame holds until the next: there are
    two rows then for every change, which is a jump for ``impinge run``, and the last frame ends the
    table. With `single` arrays of one element are numbers, as those of a disc are.

    Raises
    ------
    SurfaceError
        If the series have different times.
    """
    times = next(iter(frames.values())).times
    columns, values = [], []
    for variable, series in frames.items():
        if len(series) != len(times) or (series.times != times).any():
            raise SurfaceError(f"{variable}: its times differ from those of the other inputs")
        shape = () if single and series.values[0].size == 1 else series.values.shape[1:]
        columns += names(variable, shape)
        values.append(series.values.reshape(len(times), -1))
    rows = np.column_stack([times, *values])
    if held and len(rows) > 1:
        before = np.column_stack([rows[1:, :1], rows[:-1, 1:]])
        rows = np.concatenate(
            [rows[:1], np.stack([before, rows[1:]], axis=1).reshape(-1, rows.shape[1])]
        )
    if isinstance(out, str | Path):
        with open(out, "w", newline="") as file:
            _write(file, columns, rows)
    else:
        _write(out, columns, rows)


def _write(file: TextIO, columns: list[str], rows: np.ndarray) -> None:
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(["time [s]", *[_with_unit(name) for name in columns]])
    writer.writerows([[repr(float(x)) for x in row] for row in rows])


def _with_unit(name: str) -> str:
    unit = UNITS.get(name.partition("[")[0].rpartition(".")[2])
    return f"{name} [{unit}]" if unit else name


def read_inputs(path: str | Path) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Times [s], which may stand twice at jumps, and columns of a table of inputs by their
    names.
    """
    columns, rows = read_table(Path(path))
    if columns[0] != "time":
        raise SurfaceError(f"{path}: no first column `time`, but `{columns[0]}`")
    if (np.diff(rows[:, 0]) < 0).any():
        row = int(np.flatnonzero(np.diff(rows[:, 0]) < 0)[0])
        raise SurfaceError(
            f"{path}: row {row + 2}: column time: {rows[row + 1, 0]} s lies before the row above"
        )
    return rows[:, 0], dict(zip(columns[1:], rows[:, 1:].T, strict=True))
