"""Commands that say what a result hangs on: effects, cost, check."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

import cuefem.report
from cuefem.cli.common import show, stroke_options
from cuefem.cli.printing import command, output_option, page_option
from cuefem.cli.progress import followed
from cuefem.io import FIGURES, load_accuracy, save_figure
from cuefem.report import DEFAULT_RTOL, effects_record, effects_sheet
from cuefem.report.cost import cost_figure, cost_record, cost_sheets
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
        return effects_record(scene, rtol=DEFAULT_RTOL if rtol is None else rtol, track=followed)

    show(file, options, results, lambda record, about: [effects_sheet(record, about)])


@command()
@stroke_options
@click.option("--most", type=click.IntRange(min=24), default=150, show_default=True, help="Largest number of modes.")
@output_option(".html", *FIGURES)
def cost(file: Path, most: int, output: Path | None, **options: Any) -> None:
    """Run a convergence study and recommend a resolution: error against run time and degrees of freedom."""

    def results(scene: Scene) -> Any:
        record = cost_record(scene, most=most, track=followed)
        if output is not None and output.suffix in FIGURES:
            save_figure(cost_figure(record, f"{file.name}: convergence study", output.suffix[1:]), output)
        return record

    page = output if output is not None and output.suffix not in FIGURES else None
    show(file, {**options, "output": page}, results, lambda record, about: cost_sheets(record))


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

    show(file, options, results, lambda record, about: [cuefem.report.model_error_sheet(record), record["sentence"]])
