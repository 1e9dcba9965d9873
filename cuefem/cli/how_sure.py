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
    """Show what each effect changes: every effect of FILE is left out, every other one added, one at a time.

    An effect matters if it changes more than the rtol of the file's [accuracy], by default 1e-2.
    """

    def results(scene: Scene) -> Any:
        rtol = load_accuracy(file)
        return effects_record(scene, rtol=DEFAULT_RTOL if rtol is None else rtol, track=followed)

    show(file, options, results, lambda record, about: [effects_sheet(record, about)])


@command()
@stroke_options
@click.option(
    "--most", type=click.IntRange(min=24), default=150, show_default=True, help="The largest number of modes."
)
@output_option(".html", *FIGURES)
def cost(file: Path, most: int, output: Path | None, **options: Any) -> None:
    """Show what accuracy costs for this scene: error against time and unknowns, and which resolution to take."""

    def results(scene: Scene) -> Any:
        record = cost_record(scene, most=most, track=followed)
        if output is not None and output.suffix in FIGURES:
            save_figure(cost_figure(record, f"{file.name}: what accuracy costs", output.suffix[1:]), output)
        return record

    page = output if output is not None and output.suffix not in FIGURES else None
    show(file, {**options, "output": page}, results, lambda record, about: cost_sheets(record))


@command()
@stroke_options
@page_option
def check(file: Path, **options: Any) -> None:
    """Show how far beam theory is off for a shaft: its numbers by the beam, and by 3-D elasticity of the solid.

    FILE is a cue or a scene. The shaft is computed as a solid of revolution on two meshes, so that the mesh's own error
    stands beside each difference; this takes some seconds.
    """

    def results(scene: Scene) -> Any:
        return cuefem.report.model_error_record(scene, followed)  # loads scikit-fem, which the others need not

    show(file, options, results, lambda record, about: [cuefem.report.model_error_sheet(record), record["sentence"]])
