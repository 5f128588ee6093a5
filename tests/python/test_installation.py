"""Installations that the package recognises."""

import sys

import pytest
from impinge import errors, installation

build = sys.modules["impinge.unit.build"]

WHEEL = "file:///tmp/impinge-0.2.0-py3-none-any.whl"


@pytest.fixture
def site(tmp_path, monkeypatch):
    """A folder of installed packages that holds this one; the tests write the programs."""
    site = tmp_path / "lib/site-packages"
    information = site / "impinge-0.2.0.dist-info"
    (site / "impinge").mkdir(parents=True)
    information.mkdir()
    (site / "impinge/installation.py").write_text("")
    (information / "METADATA").write_text("Metadata-Version: 2.1\nName: impinge\nVersion: 0.2.0\n")
    (information / "RECORD").write_text(
        "impinge/installation.py,,\n../../bin/build-fmu,,\n../../bin/build-fmu.exe,,\n"
    )
    monkeypatch.setattr(installation, "__file__", str(site / "impinge/installation.py"))
    monkeypatch.syspath_prepend(site)
    return site


def program(folder):
    folder.mkdir(parents=True)
    path = folder / build.PROGRAM
    path.write_text("")
    path.chmod(0o755)
    return path


def test_installed_programs_come_before_those_on_path(site, tmp_path, monkeypatch):
    monkeypatch.delenv("IMPINGE_BIN", raising=False)
    other = program(tmp_path / "elsewhere")
    monkeypatch.setenv("PATH", str(other.parent))
    assert build.find_program() == other
    own = program(tmp_path / "bin")
    assert build.find_program() == own
    monkeypatch.setenv("IMPINGE_BIN", str(other.parent))
    assert build.find_program() == other


def test_programs_moved_by_pip_are_found(site):
    """By `pip install --target`."""
    assert installation.program(build.PROGRAM) is None
    moved = program(site / "bin")
    assert installation.program(build.PROGRAM) == moved


def test_programs_of_another_copy_of_the_package_are_not_taken(site, tmp_path, monkeypatch):
    program(tmp_path / "bin")
    monkeypatch.setattr(installation, "__file__", str(tmp_path / "impinge/installation.py"))
    assert installation.program(build.PROGRAM) is None


def test_extras_are_installed_from_the_same_wheel(site):
    origin = site / "impinge-0.2.0.dist-info/direct_url.json"
    assert "./python[study]" in errors.extra("study")
    origin.write_text(f'{{"url": "{WHEEL}", "archive_info": {{}}}}')
    assert errors.extra("study") == f'pip install "impinge[study] @ {WHEEL}"'
    origin.write_text('{"url": "file:///work/python", "dir_info": {"editable": true}}')
    assert "./python[study]" in errors.extra("study")


def test_a_unit_is_built_anew_once_another_library_is_installed(tmp_path):
    prefix = tmp_path / "prefix"
    own = program(prefix / "bin")
    before = build._key(b"scene", own, 2)
    library = prefix / "share/impinge/win64/impinge.dll"
    library.parent.mkdir(parents=True)
    library.write_text("")
    assert build._key(b"scene", own, 2) != before
