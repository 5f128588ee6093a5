"""The command ``impinge-adapt``."""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ..surface import Placement, Series, Surface, SurfaceError
from ..surface.files import load_mesh
from .cfd import cfd_frames
from .drops import drop_inputs
from .laser import laser_frames
from .out import onto_mesh, write_frames
from .spray import spray_frames
from .table import write_inputs

PROGRAM = "impinge-adapt"
# Quantities of which integrals are kept
FLUXES = ("heat_flux", "pressure", "shear_x", "shear_y", "shear_r")


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs a command line; 0 if all went well, 2 with the error on standard error if not."""
    options = _parser().parse_args(arguments)
    try:
        options.run(options)
    except (SurfaceError, OSError) as error:
        print(f"{PROGRAM}: {_in_options(str(error))}", file=sys.stderr)
        return 2
    return 0


def _in_options(told: str) -> str:
    """An error of the functions in words of the command: options in place of arguments."""
    amounts = 'quantity="extensive" carries their amounts'
    told = told.replace(amounts, "`impinge-adapt spray` carries amounts of drops")
    told = told.replace("(interval)", "(--interval)")
    return re.sub(r'\b(kind|outside)="(\w+)"', r"--\1 \2", told)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog=PROGRAM,
        description="Files of other tools to tables of inputs of units, and fields of units onto"
        " meshes of other tools.",
        epilog="Formats, orientation and examples: docs/adapt.md of the repository.",
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    laser = commands.add_parser("laser", help="maps of a beam's power to heat flux over time")
    laser.add_argument(
        "files", nargs="+", type=Path, metavar="MAP", help="picture, .csv, .npy or .h5, one a time"
    )
    laser.add_argument(
        "--size",
        nargs=2,
        type=float,
        required=True,
        metavar=("LX", "LY"),
        help="extent of a map [m]",
    )
    laser.add_argument(
        "--at", nargs=2, type=float, default=(0.0, 0.0), metavar=("X", "Y"), help="its middle [m]"
    )
    laser.add_argument("--angle", type=float, default=0.0, help="by how much it is turned [rad]")
    how = laser.add_mutually_exclusive_group(required=True)
    how.add_argument("--power", type=float, help="power that is absorbed [W]")
    how.add_argument("--scale", type=float, help="W/m2 of an intensity of 1")
    how.add_argument("--pulse", type=Path, help="table with columns time [s], power [W]")
    laser.add_argument("--interval", type=float, help="time between maps [s]")
    laser.add_argument("--upward", action="store_true", help="the first row has the lowest y")
    laser.set_defaults(run=_laser)

    spray = commands.add_parser("spray", help="places and amounts of drops to heat flux over time")
    spray.add_argument(
        "files", nargs=1, type=Path, metavar="DROPS", help="table with columns x, y, AMOUNT, time"
    )
    spray.add_argument(
        "--amount", default="mass", help="column that is summed [default: %(default)s]"
    )
    spray.add_argument(
        "--factor", type=float, default=1.0, help="such as heat per mass [J/kg] [default: 1]"
    )
    spray.add_argument("--window", type=float, required=True, help="length of a frame [s]")
    spray.set_defaults(run=_spray)

    cfd = commands.add_parser(
        "cfd", help="fields on surfaces of flow computations to inputs over time"
    )
    cfd.add_argument(
        "files", nargs=1, type=Path, metavar="FILE", help="mesh, series or table with a field"
    )
    cfd.add_argument("--data", required=True, help="name of the field")
    cfd.add_argument(
        "--kind",
        choices=["conservative", "consistent"],
        help="keeps integrals, or values [default: integrals of fluxes and tractions]",
    )
    cfd.add_argument("--weight", metavar="FIELD", help="means weighted by this field")
    cfd.add_argument(
        "--values",
        choices=["cells", "points"],
        help="where the field stands [default: in cells, if there is one of its name]",
    )
    cfd.set_defaults(run=_cfd)

    for command in (laser, spray, cfd):
        command.add_argument(
            "--onto",
            required=True,
            metavar="UNIT:NAME",
            help=".fmu or .toml, and a load or wall in it",
        )
        command.add_argument(
            "--variable", default="heat_flux", help="quantity of the load [default: %(default)s]"
        )
        command.add_argument("--hold", action="store_true", help="frames hold until the next")
        choices = ["error", "drop", "nearest"] if command is cfd else ["error", "drop"]
        command.add_argument(
            "--outside", choices=choices, default="error", help="for what falls beside"
        )
        command.add_argument("-o", "--out", type=Path, help="table for impinge run --inputs")

    drops = commands.add_parser("drops", help="times and places of drops to releases on demand")
    drops.add_argument(
        "files",
        nargs=1,
        type=Path,
        metavar="DROPS",
        help="table with columns x, y, time, and speed, temperature, angle, direction",
    )
    drops.add_argument("--body", default="drop", help="name of the droplet [default: %(default)s]")
    drops.add_argument("-o", "--out", type=Path, required=True, help="table of inputs")
    drops.set_defaults(run=_drops)

    out = commands.add_parser("out", help="fields of a unit's bodies onto a mesh of another tool")
    out.add_argument(
        "files",
        nargs=1,
        type=Path,
        metavar="SERIES",
        help="BODY.pvd of output.directory, .vtr or .vts",
    )
    out.add_argument(
        "--onto", required=True, type=Path, metavar="MESH", help="mesh that meshio reads"
    )
    out.add_argument("--fields", nargs="+", default=["temperature"], help="[default: temperature]")
    out.add_argument("--times", nargs="+", type=float, help="times [s] [default: all]")
    out.add_argument(
        "-o",
        "--out",
        type=Path,
        required=True,
        help=".xdmf or .pvd, or for one time what meshio writes",
    )
    out.set_defaults(run=_out)
    for command in (spray, cfd, drops, out):
        _add_placement(command)
    return parser


def _add_placement(command: argparse.ArgumentParser) -> None:
    group = command.add_argument_group("foreign coordinates")
    group.add_argument("--unit", default="m", help="unit of length [default: m]")
    group.add_argument(
        "--origin", nargs=3, type=float, default=(0.0, 0.0, 0.0), metavar=("X", "Y", "Z")
    )
    axes = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0)
    help = "directions of the face's x and y"
    group.add_argument("--axes", nargs=6, type=float, default=axes, metavar="D", help=help)
    group.add_argument("--tolerance", type=float, help="how far places may lie off the face [m]")


def _placement(options: argparse.Namespace) -> Placement:
    return Placement(options.origin, (options.axes[:3], options.axes[3:]), options.unit)


def _target(options: argparse.Namespace) -> Surface:
    unit, mark, name = options.onto.rpartition(":")
    if not mark:
        raise SurfaceError(f"--onto {options.onto}: UNIT:NAME is needed, such as scene.toml:laser")
    return Surface.of(unit, name)


def _laser(options: argparse.Namespace) -> None:
    target = _target(options)
    frames = laser_frames(
        options.files, target, options.size,
        at=options.at, angle=options.angle, upward=options.upward,
        power=options.power, scale=options.scale, pulse=options.pulse,
        interval=options.interval, outside=options.outside,
    )  # fmt: skip
    _write(options, target, frames, "W")


def _spray(options: argparse.Namespace) -> None:
    target = _target(options)
    frames, total = spray_frames(
        options.files[0], target,
        amount=options.amount, factor=options.factor, window=options.window,
        placement=_placement(options), outside=options.outside,
    )  # fmt: skip
    options.hold = True
    _write(options, target, frames, "per s")
    print(f"brought {total['brought']:.9g}, of which {total['lost']:.6g} falls beside the cells")


def _drops(options: argparse.Namespace) -> None:
    frames = drop_inputs(options.files[0], options.body, _placement(options))
    write_inputs(options.out, frames, held=True)
    count = frames[f"{options.body}.release"].values[-1]
    print(f"{options.out}: {count:.0f} drops, inputs {', '.join(frames)}")


def _cfd(options: argparse.Namespace) -> None:
    target = _target(options)
    keeps = "conservative" if options.variable in FLUXES else "consistent"
    frames = cfd_frames(
        options.files[0], target, options.data,
        kind=options.kind or keeps, weight=options.weight, values=options.values,
        placement=_placement(options),
        outside=options.outside, tolerance=options.tolerance,
    )  # fmt: skip
    if options.variable == "coefficient":
        _tell_coefficient(options, frames)
    else:
        _write(options, target, frames, "W")


def _tell_coefficient(options: argparse.Namespace, frames: Series) -> None:
    """Coefficients of faces are parameters, which a table of inputs cannot hold."""
    if len(frames) > 1 or frames.values.size > 1:
        raise SurfaceError(
            f"{options.files[0]}: {len(frames)} times, {frames.values[0].size} cells; a coefficient"
            " is one number, of a face such as --onto scene.toml:plate.bottom"
        )
    name = options.onto.rpartition(":")[2]
    print(f"--set {name}.coefficient={float(frames.values.item())!r}")


def _write(options: argparse.Namespace, target: Surface, frames: Series, unit: str) -> None:
    if options.out is None:
        raise SurfaceError("-o: the name of the table is needed")
    name = options.onto.rpartition(":")[2]
    missing = ~np.isfinite(frames.values)
    if missing.any():
        count = int(missing.reshape(len(frames), -1).any(axis=0).sum())
        raise SurfaceError(
            f"{options.files[0]}: {count} of {target.size} cells of {name} lie off its field and"
            " would get no value; --outside nearest gives them that of the nearest place"
        )
    write_inputs(
        options.out,
        {f"{name}.{options.variable}": frames},
        held=options.hold,
        single=target.size == 1,
    )
    total = frames.values
    if target.location == "cells":
        total = target.integral(total) * target.depth
    print(
        f"{options.out}: {len(frames)} times, {target.size} cells, integral "
        f"{total.min():.9g} to {total.max():.9g} {unit}"
    )


def _out(options: argparse.Namespace) -> None:
    mesh = load_mesh(options.onto)
    frames = onto_mesh(
        options.files[0], mesh, options.fields, times=options.times, placement=_placement(options),
        tolerance=options.tolerance,
    )  # fmt: skip
    files = write_frames(options.out, mesh, frames)
    print(f"{files[-1]}: {', '.join(options.fields)} at {len(mesh.points)} nodes")


if __name__ == "__main__":
    sys.exit(main())
