"""Commands on one cue or scene: modes, end-mass, strike, effects, cost, report."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from cuefem.cli.common import (
    WithDefinitions,
    blaming,
    file_options,
    followed,
    scene_of,
    show,
)
from cuefem.cli.strokes import blow_options, offset_option, tip_options

if TYPE_CHECKING:
    from cuefem.scene import Scene


@click.command(short_help="How the cue rings: its bending frequencies.")
@file_options
@tip_options
@click.option("--near", metavar="HERTZ", help="Show the modes nearest this frequency, not the lowest.")
@click.option("--count", type=click.IntRange(min=1), default=6, show_default=True, help="How many modes.")
def modes(file: Path, near: str | None, count: int, **given: Any) -> None:
    """Show how the cue rings: its bending frequencies and tip amplitudes."""
    from cuefem.report import modes_record, modes_table

    def results(scene: Scene) -> Any:
        return modes_record(scene, count=count, near=hertz)

    hertz = None if near is None else _hertz(file, near)
    show(file, given, results, lambda found, about: [modes_table(found)], blow=False)


def _hertz(file: Path, near: str) -> float:
    """The frequency that --near gives: a number of hertz, or a number with its unit."""
    from cuefem.io import InputError
    from cuefem.quantity import Quantity
    from cuefem.units import number

    wanted = Quantity("Hz", "[0, inf)")
    for text in (near, f"{near} Hz"):
        with suppress(ValueError):
            if wanted.holds(hertz := number(text, "Hz")):
                return hertz
    raise InputError(file, "--near", f'must be in {wanted.bounds}, such as 250 or "0.25 kHz"; got {near!r}')


@click.command("end-mass", cls=WithDefinitions, short_help="The effective end mass, by every definition.")
@file_options
@blow_options
def end_mass(file: Path, **given: Any) -> None:
    """Show the effective end mass: how much mass the ball has to push aside at the tip."""
    from cuefem.report import end_mass_record, end_mass_table

    show(file, given, end_mass_record, lambda found, about: [end_mass_table(found, about)])


@click.command(short_help="One stroke: squirt, speed, spin and pivot length.")
@file_options
@blow_options
@offset_option
def strike(file: Path, **given: Any) -> None:
    """Compute one stroke: squirt, speed, spin and pivot length; to the rtol of the file's [accuracy], if it has one."""
    from cuefem.accuracy import resolve
    from cuefem.io import load_accuracy
    from cuefem.report import strike_record, strike_table

    def results(scene: Scene) -> Any:
        rtol = load_accuracy(file)
        return strike_record(scene, None if rtol is None else resolve(scene, rtol))

    show(file, given, results, lambda found, about: [strike_table(found, about)])


@click.command(short_help="What each effect changes, left out or added.")
@file_options
@blow_options
@offset_option
def effects(file: Path, **given: Any) -> None:
    """Show what each effect changes: every effect of FILE is left out, every other one added, one at a time.

    An effect matters if it changes more than the rtol of the file's [accuracy], by default 1e-2.
    """
    from cuefem.io import load_accuracy
    from cuefem.report import DEFAULT_RTOL, effects_record, effects_table

    def results(scene: Scene) -> Any:
        rtol = load_accuracy(file)
        return effects_record(scene, rtol=DEFAULT_RTOL if rtol is None else rtol, track=followed)

    show(file, given, results, lambda found, about: [effects_table(found, about)])


@click.command(short_help="What accuracy costs, and which resolution to take.")
@file_options
@blow_options
@offset_option
@click.option(
    "--most", type=click.IntRange(min=24), default=150, show_default=True, help="The largest number of modes."
)
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), metavar="FIGURE", help="Also draw a figure: .png or .svg."
)
def cost(file: Path, most: int, output: Path | None, **given: Any) -> None:
    """Show what accuracy costs for this scene: error against time and unknowns, and which resolution to take."""
    from cuefem.io import FIGURES, InputError, save_figure
    from cuefem.report.cost import cost_figure, cost_record, cost_tables

    if output is not None and output.suffix not in FIGURES:
        raise InputError(output, "--output", f"must end in .png or .svg; got {output.suffix!r}")

    def results(scene: Scene) -> Any:
        found = cost_record(scene, most=most, track=followed)
        if output is not None:
            save_figure(cost_figure(found, f"{file.name}: what accuracy costs", output.suffix[1:]), output)
        return found

    show(file, given, results, lambda found, about: cost_tables(found))


@click.command(short_help="Everything about a cue, as tables or as a page.")
@file_options
@blow_options
@offset_option
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), metavar="PAGE.html", help="Write a page with figures instead."
)
def report(file: Path, output: Path | None, **given: Any) -> None:
    """Show modes, end masses, squirt and pivot length against offset, as tables or as a page with figures."""
    from cuefem.contact.outcome import MISSED
    from cuefem.report import end_mass_table, modes_table, pivot_table, report_record, squirt_table
    from cuefem.report.strike import MISCUE

    def tables(found: Any, about: Any) -> list[Any]:
        shown = [modes_table(found["modes"])] if "modes" in found else []
        if "no_contact" in found:
            return [*shown, f"no end mass and no squirt: {found['no_contact']}"]
        first: list[Any] = [MISCUE, "", *shown] if found["grip"] in MISSED else shown
        masses, squirt = found["end_masses"], found["squirt"]
        return [*first, end_mass_table(masses, about), squirt_table(squirt, about), pivot_table(squirt)]

    if output is None:
        show(file, given, report_record, tables)
    else:
        _write_page(file, output, given)


def _write_page(file: Path, output: Path, given: dict[str, Any]) -> None:
    from cuefem.io import InputError, load_accuracy, save_page
    from cuefem.report.page import page
    from cuefem.report.unusual import unusual

    if given["as_json"]:
        raise InputError(output, "--output", "must be left out with --json: a page is no JSON")
    scene, notes = scene_of(file, given)
    with blaming(file, given):
        text = page(file.name, scene, rtol=load_accuracy(file), notes=notes, remarks=unusual(scene), track=followed)
    save_page(text, output)
    click.echo(f"wrote {output}")
