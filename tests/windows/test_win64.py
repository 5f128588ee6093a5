"""Windows units under Wine, compared with the same units on Linux. Run by `make win64-test`.

The libraries for both systems are in the unit, `tests/windows/drive.c` drives both the same way.
"""

import os
import re
import shutil
import struct
import subprocess
import zipfile
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

import fmpy
import numpy as np
import pytest
from conftest import COARSE, ROOT, SCENES, every_scene, name_of

BUILT = Path(
    os.environ.get("IMPINGE_WIN64", ROOT / "target/win64/x86_64-win7-windows-gnu/release")
).resolve()
FOLDERS = {2: ("linux64", "win64"), 3: ("x86_64-linux", "x86_64-windows")}
COMPILER = "x86_64-w64-mingw32-gcc"
# Libraries that every Windows has: the kernel, the C library and what Rust's own library imports.
OF_THE_SYSTEM = {"ADVAPI32", "BCRYPT", "BCRYPTPRIMITIVES", "KERNEL32", "MSVCRT", "NTDLL"}
OF_THE_SYSTEM |= {"USERENV", "WS2_32", "SHELL32", "OLE32", "COMBASE"}
AWKWARD = "Größe 1 %20 ü"


@dataclass
class Wine:
    prefix: Path

    def __call__(self, *command, check=True, **options):
        environment = {**os.environ, "WINEPREFIX": str(self.prefix), "WINEDEBUG": "-all"}
        program = shutil.which("wine64") or "/usr/lib/wine/wine64"
        ran = subprocess.run(
            [program, *map(str, command)], env=environment, capture_output=True, **options
        )
        said = ran.stderr.decode(errors="replace")
        assert ran.returncode == 0 or not check, said
        return ran


@pytest.fixture(scope="session")
def wine(tmp_path_factory):
    """A fresh Windows, which is shut down in the end."""
    wine = Wine(tmp_path_factory.mktemp("wine"))
    wine("wineboot", "-i")
    wine("winecfg", "-v", "win10")
    yield wine
    wine("wineboot", "-k", check=False)


@pytest.fixture(scope="session")
def drivers(tmp_path_factory):
    """The driver for Linux and for Windows."""
    folder = tmp_path_factory.mktemp("drivers")
    source = ROOT / "tests/windows/drive.c"
    common = ["-std=gnu11", "-O2", "-Wall", "-Wextra", "-Werror", f"-I{ROOT / 'include'}", source]
    both = {
        "drive": ["cc", "-D_GNU_SOURCE", *common, "-ldl", "-lpthread"],
        "drive.exe": [COMPILER, "-D__USE_MINGW_ANSI_STDIO=1", *common, "-lpsapi"],
    }
    for name, command in both.items():
        subprocess.run([*command, "-o", folder / name], check=True)
    return folder / "drive", folder / "drive.exe"


def dos(path):
    """The path of a file of this machine as Wine's programs see it."""
    return "Z:" + str(path).replace("/", "\\")


@dataclass
class Job:
    """A unit in a folder with blanks and umlauts, driven on both systems."""

    unit: Path
    folder: Path
    drivers: tuple
    wine: Wine

    def __post_init__(self):
        self.description = fmpy.read_model_description(str(self.unit))
        self.fmi = int(self.description.fmiVersion[0])
        self.unzipped = self.folder / AWKWARD
        with zipfile.ZipFile(self.unit) as archive:
            archive.extractall(self.unzipped)
        kinds = ("Real", "Float64")
        variables = [v for v in self.description.modelVariables if v.type in kinds]
        self.inputs = [v for v in variables if v.causality == "input"]
        self.outputs = [v for v in variables if v.causality == "output"]
        self.units = [measure(v) for v in self.outputs for _ in range(size(v))]

    def resources(self, on_windows):
        path = self.unzipped / "resources"
        if self.fmi == 3:
            return dos(path) + "\\" if on_windows else f"{path}/"
        return f"file:///{'Z:' if on_windows else ''}{quote(str(path))}".replace("////", "///")

    def run(self, on_windows, steps, task="run", **more):
        name = self.description.coSimulation.modelIdentifier
        folder = FOLDERS[self.fmi][on_windows]
        library = self.unzipped / "binaries" / folder / (name + (".so", ".dll")[on_windows])
        lines = {
            "library": dos(library) if on_windows else library,
            "resources": self.resources(on_windows),
            "guid": self.description.guid,
            "version": self.fmi,
            "step": self.description.defaultExperiment.stepSize,
            "steps": steps,
            "task": task,
            **{key: dos(path) if on_windows else path for key, path in more.items()},
        }
        job = self.folder / "job.txt"
        text = [f"{key} {value}" for key, value in lines.items()]
        text += [f"input {v.valueReference} {size(v)} {start(v)!r}" for v in self.inputs]
        text += [f"output {v.valueReference} {size(v)}" for v in self.outputs]
        job.write_text("\n".join(text) + "\n")
        if on_windows:
            ran = self.wine(self.drivers[1], dos(job))
        else:
            ran = subprocess.run([self.drivers[0], job], capture_output=True, check=True)
        words = ran.stdout.split()
        assert len(words) == steps * len(self.units)
        values = struct.unpack(f">{len(words)}d", bytes.fromhex(b"".join(words).decode()))
        return np.array(values).reshape(steps, -1)


def size(variable):
    counts = [int(dimension.start) for dimension in variable.dimensions or []]
    return int(np.prod(counts)) if counts else 1


def start(variable):
    """Start value of an input; loads differ from those of the scene."""
    value = float(str(variable.start).split()[0])
    return 1.01 * value if measure(variable) in ("W/m2", "Pa") else value


