"""The documentation site: a home page, README, handbook, studies and notebooks of the repository, and the public names.

sphinx-build -W --keep-going -c .ci . site
"""

from __future__ import annotations

import ast
import inspect
import re
from collections import defaultdict
from pathlib import Path
from typing import Any

import latex2mathml.converter
from docutils import nodes
from pygments.lexers.special import TextLexer
from sphinx.application import Sphinx
from sphinx.domains.python import PyObject

import cuefem
from cuefem.handbook import MAKERS, chapters
from cuefem.handbook.page import SUBSCRIPT
from cuefem.show.analysis import Answer

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
root_doc = "index"
templates_path = [str(Path(__file__).parent / "templates")]
include_patterns = [
    "index.md",
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
for field in PyObject.doc_field_types:
    if field.name == "variable":  # what napoleon makes of a section Attributes
        field.label = "Attributes"
autodoc_typehints, autodoc_typehints_description_target = "description", "documented_params"
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
REFERENCE_HEAD = """# Python reference

`import cuefem as cf`. Lengths in m, masses in kg, times in s, angles in rad.

An answer to a question shows itself in a notebook and in print. It has `to_dict()`, `save(path)` (.html or .json),
`warnings` and `assumptions`; one that is a table has `to_frame()`. Its page lists its numbers, each with its unit.
"""
SUMMARY = """
## {title}

```{{eval-rst}}
.. currentmodule:: cuefem
.. autosummary::
   :toctree: api

{rows}
```
"""
TABLE = re.compile(r"^\| question \| answer \| page \|\n(?:\|.*\n)+", re.MULTILINE)
STUDY = re.compile(r"^\| (.+\?) \| (.+) \| \[(\w+)\]\((.+)\.md\) \|$", re.MULTILINE)
# The rows with figures have them as pictures.
CARD = """:::{{grid-item-card}} {question}
:link: /studies/{page}
:link-type: doc
{picture}
{answer}
:::
"""
PICTURE = """:img-top: /studies/{page}.svg
:img-alt: figure of the study {page}
"""
# Code in a line that begins with a name of the package: `cf.report(scene)`, `CueReport`.
NAME = re.compile(r"(?<![`\[])`((?:cf\.(?=\w)|(?=[A-Z]))(\w+)(?:\([^`<\n]*\))?)`(?!`)")
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
            contents("Project", "Studies </studies/README>", "README </README>", "/CHANGELOG", "/CONTRIBUTING"),
            "\n```{toctree}\n:hidden:\n:titlesonly:\n\n/meshes/README\n"
            + "\n".join(f"/{page}" for page in pages)
            + "\n```\n",
        ]
    )


def with_gallery(studies: str) -> str:
    """The list of studies with its table as a gallery: a card for each, those with a figure first."""
    rows = STUDY.findall(studies)
    cards = [study_card(question, answer, page) for question, answer, _, page in rows]
    cards.sort(key=lambda card: ":img-top:" not in card)
    grid = "::::{grid} 1 2 3 3\n:gutter: 3\n\n" + "\n".join(cards) + "\n::::\n"
    return TABLE.sub(lambda _: grid, studies, count=1)


def study_card(question: str, answer: str, page: str) -> str:
    """A card of the gallery."""
    has_picture = (ROOT / f"studies/{page}.svg").exists()
    picture = PICTURE.format(page=page) if has_picture else ""
    return CARD.format(question=question, answer=answer, page=page, picture=picture)


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
    text = REFERENCE_HEAD
    for title, rooms in TITLES.items():
        listed = [name for room in rooms for name in names.pop(room, [])]
        if listed:
            rows = "\n".join(f"   {name}" for name in listed)
            text += SUMMARY.format(title=title, rows=rows)
    if names:
        raise ValueError(f"public names of rooms without a title in TITLES: {dict(names)}")
    return text


def home() -> str:
    """The first page, with the answer of its own lines of Python, and the side bar."""
    text = (ROOT / ".ci/home.md").read_text(encoding="utf-8")
    lines = text.partition("```python\n")[2].partition("\n```")[0]
    return text.replace("FIRST_CONTACT", f"```{{raw}} html\n{last_answer(lines)._repr_html_()}\n```") + side_bar()


