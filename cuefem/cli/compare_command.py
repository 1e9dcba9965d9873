"""`cuefem compare`: compare cues, or computed with measured values."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import click

import cuefem as cf
from cuefem.analysis.comparison import MAX_CUES
from cuefem.analysis.measured import contradictions
from cuefem.cli.output import Command, command, output_option, print_json
from cuefem.cli.pending_warnings import warn
from cuefem.cli.progress import with_progress_bar
from cuefem.cli.request import Request, errors_name_file, file_names, open_request, print_warnings
from cuefem.cli.scene_command import (
    Presentation,
    calibration_option,
    check_overwrite,
    cue_options,
    force_option,
)
from cuefem.cli.scene_options import impact_options, offset_option, option, typed_name
from cuefem.files import InputError
from cuefem.files.cue_names import cue_name, named_path
from cuefem.files.defaults_report import STROKE, Assumption
from cuefem.files.lathe_profile import DRAWING_EXTENSIONS
from cuefem.files.warnings_of_drawings import drawing_warnings
from cuefem.measurements.calibration import Calibration
from cuefem.measurements.measured_folder import MEASURED, load_measured, named_folder, write_template
from cuefem.measurements.measurement_types import BallDirection
from cuefem.quantity.display_units import displayed_system
from cuefem.results.plausibility import plausibility_warnings
from cuefem.show.scene_summary import listed

MEASURED_FILES = (MEASURED, "cue.toml", "cue.csv")  # one of them makes a folder a measured cue


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
@click.option("--template", is_flag=True, help="Create FOLDER with files to fill in.")
@output_option(".html", ".json", ".csv", ".toml")
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
    as_json: bool,
    **options: str | None,
) -> None:
    """Compare cues side by side, or the computed and measured values of one cue, with uncertainties.

    FILE FILE ...: two to five cues or scenes, struck with the ball and stroke of the first; each a file or the name of
    a cue, such as "predator z2". An option of cue or tip applies to each file that leaves its value open.

    FOLDER: a measured cue, with the shaft's drawing (cue.toml or cue.csv, required), measured.toml with single
    measurements, and one CSV for each long series, such as squirt.csv. The options of cue, tip and stroke stand in
    these files.

    To measure squirt: strike hard (ball over 4 m/s: 1 m in a quarter of a second) with the cue as low as the rail
    allows, read the ball within 1 m, ten shots a side. Give the distance, the cue's speed, and how far the cue's centre
    line (or the chalk mark) is from the ball's centre; if you cannot strike hard, give the elevation, or a second
    speed.
    """
    listed = [] if estimate or template else _listed_files(files)
    if listed:
        if same_shaft or calibration is not None:
            raise InputError(files[0], "", f"--same-shaft and --calibration take at most {MAX_CUES} FILEs, not a list")
        _list(listed, options, output, as_json=as_json)
        return
    if output is not None and output.suffix.lower() == ".csv":
        raise InputError(output, "--output", f"a table (.csv) needs a folder of drawings or over {MAX_CUES} files")
    if len(files) > 1:
        requests = [Request.of(named_path(file), options) for file in files]
        if output is not None and output.suffix.lower() == ".toml":
            raise InputError(output, "--output", "a calibration (.toml) needs one FOLDER and --estimate")
        for name, flag in (("--estimate", estimate), ("--template", template)):
            if flag:
                raise InputError(requests[0].file, name, f"takes one FOLDER; got {len(files)} files")
        _side_by_side(requests, output, as_json=as_json, same_shaft=same_shaft, calibration=calibration)
        return
    (folder,) = files
    if calibration is not None:
        raise InputError(folder, "--calibration", "needs two or more FILEs, whose squirt it improves")
    if same_shaft or Request.of(folder, options).given:
        raise InputError(folder, "", "options of cue and stroke need two or more FILEs; a FOLDER has them in its files")
    if template:
        write_template(folder)
        if as_json:
            print_json({"output_folder": str(folder)})
            return
        click.echo(
            f"wrote {folder}: replace cue.toml by your drawing, fill in each ? of measured.toml, then run: "
            f"{_calibrating(folder)}"
        )
    elif folder.is_file() or cue_name(folder := named_folder(folder)):
        raise InputError(folder, "", "needs another FILE to compare with, or a FOLDER with measurements")
    elif output is not None and output.suffix.lower() == ".toml":
        if not estimate:
            raise InputError(output, "--output", "a calibration (.toml) needs --estimate")
        check_overwrite(output, force=force)
        _write_calibration(folder, output, as_json=as_json)
    else:
        _with_measurements(folder, output, as_json=as_json, estimate=estimate, asked=_calibrating(files[0]))


def _calibrating(folder: Path) -> str:
    """The command that makes a calibration of a measured cue."""
    made = f"{folder.resolve().name.replace(' ', '_')}_calibration.toml"
    return shlex.join(["cuefem", "compare", str(folder), "--estimate", "-o", made])


def _listed_files(files: Sequence[Path]) -> list[Path]:
    """The files of a list of shafts: more than `MAX_CUES`, or the drawings of a folder; empty for another question."""
    if len(files) > MAX_CUES:
        return [named_path(file) for file in files]
    folder = files[0]
    if len(files) > 1 or not folder.is_dir() or any((folder / name).exists() for name in MEASURED_FILES):
        return []
    drawings = sorted(
        file for file in folder.iterdir() if file.suffix.lower() in DRAWING_EXTENSIONS and file.name != "shop.toml"
    )
    if not drawings:
        problem = (
            f"must hold drawings ({', '.join(DRAWING_EXTENSIONS)}), or measured.toml and the drawing of a measured cue"
        )
        raise InputError(folder, "", f"{problem}; got none")
    return drawings


def _list(files: Sequence[Path], options: Mapping[str, str | None], output: Path | None, *, as_json: bool) -> None:
    """Print or write the list of shafts; files without an answer stand in it."""
    if output is not None and output.suffix.lower() == ".toml":
        raise InputError(output, "--output", "a list is written as .html, .json or .csv")
    scenes, unread = {}, {}
    for name, file in zip(file_names(files), files, strict=True):
        try:
            scenes[name] = open_request(file, options).scene
        except (ValueError, OSError) as error:
            unread[name] = " ".join(str(error).removeprefix(f"{file}: ").split())
    with errors_name_file(files[0].parent):
        made = cf.shop_list(scenes, unread=unread, progress=with_progress_bar)
    if output is not None and output.suffix.lower() == ".csv":
        made.save(output)
        click.echo(f"{made.headline()}\nwrote {output}")
    else:
        Presentation(made, files={"files": [typed_name(file) for file in files]}).show(output, as_json=as_json)
    if unread:
        raise InputError(files[0].parent, "", made.problem())


def _write_calibration(folder: Path, output: Path, *, as_json: bool) -> None:
    """Write the calibration by a measured cue."""
    cue, assumed = load_measured(folder)
    print_warnings(cue.scene)
    with errors_name_file(folder):
        contradictory = contradictions(cf.compare(cue, progress=with_progress_bar).rows)
        made = cf.estimate(cue, progress=with_progress_bar).calibration()
    made.save(output)
    warnings = [*contradictory, *made.warnings]
    if as_json:
        print_json({"file": str(folder), "output_file": str(output), "warnings": warnings})
        return
    for line in warnings:
        warn(line)
    for each in assumed:
        click.echo(f"assumed: {each}", err=True)
    click.echo(f"wrote {output}; for the next shaft with this tip: cuefem report NEW.toml --calibration {output}")


def _side_by_side(
    requests: Sequence[Request],
    output: Path | None,
    *,
    as_json: bool,
    same_shaft: bool,
    calibration: Calibration | None,
) -> None:
    """Print or write the comparison of cues."""
    first, files = requests[0], [request.file for request in requests]
    names = file_names(files)
    requests, notes = _distributed(requests, names)
    asked = dict(zip(names, requests, strict=True))
    scenes = {name: request.scene for name, request in asked.items()}
    for request in requests:
        request.print_warnings()
    with first.errors():
        analysis = cf.compare(scenes, same_shaft=same_shaft, calibration=calibration, progress=with_progress_bar)

        def warnings() -> list[str]:
            return [
                f"{name}: {line}"
                for name, request in asked.items()
                for line in (*drawing_warnings(request.file), *plausibility_warnings(request.scene))
            ]

        about = {"files": [typed_name(file) for file in files]}
        shown = Presentation(
            analysis, files=about, assumptions=lambda: [*notes, *_assumptions(asked)], warnings=warnings
        )
        shown.show(output, as_json=as_json)


def _distributed(requests: Sequence[Request], names: Sequence[str]) -> tuple[list[Request], list[Assumption]]:
    """The requests, each with the options of cue and tip that its file leaves open; notes on those for some files only.

    InputError for an option that no file leaves open, and for a --shaft-mass of several shafts.
    """
    given = requests[0].given
    own = {name: request.own_values() & {*given} for name, request in zip(names, requests, strict=True)}
    notes = []
    for key in sorted(set().union(*own.values())):
        having = [name for name in names if key in own[name]]
        lacking = [name for name in names if key not in own[name]]
        if not lacking:
            raise InputError(requests[0].file, option(key), _no_file_lacks(given[key], len(names)))
        verb = "has its" if len(having) == 1 else "have their"
        notes.append(Assumption("", f"{option(key)} {given[key]}: for {listed(lacking)}; {listed(having)} {verb} own"))
    weighed = [name for name in names if "shaft_mass" in given and "shaft_mass" not in own[name]]
    if len(weighed) > 1:
        problem = (
            f"must be the weight of one shaft; {listed(weighed)} leave it open: `cuefem convert` writes it into one"
        )
        raise InputError(requests[0].file, option("shaft_mass"), problem)
    filled = [
        replace(request, given={key: text for key, text in given.items() if key not in own[name]}).with_shop()
        for name, request in zip(names, requests, strict=True)
    ]
    return filled, notes


def _no_file_lacks(text: str, count: int) -> str:
    """Why an option of which every file has a value is refused."""
    every = "both files have" if count == 2 else f"all {count} files have"
    return f"must be a value that a file leaves open; got {text!r}, and {every} their own: omit it"


def _assumptions(asked: Mapping[str, Request]) -> list[Assumption]:
    """Assumptions on all cues, and on the stroke, which is that of the first; then those on each cue, with its name."""
    listed = {name: request.assumptions for name, request in asked.items()}
    first, *_ = listed.values()
    shared = [each for each in first if each.of == STROKE or all(each in own for own in listed.values())]
    others = [
        replace(each, text=f"{name}: {each.text}")
        for name, own in listed.items()
        for each in own
        if each.of != STROKE and each not in shared
    ]
    return [*shared, *others]


def _with_measurements(folder: Path, output: Path | None, *, as_json: bool, estimate: bool, asked: str) -> None:
    """Print or write the comparison with measurements, or the estimate from them; asked: what makes a calibration."""
    cue, loaded_notes = load_measured(folder)
    is_calibrating = any(isinstance(each, BallDirection) for each in cue.measurements)
    hints = [f"Calibration for the next shaft with this tip: {asked}"] if is_calibrating else []
    system = displayed_system()

    def notes() -> list[Assumption]:
        return loaded_notes if displayed_system() == system else load_measured(folder)[1]

    print_warnings(cue.scene)
    with errors_name_file(folder):
        question = cf.estimate if estimate else cf.compare
        analysis = question(cue, progress=with_progress_bar)
        shown = Presentation(
            analysis, folder.name, {"file": str(folder)}, notes, lambda: plausibility_warnings(cue.scene), hints
        )
        shown.show(output, as_json=as_json)
