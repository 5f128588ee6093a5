"""What a map of a method's limits is made of: two settings, what came of each pair, and theory."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from math import nan
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from references import Reference

Work = dict
"""Plain arguments of a run, which JSON can write: a point is measured again where they change."""


@dataclass(frozen=True)
class Answer:
    """What a run came to, and what the product said of it."""

    values: dict[str, float | list[float]] = field(default_factory=dict)
    warned: str = ""
    """The first warning that the setting was met with, if there was one."""
    refused: str = ""
    """Why there are no values: the refusal of the scene, the unit or a step."""
    is_crash: bool = False
    """Whether it ended in any other way than by a refusal."""


@dataclass(frozen=True)
class Axis:
    name: str
    unit: str
    values: list[float]
    is_logarithmic: bool = True
    labels: list[str] | None = None
    """Of settings that are words; values are their places then."""


@dataclass(frozen=True)
class Boundary:
    """Where theory expects the limit: y over x."""

    name: str
    y: Callable[[float], float]
    source: str
    is_limit: bool = True
    """Whether what is measured should lie on it; otherwise it only orders the picture."""


@dataclass(frozen=True)
class Map:
    name: str
    title: str
    x: Axis
    y: Axis
    outcome: str
    """What is coloured."""
    unit: str
    bad: float
    """Outcomes above it are failures; their edge is the measured boundary."""
    work: Callable[[float, float], Work]
    run: Callable[[Work], Answer]
    """A function of a module, so that processes find it by its name."""
    judge: Callable[[Answer, float, float], float]
    """The outcome of an answer that was not refused."""
    theory: list[Boundary] = field(default_factory=list)
    guards: str = "what the product warns of or refuses"
    must_speak: bool = True
    """Whether failures should be told of: not where the map is of a variant no user can reach."""
    refusal_is_edge: bool = False
    """Whether what is refused counts as the far side of the boundary, as beyond a limit load."""
    refine: float | None = None
    """Ratio to which the boundary is searched between the values of y."""
    colours: tuple[float, float] | None = None
    """Ends of the colours' range."""
    references: list[Reference] = field(default_factory=list)
    """What cells are judged by, if that is measured, too; measured before them."""


@dataclass(frozen=True)
class Cell:
    """A row of a map's table."""

    x: float
    y: float
    outcome: float = nan
    said: str = ""
    """`warned`, `refused` or `crashed`, or nothing."""
    message: str = ""
    seconds: float = 0.0
    is_search: bool = False
    """Whether it was taken while searching for the boundary, and does not lie on the grid."""

    @property
    def is_told(self) -> bool:
        return self.said in ("warned", "refused")