def last_answer(lines: str) -> Answer:
    """Run lines of Python; the value of the last one."""
    *statements, last = ast.parse(lines).body
    names: dict[str, Any] = {}
    exec(compile(ast.Module(statements, []), "home.md", "exec"), names)
    return eval(compile(ast.Expression(last.value), "home.md", "eval"), names)


def write_pages(app: Sphinx, config: Any) -> None:
    """Write the page of public names and, unless another page is the first, the home page: Sphinx reads files."""
    pages = {f"{REFERENCE}.md": reference()}
    if config.root_doc == root_doc:
        pages["index.md"] = home()
    for name, text in pages.items():
        path = ROOT / name
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


def docstring_read(app: Sphinx, kind: str, name: str, value: Any, options: Any, lines: list[str]) -> None:
    """The fields of an answer are its attributes: nobody makes one by its parameters."""
    if is_answer(value) and "Parameters" in lines:
        at = lines.index("Parameters")
        lines[at : at + 2] = ["Attributes", "----------"]


def signature_read(app: Sphinx, kind: str, name: str, value: Any, *more: Any) -> tuple[str, None] | None:
    """No parameters of an answer."""
    return ("", None) if is_answer(value) else None


def is_answer(value: Any) -> bool:
    """Whether a documented object is the class of an answer."""
    return inspect.isclass(value) and issubclass(value, Answer)


def source_read(app: Sphinx, document: str, source: list[str]) -> None:
    """Add what stands in no file: side bar, gallery, texts that the handbook's code adds, drawings."""
    text = WRITTEN.get(document, source[0])
    if document == "studies/README":
        text = with_gallery(text)
    if document == f"{HANDBOOK}/effects":
        text = with_worth(text)
    text = re.sub(r"\[([^\]]+)\]\([\w/]+/\)", r"`\1`", text)  # a folder is no page of the site
    if document != REFERENCE:
        text = NAME.sub(linked, text)
    source[0] = re.sub(r"```drawing\n(\w+)\n```", drawing, text)


def linked(code: re.Match[str]) -> str:
    """Code such as cf.report(scene) or CueReport as a link to the page of its public name."""
    return f"{{py:obj}}`{code[1]} <cuefem.{code[2]}>`" if code[2] in cuefem.__all__ else code[0]


def drawing(match: re.Match[str]) -> str:
    """A drawing of the handbook as part of the page: its colours are those of the page."""
    drawn = (ROOT / HANDBOOK / f"{match[1]}.svg").read_text(encoding="utf-8")
    return f"```{{raw}} html\n<figure class='drawing'>\n{drawn}</figure>\n```"


def doctree_read(app: Sphinx, tree: nodes.document) -> None:
    """Letters such as m_e with subscripts, as on the handbook's own page."""
    for text in list(tree.findall(nodes.Text)):
        if type(text.parent) in (nodes.paragraph, nodes.strong, nodes.emphasis):
            text.parent.replace(text, with_subscripts(text))


def with_subscripts(text: str) -> list[nodes.Node]:
    """Nodes of a text: the pieces between symbols, and each symbol's letters and its subscript."""
    pieces: list[nodes.Node] = []
    for i, piece in enumerate(SUBSCRIPT.split(text)):
        pieces.append(nodes.subscript(text=piece) if i % 3 == 2 else nodes.Text(piece))
    return pieces


def formula(display: str) -> tuple[Any, None]:
    """A visitor that writes LaTeX as MathML."""

    def visit(writer: Any, node: nodes.math) -> None:
        writer.body.append(latex2mathml.converter.convert(node.astext(), display=display))
        raise nodes.SkipNode

    return visit, None


WRITTEN = {f"{HANDBOOK}/{chapter.name}": chapter.text for chapter in chapters()}


def setup(app: Sphinx) -> None:
    """Connect the parts above."""
    app.add_lexer("csv", TextLexer)
    app.connect("config-inited", write_pages)
    app.connect("autodoc-process-docstring", docstring_read, priority=400)  # before napoleon reads the sections
    app.connect("autodoc-process-signature", signature_read)
    app.connect("source-read", source_read)
    app.connect("doctree-read", doctree_read)
    app.add_html_math_renderer("mathml", formula("inline"), formula("block"))
