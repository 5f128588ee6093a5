"""Builds the release programs once, and units from scenes on demand."""

import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SCENES = Path(__file__).parent / "scenes"
EXAMPLES = sorted(ROOT.glob("examples/*/scene.toml"))


@pytest.fixture(scope="session")
def programs():
    """The folder of build-fmu and impinge."""
    subprocess.run(["cargo", "build", "--release", "--workspace"], cwd=ROOT, check=True)
    return ROOT / "target/release"


@pytest.fixture(scope="session")
def pack(programs, tmp_path_factory):
    """Makes a unit of a scene, given by the name of a small one or by its path, after some edits
    `{old: new}`, of version `fmi` of the standard; the same unit is made once."""
    done = {}

    def pack(scene, edits=None, fmi=2):
        path = SCENES / f"{scene}.toml" if isinstance(scene, str) else scene
        text = path.read_text()
        for old, new in (edits or {}).items():
            assert text.count(old) == 1, f"`{old}` stands {text.count(old)} times in {path}"
            text = text.replace(old, new)
        if (text, fmi) not in done:
            folder = tmp_path_factory.mktemp(re.sub(r"\W", "_", path.stem))
            (folder / "scene.toml").write_text(text)
            build(programs, folder / "scene.toml", folder / "unit.fmu", "--fmi", str(fmi))
            done[text, fmi] = folder / "unit.fmu"
        return done[text, fmi]

    return pack


def build(programs, scene, unit, *options):
    command = [programs / "build-fmu", scene, "-o", unit, *options]
    made = subprocess.run(command, capture_output=True, text=True, check=False)
    assert made.returncode == 0, made.stderr
