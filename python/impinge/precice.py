"""A unit as participant of a preCICE coupling (API of version 3).

    from impinge import Surface, Unit
    from impinge.precice import Port, run

    with Unit("plate.toml") as unit:
        run(
            unit,
            "Plate",
            "precice-config.xml",
            meshes={"Plate-Mesh": Surface.of(unit, "laser")},
            reads=[Port("Plate-Mesh", "Heat-Flux", "laser.heat_flux")],
            writes=[Port("Plate-Mesh", "Temperature", "surface.temperature")],
        )

Cells are vertices: tiles and points of fields where they are, rings at their mean radius on the
x axis. Data that preCICE maps between meshes should be mapped conservatively for amounts only (W a
cell); fluxes (W/m2) consistently.

The preCICE library is loaded when it is asked for. It is not part of what this package is tested
with: the tests drive a stand-in of its interface, which checks the order of calls and couples two
participants implicitly, by fixed point, in threads. What a configuration file says is preCICE's
own.

Source: G. Chourdakis et al. (2022), doi 10.12688/openreseurope.14445.2.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .errors import ImpingeError
from .surface import Placement, Surface
from .surface.cells import Rings

# Part of a step below which what is left of a window is rounding
ROUNDING = 1e-9


class CouplingError(ImpingeError):
    """A participant that cannot do what the coupling asks."""


@dataclass(frozen=True)
class Port:
    """Data that stand for a variable of the unit: their mesh, their name there, and the
    variable, an array with as many elements as the mesh has vertices (times the components of
    vector data).
    """

    mesh: str
    data: str
    variable: str


@dataclass(frozen=True)
class Counts:
    """What a run took: windows that converged, steps of the unit, steps that were taken back."""

    windows: int
    steps: int
    repeated: int


def run(
    unit: Any,
    participant: Any,
    configuration: str | None = None,
    *,
    meshes: Mapping[str, Surface | np.ndarray],
    reads: Sequence[Port] = (),
    writes: Sequence[Port] = (),
    placement: Placement | None = None,
    step: float | None = None,
    rank: int = 0,
    ranks: int = 1,
    after: Callable[[float], None] | None = None,
) -> Counts:
    """Couples a unit until preCICE says that the coupling ends.

    Parameters
    ----------
    unit
        An :class:`impinge.Unit`, initialised.
    participant
        Name of the participant, or an object with the interface of ``precice.Participant``.
    configuration
        Path of preCICE's configuration, with a name.
    meshes
        By preCICE's names, the surfaces whose values are exchanged, or vertices, shape (n,
        dimensions).
    reads, writes
        Inputs and outputs of the unit.
    placement
        Where the face lies in the coordinates of the coupling; by default in its own.
    step
        Longest step of the unit [s]; by default that of the window. Inputs follow preCICE's
        waveforms: over a step by their values at its ends and, where the unit takes two
        derivatives, in its middle; held at the value of the middle where the unit takes none.
    after
        Called with the time [s] after each window that has converged.

    Raises
    ------
    CouplingError
        If preCICE is not installed, if sizes do not fit, or if implicit coupling needs states that
        the unit does not have.
    """
    if isinstance(participant, str):
        participant = _participant(participant, configuration, rank, ranks)
    exchange = _Exchange(unit, participant, meshes, reads, writes, placement or Placement())
    exchange.initialise()
    windows = steps = repeated = 0
    since, state, start = 0, None, unit.time
    while participant.is_coupling_ongoing():
        if participant.requires_writing_checkpoint():
            state, since = _save(unit, state), 0
        longest = participant.get_max_time_step_size()
        size = longest if step is None or step >= longest * (1 - ROUNDING) else step
        exchange.read(size)
        unit.step(size)
        exchange.write()
        steps, since = steps + 1, since + 1
        participant.advance(size)
        if participant.requires_reading_checkpoint():
            unit.restore(state)
            repeated, since = repeated + since, 0
        elif participant.is_time_window_complete():
            windows += 1
            if after is not None:
                after(unit.time - start)
    participant.finalize()
    if state is not None:
        state.free()
    return Counts(windows, steps, repeated)


def vertices(surface: Surface) -> np.ndarray:
    """Places that stand for the values of a surface [m]; shape (size, 3).

    Centroids and points, and of rings ``(R₁ + R₂)/2`` along x from their axis.
    """
    places = surface.coordinates.copy()
    if isinstance(surface.cells, Rings):
        places[:, 0] += 0.5 * (surface.cells.edges[1:] + surface.cells.edges[:-1])
    return places


def _participant(name: str, configuration: str | None, rank: int, ranks: int) -> Any:
    if configuration is None:
        raise CouplingError(f"{name}: the path of preCICE's configuration is needed")
    try:
        import precice
    except ModuleNotFoundError:
        raise CouplingError(
            "preCICE's Python bindings are not installed: pip install pyprecice, "
            "beside the preCICE library"
        ) from None
    if not hasattr(precice, "Participant"):
        raise CouplingError("preCICE of version 3 is needed")
    return precice.Participant(name, str(configuration), rank, ranks)


def _save(unit: Any, state: Any) -> Any:
    if not unit.can.states:
        raise CouplingError(f"{unit.name} cannot restore states; couple it explicitly")
    return unit.state(state)


class _Exchange:
    """What passes between the variables of a unit and preCICE's data."""

    def __init__(
        self,
        unit: Any,
        participant: Any,
        meshes: Mapping[str, Surface | np.ndarray],
        reads: Sequence[Port],
        writes: Sequence[Port],
        placement: Placement,
    ) -> None:
        self.unit, self.participant = unit, participant
        self.ids: dict[str, Any] = {}
        self.shapes: dict[Port, tuple[int, ...]] = {}
        for name, mesh in meshes.items():
            self.ids[name] = participant.set_mesh_vertices(
                name, self._vertices(name, mesh, placement)
            )
        self.reads = [self._checked(port, unit.inputs, "input") for port in reads]
        self.writes = [self._checked(port, unit.outputs, "output") for port in writes]

    def _vertices(self, name: str, mesh: Surface | np.ndarray, placement: Placement) -> np.ndarray:
        dimensions = self.participant.get_mesh_dimensions(name)
        places = (
            placement.to_foreign(vertices(mesh))
            if isinstance(mesh, Surface)
            else np.asarray(mesh, float)
        )
        if places.ndim != 2 or places.shape[1] < dimensions:
            raise CouplingError(
                f"{name}: vertices of shape {places.shape}, where {dimensions} "
                "coordinates are needed"
            )
        dropped = places[:, dimensions:]
        if dropped.size and np.ptp(dropped, axis=0).max() > 0:
            raise CouplingError(
                f"{name}: the face is not parallel to the plane x, y of the coupling"
            )
        places = np.ascontiguousarray(places[:, :dimensions])
        if len(np.unique(places, axis=0)) < len(places):
            raise CouplingError(f"{name}: has two vertices at one place")
        return places

    def _checked(self, port: Port, variables: Mapping[str, Any], what: str) -> Port:
        if port.mesh not in self.ids:
            raise CouplingError(f"{port.data}: mesh `{port.mesh}` is none of {', '.join(self.ids)}")
        if port.variable not in variables:
            raise CouplingError(f"{port.data}: `{port.variable}` is no {what} of {self.unit.name}")
        count = len(self.ids[port.mesh])
        components = self.participant.get_data_dimensions(port.mesh, port.data)
        size = variables[port.variable].size
        if size != count * components:
            raise CouplingError(
                f"{port.data}: {count} vertices of {components} components, but "
                f"`{port.variable}` has {size} elements"
            )
        self.shapes[port] = (count,) if components == 1 else (count, components)
        return port

    def initialise(self) -> None:
        if self.participant.requires_initial_data():
            self.write()
        self.participant.initialize()

    def read(self, size: float) -> None:
        """Sets inputs to preCICE's waveforms over the next step [s]."""
        order = self.unit.can.interpolates
        values, slopes = {}, {}
        for port in self.reads:
            if order == 0:
                values[port.variable] = self._read(port, 0.5 * size)
                continue
            first, last = self._read(port, 0.0), self._read(port, size)
            values[port.variable] = first
            if order == 1:
                slopes[port.variable] = [(last - first) / size]
                continue
            middle = self._read(port, 0.5 * size)
            bend = 4 * (first - 2 * middle + last) / size**2
            slopes[port.variable] = [(last - first) / size - 0.5 * bend * size, bend]
        if values:
            self.unit.set(values)
        if slopes:
            self.unit.set_input_derivatives(slopes)

    def _read(self, port: Port, time: float) -> np.ndarray:
        read = self.participant.read_data(port.mesh, port.data, self.ids[port.mesh], time)
        shape = self.unit.inputs[port.variable].shape
        return np.asarray(read, float).reshape(shape)

    def write(self) -> None:
        for port in self.writes:
            values = np.asarray(self.unit[port.variable], float).reshape(self.shapes[port])
            self.participant.write_data(port.mesh, port.data, self.ids[port.mesh], values)
