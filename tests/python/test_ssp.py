"""Systems of units as SSP files: FMPy and ecospy load them and compute what a loop by hand does."""

import json
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest
from fmpy.ssp.simulation import simulate_ssp
from fmpy.ssp.ssd import read_ssd
from impinge import Unit, ssp

SCENES = Path(__file__).resolve().parents[1] / "fmpy/scenes"
STEP, STEPS = 1e-7, 10  # s
ECOS = """
import ctypes, json, sys
tbb, path, step, steps, parameters, watched = json.loads(sys.argv[1])
# ecospy loads libtbb.so.12 but does not bring it.
ctypes.CDLL(tbb, mode=ctypes.RTLD_GLOBAL)
from ecospy import EcosSimulation
with EcosSimulation(step, ssp_path=path) as simulation:
    simulation.init(parameter_set=parameters)
    for _ in range(steps):
        simulation.step()
    print(json.dumps([simulation.get_real(name) for name in watched]))
"""


@pytest.fixture(scope="module")
def plate(tmp_path_factory):
    """A round plate under rings as those of the drop's wall."""
    text = (SCENES / "rings.toml").read_text()
    assert "radius = 8e-5" in text
    path = tmp_path_factory.mktemp("scenes") / "plate.toml"
    path.write_text(text.replace("radius = 8e-5", "radius = 1e-4"))
    return path


def by_hand(plate, *, temperature=None, conductivity=None, back=False):
    """Both units side by side, what one has after a step going to the other before the next."""
    own = {} if conductivity is None else {"plate.conductivity": conductivity}
    with Unit(SCENES / "drop.toml") as drop, Unit(plate, parameters=own) as solid:
        if temperature is not None:
            drop["wall.temperature"] = temperature
        flux, pressure = drop["wall.heat_flux"], drop["wall.pressure"]
        for _ in range(STEPS):
            solid["splat.heat_flux"], solid["splat.pressure"] = flux, pressure
            if back:
                drop["wall.temperature"] = np.full(4, solid["centre.temperature"] * 0.5 + 160.0)
            drop.step(STEP)
            solid.step(STEP)
            flux, pressure = drop["wall.heat_flux"], drop["wall.pressure"]
        # Stress follows pressure at once.
        solid["splat.heat_flux"], solid["splat.pressure"] = flux, pressure
        return flux, solid["centre.temperature"], solid["off.stress_xx"]


def ecos(path, watched, parameters=None):
    tbb = Path(sys.prefix) / "lib/libtbb.so.12"
    job = json.dumps([str(tbb), str(path), STEP, STEPS, parameters, watched])
    done = subprocess.run(
        [sys.executable, "-c", ECOS, job], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.strip().splitlines()[-1])


LINKS = [
    ("drop.wall.heat_flux", "plate.splat.heat_flux"),
    ("drop.wall.pressure", "plate.splat.pressure"),
]
WATCHED = [f"drop::wall.heat_flux[{i + 1}]" for i in range(4)]
WATCHED += ["plate::centre.temperature", "plate::off.stress_xx"]


def test_fmpy_runs_what_is_written(plate, tmp_path):
    units = {"drop": SCENES / "drop.toml", "plate": plate}
    path = ssp.write(tmp_path / "a.ssp", units, LINKS, stop=STEP * STEPS)
    structure = read_ssd(str(path))  # checked against the standard's schema
    assert [element.name for element in structure.system.elements] == ["drop", "plate"]
    assert len(structure.system.connections) == 8
    rows = simulate_ssp(str(path), stop_time=STEP * (STEPS - 0.5), step_size=STEP)
    flux, _, _ = by_hand(plate)
    assert len(rows) == STEPS
    found = [rows[f"drop.wall.heat_flux[{i + 1}]"][-1] for i in range(4)]
    assert found == pytest.approx(flux, rel=1e-12)
    # What a step brings out stands at the plate's inputs before the next.
    assert rows["plate.splat.heat_flux[2]"].tolist() == rows["drop.wall.heat_flux[2]"].tolist()
    assert np.abs(flux).max() > 1e6


