"""Journals and tables of studies that were damaged, forged, or are none of a study's."""

import functools
import hashlib
import json
import math
import os
import shutil
import subprocess
import sys
import threading
import warnings

import numpy as np
import pytest
from impinge import Study, UnitError
from impinge.errors import StudyError
from impinge.study import over_time
from impinge.study.functions import hash_of_function
from impinge.study.journal import Finished, Journal, read
from linear_unit import make

LEVELS = [1.0, 2.0, 4.0]


@pytest.fixture(scope="module")
def unit(tmp_path_factory):
    """x' = u − 2 x, y = x."""
    return make(tmp_path_factory.mktemp("decay"), "Decay", [[-2.0]], [1.0], [1.0], x=[3.0])


def study_of(unit, outputs=("y",), levels=LEVELS):
    return Study(unit, {"u": levels}, outputs=outputs, stop=1.0, step=0.5)


@pytest.fixture(scope="module")
def finished(unit, tmp_path_factory):
    """A folder in which the study has run, and its table."""
    folder = tmp_path_factory.mktemp("finished") / "f"
    return folder, study_of(unit).run(1, folder=folder)


@pytest.fixture
def folder(finished, tmp_path):
    """A copy of that folder, to damage, and the table."""
    original, table = finished
    return shutil.copytree(original, tmp_path / "f"), table


def lines(folder):
    return (folder / "rows.jsonl").read_bytes().split(b"\n")[:-1]


def write(folder, content):
    (folder / "rows.jsonl").write_bytes(b"".join(line + b"\n" for line in content))


def sealed(content):
    """A line with the checksum that belongs to it, whatever it holds."""
    digest = hashlib.sha256(content).hexdigest()[:32].encode()
    return content + b', "sha256": "' + digest + b'"}'


def expect_one_row_again(unit, folder, table):
    """The second row is not taken but runs again, with a warning, and the table is the same."""
    with pytest.warns(UserWarning, match="runs? again"):
        again = study_of(unit).run(1, folder=folder)
    np.testing.assert_array_equal(again["y"].values, table["y"].values)
    assert (again.status == 0).all()
    assert len(lines(folder)) == len(LEVELS) + 1
    with warnings.catch_warnings():  # the row that ran again counts
        warnings.simplefilter("ignore")
        assert len(read(folder / "rows.jsonl")) == len(LEVELS)


CHANGES = {
    "a digit": lambda line: line.replace(b'"values": [', b'"values": [1'),
    "another value": lambda line: line[: line.index(b"[")] + b"[1e9" + line[line.index(b"]") :],
    "a second value": lambda line: line.replace(b"]", b", 2.0]"),
    "NaN": lambda line: line[: line.index(b"[")] + b"[NaN" + line[line.index(b"]") :],
    "no value": lambda line: line[: line.index(b"[")] + b"[" + line[line.index(b"]") :],
    "400 digits": lambda line: line[: line.index(b"[")] + b"[" + b"9" * 400 + b"]}",
    "deep nesting": lambda line: b"[" * 100_000,
    "no checksum": lambda line: line[: line.index(b', "sha256"')] + b"}",
    "a failure": lambda line: line.replace(b'"values": ', b'"failed": "no", "values": '),
    "other bytes": lambda line: bytes(reversed(line)),
    "a blank": lambda line: line + b" ",
    "nothing": lambda line: b"",
}


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_a_row_that_was_changed_runs_again(unit, folder, change):
    folder, table = folder
    content = lines(folder)
    content[1] = change(content[1])
    write(folder, content)
    expect_one_row_again(unit, folder, table)


