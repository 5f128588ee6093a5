"""Files of other tools in and out: no joule is lost on the way through a unit."""

import csv
import subprocess
from dataclasses import replace

import h5py
import meshio
import numpy as np
import pytest
from impinge.adapt import (
    Body,
    cfd_frames,
    drop_inputs,
    laser_frames,
    onto_mesh,
    read_inputs,
    spray_frames,
    write_frames,
    write_inputs,
)
from impinge.adapt.cli import main
from impinge.adapt.laser import read_picture
from impinge.surface import Placement, Series, Surface, SurfaceError
from impinge.unit.build import find_program
from PIL import Image
from scipy.spatial import Delaunay

SCENE = """
name = "Block"
stop_time = 4e-5
step = 1e-5

[body.block]
kind = "solid"
shape = { box = [4e-4, 4e-4, 1e-4] }
material = { model = "thermoelastic", density = 3950.0, specific_heat = 900.0, \
conductivity = 10.0, young = 300e9, poisson = 0.21, expansion = 8.1e-6 }
initial_temperature = 293.15
mesh = { spacing = 4e-5, order = 1 }

[body.block.faces]
bottom = { clamped = true }

[[load]]
name = "laser"
on = "block.top"
footprint = { tiles = { count = [4, 5], size = [2e-4, 1e-4] } }
carries = ["heat_flux"]

[[probe]]
name = "centre"
in = "block"
at = [0.0, 0.0, 0.0]
gives = ["temperature", "stress", "displacement"]
"""
TILES = Surface.tiles((4, 5), (2e-4, 1e-4))


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    return path


def run(scene, *options):
    """All columns of a run of `impinge run`, by name."""
    out = scene.parent / "out"
    command = [find_program("impinge"), "run", scene, "--out", out, "--overwrite", *options]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    with open(out / "outputs.csv") as file:
        rows = list(csv.reader(file))
    names = [name.rpartition(" [")[0] for name in rows[0]]
    return dict(zip(names, np.array(rows[1:], float).T, strict=True)), out


# Laser


def test_a_pulse_of_a_picture_brings_its_energy_into_the_unit(scene, tmp_path, capsys):
    """A beam that the tiles cut on all sides, shaped in time: the unit takes ∫ P dt."""
    rng = np.random.default_rng(0)
    Image.fromarray(rng.integers(0, 255, (13, 17), dtype="uint8")).save(tmp_path / "beam.png")
    (tmp_path / "pulse.csv").write_text("time [s],power [W]\n0,0\n1.3e-5,2\n2.5e-5,1\n4e-5,0\n")
    energy = 0.5 * (1.3e-5 * 2 + 1.2e-5 * 3 + 1.5e-5 * 1)
    table = tmp_path / "table.csv"
    command = ["laser", tmp_path / "beam.png", "--size", 0.9e-4, 0.7e-4, "--at", 1e-5, 5e-6]
    command += ["--angle", 0.1, "--pulse", tmp_path / "pulse.csv"]
    command += ["--onto", f"{scene}:laser", "-o", table]
    assert main([str(word) for word in command]) == 0
    assert "4 times, 20 cells, integral 0 to 2 W" in capsys.readouterr().out
    columns, _ = run(scene, "--inputs", table)
    assert columns["block.heat_in"][-1] == pytest.approx(energy, rel=1e-12)


def test_pictures_stand_upright(tmp_path):
    """Rows from the top down, columns along x: only the upper left corner is lit."""
    picture = np.zeros((10, 8))
    picture[:2, :2] = 1.0
    target = Surface.tiles((4, 5), (2e-4, 1e-4))
    path = tmp_path / "map.npy"
    np.save(path, picture)
    lit = laser_frames([path], target, (2e-4, 1e-4), power=3.0).values[0]
    expected = np.zeros((4, 5))
    expected[0, 4] = 3.0 / (5e-5 * 2e-5)
    assert lit == pytest.approx(expected, rel=1e-12)
    upward = laser_frames([path], target, (2e-4, 1e-4), power=3.0, upward=True).values[0]
    assert upward == pytest.approx(expected[:, ::-1], rel=1e-12)
    # Turned by a quarter, upper left comes to lower left
    turned = laser_frames(
        [path], Surface.tiles((5, 4), (1e-4, 2e-4)), (2e-4, 1e-4), power=3.0, angle=np.pi / 2
    )
    quarter = np.zeros((5, 4))
    quarter[0, 0] = expected[0, 4]
    assert turned.values[0] == pytest.approx(quarter, abs=1e-3)