def measure(variable):
    """Unit of measurement."""
    return variable.unit or variable.declaredType.unit


@pytest.fixture
def job(pack, tmp_path, wine, drivers):
    """Makes a unit of a scene with the libraries for both systems, and prepares to drive it."""

    def job(scene, fmi=2):
        library = f"win64={BUILT / 'impinge.dll'}"
        unit = pack(scene, COARSE.get(name_of(scene)), fmi, "--library", library)
        folder = tmp_path / str(fmi)
        folder.mkdir()
        return Job(unit, folder, drivers, wine)

    return job


def deviation(linux, windows, units):
    """Largest difference as a share of the largest value of the same unit of measurement."""
    assert np.isfinite(linux).all() and linux.shape == windows.shape
    shares = [0.0]
    for unit in set(units):
        columns = [i for i, other in enumerate(units) if other == unit]
        largest = np.abs(linux[:, columns]).max()
        difference = np.abs(linux - windows)[:, columns].max()
        shares.append(difference / largest if difference > 0.0 else 0.0)
    return max(shares)


# Only here the C libraries' functions round otherwise: hypotenuses, hyperbolic functions, cosines.
ROUNDED = {"cells", "coated_plate", "droplet_impact", "hot_drop", "impact"}
STEPS = 20


@pytest.mark.parametrize("fmi", [2, 3])
@every_scene
def test_results_are_those_of_linux(job, scene, fmi):
    """To the bit, or to rounding where functions of the C library differ."""
    job = job(scene, fmi)
    linux, windows = (job.run(on_windows, STEPS) for on_windows in (False, True))
    if name_of(scene) in ROUNDED:
        assert deviation(linux, windows, job.units) < 1e-9
    else:
        assert (linux == windows).all()


@pytest.mark.parametrize("task", ["threads", "reload"])
@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("name", ["plate", "rings", "impact"])
def test_instances_live_side_by_side_and_after_a_reload(job, name, fmi, task):
    """On four threads at once, or one after the other in a library that is unloaded each time and
    takes no more memory: the driver expects the bits of a first run."""
    job(SCENES / f"{name}.toml", fmi).run(True, 4, task=task)


@pytest.mark.parametrize("name", ["plate", "drop"])
@pytest.mark.parametrize("from_windows", [False, True], ids=["from Linux", "from Windows"])
def test_a_saved_state_goes_on_on_the_other_system(job, name, from_windows, tmp_path):
    job = job(SCENES / f"{name}.toml")
    state = tmp_path / "state"
    whole = job.run(from_windows, STEPS, save=state)
    rest = job.run(not from_windows, STEPS, load=state)
    assert (rest[STEPS // 2 :] == whole[STEPS // 2 :]).all()


def test_a_state_of_damaged_bytes_is_refused(job, tmp_path):
    """A refusal crosses the C interface with its reason, and no panic does."""
    job = job(SCENES / "plate.toml")
    state = tmp_path / "state"
    job.run(True, STEPS, save=state)
    state.write_bytes(state.read_bytes()[:-1] + b"?")
    with pytest.raises(AssertionError, match="fmi2DeSerializeFMUstate"):
        job.run(True, STEPS, load=state)


@pytest.mark.parametrize("name", ["impinge.dll", "impinge.exe", "build-fmu.exe"])
def test_only_libraries_of_the_system_are_imported(name):
    said = subprocess.run(
        ["x86_64-w64-mingw32-objdump", "-p", BUILT / name],
        capture_output=True,
        text=True,
        check=True,
    )
    imported = re.findall(r"DLL Name: (\S+)\.dll", said.stdout, re.IGNORECASE)
    others = {name for name in map(str.upper, imported) if name not in OF_THE_SYSTEM}
    others = {name for name in others if not name.startswith("API-MS-WIN-")}
    assert imported and not others


def contents(unit):
    """The files of a unit; of its scene numbers to 13 digits."""
    with zipfile.ZipFile(unit) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    files["resources/scene.toml"] = re.sub(
        rb"(\d\.\d{12})\d*", rb"\1", files["resources/scene.toml"]
    )
    return files


def test_windows_programs_check_run_and_pack(wine, programs, tmp_path):
    """`build-fmu.exe` packs what `build-fmu` packs, but for the last digit of estimated errors."""
    folder = tmp_path / AWKWARD
    folder.mkdir()
    scene = shutil.copy(SCENES / "plate.toml", folder)
    libraries = {
        "linux64": programs / "libimpinge.so",
        "win64": BUILT / "impinge.dll",
    }
    options = [f"--library={name}={path}" for name, path in libraries.items()]
    subprocess.run([programs / "build-fmu", scene, "-o", folder / "here.fmu", *options], check=True)
    wine(BUILT / "impinge.exe", "check", dos(scene))
    options = [f"--library={name}={dos(path)}" for name, path in libraries.items()]
    there = dos(folder / "there.fmu")
    wine(BUILT / "build-fmu.exe", dos(scene), "-o", there, *options)
    assert contents(folder / "there.fmu") == contents(folder / "here.fmu")
    wine(BUILT / "build-fmu.exe", "--lint", there)
    for program, out, path in (
        ([programs / "impinge"], "linux", lambda path: path),
        (None, "windows", dos),
    ):
        arguments = ["run", path(scene), "--until", "1e-5", "--out", path(folder / out)]
        if program:
            subprocess.run([*program, *arguments], check=True, capture_output=True)
        else:
            wine(BUILT / "impinge.exe", *arguments)
    tables = [(folder / out / "outputs.csv").read_bytes() for out in ("linux", "windows")]
    assert tables[0] == tables[1]