FORGED = {
    "no value": b'"values": []',
    "two values": b'"values": [1.0, 2.0]',
    "values in values": b'"values": [[1.0]]',
    "400 digits": b'"values": [' + b"9" * 400 + b"]",
    "5000 digits": b'"values": [' + b"9" * 5000 + b"]",
    "deep nesting": b'"values": ' + b"[" * 100_000 + b"]" * 100_000,
    "no array": b'"values": [{"shape": [-1], "data": "AAAAAAAA8D8="}]',
    "a shape that lies": b'"values": [{"shape": [7], "data": "AAAAAAAA8D8="}]',
    "a word": b'"values": "1.0"',
    "nothing": b'"value": [1.0]',
}


@pytest.mark.parametrize("forged", FORGED.values(), ids=FORGED)
def test_a_row_that_no_study_writes_runs_again_though_its_checksum_is_right(unit, folder, forged):
    folder, table = folder
    content = lines(folder)
    key = json.loads(content[1])["key"].encode()
    content[1] = sealed(b'{"key": "' + key + b'", "seconds": 0.1, ' + forged)
    write(folder, content)
    expect_one_row_again(unit, folder, table)


def test_a_row_belongs_to_its_key(unit, folder, tmp_path):
    """The values of a row under the key of another, of the same study and of another one."""
    folder, table = folder
    other = study_of(unit, levels=[7.0])
    other.run(1, folder=tmp_path / "other")
    content = lines(folder)
    keys = [json.loads(line)["key"].encode() for line in content]
    for line in (content[0], lines(tmp_path / "other")[0]):
        key = json.loads(line)["key"].encode()
        write(folder, [content[0], line.replace(key, keys[1]), content[2]])
        expect_one_row_again(unit, folder, table)


def test_rows_of_another_file_are_taken_only_as_what_they_are(unit, folder, tmp_path):
    """A row says what it was computed from: in the journal of another study it counts for nothing,
    in that of the same study it is the same row."""
    folder, table = folder
    half = tmp_path / "half"
    study_of(unit, levels=LEVELS[:1]).run(1, folder=half)
    study_of(unit, outputs=[over_time("y")]).run(1, folder=tmp_path / "other")
    write(half, [*lines(half), *lines(folder)[1:2], *lines(tmp_path / "other")])
    before = len(lines(half))
    again = study_of(unit).run(1, folder=half)
    np.testing.assert_array_equal(again["y"].values, table["y"].values)
    assert len(lines(half)) == before + 1


def test_journals_without_checksums_warn_once_and_run_again(unit, folder):
    folder, table = folder
    write(folder, [line[: line.index(b', "sha256"')] + b"}" for line in lines(folder)])
    with pytest.warns(UserWarning) as heard:
        again = study_of(unit).run(1, folder=folder)
    told = [str(one.message) for one in heard if "rows.jsonl" in str(one.message)]
    assert len(told) == 1 and "3 lines have no checksum" in told[0]
    np.testing.assert_array_equal(again["y"].values, table["y"].values)
    assert len(lines(folder)) == 6


def test_values_that_are_not_finite_are_kept_where_a_row_has_them(tmp_path):
    values = [np.array(np.nan), np.array(-np.inf), np.array([np.nan, 1.0])]
    with Journal(tmp_path) as journal:
        journal.append([("a", Finished(values))])
    for kept, given in zip(read(tmp_path / "rows.jsonl")["a"].values, values, strict=True):
        np.testing.assert_array_equal(kept, given)


@pytest.mark.parametrize("cut", [1, 5, 12, 40, 90])
@pytest.mark.parametrize("zeros", [0, 300])
def test_a_line_that_was_cut_off_is_written_again(unit, folder, cut, zeros):
    folder, table = folder
    for content in (lines(folder), lines(folder)[:1]):  # of later lines, and of the first
        write(folder, content[:-1])
        with open(folder / "rows.jsonl", "ab") as journal:
            journal.write(content[-1][:cut] + bytes(zeros))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            again = study_of(unit).run(1, folder=folder)
        np.testing.assert_array_equal(again["y"].values, table["y"].values)


