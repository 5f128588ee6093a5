"""Ctrl-C between the steps of a run."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any


@contextmanager
def interruptible_between_steps() -> Iterator[Callable[[], None]]:
    """Holds Ctrl-C back until the function that it yields is called, so that no step is left half
    done; the second one breaks in at once. In other threads, and beside handlers of others, signals
    do what they did."""
    is_main = threading.current_thread() is threading.main_thread()
    if not is_main or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        yield lambda: None
        return
    held: list[int] = []

    def hold(number: int, frame: Any) -> None:
        if held:
            signal.default_int_handler(number, frame)
        held.append(number)

    def release() -> None:
        if held:
            raise KeyboardInterrupt

    signal.signal(signal.SIGINT, hold)
    try:
        yield release
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)
