"""`cuefem compare`: compare cues, or computed with measured values."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

import cuefem as cf
from cuefem.analysis.comparison import MAX_CUES
from cuefem.cli.output import Command, command, output_option
from cuefem.cli.progress import with_progress_bar
from cuefem.cli.scene_command import (
    Presentation,
    calibration_option,
    check_overwrite,
    completed_scene,
    cue_options,
    errors_name_file,
    force_option,
    print_warnings,
)
from cuefem.cli.scene_options import impact_options, offset_option, option
from cuefem.files import InputError, load_stroke
from cuefem.files.cue_names import cue_name, named_path
from cuefem.files.defaults_report import STROKE, Assumption, given_keys
from cuefem.files.warnings_of_drawings import drawing_warnings
from cuefem.measurements.calibration import Calibration
from cuefem.measurements.measured_folder import load_measured, named_folder, write_template
from cuefem.show.plausibility import plausibility_warnings


class TwoForms(Command):
    """A command whose help shows that it takes files or a folder."""

    def format_usage(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write one line for each form."""
        path = ctx.command_path
        formatter.write_usage(path, "FILE FILE ... [OPTIONS]")
        formatter.write_usage(path, "FOLDER [--estimate | --template]", prefix=" " * len("Usage: "))


@command(cls=TwoForms)
@click.argument("files", metavar="FILE FILE ... | FOLDER", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option(
    "--same-shaft",
    is_flag=True,
    help="The files are one shaft before and after a change: the uncertainty of its wood cancels.",
)
@click.option(
    "--estimate",
    is_flag=True,
    help="Estimate wood, bore and tip from all measurements in FOLDER (maximum a posteriori), with uncertainties.",
)
@click.option("--template", is_flag=True, help="Create FOLDER with example files to fill in.")
@output_option(".html", ".json", ".toml")
@calibration_option
@force_option
@cue_options
@impact_options
@offset_option
def compare(
    files: tuple[Path, ...],
    same_shaft: bool,
    estimate: bool,
    template: bool,
    output: Path | None,
    calibration: Calibration | None,
    force: bool,
    **options: Any,
) -> None:
    """Compare cues side by side, or the computed and measured values of one cue, with uncertainties.

    FILE FILE ...: two to five cues or scenes, struck with the ball and stroke of the first; each a file or the name of
    a cue, such as "predator z2".

    FOLDER: a measured cue, with the shaft's drawing (cue.toml or cue.csv, required), measured.toml with single
    measurements, and one CSV for each long series, such as squirt.csv. The options of cue, tip and stroke stand in
    these files.
    """
    as_json = options["as_json"]
    if len(files) > 1:
        files = tuple(map(named_path, files))
        if output is not None and output.suffix == ".toml":
            raise InputError(output, "--output", "a calibration (.toml) needs one FOLDER and --estimate")
        for name, flag in (("--estimate", estimate), ("--template", template)):
            if flag:
                raise InputError(files[0], name, f"takes one FOLDER; got {len(files)} files")
        _side_by_side(files, options, output, same_shaft=same_shaft, calibration=calibration)
        return
    (folder,) = files
    if calibration is not None:
        raise InputError(folder, "--calibration", "needs two or more FILEs, whose squirt it improves")
    if same_shaft or any(value is not None for name, value in options.items() if name != "as_json"):
        raise InputError(folder, "", "options of cue and stroke need two or more FILEs; a FOLDER has them in its files")
    if template:
        write_template(folder)
        click.echo(f"wrote {folder}: replace the example numbers by yours, then run: cuefem compare {folder}")
    elif folder.is_file() or cue_name(folder := named_folder(folder)):
        raise InputError(folder, "", "needs another FILE to compare with, or a FOLDER with measurements")
    elif output is not None and output.suffix == ".toml":
        if not estimate:
            raise InputError(output, "--output", "a calibration (.toml) needs --estimate")
        check_overwrite(output, force=force)
        _write_calibration(folder, output)
    else:
        _with_measurements(folder, output, as_json=as_json, estimate=estimate)


def _write_calibration(folder: Path, output: Path) -> None:
    """Write the calibration by a measured cue."""
    cue, _ = load_measured(folder)
    print_warnings(cue.scene)
    with errors_name_file(folder):
        made = cf.estimate(cue, progress=with_progress_bar).calibration()
    made.save(output)
    for line in made.warnings:
        click.echo(f"warning: {line}", err=True)
    click.echo(f"wrote {output}; for the next shaft with this tip: cuefem report NEW.toml --calibration {output}")


def _side_by_side(
    files: Sequence[Path],
    options: dict[str, Any],
    output: Path | None,
    *,
    same_shaft: bool,
    calibration: Calibration | None,
) -> None:
    """Print or write the comparison of cues."""
    if len(files) > MAX_CUES:
        raise InputError(files[MAX_CUES], "", f"must be one of at most {MAX_CUES} cues; got {len(files)}")
    if options["shaft_mass"] is not None:
        problem = (
            "must be set in each cue's file (shaft_mass) when cues are compared; `cuefem convert` writes such a .toml"
        )
        raise InputError(files[0], option("shaft_mass"), problem)
    for file in files:
        _reject_given(file, options)
    loaded = [completed_scene(file, options) for file in files]
    names = _names(files)
    scenes = {name: scene for name, (scene, *_) in zip(names, loaded, strict=True)}
    for scene in scenes.values():
        print_warnings(scene)
    with errors_name_file(files[0], options):
        analysis = cf.compare(scenes, same_shaft=same_shaft, calibration=calibration, progress=with_progress_bar)
        warnings = [
            f"{name}: {line}"
            for name, file in zip(names, files, strict=True)
            for line in (*drawing_warnings(file), *plausibility_warnings(scenes[name]))
        ]
        notes = _assumption_texts(names, [listed for _, listed, _ in loaded], [offered for *_, offered in loaded])
        about = {"files": [cue_name(file) or str(file) for file in files]}
        shown = Presentation(analysis, files=about, assumptions=notes, warnings=warnings)
        shown.show(output, as_json=options["as_json"])


def _reject_given(file: Path, options: dict[str, Any]) -> None:
    """InputError for an option of cue or tip whose value the file has itself, other than that of compared cues."""
    opened = load_stroke(file, length_unit=options["length_unit"])
    for name in sorted(given_keys(file, opened, options["length_unit"])):
        if options.get(name) is not None:
            problem = "would replace this file's own value: options of compare set what a file leaves open"
            raise InputError(file, option(name), f"{problem}; got {options[name]!r}")


def _assumption_texts(
    names: Sequence[str], listed: Sequence[list[Assumption]], offered: Sequence[set[str]]
) -> list[str]:
    """Assumptions on all cues, and on the stroke, which is that of the first; then those on each cue, with its name."""
    shared = [each for each in listed[0] if each.of == STROKE or all(each in own for own in listed)]
    texts = [each.line(offered[0]) for each in shared]
    for name, own, options in zip(names, listed, offered, strict=True):
        texts += [f"{name}: {each.line(options)}" for each in own if each.of != STROKE and each not in shared]
    return texts


def _names(files: Sequence[Path]) -> list[str]:
    """The files' names, without folder and extension if they are distinct."""
    for i, file in enumerate(files):
        if file.resolve() in [other.resolve() for other in files[:i]]:
            raise InputError(file, "", "is given twice; compare different files")
    forms = [(cue_name(file) or file.stem, file.name, str(file)) for file in files]
    return [next(own for k, own in enumerate(form) if [each[k] for each in forms].count(own) == 1) for form in forms]


def _with_measurements(folder: Path, output: Path | None, *, as_json: bool, estimate: bool) -> None:
    """Print or write the comparison with measurements, or the estimate from them."""
    cue, notes = load_measured(folder)
    print_warnings(cue.scene)
    with errors_name_file(folder):
        question = cf.estimate if estimate else cf.compare
        analysis = question(cue, progress=with_progress_bar)
        warnings = plausibility_warnings(cue.scene)
        shown = Presentation(analysis, folder.name, {"file": str(folder)}, notes, warnings)
        shown.show(output, as_json=as_json)