def test_a_file_that_is_no_journal_is_left_alone(unit, tmp_path):
    for content in (b"mine", b"mine\n", b'{"mine": 1}\n', b"\n\n", bytes(9) + b"mine"):
        (tmp_path / "rows.jsonl").write_bytes(content)
        with pytest.raises(StudyError, match=r"rows.jsonl: is not the journal of a study"):
            study_of(unit).run(1, folder=tmp_path)
        assert (tmp_path / "rows.jsonl").read_bytes() == content
    (tmp_path / "rows.jsonl").unlink()
    os.mkfifo(tmp_path / "rows.jsonl")
    with pytest.raises(StudyError, match="is no file"):
        study_of(unit).run(1, folder=tmp_path)


def test_a_table_that_is_none_of_a_study_is_replaced_only_if_asked(unit, tmp_path):
    study, table = study_of(unit), tmp_path / "study.nc"
    elsewhere = tmp_path / "elsewhere"
    for make_foreign in (
        lambda: table.write_text("mine"),
        lambda: table.mkdir(),
        lambda: os.mkfifo(table),
        lambda: table.symlink_to(elsewhere),
    ):
        make_foreign()
        with pytest.raises(StudyError, match=r"study.nc: is not the table of a study .*overwrite"):
            study.run(1, folder=tmp_path)
        assert not (tmp_path / "rows.jsonl").exists()  # nothing has run
        shutil.rmtree(table) if table.is_dir() else table.unlink()
    table.write_text("mine")
    study.run(1, folder=tmp_path, overwrite=True)
    assert table.read_bytes()[:4] == b"\x89HDF"
    study.run(1, folder=tmp_path)  # its own
    (tmp_path / "study.nc.part").symlink_to(elsewhere)
    study.run(1, folder=tmp_path)
    assert not elsewhere.exists() and not (tmp_path / "study.nc.part").is_symlink()


def test_a_study_of_what_is_no_unit_ends_in_the_package_s_error(tmp_path):
    os.mkfifo(tmp_path / "a.toml")
    with pytest.raises(UnitError, match="a.toml: is no regular file"):
        Study(tmp_path / "a.toml", {"u": [1.0]}, outputs=["y"])


# What a function holds

FUNCTIONS = """
import enum, functools, sys
from dataclasses import dataclass
import numpy as np
from scipy.interpolate import Akima1DInterpolator, CubicSpline, PchipInterpolator
from scipy.stats import norm
from impinge.study.functions import hash_of_function
import settings
from settings import Plant, Settings

VALUE = float(sys.argv[1])
LIST, DICT, SET = [VALUE], {"a": VALUE}, {VALUE, 7.0, "a", "b"}
X = np.linspace(0.0, 1.0, 5)
SPLINE = CubicSpline(X, VALUE * X**2)

def power(t, a=1.0):
    return a * t

@dataclass(slots=True)
class Slotted:
    a: float
    def __call__(self, t):
        return self.a * t

class Kind(enum.Enum):
    ONE = 1
    TWO = VALUE

class Base:
    gain = VALUE

class Inherited(Base):
    def __init__(self):
        self.names = {"q", "r", "s", Kind.ONE}
    def __call__(self, t):
        return self.gain * t

class Edited:
    def __call__(self, t):
        return POWER

class Composed:
    scaled = functools.partial(power, a=VALUE)
    def __call__(self, t):
        return self.scaled(t)

class Cached:
    @functools.lru_cache
    def __call__(self, t):
        return POWER

class Derived:
    @property
    def gain(self):
        return POWER
    def __call__(self, t):
        return self.gain * t

settings.POWER = Settings.POWER = Plant.POWER = VALUE

def local():
    class Held:
        gain = VALUE
    return lambda t: Held.gain * t

calls = {
    "module": lambda t: settings.POWER * t,
    "class": lambda t: Settings.POWER * t,
    "class_of_a_module": lambda t: settings.Plant.Part.gain * t,
    "base_of_a_class": lambda t: Plant.gain * t,
    "class_given": lambda t, of=Plant: of.gain * t,
    "class_method": Settings.law,
    "member": lambda t: Kind.TWO.value * t,
    "class_held": local(),
    "partial": functools.partial(power, a=VALUE),
    "cubic": CubicSpline(X, VALUE * X),
    "pchip": PchipInterpolator(X, VALUE * X),
    "akima": Akima1DInterpolator(X, VALUE * X),
    "normal": norm(0.0, VALUE).pdf,
    "slots": Slotted(VALUE),
    "inherited": Inherited(),
    "edited": Edited(),
    "composed": Composed(),
    "cached": Cached(),
    "derived": Derived(),
    "list": lambda t: LIST[0],
    "dict": lambda t: DICT["a"],
    "set": lambda t: max(SET),
    "spline": lambda t: SPLINE(t),
    "generator": lambda t: sum(VALUE for _ in range(3)),
    "method": DICT.get,
}
for name, call in calls.items():
    print(name, hash_of_function(call))
"""


