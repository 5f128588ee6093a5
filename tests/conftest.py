"""Builds the release programs once, and units from scenes on demand."""

import fcntl
import hashlib
import os
import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
# Programs that tests start find the package, too.
os.environ["PYTHONPATH"] = os.pathsep.join(
    [str(ROOT / "python"), str(ROOT / "tests"), *filter(None, [os.environ.get("PYTHONPATH")])]
)
SCENES = ROOT / "tests/fmpy/scenes"
EXAMPLES = sorted(ROOT.glob("examples/*/scene.toml"))


@pytest.fixture(scope="session")
def programs():
    """The folder of build-fmu and impinge; IMPINGE_BIN names one where they are built already."""
    if "IMPINGE_BIN" in os.environ:
        return Path(os.environ["IMPINGE_BIN"]).resolve()
    subprocess.run(["cargo", "build", "--release", "--workspace"], cwd=ROOT, check=True)
    return ROOT / "target/release"


@pytest.fixture(scope="session")
def units(tmp_path_factory):
    """A folder that all processes of this test run share."""
    own = tmp_path_factory.getbasetemp()
    folder = (own.parent if "PYTEST_XDIST_WORKER" in os.environ else own) / "units"
    folder.mkdir(exist_ok=True)
    return folder


@pytest.fixture(scope="session")
def pack(programs, units):
    """Makes a unit of a scene, given by the name of a small one or by its path, after some edits
    `{old: new}`, of version `fmi` of the standard; the same unit is made once."""

    def pack(scene, edits=None, fmi=2):
        path = SCENES / f"{scene}.toml" if isinstance(scene, str) else scene
        text = path.read_text()
        for old, new in (edits or {}).items():
            assert text.count(old) == 1, f"`{old}` stands {text.count(old)} times in {path}"
            text = text.replace(old, new)
        digest = hashlib.sha256(f"{fmi} {path} {text}".encode()).hexdigest()[:16]
        name = re.sub(r"\W", "_", path.stem)
        folder = units / f"{name}_{digest}"
        folder.mkdir(exist_ok=True)
        unit = folder / "unit.fmu"
        # Another process may be making it; a unit that could not be made is not there.
        with open(folder / "lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not unit.is_file():
                (folder / "scene.toml").write_text(text)
                build(programs, folder / "scene.toml", unit, "--fmi", str(fmi))
        return unit

    return pack


def build(programs, scene, unit, *options):
    command = [programs / "build-fmu", scene, "-o", unit, *options]
    made = subprocess.run(command, capture_output=True, text=True, check=False)
    assert made.returncode == 0, made.stderr
