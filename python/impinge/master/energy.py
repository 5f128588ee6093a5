"""What is lost between units: powers that leave one and do not reach the other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import prod
from typing import Any

import numpy as np

from impinge.errors import UnitError
from impinge.master.any_unit import AnyUnit
from impinge.master.connection import Link, split
from impinge.master.errors import MasterError
from impinge.measure import BASE, KELVIN
from impinge.unit.access import Reader
from impinge.unit.cells import is_per_depth

_NOT_M = [0, 2, 3, 4, 5, 6]  # metres are counted by themselves, and radians are pure numbers
_POWER = np.array([1, -3, 0, 0, 0, 0])
_ENERGY = np.array([1, -2, 0, 0, 0, 0])
_ENERGIES = {2: "J", 1: "J/m", 0: "J/m2", -1: "J/m3"}  # by their exponents of metres


@dataclass(frozen=True)
class Bond:
    """A power between two units.

    flux: the output that is passed on, such as a heat flux [W/m²] or a force [N].
    effort: the output that the other unit gives back, such as a velocity [m/s], whose product with
        the flux is the power; None where the flux itself is one, as of heat.
    area: by which the flux is multiplied [m²]; of each cell for families. If left out it is read
        from the cells of either unit, and 1 where there are none, which a warning says of powers
        per area, or the flux is no power per area. Cells of a load grow with its radius, of which
        the mean over each step counts. Cells of a plane drop have areas per metre of depth [m],
        and their energies are in J/m, as those of a power in W/m.
    total: an output that counts the energy [J, J/m] that has left the source or come to the target:
        it knows what happened within steps. Without it, fluxes between the ends of a step are taken
        to follow the polynomial through what the source says at these. With an `area` the energy is
        in the total's unit.
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


class _Area:
    """The areas of the values of a flux [m²], of a load at the radius that it has over a step.

    is_per_depth: whether they are per metre of depth [m], as of plane drops.
    start: the radius that `values` belong to [m]; None of cells that do not grow. The radius is the
    mean over a step of what the master sets, at `place` among all inputs, or what `read` returns.
    """

    def __init__(self, values: np.ndarray, is_per_depth: bool = False):
        self.values = values
        self.is_per_depth = is_per_depth
        self.start: float | None = None
        self.place: slice | None = None
        self.read: Reader | None = None

    @classmethod
    def of_cells(
        cls, name: str, variable: str, units: Mapping[str, AnyUnit], places: Mapping[str, slice]
    ) -> _Area:
        """The areas of the cells of a variable of the unit of this name."""
        unit = units[name]
        area = cls(unit.areas(variable), is_per_depth(unit.cells(variable)))
        radius = unit.placement(variable).get("radius")
        if radius is not None:
            area.start = radius.start
            area.place = places.get(f"{name}.{radius.name}")
            area.read = unit.reader([radius.name])
        return area

    def __call__(self, arrived: np.ndarray) -> np.ndarray:
        """arrived: means over a step of the inputs that the master sets."""
        if self.start is None:
            return self.values
        radius = self.read() if self.place is None else arrived[self.place]
        return self.values * (float(radius[0]) / self.start) ** 2


class Balance:
    """The energy that leaves through a bond, and the part of it that does not arrive, in `unit`.

    Over a step of length H, what arrives is the mean ū of the path that the target followed; what
    leaves is the mean ȳ that the source gave, of the whole step or of the polynomial through its
    values at both ends. With flux q and effort e, `residual += H A (ȳ_q ū_e − ū_q ȳ_e)` [J];
    without an effort, `H A (ȳ_q − ū_q)`.
    S. Sadjina, L. Kyllingstad, S. Skjong, E. Pedersen (2017), doi 10.1007/s00366-016-0492-8.
    """

    def __init__(
        self,
        given: Bond,
        links: list[Link],
        units: Mapping[str, AnyUnit],
        places: Mapping[str, slice] | None = None,
    ):
        """places: where inputs that the master sets stand among all of them, by `unit.variable`."""
        self.name = given.flux if given.effort is None else f"{given.flux}*{given.effort}"
        self.link = _link(given.flux, links)
        self.effort = None
        if given.effort is not None:
            if not _is_temperature(given.effort, units):  # a heat flux is a power by itself
                self.effort = _link(given.effort, links)
        power = _check(given, self.link, self.effort, units)
        ends = [self.link] if self.effort is None else [self.link, self.effort]
        self._area = _area(given, power, self.link, units, places or {})
        self.lacks_area = self._area is None and power is not None and power[1] == 0
        self.unit = _ENERGIES[_metres(given, power, self._area, units)]
        self._factor = prod(_factor(k, units) for k in ends)
        self._total = None
        if given.total is not None:
            unit, variable = split(given.total, units)
            self._total = units[unit].reader([variable])
            measure = units[unit].measure(units[unit].variable(variable).unit)
            self._joules = 1.0 if measure is None else measure.factor
        self.passed = self.low = self.high = 0.0
        self.moved = 0.0
        self.residual = 0.0
        self.largest = 0.0

    def begin(self) -> None:
        """Called at the start of the run."""
        self._counted = self._count()

    def add(self, size: float, arrived: np.ndarray, given: np.ndarray) -> None:
        """A step of `size` [s]: the means of all inputs as targets followed them, and as sources
        gave them."""
        came, left = arrived[self.link.place], given[self.link.place]
        if self.effort is not None:
            place = self.effort.place
            came, left = came * given[place], left * arrived[place]
        area = self._factor * (1.0 if self._area is None else self._area(arrived))
        energy = size * float(np.sum(area * left))
        if self._total is not None:
            before, self._counted = self._counted, self._count()
            energy = self._counted - before
            lost = energy - size * float(np.sum(area * came))
        else:
            lost = size * float(np.sum(area * (left - came)))
        self.passed += energy
        self.low, self.high = min(self.low, self.passed), max(self.high, self.passed)
        self.moved += abs(energy)
        self.residual += lost
        self.largest = max(self.largest, abs(self.residual))

    def _count(self) -> float:
        return self._joules * float(self._total()[0]) if self._total is not None else 0.0

    @property
    def share(self) -> float:
        """The largest residual over what the energy that has passed ranged over: of what swings,
        the energy of a swing."""
        return self.largest / (self.high - self.low) if self.high > self.low else 0.0


