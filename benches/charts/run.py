"""Charts of work over accuracy: measures what is not known yet, writes tables and pictures.

Each point is packed and run in processes of its own; medians of its repetitions. What is in a table
stays unless its scene has changed or `--again` asks for it.
"""

import sys
from pathlib import Path

# Of the folder of all benches, too.
sys.path.append(str(Path(__file__).resolve().parents[1]))

import table  # noqa: E402
from cases import CHARTS  # noqa: E402
from draw import draw  # noqa: E402
from measure import measure  # noqa: E402
from references import resolved  # noqa: E402
from surveys import parsed, parser  # noqa: E402


def missing(folder: Path) -> list[str]:
    """Points that are not measured as they are declared now."""
    told = []
    for name, build in CHARTS.items():
        chart = build()
        known = table.read(folder / f"{name}.csv", chart)
        points = [(method.name, point) for method in chart.methods for point in method.points]
        lacking = [(what, p.setting) for what, p in points if (what, table.key(p)) not in known]
        told += [f"{name} lacks {what}, {setting}" for what, setting in lacking]
    return told


def main() -> None:
    made = parser(__doc__, "charts", CHARTS)
    made.add_argument("--repetitions", type=int, default=3)
    made.add_argument("--methods", nargs="*", help="measure these alone")
    options = parsed(made, CHARTS, missing)
    for name in options.names:
        chart = CHARTS[name]()
        path = options.out / f"{name}.csv"
        known = table.read(path, chart)
        for method in chart.methods:
            if options.draw or (options.methods and method.name not in options.methods):
                continue
            for point in method.points:
                place = method.name, table.key(point)
                if place in known and not options.again:
                    continue
                known[place] = measure(point, 1 if method.is_reference else options.repetitions)
                table.write(path, resolved(chart, known), known)
                said = known[place].failure or f"{known[place].seconds:.4g} s"
                print(f"{name}: {method.name}, {point.setting}: {said}", flush=True)
        chart = resolved(chart, known)
        table.write(path, chart, known)
        draw(chart, known, options.out)


if __name__ == "__main__":
    main()
