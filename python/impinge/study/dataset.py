"""The table of a study: values by row, with units and with what they come from."""

from __future__ import annotations

import os
import platform
from collections.abc import Mapping
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import h5py
import numpy as np
import xarray as xr

import impinge
import impinge.results  # gives datasets `result.impinge`
from impinge.errors import StudyError, UnitError
from impinge.unit.variable import stem_of

from . import identity
from .distributions import is_held
from .findings import failure, findings, warnings_of
from .journal import Finished
from .outputs import Output
from .signals import parts

if TYPE_CHECKING:
    from .study import Study

DONE, FAILED, NOT_RUN = 0, 1, 2


def assemble(study: Study, finished: Mapping[str, Finished]) -> xr.Dataset:
    """The table of what is finished; values of other rows are not a number.

    Dims: `row`, or those of the grid; then `time` and the indices of arrays. `status` is 0 for
    rows that have run, 1 for those that have failed, 2 for others. `message` says why a row has
    failed, or what its unit has warned of; the attributes `failures` and `warnings` have each of
    these once, with the rows that it concerns.
    """
    answers = [finished.get(key) for key in study.keys]
    status = np.array([NOT_RUN if a is None else FAILED if a.failed else DONE for a in answers])
    messages = np.array(["" if a is None else a.message for a in answers], dtype=object)
    arrays = [
        _column(place, output, _shape(study, output), answers, status, messages)
        for place, output in enumerate(study.experiment.outputs)
    ]
    lengths = tuple(study.design.dimensions.values())
    axes = tuple(study.design.dimensions)
    table = xr.Dataset(coords=_coordinates(study))
    for output, array in zip(study.experiment.outputs, arrays, strict=True):
        inner = _inner(study, output, array.shape[1:], table)
        attributes = _attributes(study, output)
        table[output.name] = (
            (*axes, *inner),
            array.reshape(*lengths, *array.shape[1:]),
            attributes,
        )
    meanings = {"flag_values": [0, 1, 2], "flag_meanings": "done failed not_run"}
    table["status"] = (axes, status.astype(np.int8).reshape(lengths), meanings)
    table["message"] = (axes, messages.astype(str).reshape(lengths), {})
    table.attrs = _provenance(study, status)
    found = findings(table)
    table.attrs["failures"] = [str(finding) for finding in found if finding.has_failed]
    table.attrs["warnings"] = [str(finding) for finding in found if not finding.has_failed]
    return table


def write(table: xr.Dataset, path: Path) -> None:
    """Writes the table as NetCDF: whole or not at all. A link is replaced, not written through."""
    part = path.with_name(f"{path.name}.part")
    part.unlink(missing_ok=True)
    try:
        table.to_netcdf(part, engine="h5netcdf")
        os.replace(part, path)
    except BaseException:
        part.unlink(missing_ok=True)
        raise


def refuse_foreign(path: Path) -> None:
    """Raises `StudyError` where a file or link stands that is not the table of a study."""
    if path.is_symlink() or path.exists():
        if not (path.is_file() and _is_table(path)):
            raise StudyError(
                f"{path}: is not the table of a study (allowed: another folder, or overwrite=True)"
            )


def _is_table(path: Path) -> bool:
    try:
        with h5py.File(path) as file:
            return {"unit_sha256", "sampler_kind", "outputs"} <= set(file.attrs)
    except OSError:
        return False


def _column(
    place: int,
    output: Output,
    shape: tuple[int, ...],
    answers: list[Finished | None],
    status: np.ndarray,
    messages: np.ndarray,
) -> np.ndarray:
    """Values of an output, shape (rows, …); a row of another shape than the first counts as failed,
    and keeps its other outputs."""
    values = [None if a is None or a.values is None else a.values[place] for a in answers]
    shape = next((value.shape for value in values if value is not None), shape)
    column = np.full((len(answers), *shape), np.nan)
    for row, value in enumerate(values):
        if value is None:
            continue
        if value.shape == shape:
            column[row] = value
        else:
            if status[row] == FAILED:
                continue  # another of its outputs has said so
            status[row] = FAILED
            reason = f"{output.name} has shape {value.shape}, not {shape} as in other rows"
            messages[row] = failure(reason, warnings_of(messages[row]))
    return column


