"""How Sphinx builds the documentation."""

import json
import pkgutil
import sys
from importlib.metadata import version as installed_version
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))  # for generated.py beside this file

import generated

import railquake
from railquake.measures import Kind

project = "railquake"
author = "The railquake authors"
copyright = "2026, The railquake authors"
release = installed_version("railquake")
version = release

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.mathjax",
    "sphinx.ext.napoleon",
    "sphinx.ext.viewcode",
]
# the latter two are included by other pages
exclude_patterns = ["_build", "reference/channels.md", "reference/measures-*.md"]
templates_path = ["_templates"]

myst_enable_extensions = ["amsmath", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3

autosummary_generate = True
# A name is described where it is defined; a package that passes it on would describe it twice.
autodoc_default_options = {"ignore-module-all": True}
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
napoleon_google_docstring = False
napoleon_use_rtype = False

html_theme = "furo"
html_title = f"railquake {release}"


def write_reference(app):
    """Write the pages that follow from the package's own models, before Sphinx reads any."""
    folder = Path(app.srcdir) / "reference"
    folder.mkdir(exist_ok=True)
    pages = {
        "case-file.md": generated.case_file(),
        "presets.md": generated.presets(),
        "rows.md": generated.rows(),
        "slots.md": generated.slots(),
        "channels.md": generated.channels(),
        **{f"measures-{kind.name.lower()}.md": generated.measures(kind) for kind in Kind},
        "case.schema.json": json.dumps(generated.schema(), indent=2) + "\n",
    }
    for name, text in pages.items():
        path = folder / name
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")  # an unchanged page is not built again


def forget_modules_that_left(app):
    """Remove the pages of modules that are no more; autosummary would leave them to fail."""
    modules = pkgutil.walk_packages(railquake.__path__, "railquake.")
    known = {"railquake", *(module.name for module in modules)}
    for path in (Path(app.srcdir) / "reference").glob("*.rst"):
        if path.stem not in known:
            path.unlink()


def setup(app):
    app.connect("builder-inited", write_reference)
    app.connect("builder-inited", forget_modules_that_left, priority=100)  # before autosummary
