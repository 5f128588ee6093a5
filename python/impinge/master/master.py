"""A master: several units, what joins them, and a run in time."""

from __future__ import annotations

import os
import time
import warnings
from collections.abc import Collection, Mapping, Sequence
from typing import Any

import numpy as np
import xarray
from tqdm import tqdm

from impinge.errors import UnitError
from impinge.function import Function, FunctionUnit
from impinge.jumps import Watched
from impinge.master.acceleration import acceleration as make_acceleration
from impinge.master.any_unit import AnyUnit
from impinge.master.checks import (
    check_choices,
    check_count,
    check_input,
    check_jumps,
    check_lengths,
    check_memoryless,
    check_names,
    check_rollback,
    check_set,
    check_stop,
    check_units,
    flat_numbers,
)
from impinge.master.connection import Connection, Link, links, split
from impinge.master.energy import Balance, bond, powers
from impinge.master.engine import Component, Engine, NoConvergence, refused
from impinge.master.errors import MasterError, MasterWarning
from impinge.master.exchange import Exchange
from impinge.master.function_participant import FunctionParticipant
from impinge.master.graph import best_order, unit_components
from impinge.master.interruption import interruptible_between_steps
from impinge.master.participant import Participant
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
    jumps: times [s] at which inputs jump; no path reaches across them.
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
        self.notes: list[str] = []
        self._warned: set[str] = set()
        self._own: list[Unit] = []
        self.units: dict[str, AnyUnit] = {}
        try:
            self._open(units, parameters or {})
            self.scheme, self.acceleration, self.order = scheme, acceleration, order
            self.extrapolation = 0 if extrapolation is None else extrapolation
            self.adaptive, self.strict = adaptive, strict
            self.tolerance = (1e-3 if adaptive else 1e-6) if tolerance is None else tolerance
            check_jumps(jumps, self.time)
            self.links = links(connections, self.units)
            self._make_participants(inputs or {}, memoryless)
            self._make_components(relaxation, reuse)
            self._fall_back(graded)
            self._engine = Engine(
                list(self.participants.values()),
                self.links,
                self.components,
                self._drives,
                order,
                self.extrapolation,
                max_iterations,
            )
            self._exchange = Exchange(self.participants, self.links, self.units)
            self._balances = [Balance(bond(each), self.links, self.units) for each in energy]
            self._powers = powers(self.links, self.units)
            sources = [link.connection.source for link in self.links]
            self._record = Record(self.units, [*sources, *outputs])
            step = self._proposed_step() if step is None else step
        except BaseException:
            self.close()
            raise
        graded = Graded(graded) if isinstance(graded, int | float) else graded
        least = step * 1e-9 if least_step is None else least_step
        self._schedule = Schedule(step, graded, jumps, self.adaptive, least, largest_step)
        self._iteration_tolerance = self.tolerance * (0.1 if self.adaptive else 1.0)
        self._watch = Watch(
            self.units, self.links, self._exchange.loops, scheme, self._iteration_tolerance
        )
        self.steps = self.rejected = self.most_iterations = self.unconverged = 0
        self.seconds = 0.0
        self._has_begun = False

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
            ("steps", f"{self.steps} so far, {step} {self._schedule.step:g} s"),
            ("records", listed(self._record.names)),
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

    def _open(self, units: Mapping[str, Any], parameters: Mapping[str, Mapping[str, Any]]) -> None:
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
        self.time = times.pop() if times else 0.0
        for name, unit in units.items():
            is_function = isinstance(unit, Function)
            self.units[name] = unit.open(name, self.time) if is_function else opened[name]

    def _make_participants(self, inputs: Mapping[str, Any], memoryless: Collection[str]) -> None:
        self.participants = {name: _participant(name, unit) for name, unit in self.units.items()}
        self._functions = [u for u in self.units.values() if isinstance(u, FunctionUnit)]
        check_memoryless(memoryless, self.units)
        for link in self.links:
            self.participants[link.source_unit].links_out.append(link)
            self.participants[link.target_unit].links_in.append(link)
        targets = {link.connection.target for link in self.links}
        driven: dict[str, list[tuple[str, Any]]] = {}
        for name, value in inputs.items():
            unit, variable = split(name, self.units)
            if name in targets:
                raise MasterError(f"{name} is set by a connection already")
            check_input(self.units[unit], name, variable)
            driven.setdefault(unit, []).append((variable, value))
        for function in self._functions:
            check_set(
                function,
                {link.target for link in self.links if link.target_unit == function.name}
                | {variable for variable, _ in driven.get(function.name, [])},
            )
        self._drives: list[tuple[slice, Watched]] = []
        count = 0
        for name, participant in self.participants.items():
            participant.memoryless = name in memoryless
            begin, names, paths = count, [], []
            for link in participant.links_in:
                link.place = slice(count, count + link.size)
                count += link.size
                names.append(link.target)
                paths.append(np.full(link.size, link.is_real))
            for variable, value in driven.get(name, []):
                target = self.units[name].variable(variable)
                place = slice(count, count + target.size)
                count += target.size
                self._drives.append((place, _function(f"{name}.{variable}", value, target.shape)))
                names.append(variable)
                real = target.is_real and target.variability == "continuous"
                paths.append(np.full(target.size, real))
            participant.place = slice(begin, count)
            mask = np.concatenate(paths) if paths else np.zeros(0, bool)
            participant.connect(names, mask, self.order)

    def _make_components(self, relaxation: float | None, reuse: int | None) -> None:
        if self.scheme == "jacobi":
            groups = [list(self.units)]
        else:
            groups = [
                best_order(self.units, group, self.links)
                for group in unit_components(self.units, self.links)
            ]
        self.components = []
        for group in groups:
            place = {name: i for i, name in enumerate(group)}
            inner = [k for k in self.links if k.source_unit in place and k.target_unit in place]
            guessed = [
                k
                for k in inner
                if self.scheme == "jacobi" or place[k.source_unit] >= place[k.target_unit]
            ]
            iterates = self.scheme == "iterate" and any(k.is_real for k in guessed)
            made = make_acceleration(self.acceleration, relaxation, reuse)
            members = [self.participants[name] for name in group]
            self.components.append(Component(members, guessed, iterates, made))

    def _fall_back(self, graded: Graded | float | None) -> None:
        """Does without what units cannot do, and says so."""
        repeated = [p.name for c in self.components if c.iterates for p in c.members]
        check_rollback(self._functions, repeated, self.adaptive)
        for component in self.components:
            stuck = [p.name for p in component.members if not p.can_go_back]
            if component.iterates and stuck:
                component.iterates = False
                self._note(f"{_list(stuck)} cannot go back: no iterations, but Gauss-Seidel steps")
        stuck = [p.name for p in self.participants.values() if not p.can_go_back]
        if self.adaptive and stuck:
            self.adaptive = False
            self._note(f"{_list(stuck)} cannot go back: steps of one length")
        fixed = [name for name, unit in self.units.items() if not unit.can.variable_steps]
        if fixed and (self.adaptive or graded is not None):
            raise MasterError(f"{_list(fixed)} take steps of one length alone")
        self.held = [
            p.name for p in self.participants.values() if self.order and p.writer and not p.order
        ]

    def _note(self, text: str, stacklevel: int = 4) -> None:
        """Warns of something once, and keeps it for the result, in one line."""
        text = " ".join(text.split())
        if text not in self.notes:
            self.notes.append(text)
            warnings.warn(text, MasterWarning, stacklevel=stacklevel)

    def _proposed_step(self) -> float:
        proposed = [unit.default_step for unit in self.units.values() if unit.default_step]
        if not proposed:
            raise MasterError("no unit proposes a step: Master(…, step=…)")
        check_lengths(min(proposed), None, None, np.inf)
        return min(proposed)

    @property
    def algebraic_loops(self) -> list[list[str]]:
        """Sources of connections that follow each other at once."""
        return [[link.connection.source for link in loop] for loop in self._exchange.loops]

    # Running

    def run(self, stop: float, *, progress: bool | None = None) -> xarray.Dataset:
        """Goes on to `stop` [s]; what has been recorded since the start comes back.

        progress: whether a bar is shown; only in runs of more than two seconds if left out.

        Ctrl-C ends the run after the present step; another `run` goes on from there.
        """
        began = time.perf_counter()
        check_stop(stop, self.time)
        check_count(None if self.adaptive else self._schedule.step, stop - self.time)
        if not self._has_begun:
            self._begin(stop)
        bar = tqdm(
            total=stop,
            initial=self.time,
            unit="s",
            unit_scale=True,
            delay=0.0 if progress else 2.0,
            disable=False if progress else (None if progress is None else True),
            leave=False,
        )
        with bar, interruptible_between_steps() as check_for_interruption:
            while self.time < stop:
                check_for_interruption()
                if self._step(stop):
                    bar.n = self.time
                    bar.set_postfix_str(f"{self.steps} steps", refresh=False)
                    bar.update(0)
        self.seconds += time.perf_counter() - began
        self._judge()
        return self._record.dataset(self._balances, self._attributes())

    def _begin(self, stop: float = np.inf) -> None:
        engine = self._engine
        self._read_start(engine.inputs)
        self._schedule.restart(self.time)
        size = self._schedule.end_of_step(self.time, stop) - self.time
        for _, function in self._drives:
            function.look(self.time, self.time + size)
        engine.drive_after(engine.inputs, self.time, size)
        # Twice: what follows inputs at once may have been read before these were set.
        for _ in range(2):
            self._exchange(engine.inputs, self._iteration_tolerance)
        engine.see(engine.inputs)
        weight = engine.weights(engine.inputs)
        for participant in self.participants.values():
            place = participant.place
            values, shares = engine.inputs[place], weight[place]
            unknown = participant.probe(values, shares, self._schedule.step)
            if unknown and self.order:
                self._note(
                    f"{participant.name} {unknown}, so that its outputs are taken as computed in"
                    " its steps from inputs at their ends: of first order if they are states that"
                    " it does not declare to follow no input at once"
                )
        engine.begin(self.time)
        self._watch.begin(engine.inputs)
        for balance in self._balances:
            balance.begin()
        self._settle()
        self._record.add(self.time, self._balances)
        self._has_begun = True

    def _read_start(self, inputs: np.ndarray) -> None:
        for participant in self.participants.values():
            if participant.writer is not None:
                inputs[participant.place] = participant.unit.reader(participant.names)()

    def _step(self, stop: float) -> bool:
        """Tries a step; whether it was accepted."""
        end = self._schedule.end_of_step(self.time, stop)
        for _, function in self._drives:
            function.look(self.time, end)
        end = self._cut(end)
        size = end - self.time
        is_jump = end in self._schedule.jumps
        self._cross(size)
        for function in self._functions:
            function.ends_at_jump = is_jump
        self._save()
        try:
            self._engine.advance(self.time, end, self._iteration_tolerance)
        except (NoConvergence, UnitError) as error:
            if not self._may_go_on(error, size):
                return False
        if self.adaptive and not self._is_good(end, size):
            return False
        self._accept(end, size, is_jump)
        return True

    def _cut(self, end: float) -> float:
        """The end of the step, or where before that an input jumps. Where a unit takes steps of one
        length alone, the mean of that input is held over the step."""
        self._engine.means = None
        found = [(place, f, f.jumps(self.time, end)) for place, f in self._drives]
        jumping = [each for each in found if each[2]]
        steep = [f.name for _, f, at in found if not at and f.is_steep(self.time, end)]
        if steep and "steep" not in self._warned:
            self._warned.add("steep")
            self._note(
                f"{steep[0]} changes within the step from {self.time:.6g} s as no parabola does:"
                " what it brings in is not exact",
                stacklevel=5,
            )
        if not jumping:
            return end
        if all(unit.can.variable_steps for unit in self.units.values()):
            return min(at[0] for _, _, at in jumping)
        self._engine.means = means = np.full(len(self._engine.inputs), np.nan)
        for place, function, _ in jumping:
            means[place] = function.mean(self.time, end)
        if "jump" not in self._warned:
            self._warned.add("jump")
            _, function, at = jumping[0]
            self._note(
                f"{function.name} jumps at {at[0]:.6g} s, within a step, and units take steps of"
                " one length: its mean over the step is held",
                stacklevel=5,
            )
        return end

    def _cross(self, size: float) -> None:
        """Goes over to what functions of time are just after the beginning of the step, where they
        jump there."""
        engine = self._engine
        new = engine.inputs.copy()
        engine.drive_after(new, self.time, size)
        if not any(
            np.abs(new[place] - engine.inputs[place]).max(initial=0.0) > function.tolerance
            for place, function in self._drives
            if not function.is_constant
        ):
            return
        engine.inputs[:] = new
        self._exchange(engine.inputs, self._iteration_tolerance)
        engine.begin(self.time)
        self._watch.jump()
        if self.adaptive or self._schedule.graded:
            self._schedule.restart(self.time)

    def _save(self) -> None:
        for component in self.components:
            if component.iterates or self.adaptive:
                for participant in component.members:
                    participant.save()

    def _may_go_on(self, error: Exception, size: float) -> bool:
        """What to do with a step that failed: a shorter one, an error, or to pass over it."""
        if self.adaptive and refused(error):
            self._reject(size, error)
            self._schedule.shrink(size)
            return False
        if isinstance(error, NoConvergence):
            where = f"the step of {size:.6g} s from {self.time:.6g} s"
            if self.strict or "finite" in str(error):
                raise MasterError(f"{where} does not converge: {error}") from None
            self.unconverged += 1
            if self.unconverged == 1:
                self._note(f"{where} does not converge: {error}", stacklevel=5)
            return True
        raise error

    def _is_good(self, end: float, size: float) -> bool:
        error = self._engine.error(end, size) / self.tolerance
        guessed = any(c.guessed and not c.iterates for c in self.components)
        order = self.extrapolation if guessed else self.order
        self._schedule.propose(size, error, order, error <= 1)
        if error > 1:
            self._reject(size)
        return error <= 1

    def _reject(self, size: float, error: Exception | None = None) -> None:
        self.rejected += 1
        if size < self._schedule.least:
            why = "" if error is None else f": {error}"
            raise MasterError(
                f"at {self.time:.6g} s a step of {size:.3g} s is still too long"
                f" (least_step={self._schedule.least:.3g}){why}"
            ) from error
        for participant in self.participants.values():
            participant.restore()

    def _accept(self, end: float, size: float, is_jump: bool) -> None:
        engine = self._engine
        if balances := [*self._balances, *self._powers]:
            given = engine.given(end, size)
            for balance in balances:
                balance.add(size, engine.arrived, given)
        earlier, is_stale = list(engine.history.nodes), engine.is_stale
        engine.accept(end)
        self.time = end
        self.steps += 1
        self.most_iterations = max(self.most_iterations, engine.last_iterations)
        if is_jump:
            engine.drive_after(engine.inputs, end, size)
            for function in self._functions:
                function.cross_jump()
        if is_jump or any(c.has_guesses_left for c in self.components):
            self._exchange(engine.inputs, self._iteration_tolerance)
            engine.history.nodes[-1] = (end, engine.inputs.copy())
        if is_jump or is_stale:
            self._watch.jump()
        else:
            for course in self._watch.courses:
                error = engine.mean_error(course.link, earlier, end, size)
                course.add(earlier[-1][1], engine.inputs, error)
        if is_jump:
            engine.begin(end)
            self._schedule.restart(end)
        self._settle()
        self._record.add(end, self._balances)

    def _settle(self) -> None:
        """Functions whose outputs nobody reads count their steps, too."""
        for function in self._functions:
            function.settle()

    def _judge(self) -> None:
        """Warns, once, of steps that are too long for what rings of units pass on, or too few to
        tell."""
        if self.adaptive:
            return
        guessed = any(c.guessed and not c.iterates for c in self.components)
        order = self.extrapolation if guessed else self.order
        step = self._schedule.step
        for key, text in (
            ("steps", self._watch.warning(step, order)),
            ("energy", self._watch.warning_of_energy(self._powers, step, order)),
            ("few", self._watch.warning_of_few(self.steps)),
        ):
            if text and key not in self._warned:
                self._warned.add(key)
                self._note(text)

    def _attributes(self) -> dict[str, Any]:
        import impinge

        told: dict[str, Any] = {
            "scheme": self.scheme,
            "order": self.order,
            "extrapolation": self.extrapolation,
            "tolerance": self.tolerance,
            "adaptive": int(self.adaptive),
            "order_of_units": " ".join(p.name for c in self.components for p in c.members),
            "algebraic_loops": len(self.algebraic_loops),
            "steps": self.steps,
            "rejected": self.rejected,
            "iterations": self._engine.iterations,
            "most_iterations": self.most_iterations,
            "unconverged": self.unconverged,
            "path_error": self._watch.error(self.steps),
            "energy_error": max((balance.share for balance in self._powers), default=0.0),
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
        for balance in self._balances:
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


def _participant(name: str, unit: AnyUnit) -> Participant:
    kind = FunctionParticipant if isinstance(unit, FunctionUnit) else Participant
    return kind(name, unit)


def _function(name: str, value: Any, shape: tuple[int, ...]) -> Watched:
    """A constant or a function of time as a function of time that gives a flat array."""
    if callable(value):
        return Watched(name, lambda time: flat_numbers(name, value(time), shape))
    constant = flat_numbers(name, value, shape)
    return Watched(name, lambda _: constant, is_constant=True)


def _told(unit: Unit | FunctionUnit) -> str:
    """Describes a unit in short."""
    if isinstance(unit, Unit):
        return f"{unit.name} (FMI {unit.package.fmi})"
    return f"function {unit.function.name}"


def _list(names: Sequence[str]) -> str:
    return ", ".join(names)


__all__ = ["Link", "Master"]
