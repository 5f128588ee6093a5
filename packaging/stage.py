"""Lays out an installation below a folder: programs, libraries, completions, manual pages.

    python packaging/stage.py PREFIX --programs FOLDER --library linux64=FOLDER/libimpinge.so

The layout is that of Unix: `bin`, `share/man` and others. `build-fmu` looks for libraries in
`../share/impinge/PLATFORM`.
"""

import argparse
import shutil
import subprocess
from pathlib import Path

PROGRAMS = ["impinge", "build-fmu"]
# Folders below `share` in which shells look for completions.
COMPLETIONS = {
    "bash": "bash-completion/completions/{}",
    "zsh": "zsh/site-functions/_{}",
    "fish": "fish/vendor_completions.d/{}.fish",
    "powershell": "impinge/completions/{}.ps1",
}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("prefix", type=Path)
    parser.add_argument("--programs", type=Path, required=True, help="folder with the programs")
    parser.add_argument(
        "--describe", type=Path, help="folder with programs that run here, if the others do not"
    )
    parser.add_argument("--library", action="append", default=[], metavar="PLATFORM=PATH")
    arguments = parser.parse_args()
    install_programs(arguments.programs, arguments.prefix / "bin")
    for library in arguments.library:
        platform, _, path = library.partition("=")
        install(Path(path), arguments.prefix / "share/impinge" / platform)
    describe(arguments.describe or arguments.programs, arguments.prefix / "share")


def install(file, folder):
    """Replaces a file at once: a program that runs keeps the earlier one."""
    folder.mkdir(parents=True, exist_ok=True)
    unfinished = folder / f".{file.name}.part"
    shutil.copyfile(file, unfinished)
    shutil.copymode(file, unfinished)
    unfinished.replace(folder / file.name)


def install_programs(folder, target):
    for name in PROGRAMS:
        found = [path for path in (folder / name, folder / f"{name}.exe") if path.is_file()]
        if not found:
            raise SystemExit(f"{folder} has no {name}: build it first")
        install(found[0], target)


def describe(programs, share):
    """Completions and manual pages, as the programs make them."""
    for shell, place in COMPLETIONS.items():
        for name, argument in (("impinge", "completions"), ("build-fmu", "--completions")):
            file = share / place.format(name)
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(subprocess.check_output([programs / name, argument, shell]))
    pages = share / "man/man1"
    subprocess.run([programs / "impinge", "man", pages], check=True)
    subprocess.run([programs / "build-fmu", "--man", pages], check=True, stdout=subprocess.DEVNULL)


if __name__ == "__main__":
    main()
