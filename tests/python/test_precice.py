"""A unit as participant, against a stand-in of preCICE's interface: preCICE itself is not among
what tests need. The truth is a plate with a convective face, of which the outside is split off.
"""

import sys
import threading
import types

import numpy as np
import pytest
from impinge import Unit
from impinge.precice import CouplingError, Port, run, vertices
from impinge.surface import Placement, Surface
from precice_stand_in import Coupling, Exchange, Participant

COEFFICIENT, OUTSIDE, START = 2e4, 500.0, 293.15  # W/(m2 K), K, K
SCENE = """
name = "Plate"
stop_time = 0.02
step = 1e-3

[body.plate]
kind = "solid"
shape = { box = [2e-3, 2e-3, 1e-3] }
material = { density = 3950.0, specific_heat = 900.0, conductivity = 10.0 }
initial_temperature = 293.15
mesh = { spacing = 1e-3, depth_spacing = 2e-5, growth = 1.15 }
FACES
[[field]]
name = "face"
on = "plate.top"
grid = [2, 2]
gives = ["temperature"]
"""
TILES = """
[[load]]
name = "tiles"
on = "plate.top"
footprint = { tiles = { count = [2, 2], size = [2e-3, 2e-3] } }
carries = ["heat_flux"]
"""
CONVECTIVE = f"""
[body.plate.faces]
top = {{ convection = {{ coefficient = {COEFFICIENT}, ambient = {OUTSIDE} }} }}
"""
END = 0.02  # s
READS = [Port("Plate-Mesh", "Heat-Flux", "tiles.heat_flux")]
WRITES = [Port("Plate-Mesh", "Temperature", "face.temperature")]
EXCHANGES = [
    Exchange("Heat-Flux", "Outside", "Outside-Mesh", "Plate", "Plate-Mesh"),
    Exchange("Temperature", "Plate", "Plate-Mesh", "Outside", "Outside-Mesh"),
]


@pytest.fixture(scope="module")
def scenes(tmp_path_factory):
    folder = tmp_path_factory.mktemp("scenes")
    text = SCENE.replace("material = {", 'material = { model = "thermoelastic",')
    (folder / "tiles.toml").write_text(text.replace("FACES", TILES))
    (folder / "convective.toml").write_text(text.replace("FACES", CONVECTIVE))
    return folder


@pytest.fixture(scope="module")
def truth(scenes):
    with Unit(scenes / "convective.toml") as unit:
        unit.step(END)
        return unit["face.temperature"].mean()


def outside(coupling, substeps, failures):
    """The other participant: q = h (T∞ − T) at the end of each of its own steps."""
    participant = Participant("Outside", coupling)
    try:
        places = coupling.places
        ids = participant.set_mesh_vertices("Outside-Mesh", places)
        start = np.full(len(places), COEFFICIENT * (OUTSIDE - START))
        if participant.requires_initial_data():
            participant.write_data("Outside-Mesh", "Heat-Flux", ids, start)
        participant.initialize()
        while participant.is_coupling_ongoing():
            participant.requires_writing_checkpoint()
            size = min(coupling.window / substeps, participant.get_max_time_step_size())
            temperature = participant.read_data("Outside-Mesh", "Temperature", ids, size)
            flux = COEFFICIENT * (OUTSIDE - temperature)
            participant.write_data("Outside-Mesh", "Heat-Flux", ids, flux)
            participant.advance(size)
            participant.requires_reading_checkpoint()
        participant.finalize()
    except Exception as error:
        failures.append(error)
        coupling.fail()


def couple(scene, window, *, substeps=1, fmi=2, step=None, after=None, **options):
    """The mean temperature of the face at the end, what the run took, and the coupling."""
    coupling = Coupling(EXCHANGES, window, END, **options)
    failures = []
    with Unit(scene, fmi=fmi) as unit:
        surface = Surface.of(unit, "tiles")
        coupling.places = vertices(surface)
        thread = threading.Thread(target=outside, args=(coupling, substeps, failures))
        thread.start()
        try:
            meshes = {"Plate-Mesh": surface}
            participant = Participant("Plate", coupling)
            counts = run(
                unit, participant, meshes=meshes, reads=READS, writes=WRITES, step=step, after=after
            )
        except Exception:
            coupling.fail()
            raise
        finally:
            thread.join()
        assert not failures, failures
        assert participant.phase == "finalised"
        temperature = unit["face.temperature"]
        assert np.ptp(temperature) < 1e-9
        assert unit.time == pytest.approx(END, rel=1e-12)
        return temperature.mean(), counts, coupling


