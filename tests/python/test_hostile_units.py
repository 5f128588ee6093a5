"""Units of strangers: zip files and descriptions that lie, and folders of killed processes."""

import json
import os
import re
import shutil
import signal
import stat
import struct
import subprocess
import sys
import time
import zipfile
from pathlib import Path

import pytest
from impinge import Surface, Unit, UnitError
from impinge.surface import SurfaceError
from impinge.unit import archive, open_package, temporary
from impinge.unit.library import check_library
from linear_unit import make

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def unit(tmp_path_factory):
    return make(tmp_path_factory.mktemp("decay"), "Decay", [[-2.0]], [1.0], [1.0], x=[3.0])


def entries_of(unit):
    with zipfile.ZipFile(unit) as whole:
        return {name: whole.read(name) for name in whole.namelist()}


@pytest.fixture
def remade(unit, tmp_path):
    """Writes the unit again with other entries, after those of `first`."""

    def remade(changes=None, more=(), name="a.fmu"):
        path = tmp_path / name
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as out:
            for entry, content in {**entries_of(unit), **(changes or {})}.items():
                out.writestr(entry, content)
            for entry, content in more:
                out.writestr(entry, content)
        return path

    return remade


def patched(unit, folder, field, value, name="modelDescription.xml"):
    """A copy with another value in the directory's entry of a name."""
    data = bytearray(Path(unit).read_bytes())
    at = data.find(b"PK\1\2")
    while bytes(data[at + 46 : at + 46 + struct.unpack_from("<H", data, at + 28)[0]]) != (
        name.encode()
    ):
        at = data.find(b"PK\1\2", at + 1)
    offset, form = {"flags": (8, "<H"), "method": (10, "<H"), "size": (24, "<I")}[field]
    struct.pack_into(form, data, at + offset, value)
    path = folder / "patched.fmu"
    path.write_bytes(data)
    return path


def refused(path, words):
    with pytest.raises(UnitError, match=re.escape(path.name) + ".*" + words):
        Unit(path)


def test_bombs_are_refused_before_they_are_unpacked(remade, monkeypatch, tmp_path):
    taken = {"resources/large": bytes(100_000)}
    for name, value, words in [
        ("LARGEST_ENTRY", 99_999, "resources/large: 100000 bytes when .*at most 99999"),
        ("MOST_UNPACKED", 999, "bytes when unpacked .*at most 999"),
        ("MOST_ENTRIES", 2, "entries .*at most 2"),
        ("LARGEST_FILE", 100, "bytes .*at most 100"),
        ("JUDGED_RATIO", 99_999, "100000 bytes of .* packed ones"),
        ("_LARGEST_DIRECTORY", 50, "its directory has .* bytes .*at most 50"),
    ]:
        path = remade(taken, name=f"{name}.fmu")
        with monkeypatch.context() as patch:
            patch.setattr(archive, name, value)
            if name == "JUDGED_RATIO":
                patch.setattr(archive, "MOST_RATIO", 2)
            refused(path, words)
    open_package(path)


def test_limits_are_those_of_the_linter():
    package = (ROOT / "fmu-lint/src/package.rs").read_text()
    sizes = (ROOT / "fmu-lint/src/rules/zip_sizes.rs").read_text()
    whole = (ROOT / "fmu-lint/src/lib.rs").read_text()
    for text, name in [
        (whole, "LARGEST_FILE"),
        (package, "MOST_ENTRIES"),
        (package, "LARGEST_ENTRY"),
        (package, "MOST_UNPACKED"),
        (sizes, "JUDGED_RATIO"),
        (sizes, "MOST_RATIO"),
    ]:
        value = re.search(rf"const {name}: \w+ = ([^;]+);", text)[1]
        assert getattr(archive, name) == eval(value), name


@pytest.mark.parametrize(
    ("mode", "words"), [(0o120777, "is a link"), (0o010644, "is no file"), (0o020644, "is no file")]
)
def test_links_pipes_and_devices_are_refused(remade, mode, words):
    entry = zipfile.ZipInfo("resources/link")
    entry.external_attr = mode << 16
    refused(remade(more=[(entry, "/tmp")]), f"resources/link: {words}")


