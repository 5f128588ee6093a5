"""A layer of fluid and a thick plate of different temperature: how far are the heat that passes and
the temperature of contact from those of two half spaces?

`benches/contact.rs` joins particles and elements in turns, as a master does; closed form after H.
S. Carslaw, J. C. Jaeger (1959), § 2.8.
"""

import json
import subprocess
from functools import cache
from pathlib import Path

from plan import Answer, Axis, Map, Work

ROOT = Path(__file__).resolve().parents[4]
RATIOS = [1e-4, 1e-2, 0.1, 1.0, 10.0, 1e2, 1e4]
SPACINGS = [0.25, 0.5, 1.0, 2.0, 4.0, 8.0]
PRANDTL = [1e-2, 1e-1, 1.0, 10.0, 1e2, 1e3]
EXCHANGES = [3.0, 7.0, 20.0, 70.0, 200.0, 700.0]
USUAL = {"spacing": 1.0, "ratio": 0.26, "prandtl": 2.0, "exchanges": 70, "shear": 0.0}


@cache
def program() -> str:
    """The built bench."""
    command = ["cargo", "build", "--release", "--bench", "contact", "--message-format=json"]
    told = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    made = (json.loads(line) for line in told.splitlines())
    return [m["executable"] for m in made if m.get("executable")][-1]


def work(**setting: float) -> Work:
    return USUAL | setting


def run(of: Work) -> Answer:
    words = [str(of[key]) for key in ("spacing", "ratio", "prandtl", "exchanges", "shear")]
    ran = subprocess.run([program(), *words], capture_output=True, text=True, timeout=120)
    if ran.returncode:
        return Answer(refused=ran.stderr.strip(), is_crash=True)
    return Answer(json.loads(ran.stdout.splitlines()[-1]))


def error(answer: Answer, x: float, y: float) -> float:
    """Of the heat or the rise at the end, whichever is larger, relative."""
    return max(abs(answer.values[key]) for key in ("heat", "rise"))


def layer(name: str, title: str, x: Axis, y: Axis, of) -> Map:
    return Map(
        name=name,
        title=title,
        x=x,
        y=y,
        outcome="largest error of heat and temperature",
        unit="1",
        bad=0.05,
        work=of,
        run=run,
        judge=error,
        colours=(1e-4, 0.05),
    )


RATIO = Axis("effusivity of the fluid over that of the plate", "1", RATIOS)
SPACING = Axis("distance of particles over the layer √(πκt)", "1", SPACINGS)


def contact_spacing() -> Map:
    return layer(
        "coupling_contact",
        "Fluid at rest on a plate",
        RATIO,
        SPACING,
        lambda ratio, spacing: work(ratio=ratio, spacing=spacing),
    )


def contact_prandtl() -> Map:
    """The fluid is sheared by 3.5 in the time."""
    return layer(
        "coupling_prandtl",
        "Sheared fluid on a plate",
        RATIO,
        Axis("Prandtl number", "1", PRANDTL),
        lambda ratio, prandtl: work(ratio=ratio, prandtl=prandtl, shear=3.5),
    )


def contact_exchanges() -> Map:
    return layer(
        "coupling_exchanges",
        "Fluid at rest on a plate, exchanges",
        SPACING,
        Axis("exchanges in the time", "1", EXCHANGES),
        lambda spacing, exchanges: work(spacing=spacing, exchanges=exchanges, ratio=1.0),
    )
