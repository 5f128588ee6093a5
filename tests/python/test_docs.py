"""What the documentation tells to type does what it says."""

import logging
import re
import shlex
import subprocess
import sys
import tomllib
from pathlib import Path

import meshio
import numpy as np
import pytest
import yaml
from impinge import Surface, Unit, linear_map
from impinge.adapt import read_inputs
from impinge.adapt.cli import main
from impinge.linear import plan
from impinge.unit.build import find_program
from pages import Reader

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"


# Pages whose every block and command runs, or is checked, from top to bottom.
PAGES = [
    "README.md",
    "docs/tutorial.md",
    "docs/how_to.md",
    "docs/formulas.md",
    "docs/models.md",
    "docs/tools.md",
    "docs/variables.md",
    "docs/files.md",
    "docs/messages.md",
    "docs/glossary.md",
    "docs/index.md",
]
WARNS = {"docs/messages.md"}  # on purpose


@pytest.mark.parametrize("page", PAGES)
def test_every_block_of_the_page_does_what_it_says(page, tmp_path, monkeypatch, caplog, recwarn):
    monkeypatch.setenv("MPLBACKEND", "Agg")
    reader = Reader(tmp_path)
    reader.follow(page)
    told = [record.message for record in caplog.records if record.levelno >= logging.WARNING]
    told += [str(warning.message) for warning in recwarn]
    assert page in WARNS or (reader.warnings, told) == ("", [])


def test_the_readme_is_short_and_ends_in_a_picture(tmp_path, monkeypatch):
    text = (ROOT / "README.md").read_text()
    assert len(text.splitlines()) <= 90
    (picture,) = re.findall(r"!\[[^\]]+\]\(([^)]+)\)", text)
    assert (ROOT / picture).stat().st_size <= 300_000
    assert "make demo" in text and "make test" in text


def test_the_manual_builds_without_a_dead_link_and_needs_no_network(tmp_path):
    """Strict, as `make docs`; no page loads a script, a style, a font or a picture from the net."""
    command = ["-m", "sphinx", "--fail-on-warning", "--keep-going", "--quiet", "-b", "html"]
    command += ["-c", ROOT / "docs", ROOT, tmp_path]
    built = subprocess.run([sys.executable, *command], capture_output=True, text=True, check=False)
    assert built.returncode == 0, built.stderr
    pages = list(tmp_path.rglob("*.html"))
    assert len(pages) > 40 and (tmp_path / "searchindex.js").is_file()
    for page in pages:
        loaded = re.findall(
            r"<(?:script|img|link|iframe)\b[^>]*\b(?:src|href)=\"(\S+?)\"", page.read_text()
        )
        assert not [name for name in loaded if "//" in name], page
    styles = "".join(style.read_text() for style in tmp_path.rglob("*.css"))
    assert not re.findall(r"url\(\s*[\"']?https?:", styles)
    formulas = (tmp_path / "docs/formulas.html").read_text()
    assert formulas.count('class="math"') > 10 and "$" not in re.sub(
        r"<[^>]+>", "", formulas.split("<article")[1].split("</article")[0]
    )


def test_the_citation_names_this_version():
    """The keys that version 1.2.0 of the format requires, and this release."""
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    package = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]
    assert citation["cff-version"] == "1.2.0"
    assert citation["message"] and citation["title"] and citation["authors"][0]["name"]
    assert citation["version"] == package["version"]
    assert " OR ".join(citation["license"]) == package["license"]


def test_the_coupled_snippet_of_the_package_gives_no_warning(monkeypatch, caplog, recwarn, capsys):
    """The drop heats the rings below it; none is hotter than the drop or colder than the plate."""
    monkeypatch.chdir(ROOT)
    blocks = re.findall(
        r"^```python\n(.*?)^```$", (ROOT / "python/README.md").read_text(), re.M | re.S
    )
    (snippet,) = [block for block in blocks if "examples/solder_drop" in block]
    names = {}
    exec(snippet, names)
    assert [record.message for record in caplog.records if record.levelno >= logging.WARNING] == []
    assert [str(warning.message) for warning in recwarn] == []
    rings = names["result"]["plate.face.temperature"].values
    assert 520 < rings[-1, 0] < 573.15 and rings.min() > 513.15 - 1e-6
    assert "K" in capsys.readouterr().out


def test_examples_of_the_adapter_run_and_keep_their_heat(tmp_path, monkeypatch, capsys):
    """All blocks of docs/adapt.md, in their order; integrals by the closed forms of their files."""
    monkeypatch.chdir(tmp_path)
    names = {}
    blocks = re.findall(r"^```(\w+)\n(.*?)^```$", (DOCS / "adapt.md").read_text(), re.M | re.S)
    assert [kind for kind, _ in blocks].count("sh") == 5
    for kind, text in blocks:
        if kind == "toml":
            Path("block.toml").write_text(text)
        elif kind == "python":
            exec(text, names)
        for line in text.splitlines() if kind == "sh" else ():
            program, *words = shlex.split(line)
            if program == "impinge-adapt":
                assert main(words) == 0, capsys.readouterr().err
            else:
                subprocess.run([find_program(program), *words], check=True, capture_output=True)
    target = Surface.of("block.toml", "laser")

    def power(path):
        times, columns = read_inputs(path)
        assert all(name.startswith("laser.heat_flux[") for name in columns)
        return times, target.integral(np.array(list(columns.values())).T.reshape(-1, 4, 5))

    assert power("laser.csv")[1] == pytest.approx([0.0, 2.0, 0.0], abs=1e-12)
    times, watts = power("spray.csv")
    assert np.trapezoid(watts, times) == pytest.approx(50 * 1e-12 * 2.6e6, rel=1e-12)
    assert power("cfd.csv")[1] == pytest.approx(1e7 * 2e-4 * 1e-4, rel=1e-12)
    _, releases = read_inputs("releases.csv")
    assert releases["drop.release"][-1] == 50
    assert len(list(Path().glob("part_*.vtu"))) == 5


