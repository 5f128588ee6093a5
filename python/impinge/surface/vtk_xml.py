"""VTK's XML files of grids and polygons (.vtr, .vts, .vtp) and their series (.pvd).

Arrays in the file as text or base64, or appended raw or in base64; compressed by zlib or not. An
array holds as many numbers as its piece says there are points or cells, or the file is refused.
Source: *VTK File Formats*, https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html.
"""

from __future__ import annotations

import base64
import xml.etree.ElementTree as ElementTree
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from math import prod
from pathlib import Path

import numpy as np

from ..reading import read_bytes, reading
from .errors import SurfaceError

TYPES = {
    "Float64": "f8", "Float32": "f4", "Int64": "i8", "Int32": "i4", "Int16": "i2", "Int8": "i1",
    "UInt64": "u8", "UInt32": "u4", "UInt16": "u2", "UInt8": "u1",
}  # fmt: skip
ZLIB = "vtkZLibDataCompressor"
# Points or cells of a piece, at most
MOST_PLACES = 10**9
# Components of an array, at most
_MOST_COMPONENTS = 1000


@dataclass(frozen=True)
class VtkFile:
    """What a file holds: its kind, the sizes of its grid, and arrays by name."""

    kind: str
    dimensions: tuple[int, int, int] | None
    points: dict[str, np.ndarray]
    cells: dict[str, np.ndarray]
    geometry: dict[str, np.ndarray]


def read_pvd(path: Path) -> list[tuple[float, Path]]:
    """Times [s] and files of a series, in their order."""
    with reading(f"{path}: no list of VTK files", SurfaceError):
        sets = ElementTree.fromstring(read_bytes(path)).iter("DataSet")
        found = [(float(s.attrib["timestep"]), path.parent / s.attrib["file"]) for s in sets]
    if not found:
        raise SurfaceError(f"{path}: lists no file")
    if not np.isfinite([time for time, _ in found]).all():
        raise SurfaceError(f"{path}: a time is not finite")
    return found


def read_vtk_xml(path: Path) -> VtkFile:
    """Reads a file of one piece."""
    with reading(path, SurfaceError):
        return _read(path)


def _read(path: Path) -> VtkFile:
    head, appended = split(read_bytes(path))
    root = ElementTree.fromstring(head)
    kind = root.attrib.get("type", "")
    pieces = root.findall(f"./{kind}/Piece") if kind.isidentifier() else []
    if len(pieces) != 1:
        raise SurfaceError(f"{path}: {len(pieces)} pieces, where one is read")
    size = _Size.of(kind, pieces[0])
    decode = Decoder(root, appended)
    sections = {}
    for name in ("PointData", "CellData", "Points"):
        arrays = pieces[0].findall(f"./{name}/DataArray")
        many = size.before_and_cells if name == "CellData" else size.points
        first = size.before if name == "CellData" else 0
        sections[name] = {a.attrib.get("Name", name): decode(a, many)[first:] for a in arrays}
    geometry = _coordinates(pieces[0], decode, size.dimensions)
    geometry |= _polygons(pieces[0], decode, size.cells) if kind == "PolyData" else {}
    if sections["Points"]:
        geometry["Points"] = next(iter(sections["Points"].values()))
        if geometry["Points"].shape[1:] != (3,):
            raise ValueError("points without three coordinates")
    return VtkFile(kind, size.dimensions, sections["PointData"], sections["CellData"], geometry)


@dataclass(frozen=True)
class _Size:
    """Counts of points and cells that a piece states, and of points along each index of a grid.

    `before` are vertices and lines, whose values stand before those of cells. None is what a piece
    does not say.
    """

    points: int | None
    cells: int | None
    dimensions: tuple[int, int, int] | None
    before: int = 0

    @property
    def before_and_cells(self) -> int | None:
        return None if self.cells is None else self.before + self.cells

    @classmethod
    def of(cls, kind: str, piece: ElementTree.Element) -> _Size:
        if kind in ("StructuredGrid", "RectilinearGrid"):
            ends = [whole("Extent", word, least=None) for word in piece.attrib["Extent"].split()]
            if len(ends) != 6:
                raise ValueError(f"Extent has {len(ends)} numbers, not 6")
            low, high = ends[::2], ends[1::2]
            if any(a > b for a, b in zip(low, high, strict=True)):
                raise ValueError(f"Extent {piece.attrib['Extent']} does not ascend")
            x, y, z = (b - a + 1 for a, b in zip(low, high, strict=True))
            cells = prod(max(n - 1, 1) for n in (x, y, z))
            size = cls(x * y * z, cells, (x, y, z))
        else:
            points, cells, vertices, lines, strips = (
                whole(name, piece.attrib[name]) if name in piece.attrib else None
                for name in map(
                    "NumberOf{}".format, ("Points", "Polys", "Verts", "Lines", "Strips")
                )
            )
            if strips:
                raise ValueError(f"holds {strips} strips (allowed: polygons)")
            size = cls(points, cells, None, (vertices or 0) + (lines or 0))
        if max(size.points or 0, size.cells or 0) > MOST_PLACES:
            raise ValueError(f"more than {MOST_PLACES} points or cells")
        return size


