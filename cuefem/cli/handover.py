"""Commands that hand results to other people's software: handover, animate."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from cuefem.cli.common import (
    Definitions,
    WithDefinitions,
    blaming,
    file_options,
    followed,
    head_lines,
    print_all,
    print_json,
    scene_of,
)
from cuefem.cli.strokes import blow_options, measured, offset_option

if TYPE_CHECKING:
    from cuefem.scene import Scene


@click.command(cls=WithDefinitions, short_help="The end mass for a simulator: pooltool's CueSpecs.")
@file_options
@blow_options
@offset_option
@click.option(
    "--for", "whom", type=click.Choice(["pooltool"]), help="Print the JSON of this simulator, as --json does."
)
@click.option(
    "--drive", type=Definitions("A.31"), default="A.31", show_default=True, help="Which definition of the end mass."
)
@click.option("--length", metavar="LENGTH", help="Of the whole cue; by default the drawing's, or 58 in behind a shaft.")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    metavar="CUE.json",
    help="Write to a file; with --json print it too.",
)
def handover(
    file: Path, whom: str | None, drive: Any, length: str | None, output: Path | None, as_json: bool, **given: Any
) -> None:
    """Show the end mass for a simulator, against the offset; as JSON for the simulator itself.

    The JSON (--json, --for pooltool, or into a file with -o) has pooltool's CueSpecs, says what the number means and
    how well it works.
    """
    from cuefem.io import InputError, write_whole
    from cuefem.quantity import LENGTH
    from cuefem.report.handover import handover_table, handover_words, pooltool_record
    from cuefem.report.record import plain, scene_record
    from cuefem.report.unusual import unusual

    if output is not None and output.suffix != ".json":
        raise InputError(output, "--output", f"must end in .json; got {output.suffix!r}")
    scene, notes = scene_of(file, given)
    with blaming(file, given):
        whole = None if length is None else measured(file, "--length", length, LENGTH)
        found = pooltool_record(file.stem, scene, drive=drive, length=whole)
    found["notes"] += [f"assumed: {note}" for note in notes] + [f"unusual: {remark}" for remark in unusual(scene)]
    text = json.dumps(plain(found), indent=2, allow_nan=False, ensure_ascii=False)
    if output is not None:
        write_whole(output, lambda temporary: temporary.write_text(text + "\n", encoding="utf-8"))
    if as_json or (output is None and whom is not None):
        click.echo(text)
        return
    first = [f"wrote {output}"] if output else head_lines(file, scene_record(scene), scene.effects, notes)
    more = (
        [] if output else [handover_words(found), "-o CUE.json writes the file that pooltool reads, --json prints it"]
    )
    print_all([*first, "", handover_table(found), *more])


@click.command(short_help="Mode shapes and the moving cue for ParaView.")
@file_options
@blow_options
@offset_option
@click.option("--count", type=click.IntRange(1, 100), default=6, show_default=True, help="How many modes.")
@click.option(
    "--frames", type=click.IntRange(2, 10_000), default=61, show_default=True, help="How many frames of the strike."
)
@click.option("--until", metavar="TIME", help="Time of the last frame; by default three contact times.")
@click.option("--scale", type=float, default=1.0, show_default=True, help="Bending is drawn this many times enlarged.")
@click.option("-o", "--output", type=click.Path(path_type=Path), required=True, metavar="FOLDER", help="A new folder.")
def animate(file: Path, output: Path, as_json: bool, **given: Any) -> None:
    """Write mode shapes and the cue's motion in a strike for ParaView: FOLDER/modes.vtu, FOLDER/strike.pvd, frames."""
    from cuefem.io import InputError
    from cuefem.io.paraview import check_new, write_whole_folder
    from cuefem.quantity import Quantity

    drawn = {name: given.pop(name) for name in ("count", "frames", "until", "scale")}
    if not math.isfinite(drawn["scale"]):
        raise InputError(file, "--scale", f"must be finite; got {drawn['scale']}")
    if drawn["until"] is not None:
        drawn["until"] = measured(file, "--until", drawn["until"], Quantity("s", "(0, inf)"))
    check_new(output)
    scene, notes = scene_of(file, given)
    with blaming(file, given):
        put = _animation(scene, **drawn)
    write_whole_folder(output, put)
    if as_json:
        print_json({"folder": str(output), "frames": drawn["frames"], "assumed": notes})
        return
    if notes:
        click.echo(f"assumed: {'; '.join(notes)}")
    click.echo(f"wrote {output}: modes.vtu, strike.pvd and {drawn['frames']} frames")


def _animation(scene: Scene, *, count: int, frames: int, until: float | None, scale: float) -> Callable[[Path], None]:
    """Compute all of it, and return what writes it into a folder."""
    import numpy as np

    from cuefem.beam.modes import modes
    from cuefem.contact.motion import last_contact, motion
    from cuefem.io.paraview import save_modes, save_strike

    last = 3 * last_contact(scene) if until is None else until
    moving = motion(scene, np.linspace(0, last, frames))
    cue = scene.shaft
    found = modes(cue, count, effects=scene.cue_effects)

    def put(folder: Path) -> None:
        save_modes(folder / "modes.vtu", cue, found)
        save_strike(folder, scene, moving, scale=scale, track=followed)

    return put
