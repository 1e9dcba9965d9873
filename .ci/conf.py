"""The documentation site: README, handbook, studies and notebooks of the repository, and the public names.

sphinx-build -W --keep-going -c .ci . site
"""

from __future__ import annotations

import inspect
import re
from collections import defaultdict
from pathlib import Path
from typing import Any

import latex2mathml.converter
from docutils import nodes
from pygments.lexers.special import TextLexer
from sphinx.application import Sphinx

import cuefem
from cuefem.handbook import MAKERS, chapters

ROOT = Path(__file__).parents[1]

project, author, release = "cuefem", "The cuefem developers", cuefem.__version__
extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.napoleon",
    "sphinx.ext.viewcode",
    "sphinx_design",
    "sphinx_copybutton",
]
root_doc = "README"
include_patterns = [
    "README.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "cuefem/handbook/**",
    "meshes/README.md",
    "studies/**.md",
    "studies/notebooks/**",
]
html_theme, html_title = "furo", f"cuefem {release}"
html_copy_source, html_show_sphinx = False, False
html_theme_options = {"navigation_with_keys": True}
html_static_path = ["site.css", "site.js", "../cuefem/handbook/content.css"]
html_css_files, html_js_files = ["content.css", "site.css"], [("site.js", {"defer": "defer"})]
default_role = "py:obj"  # a name in backticks is a link
html_math_renderer = "mathml"  # no script, no network
nb_execution_mode = "off"  # outputs as stored; tests/studies executes the notebooks
autosummary_generate = True
autodoc_typehints = "description"
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True}
napoleon_use_ivar = True  # a documented attribute that is a member, too, has one description
napoleon_google_docstring = False
myst_enable_extensions, myst_heading_anchors = ["colon_fence", "dollarmath"], 3
myst_fence_as_directive = ["math"]

HANDBOOK = "cuefem/handbook"
REFERENCE = f"{HANDBOOK}/api"
# The public names by the room of the package that defines them; a room without a title fails the build.
TITLES = {
    "A cue and a scene": ("cue", "scene", "parameters", "quantity"),
    "Files": ("files",),
    "Questions about a cue": ("analysis", "results", "report", "show"),
    "Natural frequencies and end mass": ("beam", "endmass", "solid"),
    "The strike": ("contact",),
    "Effects": ("effects",),
    "Studies and measurements": ("designs", "measurements"),
    "Figures": ("plot",),
}
SUMMARY = """
## {title}

```{{eval-rst}}
.. currentmodule:: cuefem
.. autosummary::
   :toctree: api

{rows}
```
"""
STUDY = re.compile(r"^\| (.+\?) \| (.+) \| \[(\w+)\]\((.+)\.md\) \|$", re.MULTILINE)
CARD = """::::{{grid-item-card}} {question}
{answer}
{picture}
```python
{example}
```

[{page}](/studies/{page}.md)
::::
"""
WORTH = """
- **Change of squirt in the reference scenes:** {least} to {most} % ([effects](/studies/contact/effects.md)).
"""


def contents(caption: str, *documents: str) -> str:
    """A table of contents of the side bar."""
    return "\n".join(["\n```{toctree}", ":hidden:", f":caption: {caption}", "", *documents, "```", ""])


def side_bar() -> str:
    """The tables of contents, in the order of the side bar."""
    engineers = [chapter.name for chapter in chapters() if chapter.name not in MAKERS]
    notebooks = re.findall(r"studies/notebooks/(\w+)\.ipynb", (ROOT / "README.md").read_text(encoding="utf-8"))
    # pages that the gallery opens; the side bar would have forty lines
    pages = sorted(
        str(path.relative_to(ROOT).with_suffix(""))
        for path in (ROOT / "studies").rglob("*.md")
        if path.parent != ROOT / "studies"
    )
    return "".join(
        [
            contents("For makers", *(f"/{HANDBOOK}/{name}" for name in MAKERS)),
            contents("For engineers", *(f"/{HANDBOOK}/{name}" for name in engineers)),
            contents("Python", f"/{REFERENCE}", *(f"/studies/notebooks/{name}" for name in notebooks)),
            contents("Project", "Studies and gallery </studies/README>", "/CHANGELOG", "/CONTRIBUTING"),
            "\n```{toctree}\n:hidden:\n:titlesonly:\n\n/meshes/README\n"
            + "\n".join(f"/{page}" for page in pages)
            + "\n```\n",
        ]
    )


def gallery() -> str:
    """The studies as cards: question, answer, picture, and the lines of Python that their pages end with."""
    rows = STUDY.findall((ROOT / "studies/README.md").read_text(encoding="utf-8"))
    cards = [study_card(question, answer, page) for question, answer, _, page in rows]
    return "\n## Gallery\n\n:::::{grid} 1\n" + "".join(cards) + ":::::\n"


def study_card(question: str, answer: str, page: str) -> str:
    """A card of the gallery."""
    text = (ROOT / f"studies/{page}.md").read_text(encoding="utf-8")
    has_picture = (ROOT / f"studies/{page}.svg").exists()
    return CARD.format(
        question=question,
        answer=answer,
        page=page,
        picture=f"\n```{{image}} /studies/{page}.svg\n:alt: figure of the study {page}\n```\n" if has_picture else "",
        example=text.partition("## In Python\n\n```python\n")[2].partition("\n```")[0],
    )


def with_worth(chapter: str) -> str:
    """The chapter of effects with what each effect changes in the reference scenes, from the study's first table."""
    study = (ROOT / "studies/contact/effects.md").read_text(encoding="utf-8")
    table = study.partition("## Change of squirt by the effect, %")[2].partition("\n## ")[0]
    for name, cells in re.findall(r"^\| ([A-Z]\w+) \| (.*) \|$", table, re.MULTILINE):
        changes = [cell.strip("*") for cell in cells.split(" | ") if cell != "–"]
        worth = WORTH.format(least=min(changes, key=float), most=max(changes, key=float))
        head, found, section = chapter.partition(f"\n## {name}\n")
        if not found:
            raise ValueError(f"the chapter of effects has no section {name}, which studies/contact/effects.md lists")
        lines, separator, rest = section.partition("\n## ")
        chapter = head + found + lines.rstrip() + worth + separator + rest
    return chapter


def room_of(name: str) -> str:
    """The room of the package that defines a public name."""
    value = getattr(cuefem, name)
    module = getattr(value, "__module__", None) or value.__name__
    return module.split(".")[1]


def is_documented(name: str) -> bool:
    """Whether a public name has a docstring of its own: a dataclass without one is given its signature."""
    text = inspect.getdoc(getattr(cuefem, name)) or ""
    return text != "" and not text.startswith(f"{name}(")


def reference() -> str:
    """Every public name under the title of its room."""
    undocumented = [name for name in cuefem.__all__ if not is_documented(name)]
    if undocumented:
        raise ValueError(f"public names without a docstring: {undocumented}")
    names = defaultdict(list)
    for name in sorted(cuefem.__all__, key=str.lower):
        names[room_of(name)].append(name)
    text = "# Python reference\n\n`import cuefem as cf`. Lengths in m, masses in kg, times in s, angles in rad.\n"
    for title, rooms in TITLES.items():
        listed = [name for room in rooms for name in names.pop(room, [])]
        if listed:
            rows = "\n".join(f"   {name}" for name in listed)
            text += SUMMARY.format(title=title, rows=rows)
    if names:
        raise ValueError(f"public names of rooms without a title in TITLES: {dict(names)}")
    return text


def write_reference(app: Sphinx, config: Any) -> None:
    """Write the page of public names, which autosummary reads from a file."""
    path = ROOT / f"{REFERENCE}.md"
    if not path.exists() or path.read_text(encoding="utf-8") != reference():
        path.write_text(reference(), encoding="utf-8")


def source_read(app: Sphinx, document: str, source: list[str]) -> None:
    """Add what stands in no file: side bar, gallery, texts that the handbook's code adds, drawings."""
    text = WRITTEN.get(document, source[0])
    if document == root_doc:
        text += side_bar()
    if document == "studies/README":
        text += gallery()
    if document == f"{HANDBOOK}/effects":
        text = with_worth(text)
    text = re.sub(r"\[([^\]]+)\]\([\w/]+/\)", r"`\1`", text)  # a folder is no page of the site
    source[0] = re.sub(r"```drawing\n(\w+)\n```", drawing, text)


def drawing(match: re.Match[str]) -> str:
    """A drawing of the handbook as part of the page: its colours are those of the page."""
    drawn = (ROOT / HANDBOOK / f"{match[1]}.svg").read_text(encoding="utf-8")
    return f"```{{raw}} html\n<figure class='drawing'>\n{drawn}</figure>\n```"


def formula(display: str) -> tuple[Any, None]:
    """A visitor that writes LaTeX as MathML."""

    def visit(writer: Any, node: nodes.math) -> None:
        writer.body.append(latex2mathml.converter.convert(node.astext(), display=display))
        raise nodes.SkipNode

    return visit, None


def redirect(app: Sphinx, error: Exception | None) -> None:
    """Let index.html open the first page."""
    page = f'<meta http-equiv="refresh" content="0; url={root_doc}.html">'
    Path(app.outdir, "index.html").write_text(page, encoding="utf-8")


WRITTEN = {f"{HANDBOOK}/{chapter.name}": chapter.text for chapter in chapters()}


def setup(app: Sphinx) -> None:
    """Connect the parts above."""
    app.add_lexer("csv", TextLexer)
    app.connect("config-inited", write_reference)
    app.connect("source-read", source_read)
    app.connect("build-finished", redirect)
    app.add_html_math_renderer("mathml", formula("inline"), formula("block"))