def whole(name: str, word: str, least: int | None = 0) -> int:
    value = int(word)
    if (least is not None and value < least) or abs(value) > 2 * MOST_PLACES:
        raise ValueError(f"{name} is {word[:40]}")
    return value


def _coordinates(
    piece: ElementTree.Element, decode: Decoder, dimensions: tuple[int, int, int] | None
) -> dict[str, np.ndarray]:
    """Arrays of coordinates along the axes of a rectilinear grid."""
    arrays = piece.findall("./Coordinates/DataArray")
    if not arrays or dimensions is None:
        return {}
    if len(arrays) != 3:
        raise ValueError(f"{len(arrays)} arrays of coordinates, not 3")
    named = [array.attrib.get("Name", axis) for array, axis in zip(arrays, "xyz", strict=True)]
    if len(set(named)) < 3:
        raise ValueError(f"arrays of coordinates have the names {', '.join(named)}")
    return {n: decode(a, many) for n, a, many in zip(named, arrays, dimensions, strict=True)}


def _polygons(
    piece: ElementTree.Element, decode: Decoder, cells: int | None
) -> dict[str, np.ndarray]:
    """Offsets and nodes of polygons, of which there are as many as the last offset says."""
    arrays = {a.attrib.get("Name", ""): a for a in piece.findall("./Polys/DataArray")}
    offsets = indices("offsets", decode(arrays["offsets"], cells))
    if (np.diff(offsets, prepend=0) < 0).any():
        raise ValueError("offsets of polygons do not ascend")
    many = int(offsets[-1]) if len(offsets) else 0
    nodes = indices("connectivity", decode(arrays["connectivity"], many))
    return {"Polys.offsets": offsets, "Polys.connectivity": nodes}


def indices(name: str, values: np.ndarray) -> np.ndarray:
    if values.ndim != 1 or values.dtype.kind not in "iu":
        raise ValueError(f"array `{name}` holds no whole numbers")
    return values.astype(np.int64)


def split(content: bytes) -> tuple[bytes, bytes]:
    """The XML without what is appended, which need not be text."""
    begin = content.find(b"<AppendedData")
    if begin < 0:
        return content, b""
    first = content.find(b"_", content.find(b">", begin)) + 1
    end = content.rfind(b"</AppendedData>")
    if not begin < first <= end:
        raise ValueError("AppendedData is cut off")
    return content[:first] + content[end:], content[first:end]


