"""Surfaces of files, of scenes and of units."""

import base64
import json
import re
import struct
import zlib
from pathlib import Path

import h5py
import meshio
import numpy as np
import pytest
from impinge import Unit
from impinge.adapt import cfd_frames, read_picture
from impinge.surface import Placement, Surface, SurfaceError
from impinge.surface.families import from_cells
from scipy.spatial import Delaunay

ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "tests/fmpy/scenes"
NODES = np.array([[0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0], [4, 0, 0], [0, 0, 3.0]])


def write_mesh(path, **options):
    """A quadrilateral and a triangle on the plane z = 0, and a triangle that stands on it."""
    blocks = [("quad", [[0, 1, 2, 3]]), ("triangle", [[1, 4, 2], [0, 1, 5]])]
    flux, temperature = [[5.0], [6.0, 7.0]], [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]
    mesh = meshio.Mesh(NODES, blocks, {"T": temperature}, {"q": flux})
    mesh.write(path, **options)
    return path


@pytest.mark.parametrize("name", ["a.vtu", "a.vtk", "a.xdmf"])
def test_meshes_are_read_with_the_fields_of_their_faces(tmp_path, name):
    path = write_mesh(tmp_path / name, **({"data_format": "XML"} if "xdmf" in name else {}))
    surface = Surface.read(path, Placement(unit="mm"), face=0.0)
    assert surface.location == "cells"
    assert surface.areas == pytest.approx([2e-6, 1e-6])
    assert surface.data["q"].tolist() == [5.0, 6.0]
    surface = Surface.read(path, face=0.0, values="points")
    assert surface.data["T"].tolist() == [1, 2, 3, 4, 5]
    assert surface.coordinates[:, :2].tolist() == NODES[:5, :2].tolist()
    with pytest.raises(SurfaceError, match=f"{name}: node 5 at z = 3 m lies 3 m off the plane"):
        Surface.read(path)
    with pytest.raises(SurfaceError, match="no cell lies at z = 1 m .* they lie from 0 to 3 m"):
        Surface.read(path, face=1.0)


def test_a_standing_face_is_placed(tmp_path):
    path = write_mesh(tmp_path / "a.vtu")
    # The triangle in the plane y = 0, seen along y: x of the face along x, y along z
    surface = Surface.read(path, Placement((0, 0, 0), ((1, 0, 0), (0, 0, 1)), "mm"), face=0.0)
    assert surface.areas == pytest.approx([3e-6])
    assert surface.data["q"].tolist() == [7.0]


def test_tables_are_read_with_time_and_units(tmp_path):
    path = tmp_path / "a.csv"
    rows = [
        f"{x};{y};{t};{x + 10 * y + 100 * t}" for t in (2, 0, 1) for x in (0, 1) for y in (0, 3)
    ]
    path.write_text("# of a camera\nx [mm];y [mm];time [s];q [W/m2]\n" + "\n".join(rows))
    surface, series = Surface.read_series(path, Placement(unit="mm"))
    assert surface.coordinates[:, :2].tolist() == [[0, 0], [0, 3e-3], [1e-3, 0], [1e-3, 3e-3]]
    assert series["q"](0.5) == pytest.approx([50, 80, 51, 81])
    with pytest.raises(SurfaceError, match="`q` has 3 times; read_series reads them"):
        Surface.read(path)


