"""Verification commands: effects, cost, check."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

import cuefem.show
from cuefem.cli.output import command, page_option
from cuefem.cli.progress import with_progress_bar
from cuefem.cli.scene_command import run_on_scene, stroke_options
from cuefem.io import load_accuracy
from cuefem.scene import Scene
from cuefem.show import DEFAULT_RTOL, effects_record, tabulate_effects
from cuefem.show.convergence_table import convergence_charts, convergence_record, tabulate_convergence


@command()
@stroke_options
@page_option
def effects(file: Path, **options: Any) -> None:
    """Sensitivity to the physical effects: remove each effect of the scene, add each other one.

    The scene is FILE's; a shaft gets the game's default stroke. An effect is significant if squirt, ball speed or spin
    changes by at least rtol, relative ([accuracy] in FILE, default 1e-2).
    """

    def results(scene: Scene) -> Any:
        rtol = load_accuracy(file)
        return effects_record(scene, rtol=DEFAULT_RTOL if rtol is None else rtol, progress=with_progress_bar)

    run_on_scene(file, options, results, lambda record, about: [tabulate_effects(record, about)])


@command()
@stroke_options
@click.option(
    "--max-modes",
    type=click.IntRange(min=24),
    default=150,
    show_default=True,
    help="Refine up to this many modes; at least three levels (12, 24 and 48 modes or more) run.",
)
@page_option
def cost(file: Path, max_modes: int, **options: Any) -> None:
    """Run a convergence study and recommend a resolution: error against run time and degrees of freedom."""

    def results(scene: Scene) -> Any:
        return convergence_record(scene, max_modes=max_modes, progress=with_progress_bar)

    figures = convergence_charts if options["output"] else lambda record: []
    run_on_scene(file, options, results, lambda record, about: [*tabulate_convergence(record), *figures(record)])


@command()
@stroke_options
@page_option
def check(file: Path, **options: Any) -> None:
    """Compare the beam model of a shaft with a 3-D elastic solid: frequencies, stiffness, end mass and squirt.

    The solid is computed with elements of two orders; their difference is the discretisation error. Effects that the
    solid lacks (AxialWaves, GeometricStiffness ...) are removed from both models and listed. Run time: some seconds,
    longer for a shaft of many segments.
    """

    def results(scene: Scene) -> Any:
        return cuefem.show.model_error_record(
            scene, with_progress_bar
        )  # loads scikit-fem, which only this command needs

    run_on_scene(
        file, options, results, lambda record, about: [cuefem.show.tabulate_model_error(record), record["summary"]]
    )
