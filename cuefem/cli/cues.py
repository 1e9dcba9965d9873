"""Commands on a blow of a cue: end-mass, strike."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from cuefem.accuracy import resolve
from cuefem.cli.common import file_options, show, stroke_options
from cuefem.cli.definitions import WithDefinitions
from cuefem.cli.handover import ONLY, ONLY_TABLE, hand_over, simulator_options, table_for
from cuefem.cli.printing import page_option
from cuefem.cli.strokes import blow_options
from cuefem.io import InputError, load_accuracy
from cuefem.report import (
    end_mass_record,
    end_mass_sheet,
    strike_record,
    strike_sheet,
)
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
@simulator_options
def strike(
    file: Path,
    whom: str | None,
    drive: Any,
    length: str | None,
    offsets: str | None,
    speeds: str | None,
    output: Path | None,
    **options: Any,
) -> None:
    """Compute one stroke: squirt, speed, spin and pivot length; to the rtol of the file's [accuracy], if it has one."""
    of_table = (("--offsets", offsets), ("--speeds", speeds))
    of_pooltool = (("--drive", drive), ("--length", length))
    for option, value in of_table if whom != "table" else of_pooltool:
        if value is not None:
            raise InputError(file, option, ONLY_TABLE if whom != "table" else ONLY)
    if whom == "table":
        table_for(file, options, offsets=offsets, speeds=speeds, output=output)
        return
    if whom is not None:
        if output is not None and output.suffix == ".csv":
            raise InputError(output, "--output", "must end in .html or .json; got '.csv', which --for table writes")
        hand_over(file, options, drive=drive, length=length, output=output)
        return
    simulators = output if output is not None and output.suffix != ".html" else None
    for option, value in (*of_pooltool, ("--output", simulators)):
        if value is not None:
            raise InputError(file, option, ONLY)

    def results(scene: Scene) -> Any:
        rtol = load_accuracy(file)
        return strike_record(scene, None if rtol is None else resolve(scene, rtol))

    show(file, {**options, "output": output}, results, lambda record, about: [strike_sheet(record, about)])