@pytest.mark.parametrize("unit", ["m", "mm", "um"])
def test_units_in_headers_count_whatever_the_placement_says(tmp_path, unit):
    path = tmp_path / "a.csv"
    header = "x [mm],y [in],time [ms],q [kW/m2],T [degC],share [%],n [-]"
    path.write_text(f"{header}\n3,1,500,2,20,5,7\n4,1,500,3,30,6,8\n")
    surface, series = Surface.read_series(path, Placement(unit=unit))
    places = np.array([[3e-3, 0.0254], [4e-3, 0.0254]])
    assert surface.coordinates[:, :2] == pytest.approx(places, rel=1e-12)
    assert series["q"].times.tolist() == [0.5]
    found = {name: each.values[0].tolist() for name, each in series.items()}
    assert found["q"] == [2e3, 3e3]
    assert found["T"] == pytest.approx([293.15, 303.15], rel=1e-12)
    assert found["share"] == pytest.approx([0.05, 0.06], rel=1e-12)
    assert found["n"] == [7.0, 8.0]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("x,y,q\n1,2,3\n1,abc,3\n", "a.csv: line 3: column y: `abc` is not a number"),
        ("x,y,q\n1,2,3\n\n1,2\n", "a.csv: line 4: 2 columns, where there are 3"),
        ("x,y,q\n1,2,nan\n", "a.csv: line 2: column q: nan is not finite"),
        ("1,2,3\n", "a.csv: line 1: names of columns are needed"),
        ("x,y,q [frogs]\n1,2,3\n", r"a.csv: line 1: column q \[frogs\]: .*no unit"),
        ("x [kg],y,q\n1,2,3\n", r"line 1: column x \[kg\]: .*quantities of different kinds"),
        ("x,x,q\n", "a.csv: line 1: column `x` stands twice"),
        ("x,z,q\n1,2,3\n", "a.csv: columns x and y are needed; there are x, z, q"),
        ("x,y,time\n1,2,0\n1,2,1\n3,3,1\n", "a.csv: times have different places"),
        ("", "a.csv: is empty"),
    ],
)
def test_tables_tell_file_line_and_column(tmp_path, text, words):
    path = tmp_path / "a.csv"
    path.write_text(text)
    with pytest.raises(SurfaceError, match=words):
        Surface.read(path)


def test_hdf5_series_are_read(tmp_path):
    path = tmp_path / "a.h5"
    with h5py.File(path, "w") as file:
        file["points"], file["cells"] = NODES[:4], [[0, 1, 2, 3]]
        file["time"] = [0.0, 1.0, 3.0]
        file["q"], file["T"] = [[1.0], [3.0], [3.0]], np.arange(12.0).reshape(3, 4)
    surface, series = Surface.read_series(path, values="cells")
    assert surface.areas.tolist() == [2.0]
    assert series["q"].integral(0, 3) == pytest.approx([2 + 6])
    surface, series = Surface.read_series(path, values="points")
    assert series["T"](2.0) == pytest.approx([6, 7, 8, 9])
    with h5py.File(path, "a") as file:
        file["odd"] = np.zeros(7)
    with pytest.raises(SurfaceError, match="`odd` of shape .* fits neither points nor cells"):
        Surface.read(path)


def test_fields_of_as_many_cells_as_points_need_to_be_told(tmp_path):
    """A ring of eight parts, cut into triangles: 16 points, 16 cells."""
    turn = np.exp(2j * np.pi * np.arange(8) / 8)
    points = np.concatenate([turn, 2 * turn])
    here = np.arange(8)
    after = (here + 1) % 8
    inner, outer = np.stack([here, after + 8, after]), np.stack([here, here + 8, after + 8])
    path = tmp_path / "a.h5"
    with h5py.File(path, "w") as file:
        file["points"] = np.column_stack([points.real, points.imag])
        file["cells"] = np.hstack([inner, outer]).T
        file["q"] = np.arange(16.0)
    for values in ("cells", "points"):
        surface = Surface.read(path, values=values)
        assert (surface.location, surface.shape) == (values, (16,))
        assert surface.data["q"].tolist() == list(range(16))
    with pytest.raises(SurfaceError, match="`q` has 16 rows, and there are as many points as"):
        Surface.read(path)
    target = Surface.ring_edges([0.0, 2.0])
    frames = [cfd_frames(path, target, "q", values=values) for values in ("cells", "points")]
    exact = Surface.read(path, values="cells")
    assert target.integral(frames[0].values)[0] == pytest.approx(exact.integral(np.arange(16.0)))
    assert frames[1].values[0] != pytest.approx(frames[0].values[0])
    with pytest.raises(SurfaceError, match="--values"):
        cfd_frames(path, target, "q")


