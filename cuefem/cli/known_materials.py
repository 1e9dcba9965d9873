"""`cuefem materials`: the materials that a file can name."""

from __future__ import annotations

import click

from cuefem.cli.printing import json_option, tell
from cuefem.report import materials_record, materials_sheet


@click.command()
@json_option
def materials(as_json: bool) -> None:
    """List the materials that a file can name, with their sources."""
    found = materials_record()
    tell(as_json, found, [materials_sheet(found)])