@pytest.mark.parametrize("path", ["/tmp/x", "../x", "resources/../../x", "a\\b", "C:/x"])
def test_paths_that_lead_out_of_the_unit_are_refused(remade, path):
    refused(remade({path: b"x"}), "leads out of the unit")


def test_a_path_that_stands_twice_is_refused(remade):
    with pytest.warns(UserWarning, match="Duplicate"):
        path = remade(more=[("modelDescription.xml", b"<x/>")])
    refused(path, "modelDescription.xml: the path stands twice")


@pytest.mark.parametrize(
    ("field", "value", "words"),
    [
        ("method", 99, "compression method"),
        ("flags", 1, "is encrypted"),
        ("size", 0xFFFFFFF0, "bytes when unpacked"),
        ("size", 5, "CRC-32|has 5 bytes"),
        ("size", 1_000_000, "where the directory says 1000000"),
    ],
)
def test_directories_that_lie_are_refused(unit, tmp_path, field, value, words):
    refused(patched(unit, tmp_path, field, value), words)


def test_damaged_data_is_refused(remade):
    path = remade()
    data = bytearray(path.read_bytes())
    data[80:200] = bytes(120)
    path.write_bytes(data)
    refused(path, "")
    path.write_bytes(b"PK\3\4" + bytes(100))
    refused(path, "not a zip file")


def test_descriptions_that_cannot_be_taken_are_refused(remade, unit):
    text = entries_of(unit)["modelDescription.xml"].decode()
    for number, (changed, words) in enumerate([
        (text.replace("UTF-8", "UTF-16").encode("utf-16"), "codec"),
        (
            text.replace('valueReference="0"', f'valueReference="{2**32}"').encode(),
            "`u`: valueReference is 4294967296 .allowed: 0 to 4294967295",
        ),
        (text.replace('valueReference="0"', 'valueReference="-1"').encode(), "`u`: .* is -1 "),
        (text.replace('start="0.0"', 'start="abc"').encode(), "`u`: start: .*'abc'"),
        (text.replace('start="0.0"', 'start="NaN"').encode(), "`u`: start: NaN is not finite"),
        (text.replace('start="0.0"', 'start="-INF"').encode(), "`u`: start: -INF is not finite"),
        (text.replace('name="z"', 'name="y"').encode(), "two variables have the name `y`"),
        (b"<x/>", ""),
        (b"", ""),
        (b"<a>" * 100_000, ""),
    ]):  # fmt: skip
        path = remade({"modelDescription.xml": changed}, name=f"a{number}.fmu")
        refused(path, f"modelDescription.xml: .*{words}")


def with_second_input(unit, causality="input", kind="Real"):
    """The description with a variable of another name under the reference of `u`."""
    text = entries_of(unit)["modelDescription.xml"].decode()
    second = f'<ScalarVariable name="v" valueReference="0" causality="{causality}">'
    start = {"Real": "1.5", "Integer": "1"}[kind]
    second += f'<{kind} start="{start}"/></ScalarVariable>'
    return text.replace("</ModelVariables>", f"{second}</ModelVariables>").encode()


def test_variables_to_be_set_share_no_reference_but_aliases_do(remade, unit):
    path = remade({"modelDescription.xml": with_second_input(unit)})
    refused(path, "`u` and `v` can both be set, but share the valueReference 0")
    for number, told in enumerate([("local", "Real"), ("input", "Integer")]):
        path = remade(
            {"modelDescription.xml": with_second_input(unit, *told)}, name=f"b{number}.fmu"
        )
        assert "v" in open_package(path).variables


@pytest.mark.parametrize("kept", [-1, 0.5, 40, 20])
def test_libraries_that_are_cut_short_are_not_loaded(remade, unit, kept):
    """What is missing of a library that was mapped ends the process by SIGBUS."""
    whole = entries_of(unit)["binaries/linux64/Linear.so"]
    length = int(kept * len(whole)) if isinstance(kept, float) else kept
    path = remade({"binaries/linux64/Linear.so": whole[:length]})
    refused(path, "its library Linear.so: is cut short: it has .* bytes of at least")