def test_series_of_files_are_read(tmp_path):
    cells = [("triangle", np.array([[0, 1, 2]]))]
    with meshio.xdmf.TimeSeriesWriter(tmp_path / "a.xdmf", data_format="XML") as writer:
        writer.write_points_cells(NODES[:3], cells)
        for time in (0.0, 0.5):
            writer.write_data(time, point_data={"q": time * np.array([1.0, 2.0, 3.0])})
    sets = ""
    for k, time in enumerate((0.0, 0.5)):
        values = {"q": time * np.array([1.0, 2.0, 3.0])}
        meshio.Mesh(NODES[:3], cells, values).write(tmp_path / f"a{k}.vtu")
        sets += f'<DataSet timestep="{time}" file="a{k}.vtu"/>'
    text = f'<VTKFile type="Collection"><Collection>{sets}</Collection></VTKFile>'
    (tmp_path / "a.pvd").write_text(text)
    for name in ("a.xdmf", "a.pvd"):
        surface, series = Surface.read_series(tmp_path / name)
        assert surface.location == "points"
        assert series["q"](0.25) == pytest.approx([0.25, 0.5, 0.75])
    meshio.Mesh(2 * NODES[:3], cells, values).write(tmp_path / "a1.vtu")
    with pytest.raises(SurfaceError, match="the places at 0.5 s are others than at 0.0 s"):
        Surface.read_series(tmp_path / "a.pvd")
    with pytest.raises(SurfaceError, match="b.vtu: no such file"):
        Surface.read(tmp_path / "b.vtu")


def vtk_arrays(form, compressed):
    """XML of polygons with arrays in one of VTK's forms: two triangles and a square."""
    nodes = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [2, 1, 0]], "<f8")
    arrays = {
        "points": ("Float64", nodes, 3),
        "connectivity": ("Int64", np.array([0, 1, 2, 0, 2, 3, 1, 4, 5, 2], "<i8"), 1),
        "offsets": ("Int64", np.array([3, 6, 10], "<i8"), 1),
        "q": ("Float32", np.array([1, 2, 4], "<f4"), 1),
    }
    appended = b""

    def element(name):
        nonlocal appended
        kind, values, components = arrays[name]
        start = f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}"'
        if form == "ascii":
            text = " ".join(str(x) for x in values.ravel())
            return f'{start} format="ascii">{text}</DataArray>'
        data = values.tobytes()
        if compressed:
            size = 40
            blocks = [data[k : k + size] for k in range(0, len(data), size)]
            packed = [zlib.compress(block) for block in blocks]
            rest = len(data) % size
            numbers = [len(blocks), size, rest, *(len(block) for block in packed)]
            head, body = struct.pack(f"<{len(numbers)}I", *numbers), b"".join(packed)
        else:
            head, body = struct.pack("<I", len(data)), data
        if form == "raw":
            content = head + body
        elif compressed:
            content = base64.b64encode(head) + base64.b64encode(body)
        else:
            content = base64.b64encode(head + body)
        if form == "binary":
            return f'{start} format="binary">{content.decode()}</DataArray>'
        offset, appended = len(appended), appended + content
        return f'{start} format="appended" offset="{offset}"></DataArray>'

    pack = ' compressor="vtkZLibDataCompressor"' if compressed else ""
    text = f'<?xml version="1.0"?><VTKFile type="PolyData" byte_order="LittleEndian"{pack}>'
    text += f"<PolyData><Piece><CellData>{element('q')}</CellData><Points>{element('points')}"
    text += f"</Points><Polys>{element('connectivity')}{element('offsets')}</Polys></Piece>"
    encoding = "raw" if form == "raw" else "base64"
    tail = (
        f'</PolyData><AppendedData encoding="{encoding}">_'.encode() if appended else b"</PolyData>"
    )
    end = b"</AppendedData></VTKFile>" if appended else b"</VTKFile>"
    return text.encode() + tail + appended + end


