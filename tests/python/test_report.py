"""Pages of results: what they hold, and that a browser draws them."""

import csv
import html
import json
import re
import shutil
import subprocess

import numpy as np
import pytest
import xarray as xr
from conftest import ROOT
from impinge import Function, ImpingeError, Master, Study, Unit, report
from impinge.study import Sobol, over_time

BROWSER = shutil.which("chromium") or shutil.which("chromium-browser")
needs_browser = pytest.mark.skipif(BROWSER is None, reason="no Chromium (apt-get install chromium)")

SCENE = """
name = "Impact"
description = "</script><script>document.title = 'broken'</script> & <b>bold</b>"
stop_time = 4e-6
step = 5e-7
[body.drop]
kind = "droplet"
diameter = 1e-4
impact_velocity = 20.0
initial_temperature = 350.0
spacing = 1e-5
symmetry = "axisymmetric"
fluid = { density = 1000.0, viscosity = 1e-3, specific_heat = 4180.0, conductivity = 0.6, surface_tension = 0.07 }
[body.plate]
kind = "solid"
shape = { disc = { radius = 4e-4, thickness = 1e-4 } }
material = { model = "thermoelastic", density = 3950.0, specific_heat = 900.0, conductivity = 10.0, young = 300e9, poisson = 0.21, expansion = 8.1e-6 }
initial_temperature = 293.15
mesh = { spacing = 2e-5, depth_spacing = 2e-6, growth = 1.6 }
faces.bottom = { temperature = 293.15, roller = true }
[[coupling]]
from = "drop"
to = "plate.top"
[[probe]]
name = "centre"
in = "plate"
at = [0.0, 0.0, 0.0]
gives = ["temperature", "stress"]
"""  # noqa: E501

# Actions of a reader, and the state of the page after each.
READER = """
addEventListener("load", () => setTimeout(() => {
  const told = {}, first = (path) => document.querySelector(path);
  const press = (element, key) => element.dispatchEvent(new KeyboardEvent("keydown", { key }));
  const text = (path) => first(path).textContent;
  told.title = document.title;
  told.sections = [...document.querySelectorAll("main > section")].map((one) => one.id);
  const all = (path, of) => [...of.querySelectorAll(path)];
  told.ends = all("#histories .legend button", document).map((one) => one.textContent);
  told.last = text("#now");
  told.hot = text(".map .readout");
  const scrub = first("#scrub");
  scrub.value = 0;
  scrub.dispatchEvent(new Event("input"));
  told.first = text("#now");
  told.cold = text(".map .readout");
  press(first(".map svg"), "ArrowRight");
  told.point = text(".map .readout");
  const chart = first("#histories svg.chart");
  const paths = () => all("path", chart).map((one) => one.getAttribute("d")).join();
  const whole = paths();
  press(chart, "+");
  told.isZoomed = paths() !== whole;
  press(chart, "0");
  told.isWhole = paths() === whole;
  first("#play").click();
  told.play = text("#play");
  first("#play").click();
  first(".theme").click();
  told.theme = document.documentElement.dataset.theme;
  const canvas = first(".clip canvas"), { width, height } = canvas;
  const bits = canvas.getContext("2d").getImageData(0, 0, width, height).data;
  told.dots = bits.filter((value, i) => i % 4 === 3 && value > 0).length;
  told.wide = document.documentElement.scrollWidth - document.documentElement.clientWidth;
  const shown = { id: "told", textContent: JSON.stringify(told) };
  document.body.append(Object.assign(document.createElement("pre"), shown));
}, 600));
"""


def document_of(page):
    """The data of a page."""
    text = page.read_text(encoding="utf-8")
    return json.loads(re.search(r'id="document">(.*?)</script>', text, re.DOTALL)[1])


def browse(page, tmp_path, script="", size="1200,3000"):
    """The page as a browser shows it; any message on its console is an error."""
    text = page.read_text(encoding="utf-8")
    changed = tmp_path / "browsed.html"
    end = text.rindex("</body>")
    changed.write_text(f"{text[:end]}<script>{script}</script>{text[end:]}", encoding="utf-8")
    command = [
        BROWSER,
        "--headless=new",
        "--no-sandbox",
        "--disable-gpu",
        "--enable-logging=stderr",
    ]
    command += [f"--user-data-dir={tmp_path / 'profile'}", f"--window-size={size}"]
    command += ["--virtual-time-budget=4000", "--dump-dom", changed.as_uri()]
    ran = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert [line for line in ran.stderr.splitlines() if "CONSOLE" in line] == []
    assert 'data-ready="true"' in ran.stdout
    return ran.stdout


