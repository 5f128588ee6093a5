"""Writes `ring.vtu`: quadrilaterals of a ring whose rims are held apart by curved spokes [mm]."""

from pathlib import Path

import numpy as np

INNER, OUTER = (8.0, 10.0), (18.0, 20.0)  # mm, radii of both rims
AROUND, SPOKES, WIDTH = 120, 15, 2  # cells around, spokes, cells across one
ACROSS, ALONG = 2, 8  # cells across a rim and along a spoke
SWEEP = 12  # cells by which a spoke is turned from rim to rim
HUB = 7  # number of the face `sides`


def ring() -> tuple[np.ndarray, list[list[int]], list[list[int]]]:
    """Places of the nodes [mm], cells, and the edges of the hub."""
    nodes, numbers, cells = [], {}, []

    def node(kind: str, level: int, column: float, radius: float) -> int:
        key = kind, level, column
        if key not in numbers:
            angle = 2 * np.pi * column / AROUND
            numbers[key] = len(nodes)
            nodes.append([radius * np.cos(angle), 0.0, radius * np.sin(angle)])
        return numbers[key]

    def rim(kind: str, radii: tuple[float, float], level: int, column: int) -> int:
        radius = radii[0] + (radii[1] - radii[0]) * level / ACROSS
        return node(kind, level, column % AROUND, radius)

    for kind, radii in (("inner", INNER), ("outer", OUTER)):
        for level in range(ACROSS):
            for column in range(AROUND):
                corners = ((level, 0), (level + 1, 0), (level + 1, 1), (level, 1))
                cells.append([rim(kind, radii, at, column + by) for at, by in corners])

    def spoke(first: int, level: int, column: int) -> int:
        if level == 0:
            return rim("inner", INNER, ACROSS, first + column)
        if level == ALONG:
            return rim("outer", OUTER, 0, first + column + SWEEP)
        part = level / ALONG
        radius = INNER[1] + (OUTER[0] - INNER[1]) * part
        return node(f"spoke {first}", level, first + column + SWEEP * part, radius)

    for first in range(0, AROUND, AROUND // SPOKES):
        for level in range(ALONG):
            for column in range(WIDTH):
                corners = ((level, 0), (level + 1, 0), (level + 1, 1), (level, 1))
                cells.append([spoke(first, at, column + by) for at, by in corners])
    hub = [[rim("inner", INNER, 0, column + by) for by in (0, 1)] for column in range(AROUND)]
    return np.array(nodes) + 0.0, cells, hub


def write(path: Path):
    """Writes the ring as VTK's XML, with numbers as text."""
    nodes, cells, hub = ring()

    def array(name: str, kind: str, rows: list[str], width: int = 1) -> str:
        head = f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{width}"'
        return "\n".join([f'{head} format="ascii">', *rows, "</DataArray>"])

    def rows(values: list[int]) -> list[str]:
        return [" ".join(map(str, values[at : at + 40])) for at in range(0, len(values), 40)]

    ends = np.cumsum([len(cell) for cell in cells + hub]).tolist()
    text = [
        '<VTKFile type="UnstructuredGrid" version="1.0">',
        "<UnstructuredGrid>",
        f'<Piece NumberOfPoints="{len(nodes)}" NumberOfCells="{len(cells + hub)}">',
        "<Points>",
        array("points", "Float64", [f"{x:.6f} {y:.0f} {z:.6f}" for x, y, z in nodes], 3),
        "</Points>",
        "<Cells>",
        array("connectivity", "Int64", [" ".join(map(str, cell)) for cell in cells + hub]),
        array("offsets", "Int64", rows(ends)),
        array("types", "UInt8", rows([9] * len(cells) + [3] * len(hub))),
        "</Cells>",
        "<CellData>",
        array("face", "Int32", rows([0] * len(cells) + [HUB] * len(hub))),
        "</CellData>",
        "</Piece>",
        "</UnstructuredGrid>",
        "</VTKFile>",
    ]
    path.write_text("\n".join(text) + "\n")


if __name__ == "__main__":
    write(Path(__file__).with_name("ring.vtu"))