@pytest.mark.parametrize("form", ["ascii", "binary", "raw", "base64"])
@pytest.mark.parametrize("compressed", [False, True])
def test_all_forms_of_vtk_arrays_are_read(tmp_path, form, compressed):
    path = tmp_path / "a.vtp"
    path.write_bytes(vtk_arrays(form, compressed))
    surface = Surface.read(path)
    assert surface.areas == pytest.approx([0.5, 0.5, 1.0])
    assert surface.integral(surface.data["q"]) == pytest.approx(5.5)


@pytest.mark.parametrize("form", ["ascii", "binary"])
@pytest.mark.parametrize("is_first", [False, True])
def test_what_vtk_tells_about_an_array_is_no_part_of_it(tmp_path, form, is_first):
    """VTK writes the range of norms into the element of an array."""
    keys = """<InformationKey name="L2_NORM_RANGE" location="vtkDataArray" length="2">
    <Value index="0">0</Value><Value index="1">2.2</Value></InformationKey>"""
    parts = [r"\1", keys, r"\2"] if is_first else [r"\1", r"\2", keys]
    text = vtk_arrays(form, False).decode()
    path = tmp_path / "a.vtp"
    path.write_text(re.sub(r"(<DataArray[^>]*>)([^<]*)", "".join(parts), text))
    surface = Surface.read(path)
    assert surface.areas == pytest.approx([0.5, 0.5, 1.0])
    assert surface.integral(surface.data["q"]) == pytest.approx(5.5)


def test_flat_grids_of_vtk_are_surfaces(tmp_path):
    text = """<VTKFile type="RectilinearGrid"><RectilinearGrid><Piece Extent="0 2 0 1 0 0">
    <PointData><DataArray type="Float64" Name="T" format="ascii">0 1 3 10 11
    13</DataArray></PointData> <CellData><DataArray type="Float64" Name="q" format="ascii">5
    7</DataArray></CellData> <Coordinates><DataArray type="Float64" Name="x" format="ascii">0 1
    3</DataArray> <DataArray type="Float64" Name="y" format="ascii">0 1</DataArray> <DataArray
    type="Float64" Name="z" format="ascii">0</DataArray></Coordinates>
    </Piece></RectilinearGrid></VTKFile>
    """
    path = tmp_path / "a.vtr"
    path.write_text(text)
    surface = Surface.read(path)
    assert surface.integral(surface.data["q"]) == pytest.approx(5 * 1 + 7 * 2)
    nodes = Surface.read(path, values="points")
    middle = nodes.map_to(Surface.points([[2.0, 0.5]]), "consistent")(nodes.data["T"])
    assert middle == pytest.approx([7.0])
    path.write_text(text.replace("<VTKFile", '<VTKFile compressor="vtkLZ4DataCompressor"'))
    with pytest.raises(SurfaceError, match="a.vtr: compressed by vtkLZ4DataCompressor"):
        Surface.read(path)


# Of units and scenes


@pytest.mark.parametrize(
    ("scene", "name", "shape", "location"),
    [
        ("tiles", "patch", (2, 3), "cells"),
        ("rings", "splat", (4,), "cells"),
        ("plate", "spot", (1,), "cells"),
        ("plate", "surface", (4, 2), "points"),
        ("drop", "wall", (4,), "cells"),
    ],
)
def test_units_and_scenes_tell_the_same_cells(scene, name, shape, location):
    path = SCENES / f"{scene}.toml"
    of_scene = Surface.of(path, name)
    with Unit(path) as unit:
        of_unit, of_folder = Surface.of(unit, name), Surface.of(unit.folder, name)
        assert of_unit.coordinates == pytest.approx(of_scene.coordinates, abs=1e-18)
        for surface in (of_scene, of_unit, of_folder):
            assert surface.shape == shape
            assert surface.location == location
            assert surface.areas == pytest.approx(of_scene.areas, rel=1e-12)


