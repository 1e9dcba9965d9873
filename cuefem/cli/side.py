"""The command on a strike from the side."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import click
import numpy as np

from cuefem.cli.common import blaming, cue_options, fittings_of, head_lines
from cuefem.cli.printing import output_option, tell
from cuefem.cli.progress import followed
from cuefem.cli.strokes import measured, option, with_body
from cuefem.cue import Cue
from cuefem.io import InputError, check_new, load, load_accuracy, write_whole_folder
from cuefem.io.assumed import assumed
from cuefem.io.paraview import save_side_strike
from cuefem.measured.side.side_accuracy import resolve_side_strike
from cuefem.measured.side.side_motion import side_motion
from cuefem.measured.side.side_scene import SideStrike, Striker
from cuefem.measured.side.side_strike import side_strike
from cuefem.quantity.fields import Quantity
from cuefem.report.side_table import side_record, side_scene_record, side_sheets
from cuefem.results.quantities import UNITS
from cuefem.vary import Path as Steps
from cuefem.vary import with_fields

# Of a file that has no [striker]: a light ball, and how long it touches a wall.
MASS, RESTITUTION, CONTACT_TIME = 0.02, 0.8, 1e-3
OPTIONS: dict[Steps, Quantity] = {
    ("striker", "mass"): Quantity("kg", "(0, inf)"),
    ("striker", "restitution"): Quantity("", "[0, 1]"),
    ("striker", "contact_time"): Quantity("s", "[1e-6, 0.5]"),  # a slower one leans on the shaft and does not leave it
    ("position",): Quantity("m", "[0, inf)"),
    ("speed",): Quantity("m/s", "(0, inf)"),
}


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--position", metavar="LENGTH", help='Where the shaft is struck, from the tip, e.g. "20 mm".')
@click.option("--mass", metavar="MASS", help='Of the striker, e.g. "20 g".')
@click.option("--restitution", metavar="E", help="Of the striker off a heavy wall, in [0, 1].")
@click.option("--contact-time", metavar="TIME", help='How long it touches a wall, e.g. "1 ms".')
@click.option("--speed", metavar="SPEED", help='Of the striker, e.g. "1 m/s".')
@click.option("--places", type=click.IntRange(2, 200), default=9, show_default=True, help="Places along the shaft.")
@output_option(".html", "")
@click.option("--frames", type=click.IntRange(2, 10_000), default=61, show_default=True, help="How many frames of it.")
@cue_options
def side(file: Path, places: int, output: Path | None, frames: int, as_json: bool, **options: Any) -> None:
    """Strike a shaft, a bat or a stick from the side with a ball or a hammer, and show how that bounces off.

    FILE is a cue or a scene; with a [striker] in it nothing else is needed.
    """
    folder, page = (output if output is not None and (output.suffix == "") is new else None for new in (True, False))
    if folder is not None:
        check_new(folder)
    scene, notes = _scene(file, options)
    rtol = load_accuracy(file)
    with blaming(file):
        outcome = side_strike(scene) if rtol is None else resolve_side_strike(scene, rtol)
        about, record = side_scene_record(scene), side_record(scene, outcome, places=places)
        put = None if folder is None else _animation(scene, outcome.duration, frames)
    if folder is not None and put is not None:
        write_whole_folder(folder, put)
    written = [] if folder is None else [f"wrote {folder}: strike.pvd and {frames} frames"]
    lines = [*head_lines(file, about, scene.effects, notes), "", *side_sheets(record, about), *written]
    tell(as_json, {"file": str(file), "assumed": notes, "scene": about, **record, "units": UNITS}, lines, page)


def _scene(file: Path, options: dict[str, Any]) -> tuple[SideStrike, list[str]]:
    """The scene of a file and its options, and what was assumed."""
    opened = load(file, **fittings_of(options))
    said = {name for name, value in options.items() if value is not None}
    notes = assumed(file, said, offered=options, blow=False)
    if options["body_mass"] is not None:
        opened = with_body(opened, file, options["body_mass"])
    if not isinstance(opened, SideStrike):
        cue = opened if isinstance(opened, Cue) else opened.cue
        if not isinstance(cue, Cue):
            raise InputError(file, "cue", "must be a cue of segments: a lumped cue has no side")
        notes += _assumed(said)
        with blaming(file):  # of a whole tip its mass stays
            effects = () if isinstance(opened, Cue) else opened.bare.cue_effects
            opened = SideStrike(cue, Striker(MASS, RESTITUTION, contact_time=CONTACT_TIME), effects=effects)
    changes = {
        path: measured(file, option(str(path[-1])), options[str(path[-1])], quantity)
        for path, quantity in OPTIONS.items()
        if options[str(path[-1])] is not None
    }
    with blaming(file):
        return with_fields(opened, changes) if changes else opened, notes


def _assumed(said: set[str]) -> list[str]:
    known = (
        ("mass", f"striker {1e3 * MASS:g} g"),
        ("restitution", f"e {RESTITUTION:g}"),
        ("contact_time", f"{1e3 * CONTACT_TIME:g} ms against a wall"),
        ("position", "struck at the tip"),
        ("speed", "1 m/s"),
    )
    return [f"{words} (--{name.replace('_', '-')})" for name, words in known if name not in said]


def _animation(scene: SideStrike, duration: float, frames: int) -> Callable[[Path], None]:
    """Compute the motion, and return what writes it into a folder."""
    moving = side_motion(scene, np.linspace(0, 3 * duration, frames))
    return lambda folder: save_side_strike(folder, scene, moving, track=followed)