def test_frames_of_maps_keep_each_ones_power(tmp_path):
    rng = np.random.default_rng(1)
    frames = rng.uniform(0, 1, (3, 6, 7))
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["intensity"], file["time"] = frames, [0.0, 1e-5, 3e-5]
    series = laser_frames([tmp_path / "a.h5"], TILES, (2e-4, 1e-4), scale=1e6)
    assert series.times.tolist() == [0, 1e-5, 3e-5]
    assert TILES.integral(series.values) == pytest.approx(frames.mean(axis=(1, 2)) * 1e6 * 2e-8)
    paths = []
    for k, frame in enumerate(frames):
        paths.append(tmp_path / f"{k}.csv")
        np.savetxt(paths[-1], frame, delimiter=",")
    series = laser_frames(paths, TILES, (2e-4, 1e-4), power=5.0, interval=2e-5)
    assert series.times.tolist() == [0, 2e-5, 4e-5]
    power = TILES.integral(series.values)
    assert power.max() == pytest.approx(5.0)
    assert power / power[0] == pytest.approx(frames.sum(axis=(1, 2)) / frames[0].sum())


def test_maps_of_several_files_have_the_times_of_these(tmp_path):
    frames = np.random.default_rng(1).uniform(0, 1, (3, 6, 7))

    def written(name, part, times):
        with h5py.File(tmp_path / name, "w") as file:
            file["intensity"], file["time"] = frames[part], times
        return tmp_path / name

    whole = written("whole.h5", slice(0, 3), [0.0, 1e-5, 4e-5])
    parts = [written("a.h5", slice(0, 2), [0.0, 1e-5]), written("b.h5", 2, 4e-5)]
    expected = laser_frames([whole], TILES, (2e-4, 1e-4), scale=1e6)
    for interval in (None, 2e-5):
        series = laser_frames(parts, TILES, (2e-4, 1e-4), scale=1e6, interval=interval)
        assert series.times.tolist() == [0.0, 1e-5, 4e-5]
        assert np.array_equal(series.values, expected.values)
    alike = [parts[0], written("c.h5", 2, 0.0)]
    series = laser_frames(alike, TILES, (2e-4, 1e-4), scale=1e6, interval=2e-5)
    assert series.times.tolist() == [0.0, 2e-5, 4e-5]
    with pytest.raises(SurfaceError, match="does not ascend"):
        laser_frames(alike, TILES, (2e-4, 1e-4), scale=1e6)
    with pytest.raises(SurfaceError, match="interval"):
        np.save(tmp_path / "d.npy", frames[2])
        laser_frames([parts[0], tmp_path / "d.npy"], TILES, (2e-4, 1e-4), scale=1e6)


@pytest.mark.parametrize(
    ("text", "options", "words"),
    [
        ("1,2\n3,-1\n", {"power": 1.0}, "map.csv: line 2, column 2: -1.0 is no intensity"),
        ("1,2\n3,x\n", {"power": 1.0}, "map.csv: line 2: column 2: `x` is not a number"),
        ("1,2\n3\n", {"power": 1.0}, "map.csv: line 2: 1 columns, where there are 2"),
        ("0,0\n", {"power": 1.0}, "map.csv: is dark everywhere"),
        ("1,2\n", {}, "one of power"),
        ("1,2\n", {"power": -2.0}, "power = -2.0: a finite number above 0"),
        ("1,2\n", {"scale": float("nan")}, "scale = nan: a finite number above 0"),
        ("1,2\n", {"power": 1.0, "at": (1e-4, 0)}, r"lies off the target"),
    ],
)
def test_maps_that_are_none_are_refused(tmp_path, text, options, words):
    path = tmp_path / "map.csv"
    path.write_text(text)
    with pytest.raises(SurfaceError, match=words):
        laser_frames([path], TILES, (2e-4, 1e-4), **options)


