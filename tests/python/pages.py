"""Follows a page of the documentation as a reader does: saves scenes, types commands, runs code.

A block of TOML is saved under the name that its paragraph or its first line gives; commands and
Python run in a folder in which `examples/` and `build-fmu` are at hand; a block without a language
below them shows what they print. Commands that set up a machine are checked instead of run.
"""

import contextlib
import io
import os
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

from impinge.unit.build import find_program

ROOT = Path(__file__).parents[2]
BLOCK = re.compile(r"^( *)```(\w*)\n(.*?)^\1```$", re.M | re.S)
INDENTED = re.compile(r"\n\n((?:    \S.*\n)+)")
NAMED = re.compile(r"(Save|Append) [^`]*`([\w./-]+\.toml)`[^`]*\Z")
NUMBER = re.compile(r"[-−+]?\d[\d.]*(?:e[-+]?\d+)?")
TOLERANCE = 0.03  # of numbers that a page shows: flows of particles differ between machines


@dataclass
class Block:
    """A block of a page, with the text before it."""

    kind: str
    text: str
    before: str


def blocks(text: str) -> list[Block]:
    """The fenced and the indented blocks of a page in their order."""
    found, last = [], 0
    for match in BLOCK.finditer(text):
        found += [
            Block("sh", indented, "") for indented in INDENTED.findall(text[last : match.start()])
        ]
        inner = re.sub(f"^{match[1]}", "", match[3], flags=re.M)
        found.append(
            Block(match[2], inner, text[last : match.start()].strip().rsplit("\n\n", 1)[-1])
        )
        last = match.end()
    return found + [Block("sh", indented, "") for indented in INDENTED.findall(text[last:])]


@dataclass
class Reader:
    """Someone in a folder of their own who follows pages there."""

    folder: Path
    names: dict = field(default_factory=dict)
    printed: str = ""  # by the last block that ran
    warnings: str = ""  # of all commands
    refusal: str = ""  # of the last command, which the page has to show

    def __post_init__(self):
        for name in ("examples", "python"):
            (self.folder / name).symlink_to(ROOT / name)
        (self.folder / "out").mkdir()

    def follow(self, page: str):
        for block in blocks((ROOT / page).read_text()):
            do = {"toml": self.save, "python": self.execute, "sh": self.type, "": self.compare}
            assert block.kind in do, f"a block of {block.kind} is neither run nor checked"
            assert not self.refusal or not block.kind, self.refusal
            do[block.kind](block)
        assert not self.refusal, self.refusal

    def save(self, block: Block):
        tomllib.loads(block.text)
        if named := NAMED.search(block.before):
            with open(self.folder / named[2], {"Save": "w", "Append": "a"}[named[1]]) as file:
                file.write(block.text)
            tomllib.loads((self.folder / named[2]).read_text())
        elif title := re.match(r"# ([\w-]+\.toml)\n", block.text):
            (self.folder / title[1]).write_text(block.text)

    def execute(self, block: Block):
        printed = io.StringIO()
        with contextlib.chdir(self.folder), contextlib.redirect_stdout(printed):
            exec(compile(block.text, "block", "exec"), self.names)
        self.printed = printed.getvalue()

    def type(self, block: Block):
        self.printed = ""
        for line in block.text.replace("\\\n", " ").splitlines():
            if words := shlex.split(line, comments=True):
                self.run(words)

    def run(self, words: list[str]):
        program = Path(words[0]).name
        if program in CHECKED:
            CHECKED[program](words)
            return
        assert program in FOUND, f"`{program}` is neither run nor checked"
        ran = subprocess.run(
            [FOUND[program](program), *words[1:]],
            cwd=self.folder,
            env=os.environ | {"MPLBACKEND": "Agg"},
            capture_output=True,
            text=True,
            check=False,
        )
        self.printed += ran.stdout + ran.stderr
        if ran.returncode == 0:
            self.warnings += "".join(re.findall(r".*warning: .*\n", ran.stderr))
        else:
            self.refusal = f"{shlex.join(words)}: {ran.stderr}"

    def compare(self, block: Block):
        """The lines that a page shows are printed in their order; `…` stands for others."""
        if block.text.startswith("error: "):
            self.refusal = ""
        printed = iter(self.printed.splitlines())
        for line in filter(str.strip, block.text.splitlines()):
            if line.strip() != "…":
                assert any(alike(line, other) for other in printed), f"not printed: {line}"


def alike(shown: str, printed: str) -> bool:
    """True if two lines have the same words and, but for `TOLERANCE`, the same numbers."""
    if re.sub(NUMBER, "#", shown).split() != re.sub(NUMBER, "#", printed).split():
        return False
    return all(map(close, NUMBER.findall(shown), NUMBER.findall(printed)))


def close(shown: str, printed: str) -> bool:
    """True if numbers agree to `TOLERANCE` or to two units of the last digit that is shown."""
    first, second = (float(text.replace("−", "-")) for text in (shown, printed))
    decimals = len(shown.partition("e")[0].partition(".")[2])
    digit = 0.0 if "e" in shown else 2 * 10.0**-decimals
    return abs(first - second) <= max(TOLERANCE * max(abs(first), abs(second)), digit)


def is_target(words: list[str]):
    targets = [word for word in words[1:] if "=" not in word]
    subprocess.run(["make", "--dry-run", *targets], cwd=ROOT, check=True, capture_output=True)


def is_crate(words: list[str]):
    """The package of `cargo install --path` has a program, that of `cargo build` is this one."""
    folder = ROOT / (words[words.index("--path") + 1] if "--path" in words else ".")
    manifest = tomllib.loads((folder / "Cargo.toml").read_text())
    assert "install" not in words or (folder / "src/main.rs").is_file() or "bin" in manifest


def is_package(words: list[str]):
    """Checks that pip installs a folder with a package, or a wheel of this project."""
    wanted = words[words.index("install") + 1 :]
    for word in wanted:
        if word.startswith("."):
            project = tomllib.loads((ROOT / word.split("[")[0] / "pyproject.toml").read_text())
            extras = re.search(r"\[(.*)\]", word)
            known = project["project"]["optional-dependencies"]
            assert extras is None or set(extras[1].split(",")) <= set(known)
        else:
            assert re.fullmatch(r"(dist/)?impinge-[\w….-]*\.whl|matplotlib|pandas", word), word


def beside_python(program: str) -> Path:
    return Path(sys.executable).parent / program


FOUND = {
    "impinge": find_program,
    "build-fmu": find_program,
    "impinge-adapt": beside_python,
    "impinge-linear-map": beside_python,
    "python": lambda _: sys.executable,
    "mkdir": shutil.which,
}
CHECKED = {"make": is_target, "cargo": is_crate, "pip": is_package}
