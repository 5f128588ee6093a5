"""The document of a study."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import xarray as xr

from impinge.reporting.document import (
    FEWEST_ROWS,
    MOST_NUMBERS,
    about,
    axis,
    document,
    fact,
    numbers,
    series,
    thinned,
    unit_of,
    warning,
)
from impinge.results import words
from impinge.study.findings import Finding, findings

MOST_CURVES = 24
"""Rows whose outputs over time are drawn."""
FAILED, NOT_RUN = 1, 2


def studied(result: xr.Dataset) -> dict[str, Any]:
    """Rows of a study, with Sobol's indices where its rows are for these."""
    told = result.attrs
    name = str(told.get("title", "study")).removeprefix("study of ")
    dims = _row_dims(result)
    outputs = [each for each in words(told["outputs"]) if each in result]
    indices, notes = _sensitivities(result)
    scene = str(told.get("scene", ""))
    return document(
        f"Study of {name}",
        f"{told['rows']} rows, {told['sampler']}",
        source=[
            fact(key, told[key])
            for key in ("source", "command", "working_folder", "date", "machine", "unit_sha256")
            if key in told
        ],
        scenes=[{"name": "", "text": scene}] if scene else [],
        figures=_figures(result, dims, outputs),
        warnings=[_warning(finding) for finding in findings(result)],
        notes=[*words(told.get("notes", [])), *notes],
        model=[{"title": "Study", "facts": _facts(told), "lines": [], "tables": []}],
        histories=_histories(result, dims, outputs),
        study={"columns": _columns(result, dims, outputs), "sensitivities": indices},
    )


def _row_dims(result: xr.Dataset) -> tuple[str, ...]:
    """Dimensions of the rows: one, or those of the grid."""
    return tuple(str(dim) for dim in result["status"].dims)


def _by_row(array: xr.DataArray, result: xr.Dataset, dims: tuple[str, ...]) -> np.ndarray:
    """Values with the rows first, all in one dimension."""
    full = array.broadcast_like(result["status"]) if set(array.dims) < set(dims) else array
    inner = [dim for dim in full.dims if dim not in dims]
    values = full.transpose(*dims, *inner).values
    return values.reshape(result["status"].size, *values.shape[len(dims) :])


def _columns(result: xr.Dataset, dims: tuple[str, ...], outputs: list[str]) -> list[dict[str, Any]]:
    """Parameters, outputs (of arrays the highest value), status and message."""
    columns = []
    for name in words(result.attrs["varying"]):
        columns.append(
            _column(result[name], name, "parameter", _by_row(result[name], result, dims))
        )
    for name in outputs:
        values = _by_row(result[name], result, dims)
        if values.ndim > 1:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", RuntimeWarning)  # rows that have failed
                values = np.nanmax(values.reshape(len(values), -1), axis=1)
            columns.append(_column(result[name], f"max {name}", "output", values))
        else:
            columns.append(_column(result[name], name, "output", values))
    status = _by_row(result["status"], result, dims)
    meanings = {0: "done", FAILED: "failed", NOT_RUN: "not run"}
    if (status != 0).any():
        told = [meanings.get(int(each), "") for each in status]
        columns.append({"name": "status", "role": "status", "values": told})
    messages = [str(each) for each in _by_row(result["message"], result, dims)]
    if any(messages):
        columns.append({"name": "message", "role": "message", "values": messages})
    return columns


def _column(array: xr.DataArray, name: str, role: str, values: np.ndarray) -> dict[str, Any]:
    told = {"name": name, "unit": unit_of(array.attrs), "about": about(array.attrs), "role": role}
    if values.dtype.kind in "fiu":
        return {**told, "values": numbers(values)}
    return {**told, "values": [str(value) for value in values]}


def _figures(result: xr.Dataset, dims: tuple[str, ...], outputs: list[str]) -> list[dict[str, Any]]:
    """Ranges of outputs over all rows."""
    found = []
    for name in outputs[:3]:
        values = _by_row(result[name], result, dims)
        if values.dtype.kind not in "fiu" or not np.isfinite(values).any():
            continue
        unit = unit_of(result[name].attrs)
        for word, value in (("Lowest", np.nanmin(values)), ("Highest", np.nanmax(values))):
            told = {"label": f"{word} {name}", "value": float(value), "unit": unit}
            found.append({**told, "note": ""})
    return found


def _facts(told: dict[str, Any]) -> list[dict[str, str]]:
    facts = [fact("rows", f"{told['rows']}, {told['failed']} failed, {told['not_run']} not run")]
    facts += [fact("steps", f"of {told['step']:g} s to {told['stop']:g} s")]
    facts += [fact("sampler", told["sampler"])]
    facts += [fact("parameter", each) for each in words(told["distributions"])]
    facts += [fact("input", each) for each in words(told["inputs"]) if each]
    facts += [fact("version", each) for each in words(told["versions"])]
    return facts


def _warning(finding: Finding) -> dict[str, str]:
    kind = "failed" if finding.has_failed else "warned"
    message = f"{finding.message} ({'; '.join(finding.listed)})"
    return warning(message, f"{finding.concerned} {kind}", finding.id)


def _histories(
    result: xr.Dataset, dims: tuple[str, ...], outputs: list[str]
) -> dict[str, Any] | None:
    """Outputs over time of some of the rows."""
    over_time = [n for n in outputs if result[n].dims == (*dims, "time")]
    if not over_time:
        return None
    count = result["status"].size
    rows, times = thinned(count, MOST_CURVES), result["time"].values
    kept = thinned(len(times), max(MOST_NUMBERS // (len(rows) * len(over_time)), FEWEST_ROWS))
    curves = []
    for name in over_time:
        values = _by_row(result[name], result, dims)
        unit, meaning = unit_of(result[name].attrs), about(result[name].attrs)
        for row in rows:
            curves.append(series(f"{name}, row {row}", unit, meaning, values[row][kept]))
    note = f"{len(rows)} of {count} rows are drawn." if len(rows) < count else ""
    return {"axis": axis("time", "s", times[kept]), "note": note, "series": curves}


def _sensitivities(result: xr.Dataset) -> tuple[list[dict[str, Any]], list[str]]:
    """Sobol's indices of outputs that are single numbers, and why there are none."""
    if result.attrs.get("sampler_kind") != "Sobol":
        return [], []
    from impinge.study import sobol_indices

    dims = _row_dims(result)
    outputs = [name for name in words(result.attrs["outputs"]) if result[name].dims == dims]
    if not outputs:
        return [], ["no Sobol indices on this page: outputs are arrays"]
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            found = sobol_indices(result, outputs)
        except (ValueError, ImportError) as error:
            return [], [f"no Sobol indices: {error}"]
    keys = ("first", "first_confidence", "total", "total_confidence")
    indices = []
    for output in found["output"].values:
        of = found.sel(output=output)
        columns = {key: numbers(of[key].values) for key in keys}
        entries = [
            {"parameter": str(name), **{key: columns[key][i] for key in keys}}
            for i, name in enumerate(of["parameter"].values)
        ]
        indices.append({"output": str(output), "entries": entries})
    return indices, [str(each.message) for each in caught]
