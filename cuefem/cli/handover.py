"""`cuefem strike --for`: the end mass of a stroke for other people's software."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click
import numpy as np

from cuefem.cli.common import blaming, head_lines, scene_of
from cuefem.cli.definitions import Definitions
from cuefem.cli.printing import output_option, print_all, tell
from cuefem.cli.strokes import measured
from cuefem.io import InputError, write_whole
from cuefem.quantity.fields import LENGTH, Quantity
from cuefem.report.handover_table import (
    POOLTOOL,
    POOLTOOL_LINE,
    handover_sheet,
    handover_words,
    pooltool_record,
    table_csv,
    table_record,
    table_sheet,
)
from cuefem.report.record import scene_record
from cuefem.report.table import json_text
from cuefem.report.unusual import unusual

DRIVE = "A.31"
ONLY = "must go with --for pooltool, for which it is"
ONLY_TABLE = "must go with --for table, for which it is"
OFFSETS, SPEEDS = "0.05 to 0.55 in 11", "1 m/s to 7 m/s in 4"
OFFSET, SPEED = Quantity("", "(-1, 1)"), Quantity("m/s", "(0, 100]")
MOST = 1000  # strokes of a table
STEPS = re.compile(r"(?P<first>.+?)\s+to\s+(?P<last>.+?)\s+in\s+(?P<count>\S+)")


def simulator_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The options of a stroke that is for a simulator."""
    for option in (
        output_option(".html", ".json", ".csv"),
        click.option("--speeds", metavar="SPEEDS", help=f'Of --for table: "1 m/s, 2 m/s" or, by default, "{SPEEDS}".'),
        click.option(
            "--offsets", metavar="OFFSETS", help=f'b/R of --for table: "0.1, 0.3" or, by default, "{OFFSETS}".'
        ),
        click.option(
            "--length",
            metavar="LENGTH",
            help="Of the whole cue, --for; by default the drawing's, or 58 in.",
        ),
        click.option(
            "--drive", type=Definitions(DRIVE), help=f"Which definition of the end mass, --for; by default {DRIVE}."
        ),
        click.option(
            "--for",
            "whom",
            type=click.Choice(["pooltool", "table"]),
            help="Show the end mass that a simulator takes: pooltool, with --json its CueSpecs; or, for any other, "
            "a table against offset and speed, which -o writes as .csv or .json.",
        ),
    ):
        command = option(command)
    return command


def hand_over(
    file: Path, options: dict[str, Any], *, drive: str | None, length: str | None, output: Path | None
) -> None:
    """Show the end mass for a simulator; the JSON has pooltool's CueSpecs, what the number means, how well it works."""
    scene, notes = scene_of(file, options)
    with blaming(file, options):
        whole = None if length is None else measured(file, "--length", length, LENGTH)
        record = pooltool_record(file.stem, scene, drive=drive or DRIVE, length=whole)
    record["notes"] += [f"assumed: {note}" for note in notes] + [f"unusual: {remark}" for remark in unusual(scene)]
    text = json_text(record)
    first = head_lines(file, scene_record(scene), scene.effects, notes)
    sheets = [handover_sheet(record), handover_words(record)]
    if output is not None and output.suffix == ".html":
        tell(options["as_json"], record, [*first, *sheets], output)
        return
    if output is not None:
        write_whole(output, lambda temporary: temporary.write_text(text + "\n", encoding="utf-8"))
    if options["as_json"]:
        click.echo(text)
    elif output is not None:
        print_all([f"wrote {output}", "", sheets[0]])
    else:
        more = f"-o cue.json writes the file that pooltool {POOLTOOL} reads with {POOLTOOL_LINE}; --json prints it"
        print_all([*first, "", *sheets, more])


def table_for(
    file: Path, options: dict[str, Any], *, offsets: str | None, speeds: str | None, output: Path | None
) -> None:
    """Show end mass and squirt against offset and speed, for a simulator; or write them as CSV or JSON."""
    scene, notes = scene_of(file, options)
    with blaming(file, options):
        places = _values(file, "--offsets", offsets or OFFSETS, OFFSET)
        paces = _values(file, "--speeds", speeds or SPEEDS, SPEED)
        if len(places) * len(paces) > MOST:
            got = f"{len(places)} x {len(paces)}"
            raise InputError(file, "--offsets", f"must make at most {MOST} strokes with --speeds; got {got}")
        record = table_record(scene, places, paces)
    record["notes"] = [f"assumed: {note}" for note in notes] + [f"unusual: {remark}" for remark in unusual(scene)]
    if output is not None and output.suffix != ".html":
        text = table_csv(record) if output.suffix == ".csv" else json_text(record) + "\n"
        write_whole(output, lambda temporary: temporary.write_text(text, encoding="utf-8"))
        click.echo(json_text(record) if options["as_json"] else f"wrote {output}")
        return
    first = head_lines(file, scene_record(scene), scene.effects, notes)
    tell(options["as_json"], record, [*first, "", table_sheet(record)], output)


def _values(file: Path, name: str, text: str, wanted: Quantity) -> tuple[float, ...]:
    """The checked SI numbers of an option such as "0.1, 0.3" or "1 m/s to 7 m/s in 4"."""
    steps = STEPS.fullmatch(text.strip())
    if steps is None:
        return tuple(measured(file, name, part.strip(), wanted) for part in text.split(","))
    first, last = (measured(file, name, steps[end], wanted) for end in ("first", "last"))
    if not first < last:
        raise InputError(file, name, f"must begin below its end; got {text!r}")
    if not (steps["count"].isdecimal() and 2 <= int(steps["count"]) <= MOST):
        raise InputError(file, name, f'must have 2 to {MOST} steps after "in"; got {steps["count"]!r}')
    return tuple(np.linspace(first, last, int(steps["count"])).round(12).tolist())  # -0.3 to 0.5 in 9 has a 0
