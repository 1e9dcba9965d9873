"""Commands on a cue: report, improve, modes, end-mass, strike."""

from __future__ import annotations

import shlex
from functools import partial
from pathlib import Path
from typing import Any

import click

from cuefem.cli.output import Command, command, output_option, page_option, print_tables
from cuefem.cli.progress import with_progress_bar
from cuefem.cli.scene_command import (
    check_overwrite,
    errors_name_file,
    file_options,
    force_option,
    run_on_scene,
    scene_of,
    stroke_options,
)
from cuefem.cli.scene_options import tip_options
from cuefem.design.design_changes import design_changes
from cuefem.endmass.definitions import DEFINITIONS
from cuefem.io import InputError, load_accuracy, save, save_page
from cuefem.io.drawing_warnings import drawing_warnings
from cuefem.parameters.parameter import with_parameters
from cuefem.parameters.parts import main_material
from cuefem.results.convergence import resolve
from cuefem.results.records import Record, Table
from cuefem.scene import Scene
from cuefem.show import (
    end_mass_record,
    modes_record,
    report_record,
    strike_record,
    tabulate_end_masses,
    tabulate_modes,
    tabulate_report,
    tabulate_strike,
)
from cuefem.show.design_changes_table import tabulate_design_changes
from cuefem.show.plausibility import plausibility_warnings
from cuefem.show.simulator_export import pooltool_record, tabulate_pooltool


class WithDefinitions(Command):
    """A command whose help ends with the definitions of the end mass."""

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write name and meaning of every definition."""
        with formatter.section("Definitions of the end mass"):
            formatter.write_dl([(definition.name, definition.meaning) for definition in DEFINITIONS.values()])


@command()
@stroke_options
@page_option
def report(file: Path, output: Path | None, **options: Any) -> None:
    """Report the squirt of a cue with its uncertainty, then natural frequencies, end mass, pivot length and masses.

    Prints tables; -o FILE.html writes a page with figures. Assumptions are listed last, each with its option.
    """
    if output is None:
        record = run_on_scene(file, options, report_record, partial(_sheets, file))
        if "no_contact" in record:
            raise InputError(file, "", f"{record['no_contact']} (--tip-height, --leather, --speed)")
    else:
        _write_page(file, output, options)


def _sheets(file: Path, record: Record, about: Record) -> list[Table | str]:
    """The tables, followed by suggested commands."""
    sheets = tabulate_report(record, about)
    return (
        [*sheets, "", f"Design changes: cuefem improve {file}, with the same options"]
        if "verdict" in record and "modes" in record  # a lumped cue has nothing that a maker can change
        else sheets
    )


def _write_page(file: Path, output: Path, options: dict[str, Any]) -> None:
    from cuefem.show.report_page import page_and_headline  # templates and charts take 0.1 s to load

    if options["as_json"]:
        raise InputError(output, "--output", "cannot be combined with --json")
    scene, notes = scene_of(file, options)
    with errors_name_file(file, options):
        lines = [*drawing_warnings(file), *plausibility_warnings(scene)]
        more: dict[str, Any] = {"rtol": load_accuracy(file), "warnings": lines}
        text, line = page_and_headline(file.name, scene, notes=notes, progress=with_progress_bar, **more)
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
    """List design changes a maker can make, with squirt, stiffness, mass and first natural frequency of each.

    Each change is applied on its own and computed by the coupled strike. Rows are sorted by squirt, lowest first.
    """
    drawing = output is not None and output.suffix == ".toml"
    if (take is not None) != drawing:
        raise InputError(file, "--take", "requires -o FILE.toml, which requires --take ROW")
    if take is None or output is None:
        run_on_scene(
            file,
            {**options, "output": output},
            lambda scene: design_changes(scene, progress=with_progress_bar),
            lambda record, about: [tabulate_design_changes(record)],
        )
        return
    check_overwrite(output, force=force)
    scene, _ = scene_of(file, options)
    with errors_name_file(file, options):
        rows = design_changes(scene, progress=with_progress_bar)["changes"]
    if take > len(rows):
        raise InputError(file, "--take", f"must be a row of the table, 1 to {len(rows)}; got {take}")
    row = rows[take - 1]
    changed = with_parameters(scene, row["values"])
    save(changed, output)
    click.echo(f"wrote {output}: {row['change']}")
    if not any(value for name, value in options.items() if name != "as_json"):  # options would apply to both files
        same = ["--same-shaft"] if main_material(scene.shaft).E == main_material(changed.shaft).E else []
        click.echo(f"before and after: {shlex.join(['cuefem', 'compare', str(file), str(output), *same])}")


@command()
@file_options
@tip_options
@page_option
@click.option(
    "--near", metavar="HERTZ", type=float, help="Show the modes nearest this frequency instead of the lowest."
)
@click.option("--count", type=click.IntRange(min=1), default=6, show_default=True, help="Number of modes.")
def modes(file: Path, near: float | None, count: int, **options: Any) -> None:
    """Compute natural frequencies of bending, with period and tip amplitude of each mode."""

    def results(scene: Scene) -> Any:
        return modes_record(scene, count=count, near=near)

    run_on_scene(file, options, results, lambda record, about: [tabulate_modes(record)], with_impact=False)


@command("end-mass", cls=WithDefinitions)
@stroke_options
@page_option
@click.option("--paper", is_flag=True, help="Also show m_c (the end mass of Kim's paper) and eps.")
def end_mass(file: Path, paper: bool, **options: Any) -> None:
    """Compute the effective end mass: the transverse inertia of the cue at its tip, by five definitions."""
    run_on_scene(
        file, options, end_mass_record, lambda record, about: [tabulate_end_masses(record, about, paper=paper)]
    )


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
        run_on_scene(file, options, results, lambda record, about: [tabulate_strike(record, about)])
        return
    output = options["output"]
    to_file = output is not None and output.suffix == ".json"
    record = run_on_scene(
        file,
        options,
        lambda scene: pooltool_record(file.stem, scene, str(output) if to_file else "cue.json"),
        lambda record, about: tabulate_pooltool(record, written=to_file),
    )
    if to_file:
        print_tables(tabulate_pooltool(record, written=True))
