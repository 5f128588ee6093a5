"""Places short texts beside points of a panel, none over another or over a point."""

from matplotlib.transforms import Bbox

SIZE = 8
"""Of the letters [pt]."""
OFFSETS = [(5, 4), (5, -10), (-5, 4), (-5, -10), (0, 8), (0, -14), (7, -3), (-7, -3)]
OFFSETS += [(2 * x, 2.2 * y) for x, y in OFFSETS]
"""From a point [pt], the nearest first; texts to the left end there."""
MARGIN = 3.0
"""Around the middle of a point, which no text covers [px]."""


class Labels:
    """The texts of one panel, which knows its size; a text without a free place is left out."""

    def __init__(self, axes):
        self.axes = axes
        self.taken = [
            Bbox.from_extents(x - MARGIN, y - MARGIN, x + MARGIN, y + MARGIN)
            for line in axes.get_lines()
            if line.get_marker() not in (None, "None", "")
            for x, y in axes.transData.transform(line.get_xydata())
        ]

    def put(self, x: float, y: float, text: str, colour: str) -> None:
        """Writes a text beside a point, at the first offset where there is room."""
        if not text:
            return
        for right, up in OFFSETS:
            side = "left" if right > 0 else "right" if right < 0 else "center"
            label = self.axes.annotate(
                text,
                (x, y),
                (right, up),
                textcoords="offset points",
                fontsize=SIZE,
                color=colour,
                ha=side,
                annotation_clip=False,
            )
            extent = label.get_window_extent()
            if self._has_room(extent):
                self.taken.append(extent)
                return
            label.remove()

    def _has_room(self, extent: Bbox) -> bool:
        page = self.axes.figure.bbox
        inside = page.x0 <= extent.x0 and extent.x1 <= page.x1
        return inside and not any(extent.overlaps(other) for other in self.taken)
