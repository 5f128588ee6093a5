"""The process that runs rows: `main` with the descriptor of a socket as its argument.

It takes a job and then rows from a socket, and answers each row with what became of it. It ends
when the socket closes or, in the middle of a row, soon after standard input does, so that no
process outlives the one that started it.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path

import cloudpickle

from .runner import Experiment, Runner

IDLE = 900.0  # s, after which a worker that nobody asks ends by itself
GRACE = 3.0  # s, to clean up in once the other side is gone


@dataclass(frozen=True)
class Job:
    """What all rows of a study share: the folder of the unzipped unit, and what is done with it."""

    folder: str
    experiment: Experiment


def main() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # whoever started this process decides
    threading.Thread(target=_end_with_other_side, daemon=True).start()
    connection = Connection(int(sys.argv[1]))
    runner: Runner | None = None
    try:
        job = cloudpickle.loads(connection.recv_bytes())
        runner = Runner(Path(job.folder), job.experiment)
        connection.send(None)
        while connection.poll(IDLE):
            row = cloudpickle.loads(connection.recv_bytes())
            connection.send(runner.run(row))
    except (EOFError, ConnectionError):
        pass
    finally:
        if runner:
            runner.close()


def _end_with_other_side() -> None:
    while os.read(0, 1):
        pass
    time.sleep(GRACE)
    os._exit(1)
