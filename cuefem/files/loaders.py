"""The cue or the stroke of any file, whichever of both the file holds: `load` with one type."""

from __future__ import annotations

import os
from copy import copy
from pathlib import Path
from typing import TypedDict, Unpack

from cuefem.cue import Cue
from cuefem.files import load
from cuefem.files.cue_names import named_path
from cuefem.files.defaults_report import assumptions, offered_assumptions
from cuefem.files.errors import InputError
from cuefem.files.warnings_of_drawings import drawing_warnings
from cuefem.quantity.fields import quote, suggestion
from cuefem.scene import Assumed, Scene
from cuefem.scene.default_scene import DEFAULT_GAME, STROKES, StrokeName, usual_scene


class LoadOptions(TypedDict, total=False):
    """The options of `load`."""

    material: str | None
    length_unit: str | None
    front: str | None
    ferrule: str | None
    bore: str | None
    body_mass: str | float | None


def load_cue(path: str | os.PathLike[str], **options: Unpack[LoadOptions]) -> Cue:
    """Load the cue of a file: that of a drawing or of a scene.

    Parameters
    ----------
    path : str or path
        A file, or the name of a cue, as for `load`.
    **options
        Those of `load`: material, length_unit, front, ferrule, bore, body_mass.

    Returns
    -------
    Cue
        Its segments and masses.

    Raises
    ------
    InputError
        As `load`; also for a scene of a lumped cue, which has no segments.

    Examples
    --------
    >>> import cuefem as cf
    >>> cf.modes(cf.load_cue("plain maple"), 3).frequencies.round(0).tolist()
    [92.0, 276.0, 552.0]
    """
    loaded = load(path, **options)
    cue = loaded if isinstance(loaded, Cue) else loaded.cue
    if not isinstance(cue, Cue):
        raise InputError(Path(path), "cue", "must have segments; got a lumped cue: load_scene loads it")
    return cue


def load_scene(
    path: str | os.PathLike[str], *, game: StrokeName | None = None, **options: Unpack[LoadOptions]
) -> Scene:
    """Load the stroke that the commands see in a file: a scene, or a drawing with the default stroke of a game.

    Parameters
    ----------
    path : str or path
        A file, or the name of a cue such as "plain maple" (`cuefem.parts` lists them), as for `load`.
    game : str, optional
        For a drawing, as for `usual_scene`: "pool" (default), "carom", "snooker" or "kim".
    **options
        Those of `load`: material, length_unit, front, ferrule, bore, body_mass.

    Returns
    -------
    Scene
        What every question takes.

    Raises
    ------
    InputError
        As `load`; also for an unknown game, and a game beside a scene, which has its own ball, tip and stroke.

    Examples
    --------
    >>> import cuefem as cf
    >>> scene = cf.load_scene("plain maple")
    >>> scene.ball.mass, scene.stroke.speed
    (0.17, 2.0)
    >>> cf.load_scene("plain maple", game="snooker", body_mass="13 oz").ball.mass
    0.142
    """
    if game not in (None, *STROKES):
        hint = suggestion(str(game), STROKES)
        raise InputError(Path(path), "game", f"must be one of {', '.join(STROKES)}; got {quote(game)}{hint}")
    loaded = load(path, **options)
    if isinstance(loaded, Cue):
        given = {**options} if game is None else {**options, "game": game}
        return _with_assumptions(usual_scene(loaded, game or DEFAULT_GAME), path, given)
    if game is not None:
        problem = "does not apply: the file is a scene, which has its own ball, tip and stroke"
        raise InputError(Path(path), "game", f"{problem}; got {quote(game)}")
    return _with_assumptions(loaded, path, {**options})


def _with_assumptions(scene: Scene, path: str | os.PathLike[str], options: dict[str, object]) -> Scene:
    """The scene with what its file and the options leave open, and the warnings of the file."""
    file = named_path(Path(path))
    found = assumptions(file, scene, {name: value for name, value in options.items() if value is not None})
    made = copy(scene)
    listed = tuple(offered_assumptions(found))
    object.__setattr__(made, "assumed", Assumed(scene, listed, tuple(drawing_warnings(file))))
    return made
