"""Verification commands: effects, cost, check."""

from __future__ import annotations

import click

import cuefem.show
from cuefem.analysis.answer import Answer
from cuefem.cli.progress import with_progress_bar
from cuefem.cli.scene_command import Request, analysis_command
from cuefem.files import load_accuracy
from cuefem.show.convergence_table import convergence_charts, convergence_record, tabulate_convergence
from cuefem.show.scene_summary import scene_record


@analysis_command()
def effects(request: Request) -> Answer:
    """Sensitivity to the physical effects: remove each effect of the scene, add each other one.

    The scene is FILE's; a shaft gets the game's default stroke. An effect is significant if squirt, ball speed or spin
    changes by at least rtol, relative ([accuracy] in FILE, default 1e-2).
    """
    rtol = load_accuracy(request.file) or cuefem.show.DEFAULT_RTOL
    record = cuefem.show.effects_record(request.scene, rtol=rtol, progress=with_progress_bar)
    about = scene_record(request.scene)
    return Answer(request.scene, record, lambda record: [cuefem.show.tabulate_effects(record, about)])


@analysis_command()
@click.option(
    "--max-modes",
    type=click.IntRange(min=24),
    default=150,
    show_default=True,
    help="Refine up to this many modes; at least three levels (12, 24 and 48 modes or more) run.",
)
def cost(request: Request, max_modes: int) -> Answer:
    """Run a convergence study and recommend a resolution: error against run time and degrees of freedom."""
    record = convergence_record(request.scene, max_modes=max_modes, progress=with_progress_bar)
    return Answer(request.scene, record, lambda record: [*tabulate_convergence(record)], convergence_charts)


@analysis_command()
def check(request: Request) -> Answer:
    """Compare the beam model of a shaft with a 3-D elastic solid: frequencies, stiffness, end mass and squirt.

    The solid is computed with elements of two orders; their difference is the discretisation error. Effects that the
    solid lacks (AxialWaves, GeometricStiffness ...) are removed from both models and listed. Run time: some seconds,
    longer for a shaft of many segments.
    """
    record = cuefem.show.model_error_record(request.scene, with_progress_bar)  # only this command needs scikit-fem
    return Answer(request.scene, record, lambda record: [cuefem.show.tabulate_model_error(record), record["summary"]])
