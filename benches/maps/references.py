"""References of maps that are runs of our own at their finest, measured and kept as cells are."""

import csv
import hashlib
import json
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from plan import Answer, Work

ROOT = Path(__file__).resolve().parents[2]
FILE = ROOT / "docs/maps/references.csv"
COLUMNS = ["reference", "output", "value", "key"]


@dataclass(frozen=True)
class Reference:
    name: str
    work: Work
    run: Callable[[Work], Answer]

    @property
    def key(self) -> str:
        """What a row is of: rows of other work are measured again."""
        text = json.dumps([self.name, self.work], sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()[:12]

    @property
    def is_known(self) -> bool:
        return any(key == self.key for key, _ in known())

    def value(self, output: str) -> float:
        """At the end of the run."""
        try:
            return known()[self.key, output]
        except KeyError:
            told = f"{self.name} is not measured: run benches/maps/run.py"
            raise LookupError(told) from None

    def measure(self) -> None:
        """Writes all outputs; rows of the same reference as it was before go."""
        answer = self.run(self.work)
        if answer.refused:
            raise RuntimeError(f"{self.name}: {answer.refused}")
        kept = [row for row in rows() if row[0] != self.name]
        kept += [[self.name, name, f"{of[-1]:.9g}", self.key] for name, of in answer.values.items()]
        beside = FILE.with_suffix(".csv.part")
        with beside.open("w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([COLUMNS, *sorted(kept)])
        beside.replace(FILE)
        known.cache_clear()


def rows() -> list[list[str]]:
    if not FILE.is_file():
        return []
    with FILE.open(newline="") as file:
        return list(csv.reader(file))[1:]


@cache
def known() -> dict[tuple[str, str], float]:
    """By key and output."""
    return {(key, output): float(value) for _, output, value, key in rows()}
