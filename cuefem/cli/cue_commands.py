"""Commands on a cue: report, improve, modes, end-mass, strike."""

from __future__ import annotations

import shlex
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

import click

import cuefem.report
from cuefem.cli.common import blaming, check_free, file_options, force_option, scene_of, show, stroke_options
from cuefem.cli.printing import Command, command, output_option, page_option, print_all
from cuefem.cli.progress import followed
from cuefem.cli.strokes import blow_options, option, tip_options, with_options
from cuefem.design.design_changes import design_changes
from cuefem.endmass.definitions import DEFINITIONS
from cuefem.io import InputError, load_accuracy, save, save_page
from cuefem.io.fittings import FITTINGS
from cuefem.parameters.parameter import varied
from cuefem.parameters.parts import main_material
from cuefem.quantity.fields import Quantity
from cuefem.quantity.units import number
from cuefem.report import (
    end_mass_record,
    end_mass_sheet,
    modes_record,
    modes_sheet,
    report_record,
    report_sheets,
    strike_record,
    strike_sheet,
)
from cuefem.report.advice_table import advice_sheet
from cuefem.report.simulator_export import pooltool_record, pooltool_sheets
from cuefem.report.unusual import unusual
from cuefem.results.convergence import resolve
from cuefem.results.records import Record, Sheet
from cuefem.scene import Scene