@pytest.mark.parametrize("depth", [1e-4, 1.0])
def test_areas_of_walls_of_plane_drops_are_per_depth(tmp_path, depth):
    """In scenes as in their units, which count per metre of depth."""
    text = (SCENES / "drop.toml").read_text()
    text = text.replace("spacing = 1e-5", "spacing = 1e-5\ndimension = 2")
    tiles = f"tiles = {{ count = [20, 1], size = [8e-4, {depth}] }}"
    path = tmp_path / "scene.toml"
    path.write_text(text.replace("rings = { count = 4, radius = 1e-4 }", tiles))
    of_scene = Surface.of(path, "wall")
    with Unit(path) as unit:
        areas = unit.areas("wall")
        assert areas == pytest.approx(np.full(20, 4e-5), rel=1e-12)
        for surface in (of_scene, Surface.of(unit, "wall"), Surface.of(unit.folder, "wall")):
            assert surface.areas.ravel() == pytest.approx(areas, rel=1e-12)
            assert surface.depth == pytest.approx(depth)
            assert np.ptp(surface.cells.nodes[:, 1]) == pytest.approx(depth)


@pytest.mark.parametrize(
    "footprint",
    [
        "disc = { radius = 6e-5 }",
        "ring = { inner = 2e-5, outer = 6e-5 }",
        "rings = { count = 3, radius = 6e-5 }",
    ],
)
def test_a_load_of_a_scene_has_its_radius_at_the_start(tmp_path, footprint):
    """The cells are those of the unit of the scene; all radii grow in proportion."""
    text = (SCENES / "plate.toml").read_text()
    start = "start = { radius = '48 um' }"
    text = text.replace("disc = { radius = 6e-5 } }", f"{footprint} }}\n{start}")
    path = tmp_path / "scene.toml"
    path.write_text(text)
    of_scene = Surface.of(path, "spot")
    hole = 16e-6 if footprint.startswith("ring =") else 0.0
    assert of_scene.areas.sum() == pytest.approx(np.pi * ((48e-6) ** 2 - hole**2), rel=1e-12)
    with Unit(path) as unit:
        assert Surface.of(unit, "spot").areas == pytest.approx(of_scene.areas, rel=1e-12)


@pytest.mark.parametrize(
    ("scene", "name", "area"),
    [("plate", "spot", np.pi * (9e-5) ** 2), ("tiles", "patch", 1.1e-4 * 0.9e-4 / 6)],
)
def test_a_load_of_a_unit_is_where_and_as_large_as_it_is_now(scene, name, area):
    """By parameters and by inputs; a closed unit knows its start alone."""
    path = SCENES / f"{scene}.toml"
    start = Surface.of(path, name)
    size = {f"{name}.radius": 9e-5} if scene == "plate" else {}
    with Unit(path, parameters=size) as unit:
        unit[f"{name}.x"], unit[f"{name}.y"] = 3e-5, -5e-5
        now = Surface.of(unit, name)
        moved = now.coordinates - start.coordinates
        assert moved == pytest.approx(np.tile([3e-5, -5e-5, 0.0], (now.size, 1)), abs=1e-18)
        assert now.areas == pytest.approx(np.full(now.shape, area), rel=1e-12)
    assert Surface.of(unit, name).areas == pytest.approx(start.areas, rel=1e-12)


def check_field(tmp_path, text, keys):
    """A field with these keys lies where the unit of the scene has it."""
    path = tmp_path / "scene.toml"
    path.write_text(f'{text}\n[[field]]\nname = "f"\n{keys}\ngives = ["temperature"]\n')
    of_scene = Surface.of(path, "f")
    with Unit(path) as unit:
        of_unit = Surface.of(unit, "f")
    assert of_scene.coordinates == pytest.approx(of_unit.coordinates, abs=1e-15)
    assert of_scene.areas == pytest.approx(of_unit.areas, rel=1e-9)