@pytest.fixture(scope="module")
def run(programs, tmp_path_factory):
    """A run of a drop on a disc with its page."""
    folder = tmp_path_factory.mktemp("report")
    (folder / "scene.toml").write_text(SCENE)
    command = [programs / "impinge", "report", "scene.toml", "--out", "run", "--fields-every", "1"]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    return folder / "run"


def table(run):
    with (run / "outputs.csv").open(newline="") as file:
        rows = list(csv.reader(file))
    return {title: np.array(column, float) for title, *column in zip(*rows, strict=True)}


def test_a_page_is_small_and_loads_nothing(run):
    text = (run / "report.html").read_text(encoding="utf-8")
    assert len(text) < 1e6
    assert not re.search(r"""(src|href)=["'](?!#|data:,)""", text)
    assert text.count("<script") == 2
    assert "document.title = 'broken'" in document_of(run / "report.html")["description"]


def test_a_page_of_a_run_has_droplet_maps_and_curves(run):
    page = document_of(run / "report.html")
    assert [map["layout"] for map in page["maps"]] == ["round", "section"]
    (clip,) = page["clips"]
    assert clip["is_mirrored"] and len(clip["times"]) == 9
    assert {figure["label"] for figure in page["figures"]} >= {"Highest temperature", "Heat given"}
    titles = {balance["title"]: balance for balance in page["balances"]}
    assert titles["Heat of plate"]["residual"] < 1e-9
    assert titles["Momentum of drop along z"]["residual"] < 1e-5


@needs_browser
def test_a_browser_draws_a_run_and_answers_its_reader(run, tmp_path):
    shown = browse(run / "report.html", tmp_path, READER)
    told = json.loads(html.unescape(re.search(r'<pre id="told">(.*?)</pre>', shown)[1]))
    values = table(run)
    assert told["title"] == "Impact"
    wanted = ["scene", "fields", "histories", "values", "balances", "errors", "model", "timings"]
    assert [each for each in wanted if each not in told["sections"]] == []
    end = values["centre.temperature [K]"][-1]
    (shown_end,) = [text for text in told["ends"] if text.startswith("centre.temperature")]
    assert f"{end:.5g} K ({end - 273.15:.2f} °C)" in shown_end
    # The map is packed to 1/65534 of its range of some kelvins.
    hottest = float(re.search(r"to ([\d.]+) K", told["hot"])[1])
    assert hottest == pytest.approx(values["plate.max_temperature [K]"][-1], abs=0.02)
    assert (told["last"], told["first"]) == ("4 µs", "0 s")
    assert told["cold"].startswith("293.15 K") and "at r = 0" not in told["cold"]
    assert re.match(r"293\.15 K .*at x = ", told["point"])
    assert told["isZoomed"] and told["isWhole"]
    assert "Pause" in told["play"] and told["theme"] == "dark"
    assert told["dots"] > 100
    assert told["wide"] <= 0


@needs_browser
def test_a_page_fits_a_phone(run, tmp_path):
    beyond = "const { scrollWidth, clientWidth } = document.documentElement"
    tell = f"{beyond}; document.title = scrollWidth - clientWidth;"
    script = f"addEventListener('load', () => setTimeout(() => {{ {tell} }}, 600))"
    assert "<title>0</title>" in browse(run / "report.html", tmp_path, script, size="400,900")


@pytest.fixture(scope="module")
def coupled():
    """A heater and a plate that follows it."""
    units = {
        "heater": Function(lambda time: 1e3 * (1.0 + time), {}, {"flow": "W"}),
        "plate": Function(lambda flow: 293.15 + flow / 50.0, {"flow": "W"}, {"temperature": "K"}),
    }
    pairs = [("heater.flow", "plate.flow")]
    with Master(units, pairs, step=0.1, outputs=["plate.temperature"]) as master:
        assert "plate = function" in repr(master)
        return master.run(1.0)


