"""Commands on files and parts: convert, parts."""

from __future__ import annotations

from pathlib import Path

import click

import cuefem as cf
from cuefem.cli.output import assumption_lines, command, json_option, page_option, print_json
from cuefem.cli.scene_command import (
    Presentation,
    check_overwrite,
    force_option,
    load_with_options,
    shape_options,
)
from cuefem.cli.scene_options import CueFile, with_body_option, with_shaft_mass_option
from cuefem.cue import Cue
from cuefem.files import load, save
from cuefem.files.defaults_report import assumption_texts, drawing_assumptions


@command()
@click.argument("file", type=CueFile())
@click.argument("output", type=click.Path(path_type=Path))
@shape_options
@json_option
@force_option
def convert(file: Path, output: Path, force: bool, as_json: bool, **options: str | None) -> None:
    """Convert FILE to OUTPUT, whose extension sets the format: .toml or .vtu."""
    check_overwrite(output, force=force)
    given = {name: value for name, value in options.items() if value is not None}
    body_mass, shaft_mass = options["body_mass"], options["shaft_mass"]
    drawing = load_with_options(load, file, options)
    if body_mass is not None:
        drawing = with_body_option(drawing, file, body_mass)
    if shaft_mass is not None:
        drawing = with_shaft_mass_option(drawing, file, shaft_mass)
    save(drawing, output)
    notes = assumption_texts(drawing_assumptions(file, drawing, given), options) if isinstance(drawing, Cue) else []
    if as_json:
        print_json({"output_file": str(output), "assumptions": notes})
        return
    for line in (*assumption_lines(notes), f"wrote {output}"):
        click.echo(line)


@command()
@page_option
@json_option
def parts(as_json: bool, output: Path | None) -> None:
    """List the shafts, materials (wood, ferrule) and tips that a file can name, with their sources."""
    Presentation(cf.parts()).show(output, as_json=as_json)
