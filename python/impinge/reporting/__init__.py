"""Reports of results: one HTML page, which needs nothing but a browser.

The page is that of `impinge report`: this package makes its data, the program draws them.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import xarray as xr

from impinge.errors import ImpingeError
from impinge.reporting.coupled import coupled
from impinge.reporting.studied import studied
from impinge.results import STUDIED, Results
from impinge.unit.build import find_program
from impinge.unit.temporary import temporary_folder

PROGRAM = "impinge" + (".exe" if sys.platform == "win32" else "")


def report(
    result: xr.Dataset | str | os.PathLike[str],
    path: str | os.PathLike[str],
    *,
    title: str | None = None,
    overwrite: bool = False,
) -> Path:
    """Writes one HTML page of a result of `Master` or `Study`, and returns where it is.

    result: what `run` has returned, or a file of it (`study.nc`, `result.to_netcdf(…)`).
    overwrite: replaces a file that is no such page.

    The page holds curves and maps over time, balances and notes of a coupled run; rows, parallel
    axes and Sobol's indices of a study; and the sketches of scenes whose units took part. It loads
    nothing: no network, no fonts, no scripts of others.

    Raises `ValueError` for other data sets, `ImpingeError` with what the program refuses.
    """
    if not isinstance(result, xr.Dataset):
        with xr.open_dataset(result) as opened:
            return report(opened.load(), path, title=title, overwrite=overwrite)
    made = studied(result) if Results(result).kind == STUDIED else coupled(result)
    return _draw(made if title is None else {**made, "title": title}, Path(path), overwrite)


def _draw(document: Mapping[str, Any], page: Path, overwrite: bool) -> Path:
    """Has the program draw a document."""
    with TemporaryDirectory(dir=temporary_folder().path) as folder:
        file = Path(folder) / "report.json"
        file.write_text(json.dumps(document, allow_nan=False), encoding="utf-8")
        command: list[str | Path] = [find_program(PROGRAM), "report", file, "--output", page]
        command += ["--overwrite"] if overwrite else []
        ran = subprocess.run(command, capture_output=True, text=True, check=False)
    if ran.returncode != 0:
        raise ImpingeError(f"no report of it: {ran.stderr.strip().removeprefix('error: ')}")
    return page


__all__ = ["report"]
