"""Rows on processes of this machine, which may die without harm to the study."""

from __future__ import annotations

import os
import pickle
import signal
import socket
import subprocess
import sys
import threading
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from multiprocessing.connection import Connection
from queue import Empty, SimpleQueue
from typing import Any

import cloudpickle

from impinge.unit.temporary import temporary_folder

from .journal import Finished
from .runner import Row
from .scenes import Variant
from .worker import Job

AHEAD = 2  # rows that a worker has at hand, so that it never waits
START = 120.0  # s that a worker may take to start
START_WORKER = "from impinge.study.worker import main; main()"

Report = Callable[[Row, Finished], None]
Prepare = Callable[[Row], Variant]


class Died(Exception):
    """The worker has ended, or was ended, before it answered."""


class Worker:
    """A process that runs rows one after another; `scene` is what its unit is made of."""

    def __init__(self, job: Job, temporary: str | None = None):
        self.scene = ""
        ours, theirs = socket.socketpair()
        environment = {"OPENBLAS_NUM_THREADS": "1", **os.environ}
        environment["PYTHONPATH"] = os.pathsep.join(filter(None, sys.path))
        if temporary:
            environment["TMPDIR"] = temporary
        lock = temporary_folder().lock
        with theirs:
            self.process = subprocess.Popen(
                [sys.executable, "-c", START_WORKER, str(theirs.fileno())],
                # Keeps what the worker uses from being swept should this process be killed.
                pass_fds=[theirs.fileno(), *(number for number in [lock] if number >= 0)],
                stdin=subprocess.PIPE,  # its end tells of ours
                env=environment,
                start_new_session=True,  # Ctrl-C is for the study alone
            )
        self.connection = Connection(ours.detach())
        try:
            self.connection.send_bytes(cloudpickle.dumps(job))
            self.receive(START)
        except (Died, OSError) as death:
            raise RuntimeError(f"a worker of the study does not start: {death}") from None

    def send(self, row: Row) -> None:
        try:
            # Rows hold plain values, which pickle itself writes ten times as fast.
            self.connection.send_bytes(pickle.dumps(row))
        except OSError:
            pass  # who asks for the answer learns of the death

    def receive(self, timeout: float | None) -> Any:
        """The answer to what has waited longest; raises `Died`."""
        try:
            if self.connection.poll(timeout):
                return self.connection.recv()
        except (EOFError, OSError):
            raise Died(self._cause()) from None
        self.kill()
        raise Died(f"it took longer than {timeout:g} s and was ended")

    def _cause(self) -> str:
        self.connection.close()
        try:
            code = self.process.wait(10.0)
        except subprocess.TimeoutExpired:
            self.kill()
            return "its process stopped answering"
        self._close_streams()
        if code < 0:
            return f"its process was ended by {signal.Signals(-code).name}"
        return f"its process ended with status {code}"

    @property
    def is_alive(self) -> bool:
        return not self.connection.closed and self.process.poll() is None

    def kill(self) -> None:
        """Ends the process at once."""
        self.process.kill()
        self.process.wait()
        self._close_streams()

    def close(self) -> None:
        """Ends the process, which cleans up behind itself."""
        self._close_streams()
        try:
            self.process.wait(10.0)
        except subprocess.TimeoutExpired:
            self.kill()

    def _close_streams(self) -> None:
        self.connection.close()
        if self.process.stdin:
            self.process.stdin.close()


