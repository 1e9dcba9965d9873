"""`cuefem designer`: serve and open the designer's page."""

from __future__ import annotations

import socket
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from cuefem.cli.output import command, print_json
from cuefem.cli.pending_warnings import print_pending_warnings
from cuefem.cli.request import Request, errors_name_file
from cuefem.cli.scene_command import calibration_option, cue_options
from cuefem.cli.scene_options import CueFile, option
from cuefem.files.cue_names import REFERENCES, cue_name

if TYPE_CHECKING:
    from cuefem.measurements.calibration import Calibration


@command()
@click.argument("scene", type=CueFile(), required=False)
@click.option(
    "--port",
    type=click.IntRange(0, 65535),
    default=8470,
    show_default=True,
    help="Port of the page; 0: any free port.",
)
@click.option("--open/--no-open", "show", default=True, help="Open the page in the browser.", show_default=True)
@calibration_option
@cue_options
def designer(
    scene: Path | None, port: int, show: bool, calibration: Calibration | None, as_json: bool, **options: Any
) -> None:
    """Open a browser page with sliders: squirt, end mass, stiffness and natural frequencies update as they move.

    SCENE is a cue or scene file, or a cue's name (default: a maple pool shaft). A cue alone gets the default stroke of
    the game. The page is served on this computer only.
    """
    try:
        from cuefem.designer.server import serve
        from cuefem.designer.state import design_of, reference_design
    except ModuleNotFoundError as error:
        if error.name is None or error.name.startswith("cuefem"):
            raise
        raise ValueError(f"the designer needs {error.name}: pip install '.[designer]' in the clone") from None

    if scene is None:
        for name in [name for name, text in options.items() if text is not None]:
            raise ValueError(f"{option(name)} needs a SCENE, whose cue or stroke it changes; got none")
        first = reference_design(REFERENCES[0])
    else:
        request = Request.of(scene, options).with_shop()
        with request.errors():
            first = design_of(cue_name(scene) or scene.stem, request.scene, request.assumed)
        request.print_warnings()
        print_pending_warnings()
    if calibration is not None:
        with errors_name_file(scene or Path(REFERENCES[0])):
            calibration.check(first.scene)
    announce: Callable[[str], None] = (lambda address: print_json({"address": address})) if as_json else click.echo
    with suppress(KeyboardInterrupt):  # Ctrl-C is how one ends it
        units = click.get_current_context().get_parameter_source("units")
        is_default = units is ParameterSource.DEFAULT
        serve(
            first,
            port=_free(port),
            show=show,
            announce=announce,
            calibration=calibration,
            with_kept_units=is_default,
        )


def _free(port: int) -> int:
    """The port if it is available; any available one for 0."""
    with socket.socket() as tried:
        tried.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            tried.bind(("127.0.0.1", port))
        except OSError as error:
            raise ValueError(f"--port {port} is not available ({error.strerror}); 0 takes any free port") from None
        return int(tried.getsockname()[1])
