"""The zip file of a unit: judged by its directory before anything is unpacked, and then unpacked.

The limits are those of `build-fmu --lint`.
"""

from __future__ import annotations

import os
import re
import stat
import struct
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from impinge.errors import UnitError
from impinge.reading import open_file, reading

# Bytes of the file, entries, bytes of one of them and of all when unpacked, at most
LARGEST_FILE = 1 << 32
MOST_ENTRIES = 200_000
LARGEST_ENTRY = 1 << 29
MOST_UNPACKED = 1 << 31
# Bytes of an entry from which on it may be at most so many times as large as it is packed
JUDGED_RATIO = 1 << 26
MOST_RATIO = 100
# Bytes of the directory, at most: paths of 160 bytes for that many entries
_LARGEST_DIRECTORY = 1 << 25

_END = struct.Struct("<4s4H2LH")  # APPNOTE.TXT of PKWARE, section 4.3.16
_LONGEST_END = 65_535 + _END.size
_BLOCK = 1 << 20


@contextmanager
def open_archive(path: Path, source: object) -> Iterator[zipfile.ZipFile]:
    """Opens the zip file of a unit; raises `UnitError` with `source` for one that is out of limits.

    Refused are links, paths that stand twice or lead out of the unit, entries that are encrypted,
    and more than the limits above.
    """
    with reading(source, UnitError), open_file(path) as file:
        _check_end(file)
        with zipfile.ZipFile(file) as archive:
            _check_entries(archive.infolist())
            yield archive


def unpack(archive: zipfile.ZipFile, folder: Path) -> None:
    """Unpacks all entries into a folder that does not exist yet."""
    folder.mkdir(parents=True)
    for entry in archive.infolist():
        target = folder / entry.filename
        if entry.is_dir():
            target.mkdir(parents=True, exist_ok=True)
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        with open(target, "xb") as out:
            _copy(archive, entry, out)


def _copy(archive: zipfile.ZipFile, entry: zipfile.ZipInfo, out: BinaryIO) -> None:
    written = 0
    with archive.open(entry) as content:
        while block := content.read(_BLOCK):
            written += len(block)
            out.write(block)
    if written != entry.file_size:
        said = f"{written} bytes, where the directory says {entry.file_size}"
        raise ValueError(f"{entry.filename}: has {said}")


def _check_end(file: BinaryIO) -> None:
    """Looks at the size of the directory before it is read whole."""
    size = file.seek(0, os.SEEK_END)
    if size > LARGEST_FILE:
        raise ValueError(f"has {size} bytes (allowed: at most {LARGEST_FILE})")
    file.seek(max(0, size - _LONGEST_END))
    tail = file.read()
    at = tail.rfind(b"PK\5\6")
    if at >= 0 and len(tail) - at >= _END.size:
        *_, length, _, _ = _END.unpack_from(tail, at)
        if tail[max(0, at - 76) :].startswith(b"PK\6\6"):  # section 4.3.14, of large files
            (length,) = struct.unpack_from("<Q", tail, at - 36)
        if length > _LARGEST_DIRECTORY:
            allowed = f"at most {_LARGEST_DIRECTORY}"
            raise ValueError(f"its directory has {length} bytes (allowed: {allowed})")
    file.seek(0)


def _check_entries(entries: list[zipfile.ZipInfo]) -> None:
    if len(entries) > MOST_ENTRIES:
        raise ValueError(f"{len(entries)} entries (allowed: at most {MOST_ENTRIES})")
    seen: set[str] = set()
    for entry in entries:
        if wrong := _fault(entry):
            raise ValueError(f"{_shown(entry)}: {wrong}")
        path = entry.filename.rstrip("/")
        if path in seen:
            raise ValueError(f"{_shown(entry)}: the path stands twice in the zip file")
        seen.add(path)
    unpacked = sum(entry.file_size for entry in entries)
    if unpacked > MOST_UNPACKED:
        raise ValueError(f"{unpacked} bytes when unpacked (allowed: at most {MOST_UNPACKED})")


def _fault(entry: zipfile.ZipInfo) -> str | None:
    kind = stat.S_IFMT(entry.external_attr >> 16)
    size, packed = entry.file_size, entry.compress_size
    path = entry.orig_filename
    if entry.flag_bits & 0x1:
        return "is encrypted (allowed: entries that anyone can read)"
    if kind == stat.S_IFLNK:
        return "is a link (allowed: files and folders)"
    if kind not in (0, stat.S_IFREG, stat.S_IFDIR):
        return "is no file (allowed: files and folders)"
    if _leads_out(path):
        return "its path leads out of the unit (allowed: relative paths with forward slashes)"
    if size > LARGEST_ENTRY:
        return f"{size} bytes when unpacked (allowed: at most {LARGEST_ENTRY})"
    if size > JUDGED_RATIO and size > MOST_RATIO * packed:
        return (
            f"{size} bytes of {packed} packed ones (allowed: at most {MOST_RATIO} times as many"
            f" above {JUDGED_RATIO} bytes)"
        )
    return None


def _leads_out(path: str) -> bool:
    is_absolute = path.startswith("/") or re.match(r"[A-Za-z]:", path) is not None
    return not path or is_absolute or "\\" in path or "\0" in path or ".." in path.split("/")


def _shown(entry: zipfile.ZipInfo) -> str:
    return entry.orig_filename[:200].encode("unicode_escape").decode() or "an entry without path"
