"""The journal of a study: one line per finished row, durable once it is written.

A line is a JSON object with the row's key and either its values, with what the unit warned of, or
the message of its failure.
Numbers keep all their digits; arrays are base64 of little-endian doubles. The last member is a
checksum of all bytes before it, the key included: a row whose values or key were changed is not
taken. What a process that was killed left of a last line is cut off when the journal is opened
again.
"""

from __future__ import annotations

import base64
import hashlib
import json
import os
import stat
import warnings
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

try:
    import fcntl
except ModuleNotFoundError:
    raise ImportError(
        "studies need Linux or macOS: Windows lacks the locks and descriptors that they use"
        " (allowed there: `Unit`, `Master` and `Surface`)"
    ) from None

from impinge.errors import StudyError

_START = b'{"key": "'
_MARK = b', "sha256": "'  # before the checksum, which ends a line
_DIGITS = 32  # of the checksum, in hexadecimal


@dataclass(frozen=True)
class Finished:
    """What became of a row: the values of its outputs, or none.

    message: why there are none, or what the unit has warned of.
    """

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
        if not is_new and not stat.S_ISREG(self.path.stat().st_mode):
            raise StudyError(f"{self.path}: is no file (allowed: the journal of a study)")
        self._file = open(self.path, "ab")  # noqa: SIM115 (closed by `close`)
        try:
            self._lock(folder)
            if is_new:
                _sync_folder(folder)
            self._cut_torn_line()
            self.rows = read(self.path)
        except BaseException:
            self._file.close()
            raise

    def _lock(self, folder: Path) -> None:
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            message = f"{folder}: another process runs a study there (allowed: one at a time)"
            raise StudyError(message) from None

    def _cut_torn_line(self) -> None:
        """Cuts off the begin of a row; a file without any row is not one of ours."""
        text = self.path.read_bytes()
        whole = text.rfind(b"\n") + 1
        torn = text[whole:].rstrip(b"\0")  # zeros are what a loss of power may leave
        is_torn_row = torn.startswith(_START) or _START.startswith(torn)
        has_row = text.startswith(_START) or b"\n" + _START in text
        if not has_row and not (whole == 0 and is_torn_row):
            message = f"{self.path}: is not the journal of a study (allowed: another folder)"
            raise StudyError(message)
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
    """All whole rows of a journal by key; of several lines with one key the last counts.

    Warns of lines whose content does not have their checksum, and of lines without one, as older
    versions wrote them: their rows run again.
    """
    rows = {}
    unchecked = 0
    for number, line in enumerate(path.read_bytes().split(b"\n")[:-1], start=1):
        content, mark, _ = line.rpartition(_MARK)
        if line != content + _seal(content):
            if not mark and _is_whole(line):
                unchecked += 1
                continue
            _warn(path, number, "does not have its checksum")
            continue
        try:
            stored = json.loads(line)
            rows[stored["key"]] = _row(stored)
        except (ValueError, KeyError, TypeError, AttributeError, OverflowError, RecursionError):
            _warn(path, number, "holds no row")
    if unchecked:
        message = f"{path}: {unchecked} lines have no checksum, as older versions wrote them"
        warnings.warn(f"{message}; their rows run again", stacklevel=2)
    return rows


def _warn(path: Path, number: int, wrong: str) -> None:
    message = f"{path}, line {number} is damaged: it {wrong}; its row runs again"
    warnings.warn(message, stacklevel=3)


def _is_whole(line: bytes) -> bool:
    return line.startswith(_START) and line.endswith(b"}")


def _seal(content: bytes) -> bytes:
    """End of a line: the checksum of what stands before it."""
    checksum = hashlib.sha256(content).hexdigest()[:_DIGITS]
    return _MARK + checksum.encode() + b'"}'


def _line(key: str, row: Finished) -> bytes:
    stored: dict[str, Any] = {"key": key, "seconds": round(row.seconds, 6)}
    if row.values is None:
        stored["failed"] = row.message
    else:
        stored["values"] = [_pack(value) for value in row.values]
        if row.message:
            stored["warned"] = row.message
    content = json.dumps(stored).encode().removesuffix(b"}")
    return content + _seal(content) + b"\n"


def _row(stored: dict[str, Any]) -> Finished:
    seconds = float(stored["seconds"])
    if "failed" in stored:
        return Finished(None, str(stored["failed"]), seconds)
    values = [_unpack(value) for value in stored["values"]]
    return Finished(values, str(stored.get("warned", "")), seconds)


def _pack(value: np.ndarray) -> Any:
    value = np.asarray(value, "<f8")
    if value.ndim == 0:
        return float(value)
    return {"shape": value.shape, "data": base64.b64encode(value.tobytes()).decode()}


def _unpack(stored: Any) -> np.ndarray:
    if isinstance(stored, float):
        return np.array(stored)
    data = np.frombuffer(base64.b64decode(stored["data"], validate=True), "<f8")
    shape = [int(length) for length in stored["shape"]]
    if min(shape, default=0) < 0:
        raise ValueError("a negative length")
    return data.astype(float).reshape(shape)


def _sync_folder(folder: Path) -> None:
    """A new file is durable once its folder is."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