def test_a_pulse_counts_in_the_units_of_its_header(tmp_path):
    (tmp_path / "map.csv").write_text("1,1\n1,1\n")
    (tmp_path / "pulse.csv").write_text("time [ms],power [kW]\n0,0\n1,5\n2,0\n")
    series = laser_frames([tmp_path / "map.csv"], TILES, (2e-4, 1e-4), pulse=tmp_path / "pulse.csv")
    assert series.times == pytest.approx([0.0, 1e-3, 2e-3])
    assert TILES.integral(series.values) == pytest.approx([0.0, 5e3, 0.0])


@pytest.mark.parametrize("order", ["<", ">"])
def test_pictures_of_sixteen_bits_keep_all_of_them(tmp_path, order):
    values = np.array([[0, 300], [4000, 65535]])
    mode = "I;16" if order == "<" else "I;16B"
    picture = Image.frombytes(mode, (2, 2), values.astype(f"{order}u2").tobytes())
    picture.save(tmp_path / "beam.tif")
    assert Image.open(tmp_path / "beam.tif").mode == mode
    _, frames = read_picture(tmp_path / "beam.tif")
    np.testing.assert_array_equal(frames, [values])


def test_pages_of_a_picture_are_frames(tmp_path):
    values = np.arange(24).reshape(3, 2, 4)
    pages = [Image.fromarray(page.astype("uint16")) for page in values]
    pages[0].save(tmp_path / "beam.tif", save_all=True, append_images=pages[1:])
    _, frames = read_picture(tmp_path / "beam.tif")
    np.testing.assert_array_equal(frames, values)
    pages[0].save(tmp_path / "beam.tif", save_all=True, append_images=[pages[1].resize((3, 3))])
    with pytest.raises(SurfaceError, match="beam.tif: its pages have different sizes"):
        read_picture(tmp_path / "beam.tif")


# Spray


@pytest.mark.parametrize("begin", [0.0, 1.3e-5])
def test_drops_bring_their_heat_into_the_unit(scene, tmp_path, capsys, begin):
    rng = np.random.default_rng(2)
    places = rng.uniform(-1, 1, (300, 2)) * [0.099, 0.049]
    mass, time = rng.uniform(1e-12, 2e-12, 300), rng.uniform(0, 3.9e-5, 300)
    time[0], time[1] = begin, 3.9e-5
    time = np.maximum(time, begin)
    rows = np.column_stack([places, mass, time])
    header = "x [mm],y [mm],mass [kg],time [s]"
    np.savetxt(tmp_path / "drops.csv", rows, delimiter=",", header=header, comments="")
    table = tmp_path / "table.csv"
    command = ["spray", tmp_path / "drops.csv", "--unit", "mm", "--factor", 3e5, "--window", 1e-5]
    command += ["--onto", f"{scene}:laser", "-o", table]
    assert main([str(word) for word in command]) == 0
    assert "of which 0 falls beside" in capsys.readouterr().out
    columns, _ = run(scene, "--inputs", table)
    assert columns["block.heat_in"][-1] == pytest.approx(3e5 * mass.sum(), rel=1e-12)
    # The same table, held: rows that stand twice are jumps either way.
    held, _ = run(scene, "--inputs", table, "--between", "held")
    assert held["centre.temperature"] == pytest.approx(columns["centre.temperature"], rel=1e-13)