def test_ecos_runs_what_is_written(plate, tmp_path):
    units = {"drop": SCENES / "drop.toml", "plate": plate}
    path = ssp.write(tmp_path / "a.ssp", units, LINKS)
    *flux, temperature, stress = ecos(path, WATCHED)
    expected = by_hand(plate)
    assert flux == pytest.approx(expected[0], rel=1e-12)
    assert temperature == pytest.approx(expected[1], rel=1e-12)
    assert stress == pytest.approx(expected[2], rel=1e-9)
    assert temperature > 293.5


def test_ecos_takes_parameters_and_linear_transformations(plate, tmp_path):
    back = [
        ssp.Link("plate.centre.temperature", f"drop.wall.temperature[{i + 1}]", 0.5, 160.0)
        for i in range(4)
    ]
    units = {"drop": SCENES / "drop.toml", "plate": plate}
    given = {"plate.plate.conductivity": 25.0, "drop.wall.temperature": [310.0, 311, 312, 313]}
    path = ssp.write(tmp_path / "a.ssp", units, [*LINKS, *back], parameters=given)
    *flux, temperature, _ = ecos(path, WATCHED, "parameters")
    expected = by_hand(plate, conductivity=25.0, back=True)
    assert flux == pytest.approx(expected[0], rel=1e-9)
    assert temperature == pytest.approx(expected[1], rel=1e-12)
    without = ecos(path, WATCHED)
    assert without[4] != pytest.approx(temperature, rel=1e-5)
    # Arrays of values before initialisation
    path = ssp.write(tmp_path / "b.ssp", units, LINKS, parameters=given)
    *flux, _, _ = ecos(path, WATCHED, "parameters")
    expected = by_hand(plate, conductivity=25.0, temperature=[310.0, 311, 312, 313])
    assert flux == pytest.approx(expected[0], rel=1e-12)


def test_units_may_be_files_folders_and_instances(plate, tmp_path):
    with Unit(SCENES / "drop.toml") as drop, Unit(plate) as solid:
        units = {"drop": drop, "plate": solid.folder}
        path = ssp.write(tmp_path / "a.ssp", units, LINKS[:1])
    with zipfile.ZipFile(path) as archive:
        assert sorted(archive.namelist()) == [
            "SystemStructure.ssd",
            "resources/drop.fmu",
            "resources/plate.fmu",
        ]
        archive.extract("resources/drop.fmu", tmp_path)
    with Unit(tmp_path / "resources/drop.fmu") as again:
        again.step(STEP)
    files = {"drop": tmp_path / "resources/drop.fmu", "plate": plate}
    assert ecos(ssp.write(tmp_path / "b.ssp", files, LINKS[:1]), WATCHED) == ecos(path, WATCHED)


@pytest.mark.parametrize(
    ("links", "options", "words"),
    [
        ([("drop.wall.heat_flux", "plat.splat.heat_flux")], {}, "`plat` is none of the units"),
        ([("drop.wall.temperature", "plate.splat.heat_flux")], {}, "is no output, but input"),
        ([("drop.wall.heat_flux", "plate.centre.temperature")], {}, "is no input, but output"),
        ([("drop.wall.heat_flux", "plate.splat.heat_flux[1]")], {}, "has 4 elements, .* has 1"),
        ([("drop.wall.heat_flux", "plate.splat.pressure")], {}, "measured in W/m2, .* in Pa"),
        ([LINKS[0], LINKS[0]], {}, r"plate.splat.heat_flux\[1\]: is connected to drop"),
        ([], {"parameters": {"plates.conductivity": 1}}, "plates.conductivity: none of the units"),
        ([], {"parameters": {"plate.off.stress_xx": 1}}, "is no parameter or input, but output"),
    ],
)
def test_what_does_not_connect_is_refused(plate, tmp_path, links, options, words):
    units = {"drop": SCENES / "drop.toml", "plate": plate}
    with pytest.raises(ssp.SspError, match=words):
        ssp.write(tmp_path / "a.ssp", units, links, **options)
    assert not (tmp_path / "a.ssp").exists()


def test_units_of_fmi_3_are_refused(plate, tmp_path):
    with Unit(plate, fmi=3) as unit:
        with pytest.raises(ssp.SspError, match="plate: is a unit of FMI 3; SSP 1.0 connects"):
            ssp.write(tmp_path / "a.ssp", {"plate": unit}, [])
    with pytest.raises(ssp.SspError, match="`a.b` is no name for a unit"):
        ssp.write(tmp_path / "a.ssp", {"a.b": plate}, [])
