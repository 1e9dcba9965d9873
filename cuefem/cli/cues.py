"""Commands on a blow of a cue: end-mass, strike."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from cuefem.accuracy import resolve
from cuefem.cli.common import file_options, show, stroke_options
from cuefem.cli.definitions import WithDefinitions
from cuefem.cli.printing import page_option, print_all
from cuefem.cli.strokes import blow_options
from cuefem.io import load_accuracy
from cuefem.report import (
    end_mass_record,
    end_mass_sheet,
    strike_record,
    strike_sheet,
)
from cuefem.report.simulator_export import pooltool_record, pooltool_sheets
from cuefem.scene import Scene


@click.command("end-mass", cls=WithDefinitions)
@file_options
@blow_options
@page_option
@click.option("--paper", is_flag=True, help="Also show what Kim's paper calls end mass, m_c, and its eps.")
def end_mass(file: Path, paper: bool, **options: Any) -> None:
    """Show the effective end mass: how much mass the ball has to push aside at the tip."""
    show(file, options, end_mass_record, lambda record, about: [end_mass_sheet(record, about, paper=paper)])


@click.command(cls=WithDefinitions)
@stroke_options
@page_option
@click.option(
    "--format",
    "simulator",
    type=click.Choice(["pooltool"]),
    help="The end mass that this simulator takes, instead; -o FILE.json writes its file.",
)
def strike(file: Path, simulator: str | None, **options: Any) -> None:
    """Compute one stroke: squirt, speed, spin and pivot length; to the rtol of the file's [accuracy], if it has one."""

    def results(scene: Scene) -> Any:
        rtol = load_accuracy(file)
        return strike_record(scene, None if rtol is None else resolve(scene, rtol))

    if simulator is None:
        show(file, options, results, lambda record, about: [strike_sheet(record, about)])
        return
    output = options["output"]
    to_file = output is not None and output.suffix == ".json"
    record = show(
        file,
        options,
        lambda scene: pooltool_record(file.stem, scene, str(output) if to_file else "cue.json"),
        lambda record, about: pooltool_sheets(record, written=to_file),
    )
    if to_file:
        print_all(pooltool_sheets(record, written=True))
