"""Rows on a Dask cluster: each thread of its workers has a process of its own for them.

A row that kills its process leaves Dask's worker alone. The unit travels as bytes, so that workers
need this package but neither the unit's file nor the programs that build it.
"""

from __future__ import annotations

import atexit
import io
import shutil
import tempfile
import threading
import uuid
import zipfile
from collections import deque
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import cloudpickle

from impinge.errors import extra, need
from impinge.unit.temporary import temporary_folder

from .journal import Finished
from .processes import Batch, Prepare, Server
from .runner import Experiment, Row
from .scenes import Variant
from .worker import Job

CHUNK = 0.5  # s of work that a task has, about
END = 10.0  # s that tasks may take to return what they have
FIRST = 1  # rows of a task while it is not known how long they take


class Cluster:
    """Rows on the cluster at an address, or on that of a client; iterating yields what comes."""

    def __init__(
        self,
        folder: Path,
        experiment: Experiment,
        groups: Sequence[Sequence[Row]],
        prepare: Prepare,
        *,
        dask: Any,
        timeout: float | None,
    ):
        need("distributed", extra("study"), "run(dask=…)")
        from distributed import Client, as_completed

        self._own = None if isinstance(dask, Client) else Client(dask)
        self.client: Any = self._own or dask
        self._rows = deque(row for group in groups for row in group)
        self._prepare = prepare
        self._timeout = timeout
        content = _zip(folder)
        self._key = uuid.uuid4().hex  # of this run, on workers that may see many
        self._shared = self.client.scatter((content, cloudpickle.dumps(experiment)), broadcast=True)
        self._tasks: dict[Any, list[Row]] = {}
        self._done = as_completed()
        self._seconds = 0.0  # of rows that are finished
        self._finished = 0
        self._refused: Batch = []

    def __iter__(self) -> Iterator[Batch]:
        threads = sum(self.client.nthreads().values()) or 1
        while True:
            while len(self._tasks) < 2 * threads and self._submit(threads):
                pass
            batch, self._refused = self._refused, []
            if not self._tasks and not batch:
                return
            if not batch:
                batch = self._take(next(self._done))
            if batch:
                yield batch

    def _take(self, task: Any) -> Batch:
        """What a task has brought; rows of one that was lost with its worker go again alone."""
        rows = self._tasks.pop(task)
        if task.status == "finished":
            finished = task.result()
            batch = [(row, finished[row.index]) for row in rows if row.index in finished]
            self._seconds += sum(answer.seconds for _, answer in batch)
            self._finished += len(batch)
            return batch
        error = task.exception()
        if len(rows) == 1:
            return [(rows[0], Finished(None, f"{type(error).__name__}: {error}"))]
        for row in rows:
            self._send([row])
        return []

    def _submit(self, threads: int) -> bool:
        """Sends the next rows: so many that they take some time, but not all to few workers."""
        count = FIRST
        if self._finished:
            count = int(CHUNK * self._finished / max(self._seconds, 1e-9))
        count = max(1, min(count, 1 + len(self._rows) // (2 * threads)))
        rows = [self._rows.popleft() for _ in range(min(count, len(self._rows)))]
        if rows:
            self._send(rows)
        return bool(rows)

    def _send(self, rows: list[Row]) -> None:
        variants: dict[str, Variant] = {}
        ready = []
        for row in rows:
            if row.scene and row.scene not in variants:
                try:
                    variants[row.scene] = self._prepare(row)
                except Exception as error:
                    refused = Finished(None, f"{type(error).__name__}: {error}")
                    self._refused.append((row, refused))
                    continue
            ready.append(row)
        if not ready:
            return
        task = self.client.submit(
            run_rows, self._key, self._shared, ready, variants, self._timeout, pure=False
        )
        self._tasks[task] = ready
        self._done.add(task)

    def stop(self) -> Batch:
        """Ends the processes, and gives up what has not run; what was finished meanwhile."""
        from distributed import wait

        batch: Batch = []
        tasks = list(self._tasks)
        try:
            self.client.run(end_servers, self._key)
            if tasks:
                wait(tasks, timeout=END)
            for task in tasks:
                if task.status == "finished":
                    batch += self._take(task)
        except (OSError, TimeoutError):
            pass  # the cluster is gone, or busy
        finally:
            if tasks:
                self.client.cancel(tasks, force=True)
            if self._own:
                self._own.close()
        return batch


# On Dask's workers

_SERVERS: dict[tuple[str, int], Server] = {}
_FOLDERS: dict[str, Path] = {}
_ENDED: set[str] = set()  # runs whose rows nobody wants any more
_LOCK = threading.Lock()


def run_rows(
    key: str,
    shared: tuple[bytes, bytes],
    rows: list[Row],
    variants: dict[str, Variant],
    timeout: float | None,
) -> dict[int, Finished]:
    """What became of rows by their index, of fewer if the run is ended meanwhile; runs on a worker
    of the cluster."""
    server = _server(key, *shared)
    if server is None:
        return {}
    server.prepare = lambda row: variants[row.scene]
    server.timeout = timeout
    answers: dict[int, Finished] = {}
    waiting = deque(rows)
    server.run(
        lambda: waiting.popleft() if waiting else None,
        lambda row, finished: answers.update({row.index: finished}),
    )
    return answers


def _server(key: str, content: bytes, experiment: bytes) -> Server | None:
    """The process of this thread for a run, unless that is over."""
    with _LOCK:
        if key in _ENDED:
            return None
        place = (key, threading.get_ident())
        if place not in _SERVERS:
            if key not in _FOLDERS:
                _FOLDERS[key] = Path(tempfile.mkdtemp(dir=temporary_folder().path))
                (_FOLDERS[key] / "temporary").mkdir()
                with zipfile.ZipFile(io.BytesIO(content)) as archive:
                    archive.extractall(_FOLDERS[key] / "unit")
            job = Job(str(_FOLDERS[key] / "unit"), cloudpickle.loads(experiment))
            temporary = str(_FOLDERS[key] / "temporary")
            _SERVERS[place] = Server(job, _no_scene, None, temporary)
        return _SERVERS[place]


def _no_scene(row: Row) -> Variant:
    raise ValueError(f"row {row.index} came without its scene")


def end_servers(key: str | None = None) -> None:
    """Ends the processes of a run, or of all, and removes what they were given."""
    with _LOCK:
        if key:
            _ENDED.add(key)
        for place in [place for place in _SERVERS if key in (None, place[0])]:
            _SERVERS.pop(place).end()
        for name in [name for name in _FOLDERS if key in (None, name)]:
            shutil.rmtree(_FOLDERS.pop(name), ignore_errors=True)


atexit.register(end_servers)


def _zip(folder: Path) -> bytes:
    """What workers need of an unzipped unit."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for path in sorted(folder.rglob("*")):
            place = path.relative_to(folder)
            if path.is_file() and place.parts[0] not in ("documentation", "terminalsAndIcons"):
                archive.write(path, place)
    return buffer.getvalue()
