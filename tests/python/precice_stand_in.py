"""A stand-in of preCICE's interface (version 3): two participants in threads of one process,
coupled in parallel, explicitly or implicitly by fixed point, with waveforms that are linear
between samples and meshes that match vertex by vertex. It refuses calls in an order that preCICE
refuses.
"""

import threading
from dataclasses import dataclass, field

import numpy as np


@dataclass(frozen=True)
class Exchange:
    """Data that one participant writes on its mesh and the other reads, by the same name, on its
    own.
    """

    data: str
    writer: str
    writer_mesh: str
    reader: str
    reader_mesh: str
    components: int = 1


@dataclass
class Coupling:
    """What a configuration file would say, and the state that both participants share."""

    exchanges: list[Exchange]
    window: float
    end: float
    dimensions: int = 3
    is_implicit: bool = True
    tolerance: float = 1e-10
    most: int = 100
    wants_initial_data: bool = True
    iterations: list[int] = field(default_factory=list)

    def __post_init__(self):
        self.time, self.is_converged = 0.0, True
        self.vertices: dict[str, np.ndarray] = {}
        self.written: dict[Exchange, list] = {e: [] for e in self.exchanges}
        self.received: dict[Exchange, tuple] = {}
        self.begin: dict[Exchange, np.ndarray] = {}
        self.count = 0
        # Whoever comes last does what both wait for; one that fails ends the other's wait.
        self.started = threading.Barrier(2, self._start, timeout=30)
        self.reached = threading.Barrier(2, self._exchange, timeout=30)

    def fail(self):
        self.started.abort()
        self.reached.abort()

    def _start(self):
        for e in self.exchanges:
            sizes = [len(self.vertices[mesh]) for mesh in (e.writer_mesh, e.reader_mesh)]
            assert sizes[0] == sizes[1], f"{e.data}: meshes of {sizes} vertices"
            samples = self.written[e]
            shape = (sizes[0],) if e.components == 1 else (sizes[0], e.components)
            self.begin[e] = samples[-1][1] if samples else np.zeros(shape)
            self.received[e] = (np.zeros(1), self.begin[e][None])
            self.written[e] = []

    def _exchange(self):
        rest = 0.0
        for e in self.exchanges:
            times, values = zip(*self.written[e], strict=True)
            new = np.array([0.0, *times]), np.stack([self.begin[e], *values])
            old = self.received[e][1][-1]
            scale = max(np.abs(new[1][-1]).max(), 1e-300)
            rest = max(rest, np.abs(new[1][-1] - old).max() / scale)
            self.received[e], self.written[e] = new, []
        self.count += 1
        self.is_converged = not self.is_implicit or rest < self.tolerance or self.count >= self.most
        if self.is_converged:
            self.iterations.append(self.count)
            self.count, self.time = 0, self.time + self.window
            for e in self.exchanges:
                self.begin[e] = self.received[e][1][-1]
                self.received[e] = (np.zeros(1), self.begin[e][None])


class Participant:
    """One side, with the methods of ``precice.Participant`` that are used."""

    def __init__(self, name: str, coupling: Coupling):
        self.name, self.coupling = name, coupling
        self.phase = "created"
        self.passed = 0.0
        self.wants_checkpoint = self.wants_restore = self.is_complete = False
        self.values: dict[tuple[str, str], np.ndarray] = {}

    def _must_be(self, *phases):
        assert self.phase in phases, f"{self.name}: called while {self.phase}, not {phases}"

    # Before

    def get_mesh_dimensions(self, mesh):
        return self.coupling.dimensions

    def get_data_dimensions(self, mesh, data):
        return self._find(mesh, data).components

    def set_mesh_vertices(self, mesh, places):
        self._must_be("created")
        assert places.shape[1] == self.coupling.dimensions and mesh not in self.coupling.vertices
        self.coupling.vertices[mesh] = np.array(places)
        return np.arange(100, 100 + len(places))

    def requires_initial_data(self):
        self._must_be("created")
        self.was_asked = True
        return self.coupling.wants_initial_data

    def initialize(self):
        self._must_be("created")
        if self.coupling.wants_initial_data:
            assert getattr(self, "was_asked", False), "requires_initial_data was not asked for"
            assert self.values, "initial data were not written"
        for (mesh, data), values in self.values.items():
            self.coupling.written[self._find(mesh, data)].append((0.0, values))
        self.coupling.started.wait()
        self.phase, self.wants_checkpoint = "running", self.coupling.is_implicit

    # Over a window

    def is_coupling_ongoing(self):
        self._must_be("running", "finished")
        return self.phase == "running"

    def requires_writing_checkpoint(self):
        self._must_be("running")
        wants, self.wants_checkpoint = self.wants_checkpoint, False
        return wants

    def requires_reading_checkpoint(self):
        self._must_be("running", "finished")
        wants, self.wants_restore = self.wants_restore, False
        return wants

    def get_max_time_step_size(self):
        self._must_be("running")
        return self.coupling.window - self.passed

    def read_data(self, mesh, data, ids, time):
        self._must_be("running")
        assert not self.wants_restore, "a state is to be restored first"
        assert not self.wants_checkpoint, "a state is to be saved first"
        exchange = self._find(mesh, data)
        assert exchange.reader == self.name and mesh == exchange.reader_mesh
        assert 0 <= time <= self.get_max_time_step_size() * (1 + 1e-12)
        times, values = self.coupling.received[exchange]
        at = self.passed + time
        flat = values.reshape(len(values), -1)
        read = np.array([np.interp(at, times, column) for column in flat.T])
        return read.reshape(values.shape[1:])[np.asarray(ids) - 100]

    def write_data(self, mesh, data, ids, values):
        self._must_be("created", "running")
        exchange = self._find(mesh, data)
        assert exchange.writer == self.name and mesh == exchange.writer_mesh
        count = len(self.coupling.vertices[mesh])
        shape = (count,) if exchange.components == 1 else (count, exchange.components)
        assert values.shape == shape and np.isfinite(values).all()
        assert (np.asarray(ids) == np.arange(100, 100 + count)).all()
        self.values[mesh, data] = np.array(values)

    def advance(self, size):
        self._must_be("running")
        assert not self.wants_restore and not self.wants_checkpoint
        assert 0 < size <= self.get_max_time_step_size() * (1 + 1e-12)
        self.passed += size
        for (mesh, data), values in self.values.items():
            self.coupling.written[self._find(mesh, data)].append((self.passed, values))
        self.is_complete = False
        if self.passed < self.coupling.window * (1 - 1e-12):
            return
        self.coupling.reached.wait()
        self.passed = 0.0
        self.is_complete = self.coupling.is_converged
        self.wants_restore = not self.is_complete
        self.wants_checkpoint = self.is_complete and self.coupling.is_implicit
        if self.is_complete and self.coupling.time >= self.coupling.end * (1 - 1e-12):
            self.phase = "finished"

    def is_time_window_complete(self):
        self._must_be("running", "finished")
        return self.is_complete

    def finalize(self):
        self._must_be("finished")
        self.phase = "finalised"

    def _find(self, mesh, data):
        found = [
            e
            for e in self.coupling.exchanges
            if e.data == data
            and (self.name, mesh) in ((e.writer, e.writer_mesh), (e.reader, e.reader_mesh))
        ]
        assert found, f"{self.name}: no data {data} on mesh {mesh}"
        return found[0]
