"""Reads rectilinear grids (.vtr) with raw appended doubles, as `impinge run` writes them."""

import struct
import xml.etree.ElementTree as ET

import numpy as np


def read(path):
    """The arrays of a file by name; the nodes along the axes are `x`, `y`, `z`."""
    raw = path.read_bytes()
    start = raw.index(b"<AppendedData")
    begin = raw.index(b"_", raw.index(b">", start)) + 1
    head = ET.fromstring(raw[:start] + b"</VTKFile>")
    assert head.get("header_type") == "UInt64" and head.get("byte_order") == "LittleEndian"
    arrays = {}
    for array in head.iter("DataArray"):
        assert array.get("type") == "Float64" and array.get("format") == "appended"
        at = begin + int(array.get("offset"))
        (size,) = struct.unpack_from("<Q", raw, at)
        values = np.frombuffer(raw, "<f8", size // 8, at + 8)
        width = int(array.get("NumberOfComponents", 1))
        arrays[array.get("Name")] = values.reshape(-1, width) if width > 1 else values
    return arrays
