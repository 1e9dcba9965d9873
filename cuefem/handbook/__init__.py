"""The handbook: the physics behind the package, one chapter a file, and each effect's five lines from its docstring."""

from __future__ import annotations

import inspect
import re
from importlib.resources import files
from typing import NamedTuple

from cuefem.handbook.formulas import with_plain_formulas

__all__ = ["CHAPTERS", "LINES", "MAKERS", "Chapter", "FoundSection", "chapters", "effect_lines", "sections_with"]

# The chapters' files in the order of reading, first those for makers (tests/helpers/maker_pictures.py draws for them).
MAKERS = (
    "what_squirt_is",
    "measure_your_shaft",
    "read_the_report",
    "design_changes",
    "weigh_and_tap",
    "limits",
)
CHAPTERS = (
    *MAKERS,
    "start",
    "model",
    "files",
    "study",
    "working",
    "frame",
    "inverse_mass",
    "impulse_solver",
    "beam",
    "solid",
    "strike",
    "contact",
    "end_mass",
    "side",
    "effects",
    "measured",
    "measuring",
    "accuracy",
    "paper",
    "glossary",
    "terms",
    "sources",
)
# The headed lines of every effect's docstring, in their order.
LINES = ("Adds", "Matters when", "Wrong when", "Limit", "Source")
# How a response's argument is written: an offset b/R is optional.
ARGUMENTS = {"": "", "mode": "(n)", "offset": "[(b)]"}


class Chapter(NamedTuple):
    """A chapter: the name of its file, its title, and its markdown text with the title as its first line."""

    name: str
    title: str
    text: str


def chapters() -> tuple[Chapter, ...]:
    """Every chapter in the order of reading, the effects' lines included."""
    return tuple(_chapter(name) for name in CHAPTERS)


class FoundSection(NamedTuple):
    """A section that contains a word: its chapter's name, its heading, and the count of the word."""

    chapter: str
    title: str
    matches: int


def sections_with(word: str) -> tuple[FoundSection, ...]:
    """The sections with words that begin with ``word``, in upper or lower case, in the order of reading."""
    pattern = re.compile(rf"\b{re.escape(word)}", re.IGNORECASE)
    sections = []
    for chapter in chapters():
        for text in re.split(r"\n(?=## )", with_plain_formulas(chapter.text)):
            title = text.partition("\n")[0].lstrip("# ")
            if matches := len(pattern.findall(text)):
                sections.append(FoundSection(chapter.name, title, matches))
    return tuple(sections)


def _chapter(name: str) -> Chapter:
    text = files(__package__).joinpath(f"{name}.md").read_text(encoding="utf-8")
    title = text.partition("\n")[0].removeprefix("# ")
    more = {"effects": _every_effect, "study": _every_response}.get(name, str)
    return Chapter(name, title, text + more())


def effect_lines(effect: type) -> dict[str, str]:
    """The five lines of an effect's docstring by their headings."""
    lines = {}
    for paragraph in (inspect.getdoc(effect) or "").split("\n\n"):
        head, _, rest = paragraph.removeprefix("Notes\n-----\n").partition(":")
        if head in LINES:
            lines[head] = " ".join(rest.split())
    return lines


def _every_effect() -> str:
    """The effects as markdown: a heading, the summary and the five lines of each."""
    from cuefem.effects.effect import effect_kinds  # loaded when used: the list of chapters needs no numpy

    parts = []
    for name, kind in effect_kinds().items():
        summary = (inspect.getdoc(kind) or "").partition("\n")[0]
        lines = "\n".join(f"- **{head}:** {text}" for head, text in effect_lines(kind).items())
        parts.append(f"\n## {name}\n\n{summary}\n\n{lines}\n")
    return "".join(parts)


def _every_response() -> str:
    """The responses of studies as a table: name, display unit, definition, and which direction is better."""
    from cuefem.parameters.table import PARAMETERS
    from cuefem.quantity.display_units import display_unit
    from cuefem.results.computable_results import computable_results

    rows = [
        f"| `{name}{ARGUMENTS[result.argument]}` | {display_unit(result.display_key).name} "
        f"| {result.about or result.label} | {result.better} |"
        for name, result in computable_results().items()
    ]
    names = ", ".join(f"`{known.name}`" for known in PARAMETERS.values())
    table = "\n".join(["| response | unit | what it is | better |", "|---|---|---|---|", *rows])
    return f"{table}\n\n## Parameters by name\n\n{names}.\n"
