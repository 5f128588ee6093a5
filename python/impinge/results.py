"""Results of masters and studies: what they hold, in short, and their report.

Results are plain `xarray.Dataset`s. Whatever this package adds to them is at `result.impinge`.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import xarray as xr

from impinge.summary import Summary, Table, listed, name_with_unit, number, shown_unit

if TYPE_CHECKING:
    from impinge.study.findings import Finding

COUPLED, STUDIED = "coupled run", "study"


@xr.register_dataset_accessor("impinge")
class Results:
    """`result.impinge` shows a result in short; `result.impinge.report("page.html")` writes it."""

    def __init__(self, dataset: xr.Dataset):
        self._dataset = dataset

    @property
    def kind(self) -> str:
        """`coupled run` of a master or `study`. Raises `ValueError` for other data sets."""
        attributes = self._dataset.attrs
        if "sampler_kind" in attributes:
            return STUDIED
        if "order_of_units" in attributes:
            return COUPLED
        raise ValueError("a data set that is neither of a Master nor of a Study")

    @property
    def findings(self) -> list[Finding]:
        """Failures and warnings of a study, each once with all rows that it concerns."""
        from impinge.study.findings import findings

        return findings(self._dataset)

    def report(
        self, path: str | os.PathLike[str], *, title: str | None = None, overwrite: bool = False
    ) -> Path:
        """Writes one HTML page of the result: see `impinge.report`."""
        from impinge.reporting import report

        return report(self._dataset, path, title=title, overwrite=overwrite)

    def __repr__(self) -> str:
        return self._summary().text()

    def _repr_html_(self) -> str:
        return self._summary().html()

    def _summary(self) -> Summary:
        data = self._dataset
        names = {name: data[name] for name in data.data_vars if name not in ("status", "message")}
        of = self._of_study() if self.kind == STUDIED else self._of_master()
        values = [
            name_with_unit(str(name), array.attrs.get("units"), array.shape[1:])
            for name, array in names.items()
        ]
        rows = [
            (
                str(name),
                " × ".join(f"{dim} {size}" for dim, size in array.sizes.items()),
                shown_unit(array.attrs.get("units")),
                number(array.values) if array.dtype.kind in "fiu" else "",
                array.attrs.get("long_name", array.attrs.get("description", "")),
            )
            for name, array in names.items()
        ]
        table = Table("variables", ("name", "dimensions", "unit", "range", "meaning"), rows)
        return Summary(of.headline, [*of.lines, ("variables", listed(values))], [table])

    def _of_master(self) -> Summary:
        told, times = self._dataset.attrs, self._dataset["time"].values
        names = [key.removeprefix("unit.") for key in told if key.startswith("unit.")]
        lines = [
            ("units", listed(f"{name} = {told[f'unit.{name}']}" for name in names)),
            ("scheme", f"{told['scheme']}; order {told['order']}"),
            ("steps", f"{told['steps']}, {told['rejected']} repeated shorter"),
            *(("note", note) for note in notes_of_master(told)),
        ]
        head = f"<impinge results of a coupled run: {len(times)} times to {times[-1]:g} s>"
        return Summary(head, lines)

    def _of_study(self) -> Summary:
        told = self._dataset.attrs
        name = str(told.get("title", "study")).removeprefix("study of ")
        varying = [str(each) for each in words(told["varying"])]
        units = [self._dataset[each].attrs.get("units") for each in varying]
        pairs = zip(varying, units, strict=True)
        lines = [
            ("parameters", listed(name_with_unit(each, unit) for each, unit in pairs)),
            ("sampler", str(told["sampler"])),
            ("rows", f"{told['rows']}, {told['failed']} failed, {told['not_run']} not run"),
            *(("failure" if f.has_failed else "warning", f.short) for f in self.findings),
            *(("note", note) for note in words(told.get("notes", []))),
        ]
        return Summary(f"<impinge results of a study of {name}: {told['rows']} rows>", lines)


def notes_of_master(attributes: Mapping[str, Any]) -> list[str]:
    """Notes of a coupled run, one by one; those of older files are one text."""
    return str(attributes.get("warnings", attributes.get("notes", ""))).splitlines()


def words(stored: object) -> list[str]:
    """Names, which a NetCDF file gives back as a text where there is one alone."""
    return [stored] if isinstance(stored, str) else [str(word) for word in stored]  # type: ignore
