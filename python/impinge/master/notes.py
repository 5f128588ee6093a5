"""Warnings of a master."""

from __future__ import annotations

import sys
import warnings

from impinge.master.errors import MasterWarning


class Notes:
    """Warnings of one master: each is given once, where the user called, and kept in one line."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self._kinds: set[str] = set()

    def add(self, text: str, kind: str | None = None) -> None:
        """kind: of which only the first text counts."""
        if kind is not None and kind in self._kinds:
            return
        self._kinds |= {kind} if kind else set()
        text = " ".join(text.split())
        if text not in self.lines:
            self.lines.append(text)
            warnings.warn(text, MasterWarning, stacklevel=_level_of_the_caller())


def _level_of_the_caller() -> int:
    """Number of frames between `Notes.add` and the first one outside of this package."""
    level, frame = 1, sys._getframe(1)
    while frame.f_back and frame.f_globals.get("__name__", "").startswith("impinge."):
        level, frame = level + 1, frame.f_back
    return level
