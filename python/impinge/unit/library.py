"""A unit's shared library, looked at before the system maps it.

A file that was cut short loads, and kills the process with SIGBUS when what is missing is read.
Source: *System V ABI*, chapters 4 and 5 (ELF header, sections, program header).
"""

import os
import struct
from pathlib import Path
from typing import BinaryIO

# By class: the header from e_type on, and places of p_offset and p_filesz in a program header
_HEADERS = {1: ("HHIIIIIHHHHHH", 4, 16, "I"), 2: ("HHIQQQIHHHHHH", 8, 32, "Q")}
_IDENTITY = 16


def check_library(path: Path) -> None:
    """Raises `ValueError` for an ELF file that is shorter than its headers say.

    Files of other formats are left to the system.
    """
    with open(path, "rb") as file:
        size = os.fstat(file.fileno()).st_size
        identity = file.read(_IDENTITY)
        if not identity.startswith(b"\x7fELF"):
            return
        needed = _end(file, identity, size)
    if needed > size:
        raise ValueError(f"is cut short: it has {size} bytes of at least {needed}")


def _end(file: BinaryIO, identity: bytes, size: int) -> int:
    """Bytes up to the end of the last segment and of the table of sections."""
    form = _HEADERS.get(identity[4]) if len(identity) == _IDENTITY else None
    if form is None:
        return 0
    fields, offset_at, length_at, word = form
    order = ">" if identity[5] == 2 else "<"
    header = struct.Struct(order + fields)
    content = file.read(header.size)
    if len(content) < header.size:
        return _IDENTITY + header.size
    _, _, _, _, programs, sections, _, _, step, many, section, count, _ = header.unpack(content)
    ends = [programs + step * many, sections + section * count]
    if ends[0] > size or step < length_at + struct.calcsize(word):
        return max(ends)
    file.seek(programs)
    table = file.read(step * many)
    for begin in range(0, len(table), step):
        (offset,) = struct.unpack_from(order + word, table, begin + offset_at)
        (length,) = struct.unpack_from(order + word, table, begin + length_at)
        ends.append(offset + length)
    return max(ends)
