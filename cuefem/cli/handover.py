"""`cuefem handover`: the end mass for other people's software."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from cuefem.cli.common import blaming, file_options, head_lines, scene_of
from cuefem.cli.definitions import Definitions, WithDefinitions
from cuefem.cli.printing import print_all
from cuefem.cli.strokes import blow_options, measured, offset_option
from cuefem.io import InputError, write_whole
from cuefem.quantity import LENGTH
from cuefem.report.handover import handover_sheet, handover_words, pooltool_record
from cuefem.report.record import scene_record
from cuefem.report.table import json_text
from cuefem.report.unusual import unusual


@click.command(cls=WithDefinitions)
@file_options
@blow_options
@offset_option
@click.option(
    "--for", "whom", type=click.Choice(["pooltool"]), help="Print the JSON of this simulator, as --json does."
)
@click.option(
    "--drive",
    type=Definitions("A.31"),
    default="A.31",
    show_default=True,
    help="Which definition of the end mass.",
)
@click.option("--length", metavar="LENGTH", help="Of the whole cue; by default the drawing's, or 58 in behind a shaft.")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    metavar="CUE.json",
    help="Write to a file; with --json print it too.",
)
def handover(
    file: Path, whom: str | None, drive: Any, length: str | None, output: Path | None, as_json: bool, **given: Any
) -> None:
    """Show the end mass for a simulator, against the offset; as JSON for the simulator itself.

    The JSON (--json, --for pooltool, or into a file with -o) has pooltool's CueSpecs, says what the number means and
    how well it works.
    """
    if output is not None and output.suffix != ".json":
        raise InputError(output, "--output", f"must end in .json; got {output.suffix!r}")
    scene, notes = scene_of(file, given)
    with blaming(file, given):
        whole = None if length is None else measured(file, "--length", length, LENGTH)
        found = pooltool_record(file.stem, scene, drive=drive, length=whole)
    found["notes"] += [f"assumed: {note}" for note in notes] + [f"unusual: {remark}" for remark in unusual(scene)]
    text = json_text(found)
    if output is not None:
        write_whole(output, lambda temporary: temporary.write_text(text + "\n", encoding="utf-8"))
    if as_json or (output is None and whom is not None):
        click.echo(text)
        return
    first = [f"wrote {output}"] if output else head_lines(file, scene_record(scene), scene.effects, notes)
    more = (
        [] if output else [handover_words(found), "-o CUE.json writes the file that pooltool reads, --json prints it"]
    )
    print_all([*first, "", handover_sheet(found), *more])
