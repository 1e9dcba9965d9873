"""Commands on cues that somebody measured: compare, estimate."""

from __future__ import annotations

from pathlib import Path

import click

from cuefem.cli.common import blaming, remark, whole_record
from cuefem.cli.printing import assumed_lines, json_option, page_option, tell
from cuefem.cli.progress import followed
from cuefem.io import InputError, save_page
from cuefem.io.documented_folder import load_documented, write_template
from cuefem.measured.documented import compare as compared
from cuefem.measured.documented import zeros
from cuefem.measured.estimate import estimate as estimated
from cuefem.measured.estimate import squirt_of
from cuefem.report.documented_page import (
    compare_page,
    compare_record,
    compare_sheets,
    estimate_record,
    estimate_sheets,
)


@click.command()
@click.argument("folder", metavar="CUE_FOLDER", type=click.Path(path_type=Path))
@click.option("--template", is_flag=True, help="Make CUE_FOLDER with files to fill in, instead.")
@page_option
@json_option
def compare(folder: Path, template: bool, output: Path | None, as_json: bool) -> None:
    """Compute everything that was measured on the cue in CUE_FOLDER, and show both with errors and residuals.

    The folder holds the shaft's drawing, cue.toml or cue.csv; measured.toml, with what was measured; and long series as
    a CSV each, squirt.csv and added_mass.csv for two. Only the drawing must be there. Nothing is fitted.
    """
    if template:
        write_template(folder)
        click.echo(f"wrote {folder}: its numbers are examples; put yours, then `cuefem compare {folder}`")
        return
    if output is not None and as_json:
        raise InputError(output, "--output", "must be left out with --json: a page is no JSON")
    cue, notes = load_documented(folder)
    remark(cue.scene)
    with blaming(folder):
        rows = compared(cue, track=followed)
        record = compare_record(cue, rows, zeros(cue, rows))
    if output is not None:
        save_page(compare_page(cue, rows, record, notes), output)
        click.echo(f"wrote {output}")
        return
    whole = whole_record(folder, notes, cue.scene, record)
    tell(as_json, whole, [cue.name, *assumed_lines(notes), "", *compare_sheets(record)])


@click.command()
@click.argument("folder", metavar="CUE_FOLDER", type=click.Path(path_type=Path))
@page_option
@json_option
def estimate(folder: Path, output: Path | None, as_json: bool) -> None:
    """Find the wood, the bore and the tip that all measurements in CUE_FOLDER together make most likely.

    The folder is that of `cuefem compare`. The priors are those of the table of materials and of the folder's
    [[unknowns]]. Then: which measurement would tell most.
    """
    cue, notes = load_documented(folder)
    remark(cue.scene)
    with blaming(folder):
        found, target = estimated(cue, track=followed), squirt_of(cue)
        record = estimate_record(found, found.next(), found.predicted(target), target.offset)
    whole = whole_record(folder, notes, cue.scene, record)
    tell(as_json, whole, [cue.name, *assumed_lines(notes), "", *estimate_sheets(record)], output)