class WithDefinitions(Command):
    """A command whose help ends with the definitions of the end mass."""

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write name and meaning of every definition."""
        with formatter.section("Definitions of the end mass"):
            formatter.write_dl([(definition.name, definition.meaning) for definition in DEFINITIONS.values()])


@command()
@stroke_options
@page_option
@click.option(
    "--check",
    is_flag=True,
    help="Also compute the error of the beam model for this shaft; takes seconds (see `cuefem check`).",
)
def report(file: Path, output: Path | None, check: bool, **options: Any) -> None:
    """Report the squirt of a cue with its uncertainty, then natural frequencies, end mass, pivot length and masses.

    Prints tables; -o FILE.html writes a page with figures. Assumptions are listed last, each with its option.
    """

    def results(scene: Scene) -> Record:
        record = report_record(scene)
        checked = check and "no_contact" not in record
        return record | ({"model_error": _model_error(scene)} if checked else {})

    if output is None:
        show(file, options, results, partial(_sheets, file))
    else:
        _write_page(file, output, options, check=check)


def _sheets(file: Path, record: Record, about: Record) -> list[Sheet | str]:
    """The tables, followed by suggested commands."""
    sheets = report_sheets(record, about)
    return (
        [*sheets, "", f"Design changes: cuefem improve {file}, with the same options"]
        if "verdict" in record and "modes" in record  # a lumped cue has nothing that a maker can change
        else sheets
    )


def _model_error(scene: Scene) -> Record:
    return cuefem.report.model_error_record(scene, followed)  # loads scikit-fem, which other reports need not


def _write_page(file: Path, output: Path, options: dict[str, Any], *, check: bool) -> None:
    from cuefem.report.report_page import (
        page_and_headline,
    )  # templates and charts take 0.1 s to load

    if options["as_json"]:
        raise InputError(output, "--output", "cannot be combined with --json")
    scene, notes = scene_of(file, options)
    with blaming(file, options):
        checks = [_model_error(scene)["summary"]] if check else []
        more: dict[str, Any] = {"rtol": load_accuracy(file), "warnings": unusual(scene), "checks": checks}
        text, line = page_and_headline(file.name, scene, notes=notes, progress=followed, **more)
    save_page(text, output)
    click.echo(f"{line}\nwrote {output}")


@command()
@stroke_options
@output_option(".html", ".toml")
@click.option(
    "--take",
    type=click.IntRange(min=1),
    metavar="ROW",
    help="Save the cue of table row ROW (1 is the first) as the .toml of -o.",
)
@force_option
def improve(file: Path, take: int | None, output: Path | None, force: bool, **options: Any) -> None:
    """List design changes a maker can make, with squirt, stiffness, weight and first natural frequency of each.

    Each change is applied on its own and computed by the coupled strike. Rows are sorted by squirt, lowest first.
    """
    drawing = output is not None and output.suffix == ".toml"
    if (take is not None) != drawing:
        raise InputError(file, "--take", "--take ROW requires -o FILE.toml, and -o FILE.toml requires --take ROW")
    if take is None or output is None:
        show(
            file,
            {**options, "output": output},
            lambda scene: design_changes(scene, progress=followed),
            lambda record, about: [advice_sheet(record)],
        )
        return
    check_free(output, force=force)
    scene, _ = scene_of(file, options)
    with blaming(file, options):
        rows = design_changes(scene, progress=followed)["changes"]
    if take > len(rows):
        raise InputError(file, "--take", f"must be a row of the table, 1 to {len(rows)}; got {take}")
    row = rows[take - 1]
    changed = varied(scene, row["set"])
    save(changed, output)
    click.echo(f"wrote {output}: {row['change']}")
    for line in _comparing(file, output, options, (scene, changed)):
        click.echo(line)


def _comparing(file: Path, output: Path, options: dict[str, Any], scenes: tuple[Scene, Scene]) -> list[str]:
    """The commands that compare a cue before and after a change; none if the new file would have another stroke.

    Options that change only the drawing are converted first, since options apply to both files.
    """
    given = {name: value for name, value in options.items() if isinstance(value, str)}
    drawn = {name: given.pop(name) for name in (*FITTINGS, "shaft_mass") if name in given}
    try:
        alike = "game" not in given and with_options(scenes[1], output, given) == scenes[1]
    except InputError:  # the options do not go with the changed cue
        alike = False
    if not alike:
        return []
    before, lines = file, list[str]()
    if drawn:
        before = output.with_name(f"{file.stem}_before.toml")
        lines = [f"first: cuefem convert {_typed(file, before, drawn)}"]
    woods = {main_material(scene.shaft).E for scene in scenes}
    same = " --same-shaft" if len(woods) == 1 else ""
    return [*lines, f"before and after: cuefem compare {_typed(before, output, given)}{same}"]


def _typed(first: Path, second: Path, given: dict[str, str]) -> str:
    """Two files and options as command-line text."""
    return shlex.join([str(first), str(second), *(word for name in given for word in (option(name), given[name]))])


@command()
@file_options
@tip_options
@page_option
@click.option("--near", metavar="HERTZ", help="Show the modes nearest this frequency instead of the lowest.")
@click.option("--count", type=click.IntRange(min=1), default=6, show_default=True, help="Number of modes.")
def modes(file: Path, near: str | None, count: int, **options: Any) -> None:
    """Compute natural frequencies of bending, with period and tip amplitude of each mode."""

    def results(scene: Scene) -> Any:
        return modes_record(scene, count=count, near=hertz)

    hertz = None if near is None else _hertz(file, near)
    show(file, options, results, lambda record, about: [modes_sheet(record)], with_impact=False)


def _hertz(file: Path, near: str) -> float:
    """The frequency of --near: a number of hertz, or a number with its unit."""
    wanted = Quantity("Hz", "[0, inf)")
    for text in (near, f"{near} Hz"):
        with suppress(ValueError):
            if wanted.holds(hertz := number(text, "Hz")):
                return hertz
    raise InputError(file, "--near", f'must be {wanted.bounds_in("Hz")}, such as 250 or "0.25 kHz"; got {near!r}')


@command("end-mass", cls=WithDefinitions)
@file_options
@blow_options
@page_option
@click.option("--paper", is_flag=True, help="Also show m_c (the end mass of Kim's paper) and eps.")
def end_mass(file: Path, paper: bool, **options: Any) -> None:
    """Compute the effective end mass: the transverse inertia of the cue at its tip, by five definitions."""
    show(file, options, end_mass_record, lambda record, about: [end_mass_sheet(record, about, paper=paper)])


@command()
@stroke_options
@page_option
@click.option(
    "--format",
    "simulator",
    type=click.Choice(["pooltool"]),
    help="Export the end mass for this simulator; -o FILE.json writes its input file.",
)
def strike(file: Path, simulator: str | None, **options: Any) -> None:
    """Compute squirt, ball speed, spin and pivot length of one stroke, by the coupled strike and by lumped models.

    The numerical error target is the rtol of the file's [accuracy] table, if it has one.
    """

    def results(scene: Scene) -> Any:
        rtol = load_accuracy(file)
        return strike_record(scene, None if rtol is None else resolve(scene, rtol))

    if simulator is None:
        show(file, options, results, lambda record, about: [strike_sheet(record, about)])
        return
    output = options["output"]
    to_file = output is not None and output.suffix == ".json"
    record = show(
        file,
        options,
        lambda scene: pooltool_record(file.stem, scene, str(output) if to_file else "cue.json"),
        lambda record, about: pooltool_sheets(record, written=to_file),
    )
    if to_file:
        print_all(pooltool_sheets(record, written=True))
