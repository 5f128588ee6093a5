"""Files of strangers with surfaces and tables: each damage ends in the package's own error."""

import base64
import os
import struct
import sys
import zipfile
import zlib

import h5py
import numpy as np
import pytest
from impinge.adapt import drop_inputs, read_picture, spray_frames
from impinge.adapt.out import Body
from impinge.reading import reading
from impinge.surface import Surface, SurfaceError
from impinge.surface.csv_files import read_matrix, read_table

FIELD = '<DataArray type="Float64" Name="T" format="ascii">300</DataArray>'
POINTS = "0 0 0 1 0 0 0 1 0 1 1 0"
POLYGONS = (
    '<DataArray type="Int64" Name="connectivity" format="ascii">0 1 3 2</DataArray>'
    '<DataArray type="Int64" Name="offsets" format="ascii">4</DataArray>'
)


def polygons(field=FIELD, polygons=POLYGONS, points=POINTS, more="", root=""):
    """VTK's XML of one square of four points."""
    return (
        f'<?xml version="1.0"?><VTKFile type="PolyData"{root}><PolyData>'
        f'<Piece NumberOfPoints="4" NumberOfPolys="1"{more}><Points><DataArray type="Float64"'
        f' Name="Points" NumberOfComponents="3" format="ascii">{points}</DataArray></Points>'
        f"<Polys>{polygons}</Polys><CellData>{field}</CellData></Piece></PolyData></VTKFile>"
    )


def binary(data, header=None, size=8, form="binary"):
    head = struct.pack("<I", size) if header is None else header
    text = base64.b64encode(head + data).decode()
    return f'<DataArray type="Float64" Name="T" format="{form}">{text}</DataArray>'


def packed(blocks, numbers):
    """A compressed array whose header holds these numbers."""
    head = base64.b64encode(struct.pack(f"<{len(numbers)}I", *numbers))
    text = (head + base64.b64encode(b"".join(blocks))).decode()
    return f'<DataArray type="Float64" Name="T" format="binary">{text}</DataArray>'


ZLIB = ' compressor="vtkZLibDataCompressor"'
VALUE = struct.pack("<d", 300.0)
BLOCK = zlib.compress(VALUE)
BOMB = zlib.compress(bytes(1 << 26))

