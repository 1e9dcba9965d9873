"""The command that opens the handbook."""

from __future__ import annotations

import tempfile
import webbrowser
from pathlib import Path

import click
from rich.console import Console
from rich.markdown import Markdown

from cuefem.cli.output import command, json_option, page_option, print_json
from cuefem.handbook import CHAPTERS, chapters
from cuefem.handbook.page import page
from cuefem.io import InputError, save_page
from cuefem.io.errors import suggestion


def _known(context: click.Context, parameter: click.Parameter, chapter: str | None) -> str | None:
    if chapter is None or chapter in CHAPTERS:
        return chapter
    raise ValueError(f"CHAPTER must be one of {', '.join(CHAPTERS)}; got {chapter!r}{suggestion(chapter, CHAPTERS)}")


@command()
@click.argument("chapter", callback=_known, required=False, metavar="[CHAPTER]")
@page_option
@json_option
@click.option("--print", "in_terminal", is_flag=True, help="Print the text in the terminal.")
def guide(chapter: str | None, output: Path | None, in_terminal: bool, as_json: bool) -> None:
    """Open the handbook in the browser: six pages for makers, then physics, effects, accuracy and a glossary.

    CHAPTER opens one chapter (--print: prints it). For makers: what_squirt_is, measure_your_shaft, read_the_report,
    design_changes, weigh_and_tap or limits. For engineers: start, model, files, study, working, frame,
    inverse_mass, impulse_solver, beam, solid, strike, contact, end_mass, side, effects, measured, measuring, accuracy,
    paper, glossary, terms or sources.
    """
    requested = [part for part in chapters() if chapter in (None, part.name)]
    if as_json:
        print_json({part.name: part.text for part in requested})
        return
    if in_terminal:
        if output is not None:
            raise InputError(output, "--output", "cannot be combined with --print, which writes no page")
        _print([part.text for part in requested])
        return

    if output is not None:
        save_page(page(), output)
        click.echo(f"wrote {output}")
        return

    with tempfile.NamedTemporaryFile(prefix="cuefem-guide-", suffix=".html", delete=False) as file:
        path = Path(file.name)
    path.write_text(page(), encoding="utf-8")
    address = path.as_uri() + (f"#{chapter}" if chapter else "")
    click.echo(f"opened {address}" if webbrowser.open(address) else f"no browser found; open this file in one: {path}")


def _print(texts: list[str]) -> None:
    console = Console()
    if not console.is_terminal:
        console.width = 100
    for i, text in enumerate(texts):
        if i:
            console.print()
        console.print(Markdown(text))