def test_the_command_speaks_of_its_own_options(tmp_path, capsys):
    scene = re.search(r"```toml\n(.*?)```", (DOCS / "adapt.md").read_text(), re.S)[1]
    (tmp_path / "block.toml").write_text(scene)
    table = tmp_path / "points.csv"
    table.write_text("x,y,q\n-3e-5,-2e-5,1\n3e-5,-2e-5,2\n3e-5,2e-5,3\n-3e-5,2e-5,4\n")
    command = ["cfd", str(table), "--data", "q", "--onto", f"{tmp_path}/block.toml:laser"]
    command += ["-o", str(tmp_path / "t.csv")]
    assert main(command) == 2
    told = capsys.readouterr().err
    assert "--kind consistent" in told and '="' not in told
    small = 3e-5 * np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    mesh = meshio.Mesh(small, [("quad", [[0, 1, 2, 3]])], point_data={"q": [1.0, 2.0, 3.0, 4.0]})
    mesh.write(tmp_path / "small.vtu")
    command[1] = str(tmp_path / "small.vtu")
    assert main([*command, "--kind", "consistent"]) == 2
    told = capsys.readouterr().err
    assert "--outside nearest" in told and '="' not in told
    assert main([*command, "--kind", "consistent", "--outside", "drop"]) == 2
    assert "would get no value" in capsys.readouterr().err
    assert main([*command, "--kind", "consistent", "--outside", "nearest"]) == 0
    with pytest.raises(SystemExit):
        main(["--help"])
    told = capsys.readouterr().out
    assert "``" not in told and "Files of other tools" in told


def test_the_plan_of_two_outputs_that_studies_tell_keeps_its_limits(monkeypatch, capsys):
    """The rim stays below 340 K, and what is printed is short."""
    monkeypatch.chdir(DOCS.parent)
    text = (DOCS / "studies.md").read_text()
    (example,) = [b for b in re.findall(r"```python\n(.*?)```", text, re.S) if "highest" in b]
    names = {"np": np, "Unit": Unit, "linear_map": linear_map, "plan": plan}
    exec(example, names)
    assert len(capsys.readouterr().out.splitlines()) == 2
    found, course = names["found"], names["course"]
    made = plan(
        found, course, weights=[1.0, 0.0], highest=[np.inf, 340.0], upper=1e4, lower=0.0,
        changes=1e-7,
    )  # fmt: skip
    assert made.outputs[1:, 1].max() <= 340.0 + 1e-6
    assert abs(made.outputs[-1, 0] - 333.15) < 1.0


def test_functions_of_the_readme_cool_control_and_lag(tmp_path, monkeypatch, recwarn, capsys):
    """The heat that the law takes is what the plate loses, the bed comes to 60 °C and stays near,
    and the reading obeys τ T' = u − T."""
    text = (ROOT / "python/README.md").read_text()
    section = re.search(r"^## `Function`\n(.*?)^## ", text, re.M | re.S)[1]
    (scene,) = re.findall(r"^```toml\n(.*?)^```$", section, re.M | re.S)
    (tmp_path / "plate.toml").write_text(scene)
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    names = {}
    blocks = re.findall(r"^```python\n(.*?)^```$", section, re.M | re.S)
    assert len(blocks) == 3
    for block in blocks:
        exec(block, names)
    assert [str(warning.message) for warning in recwarn] == []
    assert len(capsys.readouterr().out.splitlines()) == 3
    cooled, heated, late = names["cooled"], names["heated"], names["late"]
    rings = cooled["plate.face.temperature"].values
    stored = 2700.0 * 900.0 * np.pi * 50e-3**2 * 8e-3 * (rings[-1].mean() - 500.0)
    assert cooled["energy_passed.air.heat_flux"].values[-1] == pytest.approx(stored, rel=1e-3)
    assert 350.0 < rings[-1].min() and (np.diff(rings, axis=0) < 0.0).all()
    temperatures = [each["bed.thermocouple.temperature"].values for each in (heated, late)]
    assert [each[-1] for each in temperatures] == pytest.approx([333.15, 333.15], abs=0.01)
    assert 333.2 < min(each.max() for each in temperatures)
    assert max(each.max() for each in temperatures) < 334.0
    reading = late["thermocouple.reading"].values
    ahead = 8.0 * np.gradient(reading, late.time.values)
    assert np.abs(reading + ahead - temperatures[1])[1:-1].max() < 0.1


def test_the_first_scene_passes_its_checks_without_a_warning(tmp_path):
    (scene,) = re.findall(r"```toml\n(.*?)```", (ROOT / "README.md").read_text(), re.S)
    (tmp_path / "scene.toml").write_text(scene)
    command = [find_program("impinge"), "check", tmp_path / "scene.toml"]
    check = subprocess.run(command, check=True, capture_output=True, text=True)
    assert check.stderr == "" and re.search(r"warnings +none", check.stdout)


def test_the_sweep_prints_the_table_that_the_page_shows(tmp_path, monkeypatch, capsys):
    text = (DOCS / "studies.md").read_text()
    snippet, table = re.search(r"```python\n([^`]*Grid.*?)```\n```\n(.*?)```", text, re.S).groups()
    snippet = snippet.replace('"examples/', f'"{ROOT}/examples/')
    (tmp_path / "out").mkdir()
    monkeypatch.chdir(tmp_path)
    exec(snippet, {})
    assert capsys.readouterr().out.split() == table.split()
    assert len((tmp_path / "out/bed_sweep.csv").read_text().splitlines()) == 13