@pytest.fixture(scope="module")
def studied():
    """Rows for Sobol's indices of a heated bed, one output over time."""
    return Study(
        ROOT / "examples/heated_bed/scene.toml",
        {"bed.conductivity": (20.0, 50.0), "heater.heat_flux": (1e3, 5e3)},
        outputs=["thermocouple.temperature", over_time("middle.temperature")],
        sampler=Sobol(4),
        stop=10.0,
        step=5.0,
    ).run(processes=1, progress=False)


def test_results_show_themselves_in_short(coupled, studied):
    text = repr(coupled.impinge)
    assert text.startswith("<impinge results of a coupled run: 11 times to 1 s>")
    assert "plate.temperature [K]" in text and "iterate; order 1" in text
    assert "<details>" in coupled.impinge._repr_html_()
    text = repr(studied.impinge)
    assert text.startswith("<impinge results of a study of HeatedBed: 16 rows>")
    assert "bed.conductivity [W/(m.K)]" in text
    with pytest.raises(ValueError, match="neither of a Master nor of a Study"):
        repr(xr.Dataset({"a": ("x", [1.0])}).impinge)


def test_a_coupled_run_is_reported_with_its_curves(programs, coupled, tmp_path):
    page = coupled.impinge.report(tmp_path / "page.html", title="<i>Heater</i> & plate")
    found = document_of(page)
    assert found["title"] == "<i>Heater</i> & plate"
    assert "<title>&lt;i&gt;Heater&lt;/i&gt; &amp; plate</title>" in page.read_text()
    (curve,) = (s for s in found["histories"]["series"] if s["name"] == "plate.temperature")
    assert curve["values"] == pytest.approx(coupled["plate.temperature"].values.tolist(), rel=1e-6)
    assert curve["group"] == "Temperature"


@needs_browser
def test_a_study_is_reported_with_rows_and_sensitivities(programs, studied, tmp_path):
    path = tmp_path / "study.nc"
    studied.to_netcdf(path, engine="h5netcdf")
    page = report(path, tmp_path / "study.html")
    found = document_of(page)["study"]
    columns = {column["name"]: column["values"] for column in found["columns"]}
    wanted = studied["thermocouple.temperature"].values.tolist()
    assert columns["thermocouple.temperature"] == pytest.approx(wanted, rel=1e-6)
    highest = studied["middle.temperature(t)"].max("time").values.tolist()
    assert columns["max middle.temperature(t)"] == pytest.approx(highest, rel=1e-6)
    (indices,) = found["sensitivities"]
    names = [entry["parameter"] for entry in indices["entries"]]
    assert names == ["bed.conductivity", "heater.heat_flux"]
    shown = browse(page, tmp_path)
    assert shown.count('<tr tabindex="0"') == 16
    assert len(re.findall(r"<title>row \d+: bed.conductivity", shown)) == 16
    assert "Sensitivities of thermocouple.temperature" in shown


def test_files_of_others_are_not_replaced(programs, coupled, tmp_path):
    page = tmp_path / "page.html"
    page.write_text("mine")
    with pytest.raises(ImpingeError, match="page.html exists"):
        report(coupled, page)
    assert page.read_text() == "mine"
    assert report(coupled, page, overwrite=True) == page
    assert report(coupled, page) == page  # a page of its own
    with pytest.raises(ValueError, match="neither of a Master nor of a Study"):
        report(xr.Dataset(), tmp_path / "other.html")


def test_units_and_studies_show_themselves_in_short(programs):
    bed = ROOT / "examples/heated_bed/scene.toml"
    study = Study(bed, {"bed.conductivity": (20.0, 50.0)}, outputs=["bed.heat_in"], stop=1.0)
    assert repr(study).startswith("<impinge.Study of HeatedBed: 5 rows, Grid(levels=5)>")
    assert "bed.conductivity [W/(m.K)]" in repr(study) and "<table>" in study._repr_html_()
    with Unit(bed) as unit:
        text = repr(unit)
        assert re.match(r"<impinge\.Unit HeatedBed-\d+ \(FMI 2\) at 0\.0 s>", text)
        assert "inputs      6: heater.heat_flux [W/m2]" in text
        shown = unit._repr_html_()
        assert "heat flux into the body, heater on bed.bottom" in shown
        assert "<script" not in shown
    assert "closed" in repr(unit)
