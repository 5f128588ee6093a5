"""Units of scenes: built once for each content, kept in a folder of the user's."""

import hashlib
import os
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

from impinge import installation
from impinge.errors import UnitError
from impinge.reading import LARGEST_SCENE, read_bytes, reading
from impinge.unit.temporary import LockedFolder

PROGRAM = "build-fmu" + (".exe" if sys.platform == "win32" else "")


def find_program(name: str = PROGRAM) -> Path:
    """Path of the program: in the folder that IMPINGE_BIN names, among the files installed with
    this package, on PATH, or in target/release of a checkout: the one that holds this package, or
    the one that holds the current folder."""
    said = os.environ.get("IMPINGE_BIN")
    if said:
        path = Path(said)
        path = path if path.is_file() and path.name == name else path / name
        if not path.is_file():
            raise UnitError(f"IMPINGE_BIN is {said}, but there is no {path}")
        return path
    found = installation.program(name) or shutil.which(name)
    if found:
        return Path(found)
    checkouts = _checkouts()
    for folder in checkouts:
        path = folder / "target/release" / name
        if path.is_file():
            return path
    places = [str(folder / "target/release") for folder in checkouts] or [
        "the target/release of a checkout, as neither this package nor the current folder is in one"
    ]
    raise UnitError(
        f"`{name}` is neither installed with this package, nor on PATH, nor in"
        f" {' nor in '.join(places)}: install the wheel of impinge, which holds it; or build it"
        " with `cargo build --release --workspace` in the checkout of impinge, and there say"
        " `export IMPINGE_BIN=$PWD/target/release`"
    )


def _checkouts() -> list[Path]:
    """Roots of checkouts of impinge above this package and the current folder, nearest first."""
    here, package = Path.cwd().resolve(), Path(__file__).resolve()
    folders = dict.fromkeys([*package.parents, here, *here.parents])
    return [folder for folder in folders if _is_checkout(folder)]


def _is_checkout(folder: Path) -> bool:
    try:
        told = tomllib.loads((folder / "Cargo.toml").read_text())
    except (OSError, ValueError):
        return False
    return told.get("package", {}).get("name") == "impinge"


def cache_folder() -> Path:
    """Where built units are kept: IMPINGE_CACHE, or `impinge` in the user's folder of caches."""
    said = os.environ.get("IMPINGE_CACHE")
    if said:
        return Path(said)
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(base) / "impinge"


def build(scene: str | Path, *, fmi: int | None = None, text: str | None = None) -> Path:
    """The unit of a scene, for version `fmi` (2 or 3; 2 if it is left out) of the standard.

    It is built if the cache has none of the same content, program and version. `text` takes the
    place of what the file holds. Raises `UnitError` with what `build-fmu` says.
    """
    scene = Path(scene)
    fmi = 2 if fmi is None else fmi
    if fmi not in (2, 3):
        raise UnitError(f"fmi is {fmi}; it may be 2 or 3")
    with reading(scene, UnitError):
        content = read_bytes(scene, LARGEST_SCENE) if text is None else text.encode()
    files = files_of(content, scene.parent)
    program = find_program()
    parts = [content, *(b"\0" + name.encode() + b"\0" + file for name, file in files.items())]
    unit = cache_folder() / "units" / _key(b"".join(parts), program, fmi) / "unit.fmu"
    if unit.is_file():
        return unit
    unit.parent.mkdir(parents=True, exist_ok=True)
    with LockedFolder(unit.parent) as folder:
        source = folder.path / scene.name  # what the key was made of, whatever is saved meanwhile
        for name, file in {scene.name: content, **files}.items():
            place = folder.path / name
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_bytes(file)
        made = folder.path / "unit.fmu"
        command = [program, source, "-o", made, "--fmi", str(fmi)]
        ran = subprocess.run(command, capture_output=True, text=True, check=False)
        if ran.returncode != 0:
            said = ran.stderr.replace(str(source), str(scene))
            said = said.replace(str(folder.path), str(scene.parent))
            raise UnitError(f"{scene} makes no unit", said.strip().splitlines())
        os.replace(made, unit)  # whole or not at all, however many processes build it
    return unit


def files_of(content: bytes, folder: Path) -> dict[str, bytes]:
    """The files that a scene names and has not in its text, by name: G-code of filaments, parts.

    Those that `build-fmu` refuses are left out.
    """
    try:
        scene = tomllib.loads(content.decode())
        bodies = list(scene.get("body", {}).values())
    except (ValueError, AttributeError):
        return {}
    bodies = [body for body in bodies if isinstance(body, dict)]
    shapes = [body.get("shape") for body in bodies]
    tables = [body.get("path") for body in bodies]
    tables += [shape.get("part") for shape in shapes if isinstance(shape, dict)]
    names = [table.get("file") for table in tables if isinstance(table, dict)]
    found = {}
    for name in names:
        if not isinstance(name, str) or "files" in scene or ".." in Path(name).parts:
            continue
        if not Path(name).is_absolute() and (folder / name).is_file():
            with reading(folder / name, UnitError):
                found[name] = read_bytes(folder / name, LARGEST_SCENE)
    return found


# The prebuilt libraries by the folder of their platform.
LIBRARIES = {
    "linux64": "libimpinge.so",
    "win64": "impinge.dll",
    "darwin64": "libimpinge.dylib",
    "aarch64-linux": "libimpinge.so",
    "aarch64-darwin": "libimpinge.dylib",
}


def _libraries(program: Path) -> list[Path]:
    """Folders in which `build-fmu` looks for libraries."""
    folder = program.resolve().parent
    beside = [folder / name for name in dict.fromkeys(LIBRARIES.values())]
    folders = [folder, folder.parent / "share/impinge"]
    return [
        *beside,
        *(f / platform / name for f in folders for platform, name in LIBRARIES.items()),
    ]


def _key(content: bytes, program: Path, fmi: int) -> str:
    parts = [content, str(fmi).encode()]
    for file in (program, *_libraries(program)):
        if file.is_file():
            status = file.stat()
            parts.append(f"{file.resolve()} {status.st_mtime_ns} {status.st_size}".encode())
    digest = hashlib.sha256()
    for part in parts:
        digest.update(hashlib.sha256(part).digest())
    return digest.hexdigest()[:24]
