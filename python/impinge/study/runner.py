"""Runs rows of a study on units that are kept from row to row."""

from __future__ import annotations

import re
import shutil
import tempfile
import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from impinge.errors import ImpingeError
from impinge.unit import Package, State, Unit, open_package
from impinge.unit.temporary import temporary_folder

from .findings import failure, joined
from .journal import Finished
from .outputs import Output
from .scenes import Variant
from .signals import Signal, Table, Timeline, takes_parameters, timeline

_LONGEST_MESSAGE = 4000
_WARNING = 1  # of the states of FMI


@dataclass(frozen=True)
class Experiment:
    """What is done with a unit in every row.

    stop, step: in s, from the unit's start at zero. inputs: what they do over time; rows may hold
    other values of them.
    """

    stop: float
    step: float
    inputs: Mapping[str, Signal]
    outputs: tuple[Output, ...]


@dataclass(frozen=True)
class Row:
    """A run: `parameters` are set before initialisation, `inputs` held over it.

    scene: what tells its unit from others, empty for the study's own; `variant` is that unit.
    sampled: all that varies, which functions of time may ask for.
    keeps: whether a row with the same parameters follows on the same unit.
    """

    index: int
    parameters: Mapping[str, Any]
    inputs: Mapping[str, Any]
    sampled: Mapping[str, Any]
    scene: str = ""
    variant: Variant | None = None
    keeps: bool = False


@dataclass
class Live:
    """An instance with its calls, and the parameters that it was initialised with.

    heard: what it has warned of. at_start: how much of that by the end of its initialisation, what
    goes for all rows that begin there.
    """

    unit: Unit
    parameters: dict[str, Any]
    heard: list[str]
    at_start: int
    fresh: bool = True  # just initialised
    state: State | None = None
    readers: dict[tuple[str, ...], Any] = field(default_factory=dict)
    timeline: Timeline | None = None  # where it is the same in all rows

    @classmethod
    def of(cls, package: Package, parameters: dict[str, Any]) -> Live:
        heard: list[str] = []

        def hear(status: int, _category: str, message: str) -> None:
            if status == _WARNING:
                heard.append(message)

        unit = Unit(package, parameters=parameters, logger=hear)
        return cls(unit, parameters, heard, len(heard))

    def reader(self, names: tuple[str, ...]) -> Any:
        if names not in self.readers:
            self.readers[names] = self.unit.reader(names)
        return self.readers[names]


class Runner:
    """Keeps one instance of the unit that the last row asked for.

    An instance is initialised anew for other parameters; for the same ones its state just after
    initialisation is restored, where it can be. Units warn of a thing once in an instance's life,
    so that one whose warnings the next row may need is replaced.
    """

    def __init__(self, folder: Path, experiment: Experiment):
        self.base = folder
        self.experiment = experiment
        self._live: Live | None = None
        self._package: Package | None = None
        self._scene: str | None = None
        self._temporary: Path | None = None

    def run(self, row: Row) -> Finished:
        """The row's values, or why there are none; an instance that failed is given up."""
        begin = time.perf_counter()
        try:
            values = self._values(row)
        except Exception as error:
            warned = dict.fromkeys(self._live.heard if self._live else [])
            self._drop()
            reason = f"{type(error).__name__}: {error}" + "".join(
                f"\n  {note}" for note in getattr(error, "__notes__", [])
            )
            message = failure(reason, warned)
            return Finished(None, self._told(row, message), time.perf_counter() - begin)
        return Finished(values, self._warnings(row), time.perf_counter() - begin)

    def _warnings(self, row: Row) -> str:
        """What the unit has warned of in a row that has run, each once."""
        live = self._live
        assert live
        message = joined(dict.fromkeys(live.heard))
        if len(live.heard) > live.at_start:
            self._drop()
        return self._told(row, message)

    def _told(self, row: Row, message: str) -> str:
        """A message without the temporary folder; lines of a changed scene are nobody's."""
        if self._package:
            place = re.escape(f"{self._package.folder}/resources/")
            message = re.sub(
                place + (r"(scene\.toml)(:\d+)?" if row.scene else "()"), r"\1", message
            )
        beyond = len(message) - _LONGEST_MESSAGE
        return message if beyond <= 0 else f"{message[:_LONGEST_MESSAGE]}… ({beyond} letters more)"

    def close(self) -> None:
        """Ends the instance and removes what was unpacked."""
        self._drop()
        self._scene = None
        if self._temporary:
            shutil.rmtree(self._temporary, ignore_errors=True)
            self._temporary = None

    def _drop(self) -> None:
        if self._live:
            live, self._live = self._live, None
            try:
                live.unit.close()
            except ImpingeError:
                pass  # it has failed already

    def _values(self, row: Row) -> list[np.ndarray]:
        live = self._start(row)
        run = Run(live, self.experiment, row)
        live.fresh = False
        series = run.series()
        values = [o.value(run.times, series, run.is_multiple) for o in self.experiment.outputs]
        for output, value in zip(self.experiment.outputs, values, strict=True):
            # A function may say that something has not come about; a unit may not.
            if output.function is None and not np.all(np.isfinite(value)):
                raise ValueError(f"output {output.name} is not finite")
        return values

    def _start(self, row: Row) -> Live:
        """An instance just initialised with the row's parameters."""
        package = self._of_scene(row)
        parameters = dict(row.parameters)
        live = self._live
        if live is None:
            live = self._live = Live.of(package, parameters)
        elif live.state is not None and live.parameters == parameters:
            live.unit.restore(live.state)
        elif not (live.fresh and live.parameters == parameters):
            live = self._initialise_anew(live, package, parameters)
        if row.keeps and live.state is None and live.unit.can.states:
            live.state = live.unit.state()
        return live

    def _initialise_anew(self, live: Live, package: Package, parameters: dict[str, Any]) -> Live:
        if live.heard:
            self._drop()
            self._live = Live.of(package, parameters)
            return self._live
        if live.state is not None:
            live.state.free()
            live.state = None
        live.parameters = parameters
        live.unit.reset(parameters)
        live.at_start = len(live.heard)
        return live

    def _of_scene(self, row: Row) -> Package:
        if self._scene == row.scene and self._package:
            return self._package
        self.close()
        if not row.scene:
            self._package = open_package(self.base)
        elif row.variant is None:
            raise ValueError(f"row {row.index} came without its unit")
        else:
            self._temporary = Path(tempfile.mkdtemp(dir=temporary_folder().path))
            self._package = row.variant.unpack(self.base, self._temporary)
        self._scene = row.scene
        return self._package


