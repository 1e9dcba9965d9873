"""`cuefem modes`: how a cue rings."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Any

import click

from cuefem.cli.common import file_options, show
from cuefem.cli.printing import page_option
from cuefem.cli.strokes import tip_options
from cuefem.io import InputError
from cuefem.quantity.fields import Quantity
from cuefem.quantity.units import number
from cuefem.report import (
    modes_record,
    modes_sheet,
)
from cuefem.scene import Scene


@click.command()
@file_options
@tip_options
@page_option
@click.option("--near", metavar="HERTZ", help="Show the modes nearest this frequency, not the lowest.")
@click.option("--count", type=click.IntRange(min=1), default=6, show_default=True, help="How many modes.")
def modes(file: Path, near: str | None, count: int, **options: Any) -> None:
    """Show how the cue rings: its bending frequencies and tip amplitudes."""

    def results(scene: Scene) -> Any:
        return modes_record(scene, count=count, near=hertz)

    hertz = None if near is None else _hertz(file, near)
    show(file, options, results, lambda record, about: [modes_sheet(record)], blow=False)


def _hertz(file: Path, near: str) -> float:
    """The frequency that --near gives: a number of hertz, or a number with its unit."""
    wanted = Quantity("Hz", "[0, inf)")
    for text in (near, f"{near} Hz"):
        with suppress(ValueError):
            if wanted.holds(hertz := number(text, "Hz")):
                return hertz
    raise InputError(file, "--near", f'must be {wanted.bounds_in("Hz")}, such as 250 or "0.25 kHz"; got {near!r}')
