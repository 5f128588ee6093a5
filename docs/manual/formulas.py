"""Formulas as outlines (SVG) by Matplotlib's mathtext: they need no script and no font.

Code hosts render the same `$…$` and `$$…$$` by themselves.
"""

from html import escape

from docutils import nodes
from matplotlib.font_manager import FontProperties
from matplotlib.path import Path
from matplotlib.textpath import text_to_path
from sphinx.errors import ExtensionError

SIZE = 100.0  # units of the drawing per em
PROPERTIES = FontProperties(size=SIZE, math_fontfamily="cm")
COMMANDS = {Path.MOVETO: "M", Path.LINETO: "L", Path.CURVE3: "Q", Path.CURVE4: "C"}
POINTS = {Path.MOVETO: 1, Path.LINETO: 1, Path.CURVE3: 2, Path.CURVE4: 3}


def setup(app):
    app.add_html_math_renderer("outlines", (inline, None), (block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def inline(translator, node):
    translator.body.append(drawing(node.astext()))
    raise nodes.SkipNode


def block(translator, node):
    translator.body.append(f'<div class="formula">{drawing(node.astext())}</div>\n')
    raise nodes.SkipNode


def drawing(formula: str) -> str:
    """Returns an SVG element on the baseline of the text; screen readers get the TeX."""
    line = " ".join(formula.split())
    text = f"${line}$"
    try:
        width, height, depth = text_to_path.get_text_width_height_descent(text, PROPERTIES, True)
        vertices, codes = text_to_path.get_text_path(PROPERTIES, text, ismath=True)
    except ValueError as reason:
        raise ExtensionError(f"formula {line}: {reason}") from None
    scale = SIZE / text_to_path.FONT_SCALE
    return (
        f'<svg class="math" role="img" aria-label="{escape(line)}" fill="currentColor" '
        f'viewBox="0 {depth - height:.0f} {width:.0f} {height:.0f}" '
        f'style="width:{width / SIZE:.3f}em;height:{height / SIZE:.3f}em;'
        f'vertical-align:{-depth / SIZE:.3f}em">'
        f'<path d="{outline(vertices, codes, scale)}"/></svg>'
    )


def outline(vertices, codes, scale: float) -> str:
    """Returns the commands of an SVG path, whose y axis points down."""
    parts, place = [], 0
    while place < len(codes):
        code = codes[place]
        if code == Path.CLOSEPOLY:
            parts.append("Z")
            place += 1
            continue
        count = POINTS[code]
        points = [f"{scale * x:.1f} {-scale * y:.1f}" for x, y in vertices[place : place + count]]
        parts.append(COMMANDS[code] + " ".join(points))
        place += count
    return "".join(parts)