def powers(
    links: Sequence[Link], units: Mapping[str, AnyUnit], places: Mapping[str, slice]
) -> list[Balance]:
    """Balances of all pairs of connections to and fro whose product is a power, as forces and
    velocities, where both are known to be by their units of measurement."""
    sources = [link.connection.source for link in links]
    once = [link for link in links if link.is_real and sources.count(link.connection.source) == 1]
    found = []
    for i, one in enumerate(once):
        for other in once[i + 1 :]:
            ends = (other.target_unit, other.source_unit)
            if (one.source_unit, one.target_unit) == ends and one.size == other.size:
                names = one.connection.source, other.connection.source
                if _is_power(*(_exponents(k.connection.source, units, k) for k in (one, other))):
                    found.append(Balance(Bond(*names), list(links), units, places))
    return found


def _is_power(*factors: np.ndarray | None) -> bool:
    """Whether quantities multiply to one, or one per length, area or volume; one alone is none."""
    if any(each is None or all(each[_NOT_M] == _POWER) for each in factors):
        return False
    found = np.sum(factors, axis=0)
    return all(found[_NOT_M] == _POWER) and -1 <= found[1] <= 2


def _link(name: str, links: list[Link]) -> Link:
    for link in links:
        if name in (link.connection.source, link.connection.target):
            return link
    raise MasterError(f"energy: {name} is the end of no connection")


def _check(
    given: Bond, link: Link, effort: Link | None, units: Mapping[str, AnyUnit]
) -> np.ndarray | None:
    """Refuses what is no power, or none per area, length or volume, as far as units of measurement
    are known. Returns the exponents of the power where known."""
    found = _exponents(given.flux, units, link)
    if given.effort is not None and effort is not None:
        other = _exponents(given.effort, units, effort)
        found = None if found is None or other is None else found + other
    if found is not None and (any(found[_NOT_M] != _POWER) or not -1 <= found[1] <= 2):
        what = given.flux if effort is None else f"{given.flux} times {given.effort}"
        raise MasterError(
            f"energy: {what} is in {_written(found)}, and no power: W, or W per m, m2 or m3, is"
            " needed; forces, say, go as pairs with velocities"
        )
    return found


def _metres(
    given: Bond, power: np.ndarray | None, area: _Area | None, units: Mapping[str, AnyUnit]
) -> int:
    """The exponent of metres of what a bond passes on; refuses a total that is something else.
    That of the total goes where nothing else tells whether the power is per metre of depth."""
    if given.area is None and area is not None:
        known = {1 if area.is_per_depth else 2}
    elif given.area is None and power is not None and power[1] != 0:
        known = {int(power[1])}
    else:
        known = {2, 1}
    total = None if given.total is None else _exponents(given.total, units)
    if total is None:
        return max(known)
    if any(total[_NOT_M] != _ENERGY) or total[1] not in known:
        allowed = " or ".join(_ENERGIES[metres] for metres in sorted(known, reverse=True))
        raise MasterError(
            f"energy: the total {given.total} is in {_written(total)}, not in {allowed}"
        )
    return int(total[1])


def _exponents(
    name: str, units: Mapping[str, AnyUnit], link: Link | None = None
) -> np.ndarray | None:
    """Of a variable's unit of measurement, as far as it is known; of what a link's map returns
    where that changes it."""
    unit, variable = split(name, units)
    found = units[unit].measure(units[unit].variable(variable).unit)
    if link is not None and link.connection.unit is not None:
        found = link.measure
    return None if found is None else np.array(found.exponents)


def _is_temperature(name: str, units: Mapping[str, AnyUnit]) -> bool:
    unit, variable = split(name, units)
    found = _exponents(name, units)
    if found is None:
        return units[unit].variable(variable).unit == "K"
    return tuple(found) == KELVIN.exponents


def _factor(link: Link, units: Mapping[str, AnyUnit]) -> float:
    """Factor from the target's unit of measurement to that of the SI."""
    unit = units[link.target_unit]
    found = unit.measure(unit.variable(link.target).unit)
    return 1.0 if found is None else found.factor


def _written(found: np.ndarray) -> str:
    return " ".join(f"{u}{n}" if n != 1 else u for u, n in zip(BASE, found, strict=True) if n) or (
        "no unit"
    )


def _area(
    given: Bond,
    power: np.ndarray | None,
    link: Link,
    units: Mapping[str, AnyUnit],
    places: Mapping[str, slice],
) -> _Area | None:
    """The area of each value of a link [m²]; None if it is unknown or does not count."""
    if given.area is not None:
        return _Area(np.broadcast_to(np.asarray(given.area, float).ravel(), (link.size,)))
    if power is not None and power[1] != 0:  # of the whole cell, or per length or volume
        return None
    for unit, variable in ((link.target_unit, link.target), (link.source_unit, link.source)):
        try:
            area = _Area.of_cells(unit, variable, units, places)
        except UnitError:
            continue
        if link.size in (1, len(area.values)):  # a map may lead from cells to other ones
            return area
    return None
