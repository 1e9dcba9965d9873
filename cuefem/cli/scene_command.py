"""Shared parts of commands: options, the command of an analysis, and output."""

from __future__ import annotations

from collections.abc import Callable, Sequence
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
from cuefem.cli.request import Request
from cuefem.cli.scene_options import (
    CueFile,
    file_label,
    impact_options,
    offset_option,
    option,
    parameter_options,
    tip_options,
    typed_name,
)
from cuefem.files import InputError, check_writable, load_accuracy, today
from cuefem.files.defaults_report import Assumption
from cuefem.files.shaft_additions import SHAFT_ADDITIONS
from cuefem.files.warnings_of_drawings import drawing_warnings
from cuefem.quantity.display_units import displayed_in
from cuefem.results.plausibility import plausibility_warnings
from cuefem.results.records import Record, Table
from cuefem.show.analysis import Analysis, Answer, write
from cuefem.show.renderers import print_tables

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


def drawing_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The file argument, and the options of a command to which no stroke matters."""
    return file_options(tip_options(command))


def shape_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The options that supplement or replace values of a drawing: the masses, and `SHAFT_ADDITIONS`."""
    for name, known in reversed(SHAFT_ADDITIONS.items()):
        command = shared_option("Cue", option(name), metavar=known.metavar, help=known.help)(command)
    return parameter_options("Cue", "body_mass", "shaft_mass")(command)


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


def analysis_command(
    name: str | None = None,
    *,
    formats: tuple[str, ...] = (".html", ".json"),
    has_stroke: bool = True,
    **about: Any,
) -> Callable[[Callable[..., Analysis | None]], click.Command]:
    """A command whose function gets the `Request` and its own options, and returns the analysis, or None if it is done.

    The command prints the analysis, as tables or JSON, or writes it into the file of -o. has_stroke:
    whether ball, tip and stroke matter to the command.
    """
    shared = stroke_options if has_stroke else drawing_options

    def decorated(analyse: Callable[..., Analysis | None]) -> click.Command:
        _, *own = signature(analyse).parameters

        @wraps(analyse)
        def run(file: Path, output: Path | None, as_json: bool, **options: Any) -> None:
            shared_values = {"output": output, "as_json": as_json}
            mine = {key: shared_values[key] if key in shared_values else options.pop(key) for key in own}
            request = Request.of(file, options, with_impact=has_stroke).with_shop()
            request.print_warnings()
            with request.errors():
                analysis = analyse(request, **mine)
            if analysis is not None:
                _show(request, analysis, output, as_json=as_json)

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

    return analysis_command(name, has_stroke=question.answer().has_stroke, help=text)(ask)


def _show(request: Request, analysis: Analysis, output: Path | None, *, as_json: bool) -> None:
    """Print the analysis of a file, or write it."""
    file = request.file

    def warnings() -> list[str]:
        return [*drawing_warnings(file), *plausibility_warnings(analysis.scene, with_impact=analysis.has_stroke)]

    about = {"file": typed_name(file)}
    shown = Presentation(analysis, file_label(file), about, lambda: request.assumptions, warnings, request.hints)
    with request.errors():
        shown.show(output, as_json=as_json)
    if analysis.problem() and output is None:
        raise InputError(file, "", analysis.problem())


@dataclass(frozen=True)
class Presentation:
    """An answer with what a command adds to it.

    name: of what was analysed. files: for JSON. assumptions, warnings: their texts in the units displayed at the call.
    hints: lines after the tables.
    """

    answer: Answer
    name: str = ""
    files: Record = field(default_factory=dict)
    assumptions: Callable[[], Sequence[Assumption]] = tuple
    warnings: Callable[[], Sequence[str]] = tuple
    hints: Sequence[Table | str] = ()

    def record(self) -> Record:
        """The JSON record, metric in every text."""
        with displayed_in("metric"):
            notes = {"assumptions": [*map(str, self.assumptions())], "warnings": [*self.warnings()]}
            added = self.files | notes if self.files else {}
            return added | self.answer.to_dict() | added

    def write(self, path: Path) -> None:
        """Write the record (.json) or a page (.html)."""
        title = self.answer.page_title(self.name, click.get_current_context().info_name or "")
        warnings = [f"warning: {line}" for line in self.warnings()]
        write(path, self.record, lambda: self.answer.to_html(title, self.assumptions(), warnings, today()))

    def show(self, output: Path | None, *, as_json: bool) -> None:
        """Write a file, or print tables; print JSON if asked for."""
        if output is not None:
            self.write(output)
        if as_json:
            print_json(self.record())
        elif output is not None:
            headline = filter(None, [self.answer.headline()])
            print_tables([*headline, *self.answer.gaps(), f"wrote {output}", *self.hints])
        else:
            print_tables(self.answer.lines(self.name, self.assumptions(), self.hints))
