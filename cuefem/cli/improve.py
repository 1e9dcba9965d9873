"""`cuefem improve`: what a maker can change, and what each change is worth."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from cuefem.cli.common import blaming, check_free, force_option, scene_of, show, stroke_options
from cuefem.cli.printing import output_option
from cuefem.cli.progress import followed
from cuefem.design.advice import advice_record
from cuefem.io import InputError, save
from cuefem.report.advice_table import advice_sheet
from cuefem.vary import varied


@click.command()
@stroke_options
@output_option(".html", ".toml")
@click.option(
    "--take", type=click.IntRange(min=1), metavar="ROW", help="Save the cue of this row of the table, 1 the first."
)
@force_option
def improve(file: Path, take: int | None, output: Path | None, force: bool, **options: Any) -> None:
    """Show what would change squirt: what a maker can do to this cue, with stiffness, weight and first tone.

    Each change alone, by the whole stroke; the least squirt first.
    """
    drawing = output is not None and output.suffix == ".toml"
    if (take is not None) != drawing:
        raise InputError(file, "--take", "goes with -o FILE.toml, and that with --take: the row, and the file to save")
    if take is None or output is None:
        show(
            file,
            {**options, "output": output},
            lambda scene: advice_record(scene, follow=followed),
            lambda record, about: [advice_sheet(record)],
        )
        return
    check_free(output, force=force)
    scene, _ = scene_of(file, options)
    with blaming(file, options):
        rows = advice_record(scene, follow=followed)["changes"]
    if take > len(rows):
        raise InputError(file, "--take", f"must be a row of the table, 1 to {len(rows)}; got {take}")
    row = rows[take - 1]
    save(varied(scene, row["set"]), output)
    click.echo(f"wrote {output}: {row['change']}")
