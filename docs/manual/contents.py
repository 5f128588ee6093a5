"""The table of contents, which follows from the lists of the first page.

Sphinx wants a `toctree` directive, which code hosts would show as a block of code. The first page
has plain lists of links instead: each heading of the second level begins a part, each item of a
list names a page by its first link.
"""

import posixpath
import re

LINK = re.compile(r"^\s*- (?:\*\*)?\[[^\]]+\]\(([^)#]+\.md)\)", re.M)


def setup(app):
    app.connect("source-read", add_contents)
    return {"parallel_read_safe": True}


def add_contents(app, page: str, source: list[str]):
    """Appends hidden directives to the source of the first page."""
    if page != app.config.root_doc:
        return
    folder = posixpath.dirname(page)
    for part in re.split(r"^## ", source[0], flags=re.M)[1:]:
        caption = part.splitlines()[0]
        linked = [posixpath.normpath(posixpath.join(folder, link)) for link in LINK.findall(part)]
        entries = [f"/{posixpath.splitext(path)[0]}" for path in linked]
        if entries:
            options = f":hidden:\n:titlesonly:\n:caption: {caption}\n"
            source[0] += "\n".join(["", "```{toctree}", options, *entries, "```", ""])