def test_drops_beside_the_cells_are_told(tmp_path):
    path = tmp_path / "drops.csv"
    path.write_text("x,y,mass\n0,0,1e-9\n1e-3,0,3e-9\n")
    with pytest.raises(SurfaceError, match=r"3e-09 of 4e-09 \(0.75 of it\) lies off .* \(0.001, 0"):
        spray_frames(path, TILES, window=1e-5)
    series, total = spray_frames(path, TILES, window=1e-5, outside="drop")
    assert total == pytest.approx({"brought": 4e-9, "given": 1e-9, "lost": 3e-9})
    assert TILES.integral(series.integral(0, 0)) == 0
    assert TILES.integral(series.values[0]) * 1e-5 == pytest.approx(1e-9)
    _, total = spray_frames(path, TILES, window=1e-5, outside="drop", factor=-1.0)
    assert total == pytest.approx({"brought": -4e-9, "given": -1e-9, "lost": -3e-9})
    deep = replace(TILES, depth=0.5)
    same, total = spray_frames(path, deep, window=1e-5, outside="drop")
    assert total == pytest.approx({"brought": 4e-9, "given": 1e-9, "lost": 3e-9})
    assert same.values == pytest.approx(series.values, rel=1e-12)
    path.write_text("x,y,mass\n0,0,-1\n")
    with pytest.raises(SurfaceError, match="drop 1: column mass: -1.0 is below 0"):
        spray_frames(path, TILES, window=1e-5)
    path.write_text("x,y,mass,time\n0,0,1,-1e-6\n")
    with pytest.raises(SurfaceError, match="drop 1: column time: -1e-06 s is below 0"):
        spray_frames(path, TILES, window=1e-5)
    with pytest.raises(SurfaceError, match="no column heat; there are x, y, mass"):
        spray_frames(path, TILES, amount="heat", window=1e-5)


# Flow surfaces


def flow_surface(path, seed=3):
    """A series of a flux that is linear in time, in the middles of cells and at nodes of a mesh in
    millimetres that stands upright, and whose heat is known."""
    rng = np.random.default_rng(seed)
    inside = rng.uniform(-1, 1, (80, 2)) * [0.1, 0.05]
    nodes = np.concatenate([inside, [[0.1, 0.05], [-0.1, 0.05], [0.1, -0.05], [-0.1, -0.05]]])
    cells = Delaunay(nodes).simplices
    foreign = np.column_stack([np.full(len(nodes), 7.0), 5 + nodes[:, 0], 3 + nodes[:, 1]])
    at_nodes, at_cells = rng.uniform(1, 2, len(nodes)), rng.uniform(1, 2, len(cells))
    with meshio.xdmf.TimeSeriesWriter(path, data_format="XML") as writer:
        writer.write_points_cells(foreign, [("triangle", cells)])
        for time in (0.0, 4e-5):
            share = 1e7 * (1 + time / 4e-5)
            fields = {"q": share * at_nodes}
            writer.write_data(time, point_data=fields, cell_data={"f": [share * at_cells]})
    area = Surface.triangles(1e-3 * nodes, cells)
    power = 1e7 * np.array([area.on_points().integral(at_nodes), area.integral(at_cells)])
    return 1.5 * 4e-5 * power


@pytest.mark.parametrize(("name", "which"), [("q", 0), ("f", 1)])
def test_a_flow_surface_brings_its_heat_into_the_unit(scene, tmp_path, name, which):
    heat = flow_surface(tmp_path / "wall.xdmf")[which]
    table = tmp_path / "table.csv"
    command = ["cfd", tmp_path / "wall.xdmf", "--data", name, "--unit", "mm", "--origin", 7, 5, 3]
    command += ["--axes", 0, 1, 0, 0, 0, 1, "--onto", f"{scene}:laser", "-o", table]
    assert main([str(word) for word in command]) == 0
    columns, _ = run(scene, "--inputs", table)
    assert columns["block.heat_in"][-1] == pytest.approx(heat, rel=1e-12)