SETTINGS = """
import sys
import threading

LOCK = threading.Lock()  # whose state nothing tells, and which no function uses

class Settings:
    gain = float(sys.argv[1])
    @classmethod
    def law(cls, t):
        return cls.gain * t
    @property
    def other(self):
        return sys.argv[1]

class Plant(Settings):
    class Part(Settings):
        pass
"""


def hashes(folder, value, seed):
    """Hashes of all functions, in a process with its own order of sets."""
    script = folder / "functions.py"
    (folder / "settings.py").write_text(SETTINGS)
    script.write_text(FUNCTIONS.replace("return POWER", f"return {value}"))
    environment = {**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, script, value]
    ran = subprocess.run(command, env=environment, check=True, capture_output=True, text=True)
    return dict(line.split() for line in ran.stdout.splitlines())


def test_rows_belong_to_what_a_callable_holds_in_any_process(tmp_path):
    one, again, other = (hashes(tmp_path, *a) for a in (("1.5", "1"), ("1.5", "2"), ("2.5", "1")))
    assert again == one
    assert not [name for name in one if one[name] == other[name]]


def test_functions_keep_the_hashes_that_journals_have():
    def ramp(t, p, gain=2.0, *, shift=3):
        return gain * t + shift + p["a"] if t in {1, 2} else 0.0

    assert hash_of_function(math.sin) == hashlib.sha256(b"3 sin").hexdigest()
    assert hash_of_function(ramp) == hash_of_parts(ramp.__code__, [], (2.0,), {"shift": 3})


def hash_of_parts(code, held, defaults, named):
    """The hash of a function that holds numbers, written out."""

    def words(*things):
        return b"".join(f"{len(text)} {text}".encode() for text in things)

    def whole(value):
        if isinstance(value, frozenset):
            return whole(sorted(map(repr, value)))
        if isinstance(value, list | tuple):
            return words(f"{type(value).__name__} {len(value)}") + b"".join(map(whole, value))
        return words(repr(value))

    names = (code.co_names, code.co_varnames, code.co_freevars)
    said = [f"{len(code.co_code)} ".encode() + code.co_code, words(repr(names))]
    said += [whole(constant) for constant in code.co_consts] + [whole(held), whole(defaults)]
    said += [words(repr(key), repr(value)) for key, value in sorted(named.items())]
    return hashlib.sha256(b"".join(said)).hexdigest()


def test_rows_of_a_callable_that_tells_nothing_run_again():
    lock = threading.Lock()

    def locked(t):
        with lock:
            return t

    assert hash_of_function(locked) != hash_of_function(locked)


def test_rows_of_another_partial_are_not_taken(unit, tmp_path):
    def tables(gain):
        given = {"u": functools.partial(lambda t, gain: gain * t, gain=gain)}
        study = Study(unit, {}, inputs=given, outputs=["y"], stop=1.0, step=0.5)
        return study.run(1, folder=tmp_path)["y"].item()

    assert tables(1.0) != tables(2.0)