def test_headers_of_either_class_and_order_are_looked_at(tmp_path):
    path = tmp_path / "a.so"
    for kind, order, header, program in [
        (1, ">", "HHIIIIIHHHHHH", "8I"),
        (2, "<", "HHIQQQIHHHHHH", "2I6Q"),
    ]:
        identity = b"\x7fELF" + bytes([kind, 2 if order == ">" else 1]) + bytes(10)
        begin = 16 + struct.calcsize(order + header)
        step = struct.calcsize(order + program)
        head = struct.pack(order + header, 3, 0, 1, 0, begin, 0, 0, begin, step, 1, 0, 0, 0)
        values = [1, 100, 0, 0, 300, 0, 0, 0] if kind == 1 else [1, 0, 100, 0, 0, 300, 0, 0]
        content = identity + head + struct.pack(order + program, *values)
        path.write_bytes(content.ljust(400, b"x"))
        check_library(path)
        path.write_bytes(content.ljust(399, b"x"))
        with pytest.raises(ValueError, match="399 bytes of at least 400"):
            check_library(path)
    path.write_bytes(b"MZ")
    check_library(path)


@pytest.mark.parametrize(
    "more", [[("resources/a", b"x"), ("resources/a/b", b"x")], [("modelDescription.xml", b"<x/>")]]
)
def test_nothing_is_left_of_a_unit_that_was_refused(remade, more):
    path = remade(dict(more)) if len(more) == 1 else remade(more=more)
    before = set(temporary.temporary_folder().path.iterdir())
    for _ in range(2):
        refused(path, "" if len(more) == 2 else "modelDescription.xml: ")
    assert set(temporary.temporary_folder().path.iterdir()) == before


CELLS = {"footprint": "rings", "count": [2], "inputs": ["q"], "outputs": [], "at": [0.0, 0.0]}
CELLS |= {"inner": [0.0, 1.0], "outer": [1.0, 2.0]}


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "Expecting value"),
        (b"[]", "holds no table `families`"),
        (b'{"families": 3}', "holds no table `families`"),
        (b"\xff", "codec|decode"),
        (b"[" * 100_000, "nested too deeply"),
        ({"a": 3}, "family `a`: is no table"),
        ({"a": {**CELLS, "footprint": None}}, "has no `footprint`"),
        ({"a": {**CELLS, "count": [10**12]}}, "`count` is none"),
        ({"a": {**CELLS, "count": [-2]}}, "`count` is none"),
        ({"a": {**CELLS, "count": [2.0]}}, "`count` is none"),
        ({"a": {**CELLS, "count": [3]}}, "`inner` has 2 values for 3 cells"),
        ({"a": {**CELLS, "outer": [1.0, float("nan")]}}, "NaN is not finite"),
        ({"a": {**CELLS, "outer": [1.0, 10**400]}}, "family `a`|too large"),
        ({"a": {**CELLS, "outer": [1.0, "2"]}}, "`outer` holds 2"),
        ({"a": {**CELLS, "outer": "12"}}, "`outer` is no list"),
        ({"a": {**CELLS, "area": [1.0, -1.0]}}, "below 0 m2"),
        ({"a": {**CELLS, "at": [0.0]}}, "`at` is no place"),
        ({"a": {**CELLS, "size": [1.0, 0.0]}}, "`size` is no pair"),
        ({"a": {**CELLS, "inputs": "q"}}, "`inputs` is no list"),
    ],
)
def test_absurd_files_of_cells_are_refused_with_file_and_reason(remade, content, words):
    if isinstance(content, dict):
        content = json.dumps({"families": content}).encode()
    path = remade({"resources/cells.json": content})
    with pytest.raises(UnitError, match=f"a.fmu: resources/cells.json: .*({words})"):
        _ = open_package(path).cell_families
    with pytest.raises(SurfaceError, match=f"a.fmu: resources/cells.json: .*({words})"):
        Surface.of(path, "a")


def test_cells_that_are_right_are_read(remade):
    path = remade({"resources/cells.json": json.dumps({"families": {"a": CELLS}}).encode()})
    assert open_package(path).cell_families["a"]["quantities"] == ["q"]
    assert Surface.of(path, "a").shape == (2,)


