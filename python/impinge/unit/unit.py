"""A unit whose variables go by their names."""

from __future__ import annotations

import itertools
import logging
import os
import struct
import zlib
from collections.abc import Iterable, Mapping, Sequence
from math import inf
from pathlib import Path
from typing import Any

import numpy as np

from impinge.errors import StepDiscarded, UnitError
from impinge.measure import Measure
from impinge.summary import Summary, listed, name_with_unit, variables
from impinge.unit.access import PathWriter, Reader, Writer
from impinge.unit.cells import areas_of, place_of
from impinge.unit.fmi2 import Fmi2
from impinge.unit.fmi3 import Fmi3
from impinge.unit.log import Listener, Log
from impinge.unit.package import Package, open_package
from impinge.unit.state import State
from impinge.unit.variable import Capabilities, Variable, stem_of

_COUNT = itertools.count(1)
_MAGIC = b"impinge\x02"
_HEAD = struct.Struct("<I")  # CRC-32 of what follows: the time, then the state
_TIME = struct.Struct("<d")


class Unit:
    """One initialised instance of a co-simulation unit, of FMI 2.0 or 3.0 and of any tool.

    source: a scene (`.toml`, built once for each content), a `.fmu` file, or a folder that one has
        been unzipped into. Instances of the same content share one folder and one library.
    parameters: values before initialisation, by name; inputs may be among them.
    fmi: the version that a scene is built for, 2 (default) or 3.
    start_time, stop_time: of the experiment, in s.
    logger: a function of (status, category, message) or a `logging.Logger` that hears the unit.

    `unit["spot.heat_flux"] = 5e7` sets, `unit["centre.temperature"]` reads; families such as
    `surface.temperature` are arrays of their shape in both versions of FMI, and their elements go
    by `surface.temperature[1,2]`. Raises `UnitError` with what the unit has logged.
    """

    def __init__(
        self,
        source: str | os.PathLike[str] | Package,
        *,
        parameters: Mapping[str, Any] | None = None,
        fmi: int | None = None,
        start_time: float = 0.0,
        stop_time: float | None = None,
        logger: Listener | logging.Logger | None = None,
    ):
        self.is_open = False
        self.package = source if isinstance(source, Package) else open_package(source, fmi)
        self._as_read = self.package
        self.start_time, self.stop_time = start_time, stop_time
        self._own_parameters = dict(parameters or {})
        self._readers: dict[tuple[str, ...], Reader] = {}
        self._writers: dict[tuple[str, ...], Writer] = {}
        self.log = Log(f"{self.package.name}-{next(_COUNT)}", logger)
        self.slave: Fmi2 | Fmi3 = (Fmi3 if self.package.fmi == 3 else Fmi2)(self.package, self.log)
        self.is_open = True
        self.time = start_time
        self._initialised = False
        try:
            self._initialise({})
        except BaseException:
            self.close()
            raise

    def _initialise(self, parameters: Mapping[str, Any]) -> None:
        values = {**self._own_parameters, **parameters}
        self.time = self.start_time
        if self.package is not self._as_read:
            self.package = self._as_read
            self._forget_accesses()
        structural = {
            name: values.pop(name)
            for name in list(values)
            if self.package.variable(name).causality == "structuralParameter"
        }
        if structural:
            if not isinstance(self.slave, Fmi3):
                raise UnitError("structural parameters are of FMI 3.0 alone")
            self.slave.configure(lambda: self.set(structural))
            self.package = self.package.reshaped(structural)
            self._forget_accesses()
        self.slave.setup(self.start_time, self.stop_time)
        self.set(values)
        self.slave.initialise(self.start_time, self.stop_time)
        self._initialised = True

    # Life

    def reset(self, parameters: Mapping[str, Any] | None = None) -> None:
        """Initialises the instance anew, as it was made but with these parameters laid over."""
        self._must_be_open()
        self.slave.reset()
        self._initialised = False
        self._initialise(parameters or {})

    def close(self) -> None:
        """Ends the instance; it cannot be used any more. Closing twice does no harm."""
        if not self.is_open:
            return
        self.is_open = False
        self._forget_accesses()
        if self._initialised:
            self.slave.terminate()
        self.slave.free()

    def _forget_accesses(self) -> None:
        for access in list(self.slave.accesses):
            access.close()
        self._readers.clear()
        self._writers.clear()

    def __enter__(self) -> Unit:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __del__(self) -> None:
        try:
            self.close()
        except Exception:  # the interpreter is ending
            pass

    def __repr__(self) -> str:
        return self._summary().text()

    def _repr_html_(self) -> str:
        return self._summary().html()

    def _summary(self) -> Summary:
        life = f"at {self.time!r} s" if self.is_open else "closed"
        if self.slave.fatal is not None:
            life = "failed fatally"
        kinds = {"inputs": self.inputs, "outputs": self.outputs, "parameters": self.parameters}
        lines = [
            (kind, listed(name_with_unit(v.name, v.unit, v.shape) for v in of.values()))
            for kind, of in kinds.items()
        ]
        if self.default_step and self.default_stop:
            proposed = f"steps of {self.default_step:g} s to {self.default_stop:g} s"
            lines.append(("proposes", proposed))
        return Summary(
            f"<impinge.Unit {self.log.name} (FMI {self.package.fmi}) {life}>",
            lines,
            [variables(kind, of) for kind, of in kinds.items()],
        )

    def _must_be_open(self) -> None:
        if not self.is_open:
            raise UnitError("the unit is closed")
        self.slave.must_live()

    # What there is

    @property
    def name(self) -> str:
        """The model's name."""
        return self.package.name

    @property
    def scene(self) -> str:
        """The text of the scene that the unit was packed from; empty of units of other tools."""
        path = self.package.folder / "resources/scene.toml"
        return path.read_text(encoding="utf-8") if path.is_file() else ""

    @property
    def inputs(self) -> dict[str, Variable]:
        """Inputs by name; a family is one."""
        return self.package.of_causality("input")

    @property
    def outputs(self) -> dict[str, Variable]:
        """Outputs by name; a family is one."""
        return self.package.of_causality("output")

    @property
    def parameters(self) -> dict[str, Variable]:
        """Parameters by name, those that may be set before initialisation."""
        return self.package.of_causality("parameter", "structuralParameter")

    @property
    def variables(self) -> dict[str, Variable]:
        """All variables by name; a family is one."""
        return self.package.variables

    def variable(self, name: str) -> Variable:
        """The variable, family or element of a family of this name."""
        return self.package.variable(name)

    def measure(self, unit: str | None) -> Measure | None:
        """The unit of measurement of this name, as far as the unit defines it."""
        return self.package.measure(unit)

    def is_mean(self, name: str) -> bool:
        """True if an output is a mean over the last step, as impinge's units describe theirs."""
        return self.package.is_own and "mean over the last step" in self.variable(name).description

    @property
    def identity(self) -> str:
        """The model's name and the beginning of the SHA-256 of its content."""
        return f"{self.name} {self.package.digest[:16]}"

    @property
    def can(self) -> Capabilities:
        """What the unit says it can do."""
        return self.package.can

    @property
    def default_step(self) -> float | None:
        """The communication step [s] that the unit proposes."""
        said = getattr(self.package.description.defaultExperiment, "stepSize", None)
        return None if said is None else float(said)

    @property
    def default_stop(self) -> float | None:
        """The stop time [s] that the unit proposes."""
        said = getattr(self.package.description.defaultExperiment, "stopTime", None)
        return None if said is None else float(said)

    def depends_on(self, output: str) -> set[str]:
        """The inputs that an output follows at once, by the unit's own declaration."""
        found = self.package.dependencies.get(output)
        if found is None:
            found = self.package.dependencies.get(stem_of(output))
        if found is None:
            raise UnitError(f"{self.name} has no output `{output}`")
        return set(found)

    def cells(self, name: str) -> dict[str, Any]:
        """The cells of a family (`rings`, or a variable of it) as `resources/cells.json` has them:
        kind, footprint, count, areas [m²] and places [m], last index fastest."""
        return self._cells(name)[1]

    def _cells(self, name: str) -> tuple[str, dict[str, Any], tuple[int, ...]]:
        """The name of a family and its cells, and the indices of the element that `name` means."""
        families = self.package.cell_families
        found = place_of(families, name)
        if found is None:
            known = f"; it has {', '.join(families)}" if families else ""
            raise UnitError(f"{self.name} tells no cells of `{name}`{known}")
        family, indices = found
        return family, families[family], indices

    def areas(self, name: str) -> np.ndarray:
        """The areas [m²] of a family's cells, flat, or that of an element's cell, at the start of
        loads whose radius is an input; of walls of plane drops per metre of depth [m]. Raises
        `UnitError` if they are not told."""
        _, cells, indices = self._cells(name)
        if indices:
            self.variable(name)  # or there is no such element
        areas = areas_of(cells, indices)
        if not len(areas):
            raise UnitError(f"{self.name} tells no areas of `{name}`")
        return areas

    def placement(self, name: str) -> dict[str, Variable]:
        """The inputs that place a load's cells, as far as there are any: `x` and `y` of the centre
        and the outer `radius`, with which all radii grow in proportion. A tunable parameter may
        stand for each."""
        family, cells, _ = self._cells(name)
        found = {}
        for key in ("x", "y", "radius") if cells.get("kind") == "load" else ():
            for mark in "._":
                variable = self.variables.get(f"{family}{mark}{key}")
                if variable is not None and variable.causality in ("input", "parameter"):
                    found[key] = variable
        return found

    def coordinates(self, name: str) -> dict[str, np.ndarray]:
        """The coordinates x, y, z [m] of a family's cells or points: those that it has."""
        stem = stem_of(name)
        place = place_of(self.package.cell_families, name)
        flat = [f"{place[0]}_"] if place else []
        for prefix in (f"{stem}.", f"{stem.rpartition('.')[0]}.", *flat):
            found = {axis: self.variables.get(prefix + axis) for axis in "xyz"}
            constant = {a: v for a, v in found.items() if v and v.variability == "constant"}
            if constant:
                return {a: np.array(v.start, dtype=float) for a, v in constant.items()}
        cells = self.cells(name)
        return {axis: np.array(cells[axis], dtype=float) for axis in "xyz" if axis in cells}

    # Values

    def reader(self, names: Iterable[str]) -> Reader:
        """A call that reads these names into one flat array, over and over."""
        return self._access(Reader, tuple(names))

    def writer(self, names: Iterable[str]) -> Writer:
        """A call that sets these names from one flat array, over and over."""
        return self._access(Writer, tuple(names))

    def path_writer(self, names: Iterable[str], order: int) -> PathWriter:
        """A call that sets inputs that follow polynomials in time over the next step."""
        if not isinstance(self.slave, Fmi2) or not 1 <= order <= self.can.interpolates:
            raise UnitError(
                f"{self.name} follows inputs of degree {self.can.interpolates} in time, not {order}"
            )
        return PathWriter(self.slave, self.writer(names), order)

    def _access(self, kind: Any, names: tuple[str, ...]) -> Any:
        self._must_be_open()
        variables = [self.package.variable(name) for name in names]
        access = kind(self.slave, variables, lambda name: self.package.variable(stem_of(name)))
        self.slave.accesses.add(access)
        return access

    def _reader(self, names: tuple[str, ...]) -> Reader:
        found = self._readers.get(names)
        if found is None:
            found = self._readers[names] = self.reader(names)
        return found

    def _writer(self, names: tuple[str, ...]) -> Writer:
        found = self._writers.get(names)
        if found is None:
            found = self._writers[names] = self.writer(names)
        return found

    def get(self, names: Sequence[str]) -> np.ndarray:
        """Values of names, float64, those of arrays one after another in C order; one call."""
        return self._reader((names,) if isinstance(names, str) else tuple(names))().copy()

    def set(self, values: Mapping[str, Any]) -> None:
        """Sets values by name; numbers and arrays in one call. Inputs hold until set again."""
        try:
            writer = self._writers.get(tuple(values))
            if writer is None:
                self._set_first(values)
                return
            writer.fill(list(values.values()))
            writer()
        except UnitError as error:
            self._explain(values, error)
            raise

    def _set_first(self, values: Mapping[str, Any]) -> None:
        texts = [name for name in values if not self.package.variable(name).is_number]
        for name in texts:
            variable = self.package.variable(name)
            value = values[name]
            wanted = bytes if variable.kind == "Binary" else str
            if not isinstance(value, wanted):
                raise UnitError(f"`{name}` takes {wanted.__name__}, not {value!r}")
            self.slave.set_text(variable.kind, variable.references, [value])
        numbers = {name: value for name, value in values.items() if name not in texts}
        if numbers:
            writer = self._writer(tuple(numbers))
            writer.fill(list(numbers.values()))
            writer()

    def _explain(self, values: Mapping[str, Any], error: UnitError) -> None:
        if not self._initialised:
            return
        fixed = [name for name in values if name in self.parameters]
        if fixed:
            error.add_note(
                f"{', '.join(fixed)}: parameters are set before initialisation:"
                " Unit(…, parameters={…}) or unit.reset({…})"
            )

    def __getitem__(self, name: str) -> Any:
        reader = self._readers.get((name,))
        if reader is None:
            variable = self.package.variable(name)
            if not variable.is_number:
                self._must_be_open()
                texts = self.slave.get_text(variable.kind, variable.references)
                return texts[0] if not variable.shape else texts
            reader = self._reader((name,))
        values = reader()
        variable = reader.variables[0]
        if variable.shape:
            array = values.reshape(variable.shape)
            return array.copy() if variable.is_real else array.astype(_plain(variable))
        return values.item() if variable.is_real else _plain(variable)(values[0])

    def __setitem__(self, name: str, value: Any) -> None:
        writer = self._writers.get((name,))
        if writer is None:
            self.set({name: value})
            return
        writer.fill((value,))
        writer()

    # Time

    def step(self, size: float) -> None:
        """Advances by `size` [s]. Raises `StepDiscarded` if the unit stops short of it."""
        self._must_be_open()
        if not 0.0 <= size < inf:
            raise UnitError(
                f"{self.log.name}: step size {float(size)!r} s is not positive and finite"
            )
        try:
            self.slave.do_step(self.time, size)
        except StepDiscarded as error:
            self.time = error.time
            raise
        except KeyboardInterrupt:
            self.time = self.slave.reached(self.time, size)
            raise
        self.time += size

    def step_to(self, time: float) -> None:
        """Advances to `time` [s]."""
        self.step(time - self.time)
        self.time = time

    # States

    def state(self, into: State | None = None) -> State:
        """Saves the present state; if given, in place of one that is not needed any more."""
        self._must_be_able("states")
        if into is not None and not into.belongs_to(self):
            raise UnitError("the state belongs to another unit, or has been freed")
        state = into or State(self, self.time)
        self.slave.get_state(state.handle)
        state.time = self.time
        return state

    def restore(self, state: State) -> None:
        """Goes back to a state of this instance."""
        self._must_be_able("states")
        if not isinstance(state, State):
            kind = type(state).__name__
            raise UnitError(f"{kind} is no state: state() saves one; load() takes bytes of save()")
        if not state.belongs_to(self):
            raise UnitError("the state belongs to another unit, or has been freed")
        self.slave.set_state(state.handle)
        self.time = state.time

    def save(self) -> bytes:
        """The present state and time as bytes, for another instance or process."""
        self._must_be_able("serialise")
        with self.state() as state:
            content = self.slave.to_bytes(state.handle)
        told = _TIME.pack(self.time) + content
        return _MAGIC + _HEAD.pack(zlib.crc32(told)) + told

    def load(self, content: bytes) -> None:
        """Goes on from what `save` of the same unit, in any process, has returned."""
        self._must_be_able("serialise")
        content = bytes(content)
        begin = len(_MAGIC) + _HEAD.size
        if not content.startswith(_MAGIC):
            raise UnitError("these bytes are not what Unit.save returns")
        if len(content) < begin + _TIME.size:
            raise UnitError(f"these {len(content)} bytes are the beginning of a saved state alone")
        told = content[begin:]
        if _HEAD.unpack_from(content, len(_MAGIC)) != (zlib.crc32(told),):
            raise UnitError("the saved state is damaged or cut off: its checksum differs")
        (time,) = _TIME.unpack_from(told)
        with State(self, time) as state:
            self.slave.from_bytes(told[_TIME.size :], state.handle)
            self.restore(state)

    def _must_be_able(self, what: str) -> None:
        self._must_be_open()
        if not getattr(self.can, what):
            words = {"states": "save and restore its state", "serialise": "save its state as bytes"}
            raise UnitError(f"{self.name} cannot {words[what]}")

    # Derivatives

    def set_input_derivatives(self, derivatives: Mapping[str, Sequence[Any]]) -> None:
        """Time derivatives of inputs over the next step, at its beginning.

        {name: [first, second, …]}, each as the input: a number or an array of its shape, in units
        of the input per s, s², … Raises `UnitError` where inputs are held (`can.interpolates`).
        """
        if not isinstance(self.slave, Fmi2) or not self.can.interpolates:
            raise UnitError(f"{self.name} holds its inputs over a step")
        self._must_be_open()
        references, orders, values = [], [], []
        for name, list_ in derivatives.items():
            variable = self.package.variable(name)
            for order, value in enumerate(list_, start=1):
                references.append(variable.references)
                orders.append(np.full(variable.size, order, dtype=np.int32))
                array = np.asarray(value, dtype=float)
                values.append(np.broadcast_to(array, variable.shape).ravel())
        if references:
            arrays = [np.ascontiguousarray(np.concatenate(a)) for a in (references, orders, values)]
            self.slave.check(self.slave.input_derivatives(*arrays)(), "SetRealInputDerivatives")

    def output_derivatives(self, names: Sequence[str], order: int = 1) -> np.ndarray:
        """Time derivatives of outputs, flat as by `get`, in units of the output per s^order."""
        self._must_be_open()
        if order > self.can.output_derivatives:
            raise UnitError(
                f"{self.name} gives derivatives of outputs up to order"
                f" {self.can.output_derivatives}, not {order}"
            )
        variables = [self.package.variable(name) for name in names]
        references = np.concatenate([v.references for v in variables])
        orders = np.full(len(references), order, dtype=np.int32)
        values = np.zeros(sum(v.size for v in variables))
        call = self.slave.output_derivatives(references, orders, values)
        self.slave.check(call(), "GetOutputDerivatives")
        return values

    def directional_derivative(
        self, outputs: Sequence[str], change: Mapping[str, Any]
    ) -> np.ndarray:
        """The change of outputs, flat as by `get`, that goes with a change of inputs at once."""
        self._must_be_open()
        if not self.can.directional_derivatives:
            raise UnitError(f"{self.name} gives no directional derivatives")
        unknowns = [self.package.variable(name) for name in outputs]
        knowns = [self.package.variable(name) for name in change]
        given = [
            np.broadcast_to(np.asarray(value, dtype=float), known.shape).ravel()
            for known, value in zip(knowns, change.values(), strict=True)
        ]
        result = np.zeros(sum(v.size for v in unknowns))
        self.slave.directional_derivative(
            np.concatenate([v.references for v in unknowns]),
            np.concatenate([v.references for v in knowns]),
            np.ascontiguousarray(np.concatenate(given)),
            result,
        )
        return result

    @property
    def folder(self) -> Path:
        """Where the unit has been unzipped."""
        return self.package.folder


def _plain(variable: Variable) -> type:
    if variable.kind == "Boolean":
        return bool
    return float if variable.kind.startswith(("Real", "Float")) else int
