"""The handbook as one HTML page that needs no network."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cache
from html import escape
from importlib.resources import files
from itertools import zip_longest
from string import Template
from typing import Any

from markdown_it import MarkdownIt
from markdown_it.renderer import RendererHTML
from markdown_it.token import Token

from cuefem.handbook import CHAPTERS, MAKERS, Chapter, chapters
from cuefem.handbook.formulas import as_mathml
from cuefem.results.quantities import unbroken

SUBSCRIPT = re.compile(r"\b([A-Za-zα-ωΩ]{1,2})_([A-Za-z∥⊥0-9]{1,4})(?![A-Za-z0-9_])")
PAGE = Template("""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<link rel="icon" href="data:,">
<title>cuefem handbook</title>
<style>
$style</style>
</head>
<body>
<header>
<p class="kind">cuefem</p>
<p class="name">Handbook</p>
</header>
<nav aria-label="Contents">
<label for="search">Search</label>
<input id="search" type="search" autocomplete="off" placeholder="a word, such as bore" aria-controls="hits">
<p id="count" role="status"></p>
<ul id="hits"></ul>
<div id="contents">
<h2>For makers</h2>
<ol>
$makers</ol>
<h2>For engineers</h2>
<ol>
$engineers</ol>
</div>
</nav>
<main>
$body</main>
<script>
$script</script>
</body>
</html>
""")


def page(opens_with: str = CHAPTERS[0]) -> str:
    """The whole handbook with its table of contents; a browser shows one chapter at a time, first ``opens_with``."""
    entries, bodies = [], []
    every_chapter = chapters()
    for chapter, following in zip_longest(every_chapter, every_chapter[1:]):
        tokens, headings = _parsed(chapter.name, chapter.text)
        inner = "".join(f'<li><a href="#{anchor}">{escape(title)}</a></li>\n' for anchor, title in headings)
        below = f"<ul>\n{inner}</ul>\n" if inner else ""
        entries.append(f'<li><a href="#{chapter.name}">{escape(chapter.title)}</a>\n{below}</li>\n')
        html = _MARKDOWN.renderer.render(tokens, _MARKDOWN.options, {})
        html = html.replace("<table>", f"{_scrolled(chapter)}<table>").replace("</table>", "</table></div>")
        onward = (
            f'<p class="next"><a href="#{following.name}">Next: {escape(following.title)}</a></p>\n'
            if following
            else ""
        )
        first = ' class="first"' if chapter.name == opens_with else ""
        bodies.append(f"<section{first}>\n{html}{onward}</section>\n")
    drawings, own, script = (
        files(__package__).joinpath(name).read_text(encoding="utf-8")
        for name in ("content.css", "page.css", "search.js")
    )
    style = drawings + own
    makers, engineers = "".join(entries[: len(MAKERS)]), "".join(entries[len(MAKERS) :])
    return PAGE.substitute(style=style, script=script, makers=makers, engineers=engineers, body="".join(bodies))


def _scrolled(chapter: Chapter) -> str:
    """The start of a block that scrolls sideways where the window is narrow, also by keyboard."""
    return f'<div class="scroll" role="group" tabindex="0" aria-label="Table in {escape(chapter.title)}">'


def _text(_: object, tokens: Sequence[Token], index: int, *__: object) -> str:
    """A text token with letters such as m_e as subscripts, and its citations of chapters as links."""
    return _linked(SUBSCRIPT.sub(r"\1<sub>\2</sub>", escape(unbroken(tokens[index].content))))


def _linked(text: str) -> str:
    names = _names()
    title = "|".join(map(re.escape, names))
    cited = rf"(?<=handbook: )(?:{title})(?:, (?:{title}))*"

    def link(match: re.Match[str]) -> str:
        return f'<a href="#{names[match[0]]}">{match[0]}</a>'

    return re.sub(cited, lambda cited_title: re.sub(title, link, cited_title[0]), text)


@cache
def _names() -> dict[str, str]:
    """The chapters' names by their titles."""
    return {chapter.title: chapter.name for chapter in chapters()}


def _fence(renderer: RendererHTML, tokens: Sequence[Token], index: int, *more: Any) -> str:
    """A block of code; one of the kind "math" is a formula, "drawing" names a drawing beside this file."""
    token = tokens[index]
    if token.info == "math":
        return f'<div class="formula" tabindex="0">{as_mathml(token.content)}</div>\n'
    if token.info != "drawing":
        return RendererHTML.fence(renderer, tokens, index, *more).replace("<pre>", '<pre tabindex="0">', 1)
    drawn = files(__package__).joinpath(f"{token.content.strip()}.svg").read_text(encoding="utf-8")
    return f"<figure>\n{drawn}</figure>\n"


_MARKDOWN = MarkdownIt("commonmark", {"html": False}).enable("table")
_MARKDOWN.add_render_rule("text", _text)
_MARKDOWN.add_render_rule("fence", _fence)


def _parsed(name: str, text: str) -> tuple[list[Token], list[tuple[str, str]]]:
    """A chapter's tokens with anchors at the headings, and anchor and title of those below the chapter's own."""
    tokens, headings = _MARKDOWN.parse(text), []
    for i, token in enumerate(tokens):
        if token.type == "heading_open":
            title = tokens[i + 1].content
            anchor = name if token.tag == "h1" else f"{name}-{re.sub(r'[^a-z0-9]+', '-', title.lower()).strip('-')}"
            token.attrSet("id", anchor)
            if token.tag == "h2":
                headings.append((anchor, title))
    return tokens, headings
