"""`cuefem report`: everything about a cue, as tables or as a page."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import click

import cuefem.report
from cuefem.cli.common import blaming, scene_of, show, stroke_options
from cuefem.cli.printing import page_option
from cuefem.cli.progress import followed
from cuefem.io import InputError, load_accuracy, save_page
from cuefem.report import report_record, report_sheets
from cuefem.report.unusual import unusual
from cuefem.results.records import Record, Sheet
from cuefem.scene import Scene


@click.command()
@stroke_options
@page_option
@click.option(
    "--check",
    is_flag=True,
    help="Say also how far beam theory is off for this shaft, which takes some seconds (see `cuefem check`).",
)
def report(file: Path, output: Path | None, check: bool, **options: Any) -> None:
    """Show modes, end masses, squirt and pivot length against offset, as tables or as a page with figures."""

    def results(scene: Scene) -> Record:
        record = report_record(scene)
        checked = check and "no_contact" not in record
        return record | ({"model_error": _model_error(scene)} if checked else {})

    if output is None:
        show(file, options, results, partial(_sheets, file))
    else:
        _write_page(file, output, options, check=check)


def _sheets(file: Path, record: Record, about: Record) -> list[Sheet | str]:
    """The tables, and at their end what one asks next."""
    sheets = report_sheets(record, about)
    return (
        [*sheets, "", f"What would change it: cuefem improve {file}, with the same options"]
        if "verdict" in record and "modes" in record  # a lumped cue has nothing that a maker can change
        else sheets
    )


def _model_error(scene: Scene) -> Record:
    return cuefem.report.model_error_record(scene, followed)  # loads scikit-fem, which other reports need not


def _write_page(file: Path, output: Path, options: dict[str, Any], *, check: bool) -> None:
    from cuefem.report.report_page import page  # templates and charts take 0.1 s, which tables need not pay

    if options["as_json"]:
        raise InputError(output, "--output", "must be left out with --json: a page is no JSON")
    scene, notes = scene_of(file, options)
    with blaming(file, options):
        trust = (_model_error(scene)["sentence"],) if check else ()
        asked: dict[str, Any] = {"rtol": load_accuracy(file), "notes": notes, "remarks": unusual(scene), "trust": trust}
        text = page(file.name, scene, track=followed, **asked)
    save_page(text, output)
    click.echo(f"wrote {output}")
