"""The public doors of files: what a file holds, its cue, or the stroke that the commands see in it."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Unpack

from cuefem.cue import Cue
from cuefem.files import LoadOptions
from cuefem.files import load as read_file
from cuefem.files.cue_names import named_path
from cuefem.files.defaults_report import Assumption, with_assumptions
from cuefem.files.errors import InputError, as_input_error, quote
from cuefem.files.shop import shop_defaults
from cuefem.scene import Scene
from cuefem.scene.default_scene import DEFAULT_GAME, StrokeName, stroke_name, usual_scene


def load(path: str | os.PathLike[str], **options: Unpack[LoadOptions]) -> Cue | Scene:
    """Load a cue or a scene from a file.

    Parameters
    ----------
    path : str or path
        A drawing or a scene (.toml), a lathe profile (.csv), or a closed CAD surface (.stl, .ply, .obj); or the name of
        a cue, such as "plain maple", "carbon" or "predator z2" (`cuefem parts` lists them).
    material : str, optional
        Name of the material of the shaft, instead of the one in the file; for a lathe profile or a surface that names
        none "hard maple" by default. A weighed density (``shaft_mass``) is that of the wood of the file: another
        material has its own, and all other options keep it.
    length_unit : str, optional
        Unit of a surface's coordinates, "mm" by default, or of a lathe profile without units.
    front : str, optional
        Front of a lathe profile or a surface: "ferrule" (default) or "leather 6 mm".
    ferrule : str, optional
        A ferrule at the front, such as "25 mm melamine", on a wooden tenon of 0.62 of its diameter. The tenon may be
        named: "25 mm melamine, tenon 8 mm", "25 mm melamine, no tenon".
    bore : str, optional
        A bore, such as "6 mm wide, 127 mm deep", drilled from behind the tenon of the ferrule, or from the front.
    body_mass : str or float, optional
        Mass of the rest of the cue behind the drawing, such as "15 oz", or a number in kg; by default from the file.

    Returns
    -------
    Cue or Scene
        A .toml file with [[segments]] is a cue, one with [cue] a scene.

    Raises
    ------
    InputError
        A ValueError in one line that names the file, the key, the bound with its unit, and the value in the file.
    TypeError
        For another option.

    Examples
    --------
    >>> import cuefem as cf
    >>> cue = cf.Cue((cf.Segment(0.7, 0.012, 0.021, cf.Material(12.6e9, 0.84e9, 700.0)),))
    >>> import tempfile, pathlib
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder) / "cue.toml"
    ...     cf.save(cue, path)
    ...     cf.load(path) == cue, cf.load(path, body_mass="15 oz").body_mass
    (True, 0.425242...)
    """
    return _loaded(path, options)


def _loaded(path: str | os.PathLike[str], options: LoadOptions, notes: Sequence[Assumption] = ()) -> Cue | Scene:
    """What a file holds, with its assumptions and warnings; notes: assumptions on its options."""
    loaded, file = read_file(path, **options), named_path(Path(path))
    given = {name: value for name, value in options.items() if value is not None}
    return with_assumptions(file, loaded, given, notes)


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

    Body mass and ferrule that file and options leave open are those of the [defaults] in a ``shop.toml``, if there is
    one beside the file, in a folder above it, or in the user's configuration folder; the scene's assumptions say so.

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
    with as_input_error(Path(path), ""):
        stroke = stroke_name(DEFAULT_GAME if game is None else game)
    given = {name: value for name, value in options.items() if value is not None}
    added, notes = shop_defaults(named_path(Path(path)), given)
    completed: Any = {**options, **added}
    loaded = _loaded(path, completed, notes)
    if isinstance(loaded, Cue):
        set_here = frozenset() if game is None else frozenset(("game",))
        return usual_scene(loaded, stroke).assuming(game=stroke, given=set_here)
    if game is not None:
        problem = "does not apply: the file is a scene, which has its own ball, tip and stroke"
        raise InputError(Path(path), "game", f"{problem}; got {quote(game)}")
    return loaded