def test_flow_surfaces_that_do_not_fit_are_refused(tmp_path, capsys):
    flow_surface(tmp_path / "wall.xdmf")
    placement = Placement((7, 5, 3), ((0, 1, 0), (0, 0, 1)), "mm")
    with pytest.raises(SurfaceError, match="no field `h`; there are q"):
        cfd_frames(tmp_path / "wall.xdmf", TILES, "h", placement=placement)
    with pytest.raises(SurfaceError, match="no cell lies at z = 0 m"):
        cfd_frames(tmp_path / "wall.xdmf", TILES, "q", placement=Placement(unit="mm"))
    small = Surface.tiles((4, 5), (1e-4, 1e-4))
    with pytest.raises(SurfaceError, match="lies off the target"):
        cfd_frames(tmp_path / "wall.xdmf", small, "q", placement=placement)
    values = cfd_frames(tmp_path / "wall.xdmf", small, "q", kind="consistent", placement=placement)
    assert (values.values[0] > 1e7).all() and (values.values[0] < 2e7).all()
    assert main(["cfd", "none.vtu", "--data", "q", "--onto", "a.toml:b", "-o", "t.csv"]) == 2
    assert "impinge-adapt: a.toml: no such file" in capsys.readouterr().err


def test_coefficients_and_ambients_of_a_flow_become_those_of_a_face(scene, tmp_path, capsys):
    """A face below which the flow is hot where the coefficient is high: it takes the same heat."""
    text = scene.read_text()
    assert "bottom = { clamped = true }" in text
    convection = "convection = { coefficient = 1.0, ambient = 293.15 }"
    scene.write_text(text.replace("clamped = true }", f"clamped = true, {convection} }}"))
    x = np.linspace(-2e-4, 2e-4, 9)
    nodes = np.stack(np.meshgrid(x, x, [-1e-4], indexing="ij"), axis=3).reshape(-1, 3)
    cells = Surface.tiles((8, 8), (4e-4, 4e-4)).cells.corners
    rng = np.random.default_rng(4)
    h, hot = rng.uniform(1e3, 3e3, 64), rng.uniform(300, 500, 64)
    meshio.Mesh(nodes, [("quad", cells)], cell_data={"h": [h], "T": [hot]}).write(
        tmp_path / "w.vtu"
    )
    command = ["cfd", str(tmp_path / "w.vtu"), "--onto", f"{scene}:block.bottom"]
    assert main([*command, "--data", "h", "--variable", "coefficient"]) == 0
    option = capsys.readouterr().out.split()
    assert option[0] == "--set" and option[1].startswith("block.bottom.coefficient=")
    assert float(option[1].partition("=")[2]) == pytest.approx(h.mean(), rel=1e-13)
    table = tmp_path / "table.csv"
    more = ["--data", "T", "--weight", "h", "--variable", "ambient", "-o", str(table)]
    assert main([*command, *more]) == 0
    ambient = read_inputs(table)[1]["block.bottom.ambient"][0]
    assert ambient == pytest.approx((h * hot).sum() / h.sum(), rel=1e-13)
    columns, _ = run(scene, *option, "--inputs", table, "--step", "1e-7", "--until", "1e-7")
    # The body has hardly warmed: h (T∞ − T₀) over the face, in the first tenth of a microsecond.
    heat = (h * (hot - 293.15)).mean() * 1.6e-7 * 1e-7
    assert -columns["block.heat_lost"][-1] == pytest.approx(heat, rel=1e-3)
    assert main([*command, "--data", "T"]) == 2
    assert "-o: the name of the table is needed" in capsys.readouterr().err


# Tables of inputs


def test_tables_of_inputs_read_back(tmp_path):
    path = tmp_path / "t.csv"
    values = np.arange(12.0).reshape(2, 2, 3)
    write_inputs(path, {"laser.heat_flux": Series(np.array([0.0, 1.0]), values)})
    times, columns = read_inputs(path)
    assert times.tolist() == [0, 1]
    assert list(columns)[4] == "laser.heat_flux[2,2]"
    assert columns["laser.heat_flux[2,2]"].tolist() == [4, 10]
    write_inputs(
        path, {"spot.heat_flux": Series(np.array([0.0, 1.0]), values[:, 0, :1])}, single=True
    )
    assert read_inputs(path)[1]["spot.heat_flux"].tolist() == [0, 6]
    later = Series(np.array([0.0, 2.0]), values)
    with pytest.raises(SurfaceError, match="b: its times differ"):
        write_inputs(path, {"a": Series(np.array([0.0, 1.0]), values), "b": later})


