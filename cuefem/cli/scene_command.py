"""Shared parts of commands: options, the scene of a file and its options, and output."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click

from cuefem.cli.output import assumption_lines, json_option, print_result, shared_option
from cuefem.cli.scene_options import (
    impact_options,
    offset_option,
    option,
    parameter_options,
    reject_game,
    scene_from_cue,
    with_options,
)
from cuefem.effects.force_law import IndentationOutOfRange
from cuefem.io import InputError, check_writable, load_stroke
from cuefem.io.defaults_report import Assumption, assumption_texts, assumptions
from cuefem.io.drawing_warnings import drawing_warnings
from cuefem.io.shaft_additions import SHAFT_ADDITIONS
from cuefem.results.quantities import UNITS
from cuefem.results.records import Record, json_value
from cuefem.scene import Scene
from cuefem.show.plausibility import plausibility_warnings
from cuefem.show.scene_summary import cue_line, effect_text, scene_record
from cuefem.solid.tip_cache import computing_message


def file_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The file argument, and the options of every command on a file."""
    return click.argument("file", type=click.Path(path_type=Path))(cue_options(command))


def stroke_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The file argument, and the options of every command on one stroke of its cue."""
    return file_options(impact_options(offset_option(command)))


def cue_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The options for values that a cue's file may omit, and --json."""
    return json_option(shape_options(command))


def shape_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The options that supplement or replace values of a drawing: the masses, and `SHAFT_ADDITIONS`."""
    for name, known in reversed(SHAFT_ADDITIONS.items()):
        command = shared_option("Cue", option(name), metavar=known.metavar, help=known.help)(command)
    return parameter_options("Cue", "body_mass", "shaft_mass")(command)


def load_with_options(load: Callable[..., Any], file: Path, options: Mapping[str, Any]) -> Any:
    """The contents of a file, with the options that supplement its drawing; errors name the option."""
    try:
        return load(file, **{name: options.get(name) for name in SHAFT_ADDITIONS})
    except InputError as error:
        name, _, problem = f"{error.key}: {error.problem}".removeprefix(": ").partition(": ")
        if options.get(name) is None:
            raise
        raise InputError(file, option(name), problem) from None


def force_option(command: Callable[..., Any]) -> Callable[..., Any]:
    """The option of every command that writes a drawing."""
    return shared_option("Output", "--force", is_flag=True, help="Overwrite an existing drawing.")(command)


def check_overwrite(drawing: Path, *, force: bool) -> None:
    """Reject overwriting a drawing without --force; pages and figures can be regenerated."""
    if drawing.exists() and not drawing.is_dir() and not force:
        raise InputError(drawing, "", "already exists; --force overwrites it")
    check_writable(drawing)


@contextmanager
def errors_name_file(file: Path, options: Collection[str] = ()) -> Iterator[None]:
    """Prefix errors of the computation with the file name, such as an effect beyond the cue.

    options: those of the command, which the error names where they help.
    """
    try:
        yield
    except InputError:  # which names a file already
        raise
    except ValueError as error:
        help_words = (
            " (--tip-height, --leather, --speed)"
            if isinstance(error, IndentationOutOfRange) and "leather" in options
            else ""
        )
        raise InputError(file, "", f"{error}{help_words}") from None


def scene_of(
    file: Path, options: dict[str, Any], *, with_impact: bool = True, warn: bool = True
) -> tuple[Scene, list[str]]:
    """The scene of a command, and the texts of its assumptions.

    with_impact: whether ball, tip and stroke matter to the command, so that assumptions on them are listed too. warn:
    whether to warn of implausible numbers.
    """
    scene, listed, offered = completed_scene(file, options)
    if warn:
        print_warnings(scene, with_impact=with_impact)
    return scene, assumption_texts(listed, offered, with_impact=with_impact)


def completed_scene(file: Path, options: dict[str, Any]) -> tuple[Scene, list[Assumption], set[str]]:
    """The scene of a file, the assumptions: values set neither in the file nor by options, and the options that apply.

    A cue alone gets a game's default stroke (`cuefem.scene.default_scene`).
    """
    opened = load_with_options(load_stroke, file, options)
    if isinstance(opened, Scene):
        reject_game(file, options)
        scene = with_options(opened, file, options)
    else:
        scene = scene_from_cue(opened, file, options)
    given = {name: value for name, value in options.items() if value is not None}
    offered = {*options} - ({"game"} if isinstance(opened, Scene) else set())
    with errors_name_file(file):
        compute_tip(scene)
    return scene, assumptions(file, scene, given), offered


def compute_tip(scene: Scene) -> None:
    """Compute the scene's leather tip unless it is tabulated or cached, and announce the waiting time."""
    if not scene.tip_is_cached:
        click.echo(computing_message(), err=True)
        scene.tip_law()


def print_warnings(scene: Scene, *, with_impact: bool = True) -> None:
    """Warn on stderr of implausible numbers; a wrong unit is the most common reason."""
    for line in plausibility_warnings(scene, with_impact=with_impact):
        click.echo(f"warning: {line}", err=True)


def run_on_scene(
    file: Path,
    options: dict[str, Any],
    results: Callable[[Scene], Any],
    sheets: Callable[..., Any],
    *,
    with_impact: bool = True,
) -> Record:
    """Compute all of it first, then print it all: as JSON, or as a heading and tables; or write these into a file.

    with_impact: see `scene_of`.
    """
    page = options.pop("output", None)
    scene, notes = scene_of(file, options, with_impact=with_impact)
    with errors_name_file(file, options):
        about, answer = scene_record(scene), results(scene)
    struck = about if with_impact else {name: value for name, value in about.items() if name in ("cue", "effects")}
    record = full_record(file, notes, scene, answer, with_impact=with_impact, scene=struck)
    lines = [head_line(file, about), "", *sheets(answer, about), "", *basis_lines(scene.effects, notes)]
    print_result(options["as_json"], record, lines, page, f"{file.name}: {click.get_current_context().info_name}")
    return record


def full_record(
    file: Path, notes: Sequence[str], solved: Scene, record: Record, *, with_impact: bool = True, **more: Any
) -> Record:
    """The JSON record: the file, assumptions, warnings, the scene, the result, the units."""
    warnings = [*drawing_warnings(file), *plausibility_warnings(solved, with_impact=with_impact)]
    about = {"file": str(file), "assumptions": notes, "warnings": warnings, "scene": scene_record(solved)}
    return about | more | record | {"units": UNITS | record.get("units", {})}


def head_line(file: Path, about: dict[str, Any]) -> str:
    """The heading of a command's tables: the file and its cue."""
    return f"{file.name}: {cue_line(json_value(about['cue']))}"


def basis_lines(effects: Sequence[Any], notes: Sequence[str]) -> list[str]:
    """The lines below a command's tables: the effects, and the assumptions."""
    acting = [f"effects: {', '.join(map(effect_text, effects))}"] if effects else []
    return [*acting, *assumption_lines(notes)]
