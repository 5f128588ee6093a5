"""What tells variables of a unit apart: names, and value references of those that can be set."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from impinge.unit.variable import Variable

# Causalities of variables that may be set, and types of FMI 2.0 that share their references
_SETTABLE = frozenset({"input", "parameter", "structuralParameter"})
_BASES = {"Enumeration": "Integer"}


def check_identities(singles: Iterable[Variable], fmi: int) -> None:
    """Raises `ValueError` for two variables of one name, and for two to be set by one reference.

    FMI 2.0 allows aliases, of which at most one can be set, and counts references of each type
    apart; FMI 3.0 does neither.
    """
    names: set[str] = set()
    settable: dict[tuple[str, int], str] = {}
    for single in singles:
        if single.name in names:
            raise ValueError(f"two variables have the name `{single.name}` (allowed: one)")
        names.add(single.name)
        if single.causality not in _SETTABLE:
            continue
        key = (_BASES.get(single.kind, single.kind) if fmi == 2 else "", int(single.references[0]))
        first = settable.setdefault(key, single.name)
        if first != single.name:
            raise ValueError(
                f"`{first}` and `{single.name}` can both be set, but share the valueReference"
                f" {key[1]} (allowed: one of them)"
            )
