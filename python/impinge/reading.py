"""Reading files of strangers: errors are the package's own, with the file and the reason."""

from __future__ import annotations

import json
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO, NoReturn

from impinge.errors import ImpingeError

# Bytes of a scene and of a file of cells, at most
LARGEST_SCENE = 16_000_000
LARGEST_JSON = 256_000_000


@contextmanager
def reading(source: object, kind: type[ImpingeError]) -> Iterator[None]:
    """Turns whatever a reader raises into `kind` with `source` and the reason.

    Errors of the package itself that name the source pass as they are.
    """
    try:
        yield
    except ImpingeError as error:
        if not isinstance(error, kind) or str(error).startswith(str(source)):
            raise
        raise kind(f"{source}: {error}") from error
    except FileNotFoundError as error:
        raise kind(f"{source}: no such file") from error
    except (Exception, SystemExit) as error:  # of readers of many formats: anything
        raise kind(f"{source}: {reason(error)}") from error


def reason(error: BaseException) -> str:
    """Returns the reason of an error in words, whatever its kind."""
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    if isinstance(error, KeyError):
        return f"lacks {error}"
    if isinstance(error, RecursionError):
        return "is nested too deeply"
    if isinstance(error, SystemExit):  # its code is no reason
        return "its reader gave up without a reason"
    if isinstance(error, MemoryError):
        return f"takes more memory than there is {error}".rstrip()
    return str(error).strip() or type(error).__name__


def open_file(path: Path) -> BinaryIO:
    """Opens a regular file; raises `OSError` for pipes, devices and folders without a wait."""
    descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0))
    try:
        mode = os.fstat(descriptor).st_mode
        if not stat.S_ISREG(mode):
            what = "a folder" if stat.S_ISDIR(mode) else "no regular file"
            raise OSError(f"is {what} (allowed: regular files)")
        return os.fdopen(descriptor, "rb")
    except BaseException:
        os.close(descriptor)
        raise


def read_bytes(path: Path, most: int | None = None) -> bytes:
    """Returns the content of a regular file of at most `most` bytes."""
    with open_file(path) as file:
        content = file.read(-1 if most is None else most + 1)
    if most is not None and len(content) > most:
        raise OSError(f"has more than {most} bytes (allowed: at most {most})")
    return content


def parse_json(content: bytes) -> Any:
    """Returns the value of a JSON text; raises `ValueError` for numbers that are not finite."""

    def refuse(word: str) -> NoReturn:
        raise ValueError(f"the number {word} is not finite")

    def number(word: str) -> float:
        value = float(word)
        if value in (float("inf"), float("-inf")):
            refuse(word)
        return value

    return json.loads(content, parse_constant=refuse, parse_float=number)
