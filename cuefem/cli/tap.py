"""The tap test: a recording and a drawing to the wood of the shaft."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from cuefem.cli.common import blaming, check_free, cue_options, fittings_of, scene_of, whole_record
from cuefem.cli.printing import assumed_lines, output_option, tell
from cuefem.cli.strokes import blow_options, measured, offset_option, with_body
from cuefem.contact.strike import strike
from cuefem.cue import Cue
from cuefem.games import without_leather
from cuefem.io import FIGURES, InputError, load_stroke, save, save_figure
from cuefem.io.sound import load_recording
from cuefem.measured.fit import TapFit
from cuefem.measured.ringing import Ringing, ringing
from cuefem.measured.tones import tones
from cuefem.measured.wood import Predicted, TapTest, predicted
from cuefem.parts import with_material
from cuefem.quantity.fields import Quantity
from cuefem.report.record import scene_record
from cuefem.report.tap_table import tap_figure, tap_record, tap_sheets
from cuefem.scene import Outcome, Scene


@click.command()
@click.argument("recording", type=click.Path(path_type=Path))
@click.option(
    "--scene", "file", type=click.Path(path_type=Path), metavar="FILE", required=True, help="The cue or scene."
)
@click.option(
    "--mass", metavar="MASS", help='Weight of the shaft as it hung, e.g. "118 g"; without it the density stays.'
)
@click.option(
    "--material-of", "segment", type=click.IntRange(min=0), metavar="N", help="Fit segment N's material, 0 at the tip."
)
@output_option(".html", ".toml", *FIGURES, many=True)
@click.option("--doubted", is_flag=True, help="Show and write the result even if it is doubted.")
@click.option("--force", is_flag=True, help="Replace an existing drawing; also does what --doubted does.")
@cue_options
@blow_options
@offset_option
def tap(recording: Path, file: Path, output: tuple[Path, ...], force: bool, doubted: bool, **options: Any) -> None:
    """Find the shaft's wood by ear: E, G and density from a recording of the shaft, hung free and tapped.

    RECORDING is a .wav of one or more taps; -o NEW.toml writes FILE with the fitted wood, -o FIGURE.png the spectrum.
    Its tones are matched to the bending modes of the shaft in FILE, as it is drawn there; ball and tip matter to the
    squirt that follows alone. If the tones do not fit this shaft, or no such wood exists, nothing is shown or written
    without --doubted (status 1).
    """
    drawing, page, figure = (
        next((path for path in output if path.suffix in kinds), None) for kinds in ((".toml",), (".html",), FIGURES)
    )
    if drawing is not None:
        check_free(drawing, force=force)
    scene, notes = scene_of(file, options)
    heard, fit = _heard(recording, file, _as_drawn(scene, file, options), options)
    if fit.refusals and not (doubted or force):
        raise RuntimeError(f"{recording}: refused, --doubted goes on: {'; '.join(fit.refusals)}")
    record = tap_record(fit, heard, *_predicted(file, scene, fit))
    about = scene_record(replace(scene, cue=_struck(scene, fit)))
    if drawing is not None:
        save(_updated(file, scene, fit, options), drawing)
    if figure is not None:
        save_figure(tap_figure(fit, heard, f"{recording.name}: {file.name}", figure.suffix[1:]), figure)
    written = [f"wrote {path}" for path in (drawing, figure) if path is not None]
    whole = whole_record(file, notes, scene, record, scene=about, recording=str(recording))
    lines = [f"{recording.name}, {file.name}", "", *tap_sheets(record, about), *assumed_lines(notes), *written]
    tell(options["as_json"], whole, lines, page)


def _as_drawn(scene: Scene, file: Path, options: dict[str, Any]) -> Scene:
    """The scene of FILE; of a cue alone the scene with the cue as it is drawn, its leather included."""
    drawn = load_stroke(file, **fittings_of(options))
    if isinstance(drawn, Scene):
        return scene
    return Scene(drawn if options["body_mass"] is None else with_body(drawn, file, options["body_mass"]))


def _struck(scene: Scene, fit: TapFit) -> Cue:
    """The fitted cue as the scene has it: a scene with a whole tip has no drawn leather."""
    return fit.cue if scene.contact_terms.tip is None else without_leather(fit.cue)


def _heard(recording: Path, file: Path, scene: Scene, options: dict[str, Any]) -> tuple[Ringing, TapFit]:
    if not scene.cue.segments:
        raise InputError(file, "", "must hold a cue of segments: a lumped cue has no tones")
    mass = options["mass"]
    mass = None if mass is None else measured(file, "--mass", mass, Quantity("kg", "(0, inf)"))
    with blaming(file):
        test = TapTest(scene.shaft, segment=options["segment"], mass=mass, effects=scene.cue_effects)
    sound = load_recording(recording)
    with blaming(recording):
        heard = ringing(sound.samples, sound.rate)
    try:
        return heard, test.fit(tones(heard), heard.rate)
    except RuntimeError as error:
        raise RuntimeError(f"{recording}: {error}") from None


def _predicted(file: Path, scene: Scene, fit: TapFit) -> tuple[dict[str, Predicted], Outcome]:
    """The scene's numbers and its stroke with the fitted wood."""
    with blaming(file):
        cue = _struck(scene, fit)
        return predicted(scene, replace(fit, cue=cue)), strike(replace(scene, cue=cue))


def _updated(file: Path, scene: Scene, fit: TapFit, options: dict[str, Any]) -> Any:
    """The cue or scene of FILE with the fitted wood, to six digits."""
    short = {name: float(f"{getattr(fit.wood, name):.6g}") for name in ("E", "G", "rho", "loss", "nu")}
    cue = with_material(fit.cue, fit.wood, replace(fit.wood, **short))
    drawn = load_stroke(file, **fittings_of(options))
    return replace(drawn, cue=cue) if isinstance(drawn, Scene) else cue
