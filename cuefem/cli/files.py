"""Commands about files: convert, schema, materials."""

from __future__ import annotations

import json
from pathlib import Path

import click

from cuefem.cli.common import print_all, print_json


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.argument("output", type=click.Path(path_type=Path))
@click.option("--material", metavar="NAME", help="Material of a .csv or surface (see `cuefem materials`).")
@click.option("--length-unit", metavar="UNIT", help="Unit of a .stl, .ply or .obj surface; mm if left out.")
def convert(file: Path, output: Path, **given: str | None) -> None:
    """Write FILE as another kind of file: OUTPUT ends in .toml, .vtk or .vtu."""
    from cuefem.io import load, save
    from cuefem.io.assumed import assumed
    from cuefem.io.profile import SHAPES

    save(load(file, **given), output)
    said = {"body_mass", *(name for name, value in given.items() if value is not None)}
    notes = assumed(file, said) if file.suffix.lower() in SHAPES else []
    if notes:
        click.echo(f"assumed: {'; '.join(notes)}")


@click.command()
@click.option("--json", "as_json", is_flag=True, help="The same: the schema is JSON.")
def schema(as_json: bool) -> None:
    """JSON schema of cue and scene files, for editors."""
    from cuefem.io.export import json_schema

    click.echo(json.dumps(json_schema(), indent=2, allow_nan=False, ensure_ascii=False))


@click.command()
@click.option("--json", "as_json", is_flag=True, help="As JSON.")
def materials(as_json: bool) -> None:
    """The materials that a file can name, with their sources."""
    from cuefem.report import materials_record, materials_table

    found = materials_record()
    if as_json:
        print_json(found)
    else:
        print_all([materials_table(found)])
