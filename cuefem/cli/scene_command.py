"""Shared parts of commands: options, the scene of a file and its options, and output."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import wraps
from inspect import cleandoc, signature
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from cuefem.cli.output import (
    command,
    json_option,
    output_option,
    print_json,
    shared_option,
)
from cuefem.cli.progress import with_progress_bar
from cuefem.cli.scene_options import (
    CueFile,
    file_label,
    impact_options,
    offset_option,
    option,
    parameter_options,
    reject_game,
    scene_as_drawn,
    scene_from_cue,
    sets_tip,
    with_options,
)
from cuefem.effects.force_law import IndentationOutOfRange
from cuefem.files import InputError, check_writable, load_accuracy, load_stroke
from cuefem.files.cue_names import cue_name
from cuefem.files.defaults_report import Assumption, assumption_texts, assumptions
from cuefem.files.shaft_additions import SHAFT_ADDITIONS
from cuefem.files.warnings_of_drawings import drawing_warnings
from cuefem.results.records import Record, Table
from cuefem.scene import Scene
from cuefem.show.analysis import Analysis, Answer, write
from cuefem.show.plausibility import plausibility_warnings
from cuefem.show.renderers import print_tables
from cuefem.solid.tip_cache import computing_message

if TYPE_CHECKING:
    from cuefem.analysis import Question
    from cuefem.measurements.calibration import Calibration


def file_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The file argument, and the options of every command on a file."""
    return click.argument("file", type=CueFile())(cue_options(command))


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


def _calibration(context: click.Context, parameter: click.Parameter, path: Path | None) -> Calibration | None:
    if path is None:
        return None
    from cuefem.measurements.calibration import load_calibration  # loaded when used: the room of measurements

    return load_calibration(path)


def calibration_option(command: Callable[..., Any]) -> Callable[..., Any]:
    """The option for squirt that was measured on another shaft."""
    return click.option(
        "--calibration",
        type=click.Path(path_type=Path),
        metavar="FILE",
        callback=_calibration,
        help="Squirt measured on another shaft with the same tip: the .toml of `compare FOLDER --estimate -o`.",
    )(command)


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

    with_impact: whether ball, tip and stroke matter to the command: assumptions on them are listed too, and a cue alone
    gets the default stroke of a game. warn: whether to warn of implausible numbers.
    """
    scene, listed, offered = completed_scene(file, options, as_drawn=not with_impact)
    if warn:
        print_warnings(scene, with_impact=with_impact)
    return scene, assumption_texts(listed, offered, with_impact=with_impact)


def completed_scene(
    file: Path, options: dict[str, Any], *, as_drawn: bool = False
) -> tuple[Scene, list[Assumption], set[str]]:
    """The scene of a file, the assumptions: values set neither in the file nor by options, and the options that apply.

    A cue alone gets a game's default stroke (`cuefem.scene.default_scene`); as_drawn: only if an option sets its game
    or tip.
    """
    opened = load_with_options(load_stroke, file, options)
    if isinstance(opened, Scene):
        reject_game(file, options)
        scene = with_options(opened, file, options)
    elif as_drawn and not sets_tip(options):
        scene = scene_as_drawn(opened, file, options)
    else:
        scene = scene_from_cue(opened, file, options)
        as_drawn = False
    given = {name: value for name, value in options.items() if value is not None}
    offered = {*options} - ({"game"} if isinstance(opened, Scene) else set())
    with errors_name_file(file):
        compute_tip(scene)
    listed = [each for each in assumptions(file, scene, given) if not (as_drawn and each.key == "game")]
    return scene, listed, offered


def compute_tip(scene: Scene) -> None:
    """Compute the scene's leather tip unless it is tabulated or cached, and announce the waiting time."""
    if not scene.tip_is_cached:
        click.echo(computing_message(), err=True)
        scene.tip_law()


def print_warnings(scene: Scene, *, with_impact: bool = True) -> None:
    """Warn on stderr of implausible numbers; a wrong unit is the most common reason."""
    for line in plausibility_warnings(scene, with_impact=with_impact):
        click.echo(f"warning: {line}", err=True)