class Decoder:
    """Reads arrays of a file; raises `ValueError` where one has not the numbers it should have."""

    def __init__(self, root: ElementTree.Element, appended: bytes) -> None:
        self.appended = appended
        self.order = "<" if root.attrib.get("byte_order", "LittleEndian") == "LittleEndian" else ">"
        header = root.attrib.get("header_type", "UInt32")
        if header not in ("UInt32", "UInt64"):
            raise ValueError(f"header_type is {header} (allowed: UInt32, UInt64)")
        self.header = np.dtype(self.order + TYPES[header])
        compressor = root.attrib.get("compressor")
        if compressor not in (None, ZLIB):
            raise ValueError(f"compressed by {compressor}; zlib alone is read")
        self.is_compressed = compressor is not None
        node = root.find("AppendedData")
        self.is_raw = node is not None and node.attrib.get("encoding", "base64") == "raw"

    def __call__(self, array: ElementTree.Element, many: int | None) -> np.ndarray:
        """The array of so many places, shape (many,) or (many, components); of any number if none
        is said.
        """
        name = array.attrib.get("Name", "")
        try:
            return self._read(array, many)
        except (ValueError, IndexError, KeyError, OverflowError, zlib.error) as error:
            wrong = f"lacks {error}" if isinstance(error, KeyError) else str(error)
            raise ValueError(f"array `{name}`: {wrong}") from None

    def _read(self, array: ElementTree.Element, many: int | None) -> np.ndarray:
        kind = TYPES.get(array.attrib.get("type", ""))
        if kind is None:
            raise ValueError(f"is of type {array.attrib.get('type')}")
        components = whole(
            "NumberOfComponents", array.attrib.get("NumberOfComponents", "1"), least=1
        )
        if components > _MOST_COMPONENTS:
            raise ValueError(f"{components} components (allowed: at most {_MOST_COMPONENTS})")
        expected = None if many is None else many * components
        if array.attrib["format"] == "ascii":
            values = np.array(_own_text(array).split(), dtype=kind)
        else:
            length = None if expected is None else expected * np.dtype(kind).itemsize
            values = np.frombuffer(self._bytes(array, length), dtype=self.order + kind)
        if expected is not None and len(values) != expected:
            raise ValueError(f"has {len(values)} numbers, not {expected}")
        return values.reshape(-1, components) if components > 1 else values

    def _bytes(self, array: ElementTree.Element, length: int | None) -> bytes:
        form = array.attrib["format"]
        if length == 0:
            return b""
        if form == "appended":
            offset = whole("offset", array.attrib["offset"])
            data = self.appended[offset:]
            if self.is_raw:
                return self._blocks(lambda start, size: data[start : start + size], length)
        elif form == "binary":
            data = _own_text(array).strip().encode()
        else:
            raise ValueError(f"its format is {form} (allowed: ascii, binary, appended)")
        return self._blocks_of_base64(data, length)

    def _blocks(self, read: Callable[[int, int], bytes], length: int | None) -> bytes:
        """Bytes of an array whose header and data `read` gives from one stream."""
        size = self.header.itemsize
        first = int(self._header(read(0, size), 1)[0])
        if not self.is_compressed:
            if length is not None and first != length:
                raise ValueError(f"says it has {first} bytes, not {length}")
            return _whole_bytes(read(size, first), first)
        if first == 0:
            return b""
        if length is not None and first > length:  # no block is empty
            raise ValueError(f"says it has {first} blocks for {length} bytes")
        block, last, *_ = self._header(read(size, 2 * size), 2)
        said = int(block) * (first - bool(last)) + int(last)
        if length is not None and said != length:
            raise ValueError(f"says it has {said} bytes, not {length}")
        sizes = self._header(read(3 * size, first * size), first)
        begin = (3 + first) * size
        ends = begin + np.cumsum(sizes, dtype=np.uint64)
        parts = []
        for packed, end in zip(sizes, ends, strict=True):
            content = _whole_bytes(read(int(end) - int(packed), int(packed)), int(packed))
            parts.append(zlib.decompressobj().decompress(content, max(int(block), int(last), 1)))
        return _whole_bytes(b"".join(parts), said)

    def _header(self, data: bytes, many: int) -> np.ndarray:
        return np.frombuffer(_whole_bytes(data, many * self.header.itemsize), self.header)

    def _blocks_of_base64(self, data: bytes, length: int | None) -> bytes:
        """Header and data are encoded apart where they are compressed."""
        size = self.header.itemsize

        def read(text: bytes, start: int, many: int) -> bytes:
            first = 4 * (start // 3)
            last = 4 * -(-(start + many) // 3)
            return base64.b64decode(text[first:last])[start - 3 * (start // 3) :][:many]

        if not self.is_compressed:
            return self._blocks(lambda start, many: read(data, start, many), length)
        blocks = int(self._header(read(data, 0, size), 1)[0])
        head = (3 + blocks) * size
        rest = data[4 * -(-head // 3) :]
        return self._blocks(
            lambda start, many: (
                read(data, start, many) if start < head else read(rest, start - head, many)
            ),
            length,
        )


def _own_text(array: ElementTree.Element) -> str:
    """The text of an array without that of elements inside, which hold what is known about it."""
    return "".join([array.text or "", *(child.tail or "" for child in array)])


def _whole_bytes(data: bytes, length: int) -> bytes:
    if len(data) != length:
        raise ValueError(f"has {len(data)} bytes, not {length}")
    return data
