"""`cuefem check`: beam theory beside the solid."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from cuefem.cli.common import file_options, show
from cuefem.cli.printing import page_option
from cuefem.cli.progress import followed
from cuefem.cli.strokes import blow_options, offset_option
from cuefem.report.model_error import model_error_record, model_error_sheet
from cuefem.scene import Scene


@click.command()
@file_options
@blow_options
@offset_option
@page_option
def check(file: Path, **given: Any) -> None:
    """Show how far beam theory is off for a shaft: its numbers by the beam, and by 3-D elasticity of the solid.

    FILE is a cue or a scene. The shaft is computed as a solid of revolution on two meshes, so that the mesh's own error
    stands beside each difference; this takes some seconds.
    """

    def results(scene: Scene) -> Any:
        return model_error_record(scene, followed)

    show(file, given, results, lambda found, about: [model_error_sheet(found), found["sentence"]])
