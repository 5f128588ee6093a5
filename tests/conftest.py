"""Builds the release programs once, and units from scenes on demand."""

import fcntl
import hashlib
import os
import re
import shutil
import subprocess
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
# Programs that tests start find the package, too.
os.environ["PYTHONPATH"] = os.pathsep.join(
    [str(ROOT / "python"), str(ROOT / "tests"), *filter(None, [os.environ.get("PYTHONPATH")])]
)
# Programs that tests start share a store of their own, and leave the user's alone.
os.environ.setdefault("IMPINGE_CACHE", str(ROOT / "target/cache"))
SCENES = ROOT / "tests/fmpy/scenes"
EXAMPLES = sorted(ROOT.glob("examples/*/scene.toml"))
EVERY_SCENE = [*EXAMPLES, *sorted(SCENES.glob("*.toml"))]

# Examples that take long, on few nodes and particles: all variables are the same.
COARSE = {
    "alumina_plate": {
        "spacing = 5e-6, depth_spacing = 0.05e-6, growth = 1.6": "spacing = 2e-5, "
        "depth_spacing = 1e-6, growth = 2.0"
    },
    "coated_plate": {
        "spacing = 100e-6, depth_spacing = 2e-6, growth = 1.5": "spacing = 2e-4, order = 1, "
        "depth_spacing = 4e-6, growth = 2.0",
        "spacing = 300e-6, depth_spacing = 2e-6, growth = 1.5": "spacing = 6e-4, order = 1, "
        "depth_spacing = 4e-6, growth = 2.0",
        "\nspacing = 125e-6": "\nspacing = 250e-6",
    },
    "drop_on_hot_glass": {"\nspacing = 80e-6": "\nspacing = 200e-6"},
    "droplet_impact": {
        "\nspacing = 2.5e-6": "\nspacing = 6e-6",
        "spacing = 7.5e-6, depth_spacing = 0.3e-6": "spacing = 20e-6, depth_spacing = 0.6e-6",
    },
    "gel_drop_on_plate": {"spacing = 0.35e-3": "spacing = 1e-3"},
    "hot_drop": {
        "\nspacing = 10e-6": "\nspacing = 50e-6",
        "{ spacing = 10e-6 }": "{ spacing = 50e-6 }",
    },
    "mini_slump": {"\nspacing = 1.2e-3": "\nspacing = 3e-3"},
    "moving_spot": {
        "spacing = 40e-6, depth_spacing = 10e-6, growth = 1.4": "spacing = 1e-4, "
        "depth_spacing = 2e-5, growth = 2.0"
    },
    "notched_beam": {"\nspacing = 9.525e-3": "\nspacing = 19.05e-3"},
    "paste_bead": {"\nspacing = 0.2e-3": "\nspacing = 0.25e-3"},
    "printed_line": {
        "\nspacing = 3e-6": "\nspacing = 8e-6",
        "spacing = 3e-5, depth_spacing = 5e-6": "spacing = 6e-5, depth_spacing = 1e-5",
    },
    "printed_strand": {
        "spacing = 0.1e-3 }\nfaces.right = { clamped = true }      #": "spacing = 0.2e-3 }\n"
        "faces.right = { clamped = true }      #",
        "spacing = 0.1e-3 }\nfaces.right = { clamped = true }\n\n[material": "spacing = 0.2e-3 }\n"
        "faces.right = { clamped = true }\n\n[material",
    },
    "thermostat_strip": {"spacing = 0.2e-3": "spacing = 0.8e-3"},
    "quench_cracks": {"strength = 180e6": "strength = 80e6"},
    "crack_network": {"strength = 180e6": "strength = 90e6"},
    "glass_strip": {"length = 0.75e-3": "length = 3e-3"},
    "remelting": {"\nspacing = 80e-6": "\nspacing = 270e-6"},
    "stress_study": {
        "spacing = 25e-6, depth_spacing = 20e-6": "spacing = 1e-4, depth_spacing = 5e-5"
    },
    "tin_drop": {"\nspacing = 60e-6": "\nspacing = 270e-6"},
    "wax_layers": {"mesh = { spacing = 0.4e-3 }": "mesh = { spacing = 1.5e-3, order = 1 }"},
    "wax_line": {"mesh = { spacing = 0.8e-3 }": "mesh = { spacing = 1e-3, order = 1 }"},
}
# Fields of examples that have hundreds of points.
GRIDS = {
    "alumina_plate": {"grid = [24, 24]": "grid = [4, 2]"},
    "droplet_impact": {"grid = [32, 32]": "grid = [4, 2]"},
    "moving_spot": {"grid = [32, 20]": "grid = [4, 2]"},
    "printed_line": {"grid = [48, 16]": "grid = [4, 2]"},
    "printer_control": {"grid = [40, 12]": "grid = [4, 2]"},
    "quench_cracks": {"grid = [144, 48]": "grid = [4, 2]"},
    "crack_network": {"grid = [61, 61]": "grid = [4, 2]", "grid = [61, 31]": "grid = [4, 2]"},
    "glass_strip": {"grid = [72, 93]": "grid = [4, 2]"},
    "wax_layers": {"grid = [24, 24]": "grid = [4, 3]"},
    "wax_line": {"grid = [60, 45]": "grid = [4, 3]"},
}


