"""Windows units under Wine, beside the same units on Linux. Run by `make win64-test`.

The libraries for both systems are in the unit, `tests/windows/drive.c` drives both the same way.
"""

import os
import shutil
import struct
import subprocess
import zipfile
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import quote

import fmpy
import numpy as np
import pytest
from conftest import EVERY_SCENE, ROOT, SCENES, name_of

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
    names: list = field(init=False)

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
        self.names = [v.name for v in self.outputs for _ in range(size(v))]

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
        assert len(words) == steps * len(self.names)
        values = struct.unpack(f">{len(words)}d", bytes.fromhex(b"".join(words).decode()))
        return np.array(values).reshape(steps, -1)


def size(variable):
    counts = [int(dimension.start) for dimension in variable.dimensions or []]
    return int(np.prod(counts)) if counts else 1


def start(variable):
    """Start value of an input; loads differ from those of the scene."""
    value = float(str(variable.start).split()[0])
    return 1.01 * value if variable.unit in ("W/m2", "Pa") else value


@pytest.fixture
def job(pack_coarse, tmp_path, wine, drivers):
    return lambda scene, fmi=2: Job(pack_coarse(scene, fmi), tmp_path, drivers, wine)
