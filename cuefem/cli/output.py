"""Output of commands: tables and text in the terminal, pages, and JSON."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import click
from click.core import ParameterSource

from cuefem.files import InputError, check_writable
from cuefem.files.defaults_report import Assumption
from cuefem.files.shop import shop_of
from cuefem.quantity.display_units import SYSTEMS, displayed_in
from cuefem.quantity.encoding import is_unicode
from cuefem.show.renderers import json_text

# The heading of an option that many commands share, in the order of a command's help.
HEADINGS = ("Cue", "Tip", "Stroke", "Output")
UNITS_VARIABLE = "CUEFEM_UNITS"  # of the environment
LAST = ("output", "as_json", "units", "force")  # under their heading, in every command's help


class SharedOption(click.Option):
    """An option listed under a heading, below the command's own options."""

    def __init__(self, *names: Any, heading: str, **about: Any) -> None:
        super().__init__(*names, **about)
        self.heading = heading


def _units_option() -> SharedOption:
    """The option of every command for the units of display."""
    return SharedOption(
        ["--units"],
        heading="Output",
        type=click.Choice([*SYSTEMS]),
        default="metric",
        envvar=UNITS_VARIABLE,
        show_envvar=True,
        is_eager=True,
        help="Units in the terminal and on pages; us: in, oz, lbf, psi and mph.",
    )


class Command(click.Command):
    """A command whose help shows its own options first and shared ones under their headings."""

    def __init__(self, *names: Any, **about: Any) -> None:
        super().__init__(*names, **about)
        self.params.append(_units_option())

    def invoke(self, ctx: click.Context) -> Any:
        """Run it in the chosen units of display; what becomes JSON alone is metric in every text."""
        system = ctx.params.pop("units")
        if ctx.get_parameter_source("units") is ParameterSource.DEFAULT:
            system = _shop_units(ctx) or system
        with displayed_in("metric" if ctx.params.get("as_json") and not ctx.params.get("output") else system):
            return super().invoke(ctx)

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the options, a group under each heading."""
        options = [p for p in self.get_params(ctx) if isinstance(p, click.Option)]
        options.sort(key=lambda p: LAST.index(p.name) if p.name in LAST else -1)
        for heading in ("", *HEADINGS):
            records = (p.get_help_record(ctx) for p in options if getattr(p, "heading", "") == heading)
            if rows := [record for record in records if record]:
                with formatter.section(heading or "Options"):
                    formatter.write_dl(rows)


def shared_option(heading: str, *names: str, **about: Any) -> Callable[[Any], Any]:
    """An option under a heading."""
    return click.option(*names, cls=SharedOption, heading=heading, **about)


def _shop_units(ctx: click.Context) -> str | None:
    """The units of the shop.toml of a command's file, or of the working folder."""
    typed = ctx.params.get("file") or ctx.params.get("scene") or next(iter(ctx.params.get("files") or ()), None)
    return shop_of(typed if isinstance(typed, Path) else Path()).defaults.units


command = partial(click.command, cls=Command)

# The option of every command, for programs.
json_option = shared_option("Output", "--json", "as_json", is_flag=True, help="Print JSON (SI units).")

# The formats of -o by extension, as its help names them.
FORMATS = {
    ".html": ".html (page)",
    ".csv": ".csv (table)",
    ".parquet": ".parquet (table, needs pyarrow)",
    ".json": ".json",
    ".toml": ".toml (drawing, scene or calibration)",
    "": "a FOLDER of tables",
}


class Output(click.Path):
    """A file to write; its extension sets the format. ValueError before the computation if it cannot be written."""

    def __init__(self, extensions: Sequence[str]) -> None:
        super().__init__(path_type=Path)
        self.extensions = extensions

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """The path, if the command writes its extension."""
        path = Path(os.fsdecode(super().convert(value, param, ctx)))
        if path.suffix.lower() not in self.extensions:
            wanted = " or ".join(filter(None, self.extensions))
            more = "; --store names the file of stored designs" if path.suffix.lower() == ".sqlite" else ""
            more = "; a page (.html) has the figures" if path.suffix.lower() in (".png", ".svg", ".pdf") else more
            raise InputError(path, "--output", f"must end in {wanted}; got {path.suffix!r}{more}")
        if not path.suffix and path.exists() and not path.is_dir():
            raise InputError(path, "--output", "must be a folder; a file of this name exists")
        if path.suffix.lower() != ".toml":  # a command that writes a drawing checks it itself
            check_writable(path / "table.json" if path.is_dir() and not path.suffix else path)
        return path


def output_option(*extensions: str, required: bool = False, many: bool = False) -> Callable[..., Any]:
    """The option -o of every command, with the formats by extension; many: whether it is repeatable."""
    *others, last = (FORMATS[extension] for extension in extensions)
    formats = f"{', '.join(others)}{' or ' if others else ''}{last}"
    text = f"Write the result to FILE: {formats}; the extension sets the format.{' Repeatable.' if many else ''}"
    return shared_option(
        "Output",
        *("-o", "--output"),
        type=Output(extensions),
        metavar="FILE",
        help=text,
        required=required,
        multiple=many,
    )


# Of commands whose page is their tables.
page_option = output_option(".html", ".json")


def assumption_lines(notes: Sequence[Assumption]) -> list[str]:
    """The assumptions, one per line, each with its option; empty without assumptions."""
    return ["assumed:", *(f"  {note}" for note in notes)] if notes else []


def print_json(record: Any) -> None:
    """Print a record as JSON, escaped where stdout lacks characters."""
    click.echo(json_text(record, escaped=not is_unicode(sys.stdout.encoding)))
