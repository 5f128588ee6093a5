"""Many runs of a unit or of a scene, a table of what came of them."""

from __future__ import annotations

import hashlib
import logging
import os
import shlex
import sys
import tempfile
import warnings
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import xarray as xr
from tqdm import tqdm

from impinge.errors import UnitError
from impinge.summary import Summary, Table, listed, name_with_unit
from impinge.unit import Package, open_package
from impinge.unit.temporary import temporary_folder

from . import checks, dataset, identity
from .distributions import Distribution, distribution_of, is_held
from .findings import findings, warning_of
from .journal import Finished, Journal, read
from .outputs import Output, output_of
from .processes import Processes
from .runner import Experiment, Row
from .sampling import Design, Grid, Sampler
from .scenes import Scene, Variant
from .signals import Signal, signal_of, takes_parameters
from .worker import Job

_LOGGER = logging.getLogger("impinge")
# More than these take gigabytes for their times alone.
_MOST_STEPS = 1e8


class Study:
    """Runs of one unit over values of its parameters, its inputs and the keys of its scene.

    source: a scene (`.toml`), a `.fmu` file of any tool, or a folder that one was unzipped into.
    parameters: what varies, by name: a pair (low, high) is a range, a list or an array are levels,
        one value is held; `LogUniform`, `Normal` and others say more. A name is that of a parameter
        of the unit, of an input (held over a run), or the dotted path of a key of the scene, such
        as `body.plate.shape.box.2` or `load.spot.footprint.disc.radius`; every other scene is a
        unit of its own. Names without a dot that are neither are for functions of time.
    inputs: what inputs, or tunable parameters, do in all runs: a value, a function of time [s] or
        of time and the row's values, a `Table`, or a pair (times, values). Inputs are parabolas
        over a step where the unit interpolates them, all else is held at its value in the middle.
        Where functions jump, steps are cut (the mean is held if the unit cannot).
    outputs: names of variables (their value at the stop), `over_time`, `maximum`, `minimum` of
        them, or `of_run` for a function of a run.
    stop, step: of every run, in s; those that the unit proposes if left out.
    sampler: `Grid` (default), `Paired`, `LatinHypercube` or `Sobol`.
    fmi: the version that a scene is built for.

    Raises `UnitError` or `ValueError` for what does not fit the unit or the scene, before anything
    runs; what both ends of a range or of levels are refused for counts as that.
    """

    def __init__(
        self,
        source: str | os.PathLike[str],
        parameters: Mapping[str, Any],
        *,
        outputs: Iterable[str | Output],
        inputs: Mapping[str, Any] | None = None,
        stop: float | None = None,
        step: float | None = None,
        sampler: Sampler | None = None,
        fmi: int | None = None,
    ):
        path = Path(source)
        self.source = str(source)
        self.package: Package = open_package(path, fmi)
        self.scene = Scene(path, self.package.fmi) if path.suffix == ".toml" else None
        self.sampler: Sampler = sampler or Grid()
        self.parameters = {name: distribution_of(name, v) for name, v in parameters.items()}
        self.experiment = self._experiment(inputs or {}, outputs, stop, step)
        self.kinds = {name: self._kind(name) for name in self.parameters}
        self._check_outputs()
        self.design: Design = self.sampler.design(self.parameters)
        self.texts: dict[str, str] = {}  # scenes by hash
        self.rows = [self._row(index, values) for index, values in enumerate(self.design.rows)]
        self.notes: list[str] = []  # on its inputs and outputs, each said once
        checks.check_values(self)
        checks.warn_of_inputs(self)
        checks.warn_of_points(self)
        self.unit_hash = identity.hash_of_unit(self.package.folder)
        shared = identity.hash_of_experiment(self.unit_hash, self.experiment)
        self.keys = [identity.key_of_row(shared, row) for row in self.rows]

    def __repr__(self) -> str:
        return self._summary().text()

    def _repr_html_(self) -> str:
        return self._summary().html()

    def _summary(self) -> Summary:
        names = self.parameters
        parameters = [(name, self.unit_of(name), f"{d}") for name, d in names.items()]
        of = self.experiment
        lines = [
            ("parameters", listed(name_with_unit(name, unit) for name, unit, _ in parameters)),
            ("inputs", listed(of.inputs)),
            ("outputs", listed(output.name for output in of.outputs)),
            ("steps", f"of {of.step:g} s to {of.stop:g} s"),
            *(("note", note) for note in self.notes),
        ]
        about = [self.description_of(name) for name in names]
        rows = [(*row, words) for row, words in zip(parameters, about, strict=True)]
        outputs = [(output.name, output.kind, ", ".join(output.needs)) for output in of.outputs]
        tables = [
            Table("parameters", ("name", "unit", "values", "meaning"), rows),
            Table("outputs", ("name", "kind", "of"), outputs),
        ]
        count = f"{len(self.rows)} rows, {self.sampler}"
        return Summary(f"<impinge.Study of {self.package.name}: {count}>", lines, tables)

    @property
    def varying(self) -> list[str]:
        """Names of the parameters that are not the same in all rows."""
        return [name for name, d in self.parameters.items() if not is_held(d)]

    def run(
        self,
        processes: int | None = None,
        *,
        dask: Any = None,
        folder: str | os.PathLike[str] | None = None,
        retry: bool = False,
        timeout: float | None = None,
        progress: bool | None = None,
        overwrite: bool = False,
    ) -> xr.Dataset:
        """Runs all rows that are not in `folder` yet, and returns the whole table.

        processes: how many of this machine work; as many as it has cores if left out.
        dask: the address of a scheduler (`tcp://…`), or a `distributed.Client`, to work instead.
        folder: where every finished row is written at once and found again by the hash of unit,
            experiment and values, also after the process was killed, and the table as `study.nc`.
        retry: runs rows again that have failed before.
        timeout: in s, what a row may take before it counts as failed.
        progress: whether to show a bar; left out, one is shown on a terminal.
        overwrite: replaces a `study.nc` in the folder that is not the table of a study, which is
            refused with `StudyError` otherwise.

        A row that fails keeps its message (`status`, `message` of the table), one whose process
        dies too. Warnings of a row's unit stand in its `message`. At the end each failure and each
        warning is a `StudyWarning`, once, with the rows that it concerns and what varies there; so
        are the attributes `failures` and `warnings` of the table. Meanwhile the logger `impinge`
        has them row by row at the level INFO. After Ctrl-C all finished rows are in the folder.
        """
        finished: dict[str, Finished] = {}
        path = Path(folder) / "study.nc" if folder is not None else None
        if path and not overwrite:
            dataset.refuse_foreign(path)
        journal = Journal(Path(folder)) if folder is not None else None
        try:
            if journal:
                known = self._own(journal.rows)
                finished = {key: row for key, row in known.items() if not (retry and row.failed)}
            pending = self._pending(finished)
            silent = None if progress is None else not progress
            with tqdm(
                total=len(self.rows),
                initial=len(self.rows) - len(pending),
                disable=silent,
                unit="run",
                desc=self.package.name,
            ) as bar:
                self._run(pending, finished, journal, bar, processes, dask, timeout)
            table = dataset.assemble(self, finished)
            if path:
                dataset.write(table, path)
        finally:
            if journal:
                journal.close()
        for finding in findings(table):
            warnings.warn(warning_of(finding), stacklevel=2)
        return table

    def results(self, folder: str | os.PathLike[str]) -> xr.Dataset:
        """The table of what is in a folder by now; rows that have not run are not a number."""
        path = Path(folder) / "rows.jsonl"
        if not path.is_file():
            raise FileNotFoundError(f"{path}: no study has run there")
        return dataset.assemble(self, self._own(read(path)))

    def _own(self, rows: Mapping[str, Finished]) -> dict[str, Finished]:
        """Rows of this study, each with a value for every output; others run again."""
        own = {key: rows[key] for key in set(self.keys) & rows.keys()}
        count = len(self.experiment.outputs)
        for key, row in list(own.items()):
            if row.values is not None and len(row.values) != count:
                message = f"row {key} has {len(row.values)} values of {count} outputs"
                warnings.warn(f"{message}; it runs again", stacklevel=3)
                del own[key]
        return own

    def _run(
        self,
        pending: list[Row],
        finished: dict[str, Finished],
        journal: Journal | None,
        bar: Any,
        processes: int | None,
        dask: Any,
        timeout: float | None,
    ) -> None:
        def keep(batch: list[tuple[Row, Finished]]) -> None:
            rows = [(self.keys[row.index], answer) for row, answer in batch]
            if journal:
                journal.append(rows)
            finished.update(rows)
            for row, answer in batch:
                self._log_message(row, answer)
            bar.update(len(rows))
            failed = sum(answer.failed for answer in finished.values())
            warned = sum(bool(a.message) and not a.failed for a in finished.values())
            counts = {"failed": failed, "warned": warned}
            bar.set_postfix({word: n for word, n in counts.items() if n}, refresh=False)

        if not pending:
            return
        with tempfile.TemporaryDirectory(dir=temporary_folder().path) as temporary:
            workers = self._workers(pending, processes, dask, timeout, temporary)
            try:
                for batch in workers:
                    keep(batch)
            finally:
                keep(workers.stop())

    def _log_message(self, row: Row, answer: Finished) -> None:
        """Here, not where the row ran: loggers of other processes are not the user's."""
        if not answer.message:
            return
        values = self.design.rows[row.index]
        told = ", ".join(f"{name} = {values[name]!r}" for name in self.varying)
        _LOGGER.info("%s, row %d (%s): %s", self.package.name, row.index, told, answer.message)

    def _workers(
        self,
        pending: list[Row],
        processes: int | None,
        dask: Any,
        timeout: float | None,
        temporary: str,
    ) -> Any:
        groups = _groups(pending)
        if dask is not None:
            from .cluster import Cluster

            return Cluster(
                self.package.folder,
                self.experiment,
                groups,
                self._prepare,
                dask=dask,
                timeout=timeout,
            )
        count = (os.cpu_count() or 1) if processes is None else processes
        if count < 1:
            raise ValueError(f"processes = {count} (allowed: at least 1)")
        return Processes(
            Job(str(self.package.folder), self.experiment),
            groups,
            self._prepare,
            processes=min(count, len(pending)),
            timeout=timeout,
            temporary=temporary,
        )

    def _pending(self, finished: Mapping[str, Finished]) -> list[Row]:
        """Rows to run, each key once."""
        rows: dict[str, Row] = {}
        for key, row in zip(self.keys, self.rows, strict=True):
            if key not in finished:
                rows.setdefault(key, row)
        return list(rows.values())

    def _prepare(self, row: Row) -> Variant:
        assert self.scene
        return self.scene.variant(self.texts[row.scene])

    # What names and values mean

    def _experiment(
        self,
        inputs: Mapping[str, Any],
        outputs: Iterable[str | Output],
        stop: float | None,
        step: float | None,
    ) -> Experiment:
        proposed = self.package.description.defaultExperiment
        stop = _positive("stop", stop, getattr(proposed, "stopTime", None))
        if step is not None and step > stop:
            raise ValueError(f"step = {step:g} s (allowed: at most the stop, {stop:g} s)")
        step = _positive("step", step, getattr(proposed, "stepSize", None))
        if stop > _MOST_STEPS * step:
            raise ValueError(
                f"{stop / step:.3g} steps of {step:g} s (allowed: {stop / _MOST_STEPS:.3g} s or"
                f" more, for at most {_MOST_STEPS:.0e} steps)"
            )
        if isinstance(outputs, str):
            raise ValueError(f"outputs is {outputs!r} (allowed: a list of names, [{outputs!r}])")
        kept = tuple(output_of(output) for output in outputs)
        if not kept:
            raise ValueError("no outputs (allowed: at least one)")
        twice = {o.name for o in kept if sum(p.name == o.name for p in kept) > 1}
        if twice:
            raise ValueError(f"outputs {', '.join(sorted(twice))} stand twice (allowed: once)")
        signals: dict[str, Signal] = {}
        for name, given in inputs.items():
            variable = self.package.variable(name)
            if variable.causality != "input" and variable.variability != "tunable":
                told = f"{variable.variability} {variable.causality}"
                raise UnitError(f"`{name}` is a {told} (allowed: inputs, tunable parameters)")
            signals[name] = signal_of(name, given)
        return Experiment(stop, min(step, stop), signals, kept)

    def _check_outputs(self) -> None:
        """Refuses what the unit has not; changed scenes may have other variables than it."""
        taken = {*self.parameters, "status", "message", "time", "row"}
        for output in self.experiment.outputs:
            if output.name in taken:
                raise ValueError(
                    f"output {output.name} (allowed: names that the table has not yet)"
                )
        if "scene" in self.kinds.values():
            return
        for output in self.experiment.outputs:
            for name in output.needs:
                if not self.package.variable(name).is_number:
                    raise UnitError(f"`{name}` is no number (allowed as output: numbers)")

    def _kind(self, name: str) -> str:
        """What a parameter's name stands for: parameter, input, scene or function."""
        try:
            variable = self.package.variable(name)
        except UnitError as error:
            if self.scene and self.scene.has(name):
                return "scene"
            functions = [s for s in self.experiment.inputs.values() if callable(s)]
            if "." not in name and any(takes_parameters(f) for f in functions):
                return "function"
            place = " or key of the scene" if self.scene else ""
            raise UnitError(f"no parameter, input{place} `{name}`: {error}") from None
        if name in self.experiment.inputs:
            raise ValueError(f"`{name}` stands among parameters and inputs (allowed: one)")
        if variable.causality in ("parameter", "structuralParameter"):
            return "parameter"
        if variable.causality != "input":
            raise UnitError(f"`{name}` is of causality {variable.causality}: it cannot be set")
        return "input"

    def _row(self, index: int, values: Mapping[str, Any]) -> Row:
        by_kind: dict[str, dict[str, Any]] = {
            "parameter": {},
            "input": {},
            "scene": {},
            "function": {},
        }
        for name, value in values.items():
            by_kind[self.kinds[name]][name] = value
        scene = ""
        if by_kind["scene"]:
            assert self.scene
            text = self.scene.changed(by_kind["scene"])
            scene = hashlib.sha256(text.encode()).hexdigest()
            self.texts[scene] = text
        asks = any(callable(s) and takes_parameters(s) for s in self.experiment.inputs.values())
        sampled = dict(values) if asks else {}
        return Row(index, by_kind["parameter"], by_kind["input"], sampled, scene)

    def unit_of(self, name: str) -> str:
        """The unit of measurement of a parameter, empty where none is known."""
        if self.kinds[name] == "function":
            return ""
        if self.kinds[name] == "scene":
            assert self.scene
            return self.scene.unit_of(name)
        return self.package.variable(name).unit or ""

    def description_of(self, name: str) -> str:
        """What a parameter is."""
        if self.kinds[name] == "scene":
            return f"key of the scene: {name}"
        if self.kinds[name] == "function":
            return "of functions of time"
        return self.package.variable(name).description

    def distribution(self, name: str) -> Distribution:
        """What a parameter may be."""
        return self.parameters[name]

    @property
    def command(self) -> str:
        """How the process was called, with the path of its script."""
        words = list(sys.orig_argv) or [sys.executable, *sys.argv]
        words[0] = sys.executable or words[0]
        script = Path(sys.argv[0]) if sys.argv and sys.argv[0] else None
        if script is not None and script.is_file():
            same = {sys.argv[0], os.path.relpath(script)}
            words = [str(script.resolve()) if word in same else word for word in words]
        return shlex.join(words)


def _groups(rows: list[Row]) -> list[list[Row]]:
    """Rows that share a unit, and of these the same parameters one after another."""
    groups: dict[str, dict[str, list[Row]]] = {}
    for row in rows:
        same = groups.setdefault(row.scene, {})
        same.setdefault(repr(sorted(row.parameters.items())), []).append(row)
    found = []
    for same in groups.values():
        group = []
        for alike in same.values():
            group += [
                replace(row, keeps=number + 1 < len(alike)) for number, row in enumerate(alike)
            ]
        found.append(group)
    return found


def _positive(name: str, given: float | None, proposed: Any) -> float:
    if given is None and proposed is None:
        raise ValueError(f"no {name}, and the unit proposes none (allowed: above 0 s)")
    value = float(proposed if given is None else given)
    if not 0.0 < value < float("inf"):
        raise ValueError(f"{name} = {value} (allowed: above 0 s)")
    return value
