"""Reads the ParaView files that units and `impinge run` write."""

import struct
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np


def read(path: Path) -> dict[str, np.ndarray]:
    """The arrays of a ParaView file of raw appended doubles by name."""
    raw = path.read_bytes()
    start = raw.index(b"<AppendedData")
    begin = raw.index(b"_", raw.index(b">", start)) + 1
    arrays = {}
    for array in ET.fromstring(raw[:start] + b"</VTKFile>").iter("DataArray"):
        if array.get("type") != "Float64":
            continue
        at = begin + int(array.get("offset"))
        (size,) = struct.unpack_from("<Q", raw, at)
        width = int(array.get("NumberOfComponents", 1))
        values = np.frombuffer(raw, "<f8", size // 8, at + 8)
        arrays[array.get("Name")] = values.reshape(-1, width) if width > 1 else values
    return arrays


def files(folder: Path, body: str) -> dict[float, Path]:
    """The files of a body's series by their times [s]."""
    entries = ET.parse(folder / f"{body}.pvd").iter("DataSet")
    return {float(entry.get("timestep")): folder / entry.get("file") for entry in entries}