# Fields out


def test_fields_of_a_box_come_onto_a_mesh(scene, tmp_path):
    """Nodes of the unit's own mesh in foreign coordinates give the unit's own values."""
    columns, out = run(scene, "--set", "laser.heat_flux=1e8", "--fields-every", "1")
    body = Body.read(out / "block_000004.vtr")
    nodes = np.stack(np.meshgrid(*body.axes, indexing="ij"), axis=3).reshape(-1, 3)
    placement = Placement((1.0, -2.0, 0.5), ((0, 1, 0), (-1, 0, 0)), "mm")
    foreign = placement.to_foreign(nodes)
    mesh = meshio.Mesh(foreign, [("vertex", np.arange(len(nodes))[:, None])])
    fields = ["temperature", "stress", "displacement", "von_mises"]
    frames = list(onto_mesh(out / "block.pvd", mesh, fields, placement=placement))
    assert len(frames) == 5
    time, values = frames[-1]
    assert time == 4e-5
    own = {name: body.fields[name].reshape(len(nodes), -1) for name in fields}
    assert values["temperature"] == pytest.approx(own["temperature"][:, 0], rel=1e-13)
    centre = body("temperature", np.zeros((1, 3)), 0.0)[0, 0]
    assert centre == pytest.approx(columns["centre.temperature"][-1], rel=1e-12)
    # Turned by a quarter: the body's x lies along the mesh's y.
    u, stress = own["displacement"], own["stress"]
    assert values["displacement"] == pytest.approx(
        np.stack([-u[:, 1], u[:, 0], u[:, 2]], 1), abs=1e-20
    )
    turned = stress[:, [1, 0, 2, 3, 5, 4]] * [1, 1, 1, -1, 1, -1]
    assert values["stress"] == pytest.approx(turned, rel=1e-9, abs=1e-6 * np.abs(stress).max())
    files = write_frames(tmp_path / "o.xdmf", mesh, frames)
    with meshio.xdmf.TimeSeriesReader(files[-1]) as reader:
        reader.read_points_cells()
        assert reader.num_steps == 5
        read = reader.read_data(4)
    assert read[0] == 4e-5 and np.array_equal(read[1]["temperature"], values["temperature"])
    files = write_frames(tmp_path / "o.pvd", mesh, frames)
    assert len(files) == 6
    assert np.array_equal(meshio.read(files[4]).point_data["stress"], values["stress"])
    with pytest.raises(SurfaceError, match="o.vtu: holds one time of 5"):
        write_frames(tmp_path / "o.vtu", mesh, frames)


def test_linear_fields_of_a_box_are_exact_and_places_off_it_refused():
    axes = tuple(np.sort(np.random.default_rng(k).uniform(-1, 1, 5)) for k in range(3))
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=3)
    body = Body(axes, {"temperature": (grid @ [1.0, -2, 3] + 300)[..., None]})
    low, high = (np.array([axis[k] for axis in axes]) for k in (0, -1))
    points = np.random.default_rng(9).uniform(low, high, (50, 3))
    assert body("temperature", points, 0.0)[:, 0] == pytest.approx(points @ [1, -2, 3] + 300)
    points[7] = high + [0.1, 0, 0]
    with pytest.raises(
        SurfaceError, match="1 of 50 points lie off the body, point 7 at .* by 0.1 m"
    ):
        body("temperature", points, 1e-3)
    with pytest.raises(SurfaceError, match="no field `heat`; there are temperature"):
        body("heat", points, 1.0)


