"""Settings of the manual: the Markdown pages of the repository, as HTML that needs no network."""

import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "docs"))

project = "impinge"
author = copyright = "impinge contributors"
release = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]["version"]
language = "en"

extensions = ["myst_parser", "manual.contents", "manual.formulas"]
root_doc = "docs/index"
include_patterns = [
    "README.md",
    "docs/*.md",
    "docs/*/*.md",
    "examples/*/README.md",
    "python/README.md",
    "build-fmu/README.md",
    "benches/README.md",
    "tests/verification/README.md",
    "ARCHITECTURE.md",
    "CONTRIBUTING.md",
    "CHANGELOG.md",
]
exclude_patterns = [".*", "target", "out"]
myst_enable_extensions = ["dollarmath"]  # $…$ and $$…$$, which code hosts render, too
myst_heading_anchors = 4  # the anchors that code hosts give to headings
suppress_warnings = ["myst.header"]  # docs/scene.md keeps its second level for tables of keys

html_theme = "furo"
html_title = f"impinge {release}"
html_math_renderer = "outlines"
html_copy_source = False
html_show_sphinx = False
html_static_path = ["manual/static"]
html_css_files = ["manual.css"]
html_additional_pages = {"index": "redirect.html"}
templates_path = ["manual/templates"]
