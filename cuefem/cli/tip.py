"""The command on a tip of leather."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from cuefem.cli.common import file_options, show
from cuefem.cli.printing import page_option
from cuefem.cli.strokes import measured, place_options, tip_options
from cuefem.contact.calibrated import leather_modulus, with_modulus
from cuefem.io import InputError
from cuefem.quantity.fields import CONTACT_TIME
from cuefem.report.tip_table import tip_record, tip_sheets
from cuefem.scene import Scene


@click.command()
@file_options
@tip_options
@page_option
@place_options("restitution", "speed")
@click.option(
    "--contact-time",
    "wanted",
    metavar="TIME",
    help='Find the E with which the tip touches the ball this long head on, e.g. "1.1 ms".',
)
def tip(file: Path, wanted: str | None, **options: Any) -> None:
    """Show what the leather tip of a cue does: force over depth, contact time over speed, and its shear ratio.

    FILE is a cue, or a scene with a LeatherTip among its effects. What is shown holds for a head-on blow of the
    scene's cue and ball; --contact-time finds the E of the leather from a measured contact time.
    """
    if options["leather"] is not None and wanted is not None:
        raise InputError(file, "--leather", "must be left out with --contact-time, which finds it")
    time = None if wanted is None else measured(file, "--contact-time", wanted, CONTACT_TIME)

    def asked(scene: Scene) -> Scene:
        return scene if time is None else with_modulus(scene, leather_modulus(scene, time))

    settled = ("friction", "offset", *(() if time is None else ("leather",)))
    show(
        file, options, tip_record, lambda record, about: tip_sheets(record, about, time), change=asked, settled=settled
    )
