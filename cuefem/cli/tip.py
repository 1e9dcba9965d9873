"""The command on a tip of leather."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from cuefem.cli.common import file_options, measured, show

if TYPE_CHECKING:
    from cuefem.scene import Scene


@click.command(short_help="The leather tip by itself: force, contact time, shear ratio.")
@file_options
@click.option("--speed", metavar="SPEED", help='Speed of the cue, e.g. "3 m/s".')
@click.option("--leather", metavar="PRESSURE", help='E of the leather, e.g. "140 MPa".')
@click.option(
    "--contact-time", metavar="TIME", help='Find the E with which the tip touches the ball this long, e.g. "1.1 ms".'
)
def tip(
    file: Path, speed: str | None, leather: str | None, contact_time: str | None, as_json: bool, **given: Any
) -> None:
    """Show what the leather tip of a scene does: force over depth, contact time over speed, and its shear ratio.

    FILE is a scene with a LeatherTip among its effects. What is shown holds for a head-on blow of the scene's cue and
    ball; --contact-time finds the E of the leather from a measured contact time.
    """
    from cuefem.contact.calibrated import leather_modulus, with_modulus
    from cuefem.io import InputError
    from cuefem.quantity import CONTACT_TIME, Quantity
    from cuefem.report.tip import tip_record, tip_tables

    if leather is not None and contact_time is not None:
        raise InputError(file, "--leather", "must be left out with --contact-time, which finds it")
    wanted = None if contact_time is None else measured(file, "--contact-time", contact_time, CONTACT_TIME)

    def asked(scene: Scene) -> Scene:
        if speed is not None:
            found = measured(file, "--speed", speed, Quantity("m/s", "(0, inf)"))
            scene = replace(scene, stroke=replace(scene.stroke, speed=found))
        E = scene.leather.E
        if leather is not None:
            E = measured(file, "--leather", leather, Quantity("Pa", "(0, inf)"))
        if wanted is not None:
            E = leather_modulus(scene, wanted)
        return with_modulus(scene, E)

    show(
        file,
        {**given, "as_json": as_json},
        tip_record,
        lambda found, about: tip_tables(found, about, wanted),
        change=asked,
    )
