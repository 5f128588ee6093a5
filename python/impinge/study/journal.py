"""The journal of a study: one line per finished row, durable once it is written.

A line is a JSON object with the row's key and either its values or the message of its failure.
Numbers keep all their digits; arrays are base64 of little-endian doubles. What a process that was
killed left of a last line is cut off when the journal is opened again.
"""

from __future__ import annotations

import base64
import fcntl
import json
import os
import warnings
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Finished:
    """What became of a row: the values of its outputs, or why there are none."""

    values: list[np.ndarray] | None
    message: str = ""
    seconds: float = 0.0

    @property
    def failed(self) -> bool:
        return self.values is None


class Journal:
    """Rows by key in `folder`/rows.jsonl; one process at a time may write."""

    def __init__(self, folder: Path):
        folder.mkdir(parents=True, exist_ok=True)
        self.path = folder / "rows.jsonl"
        is_new = not self.path.exists()
        self._file = open(self.path, "ab")  # noqa: SIM115 (closed by `close`)
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            self._file.close()
            message = f"{folder}: another process runs a study there (allowed: one at a time)"
            raise RuntimeError(message) from None
        if is_new:
            _sync_folder(folder)
        self._cut_torn_line()
        self.rows = read(self.path)

    def _cut_torn_line(self) -> None:
        text = self.path.read_bytes()
        whole = text.rfind(b"\n") + 1
        if whole < len(text):
            self._file.truncate(whole)
            os.fsync(self._file.fileno())

    def append(self, rows: Iterable[tuple[str, Finished]]) -> None:
        """Writes rows, which are on the disk when this returns; one wait for all of them."""
        rows = list(rows)
        if not rows:
            return
        self._file.write(b"".join(_line(key, row) for key, row in rows))
        self._file.flush()
        os.fsync(self._file.fileno())
        self.rows.update(rows)

    def close(self) -> None:
        self._file.close()

    def __enter__(self) -> Journal:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def read(path: Path) -> dict[str, Finished]:
    """All whole rows of a journal by key; of several lines with one key the last counts."""
    rows = {}
    for number, line in enumerate(path.read_bytes().split(b"\n")[:-1], start=1):
        try:
            stored = json.loads(line)
            rows[stored["key"]] = _row(stored)
        except (ValueError, KeyError, TypeError):
            warnings.warn(f"{path}, line {number} is damaged; its row runs again", stacklevel=2)
    return rows


def _line(key: str, row: Finished) -> bytes:
    stored: dict[str, Any] = {"key": key, "seconds": round(row.seconds, 6)}
    if row.values is None:
        stored["failed"] = row.message
    else:
        stored["values"] = [_pack(value) for value in row.values]
    return json.dumps(stored).encode() + b"\n"


def _row(stored: dict[str, Any]) -> Finished:
    if "failed" in stored:
        return Finished(None, stored["failed"], stored["seconds"])
    return Finished([_unpack(value) for value in stored["values"]], "", stored["seconds"])


def _pack(value: np.ndarray) -> Any:
    value = np.asarray(value, "<f8")
    if value.ndim == 0:
        return float(value)
    return {"shape": value.shape, "data": base64.b64encode(value.tobytes()).decode()}


def _unpack(stored: Any) -> np.ndarray:
    if not isinstance(stored, dict):
        return np.array(stored, float)
    data = np.frombuffer(base64.b64decode(stored["data"], validate=True), "<f8")
    return data.astype(float).reshape(stored["shape"])


def _sync_folder(folder: Path) -> None:
    """A new file is durable once its folder is."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
