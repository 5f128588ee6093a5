"""Charts of work over accuracy: measures what is not known yet, writes tables and pictures.

Each point is packed and run in processes of its own; medians of its repetitions. What is in a table
stays unless its scene has changed or `--again` asks for it.
"""

import argparse
import sys
from pathlib import Path

import table
from cases import CHARTS
from draw import draw
from measure import ROOT, measure
from references import resolved


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
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("charts", nargs="*", help=f"of {', '.join(CHARTS)} [default: all]")
    parser.add_argument("--out", type=Path, default=ROOT / "docs/charts")
    parser.add_argument("--repetitions", type=int, default=3)
    parser.add_argument("--again", action="store_true", help="measure what is known, too")
    parser.add_argument("--draw", action="store_true", help="only draw what is known")
    parser.add_argument("--methods", nargs="*", help="measure these alone")
    parser.add_argument("--check", action="store_true", help="only say what is not known")
    options = parser.parse_args()
    if unknown := set(options.charts) - set(CHARTS):
        parser.error(f"no such chart: {', '.join(sorted(unknown))}; there are {', '.join(CHARTS)}")
    if options.check:
        sys.exit("\n".join(missing(options.out)) or None)
    options.out.mkdir(parents=True, exist_ok=True)
    for name in options.charts or CHARTS:
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
