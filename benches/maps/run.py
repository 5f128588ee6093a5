"""Maps of where methods fail: measures what is not known yet, writes tables and pictures.

A point is run in a process of its own; what is in a table stays unless its work has changed or
`--again` asks for it. Pictures that no document shows go into `out/maps`. `limits.csv` holds how
far each measured limit is from theory, and how many failures nothing was said of, `references.csv`
what maps of impacts are judged by.
"""

import csv
import multiprocessing
import os
import sys
import time
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from statistics import median

# Of the folder of all benches, too.
sys.path.append(str(Path(__file__).resolve().parents[1]))

import table  # noqa: E402
from boundary import crossings, deviations, search, silent  # noqa: E402
from cases import MAPS, SHOWN  # noqa: E402
from draw import draw  # noqa: E402
from plan import Answer, Cell, Map  # noqa: E402
from surveys import ROOT, parsed, parser  # noqa: E402


def measure(name: str, x: float, y: float, is_search: bool) -> Cell:
    """One cell; whatever is raised but a refusal counts as a crash."""
    of = MAPS[name]()
    begin = time.perf_counter()
    try:
        answer = of.run(of.work(x, y))
    except Exception as failure:  # noqa: BLE001 - a map shows them
        answer = Answer(refused=f"{type(failure).__name__}: {failure}", is_crash=True)
    seconds = time.perf_counter() - begin
    if answer.is_crash:
        return Cell(x, y, said="crashed", message=line(answer.refused), seconds=seconds)
    if answer.refused:
        message = line(answer.refused)
        return Cell(x, y, said="refused", message=message, seconds=seconds, is_search=is_search)
    said = "warned" if answer.warned else ""
    outcome = of.judge(answer, x, y)
    return Cell(x, y, outcome, said, line(answer.warned), seconds, is_search)


def line(message: str) -> str:
    return " ".join(message.split())[:300]


LIMIT = 600.0  # s, for one cell
UNSHOWN = ROOT / "out/maps"
"""Folder for the pictures of maps that no document shows."""


def in_own_process(name: str, x: float, y: float, is_search: bool) -> Cell:
    """What a cell leaves behind is not the next one's, and one that dies takes nothing with it."""
    context = multiprocessing.get_context("fork")
    receiver, sender = context.Pipe(duplex=False)
    worker = context.Process(target=tell, args=(sender, name, x, y, is_search))
    worker.start()
    sender.close()
    try:
        if receiver.poll(LIMIT):
            return receiver.recv()
        message = f"took longer than {LIMIT:g} s"
    except EOFError:
        worker.join()
        message = f"ended with {worker.exitcode}"
    finally:
        worker.kill()
        worker.join()
    return Cell(x, y, said="crashed", message=message, is_search=is_search)


def tell(sender, *place) -> None:
    sender.send(measure(*place))


class Surveyor:
    """Measures places of one map on all cores and keeps each as soon as it is known."""

    def __init__(self, of: Map, path: Path, jobs: int):
        self.of, self.path, self.jobs = of, path, jobs
        self.known = table.read(path, of)

    def measure(self, places: list[tuple[float, float]], is_search: bool = False) -> None:
        with ThreadPoolExecutor(self.jobs) as threads:
            waiting = [
                threads.submit(in_own_process, self.of.name, *place, is_search) for place in places
            ]
            for done in as_completed(waiting):
                cell = done.result()
                self.known[cell.x, cell.y] = cell
                table.write(self.path, self.of, self.known)

    def complete(self) -> None:
        for reference in self.of.references:
            if not reference.is_known:
                reference.measure()
        grid = [(x, y) for x in self.of.x.values for y in self.of.y.values]
        self.measure([place for place in grid if place not in self.known])
        search(self.of, self.known, lambda places: self.measure(places, is_search=True))


def summary(of: Map, known: table.Known) -> list[str]:
    """Cells, those told of, failures in silence, and the boundary against theory."""
    grid = [cell for cell in known.values() if not cell.is_search]
    off = [abs(row[3]) for row in deviations(of, known) if row[3] == row[3]]
    return [
        of.name,
        str(len(grid)),
        str(sum(cell.is_told for cell in grid)),
        f"{of.bad:g}",
        str(len(silent(of, known))) if of.must_speak else "",
        str(len(crossings(of, known))),
        f"{100 * median(off):.2g}" if off else "",
        f"{100 * max(off):.2g}" if off else "",
    ]


HEADS = [
    "map",
    "cells",
    "told of",
    "bad above",
    "bad and silent",
    "edges",
    "off theory [%]",
    "at most [%]",
]


def missing(folder: Path) -> list[str]:
    """Cells that are not measured as they are declared now."""
    told = []
    for name, build in MAPS.items():
        of = build()
        known = table.read(folder / f"{name}.csv", of)
        lacking = [(x, y) for x in of.x.values for y in of.y.values if (x, y) not in known]
        told += [f"{name} lacks x = {x:g}, y = {y:g}" for x, y in lacking]
        told += [f"{name} lacks the reference {r.name}" for r in of.references if not r.is_known]
    return told


def main() -> None:
    made = parser(__doc__, "maps", MAPS)
    made.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parsed(made, MAPS, missing)
    UNSHOWN.mkdir(parents=True, exist_ok=True)
    for name in options.names:
        surveyor = Surveyor(MAPS[name](), options.out / f"{name}.csv", options.jobs)
        if options.again:
            surveyor.known.clear()
        begin = time.perf_counter()
        if not options.draw:
            surveyor.complete()
        draw(surveyor.of, surveyor.known, options.out if name in SHOWN else UNSHOWN)
        told = zip(HEADS, summary(surveyor.of, surveyor.known), strict=True)
        print("; ".join(f"{head} {value or '–'}" for head, value in told), end="")
        print(f" ({time.perf_counter() - begin:.0f} s)", flush=True)
    write_limits(options.out)


def write_limits(folder: Path) -> None:
    with (folder / "limits.csv").open("w", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(HEADS)
        for name, build in MAPS.items():
            of = build()
            if known := table.read(folder / f"{name}.csv", of):
                rows.writerow(summary(of, known))


if __name__ == "__main__":
    main()
