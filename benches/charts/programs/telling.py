"""How a program tells what it came to."""

import json
import resource
import sys
import time


def peak() -> int:
    """Peak memory of this process [B]."""
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def tell(prepare) -> None:
    """Runs what `prepare` makes of the arguments, and prints values, times and memory."""
    case = json.loads(sys.argv[1])
    before = peak()
    begin = time.perf_counter()
    run = prepare(case)
    started = time.perf_counter()
    values = run()
    ended = time.perf_counter()
    told = {"values": values, "start": started - begin, "steps": ended - started}
    print(json.dumps(told | {"memory": peak() - before}))
