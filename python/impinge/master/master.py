"""A master: several units, what joins them, and a run in time."""

from __future__ import annotations

import os
import time
from collections.abc import Collection, Mapping, Sequence
from typing import Any

import numpy as np
import xarray
from tqdm import tqdm

from impinge.function import Function, FunctionUnit
from impinge.master.any_unit import AnyUnit
from impinge.master.assembly import components, join
from impinge.master.checks import (
    check_choices,
    check_count,
    check_end,
    check_jumps,
    check_lengths,
    check_memoryless,
    check_names,
    check_rollback,
    check_stop,
    check_units,
)
from impinge.master.connection import Connection, Link, links
from impinge.master.energy import Balance, bond, powers
from impinge.master.engine import Engine
from impinge.master.errors import MasterError
from impinge.master.exchange import Exchange
from impinge.master.interruption import interruptible_between_steps
from impinge.master.march import March
from impinge.master.notes import Notes
from impinge.master.record import Record
from impinge.master.stepping import Graded, Schedule
from impinge.master.watch import Watch
from impinge.summary import Summary, Table, listed, variables
from impinge.unit import Unit


class Master:
    """Couples units of FMI 2.0 and 3.0, of any tool, and Python functions.

    units: by name, each a `Unit`, what one is made of (those are closed with the master), or a
        `Function`.
    connections: pairs ("unit.output", "unit.input") or `Connection`s; families connect whole.
    scheme: "jacobi": all units advance on extrapolated inputs; "gauss-seidel": in the order that
        declared dependencies give, on what those before them have just found; "iterate": rings of
        units repeat each step, from saved states, until what was guessed comes out.
    acceleration: of iterations: "none", "aitken", "anderson", "iqn-ils"; `relaxation` is the factor
        of the first iteration, `reuse` the earlier steps whose columns IQN-ILS keeps.
    step: communication step [s]; the first one where `adaptive`. The shortest that a unit proposes
        if left out.
    tolerance: of residuals of iterations, as a share of each connection's scale (1e-6); where
        `adaptive`, of each step's error in time (1e-3), with iterations to a tenth of that.
    order: degree in time, 0 to 2, of paths that inputs follow over a step through values at its
        ends and before. Units that cannot follow them get the mean, or the end where their
        outputs come from their steps alone.
    extrapolation: degree of paths through earlier values alone; 0 holds inputs.
    adaptive: steps as long as the error allows; those that miss it are repeated shorter.
    graded: `Graded(over, exponent)`, or the time `over`: shorter steps after the start and jumps.
    jumps: times [s] at which inputs jump; no path reaches across them. Where units take steps of
        one length, they are at ends of these, as is where a run stops.
    inputs: values, or functions of time [s], of inputs that no connection sets. Steps end where
        these jump, or hold the mean where units take steps of one length.
    energy: powers to balance: `Bond`s, or pairs (flux output, effort output).
    outputs: what to record beside the sources of connections.
    memoryless: units without a state of their own, which may take a step again without going back.
    parameters: of units that are made here, by unit.
    strict: whether iterations without end are an error; else a warning, and the run goes on.

    Steps of one length whose paths are off by more than a tenth of what rings of units pass on are
    warned of at the end of a run.

    Raises `MasterError` for what does not fit together, `UnitError` for what units refuse.
    """

    def __init__(
        self,
        units: Mapping[str, Unit | Function | str | os.PathLike[str]],
        connections: Sequence[Connection | tuple[str, str]] = (),
        *,
        scheme: str = "iterate",
        acceleration: str = "iqn-ils",
        step: float | None = None,
        tolerance: float | None = None,
        order: int = 1,
        extrapolation: int | None = None,
        adaptive: bool = False,
        graded: Graded | float | None = None,
        jumps: Sequence[float] = (),
        inputs: Mapping[str, Any] | None = None,
        energy: Sequence[Any] = (),
        outputs: Sequence[str] = (),
        max_iterations: int = 50,
        relaxation: float | None = None,
        reuse: int | None = None,
        least_step: float | None = None,
        largest_step: float = np.inf,
        memoryless: Collection[str] = (),
        parameters: Mapping[str, Mapping[str, Any]] | None = None,
        strict: bool = True,
    ):
        check_choices(scheme, order, extrapolation, max_iterations, relaxation)
        check_lengths(step, tolerance, least_step, largest_step)
        check_units(units, parameters or {})
        check_names("outputs", outputs)
        check_names("energy", energy)
        self._notes = Notes()
        self._own: list[Unit] = []
        self.units: dict[str, AnyUnit] = {}
        try:
            start = self._open(units, parameters or {})
            self.scheme, self.acceleration, self.order = scheme, acceleration, order
            self.extrapolation = 0 if extrapolation is None else extrapolation
            self.adaptive, self.strict = adaptive, strict
            self.tolerance = (1e-3 if adaptive else 1e-6) if tolerance is None else tolerance
            check_jumps(jumps, start)
            self.links = links(connections, self.units, inputs or {})
            check_memoryless(memoryless, self.units)
            self.participants, drives = join(
                self.units, self.links, inputs or {}, memoryless, order, outputs
            )
            self.components = components(
                self.participants, self.links, scheme, acceleration, relaxation, reuse
            )
            self._fall_back(graded)
            engine = Engine(
                list(self.participants.values()),
                self.links,
                self.components,
                drives,
                order,
                self.extrapolation,
                max_iterations,
            )
            exchange = Exchange(self.participants, self.links, self.units)
            places = {link.connection.target: link.place for link in self.links}
            places |= {function.name: place for place, function in drives}
            balances = [Balance(bond(each), self.links, self.units, places) for each in energy]
            self._tell_of_areas(balances)
            sources = [link.connection.source for link in self.links]
            record = Record(self.units, [*sources, *outputs])
            step = self._proposed_step() if step is None else step
            for jump in jumps:
                check_end("jumps", jump, start, step, self._fixed)
        except BaseException:
            self.close()
            raise
        graded = Graded(graded) if isinstance(graded, int | float) else graded
        least = step * 1e-9 if least_step is None else least_step
        iteration_tolerance = self.tolerance * (0.1 if self.adaptive else 1.0)
        self._march = March(
            units=self.units,
            participants=self.participants,
            components=self.components,
            drives=drives,
            engine=engine,
            exchange=exchange,
            schedule=Schedule(step, graded, jumps, self.adaptive, least, largest_step),
            watch=Watch(self.units, self.links, exchange.loops, scheme, iteration_tolerance),
            balances=balances,
            powers=powers(self.links, self.units, places),
            record=record,
            notes=self._notes,
            time=start,
            adaptive=self.adaptive,
            strict=strict,
            tolerance=self.tolerance,
            iteration_tolerance=iteration_tolerance,
        )
        self.seconds = 0.0

    @property
    def time(self) -> float:
        """The time reached [s]."""
        return self._march.time

    @property
    def steps(self) -> int:
        """Steps taken so far."""
        return self._march.steps

    @property
    def notes(self) -> list[str]:
        """Warnings so far."""
        return self._notes.lines

    # Description

    def __repr__(self) -> str:
        return self._summary().text()

    def _repr_html_(self) -> str:
        return self._summary().html()

    def _summary(self) -> Summary:
        units = {name: _told(unit) for name, unit in self.units.items()}
        pairs = [(link.connection.source, link.connection.target) for link in self.links]
        scheme = f"{self.scheme}, {self.acceleration}" if self._iterates() else self.scheme
        step = "adaptive, first" if self.adaptive else "of"
        lines = [
            ("units", listed(f"{name} = {words}" for name, words in units.items())),
            ("connections", listed(f"{source} → {target}" for source, target in pairs)),
            ("scheme", f"{scheme}; order {self.order}, tolerance {self.tolerance:g}"),
            ("steps", f"{self.steps} so far, {step} {self._march.schedule.step:g} s"),
            ("records", listed(self._march.record.names)),
            *(("note", note) for note in self.notes),
        ]
        tables = [
            Table("connections", ("from", "to"), pairs),
            *(variables(f"inputs of {name}", unit.inputs) for name, unit in self.units.items()),
            *(variables(f"outputs of {name}", unit.outputs) for name, unit in self.units.items()),
        ]
        return Summary(f"<impinge.Master at {self.time!r} s>", lines, tables)

    def _iterates(self) -> bool:
        return any(component.iterates for component in self.components)

    # Making

    def _open(self, units: Mapping[str, Any], parameters: Mapping[str, Mapping[str, Any]]) -> float:
        """Opens what is not yet open; returns the time at which all stand [s]."""
        opened: dict[str, Unit] = {}
        for name, unit in units.items():
            if isinstance(unit, Unit):
                opened[name] = unit
            elif not isinstance(unit, Function):
                opened[name] = Unit(unit, parameters=parameters.get(name))
                self._own.append(opened[name])
        times = {unit.time for unit in opened.values()}
        if len(times) > 1:
            raise MasterError(f"units stand at different times: {sorted(times)} s")
        start = times.pop() if times else 0.0
        for name, unit in units.items():
            is_function = isinstance(unit, Function)
            self.units[name] = unit.open(name, start) if is_function else opened[name]
        return start

    def _fall_back(self, graded: Graded | float | None) -> None:
        """Does without what units cannot do, and says so."""
        repeated = [p.name for c in self.components if c.iterates for p in c.members]
        functions = [unit for unit in self.units.values() if isinstance(unit, FunctionUnit)]
        check_rollback(functions, repeated, self.adaptive)
        for component in self.components:
            stuck = [p.name for p in component.members if not p.can_go_back]
            if component.iterates and stuck:
                component.iterates = False
                self._notes.add(
                    f"{_list(stuck)} cannot go back: no iterations, but Gauss-Seidel steps"
                )
        stuck = [p.name for p in self.participants.values() if not p.can_go_back]
        if self.adaptive and stuck:
            self.adaptive = False
            self._notes.add(f"{_list(stuck)} cannot go back: steps of one length")
        self._fixed = [name for name, unit in self.units.items() if not unit.can.variable_steps]
        if self._fixed and (self.adaptive or graded is not None):
            raise MasterError(f"{_list(self._fixed)} take steps of one length alone")
        self.held = [
            p.name for p in self.participants.values() if self.order and p.writer and not p.order
        ]

    def _tell_of_areas(self, balances: Sequence[Balance]) -> None:
        """Warns of powers per area whose area is unknown."""
        for balance in balances:
            if balance.lacks_area:
                self._notes.add(
                    f"energy: no unit tells the area of {balance.name}, a power per m2: 1 m2 is"
                    " taken (Bond(…, area=…) sets it)"
                )

    def _proposed_step(self) -> float:
        proposed = [unit.default_step for unit in self.units.values() if unit.default_step]
        if not proposed:
            raise MasterError("no unit proposes a step: Master(…, step=…)")
        check_lengths(min(proposed), None, None, np.inf)
        return min(proposed)

    @property
    def algebraic_loops(self) -> list[list[str]]:
        """Sources of connections that follow each other at once."""
        return [[link.connection.source for link in loop] for loop in self._march.exchange.loops]

    # Running

    def run(self, stop: float, *, progress: bool | None = None) -> xarray.Dataset:
        """Goes on to `stop` [s]; what has been recorded since the start comes back.

        progress: whether a bar is shown; only in runs of more than two seconds if left out.

        Ctrl-C ends the run after the present step; another `run` goes on from there. If a unit
        fails, `record` has the rows before.
        """
        began = time.perf_counter()
        march = self._march
        check_stop(stop, march.time)
        check_end("run", stop, march.time, march.schedule.step, self._fixed)
        check_count(None if self.adaptive else march.schedule.step, stop - march.time)
        march.look(stop)
        if not march.has_begun:
            march.begin(stop)
        bar = tqdm(
            total=stop,
            initial=march.time,
            unit="s",
            unit_scale=True,
            delay=0.0 if progress else 2.0,
            disable=False if progress else (None if progress is None else True),
            leave=False,
        )
        with bar, interruptible_between_steps() as check_for_interruption:
            while march.time < stop:
                check_for_interruption()
                if march.step(stop):
                    bar.n = march.time
                    bar.set_postfix_str(f"{march.steps} steps", refresh=False)
                    bar.update(0)
        self.seconds += time.perf_counter() - began
        march.judge()
        return self.record

    @property
    def record(self) -> xarray.Dataset:
        """The rows recorded since the start; also those before a run failed."""
        return self._march.record.dataset(self._march.balances, self._attributes())

    def _attributes(self) -> dict[str, Any]:
        import impinge

        march = self._march
        told: dict[str, Any] = {
            "scheme": self.scheme,
            "order": self.order,
            "extrapolation": self.extrapolation,
            "tolerance": self.tolerance,
            "adaptive": int(self.adaptive),
            "order_of_units": " ".join(p.name for c in self.components for p in c.members),
            "algebraic_loops": len(self.algebraic_loops),
            "steps": march.steps,
            "rejected": march.rejected,
            "iterations": march.engine.iterations,
            "most_iterations": march.most_iterations,
            "unconverged": march.unconverged,
            "path_error": march.watch.error(march.steps),
            "energy_error": max((balance.share for balance in march.powers), default=0.0),
            "held_inputs": " ".join(self.held),
            "notes": "; ".join(self.notes),
            "warnings": "\n".join(self.notes),
            "seconds": self.seconds,
            "impinge": impinge.__version__,
        }
        if self._iterates():
            told["acceleration"] = self.acceleration
        for name, participant in self.participants.items():
            told[f"unit_steps.{name}"] = participant.steps
            told[f"unit.{name}"] = participant.unit.identity
            if participant.unit.scene:
                told[f"scene.{name}"] = participant.unit.scene
        for balance in march.balances:
            told[f"energy_residual.{balance.name}"] = balance.largest / (balance.moved or 1.0)
        return told

    # Life

    def close(self) -> None:
        """Ends the units that were made here."""
        for participant in getattr(self, "participants", {}).values():
            participant.free()
        for unit in self._own:
            unit.close()

    def __enter__(self) -> Master:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _told(unit: Unit | FunctionUnit) -> str:
    """Describes a unit in short."""
    if isinstance(unit, Unit):
        return f"{unit.name} (FMI {unit.package.fmi})"
    return f"function {unit.function.name}"


def _list(names: Sequence[str]) -> str:
    return ", ".join(names)


__all__ = ["Link", "Master"]
