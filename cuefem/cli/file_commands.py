"""Commands on files and parts: convert, parts."""

from __future__ import annotations

from pathlib import Path

import click

import cuefem as cf
from cuefem.cli.output import assumption_lines, command, json_option, page_option, print_json
from cuefem.cli.request import Request
from cuefem.cli.scene_command import (
    Presentation,
    check_overwrite,
    force_option,
    shape_options,
)
from cuefem.cli.scene_options import CueFile
from cuefem.files import save_changed


@command()
@click.argument("file", type=CueFile())
@click.argument("output", type=click.Path(path_type=Path))
@shape_options
@json_option
@force_option
def convert(file: Path, output: Path, force: bool, as_json: bool, **options: str | None) -> None:
    """Convert FILE to OUTPUT, whose extension sets the format: .toml or .vtu."""
    check_overwrite(output, force=force)
    request = Request.of(file, options)
    save_changed(request.drawing, output, file)
    notes = request.assumptions_of_drawing
    if as_json:
        print_json({"output_file": str(output), "assumptions": [*map(str, notes)]})
        return
    for line in (*assumption_lines(notes), f"wrote {output}"):
        click.echo(line)


@command()
@page_option
@json_option
def parts(as_json: bool, output: Path | None) -> None:
    """List the shafts, materials (wood, ferrule) and tips that a file can name, with their sources."""
    Presentation(cf.parts()).show(output, as_json=as_json)