@pytest.mark.parametrize("ending", ["vtr", "vts"])
def test_fields_of_a_disc_come_onto_a_mesh(ending, tmp_path, capsys):
    """Displacement along the radius, stress of a ring: components follow the angle."""
    scene = tmp_path / "disc.toml"
    text = SCENE.replace("box = [4e-4, 4e-4, 1e-4]", "disc = { radius = 2e-4, thickness = 1e-4 }")
    scene.write_text(
        text.replace("tiles = { count = [4, 5], size = [2e-4, 1e-4] }", "disc = { radius = 1e-4 }")
    )
    revolved = ["--revolve"] if ending == "vts" else []
    _, out = run(scene, "--set", "laser.heat_flux=1e8", "--fields-every", "4", *revolved)
    body = Body.read(out / f"block_000001.{ending}")
    assert body.axes[0][[0, -1]] == pytest.approx([0, 2e-4])
    radius, angle = body.axes[0][3], np.array([0.0, 0.7, 2.0, -1.5])
    points = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.zeros(4)])
    u = body("displacement", points, 1e-9)
    outward = np.column_stack([np.cos(angle), np.sin(angle)])
    along = body.fields["displacement"][3, -1, 0]
    assert along > 0
    assert (u[:, :2] * outward).sum(axis=1) == pytest.approx(along, rel=1e-12)
    stress = body("stress", points, 1e-9)
    rr = (stress[:, :2] * outward**2).sum(axis=1) + 2 * stress[:, 3] * outward.prod(axis=1)
    assert rr == pytest.approx(body.fields["stress"][3, -1, 0], rel=1e-12)
    # The command, onto one time
    nodes = 1e3 * points
    meshio.Mesh(nodes, [("vertex", np.arange(4)[:, None])]).write(tmp_path / "mesh.vtu")
    command = ["out", out / "block.pvd", "--onto", tmp_path / "mesh.vtu", "--unit", "mm"]
    command += ["--times", 4e-5, "--fields", "temperature", "stress", "-o", tmp_path / "o.vtu"]
    assert main([str(word) for word in command]) == 0
    read = meshio.read(tmp_path / "o.vtu").point_data
    assert read["temperature"] == pytest.approx(body.fields["temperature"][3, -1, 0], rel=1e-12)
    assert read["stress"] == pytest.approx(stress, rel=1e-9)
    command[command.index(4e-5)] = 3e-5
    assert main([str(word) for word in command]) == 2
    assert "block.pvd: has no time 3e-05 s" in capsys.readouterr().err


# Drops on demand


def test_drops_become_releases_one_after_another(tmp_path, capsys):
    """In millimetres of a face whose x lies along the file's −y; the second line falls first."""
    path = tmp_path / "drops.csv"
    path.write_text("time,x [mm],y [mm],speed,direction\n2e-3,3,0,1.5,0\n1e-3,0,2,2.5,1.5707963\n")
    table = tmp_path / "table.csv"
    command = ["drops", path, "--unit", "mm", "--axes", 0, -1, 0, 1, 0, 0, "-o", table]
    assert main([str(word) for word in command]) == 0
    assert "2 drops, inputs drop.release, drop.x" in capsys.readouterr().out
    times, columns = read_inputs(table)
    assert times.tolist() == [0, 1e-3, 1e-3, 2e-3, 2e-3]
    assert columns["drop.release"].tolist() == [0, 0, 1, 1, 2]
    assert columns["drop.x"] == pytest.approx([-2e-3] * 4 + [0], abs=1e-18)
    assert columns["drop.y"] == pytest.approx([0] * 4 + [3e-3], abs=1e-18)
    assert columns["drop.speed"].tolist() == [2.5] * 4 + [1.5]
    # Along the file's y is against the face's x, along its x is along the face's y.
    assert columns["drop.direction"] == pytest.approx([np.pi] * 4 + [np.pi / 2], abs=1e-6)
    path.write_text("x,y,time\n0,0,1\n1,1,2\n2,2,1\n")
    with pytest.raises(SurfaceError, match="drops 1 and 3 both fall at 1.0 s"):
        drop_inputs(path, "drop")
    path.write_text("x,y\n0,0\n")
    with pytest.raises(SurfaceError, match="no column time; there are x, y"):
        drop_inputs(path, "drop")
