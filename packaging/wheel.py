"""Makes a wheel of the Python package and an installation laid out by packaging/stage.py.

    python packaging/wheel.py STAGE manylinux_2_28_x86_64 -o dist

setuptools builds the package, which is pure Python. Programs and shared data join it in the places
that the format of wheels has for them (`*.data/scripts` and `*.data/data`). One wheel serves every
version of Python. Equal files make equal wheels.
"""

import argparse
import base64
import hashlib
import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LICENCES = ["LICENSE-MIT", "LICENSE-APACHE", "THIRD-PARTY.md"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("stage", type=Path)
    parser.add_argument("platform", help="tag of the platform, such as win_amd64")
    parser.add_argument("-o", "--output", type=Path, default=Path("dist"))
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        files = unpacked(build(Path(folder)))
    information = next(name for name in files if name.endswith(".dist-info/WHEEL"))
    information = information.removesuffix("/WHEEL")
    files |= staged(arguments.stage, information.replace(".dist-info", ".data"))
    for name in LICENCES:
        files[f"{information}/licenses/{name}"] = (ROOT / name).read_bytes()
    files[f"{information}/WHEEL"] = description(arguments.platform)
    files[f"{information}/RECORD"] = record(files, f"{information}/RECORD")
    arguments.output.mkdir(parents=True, exist_ok=True)
    name = information.removesuffix(".dist-info")
    wheel = arguments.output / f"{name}-py3-none-{arguments.platform}.whl"
    write(wheel, files)
    print(wheel, f"({wheel.stat().st_size / 1e6:.1f} MB)")


def build(folder):
    """The wheel of the package alone, without remains of earlier builds."""
    source = folder / "python"
    shutil.copytree(ROOT / "python", source, ignore=shutil.ignore_patterns("build", "*.egg-info"))
    command = [sys.executable, "-m", "pip", "wheel", "--quiet", "--disable-pip-version-check"]
    command += ["--no-deps", "--no-build-isolation", "--wheel-dir", folder, source]
    subprocess.run(command, check=True)
    return next(folder.glob("*.whl"))


def unpacked(wheel):
    with zipfile.ZipFile(wheel) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def staged(stage, data):
    """The files of an installation by their place in a wheel."""
    files = {}
    for path in sorted(path for path in stage.rglob("*") if path.is_file()):
        below = path.relative_to(stage)
        place = f"scripts/{below.name}" if below.parts[0] == "bin" else f"data/{below.as_posix()}"
        files[f"{data}/{place}"] = path.read_bytes()
    if not files:
        raise SystemExit(f"{stage} holds no installation: make it with packaging/stage.py")
    return files


def description(platform):
    tags = "".join(f"Tag: py3-none-{tag}\n" for tag in platform.split("."))
    head = "Wheel-Version: 1.0\nGenerator: impinge packaging/wheel.py\nRoot-Is-Purelib: false\n"
    return (head + tags).encode()


def record(files, own):
    """The list of files with their checksums."""
    rows = []
    for name, content in sorted(files.items()):
        if name != own:
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).decode()
            rows.append(f"{name},sha256={digest.rstrip('=')},{len(content)}\n")
    return "".join([*rows, f"{own},,\n"]).encode()


def write(wheel, files):
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, content in sorted(files.items()):
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            mode = 0o755 if "/scripts/" in name else 0o644
            entry.external_attr = (0o100000 | mode) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, content)


if __name__ == "__main__":
    main()
