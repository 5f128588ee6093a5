"""Warnings and failures of a study's rows, each once with the rows that it concerns."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import xarray as xr

from impinge.errors import StudyWarning
from impinge.results import words

WARNED = "\n  warned: "
"""Stands in the message of a row that has failed before each of its unit's warnings."""
_DONE, _FAILED = 0, 1
_SHOWN = 3
_LINES = re.compile(r"\n(?! )")  # lines that are indented go on with what is above
_NUMBER = re.compile(r"(?<![\w.])[-−+]?\d+(?:\.\d+)*(?:e[-−+]?\d+)?")
# A warning of a scene has a line of its text, or none once parameters have changed that.
_OF_SCENE = re.compile(
    r"^( *)(?:the scene with its parameters as set|(?:[^\s:]*/)?scene\.toml(?::\d+)?): ",
    re.MULTILINE,
)
_ID = re.compile(r" \[([a-z]\w*)\]$")


@dataclass(frozen=True)
class Finding:
    """A warning of units, or the reason of failures, with the rows that it concerns.

    text: as the first of the rows has it. is_alike: whether the others have the same text; else
        theirs differ from it in numbers alone. Notation of numbers and lines of the scene do not
        count: a row whose parameters are those of the scene names them as the scene does.
    rows: their numbers from 0, in the order of the table. count: of all rows of the study.
    places: what varies, with its values, in the first few of the rows.
    """

    text: str
    has_failed: bool
    rows: tuple[int, ...]
    count: int
    places: tuple[str, ...]
    is_alike: bool

    @property
    def id(self) -> str:
        """The id of the warning, as in `docs/warnings.md`; empty if it has none."""
        found = _ID.search(self.text)
        return found[1] if found else ""

    @property
    def message(self) -> str:
        """The text without the id."""
        return _ID.sub("", self.text)

    @property
    def short(self) -> str:
        """The text and the rows in one line."""
        rows = ", ".join(map(str, self.rows[:_SHOWN]))
        beyond = len(self.rows) - _SHOWN
        more = f" and {beyond} more" if beyond > 0 else ""
        return f"{' '.join(self.text.split())} ({self.concerned}: {rows}{more})"

    @property
    def concerned(self) -> str:
        """The number of rows in words."""
        return f"{len(self.rows)} of {self.count} row{'s' if self.count > 1 else ''}"

    @property
    def listed(self) -> list[str]:
        """The first few rows with their values, and how many there are beyond."""
        told = [
            f"row {row}: {place}" if place else f"row {row}"
            for row, place in zip(self.rows, self.places, strict=False)
        ]
        beyond = len(self.rows) - len(told)
        told += [f"and {beyond} more"] if beyond else []
        if not self.is_alike:
            told.append(f"numbers are those of row {self.rows[0]}; `message` has the others")
        return told

    def __str__(self) -> str:
        kind = "failed" if self.has_failed else "warned"
        return "\n  ".join([f"{self.concerned} {kind}: {self.text}", *self.listed])


def warning_of(finding: Finding) -> StudyWarning:
    """A finding as a Python warning."""
    return StudyWarning(str(finding), finding.id, finding.rows)


def findings(table: xr.Dataset) -> list[Finding]:
    """Failures and warnings of a study's table, failures first, each in the order of its rows."""
    status, messages = table["status"].values.ravel(), table["message"].values.ravel()
    gathered: dict[tuple[bool, str, int], dict[int, str]] = {}
    for row in np.flatnonzero(messages != ""):
        for has_failed, nth, text in _numbered(int(status[row]), str(messages[row])):
            key = (has_failed, _without_numbers(text), nth)
            gathered.setdefault(key, {})[int(row)] = text
    found = [
        Finding(
            next(iter(texts.values())),
            has_failed,
            tuple(texts),
            len(status),
            tuple(_place(table, row) for row in list(texts)[:_SHOWN]),
            len(set(map(_plain, texts.values()))) == 1,
        )
        for (has_failed, _, _), texts in gathered.items()
    ]
    return sorted(found, key=lambda finding: not finding.has_failed)


def joined(texts: Iterable[str]) -> str:
    """The message of a row with these warnings."""
    return "\n".join(text.replace("\n", "\n  ") for text in texts)


def failure(reason: str, warned: Iterable[str]) -> str:
    """The message of a row that has failed after these warnings."""
    told = [text.replace("\n", "\n  ") for text in warned if text not in reason]
    return WARNED.join([reason, *told])


def warnings_of(message: str) -> list[str]:
    """The warnings in the message of a row that has run."""
    return _LINES.split(message) if message else []


def _numbered(status: int, message: str) -> Iterator[tuple[bool, int, str]]:
    """Texts of a row, failures marked; texts that differ in numbers alone are numbered, so that
    none of them counts for another."""
    reasons, warned = [], []
    if status == _DONE:
        warned = warnings_of(message)
    elif status == _FAILED:
        reason, *warned = message.split(WARNED)
        reasons = [reason]
    seen: dict[str, int] = {}
    for has_failed, texts in ((True, reasons), (False, warned)):
        for text in texts:
            alike = _without_numbers(text)
            seen[alike] = nth = seen.get(alike, -1) + 1
            yield has_failed, nth, text


def _without_numbers(text: str) -> str:
    """The part that texts share that differ in numbers, or in whether a scene was changed."""
    return _NUMBER.sub("#", _OF_SCENE.sub(r"\1scene: ", text))


def _plain(text: str) -> str:
    """The text with its numbers written in one way."""

    def number(found: re.Match[str]) -> str:
        try:
            return repr(float(found[0].replace("−", "-")))
        except ValueError:
            return found[0]

    return _NUMBER.sub(number, _OF_SCENE.sub(r"\1scene: ", text))


def _place(table: xr.Dataset, row: int) -> str:
    """Names and values of what varies in a row."""
    status = table["status"]
    at: Mapping = dict(zip(status.dims, np.unravel_index(row, status.shape), strict=True))
    told = []
    for name in words(table.attrs["varying"]):
        array = table[name]
        value = array.isel({dim: at[dim] for dim in array.dims}).item()
        told.append(f"{name} = {value:.6g}" if isinstance(value, float) else f"{name} = {value}")
    return ", ".join(told)