@pytest.mark.parametrize(
    ("scene", "keys"),
    [
        ("tiles", "footprint = { tiles = { count = [2, 3], size = [6e-5, 9e-5] } }"),
        ("tiles", "footprint = { rings = { count = 3, radius = 6e-5 } }"),
        ("rings", "grid = [3, 5]"),
    ],
)
def test_fields_of_scenes_lie_where_they_lie_in_the_unit(tmp_path, scene, keys):
    """Cells whose middle is not the axis, and the grid in the square that a disc encloses."""
    text = (SCENES / f"{scene}.toml").read_text()
    body = re.search(r"\[body\.(\w+)\]", text)[1]
    at = "" if "grid" in keys else "\nat = [5e-5, -2e-5]"
    check_field(tmp_path, text, f'on = "{body}.top"\n{keys}{at}')


def scene_of_texts(scene):
    """A small scene whose lengths are texts, and the name of its body."""
    text = (SCENES / f"{scene}.toml").read_text()
    body = re.search(r"\[body\.(\w+)\]", text)[1]
    for old, new in (
        ("shape = { disc = { radius = 3e-4, thick", "shape = { disc = { radius = '300 um', thick"),
        ("thickness = 1e-4", "thickness = '.1mm'"),
        ("box = [4e-4, 4e-4, 1e-4]", "box = ['0.4 mm', 4e-4, '1e-1 mm']"),
    ):
        text = text.replace(old, new)
    assert "mm'" in text
    return text, body


@pytest.mark.parametrize(
    ("scene", "keys"),
    [
        ("tiles", "footprint = { tiles = { count = [2, 3], size = ['110 µm', '3.5 mil'] } }"),
        ("tiles", "footprint = { rings = { count = 3, radius = '.06mm' } }"),
        ("tiles", "footprint = { ring = { inner = '2e-5 m', outer = '60 micron' } }"),
        ("tiles", "footprint = { disc = { radius = '+1e-1 mm' } }"),
        ("tiles", "grid = [3, 5]\nsize = ['0.2 mm', '1500000 Å']"),
        ("tiles", "grid = [3, 5]"),
        ("rings", "grid = [3, 5]"),
    ],
)
def test_lengths_of_scenes_may_be_texts(tmp_path, scene, keys):
    """Fields lie where the unit of the same scene has them."""
    text, body = scene_of_texts(scene)
    at = "" if "grid" in keys else "\nat = ['5e-2 mm', -2e-5]"
    check_field(tmp_path, text, f'on = "{body}.top"\n{keys}{at}')


@pytest.mark.parametrize(("scene", "area"), [("tiles", 1.6e-7), ("rings", np.pi * 9e-8)])
def test_faces_of_bodies_may_have_texts_as_lengths(tmp_path, scene, area):
    text, body = scene_of_texts(scene)
    path = tmp_path / "scene.toml"
    path.write_text(text)
    surface = Surface.of(path, f"{body}.bottom")
    assert surface.areas.sum() == pytest.approx(area, rel=1e-12)
    assert surface.z == -1e-4


@pytest.mark.parametrize("text", ["8", "8 s", "8,5 mm", "wide"])
def test_texts_that_are_no_lengths_are_refused(tmp_path, text):
    path = tmp_path / "scene.toml"
    given = (SCENES / "tiles.toml").read_text()
    path.write_text(given.replace("size = [1.1e-4, 0.9e-4]", f'size = [1.1e-4, "{text}"]'))
    with pytest.raises(SurfaceError, match=f"scene.toml: '{text}' is no length"):
        Surface.of(path, "patch")


def test_points_of_a_field_are_where_the_unit_says():
    with Unit(SCENES / "plate.toml", fmi=3) as unit:
        surface = Surface.of(unit, "surface")
        places = unit.coordinates("surface")
        for axis, lines in zip("xy", surface.cells.middles, strict=True):
            assert lines == pytest.approx(np.unique(places[axis]), abs=1e-15)
        assert (places["z"] == surface.z).all()


