"""Options that charts and maps share: which of them, where to, and whether to measure at all."""

import argparse
import sys
from collections.abc import Callable, Iterable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def parser(purpose: str, kind: str, known: Iterable[str]) -> argparse.ArgumentParser:
    """Of `charts` or `maps`, a kind; more options may be added."""
    made = argparse.ArgumentParser(description=purpose)
    told = f"of {', '.join(known)} [default: all]"
    made.add_argument("names", nargs="*", metavar=kind.removesuffix("s"), help=told)
    made.add_argument("--out", type=Path, default=ROOT / "docs" / kind)
    made.add_argument("--again", action="store_true", help="measure what is known, too")
    made.add_argument("--draw", action="store_true", help="only draw what is known")
    made.add_argument("--check", action="store_true", help="only say what is not known")
    return made


def parsed(
    made: argparse.ArgumentParser, known: Iterable[str], missing: Callable[[Path], list[str]]
) -> argparse.Namespace:
    """Options with every name that is meant; ends with what is `missing` if that is asked for."""
    options = made.parse_args()
    if unknown := sorted(set(options.names) - set(known)):
        made.error(f"no such name: {', '.join(unknown)}; there are {', '.join(known)}")
    if options.check:
        sys.exit("\n".join(missing(options.out)) or None)
    options.out.mkdir(parents=True, exist_ok=True)
    options.names = options.names or list(known)
    return options
