"""Verification commands: effects, cost, check."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

import cuefem.report
from cuefem.cli.common import show, stroke_options
from cuefem.cli.printing import command, page_option
from cuefem.cli.progress import followed
from cuefem.io import load_accuracy
from cuefem.report import DEFAULT_RTOL, effects_record, effects_sheet
from cuefem.report.cost import cost_charts, cost_record, cost_sheets
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
        return effects_record(scene, rtol=DEFAULT_RTOL if rtol is None else rtol, progress=followed)

    show(file, options, results, lambda record, about: [effects_sheet(record, about)])


@command()
@stroke_options
@click.option("--most", type=click.IntRange(min=24), default=150, show_default=True, help="Largest number of modes.")
@page_option
def cost(file: Path, most: int, **options: Any) -> None:
    """Run a convergence study and recommend a resolution: error against run time and degrees of freedom."""

    def results(scene: Scene) -> Any:
        return cost_record(scene, most=most, progress=followed)

    figures = cost_charts if options["output"] else lambda record: []
    show(file, options, results, lambda record, about: [*cost_sheets(record), *figures(record)])


@command()
@stroke_options
@page_option
def check(file: Path, **options: Any) -> None:
    """Compare the beam model of a shaft with a 3-D elastic solid: frequencies, stiffness, end mass and squirt.

    The shaft is computed as a solid of revolution on two meshes, which gives the discretisation error beside each
    difference. Takes seconds.
    """

    def results(scene: Scene) -> Any:
        return cuefem.report.model_error_record(scene, followed)  # loads scikit-fem, which the others need not

    show(file, options, results, lambda record, about: [cuefem.report.model_error_sheet(record), record["summary"]])