@dataclass(frozen=True)
class Request:
    """What a command asks: its file, the scene with the options, and the assumptions.

    hints: lines that the function adds, printed after the tables.
    """

    file: Path
    scene: Scene
    assumptions: list[str]
    options: dict[str, Any]
    hints: list[Table | str] = field(default_factory=list)


def analysis_command(
    name: str | None = None,
    *,
    shared: Callable[[Any], Any] = stroke_options,
    formats: tuple[str, ...] = (".html", ".json"),
    has_stroke: bool = True,
    **about: Any,
) -> Callable[[Callable[..., Analysis | None]], click.Command]:
    """A command whose function gets the `Request` and its own options, and returns the analysis, or None if it is done.

    The command prints the analysis, as tables or JSON, or writes it into the file of -o. has_stroke: see `scene_of`.
    """

    def decorated(analyse: Callable[..., Analysis | None]) -> click.Command:
        _, *own = signature(analyse).parameters

        @wraps(analyse)
        def run(file: Path, **options: Any) -> None:
            mine = {key: options[key] if key == "output" else options.pop(key) for key in own}
            output = options.pop("output")
            scene, assumptions = scene_of(file, options, with_impact=has_stroke)
            request = Request(file, scene, assumptions, options)
            with errors_name_file(file, options):
                analysis = analyse(request, **mine)
            if analysis is not None:
                _show(request, analysis, output)

        return command(name, **about)(shared(output_option(*formats)(run)))

    return decorated


def question_command(name: str, question: Question) -> click.Command:
    """The command of a registered question; its help is the text of the function above the parameters."""
    function = question.function()
    taken = signature(function).parameters
    text = cleandoc(function.__doc__ or question.help).partition("\n\nParameters\n")[0]

    def ask(request: Request) -> Analysis:
        arguments: dict[str, Any] = {}
        if "rtol" in taken:
            arguments["rtol"] = load_accuracy(request.file)
        if "progress" in taken:
            arguments["progress"] = with_progress_bar
        return function(request.scene, **arguments)

    return analysis_command(name, help=text)(ask)


def _show(request: Request, analysis: Analysis, output: Path | None) -> None:
    """Print the analysis of a file, or write it."""
    file = request.file
    warnings = [*drawing_warnings(file), *plausibility_warnings(analysis.scene, with_impact=analysis.has_stroke)]
    shown = Presentation(
        analysis, file_label(file), {"file": cue_name(file) or str(file)}, request.assumptions, warnings, request.hints
    )
    with errors_name_file(file, request.options):
        shown.show(output, as_json=request.options["as_json"])
    if analysis.problem() and output is None:
        raise InputError(file, "", analysis.problem())


@dataclass(frozen=True)
class Presentation:
    """An answer with what a command adds to it.

    name: of what was analysed. files: for JSON. assumptions: their texts. hints: lines after the tables.
    """

    answer: Answer
    name: str = ""
    files: Record = field(default_factory=dict)
    assumptions: Sequence[str] = ()
    warnings: Sequence[str] = ()
    hints: Sequence[Table | str] = ()

    def record(self) -> Record:
        """The JSON record."""
        notes = {"assumptions": [*self.assumptions], "warnings": [*self.warnings]}
        return (self.files | notes if self.files else {}) | self.answer.to_dict()

    def write(self, path: Path) -> None:
        """Write the record (.json) or a page (.html)."""
        title = self.answer.page_title(self.name, click.get_current_context().info_name or "")
        warnings = [f"warning: {line}" for line in self.warnings]
        write(path, self.record, lambda: self.answer.to_html(title, self.assumptions, warnings))

    def show(self, output: Path | None, *, as_json: bool) -> None:
        """Write a file, or print tables; print JSON if asked for."""
        if output is not None:
            self.write(output)
        if as_json:
            print_json(self.record())
        elif output is not None:
            print_tables([*filter(None, [self.answer.headline()]), f"wrote {output}", *self.hints])
        else:
            print_tables(self.answer.lines(self.name, self.assumptions, self.hints))
