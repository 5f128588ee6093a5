"""Short descriptions of units, masters, studies and results, as text and for notebooks."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from typing import Any

import numpy as np

MOST_NAMES = 4
"""Names that a line of text lists before it counts the others."""
MOST_ROWS = 200
"""Rows of a table in a notebook."""
LARGEST_LIMIT = 1e9
"""Limits beyond it say nothing to a reader."""

_STYLE = "text-align:left;vertical-align:top;padding:0.1em 0.8em 0.1em 0"


@dataclass(frozen=True)
class Table:
    """Rows of texts under a head, folded away in a notebook; without columns that are empty."""

    title: str
    head: Sequence[str]
    rows: Sequence[Sequence[str]]

    def html(self) -> str:
        """The table as HTML; names and descriptions are escaped."""
        filled = [i for i in range(len(self.head)) if any(row[i] for row in self.rows)]
        head = "".join(f'<th style="{_STYLE}">{escape(self.head[i])}</th>' for i in filled)
        cells = [
            "".join(f'<td style="{_STYLE}">{escape(row[i])}</td>' for i in filled)
            for row in self.rows[:MOST_ROWS]
        ]
        rows = "".join(f"<tr>{row}</tr>" for row in cells)
        more = len(self.rows) - MOST_ROWS
        rest = f"<p>{more} more</p>" if more > 0 else ""
        title = escape(f"{self.title} ({len(self.rows)})")
        return (
            f"<details><summary>{title}</summary><table><thead><tr>{head}</tr></thead>"
            f"<tbody>{rows}</tbody></table>{rest}</details>"
        )


@dataclass(frozen=True)
class Summary:
    """A headline, lines of a label and a text, and tables that only notebooks show."""

    headline: str
    lines: Sequence[tuple[str, str]]
    tables: Sequence[Table] = field(default=())

    def text(self) -> str:
        """As `repr` gives it."""
        width = max((len(label) for label, _ in self.lines), default=0)
        lines = [f"  {label.ljust(width)}  {text}" for label, text in self.lines if text]
        return "\n".join([self.headline, *lines])

    def html(self) -> str:
        """As notebooks show it."""
        rows = "".join(
            f'<tr><th style="{_STYLE}">{escape(label)}</th>'
            f'<td style="{_STYLE}">{escape(text)}</td></tr>'
            for label, text in self.lines
            if text
        )
        tables = "".join(table.html() for table in self.tables if table.rows)
        headline = escape(self.headline.strip("<>"))
        return f"<div><strong>{headline}</strong><table><tbody>{rows}</tbody></table>{tables}</div>"


def listed(names: Iterable[str], joint: str = ", ") -> str:
    """The number of items, and the first of them."""
    names = list(names)
    if not names:
        return ""
    more = ", …" if len(names) > MOST_NAMES else ""
    return f"{len(names)}: {joint.join(names[:MOST_NAMES])}{more}"


def name_with_unit(name: str, unit: str | None, shape: Sequence[int] = ()) -> str:
    """`surface.temperature[24,24] [K]`; a pure number has no unit."""
    size = f"[{','.join(str(length) for length in shape)}]" if shape else ""
    return f"{name}{size} [{unit}]" if shown_unit(unit) else f"{name}{size}"


def shown_unit(unit: str | None) -> str:
    """A unit of measurement for display; pure numbers have none."""
    return "" if unit in (None, "1") else unit


def number(value: Any) -> str:
    """Six digits of a number, the range of an array, or the value itself."""
    if value is None:
        return ""
    if isinstance(value, str | bytes):
        return str(value)
    values = np.asarray(value, float)
    if values.size == 0 or np.isnan(values).all():
        return ""
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    return f"{low:.6g}" if low == high else f"{low:.6g} to {high:.6g}"


def variables(title: str, of: Mapping[str, Any]) -> Table:
    """Variables of a unit: name, unit, start value, limits and meaning."""
    rows = []
    for name, variable in of.items():
        ends = [_limit(limit) for limit in (variable.min, variable.max)]
        limits = " … ".join(ends) if any(ends) else ""
        shape = "×".join(str(length) for length in variable.shape)
        unit, start = shown_unit(variable.unit), number(variable.start)
        rows.append((name, shape, unit, start, limits, variable.description))
    return Table(title, ("name", "shape", "unit", "start", "limits", "meaning"), rows)


def _limit(value: float | None) -> str:
    return "" if value is None or abs(value) >= LARGEST_LIMIT else number(value)