def test_implicit_coupling_with_waveforms_comes_to_the_truth(scenes, truth):
    assert truth - START > 40  # K
    errors = []
    for windows in (10, 20, 40):
        temperature, counts, coupling = couple(scenes / "tiles.toml", END / windows)
        errors.append(abs(temperature - truth))
        assert counts.windows == windows == len(coupling.iterations)
        assert counts.steps == sum(coupling.iterations)
        assert counts.repeated == counts.steps - windows > 0
        assert max(coupling.iterations) < 60
    held, counts, _ = couple(scenes / "tiles.toml", END / 40, is_implicit=False)
    assert counts.repeated == 0 and counts.steps == 40
    assert errors[-1] < 0.03 * abs(held - truth)
    # Order 3/2: the face's temperature begins as √t.
    assert np.log2(np.divide(errors[:-1], errors[1:])) == pytest.approx(1.5, abs=0.1)


def test_steps_within_windows_and_vertices_of_both_sides(scenes, truth):
    times = []
    temperature, counts, coupling = couple(
        scenes / "tiles.toml", END / 10, substeps=4, step=END / 40, after=times.append
    )
    assert counts.steps == 4 * sum(coupling.iterations)
    assert counts.repeated == counts.steps - 40
    assert times == pytest.approx(END * np.arange(1, 11) / 10)
    coarse, _, _ = couple(scenes / "tiles.toml", END / 10)
    assert abs(temperature - truth) < 0.5 * abs(coarse - truth)
    middles = Surface.tiles((2, 2), (2e-3, 2e-3)).coordinates
    assert coupling.vertices["Plate-Mesh"] == pytest.approx(middles)


def test_units_that_hold_inputs_take_the_middle_of_the_step(scenes, truth):
    """FMI 3.0 has no input derivatives."""
    linear, _, _ = couple(scenes / "tiles.toml", END / 20)
    held, _, _ = couple(scenes / "tiles.toml", END / 20, fmi=3)
    explicit, _, _ = couple(scenes / "tiles.toml", END / 20, is_implicit=False)
    assert abs(held - truth) < abs(explicit - truth)
    assert held != linear


def test_without_initial_data_the_first_window_starts_from_nothing(scenes, truth):
    with_start, _, _ = couple(scenes / "tiles.toml", END / 20)
    without, _, _ = couple(scenes / "tiles.toml", END / 20, wants_initial_data=False)
    assert without < with_start


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"reads": [Port("Mesh", "Heat-Flux", "tiles.heat_flux")]}, "`Mesh` is none of Plate-Mesh"),
        ({"reads": [Port("Plate-Mesh", "Heat-Flux", "tiles.heat")]}, "`tiles.heat` is no input"),
        ({"reads": [Port("Plate-Mesh", "Heat-Flux", "tiles.x")]}, "4 vertices .* has 1 elements"),
        ({"meshes": {"Plate-Mesh": np.zeros((4, 3))}}, "two vertices at one place"),
        ({"meshes": {"Plate-Mesh": np.eye(4)[:, :2]}}, "where 3 coordinates are needed"),
    ],
)
def test_what_does_not_fit_is_refused(scenes, change, words):
    with Unit(scenes / "tiles.toml") as unit:
        options = {
            "meshes": {"Plate-Mesh": Surface.of(unit, "tiles")},
            "reads": READS,
            "writes": WRITES,
        }
        participant = Participant("Plate", Coupling(EXCHANGES, 1e-3, END))
        with pytest.raises(CouplingError, match=words):
            run(unit, participant, **{**options, **change})


def test_a_plane_coupling_takes_faces_that_lie_in_its_plane(scenes):
    with Unit(scenes / "tiles.toml") as unit:
        surface = Surface.of(unit, "tiles")
        standing = Placement(axes=((1, 0, 0), (0, 0, 1)))
        participant = Participant("Plate", Coupling(EXCHANGES, 1e-3, END, dimensions=2))
        with pytest.raises(CouplingError, match="not parallel to the plane x, y"):
            run(unit, participant, meshes={"Plate-Mesh": surface}, placement=standing)


def test_rings_stand_at_their_mean_radii():
    places = vertices(Surface.rings(3, 3.0, (1.0, 2.0)))
    assert places.tolist() == [[1.5, 2, 0], [2.5, 2, 0], [3.5, 2, 0]]


def test_preCICE_is_loaded_when_it_is_asked_for(monkeypatch):
    monkeypatch.setitem(sys.modules, "precice", None)
    with pytest.raises(CouplingError, match="pip install pyprecice"):
        run(None, "Plate", "config.xml", meshes={})
    monkeypatch.setitem(sys.modules, "precice", types.ModuleType("precice"))
    with pytest.raises(CouplingError, match="version 3 is needed"):
        run(None, "Plate", "config.xml", meshes={})
    with pytest.raises(CouplingError, match="configuration is needed"):
        run(None, "Plate", meshes={})
