"""A run in time: steps that are tried, taken, repeated shorter or refused, and what they leave."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from impinge.errors import UnitError
from impinge.function import FunctionUnit
from impinge.master.any_unit import AnyUnit
from impinge.master.assembly import Drive
from impinge.master.energy import Balance
from impinge.master.engine import Component, Engine, NoConvergence, refused
from impinge.master.errors import MasterError
from impinge.master.exchange import Exchange
from impinge.master.notes import Notes
from impinge.master.participant import Participant
from impinge.master.record import Record
from impinge.master.stepping import Schedule
from impinge.master.watch import Watch

_PATHS = ("constant", "straight line", "parabola")  # of driven inputs over a step, by their degree


@dataclass(kw_only=True)
class March:
    """Steps of all units from one time on.

    tolerance: of each step's error in time where `adaptive`; iteration_tolerance: of residuals.
    """

    units: Mapping[str, AnyUnit]
    participants: Mapping[str, Participant]
    components: Sequence[Component]
    drives: Sequence[Drive]
    engine: Engine
    exchange: Exchange
    schedule: Schedule
    watch: Watch
    balances: Sequence[Balance]
    powers: Sequence[Balance]
    record: Record
    notes: Notes
    time: float
    adaptive: bool
    strict: bool
    tolerance: float
    iteration_tolerance: float
    steps: int = 0
    rejected: int = 0
    most_iterations: int = 0
    unconverged: int = 0
    has_begun: bool = False

    def __post_init__(self) -> None:
        self.functions = [unit for unit in self.units.values() if isinstance(unit, FunctionUnit)]

    def begin(self, stop: float = np.inf) -> None:
        engine = self.engine
        self._read_start(engine.inputs)
        self.schedule.restart(self.time)
        size = self.schedule.end_of_step(self.time, stop) - self.time
        for _, function in self.drives:
            function.look(self.time, self.time + size)
        engine.drive_after(engine.inputs, self.time, size)
        # Twice: what follows inputs at once may have been read before these were set.
        for _ in range(2):
            self.exchange(engine.inputs, self.iteration_tolerance)
        engine.see(engine.inputs)
        weight = engine.weights(engine.inputs)
        for participant in self.participants.values():
            place = participant.place
            values, shares = engine.inputs[place], weight[place]
            unknown = participant.probe(values, shares, self.schedule.step)
            if unknown and self.engine.order:
                self.notes.add(
                    f"{participant.name} {unknown}, so that its outputs are taken as computed in"
                    " its steps from inputs at their ends: of first order if they are states that"
                    " it does not declare to follow no input at once"
                )
        engine.begin(self.time)
        self.watch.begin(engine.inputs)
        for balance in self.balances:
            balance.begin()
        self._settle()
        self.record.add(self.time, self.balances)
        self.has_begun = True

    def look(self, stop: float) -> None:
        """Takes values of functions of time up to `stop`, so that their ranges are known."""
        for _, function in self.drives:
            function.look(self.time, stop)

    def _read_start(self, inputs: np.ndarray) -> None:
        for participant in self.participants.values():
            if participant.writer is not None:
                inputs[participant.place] = participant.unit.reader(participant.names)()

    def step(self, stop: float) -> bool:
        """Tries a step; whether it was accepted."""
        end = self.schedule.end_of_step(self.time, stop)
        for _, function in self.drives:
            function.look(self.time, end)
        if self._cross(end - self.time):
            end = self.schedule.end_of_step(self.time, stop)
        end = self._cut(end)
        size = end - self.time
        is_jump = end in self.schedule.jumps
        for function in self.functions:
            function.ends_at_jump = is_jump
        self._save()
        try:
            is_strict = self.strict or self.adaptive
            self.engine.advance(self.time, end, self.iteration_tolerance, is_strict)
        except (NoConvergence, UnitError) as error:
            if not self._may_go_on(error, size):
                return False
        if self.adaptive and not self._is_good(end, size):
            return False
        self._accept(end, size, is_jump)
        return True

    def _cut(self, end: float) -> float:
        """The end of the step, or where before that an input jumps. Where a unit takes steps of one
        length alone, the mean of that input is held over the step; of whole numbers and the like
        what they are at its beginning."""
        self.engine.means = None
        found = [(place, f, f.jumps(self.time, end)) for place, f in self.drives]
        jumping = [each for each in found if each[2]]
        order = self.engine.order
        steep = [f.name for _, f, at in found if not at and f.is_steep(self.time, end, order)]
        if steep and not self.adaptive:  # whose error rejects such steps
            self.notes.add(
                f"{steep[0]} changes within the step from {self.time:.6g} s as no {_PATHS[order]}"
                " does: what it brings in is not exact (shorter steps help)",
                kind="steep",
            )
        if not jumping:
            return end
        if all(unit.can.variable_steps for unit in self.units.values()):
            return min(at[0] for _, _, at in jumping)
        self.engine.means = means = np.full(len(self.engine.inputs), np.nan)
        for place, function, _ in jumping:
            if self.engine.paths[place].all():
                means[place] = function.mean(self.time, end)
        place, function, at = jumping[0]
        held = "its mean over the step" if self.engine.paths[place].all() else "what it was before"
        self.notes.add(
            f"{function.name} jumps at {at[0]:.6g} s, within a step, and units take steps of"
            f" one length: {held} is held",
            kind="jump",
        )
        return end

    def _cross(self, size: float) -> bool:
        """Goes over to what functions of time are just after the beginning of a step of `size`,
        where they jump there; returns whether any does."""
        engine = self.engine
        new = engine.inputs.copy()
        engine.drive_after(new, self.time, size)
        if not any(
            np.abs(new[place] - engine.inputs[place]).max(initial=0.0) > function.tolerance
            for place, function in self.drives
            if not function.is_constant
        ):
            return False
        engine.inputs[:] = new
        self._go_over()
        if self.adaptive or self.schedule.graded:
            self.schedule.restart(self.time)
        return True

    def _go_over(self) -> None:
        """Goes on from the present inputs, just after a jump."""
        for function in self.functions:
            function.cross_jump()
        self.exchange(self.engine.inputs, self.iteration_tolerance)
        self.engine.begin(self.time)
        self.watch.jump()

    def _save(self) -> None:
        for component in self.components:
            if component.iterates or self.adaptive:
                for participant in component.members:
                    participant.save()

    def _may_go_on(self, error: Exception, size: float) -> bool:
        """Returns true if a step that failed is passed over, false if a shorter one follows."""
        if self.adaptive and refused(error):
            self._reject(size, str(error), error)
            self.schedule.shrink(size)
            return False
        if isinstance(error, NoConvergence):
            where = f"the step of {size:.6g} s from {self.time:.6g} s"
            if self.strict or error.is_final:
                raise MasterError(f"{where} does not converge: {error}") from None
            self.unconverged += 1
            self.notes.add(f"{where} does not converge: {error}", kind="unconverged")
            return True
        raise error

    def _is_good(self, end: float, size: float) -> bool:
        error, name = self.engine.error(end, size)
        error /= self.tolerance
        guessed = any(c.guessed and not c.iterates for c in self.components)
        order = self.engine.extrapolation if guessed else self.engine.order
        self.schedule.propose(size, error, order, error <= 1)
        if error > 1:
            self._reject(
                size,
                f"the error of {name} is {error:.2g} times the tolerance; a larger `tolerance`, or"
                " `scale` of its Connection, allows more",
            )
        return error <= 1

    def _reject(self, size: float, why: str, error: Exception | None = None) -> None:
        self.rejected += 1
        if size < self.schedule.least:
            raise MasterError(
                f"at {self.time:.6g} s a step of {size:.3g} s is still too long"
                f" (least_step={self.schedule.least:.3g}): {why}"
            ) from error
        for participant in self.participants.values():
            participant.restore()

    def _accept(self, end: float, size: float, is_jump: bool) -> None:
        engine = self.engine
        if balances := [*self.balances, *self.powers]:
            given = engine.given(end, size)
            for balance in balances:
                balance.add(size, engine.arrived, given)
        earlier, is_stale = list(engine.history.nodes), engine.is_stale
        engine.accept(end)
        self.time = end
        self.steps += 1
        self.most_iterations = max(self.most_iterations, engine.last_iterations)
        if any(c.has_guesses_left for c in self.components):
            self.exchange(engine.inputs, self.iteration_tolerance)
            engine.history.nodes[-1] = (end, engine.inputs.copy())
        if is_jump or is_stale:
            self.watch.jump()
        else:
            for course in self.watch.courses:
                error = engine.mean_error(course.link, earlier, end, size)
                course.add(earlier[-1][1], engine.inputs, error)
        if is_jump:
            engine.drive_after(engine.inputs, end, size)
            self._go_over()
            self.schedule.restart(end)
        self._settle()
        self.record.add(end, self.balances)

    def _settle(self) -> None:
        """Functions whose outputs nobody reads count their steps, too."""
        for function in self.functions:
            function.settle()

    def judge(self) -> None:
        """Warns, once, of steps that are too long for what rings of units pass on, or too few to
        tell."""
        if self.adaptive:
            return
        guessed = any(c.guessed and not c.iterates for c in self.components)
        order = self.engine.extrapolation if guessed else self.engine.order
        step = self.schedule.step
        for kind, text in (
            ("steps", self.watch.warning(step, order, self.schedule.graded is not None)),
            ("energy", self.watch.warning_of_energy(self.powers, step, order)),
            ("few", self.watch.warning_of_few(self.steps)),
        ):
            if text:
                self.notes.add(text, kind=kind)
