"""Verification commands: effects, cost, check."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

import cuefem as cf
from cuefem.cli.progress import with_progress_bar
from cuefem.cli.scene_command import Request, analysis_command
from cuefem.files import load_accuracy

if TYPE_CHECKING:
    from cuefem.show.analysis import Analysis


@analysis_command()
def effects(request: Request) -> Analysis:
    """Sensitivity to the physical effects: remove each effect of the scene, add each other one.

    The scene is FILE's; a shaft gets the game's default stroke. An effect is significant if squirt, ball speed or spin
    changes by at least rtol, relative ([accuracy] in FILE, default 1e-2).
    """
    return cf.effect_sensitivity(request.scene, load_accuracy(request.file), progress=with_progress_bar)


@analysis_command()
@click.option(
    "--max-modes",
    type=click.IntRange(min=24),
    default=150,
    show_default=True,
    help="Refine up to this many modes; at least three levels (12, 24 and 48 modes or more) run.",
)
def cost(request: Request, max_modes: int) -> Analysis:
    """Run a convergence study and recommend a resolution: error against run time and degrees of freedom."""
    return cf.convergence_study(request.scene, max_modes, progress=with_progress_bar)


@analysis_command()
def check(request: Request) -> Analysis:
    """Compare the beam model of a shaft with a 3-D elastic solid: frequencies, stiffness, end mass and squirt.

    The solid is computed with elements of two orders; their difference is the discretisation error. Effects that the
    solid lacks (AxialWaves, GeometricStiffness ...) are removed from both models and listed. Run time: some seconds,
    longer for a shaft of many segments.
    """
    return cf.model_error(request.scene, progress=with_progress_bar)