def name_of(scene):
    """Of an example its folder, of a small scene its file."""
    return scene.parent.name if scene.name == "scene.toml" else scene.stem


every_scene = pytest.mark.parametrize("scene", EVERY_SCENE, ids=name_of)


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

    def pack(scene, edits=None, fmi=2, *options):
        path = SCENES / f"{scene}.toml" if isinstance(scene, str) else scene
        text = path.read_text()
        for old, new in (edits or {}).items():
            assert text.count(old) == 1, f"`{old}` stands {text.count(old)} times in {path}"
            text = text.replace(old, new)
        digest = hashlib.sha256(f"{fmi} {options} {path} {text}".encode()).hexdigest()[:16]
        name = re.sub(r"\W", "_", path.stem)
        folder = units / f"{name}_{digest}"
        folder.mkdir(exist_ok=True)
        unit = folder / "unit.fmu"
        # Another process may be making it; a unit that could not be made is not there.
        with open(folder / "lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not unit.is_file():
                (folder / "scene.toml").write_text(text)
                for kind in ["gcode", "vtu", "csv"]:
                    for file in path.parent.glob(f"*.{kind}"):
                        shutil.copy(file, folder)
                build(programs, folder / "scene.toml", unit, "--fmi", str(fmi), *options)
        return unit

    return pack


@pytest.fixture(scope="session")
def pack_coarse(pack):
    """Makes a unit of any scene, of an example on a coarse mesh: for tests of no values."""
    return lambda scene, fmi=2: pack(scene, COARSE.get(name_of(scene)), fmi)


@pytest.fixture(scope="session")
def pack_small(pack):
    """The same with fields of few points, each of which is a variable."""
    return lambda scene, fmi=2: pack(
        scene, COARSE.get(name_of(scene), {}) | GRIDS.get(name_of(scene), {}), fmi
    )


def build(programs, scene, unit, *options):
    command = [programs / "build-fmu", scene, "-o", unit, *options]
    made = subprocess.run(command, capture_output=True, text=True, check=False)
    assert made.returncode == 0, made.stderr


# Keys and values that make heat or deformation of a solid nonlinear.
NONLINEAR = re.compile(
    r"'finite'|plastic'|'viscoelastic'|'fracture'|'melting'|'radiation'|'bath'|'temperature': \["
)


def order_of_output_derivatives(text):
    """Order of output derivatives of the unit of a scene: none with droplets, below bodies that
    fall or are laid as a whole, or without a linear solid."""
    scene = tomllib.loads(text)
    named = scene.get("material", {})

    def is_linear(body):
        layers = [body, *body.get("layers", [])]
        own = [
            named.get(layer["material"])
            for layer in layers
            if isinstance(layer.get("material"), str)
        ]
        return body["kind"] == "solid" and not NONLINEAR.search(repr([body, own]))

    is_linked = any("." not in coupling["from"] for coupling in scene.get("coupling", []))
    drops = any(body["kind"] == "droplet" for body in scene["body"].values())
    return int(not is_linked and not drops and any(map(is_linear, scene["body"].values())))
