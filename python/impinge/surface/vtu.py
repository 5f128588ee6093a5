"""Cells of VTK's unstructured grids (.vtu), looked at before meshio reads them.

meshio leaves out cells of types that it does not know, and takes offsets as they come. Source: as
of `vtk_xml`.
"""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..reading import read_bytes
from .vtk_xml import ZLIB, Decoder, indices, split, whole


@dataclass(frozen=True)
class VtuCells:
    """How many cells a file holds, and of which of VTK's types; none where that is unknown."""

    count: int
    types: tuple[int, ...]


def check_vtu(path: Path) -> VtuCells | None:
    """Raises `ValueError` for what is no XML, and for offsets that lie beyond their connectivity.

    Returns nothing of files that are packed in another way than by zlib.
    """
    head, appended = split(read_bytes(path))
    if not head.strip():
        raise ValueError("is empty")
    root = ElementTree.fromstring(head)
    if root.attrib.get("compressor", ZLIB) != ZLIB:
        return None
    decode = Decoder(root, appended)
    count, types = 0, set()
    for piece in root.findall("./UnstructuredGrid/Piece"):
        many = whole("NumberOfCells", piece.attrib["NumberOfCells"])
        arrays = {a.attrib.get("Name", ""): a for a in piece.findall("./Cells/DataArray")}
        if not many or not arrays:
            continue
        _check_offsets(
            indices("offsets", decode(arrays["offsets"], many)),
            len(decode(arrays["connectivity"], None)),
        )
        count += many
        types |= set(indices("types", decode(arrays["types"], many)).tolist())
    return VtuCells(count, tuple(sorted(types)))


def _check_offsets(offsets: np.ndarray, nodes: int) -> None:
    if (np.diff(offsets, prepend=0) < 0).any():
        raise ValueError("offsets of cells do not ascend")
    if offsets[-1] > nodes:
        beyond = int(np.flatnonzero(offsets > nodes)[0])
        raise ValueError(
            f"the offset {offsets[beyond]} of cell {beyond} lies beyond the {nodes} numbers of the"
            " cells' connectivity"
        )
