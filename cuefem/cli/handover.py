"""`cuefem strike --for`: the end mass of a stroke for other people's software."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from cuefem.cli.common import blaming, head_lines, scene_of
from cuefem.cli.definitions import Definitions
from cuefem.cli.printing import output_option, print_all, tell
from cuefem.cli.strokes import measured
from cuefem.io import write_whole
from cuefem.quantity import LENGTH
from cuefem.report.handover import handover_sheet, handover_words, pooltool_record
from cuefem.report.record import scene_record
from cuefem.report.table import json_text
from cuefem.report.unusual import unusual

DRIVE = "A.31"
ONLY = "must go with --for pooltool, for which it is; got no --for"


def simulator_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The options of a stroke that is for a simulator."""
    for option in (
        output_option(".html", ".json"),
        click.option("--length", metavar="LENGTH", help="Of the whole cue, --for; by default the drawing's, or 58 in."),
        click.option(
            "--drive", type=Definitions(DRIVE), help=f"Which definition of the end mass, --for; by default {DRIVE}."
        ),
        click.option(
            "--for",
            "whom",
            type=click.Choice(["pooltool"]),
            help="Show the end mass that this simulator takes, against the offset; with --json its CueSpecs.",
        ),
    ):
        command = option(command)
    return command


def hand_over(file: Path, given: dict[str, Any], *, drive: str | None, length: str | None, output: Path | None) -> None:
    """Show the end mass for a simulator; the JSON has pooltool's CueSpecs, what the number means, how well it works."""
    scene, notes = scene_of(file, given)
    with blaming(file, given):
        whole = None if length is None else measured(file, "--length", length, LENGTH)
        record = pooltool_record(file.stem, scene, drive=drive or DRIVE, length=whole)
    record["notes"] += [f"assumed: {note}" for note in notes] + [f"unusual: {remark}" for remark in unusual(scene)]
    text = json_text(record)
    first = head_lines(file, scene_record(scene), scene.effects, notes)
    sheets = [handover_sheet(record), handover_words(record)]
    if output is not None and output.suffix == ".html":
        tell(given["as_json"], record, [*first, *sheets], output)
        return
    if output is not None:
        write_whole(output, lambda temporary: temporary.write_text(text + "\n", encoding="utf-8"))
    if given["as_json"]:
        click.echo(text)
    elif output is not None:
        print_all([f"wrote {output}", "", sheets[0]])
    else:
        more = "-o CUE.json writes the file that pooltool reads, --json prints it"
        print_all([*first, "", *sheets, more])