DAMAGED = {
    "3 values of 1 cell": (polygons(FIELD.replace("300", "1 2 3")), "has 3 numbers, not 1"),
    "no value": (polygons(FIELD.replace("300", "")), "has 0 numbers, not 1"),
    "NaN": (polygons(FIELD.replace("300", "nan")), "`T` is nan at place 0"),
    "infinity": (polygons(FIELD.replace("300", "-inf")), "`T` is -inf at place 0"),
    "words": (polygons(FIELD.replace("300", "abc")), "array `T`: could not convert"),
    "no format": (polygons(FIELD.replace(' format="ascii"', "")), "lacks 'format'"),
    "no such format": (polygons(FIELD.replace("ascii", "hex")), "its format is hex"),
    "no such type": (polygons(FIELD.replace("Float64", "String")), "is of type String"),
    "components -1": (
        polygons(FIELD.replace(" format", ' NumberOfComponents="-1" format')),
        "NumberOfComponents is -1",
    ),
    "components of no number": (
        polygons(FIELD.replace(" format", ' NumberOfComponents="x" format')),
        "array `T`: invalid literal",
    ),
    "says 4 GB, has 8 bytes": (polygons(binary(VALUE, size=0xFFFFFFF0)), "4294967280 bytes, not 8"),
    "cut off": (polygons(binary(VALUE[:5])), "has 5 bytes, not 8"),
    "no header": (polygons(binary(b"", header=b"\1")), "has 1 bytes, not 4"),
    "says 4e9 blocks": (polygons(packed([BLOCK], [0xFFFFFFFF, 8, 0, 1]), root=ZLIB), "blocks"),
    "a bomb": (
        polygons(packed([BOMB], [1, 1 << 26, 0, len(BOMB)]), root=ZLIB),
        "67108864 bytes, not 8",
    ),
    "a bomb that lies": (polygons(packed([BOMB], [1, 8, 0, len(BOMB)]), root=ZLIB), None),
    "a block too short": (polygons(packed([BLOCK], [1, 8, 0, 99]), root=ZLIB), "bytes, not 99"),
    "no zlib": (polygons(packed([b"abc"], [1, 8, 0, 3]), root=ZLIB), "array `T`: Error -3"),
    "header of no type": (polygons(root=' header_type="Float32"'), "header_type is Float32"),
    "corner -2": (polygons(polygons=POLYGONS.replace("3 2", "3 -2")), "corners 0, 1, 3, -2"),
    "corner 99999999": (
        polygons(polygons=POLYGONS.replace("3 2", "3 99999999")),
        "cell 0 has the corners 0, 1, 3, 99999999 .allowed: 0 to 3",
    ),
    "corner 4": (polygons(polygons=POLYGONS.replace("3 2", "3 4")), "allowed: 0 to 3"),
    "corners of 30 digits": (polygons(polygons=POLYGONS.replace("3 2", "3 " + "9" * 30)), "array"),
    "corners that are no whole numbers": (
        polygons(polygons=POLYGONS.replace("Int64", "Float64")),
        "holds no whole numbers",
    ),
    "offset 5 of 4": (polygons(polygons=POLYGONS.replace(">4<", ">5<")), "has 4 numbers, not 5"),
    "offset -4": (polygons(polygons=POLYGONS.replace(">4<", ">-4<")), "do not ascend"),
    "offset 9e18": (polygons(polygons=POLYGONS.replace(">4<", f">{9 * 10**18}<")), "array"),
    "a second offset": (polygons(polygons=POLYGONS.replace(">4<", ">4 4<")), "has 2 numbers"),
    "two corners": (
        polygons(polygons=POLYGONS.replace("0 1 3 2", "0 1").replace(">4<", ">2<")),
        "polygon 0 has 2 corners",
    ),
    "no polygons": (polygons(polygons=""), "lacks 'offsets'"),
    "a point is missing": (polygons(points=POINTS[:-6]), "has 9 numbers, not 12"),
    "a point is NaN": (
        polygons(points=POINTS.replace("1 1 0", "1 nan 0")),
        "point 3 .* not finite",
    ),
    "points without number": (polygons().replace('"4"', '"many"'), "invalid literal"),
    "-4 points": (polygons().replace('NumberOfPoints="4"', 'NumberOfPoints="-4"'), "is -4"),
    "1e15 points": (polygons().replace('"4"', f'"{10**15}"'), "NumberOfPoints is 1000000000000000"),
    "strips": (polygons(more=' NumberOfStrips="2"'), "holds 2 strips"),
    "a beginning of appended data": ("<VTKFile><AppendedData", "AppendedData is cut off"),
    "deep nesting": ("<a>" * 200_000, ""),
    "a kind that is a path": (
        polygons(root="").replace('type="PolyData"', 'type="*["'),
        "0 pieces",
    ),
    "no kind": ("<VTKFile/>", "0 pieces"),
}


@pytest.mark.parametrize(("text", "words"), DAMAGED.values(), ids=DAMAGED)
def test_damaged_polygons_are_refused(tmp_path, text, words):
    path = tmp_path / "a.vtp"
    path.write_text(text)
    if words is None:  # what lies beyond the size that a block says is not unpacked
        assert Surface.read(path).data["T"].tolist() == [0.0]
        return
    with pytest.raises(SurfaceError, match=rf"a.vtp: .*{words}"):
        Surface.read(path)


def test_whole_polygons_are_read_with_what_stands_before_them(tmp_path):
    """Values of vertices and lines come before those of polygons, and belong to no surface."""
    path = tmp_path / "a.vtp"
    for text, value in [
        (polygons(), 300.0),
        (polygons(binary(VALUE)), 300.0),
        (polygons(packed([BLOCK], [1, 8, 0, len(BLOCK)]), root=ZLIB), 300.0),
        (polygons(packed([BLOCK], [1, 64, 8, len(BLOCK)]), root=ZLIB), 300.0),
        (polygons(FIELD.replace("300", "1 2 7"), more=' NumberOfLines="2"'), 7.0),
        (polygons(polygons=POLYGONS.replace("Int64", "UInt32")), 300.0),
    ]:
        path.write_text(text)
        surface = Surface.read(path)
        assert surface.data["T"].tolist() == [value] and surface.areas == pytest.approx([1.0])