class Server:
    """Runs rows on a worker, and on a new one where that has died.

    `prepare` makes the unit of a row of a changed scene. `timeout` [s] is what a row may take.
    """

    def __init__(
        self,
        job: Job,
        prepare: Prepare,
        timeout: float | None = None,
        temporary: str | None = None,
    ):
        self.job = job
        self.prepare = prepare
        self.timeout = timeout
        self.temporary = temporary
        self.worker: Worker | None = None
        self.is_stopped = False

    def run(self, take: Callable[[], Row | None], report: Report) -> None:
        """Runs what `take` gives until that is nothing; a row whose process dies has failed."""
        waiting: deque[Row] = deque()
        again: deque[Row] = deque()  # taken, but not run
        while not self.is_stopped:
            while len(waiting) < AHEAD:
                row = again.popleft() if again else take()
                if row is None:
                    break
                worker = self._ready(bool(waiting))
                is_new = bool(row.scene) and row.scene != worker.scene
                if is_new and waiting:
                    # Two sides that both send much would wait for each other.
                    again.appendleft(row)
                    break
                if is_new:
                    try:
                        row = replace(row, variant=self.prepare(row))
                    except Exception as error:
                        report(row, Finished(None, f"{type(error).__name__}: {error}"))
                        continue
                worker.scene = row.scene
                worker.send(row)
                waiting.append(row)
            if not waiting:
                return
            try:
                finished = self._ready(True).receive(self.timeout)
            except Died as death:
                self.worker = None
                if self.is_stopped:
                    return
                report(waiting.popleft(), Finished(None, f"the run did not end: {death}"))
                again.extendleft(reversed(waiting))
                waiting.clear()
            else:
                report(waiting.popleft(), finished)

    def _ready(self, owes_answers: bool) -> Worker:
        """The worker; a new one if there is none, or if it has ended with nothing to do. One that
        owes answers is kept: only asking for them tells of which row it died."""
        if self.worker and not owes_answers and not self.worker.is_alive:
            self.worker.close()
            self.worker = None
        if self.worker is None:
            self.worker = Worker(self.job, self.temporary)
        return self.worker

    def close(self) -> None:
        """Ends the worker once it is done."""
        if self.worker:
            self.worker.close()
        self.worker = None

    def stop(self) -> None:
        """Ends the worker at once, in whatever it does; `run` in another thread returns."""
        self.is_stopped = True
        worker = self.worker
        if worker:
            worker.process.kill()

    def end(self) -> None:
        """Ends the worker for good."""
        self.stop()
        self.close()


class Queue:
    """Rows in groups that share a unit. A server keeps to its group, then takes another one, then
    half of what the busiest has left."""

    def __init__(self, groups: Sequence[Sequence[Row]]):
        self._groups = deque(deque(group) for group in groups)
        self._own: dict[int, deque[Row]] = {}
        self._lock = threading.Lock()

    def take(self, server: int) -> Row | None:
        with self._lock:
            own = self._own.get(server)
            if not own:
                own = self._groups.popleft() if self._groups else self._half_of_busiest()
                self._own[server] = own
            return own.popleft() if own else None

    def _half_of_busiest(self) -> deque[Row]:
        busiest = max(self._own.values(), key=len, default=deque())
        return deque(reversed([busiest.pop() for _ in range(len(busiest) // 2)]))


Batch = list[tuple[Row, Finished]]


class Processes:
    """Rows on so many processes of this machine; iterating yields what is finished, as it comes."""

    def __init__(
        self,
        job: Job,
        groups: Sequence[Sequence[Row]],
        prepare: Prepare,
        *,
        processes: int,
        timeout: float | None,
        temporary: str,
    ):
        self._queue = Queue(groups)
        self._answers: SimpleQueue[tuple[Row, Finished] | Exception | None] = SimpleQueue()
        self._servers = [Server(job, prepare, timeout, temporary) for _ in range(processes)]
        self._threads = [
            threading.Thread(target=self._serve, args=(number,), daemon=True)
            for number in range(processes)
        ]
        for thread in self._threads:
            thread.start()

    def _serve(self, number: int) -> None:
        server = self._servers[number]
        try:
            server.run(lambda: self._queue.take(number), lambda *row: self._answers.put(row))
        except Exception as error:
            self._answers.put(error)
        finally:
            server.close()
            self._answers.put(None)

    def __iter__(self) -> Iterator[Batch]:
        running = len(self._servers)
        while running:
            answers = [self._answers.get(), *self._at_hand()]
            running -= sum(answer is None for answer in answers)
            batch = [answer for answer in answers if isinstance(answer, tuple)]
            if batch:
                yield batch
            for answer in answers:
                if isinstance(answer, Exception):
                    raise answer

    def stop(self) -> Batch:
        """Ends all processes, whatever they do; what has come in meanwhile."""
        for server in self._servers:
            server.stop()
        for thread in self._threads:
            thread.join()
        return [answer for answer in self._at_hand() if isinstance(answer, tuple)]

    def _at_hand(self) -> list[Any]:
        found = []
        while True:
            try:
                found.append(self._answers.get_nowait())
            except Empty:
                return found
