"""The command that opens the handbook."""

from __future__ import annotations

import difflib
import tempfile
import webbrowser
from pathlib import Path

import click
from rich.console import Console
from rich.markdown import Markdown

from cuefem.cli.output import command, json_option, page_option, print_json
from cuefem.files import InputError
from cuefem.handbook import CHAPTERS, chapters, sections_with
from cuefem.handbook.formulas import with_plain_formulas
from cuefem.handbook.page import page
from cuefem.show.analysis import write


@command()
@click.argument("subject", required=False, metavar="[CHAPTER or WORD]")
@page_option
@json_option
@click.option("--print", "in_terminal", is_flag=True, help="Print the text in the terminal.")
def guide(subject: str | None, output: Path | None, in_terminal: bool, as_json: bool) -> None:
    """Open the handbook in the browser: six pages for makers, then physics, effects, accuracy and a glossary.

    CHAPTER opens one chapter (--print: prints it), a WORD lists the sections that contain it. For makers:
    what_squirt_is, measure_your_shaft, read_the_report, design_changes, weigh_and_tap or limits. For engineers: start,
    model, files, study, working, frame, inverse_mass, impulse_solver, beam, solid, strike, contact, end_mass, side,
    effects, measured, measuring, accuracy, paper, glossary, terms or sources.
    """
    if in_terminal and output is not None:
        raise InputError(output, "--output", "cannot be combined with --print, which writes no page")
    if subject is not None and subject not in CHAPTERS:
        if output is not None:
            raise InputError(output, "--output", f"needs a CHAPTER or none; got {subject!r}: use --json")
        _list_sections(subject, as_json)
        return
    requested = [chapter for chapter in chapters() if subject in (None, chapter.name)]
    record = {chapter.name: chapter.text for chapter in requested}
    if output is not None:
        write(output, lambda: record, lambda: page(opens_with=subject or CHAPTERS[0]))
    if as_json:
        print_json(record)
    elif output is not None:
        click.echo(f"wrote {output}")
    elif in_terminal:
        _print([with_plain_formulas(text) for text in record.values()])
    else:
        _open(subject)


def _list_sections(word: str, as_json: bool) -> None:
    """Print the sections that contain a word; ValueError if no section does."""
    sections = sections_with(word)
    if not sections:
        near = difflib.get_close_matches(word, CHAPTERS, n=3, cutoff=0.3)
        nearest = f"; the nearest chapters are {', '.join(near)}" if near else ""
        raise ValueError(f"CHAPTER must be a chapter, or a word of the handbook; got {word!r}{nearest}")
    if as_json:
        print_json([section._asdict() for section in sections])
        return
    click.echo(
        f"{len(sections)} section{'s' if len(sections) > 1 else ''} with {word!r}; cuefem guide CHAPTER opens one:"
    )
    for section in sections:
        click.echo(f"  {section.chapter:20} {section.title} ({section.matches})")


def _open(chapter: str | None) -> None:
    """Write the page to a temporary file, and open it in a browser."""
    with tempfile.NamedTemporaryFile(
        "w", encoding="utf-8", prefix="cuefem-guide-", suffix=".html", delete=False
    ) as file:
        file.write(page())
    address = Path(file.name).as_uri() + (f"#{chapter}" if chapter else "")
    click.echo(
        f"opened {address}" if webbrowser.open(address) else f"no browser found; open this file in one: {file.name}"
    )


def _print(texts: list[str]) -> None:
    console = Console()
    if not console.is_terminal:
        console.width = 100
    for i, text in enumerate(texts):
        if i:
            console.print()
        console.print(Markdown(text))