GRID = """<VTKFile type="RectilinearGrid"><RectilinearGrid><Piece Extent="0 2 0 1 0 0">
<PointData><DataArray type="Float64" Name="T" format="ascii">0 1 3 10 11 13</DataArray></PointData>
<Coordinates><DataArray type="Float64" Name="x" format="ascii">0 1 3</DataArray>
<DataArray type="Float64" Name="y" format="ascii">0 1</DataArray>
<DataArray type="Float64" Name="z" format="ascii">0</DataArray></Coordinates>
</Piece></RectilinearGrid></VTKFile>"""


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("0 2 0 1 0 0", "0 2 0 1 0", "Extent has 5 numbers, not 6"),
        ("0 2 0 1 0 0", "2 0 0 1 0 0", "Extent 2 0 0 1 0 0 does not ascend"),
        ("0 2 0 1 0 0", "0 9 0 1 0 0", "numbers, not 20"),
        ("0 2 0 1 0 0", "0 99999999 0 99999999 0 0", "more than 1000000000 points"),
        ("0 2 0 1 0 0", "a b c d e f", "invalid literal"),
        ("0 2 0 1 0 0", f"0 {10**30} 0 1 0 0", "Extent is 1"),
        ('Extent="0 2 0 1 0 0"', "", "lacks 'Extent'"),
        ("0 1 3 10 11 13", "0 1 3 10 11", "has 5 numbers, not 6"),
        ("0 1 3 10 11 13", "0 1 3 10 11 nan", "`T` is nan at place 5"),
        (">0 1 3<", ">0 nan 3<", "is not finite|nan at place 1"),
        (">0 1 3<", ">0 1<", "has 2 numbers, not 3"),
        ('Name="y"', 'Name="x"', "names x, x, z"),
        ('<DataArray type="Float64" Name="z" format="ascii">0</DataArray>', "", "2 arrays of"),
        ("Coordinates", "Nowhere", "a RectilinearGrid is neither a grid nor polygons"),
    ],
)
def test_damaged_grids_are_refused(tmp_path, old, new, words):
    path = tmp_path / "a.vtr"
    path.write_text(GRID)
    assert Surface.read(path).data["T"].tolist() == [0, 1, 3, 10, 11, 13]
    assert GRID.count(old) >= 1
    path.write_text(GRID.replace(old, new))
    for read in (Surface.read, Body.read):
        with pytest.raises(SurfaceError, match=f"a.vtr: .*({words})"):
            read(path)


def test_grids_that_would_fill_the_memory_are_refused(tmp_path):
    """Two axes of 30 000 points are 9e8 points."""
    axis = " ".join(map(str, range(30_000)))
    text = GRID.replace("0 2 0 1 0 0", "0 29999 0 29999 0 0")
    text = text.replace(">0 1 3<", f">{axis}<").replace(">0 1<", f">{axis}<")
    text = text[: text.index("<PointData>")] + text[text.index("<Coordinates>") :]
    path = tmp_path / "a.vtr"
    path.write_text(text)
    for read in (Surface.read, Body.read):
        with pytest.raises(SurfaceError, match="900000000 points .allowed: at most 100000000"):
            read(path)


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("cells", [[0, 1, 2, -1]], "corners 0, 1, 2, -1"),
        ("cells", [[0, 1, 2, 4]], "allowed: 0 to 3"),
        ("cells", [[0.0, 1.0, 2.0, 3.0]], "whole numbers"),
        ("cells", [0], "whole numbers of shape"),
        ("points", [[0.0], [1.0], [2.0], [3.0]], r"points of shape \(4, 1\)"),
        ("points", [[0, 0], [1, 0], [1, 1], [0, np.nan]], "point 3 .* not finite"),
        ("q", [np.nan], "`q` is nan at place 0"),
        ("q", [b"text"], "`q` holds"),
        ("time", [[0.0, 1.0]], "`time` of shape"),
    ],
)
def test_damaged_hdf5_is_refused(tmp_path, name, value, words):
    path = tmp_path / "a.h5"
    content = {"points": [[0, 0], [1, 0], [1, 1], [0, 1.0]], "cells": [[0, 1, 2, 3]], "q": [1.0]}
    with h5py.File(path, "w") as file:
        for key, data in {**content, name: value}.items():
            file[key] = data
    with pytest.raises(SurfaceError, match=f"a.h5: .*{words}"):
        Surface.read(path)


