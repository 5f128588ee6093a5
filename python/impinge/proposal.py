"""Suggestions for misspelt names."""

import difflib
from collections.abc import Iterable


def proposal(name: str, names: Iterable[str]) -> str:
    """Returns "; is it `a` or `b`?" with names close to this one, nothing if there are none."""
    known = list(names)
    near = [each for each in known if each.lower() == name.lower()]
    near = near or difflib.get_close_matches(name, known, n=3)
    return f"; is it {' or '.join(f'`{each}`' for each in near)}?" if near else ""
