"""Writes THIRD-PARTY.md: the crates linked into library and programs, with version and licence.

Run it at the repository root after a change of dependencies: python build-fmu/third-party.py
"""

import json
import pathlib
import subprocess

HEAD = """# Third-party software

The library in a unit is linked with these crates, under the licences they declare.
Made by `build-fmu/third-party.py` from the locked dependencies.
"""
PROGRAMS = """
## The programs alone
`impinge` and `build-fmu` are linked with these, too. Libraries and programs for Windows contain the
start-up code of mingw-w64 (public domain and ZPL 2.1) and parts of GCC's run-time library (GPL 3
with its exception for such use).
"""
TABLE = """
| crate | version | licence | source |
|---|---|---|---|
"""


def linked(metadata, *names):
    """Packages of others that those of these names depend on outside of builds and tests."""
    nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}
    packages = {package["id"]: package for package in metadata["packages"]}
    found, left = set(), [i for i, package in packages.items() if package["name"] in names]
    while left:
        for dependency in nodes[left.pop()]["deps"]:
            normal = any(kind["kind"] is None for kind in dependency["dep_kinds"])
            targets = packages[dependency["pkg"]]["targets"]
            kinds = {kind for target in targets for kind in target["kind"]}
            if normal and "proc-macro" not in kinds and dependency["pkg"] not in found:
                found.add(dependency["pkg"])
                left.append(dependency["pkg"])
    others = (packages[i] for i in found if packages[i]["source"])  # not this workspace's own
    return sorted(others, key=lambda package: (package["name"], package["version"]))


def table(packages):
    rows = []
    for package in packages:
        licence = package["license"] or package["license_file"]
        cells = [package["name"], package["version"], licence, package["repository"] or ""]
        rows.append(f"| {' | '.join(cells)} |\n")
    return TABLE + "".join(rows)


def main():
    root = pathlib.Path(__file__).parent.parent
    command = ["cargo", "metadata", "--locked", "--format-version", "1"]
    command += ["--filter-platform", "x86_64-unknown-linux-gnu"]
    metadata = json.loads(subprocess.run(command, cwd=root, check=True, capture_output=True).stdout)
    library = linked(metadata, "impinge")
    programs = [p for p in linked(metadata, "impinge-cli", "build-fmu") if p not in library]
    text = HEAD + table(library) + PROGRAMS + table(programs)
    (root / "THIRD-PARTY.md").write_text(text)


if __name__ == "__main__":
    main()
