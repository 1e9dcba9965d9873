"""The handbook's glossary on a page: each term is a button that opens its definition."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cache
from html import escape
from importlib.resources import files
from typing import NamedTuple

SKIPPED = ("head", "style", "script", "svg", "button", "h1", "h2", "h3", "summary", "a", "code", "label")
PARTS = ("section", "header")  # a term has one button in each of them
_TAG = re.compile(r"(<[^>]*>)")
_NAME = re.compile(r"</?([a-zA-Z0-9]+)")
_USED = re.compile(r'popovertarget="(w-[^"]*)"')


class Entry(NamedTuple):
    """Synonyms, and their definition as markdown."""

    words: tuple[str, ...]
    meaning: str

    @property
    def id(self) -> str:
        """Its id on a page."""
        return "w-" + re.sub(r"\W+", "-", self.words[0].lower())


@cache
def entries() -> tuple[Entry, ...]:
    """The entries of the handbook's glossary."""
    text = files("cuefem").joinpath("handbook/glossary.md").read_text(encoding="utf-8")
    _, *rows = (line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("| "))
    return tuple(Entry(tuple(words.split(", ")), meaning) for words, meaning in rows)


@cache
def _words() -> tuple[re.Pattern[str], dict[str, str]]:
    """A pattern of all terms and their plurals, the longest first; and the id of each term's entry."""
    known = {word.lower(): entry.id for entry in entries() for word in entry.words}
    longest = sorted(known, key=len, reverse=True)
    return re.compile(rf"(?<![\w/-])(?P<word>{'|'.join(map(re.escape, longest))})s?(?![\w/-])", re.IGNORECASE), known


def with_term_buttons(markup: str, names: Iterable[str] = ()) -> str:
    """Markup in which the first occurrence of each term in a section is a button that opens its definition.

    names: of cues, in which no word is a term.
    """
    terms, known = _words()
    whole = "|".join(re.escape(escape(name)) for name in sorted(names, key=len, reverse=True))
    pattern = re.compile(rf"(?<![\w/-])(?P<name>{whole})(?![\w/-])|{terms.pattern}", terms.flags) if whole else terms
    seen: set[str] = set()
    inside: list[str] = []

    def button(match: re.Match[str]) -> str:
        word = match["word"]
        if word is None or known[word.lower()] in seen:
            return match[0]
        entry = known[word.lower()]
        seen.add(entry)
        return f'<button type="button" class="term" popovertarget="{entry}">{match[0]}</button>'

    pieces = _TAG.split(markup)
    for i, piece in enumerate(pieces):
        if i % 2 == 0:
            pieces[i] = piece if inside else pattern.sub(button, piece)
            continue
        name = _NAME.match(piece)
        tag = name[1].lower() if name else ""
        if tag in PARTS:
            seen.clear()
        if tag in SKIPPED and not piece.endswith("/>"):
            if piece.startswith("</"):
                inside.pop()
            else:
                inside.append(tag)
    return "".join(pieces)


def definitions(used: set[str] | None = None) -> str:
    """The definitions that the buttons open, of all terms or of those with an id in ``used``; printed at the end."""
    shown = (
        f'<div popover id="{entry.id}" class="word"><b>{escape(", ".join(entry.words))}</b> '
        f"{_with_code(entry.meaning)}</div>"
        for entry in entries()
        if used is None or entry.id in used
    )
    return f'<aside class="words" aria-label="Glossary"><h2>Glossary</h2>{"".join(shown)}</aside>'


def _with_code(meaning: str) -> str:
    return subscripts(re.sub(r"`([^`]*)`", r"<code>\1</code>", escape(meaning)))


def subscripts(markup: str) -> str:
    """Markup with m_e and the like as subscripts."""
    return re.sub(r"(?<!\w)(\w)_(\w)(?!\w)", r"\1<sub>\2</sub>", markup)


def with_glossary(page: str, names: Iterable[str]) -> str:
    """A page with buttons for the terms of the glossary, outside of names of cues, and their definitions."""
    text = with_term_buttons(page, names)
    used = set(_USED.findall(text))
    return text.replace("<!-- words -->", definitions(used), 1) if used else text
