"""VTK's XML files of grids and polygons (.vtr, .vts, .vtp) and their series (.pvd).

Arrays in the file as text or base64, or appended raw or in base64; compressed by zlib or not.
Source: *VTK File Formats*, https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html.
"""

from __future__ import annotations

import base64
import xml.etree.ElementTree as ElementTree
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .errors import SurfaceError

TYPES = {
    "Float64": "f8", "Float32": "f4", "Int64": "i8", "Int32": "i4", "Int16": "i2", "Int8": "i1",
    "UInt64": "u8", "UInt32": "u4", "UInt16": "u2", "UInt8": "u1",
}  # fmt: skip


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
    try:
        sets = ElementTree.parse(path).getroot().iter("DataSet")
        found = [(float(s.attrib["timestep"]), path.parent / s.attrib["file"]) for s in sets]
    except (ElementTree.ParseError, KeyError, ValueError) as error:
        raise SurfaceError(f"{path}: no list of VTK files: {error}") from None
    if not found:
        raise SurfaceError(f"{path}: lists no file")
    return found


def read_vtk_xml(path: Path) -> VtkFile:
    """Reads a file of one piece."""
    content = path.read_bytes()
    head, appended = _split(content)
    try:
        root = ElementTree.fromstring(head)
    except ElementTree.ParseError as error:
        raise SurfaceError(f"{path}: {error}") from None
    kind = root.attrib.get("type", "")
    pieces = root.findall(f"./{kind}/Piece")
    if len(pieces) != 1:
        raise SurfaceError(f"{path}: {len(pieces)} pieces, where one is read")
    decode = _Decoder(path, root, appended)
    sections = {}
    for name in ("PointData", "CellData", "Points", "Coordinates", "Polys"):
        arrays = pieces[0].findall(f"./{name}/DataArray")
        sections[name] = {a.attrib.get("Name", name): decode(a) for a in arrays}
    extent = [int(n) for n in pieces[0].attrib.get("Extent", "").split()]
    dimensions = tuple(b - a + 1 for a, b in zip(extent[::2], extent[1::2], strict=True)) or None
    geometry = {
        **sections["Coordinates"],
        **{f"Polys.{k}": v for k, v in sections["Polys"].items()},
    }
    if sections["Points"]:
        geometry["Points"] = next(iter(sections["Points"].values()))
    return VtkFile(kind, dimensions, sections["PointData"], sections["CellData"], geometry)


def _split(content: bytes) -> tuple[bytes, bytes]:
    """The XML without what is appended, which need not be text."""
    begin = content.find(b"<AppendedData")
    if begin < 0:
        return content, b""
    first = content.index(b"_", content.index(b">", begin)) + 1
    end = content.rfind(b"</AppendedData>")
    return content[:first] + content[end:], content[first:end]


class _Decoder:
    def __init__(self, path: Path, root: ElementTree.Element, appended: bytes) -> None:
        self.path, self.appended = path, appended
        self.order = "<" if root.attrib.get("byte_order", "LittleEndian") == "LittleEndian" else ">"
        self.header = np.dtype(self.order + TYPES[root.attrib.get("header_type", "UInt32")])
        compressor = root.attrib.get("compressor")
        if compressor not in (None, "vtkZLibDataCompressor"):
            raise SurfaceError(f"{path}: compressed by {compressor}; zlib alone is read")
        self.is_compressed = compressor is not None
        node = root.find("AppendedData")
        self.is_raw = node is not None and node.attrib.get("encoding", "base64") == "raw"

    def __call__(self, array: ElementTree.Element) -> np.ndarray:
        name = array.attrib.get("Name", "")
        kind = TYPES.get(array.attrib.get("type", ""))
        if kind is None:
            raise SurfaceError(f"{self.path}: array `{name}` of type {array.attrib.get('type')}")
        if array.attrib["format"] == "ascii":
            values = np.array("".join(array.itertext()).split(), dtype=kind)
        else:
            try:
                values = np.frombuffer(self._bytes(array), dtype=self.order + kind)
            except (ValueError, IndexError, zlib.error) as error:
                raise SurfaceError(f"{self.path}: array `{name}`: {error}") from None
        components = int(array.attrib.get("NumberOfComponents", 1))
        return values.reshape(-1, components) if components > 1 else values

    def _bytes(self, array: ElementTree.Element) -> bytes:
        if array.attrib["format"] == "appended":
            data = self.appended[int(array.attrib["offset"]) :]
            if self.is_raw:
                return self._blocks(lambda start, size: data[start : start + size])
        else:
            data = (array.text or "").strip().encode()
        return self._blocks_of_base64(data)

    def _blocks(self, read: Callable[[int, int], bytes]) -> bytes:
        """Bytes of an array whose header and data `read` gives from one stream."""
        size = self.header.itemsize
        first = np.frombuffer(read(0, size), self.header)[0]
        if not self.is_compressed:
            return read(size, int(first))
        sizes = np.frombuffer(read(3 * size, int(first) * size), self.header)
        begin = (3 + int(first)) * size
        ends = begin + np.cumsum(sizes)
        return b"".join(
            zlib.decompress(read(int(e - s), int(s))) for s, e in zip(sizes, ends, strict=True)
        )

    def _blocks_of_base64(self, data: bytes) -> bytes:
        """Header and data are encoded apart where they are compressed."""
        size = self.header.itemsize

        def read(text: bytes, start: int, many: int) -> bytes:
            first = 4 * (start // 3)
            last = 4 * -(-(start + many) // 3)
            return base64.b64decode(text[first:last])[start - 3 * (start // 3) :][:many]

        if not self.is_compressed:
            return self._blocks(lambda start, many: read(data, start, many))
        blocks = int(np.frombuffer(read(data, 0, size), self.header)[0])
        head = (3 + blocks) * size
        rest = data[4 * -(-head // 3) :]
        return self._blocks(
            lambda start, many: (
                read(data, start, many) if start < head else read(rest, start - head, many)
            )
        )