def test_families_without_cells_are_refused(tmp_path):
    with pytest.raises(SurfaceError, match="`cloud` is none of its loads, walls and fields: patch"):
        Surface.of(SCENES / "tiles.toml", "cloud")
    scene = tmp_path / "a.toml"
    text = (SCENES / "tiles.toml").read_text()
    footprint = "tiles = { count = [2, 3], size = [1.1e-4, 0.9e-4] }"
    assert footprint in text
    scene.write_text(text.replace(footprint, "gaussian = { radius = 1e-5 }"))
    with pytest.raises(SurfaceError, match="`patch` has no rings, tiles, disc or grid to map to"):
        Surface.of(scene, "patch")
    scene.write_text(text.replace('"block.top"', '"block.bottom"'))
    assert Surface.of(scene, "patch").z == -1e-4
    with pytest.raises(SurfaceError, match="b.fmu: no such file"):
        Surface.of(tmp_path / "b.fmu", "patch")
    cells = {"footprint": "rings", "inner": [0, 1], "outer": [1, 2], "area": [3.0, 9.0]}
    with pytest.raises(SurfaceError, match="areas of the unit differ"):
        from_cells(cells, "rings")
    with pytest.raises(SurfaceError, match="whose height it does not tell"):
        from_cells({**cells, "on": "plate.bottom"}, "rings")
    folder = tmp_path / "unit"
    (folder / "resources").mkdir(parents=True)
    cells["area"] = [np.pi, 3 * np.pi]
    (folder / "resources/cells.json").write_text(json.dumps({"families": {"rings": cells}}))
    assert Surface.of(folder, "rings").areas == pytest.approx(cells["area"])


@pytest.mark.parametrize(
    "kind", ["csv h5 vtu vtk vtp vtr pvd xdmf msh stl foo", "npy png toml fmu"]
)
@pytest.mark.parametrize("content", [b"", b"garbage", b"\xff\xfe\x00", b"<Xdmf></Xdmf>", bytes(99)])
def test_files_that_are_something_else_are_refused_by_name(tmp_path, kind, content):
    for suffix in kind.split():
        path = tmp_path / f"odd.{suffix}"
        path.write_bytes(content)
        calls = [lambda path=path: read_picture(path)] if "npy" in kind else []
        calls += [lambda path=path: Surface.of(path, "laser")]
        calls += [] if "npy" in kind else [lambda path=path: Surface.read_series(path)]
        for call in calls:
            with pytest.raises(SurfaceError, match=f"odd.{suffix}: "):
                call()


def test_a_unit_takes_what_a_foreign_mesh_brings_and_gives_its_field_back(tmp_path):
    """Flux at nodes in millimetres into the tiles of a unit; its temperature onto those nodes."""
    rng = np.random.default_rng(6)
    inside = rng.uniform(-1, 1, (60, 2)) * [0.055, 0.045]
    nodes = np.concatenate([inside, [[0.055, 0.045], [-0.055, 0.045], [0.055, -0.045]]])
    nodes = np.column_stack([nodes + [120, 40], np.zeros(len(nodes))])
    cells = Delaunay(nodes[:, :2]).simplices
    mesh = meshio.Mesh(nodes, [("triangle", cells)], {"q": rng.uniform(1e7, 2e7, len(nodes))})
    mesh.write(tmp_path / "wall.vtu")
    scene = tmp_path / "scene.toml"
    field = '[[field]]\nname = "face"\non = "block.top"\ngrid = [40, 40]\ngives = ["temperature"]\n'
    scene.write_text((SCENES / "tiles.toml").read_text() + field)
    with Unit(scene) as unit:
        wall = Surface.read(tmp_path / "wall.vtu", Placement(origin=(120, 40, 0), unit="mm"))
        flux = wall.map_to(Surface.of(unit, "patch"))
        unit["patch.heat_flux"] = flux(wall.data["q"])
        unit.step(1e-5)
        heat = wall.integral(wall.data["q"]) * 1e-5
        assert unit["block.heat_in"] == pytest.approx(heat, rel=1e-12)
        back = Surface.of(unit, "face").map_to(wall, "consistent")(unit["face.temperature"])
        assert back.shape == (len(nodes),)
        assert 293.15 < back.min() and back.max() <= unit["face.temperature"].max()
