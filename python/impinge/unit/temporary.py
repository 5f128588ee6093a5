"""Temporary folders that live as long as their process, and those of killed processes.

A folder is named `impinge-PID-…` and holds a file `.lock`. It is locked by `flock` as long as the
process lives, or one that it passed the descriptor to. The system lets go of the lock however the
process ends, so nobody uses a folder whose lock is free.
"""

from __future__ import annotations

import atexit
import os
import re
import shutil
import stat
import tempfile
from pathlib import Path

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

_NAME = re.compile(r"impinge-\d+-[a-z0-9_]{8}")
_LOCK = ".lock"


class LockedFolder:
    """A folder in `parent`, which goes when it is closed; those of killed processes go before.

    `lock` is a descriptor to be passed to processes that use the folder, too; -1 where there are no
    locks.
    """

    def __init__(self, parent: Path):
        sweep(parent)
        self.process = os.getpid()
        self.path = Path(tempfile.mkdtemp(prefix=f"impinge-{self.process}-", dir=parent))
        self.lock = _lock(self.path)

    def close(self) -> None:
        """Removes the folder; forked processes leave it to their parent."""
        if self.process == os.getpid() and self.path.exists():
            shutil.rmtree(self.path, ignore_errors=True)
            if self.lock >= 0:
                os.close(self.lock)
            self.lock = -1

    def __enter__(self) -> LockedFolder:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


_OWN: dict[str, LockedFolder] = {}


def temporary_folder() -> LockedFolder:
    """The folder of this process, which goes when it ends; forked processes share it."""
    if not _OWN:
        folder = LockedFolder(Path(tempfile.gettempdir()))
        _OWN["folder"] = folder
        atexit.register(folder.close)
    return _OWN["folder"]


def sweep(parent: Path) -> None:
    """Removes folders of this user in `parent` whose processes were killed. Follows no links."""
    if fcntl is None:
        return
    try:
        names = [name for name in os.listdir(parent) if _NAME.fullmatch(name)]
    except OSError:
        return
    for name in names:
        _remove_if_unused(parent / name)


def _remove_if_unused(folder: Path) -> None:
    try:
        status = folder.lstat()
        if not stat.S_ISDIR(status.st_mode) or status.st_uid != os.geteuid():
            return
        flags = os.O_RDWR | os.O_NOFOLLOW | os.O_NONBLOCK
        lock = os.open(folder / _LOCK, flags)
    except OSError:  # not there yet, gone, or none of ours
        return
    try:
        if stat.S_ISREG(os.fstat(lock).st_mode):
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            shutil.rmtree(folder, ignore_errors=True)
    except OSError:
        pass  # in use
    finally:
        os.close(lock)


def _lock(folder: Path) -> int:
    """Puts a file into a folder that is locked when others first see it under its name."""
    if fcntl is None:
        return -1
    unnamed = folder / f"{_LOCK}.new"
    lock = os.open(unnamed, os.O_RDWR | os.O_CREAT | os.O_EXCL, 0o600)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:  # a file system without locks: the folder is never swept
        os.close(lock)
        return -1
    os.rename(unnamed, folder / _LOCK)
    return lock
