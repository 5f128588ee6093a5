"""Writes the pictures of documents: as wide as a page shows them, of a palette, thus small."""

from io import BytesIO
from pathlib import Path

from PIL import Image

WIDTH = 1300  # px


def save(figure, path: Path) -> None:
    """Writes a PNG of 256 colours, a third as large as one of all; curves and maps need no more."""
    drawn = BytesIO()
    figure.savefig(drawn, format="png", dpi=WIDTH / figure.get_figwidth())
    with Image.open(drawn) as image:
        coverage = Image.Quantize.MAXCOVERAGE  # no colour of a scale is off by more than a shade
        few = image.convert("RGB").quantize(256, coverage, kmeans=3, dither=Image.Dither.NONE)
    few.save(path, optimize=True)
