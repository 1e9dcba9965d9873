"""`cuefem materials` and `cuefem parts`: the materials and the parts that a file can name."""

from __future__ import annotations

from pathlib import Path

import click

from cuefem.cli.printing import json_option, page_option, tell
from cuefem.report import materials_record, materials_sheet
from cuefem.report.materials_table import parts_record, parts_sheets


@click.command()
@page_option
@json_option
def materials(as_json: bool, output: Path | None) -> None:
    """List the materials that a file can name, with their sources."""
    found = materials_record()
    tell(as_json, found, [materials_sheet(found)], output)


@click.command()
@page_option
@json_option
def parts(as_json: bool, output: Path | None) -> None:
    """List the shafts, woods, ferrules and tips of which a cue is put together by name, with their sources."""
    found = parts_record()
    tell(as_json, found, parts_sheets(found), output)
