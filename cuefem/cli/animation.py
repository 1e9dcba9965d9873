"""`cuefem animate`: mode shapes and the moving cue for ParaView."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click
import numpy as np

from cuefem.beam.modes import modes
from cuefem.cli.common import blaming, scene_of, stroke_options
from cuefem.cli.printing import assumed_lines, output_option, print_json
from cuefem.cli.progress import followed
from cuefem.cli.strokes import measured
from cuefem.contact.motion import last_contact, motion
from cuefem.io import InputError, check_new, write_whole_folder
from cuefem.io.paraview import save_modes, save_strike
from cuefem.quantity.fields import Quantity
from cuefem.scene import Scene


@click.command()
@stroke_options
@click.option("--count", type=click.IntRange(1, 100), default=6, show_default=True, help="How many modes.")
@click.option(
    "--frames", type=click.IntRange(2, 10_000), default=61, show_default=True, help="How many frames of the strike."
)
@click.option("--until", metavar="TIME", help="Time of the last frame; by default three contact times.")
@click.option("--scale", type=float, default=1.0, show_default=True, help="Bending is drawn this many times enlarged.")
@output_option("", required=True)
def animate(file: Path, output: Path, as_json: bool, **options: Any) -> None:
    """Write mode shapes and the cue's motion in a strike for ParaView: FOLDER/modes.vtu, FOLDER/strike.pvd, frames."""
    drawn = {name: options.pop(name) for name in ("count", "frames", "until", "scale")}
    if not math.isfinite(drawn["scale"]):
        raise InputError(file, "--scale", f"must be finite; got {drawn['scale']}")
    if drawn["until"] is not None:
        drawn["until"] = measured(file, "--until", drawn["until"], Quantity("s", "(0, inf)"))
    check_new(output)
    scene, notes = scene_of(file, options)
    with blaming(file, options):
        put = _animation(scene, **drawn)
    write_whole_folder(output, put)
    if as_json:
        print_json({"folder": str(output), "frames": drawn["frames"], "assumed": notes})
        return
    for line in assumed_lines(notes):
        click.echo(line)
    click.echo(f"wrote {output}: modes.vtu, strike.pvd and {drawn['frames']} frames")


def _animation(scene: Scene, *, count: int, frames: int, until: float | None, scale: float) -> Callable[[Path], None]:
    """Compute all of it, and return what writes it into a folder."""
    last = 3 * last_contact(scene) if until is None else until
    moving = motion(scene, np.linspace(0, last, frames))
    cue = scene.shaft
    bending = modes(cue, count, effects=scene.cue_effects)

    def put(folder: Path) -> None:
        save_modes(folder / "modes.vtu", cue, bending)
        save_strike(folder, scene, moving, scale=scale, track=followed)

    return put