def test_hdf5_that_leads_elsewhere_or_is_huge_is_refused(tmp_path):
    path = tmp_path / "a.h5"
    for make, words in [
        (lambda f: f.__setitem__("points", h5py.ExternalLink("/etc/passwd", "/x")), "is a link"),
        (lambda f: f.__setitem__("points", h5py.SoftLink("/nowhere")), "lacks|doesn't exist"),
        (lambda f: f.create_dataset("points", (10**13, 3), chunks=(10, 3)), "bytes of datasets"),
        (lambda f: f.create_dataset("points", (4, 2), external="/etc/passwd"), "in another file"),
    ]:
        with h5py.File(path, "w") as file:
            make(file)
        for read in (Surface.read, read_picture):
            with pytest.raises(SurfaceError, match=f"a.h5: .*({words})"):
                read(path)


def test_pipes_devices_and_folders_are_refused(tmp_path):
    target = Surface.tiles((2, 2), (1.0, 1.0))
    for suffix in ("vtp", "vtu", "csv", "h5", "pvd", "xdmf", "npy", "png"):
        for make in (os.mkfifo, os.mkdir, lambda path: os.symlink("/dev/zero", path)):
            path = tmp_path / f"a.{suffix}"
            make(path)
            for read in (
                Surface.read,
                read_picture,
                read_table,
                read_matrix,
                Body.read,
                lambda path: drop_inputs(path, "drop"),
                lambda path: spray_frames(path, target, window=1.0),
            ):
                with pytest.raises(
                    SurfaceError, match=rf"a.{suffix}: .*(no regular file|a folder)"
                ):
                    read(path)
            os.rmdir(path) if path.is_dir() else os.unlink(path)


def test_pictures_that_cannot_be_read_are_refused(tmp_path):
    huge = b"\x93NUMPY\1\0v\0" + b"{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999,"
    huge += b" 999), }".ljust(128 - len(huge) - 1) + b"\n"
    for name, content in [
        ("a.npy", huge),
        ("b.npy", b"PK\3\4" + bytes(40)),
        ("c.png", b"\x89PNG\r\n\x1a\n" + bytes(40)),
        ("d.csv", b"1,2\n" + b"9" * 200_000 + b',"\n'),
    ]:
        (tmp_path / name).write_bytes(content)
        with pytest.raises(SurfaceError, match=f"{name}: "):
            read_picture(tmp_path / name)
    with zipfile.ZipFile(tmp_path / "e.npy", "w") as file:
        file.writestr("x.npy", b"")
    with pytest.raises(SurfaceError, match="e.npy: "):
        read_picture(tmp_path / "e.npy")


def test_drops_over_more_windows_than_memory_holds_are_refused(tmp_path):
    path = tmp_path / "drops.csv"
    target = Surface.tiles((2, 2), (1.0, 1.0))
    for last in ("1e12", "1e300", "1e17"):
        path.write_text(f"x,y,mass,time\n0,0,1,0\n0,0,1,{last}\n")
        with pytest.raises(SurfaceError, match="drops.csv: 2 drops over .* windows"):
            spray_frames(path, target, window=1e-3)


SQUARE = "0 0 0 1 0 0 1 1 0 0 1 0"


