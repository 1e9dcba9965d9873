"""`cuefem materials`: the materials that a file can name."""

from __future__ import annotations

import click

from cuefem.cli.printing import json_option, print_all, print_json
from cuefem.report import materials_record, materials_sheet


@click.command()
@json_option
def materials(as_json: bool) -> None:
    """List the materials that a file can name, with their sources."""
    found = materials_record()
    if as_json:
        print_json(found)
    else:
        print_all([materials_sheet(found)])
