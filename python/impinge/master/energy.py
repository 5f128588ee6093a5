"""What is lost between units: powers that leave one and do not reach the other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from impinge.errors import UnitError
from impinge.master.connection import Link, split
from impinge.master.errors import MasterError
from impinge.unit import Unit


@dataclass(frozen=True)
class Bond:
    """A power between two units.

    flux: the output that is passed on, such as a heat flux [W/m²] or a force [N].
    effort: the output that the other unit gives back, such as a velocity [m/s], whose product with
        the flux is the power; None where the flux itself is one, as of heat.
    area: by which the flux is multiplied [m²]; of each cell for families. Read from the cells of
        either unit if left out, else 1.
    total: an output that counts the energy [J] that has left the source or come to the target: it
        knows what happened within steps. Without it, fluxes between the ends of a step are taken
        to follow the polynomial through what the source says at these.
    """

    flux: str
    effort: str | None = None
    area: Any = None
    total: str | None = None


def bond(given: Any) -> Bond:
    """A bond, or the pair of names that stands for one."""
    return (
        given if isinstance(given, Bond) else Bond(*((given,) if isinstance(given, str) else given))
    )


class Balance:
    """The energy that leaves through a bond, and the part of it that does not arrive.

    Over a step of length H, what arrives is the mean ū of the path that the target followed; what
    leaves is the mean ȳ that the source gave, of the whole step or of the polynomial through its
    values at both ends. With flux q and effort e, `residual += H A (ȳ_q ū_e − ū_q ȳ_e)` [J];
    without an effort, `H A (ȳ_q − ū_q)`.
    S. Sadjina, L. Kyllingstad, S. Skjong, E. Pedersen (2017), doi 10.1007/s00366-016-0492-8.
    """

    def __init__(self, given: Bond, links: list[Link], units: Mapping[str, Unit]):
        self.name = given.flux if given.effort is None else f"{given.flux}*{given.effort}"
        self.link = _link(given.flux, links)
        self.effort = None
        if given.effort is not None:
            unit, variable = split(given.effort, units)
            if units[unit].variable(variable).unit != "K":  # a heat flux is a power by itself
                self.effort = _link(given.effort, links)
        self.area = _area(given, self.link, units)
        self._count = None
        if given.total is not None:
            unit, variable = split(given.total, units)
            self._count = units[unit].reader([variable])
        self.passed = 0.0
        self.moved = 0.0
        self.residual = 0.0
        self.largest = 0.0

    def begin(self) -> None:
        """Called at the start of the run."""
        self._counted = float(self._count()[0]) if self._count else 0.0

    def add(self, size: float, arrived: np.ndarray, given: np.ndarray) -> None:
        """A step of `size` [s]: the means of all inputs as targets followed them, and as sources
        gave them."""
        came, left = arrived[self.link.place], given[self.link.place]
        if self.effort is not None:
            place = self.effort.place
            came, left = came * given[place], left * arrived[place]
        energy = size * float(np.sum(self.area * left))
        if self._count is not None:
            before, self._counted = self._counted, float(self._count()[0])
            energy = self._counted - before
            lost = energy - size * float(np.sum(self.area * came))
        else:
            lost = size * float(np.sum(self.area * (left - came)))
        self.passed += energy
        self.moved += abs(energy)
        self.residual += lost
        self.largest = max(self.largest, abs(self.residual))


def _link(name: str, links: list[Link]) -> Link:
    for link in links:
        if name in (link.connection.source, link.connection.target):
            return link
    raise MasterError(f"energy: {name} is the end of no connection")


def _area(given: Bond, link: Link, units: Mapping[str, Unit]) -> np.ndarray:
    if given.area is not None:
        return np.broadcast_to(np.asarray(given.area, float).ravel(), (link.size,))
    for unit, variable in ((link.target_unit, link.target), (link.source_unit, link.source)):
        try:
            return np.asarray(units[unit].cells(variable)["area"], float).ravel()
        except (UnitError, KeyError):
            continue
    return np.ones(link.size)
