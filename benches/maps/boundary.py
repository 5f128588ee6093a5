"""Where outcomes turn bad: between the rows of a map, and how far from theory."""

from collections.abc import Callable
from dataclasses import dataclass
from math import isnan, nan, sqrt

from plan import Cell, Map
from table import Known


@dataclass(frozen=True)
class Crossing:
    """An edge between a good and a bad setting of y at one x."""

    x: float
    good: float
    bad: float

    def middle(self, of: Map) -> float:
        if of.y.is_logarithmic:
            return sqrt(self.good * self.bad)
        return 0.5 * (self.good + self.bad)

    def ratio(self) -> float:
        ends = sorted((abs(self.good), abs(self.bad)))
        return ends[1] / ends[0] if ends[0] else float("inf")


def is_bad(of: Map, cell: Cell) -> bool:
    if of.refusal_is_edge and cell.said == "refused":
        return True
    return cell.said == "crashed" or (not isnan(cell.outcome) and cell.outcome > of.bad)


def crossings(of: Map, known: Known) -> list[Crossing]:
    """The first edge along y of each x, between settings that came to an outcome."""
    found = []
    for x in of.x.values:
        column = sorted((y, cell) for (at, y), cell in known.items() if at == x)
        counts = of.refusal_is_edge
        column = [(y, is_bad(of, cell)) for y, cell in column if counts or cell.said != "refused"]
        for (low, low_is_bad), (high, high_is_bad) in zip(column, column[1:], strict=False):
            if low_is_bad != high_is_bad:
                good, bad = (high, low) if low_is_bad else (low, high)
                found.append(Crossing(x, good, bad))
                break
    return found


def search(of: Map, known: Known, measure: Callable[[list[tuple[float, float]]], None]) -> None:
    """Halves the distance between good and bad until they are within the ratio asked for."""
    while of.refine:
        wide = [c for c in crossings(of, known) if c.ratio() > of.refine]
        places = [(c.x, c.middle(of)) for c in wide]
        places = [place for place in places if place not in known]
        if not places:
            return
        measure(places)


def deviations(of: Map, known: Known) -> list[tuple[float, float, float, float]]:
    """x, measured y, the y of theory, and what they differ by, relative to theory."""
    rows = []
    limits = [theory for theory in of.theory if theory.is_limit]
    for edge in crossings(of, known):
        y = edge.middle(of)
        expected = min((t.y(edge.x) for t in limits), key=lambda e: abs(e - y), default=nan)
        rows.append((edge.x, y, expected, y / expected - 1.0))
    return rows


def silent(of: Map, known: Known) -> list[Cell]:
    """Failures of the grid that nothing was said of."""
    return [c for c in known.values() if is_bad(of, c) and not c.is_told and not c.is_search]
