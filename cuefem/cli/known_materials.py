"""`cuefem materials`: the materials that a file can name."""

from __future__ import annotations

from pathlib import Path

import click

from cuefem.cli.printing import json_option, page_option, tell
from cuefem.report import materials_record, materials_sheet


@click.command()
@page_option
@json_option
def materials(as_json: bool, output: Path | None) -> None:
    """List the materials that a file can name, with their sources."""
    found = materials_record()
    tell(as_json, found, [materials_sheet(found)], output)
