"""What a chart of work over accuracy is made of: quantities and methods with their settings."""

from collections.abc import Callable
from dataclasses import dataclass, field

Values = dict[str, float]


@dataclass(frozen=True)
class Measured:
    """A reference that is a value of a point of the same chart, measured as all points are."""

    method: str
    setting: str
    quantity: str


@dataclass(frozen=True)
class Quantity:
    """What is asked for: `reference` is at least ten times as accurate as the best point shown."""

    name: str
    unit: str
    reference: float | Measured
    scale: float | None
    """What an error is divided by, in the same unit; nothing stands for the reference."""
    source: str
    """Where the reference comes from."""
    has_panel: bool = True
    """Else it stands in the table, and beside what was asked for, alone."""
    title: str = ""
    """Its name in the picture, if that is another than in the table."""

    @property
    def shown(self) -> str:
        return self.title or self.name


@dataclass(frozen=True)
class UnitRun:
    """A unit that is packed, started, stepped and read as a host does it."""

    scene: dict
    outputs: dict[str, str]
    """Variables of the unit by quantity; read at the end of every step."""
    inputs: Values = field(default_factory=dict)
    steps: int = 1


@dataclass(frozen=True)
class ProgramRun:
    """A program of `programs/`, such as another code on the same work, in a process of its own.

    It gets its arguments as JSON and prints as its last line what `measure.drive` returns: values
    by quantity, seconds to start and of steps, and bytes of memory; seconds of packing and bytes of
    what that leaves, where there are such."""

    program: str
    arguments: dict
    environment: str = ".venv"
    """The virtual environment whose Python runs it."""


@dataclass(frozen=True)
class Formula:
    """Something that is evaluated: a function of nothing that gives values by quantity."""

    evaluate: Callable[[], Values]


@dataclass(frozen=True)
class Point:
    setting: str
    work: UnitRun | ProgramRun | Formula
    asked: float | None = None
    """The relative error that was asked for, where one can ask."""


@dataclass(frozen=True)
class Method:
    name: str
    points: list[Point]
    references: dict[str, float | Measured] = field(default_factory=dict)
    """By quantity, of a method that models another body, whose own answer differs."""
    is_reference: bool = False
    """Whether others are measured by it: run once, in the table, and not drawn."""


@dataclass(frozen=True)
class Chart:
    name: str
    title: str
    quantities: list[Quantity]
    methods: list[Method]
    points: str = ""
    """Explains the settings at points in a sentence below the picture."""
    has_settings: bool = True
    """True if settings stand at the ends of curves; false where they would cover each other."""


@dataclass(frozen=True)
class Outcome:
    """What a point came to: medians over its repetitions; a failure instead where there was one."""

    values: Values
    pack: float
    """Packing of the unit [s]."""
    start: float
    """Instantiation and initialisation [s]."""
    steps: float
    """All steps and readings [s]."""
    memory: float
    """Peak of the process above that before the unit was loaded [B]."""
    size: int
    """Of the unit's file [B]."""
    failure: str = ""

    @property
    def seconds(self) -> float:
        """What a host waits for."""
        return self.start + self.steps
