"""Verification commands: effects, cost, check."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

import cuefem.report
from cuefem.cli.common import run_on_scene, stroke_options
from cuefem.cli.output import command, page_option
from cuefem.cli.progress import with_progress_bar
from cuefem.io import load_accuracy
from cuefem.report import DEFAULT_RTOL, effects_record, tabulate_effects
from cuefem.report.convergence_table import convergence_charts, convergence_record, tabulate_convergence
from cuefem.scene import Scene


@command()
@stroke_options
@page_option
def effects(file: Path, **options: Any) -> None:
    """Test the physical effects one at a time: remove each one FILE lists, add each one it does not.

    An effect matters if squirt, ball speed or spin change by more than the rtol of the file's [accuracy] table
    (default 1e-2).
    """

    def results(scene: Scene) -> Any:
        rtol = load_accuracy(file)
        return effects_record(scene, rtol=DEFAULT_RTOL if rtol is None else rtol, progress=with_progress_bar)

    run_on_scene(file, options, results, lambda record, about: [tabulate_effects(record, about)])


@command()
@stroke_options
@click.option("--most", type=click.IntRange(min=24), default=150, show_default=True, help="Largest number of modes.")
@page_option
def cost(file: Path, most: int, **options: Any) -> None:
    """Run a convergence study and recommend a resolution: error against run time and degrees of freedom."""

    def results(scene: Scene) -> Any:
        return convergence_record(scene, most=most, progress=with_progress_bar)

    figures = convergence_charts if options["output"] else lambda record: []
    run_on_scene(file, options, results, lambda record, about: [*tabulate_convergence(record), *figures(record)])


@command()
@stroke_options
@page_option
def check(file: Path, **options: Any) -> None:
    """Compare the beam model of a shaft with a 3-D elastic solid: frequencies, stiffness, end mass and squirt.

    The shaft is computed as a solid of revolution on two meshes, which gives the discretisation error beside each
    difference. Takes seconds.
    """

    def results(scene: Scene) -> Any:
        return cuefem.report.model_error_record(scene, with_progress_bar)  # loads scikit-fem, which the others need not

    run_on_scene(
        file, options, results, lambda record, about: [cuefem.report.tabulate_model_error(record), record["summary"]]
    )