class Run:
    """One run of an instance, which it leaves at the stop."""

    def __init__(self, live: Live, experiment: Experiment, row: Row):
        self.live = live
        self.unit = live.unit
        self.experiment = experiment
        # A stress may cost a solve: what is asked for at the stop is read there alone.
        self.always = _needs(output for output in experiment.outputs if output.needs_all_times)
        self.at_stop = tuple(n for n in _needs(experiment.outputs) if n not in self.always)
        signals = {**experiment.inputs, **row.inputs}
        held = {n: s for n, s in signals.items() if not (callable(s) or isinstance(s, Table))}
        moving = {n: s for n, s in signals.items() if n not in held}
        line = self._timeline(moving, row.sampled)
        self.times, self.courses = line.times, line.courses
        near = self.times / experiment.step
        self.is_multiple = np.abs(near - np.rint(near)) < 1e-9 * np.maximum(near, 1.0)
        self.is_multiple[-1] = True
        self.sizes = np.diff(self.times)
        even = np.abs(self.sizes - experiment.step) <= 1e-9 * experiment.step
        self.sizes[even] = experiment.step  # one length, which units may remember
        if held:
            self.unit.set(held)

    def _timeline(self, moving: Mapping[str, Signal], sampled: Mapping[str, Any]) -> Timeline:
        if self.live.timeline is not None:
            return self.live.timeline
        stop, step = self.experiment.stop, self.experiment.step
        discrete = [name for name in moving if self.unit.variable(name).is_discrete]
        found = timeline(stop, step, moving, self.unit.can.variable_steps, sampled, discrete)
        if not any(callable(s) and takes_parameters(s) for s in moving.values()):
            self.live.timeline = found
        return found

    def series(self) -> dict[str, np.ndarray]:
        """Values of all variables that outputs need, shape (times, *shape of the variable): at all
        times, or at the last one alone where that is enough."""
        found = {}
        every = self.live.reader(self.always) if self.always else None
        rows = np.empty((len(self.times), len(every.values) if every else 0))
        if self.courses:
            self._advance_moving(rows, every)
        else:
            self._advance_held(rows, every)
        if every:
            rows[-1] = every()
            found.update(_by_name(every, rows))
        if self.at_stop:
            last = self.live.reader(self.at_stop)
            found.update(_by_name(last, last()[None, :]))
        return found

    def _advance_held(self, rows: np.ndarray, reader: Any) -> None:
        step = self.unit.step
        for number, size in enumerate(self.sizes.tolist()):
            if reader:
                rows[number] = reader()
            step(size)

    def _advance_moving(self, rows: np.ndarray, reader: Any) -> None:
        """Inputs follow a parabola over each step, as far as the unit can; else they are held at
        their value in the middle, counts at that of the beginning. Values are read under the inputs
        of their time."""
        order = self.unit.can.interpolates
        write = self.unit.writer(self.courses)
        courses = self.courses.values()
        first, middle, last = (
            np.hstack([getattr(c, part) for c in courses]) for part in ("begins", "middles", "ends")
        )
        if first.shape[1] != len(write.values):
            raise ValueError(f"{first.shape[1]} values for inputs {', '.join(self.courses)}")
        slopes = _derivatives(first, middle, last, self.sizes[:, None], order)
        follows = {
            variable.name: (variable.shape, place)
            for variable, place in zip(write.variables, write.slices, strict=True)
            # Tunable parameters have no derivatives.
            if order and variable.causality == "input" and not variable.is_discrete
        }
        is_held = np.ones(first.shape[1], bool)
        for _, place in follows.values():
            is_held[place] = False
        over_step = np.where(is_held, middle, first)
        for number, size in enumerate(self.sizes.tolist()):
            write.values[:] = first[number]
            write()
            if reader:
                rows[number] = reader()
            if is_held.any():
                write.values[:] = over_step[number]
                write()
            if follows:
                self.unit.set_input_derivatives(
                    {
                        name: [slope[number, place].reshape(shape) for slope in slopes]
                        for name, (shape, place) in follows.items()
                    }
                )
            self.unit.step(size)
        write.values[:] = last[-1]
        write()


def _needs(outputs: Iterable[Output]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(name for output in outputs for name in output.needs))


def _by_name(reader: Any, rows: np.ndarray) -> dict[str, np.ndarray]:
    return {
        variable.name: rows[:, place].reshape(len(rows), *variable.shape).copy()
        for variable, place in zip(reader.variables, reader.slices, strict=True)
    }


def _derivatives(
    first: np.ndarray, middle: np.ndarray, last: np.ndarray, size: np.ndarray, order: int
) -> list[np.ndarray]:
    """First and second derivative at its beginning of the line or parabola through the values of a
    step."""
    if order < 2:
        return [(last - first) / size]
    return [
        (4.0 * middle - 3.0 * first - last) / size,
        4.0 * (first - 2.0 * middle + last) / size**2,
    ]