def unstructured(connectivity="0 1 2 3", offsets="4", types="9", points=SQUARE):
    """VTK's XML of cells without fields."""
    arrays = "".join(
        f'<DataArray type="{kind}" Name="{name}" format="ascii">{content}</DataArray>'
        for kind, name, content in [
            ("Int64", "connectivity", connectivity),
            ("Int64", "offsets", offsets),
            ("UInt8", "types", types),
        ]
    )
    counts = f'NumberOfPoints="{len(points.split()) // 3}" NumberOfCells="{len(offsets.split())}"'
    return (
        '<?xml version="1.0"?><VTKFile type="UnstructuredGrid" version="0.1"><UnstructuredGrid>'
        f'<Piece {counts}><Points><DataArray type="Float64" NumberOfComponents="3"'
        f' format="ascii">{points}</DataArray></Points><Cells>{arrays}</Cells></Piece>'
        "</UnstructuredGrid></VTKFile>"
    )


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "is empty"),
        (" ", "is empty"),
        ("<VTKFile", "unclosed token"),
        ('<!DOCTYPE a [<!ENTITY a SYSTEM "file:///etc/passwd">]><a>&a;</a>', "undefined entity"),
        (unstructured(offsets="400"), "the offset 400 of cell 0 lies beyond the 4 numbers of"),
        (unstructured("0 1 2 3 0 1 2", "7 4", "9 5"), "offsets of cells do not ascend"),
        (unstructured(types="200"), "1 of 1 cells are of types that are not read; .* are 200"),
        (unstructured("0 1 2 0 2 3", "3 6", "5 6"), "1 of 2 cells are of types .* are 5, 6"),
        (unstructured(types="9 9"), "array `types`: has 2 numbers, not 1"),
    ],
)
def test_damaged_unstructured_grids_are_refused_with_the_reason(tmp_path, text, words):
    path = tmp_path / "a.vtu"
    path.write_text(unstructured())
    assert Surface.read(path).areas.tolist() == [1.0]
    path.write_text(text)
    with pytest.raises(SurfaceError, match=f"a.vtu: .*{words}"):
        Surface.read(path)


def test_why_meshio_gives_up_is_told(tmp_path, capfd):
    (tmp_path / "a.vtk").write_text("junk")
    with pytest.raises(SurfaceError, match="a.vtk: meshio does not read it as .vtk: Illegal VTK"):
        Surface.read(tmp_path / "a.vtk")
    assert capfd.readouterr() == ("", "")
    with (
        pytest.raises(SurfaceError, match="a.vtk: its reader gave up"),
        reading("a.vtk", SurfaceError),
    ):
        sys.exit(1)


TWO = "0 0 0 1 0 0 1 1 0 0 1 0 "
OVERLAPS = {
    "the same square": unstructured("0 1 2 3 0 1 2 3", "4 8", "9 9"),
    "the same square round the other way": unstructured("0 1 2 3 3 2 1 0", "4 8", "9 9"),
    "with nodes of its own": unstructured("0 1 2 3 4 5 6 7", "4 8", "9 9", 2 * TWO),
    "on one side": unstructured("0 1 2 3 0 1 2", "4 7", "9 5"),
    "inside": unstructured(
        "0 1 2 3 4 5 6", "4 7", "9 5", TWO + "0.4 0.4 0 0.5 0.4 0 0.4 0.5 0"
    ),
    "across": unstructured(
        "0 1 2 3 4 5 6 7", "4 8", "9 9", TWO + "0.4 -1 0 0.6 -1 0 0.6 2 0 0.4 2 0"
    ),
    "of thin cells": unstructured(
        "0 1 2 3 4 5 6 7", "4 8", "9 9", 2 * "0 0 0 1 0 0 1 1e-4 0 0 1e-4 0 "
    ),
}  # fmt: skip


@pytest.mark.parametrize("text", OVERLAPS.values(), ids=OVERLAPS)
def test_cells_that_overlap_are_refused(tmp_path, text):
    """What lies on them would count twice."""
    path = tmp_path / "a.vtu"
    path.write_text(text)
    with pytest.raises(SurfaceError, match="a.vtu: cells 0 and 1 overlap at"):
        Surface.read(path)


def test_cells_that_share_sides_or_leave_seams_are_read(tmp_path):
    """Cells of very different size side by side, hanging nodes, and a seam of a hundredth."""
    path = tmp_path / "a.vtu"
    small = "1 0 0 1.001 0 0 1.001 1 0 1 1 0 1 0.2 0 2 0.2 0 2 0.5 0 1 0.5 0 "
    for shift in ("", "0 -1 0 0.9 -1 0 0.9 0.005 0 0 0.005 0 "):
        nodes = TWO + small.replace("1 0.2", "1.001 0.2").replace("1 0.5", "1.001 0.5") + shift
        many = len(nodes.split()) // 12
        numbers = " ".join(map(str, range(4 * many)))
        ends = " ".join(str(4 * k + 4) for k in range(many))
        path.write_text(unstructured(numbers, ends, " ".join(many * ["9"]), nodes))
        assert Surface.read(path).shape == (many,)