def _shape(study: Study, output: Output) -> tuple[int, ...]:
    """The shape of an output by the study's own unit, while no row tells it."""
    if output.kind == "function":
        return ()
    try:
        shape = study.package.variable(output.needs[0]).shape
    except UnitError:
        return ()
    return (len(_times(study)), *shape) if output.kind == "over_time" else shape


def _times(study: Study) -> np.ndarray:
    """Zero, the multiples of the step, and the stop [s]."""
    return parts(study.experiment.stop, study.experiment.step, {}, cut=False)


def _coordinates(study: Study) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name, distribution in study.parameters.items():
        values = np.array([row[name] for row in study.design.rows])
        attributes = {"units": study.unit_of(name), "long_name": study.description_of(name)}
        if is_held(distribution):
            found[name] = ((), values[0], attributes)
        elif name in study.design.dimensions:
            levels = distribution.levels(study.design.dimensions[name])
            found[name] = ((name,), np.array(levels), attributes)
        else:
            found[name] = (("row",), values, attributes)
    return found


def _inner(
    study: Study, output: Output, shape: tuple[int, ...], table: xr.Dataset
) -> tuple[str, ...]:
    """Names of the dims of an output within a row, with their coordinates where known."""
    dims: list[str] = []
    stem = output.name
    if output.kind == "over_time" and shape:
        about = {"units": "s", "long_name": "time"}
        table.coords["time"] = (("time",), _times(study), about)
        dims.append("time")
    if output.kind != "function":
        stem = stem_of(output.needs[0]).rpartition(".")[0]  # families of one grid share their dims
    first = len(dims)
    for number, length in enumerate(shape[first:], start=1):
        name = f"{stem}_{number}"
        if table.sizes.get(name, length) != length:
            name = f"{output.name}_{number}"
        dims.append(name)
    return tuple(dims)


def _attributes(study: Study, output: Output) -> dict[str, str]:
    attributes = {"cell_methods": output.kind, "units": output.unit or ""}
    try:
        variable = study.package.variable(output.needs[0])
    except (UnitError, IndexError):
        return attributes
    if output.unit is None:
        attributes["units"] = variable.unit or ""
    if output.kind != "function":
        attributes["long_name"] = variable.description
    return attributes


def _provenance(study: Study, status: np.ndarray) -> dict[str, Any]:
    experiment = study.experiment
    return {
        "title": f"study of {study.package.name}",
        "source": study.source,
        "unit_sha256": study.unit_hash,
        "generation_tool": study.package.description.generationTool or "",
        "fmi": study.package.fmi,
        "scene": study.scene.text if study.scene else "",
        "sampler": repr(study.sampler),
        "sampler_kind": type(study.sampler).__name__,
        "second_order": int(getattr(study.sampler, "second_order", False)),
        "varying": study.varying,
        "distributions": [f"{name}: {d}" for name, d in study.parameters.items()],
        "outputs": [output.name for output in experiment.outputs],
        "inputs": [
            f"{name}: {identity.told(signal)}" for name, signal in experiment.inputs.items()
        ],
        "stop": experiment.stop,
        "step": experiment.step,
        "rows": len(status),
        "failed": int((status == FAILED).sum()),
        "not_run": int((status == NOT_RUN).sum()),
        "notes": study.notes,
        "versions": [
            f"impinge {impinge.__version__}",
            *(f"{name} {_version(name)}" for name in ("FMPy", "numpy", "SALib")),
            f"Python {platform.python_version()}",
        ],
        "machine": platform.platform(),
        "command": study.command,
        "working_folder": os.getcwd(),
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
    }


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "not installed"