def test_pipes_and_folders_are_no_units(tmp_path):
    for name in ("a.fmu", "a.toml"):
        os.mkfifo(tmp_path / name)
        refused(tmp_path / name, "is no regular file")
        with pytest.raises(SurfaceError, match=f"{name}: is no regular file"):
            Surface.of(tmp_path / name, "laser")
    (tmp_path / "folder").mkdir()
    refused(tmp_path / "folder", "holds no modelDescription.xml")
    os.mkfifo(tmp_path / "folder/modelDescription.xml")
    refused(tmp_path / "folder", "holds no modelDescription.xml")
    refused(tmp_path / "b.fmu", "no such file")


# Folders of killed processes

HOLDS = """
import sys, time
from impinge.unit import open_package
print(open_package(sys.argv[1]).folder.parent, flush=True)
time.sleep(60)
"""


def start(unit, place, code=HOLDS):
    process = subprocess.Popen(
        [sys.executable, "-c", code, str(unit)],
        env={**os.environ, "TMPDIR": str(place)},
        stdout=subprocess.PIPE,
        text=True,
    )
    return process, Path(process.stdout.readline().strip())


def test_folders_of_killed_processes_go_and_those_of_others_stay(unit, tmp_path):
    place = tmp_path / "temporary"
    place.mkdir()
    killed, left = start(unit, place)
    living, used = start(unit, place)
    killed.send_signal(signal.SIGKILL)
    killed.wait()
    outside = tmp_path / "outside"
    outside.mkdir()
    (outside / "mine").write_text("mine")
    (left / "link").symlink_to(outside)
    name = "impinge-1-abcdefgh"
    foreign = [place / "impinge-notes", place / "impinge-12-x", place / name]
    for folder in foreign[:2]:
        folder.mkdir()
        (folder / ".lock").touch()
    foreign[2].symlink_to(outside)
    (outside / ".lock").touch()
    without_lock = place / "impinge-2-abcdefgh"
    without_lock.mkdir()
    with_pipe = place / "impinge-3-abcdefgh"
    with_pipe.mkdir()
    os.mkfifo(with_pipe / ".lock")
    try:
        assert left.is_dir() and used.is_dir() and left != used
        temporary.sweep(place)
        assert not left.exists() and used.is_dir()
        assert (outside / "mine").read_text() == "mine"
        assert all(os.path.lexists(folder) for folder in [*foreign, without_lock, with_pipe])
        assert stat.S_IMODE(used.stat().st_mode) == 0o700
    finally:
        living.terminate()
        living.wait()


FORKS = """
import os, sys, time
from impinge.unit import open_package
folder = open_package(sys.argv[1]).folder.parent
if os.fork() == 0:
    print(folder, flush=True)
    time.sleep(60)
    os._exit(0)
time.sleep(60)
"""


def test_a_folder_is_used_as_long_as_a_forked_process_lives(unit, tmp_path):
    parent, used = start(unit, tmp_path, FORKS)
    child = int(
        next(p.parent.name for p in Path("/proc").glob("[0-9]*/stat") if _parent(p) == parent.pid)
    )
    parent.send_signal(signal.SIGKILL)
    parent.wait()
    try:
        temporary.sweep(tmp_path)
        assert used.is_dir()
    finally:
        os.kill(child, signal.SIGKILL)
    limit = time.monotonic() + 20.0
    while used.exists():
        assert time.monotonic() < limit
        temporary.sweep(tmp_path)
        time.sleep(0.05)


SHARED = """
import os, shutil, sys, zipfile
from impinge.unit import open_package
first, second = sys.argv[1], sys.argv[1] + ".other.fmu"
open_package(first)
# The other holds the same and a comment, so that its content is another.
shutil.copy(first, second)
with zipfile.ZipFile(second, "a") as archive:
    archive.comment = b"another"
for _ in range(2):
    if (child := os.fork()) == 0:
        os._exit(0 if open_package(second).name == open_package(first).name else 1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
assert open_package(second).folder.is_dir()
"""


def test_forked_processes_open_the_same_unit(unit, tmp_path):
    """The parent has opened another one, whose folder all of them share."""
    environment = {**os.environ, "TMPDIR": str(tmp_path)}
    copy = shutil.copy(unit, tmp_path / "unit.fmu")
    command = [sys.executable, "-c", SHARED, str(copy)]
    ran = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr


def _parent(path):
    try:
        return int(path.read_text().rpartition(")")[2].split()[1])
    except OSError:
        return 0
