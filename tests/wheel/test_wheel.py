"""The wheel in fresh environments, without a compiler and without this checkout.

Run by `make wheel-test`, which makes the wheel first.
"""

import os
import re
import shutil
import subprocess
import time
import zipfile
from pathlib import Path

import pytest
from conftest import ROOT

USE = Path(__file__).with_name("use.py")
SCENES = ["heated_bed/scene.toml", "solder_drop/drop.toml", "solder_drop/plate.toml"]
# A path without cargo, checkout and other environments.
BARE = {"PATH": "/usr/bin:/bin", "HOME": "", "LANG": "C.UTF-8"}


def interpreters():
    """The versions of Python that are here, by their numbers."""
    found = {}
    places = [shutil.which(f"python3.{minor}") for minor in (11, 12, 13)]
    places += sorted((Path.home() / ".pyenv/versions").glob("3.*/bin/python3"))
    for place in filter(None, places):
        told = subprocess.run([place, "--version"], capture_output=True, text=True)
        version = re.fullmatch(r"Python 3\.(\d+)\.\S+\s*", told.stdout)
        if version and int(version[1]) >= 11:
            found[int(version[1])] = place
    return found


PYTHONS = interpreters()


@pytest.fixture(scope="session")
def wheel():
    wheels = sorted((ROOT / "dist").glob("*manylinux*.whl"))
    assert len(wheels) == 1, f"make wheels; there are {wheels}"
    return wheels[0]


class Environment:
    """A fresh virtual environment, and a folder to work in beside it."""

    def __init__(self, folder, python):
        self.bin, self.work = folder / "venv/bin", folder / "work"
        self.work.mkdir(parents=True)
        self.variables = {**BARE, "HOME": str(folder)}
        for name in ("PIP_INDEX_URL", "PIP_CONFIG_FILE", "SSL_CERT_FILE"):
            if name in os.environ:
                self.variables[name] = os.environ[name]
        subprocess.run([python, "-m", "venv", folder / "venv"], check=True)
        for scene in SCENES:
            shutil.copy(ROOT / "examples" / scene, self.work)

    def __call__(self, program, *arguments, check=True):
        command = [self.bin / program, *map(str, arguments)]
        ran = subprocess.run(
            command, cwd=self.work, env=self.variables, capture_output=True, text=True
        )
        assert ran.returncode == 0 or not check, ran.stdout + ran.stderr
        return ran.stdout

    def install(self, *what):
        self("python", "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *what)


@pytest.fixture(scope="session", params=sorted(PYTHONS), ids=lambda minor: f"3.{minor}")
def environment(request, tmp_path_factory, wheel):
    begun = time.perf_counter()
    folder = tmp_path_factory.mktemp(f"python3{request.param}")
    environment = Environment(folder, PYTHONS[request.param])
    environment.install(wheel, "matplotlib")
    print(f"\ninstalled in {time.perf_counter() - begun:.1f} s")
    return environment


def test_an_installed_wheel_packs_runs_plots_couples_and_studies(environment):
    begun = time.perf_counter()
    for program in ("impinge", "build-fmu"):
        assert environment(program, "--version").split()[0] == program
    environment("impinge", "check", "scene.toml")
    environment("build-fmu", "scene.toml", "-o", "unit.fmu")
    print(f"\npacked in {time.perf_counter() - begun:.1f} s")
    with zipfile.ZipFile(environment.work / "unit.fmu") as unit:
        assert "binaries/linux64/HeatedBed.so" in unit.namelist()
    print(environment("python", USE))
    assert "HeatedBed" in environment(
        "python", "-c", "import impinge; print(impinge.Unit('unit.fmu').name)"
    )


def test_completions_and_manual_pages_are_installed(environment):
    share = environment.bin.parent / "share"
    for place in (
        "man/man1/impinge-run.1",
        "man/man1/build-fmu.1",
        "bash-completion/completions/impinge",
        "zsh/site-functions/_build-fmu",
        "fish/vendor_completions.d/impinge.fish",
        "impinge/completions/impinge.ps1",
    ):
        assert (share / place).stat().st_size > 500, place
    script = share / "bash-completion/completions/impinge"
    asks = "COMP_WORDS=(impinge r); COMP_CWORD=1; _impinge impinge r impinge; echo ${COMPREPLY[@]}"
    asked = subprocess.run(["bash", "-c", f". {script}; {asks}"], capture_output=True, text=True)
    assert "run" in asked.stdout.split()


def test_a_wheel_moved_to_a_folder_of_its_own_finds_its_programs(environment, tmp_path):
    """By `pip install --target`."""
    wheel = next((ROOT / "dist").glob("*manylinux*.whl"))
    environment.install("--no-deps", "--target", tmp_path / "of its own", wheel)
    asks = (
        f"import sys; sys.path.insert(0, {str(tmp_path / 'of its own')!r});"
        "from impinge.unit.build import find_program; print(find_program())"
    )
    found = environment("python", "-c", asks).strip()
    assert found == str(tmp_path / "of its own/bin/build-fmu")
    subprocess.run([found, "scene.toml", "-o", "moved.fmu"], cwd=environment.work, check=True)


def test_units_of_the_wheel_give_the_bits_of_those_of_this_machine(wheel, programs, tmp_path):
    """The wheel is built for older C libraries, by another linker."""
    with zipfile.ZipFile(wheel) as archive:
        (name,) = [name for name in archive.namelist() if name.endswith("/scripts/impinge")]
        own = Path(archive.extract(name, tmp_path))
    own.chmod(0o755)
    for scene in SCENES:
        tables = []
        for program, out in ((own, "wheel"), (programs / "impinge", "here")):
            folder = tmp_path / scene / out
            command = [program, "run", ROOT / "examples" / scene, "--out", folder]
            subprocess.run(command, check=True, capture_output=True)
            tables.append((folder / "outputs.csv").read_bytes())
        assert tables[0] == tables[1], scene


def test_the_wheel_serves_every_python_from_3_11_and_c_libraries_from_2018_on(wheel):
    assert re.fullmatch(r"impinge-[\d.]+-py3-none-manylinux_2_28_x86_64\.whl", wheel.name)
    tool = ROOT / ".venv-dist/bin/auditwheel"
    environment = {**os.environ, "PATH": f"{tool.parent}:{os.environ['PATH']}"}
    said = subprocess.run([tool, "show", wheel], capture_output=True, text=True, env=environment)
    consistent = re.search(r"following platform tag:\s+\"(\w+)\"", said.stdout)
    assert consistent and consistent[1] == "manylinux_2_28_x86_64", said.stdout
