"""The only part of cuefem that opens files: cues and scenes as TOML, lathe profiles as CSV, shafts as CAD surfaces."""

from __future__ import annotations

import errno
import os
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from cuefem.contact.side_strike import SideStrike
from cuefem.cue import Cue
from cuefem.io.errors import InputError, faults_of, reason, shown
from cuefem.io.fittings import fitted, with_shaft_of
from cuefem.io.profile import DEFAULT_MATERIAL, SHAPES, TABLES, read_profile
from cuefem.io.toml import drawn_cue, load_accuracy, load_cue, load_toml, named_material
from cuefem.parameters.parameter import with_fields
from cuefem.parameters.parts import with_shaft_mass
from cuefem.quantity.fields import Quantity
from cuefem.quantity.units import number
from cuefem.scene import Scene

__all__ = [
    "DEFAULT_MATERIAL",
    "InputError",
    "check_new",
    "check_place",
    "load",
    "load_accuracy",
    "load_stroke",
    "number",
    "save",
    "save_page",
    "write_whole",
    "write_whole_folder",
]

MESH = ".vtu"


def load(
    path: str | os.PathLike[str],
    *,
    material: str | None = None,
    length_unit: str | None = None,
    begins: str | None = None,
    ferrule: str | None = None,
    bore: str | None = None,
    body_mass: str | float | None = None,
) -> Cue | Scene | SideStrike:
    """Load a cue or a scene from a file.

    Parameters
    ----------
    path : str or path
        A drawing or a scene (.toml), a lathe profile (.csv), or a closed CAD surface (.stl, .ply, .obj).
    material : str, optional
        Name of the material of the shaft. A lathe profile or a surface names none, and has "hard maple" by default.
    length_unit : str, optional
        Unit of a surface's coordinates, "mm" by default, or of a lathe profile whose columns name none.
    begins : str, optional
        Where a lathe profile or a surface begins: "ferrule", the default, or "leather 6 mm", its front being leather.
    ferrule : str, optional
        A ferrule on the front of the shaft, such as "25 mm melamine". It sits on a tenon of the shaft's wood, 0.62
        of its width; "25 mm melamine, tenon 8 mm" and "25 mm melamine, no tenon" are others.
    bore : str, optional
        A bore, such as "6 mm wide, 127 mm deep": from the end of the ferrule's tenon on, or else from the front.
    body_mass : str or float, optional
        Mass of the rest of the cue behind the drawing, such as "15 oz", or a number in kg; without it that of the file.

    Returns
    -------
    Cue, Scene or SideStrike
        A .toml file with [[segments]] at its top is a cue, one with [cue] is a scene; if it has a [striker] too, it is
        a strike from the side.

    Raises
    ------
    InputError
        A ValueError in one line that names the file, the key, the bound with its unit, and the value in the file.

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
    path = Path(path)
    shape = path.suffix.lower() in SHAPES
    for name, value, whose in (("length_unit", length_unit, "units of length"), ("begins", begins, "leather")):
        if value is not None and not shape:
            files = f"{', '.join(SHAPES[:-1])} and {SHAPES[-1]}"
            raise InputError(path, "", f"has its own {whose}: {name} is for {files} files alone; got {value!r}")
    if path.suffix.lower() == ".toml":
        loaded = load_toml(path, _load_cue)
    else:
        loaded = _load_cue(path, material if shape else None, length_unit)
    told = {"begins": begins, "ferrule": ferrule, "bore": bore}
    changed = any(told.values()) or (material is not None and not shape)
    if (changed or body_mass is not None) and isinstance(loaded, Scene) and loaded.lumped:
        raise InputError(path, "cue", "is a lumped cue, which has no material, ferrule, bore or body mass")
    cue = loaded if isinstance(loaded, Cue) else loaded.cue
    weight = cue.shaft_mass if isinstance(cue, Cue) and cue.weighed else 0.0
    with faults_of(path, ""):
        if material is not None and not shape:
            named_material(material, path, "material")
            loaded = with_shaft_of(loaded, material)
        if changed:
            loaded = fitted(loaded, **told)
        if changed and weight:  # options on a shaft do not change its measured mass
            told_of: Any = loaded if isinstance(loaded, Cue) else loaded.cue
            weighed = with_shaft_mass(told_of, weight)
            loaded = weighed if isinstance(loaded, Cue) else replace(loaded, cue=weighed)
    return loaded if body_mass is None else with_body_mass(loaded, path, "body_mass", body_mass)


def with_body_mass(thing: Any, path: Path, key: str, mass: str | float) -> Any:
    """A file's cue, scene or side strike with another mass behind the drawing: a text with its unit, or kg."""
    with faults_of(path, key):
        value = Quantity("kg", "[0, inf)").read(mass if isinstance(mass, str) else f"{mass!r} kg")
    return with_fields(thing, {("body_mass",) if isinstance(thing, Cue) else ("cue", "body_mass"): value})


def _load_cue(path: Path, material: str | None = None, length_unit: str | None = None) -> Cue:
    ending = path.suffix.lower()
    if ending == ".toml":
        return load_cue(path)
    if ending in SHAPES:
        wood = named_material(material or DEFAULT_MATERIAL, path, "material")
        if ending == ".csv":
            return read_profile(path, wood, length_unit)[0]
        from cuefem.io.surface import load_surface

        return load_surface(path, wood, length_unit)
    if os.path.isdir(path):  # unlike Path.is_dir, of names too long as well
        raise InputError(path, "", "must be a file; got a folder")
    hint = "; save the table as .csv" if ending in TABLES else ""
    raise InputError(path, "", f"must end in .toml, .csv, .stl, .ply or .obj; got {path.suffix!r}{hint}")


def load_stroke(path: Path, **told: str | None) -> Cue | Scene:
    """A cue or the scene of a stroke along it, told: as for `load`; InputError for a strike from the side."""
    stroke = load(path, **told)
    if isinstance(stroke, SideStrike):
        raise InputError(path, "striker", "must be absent here: `cuefem.side_strike` takes a side strike")
    return stroke


def replaced_segments(path: Path, scene: Scene) -> int:
    """How many segments of a cue's or a scene's file are no segments of its scene, since a `LeatherTip` replaces them.

    They are the first of the drawing: segment N of the file is segment N less so many of the scene.
    """
    drawn = drawn_cue(path, _load_cue) if isinstance(load_stroke(path), Scene) else _load_cue(path)
    return len(drawn.segments) - len(scene.cue.segments)


def save(obj: Cue | Scene | SideStrike, path: str | os.PathLike[str]) -> None:
    """Write a cue or a scene into a file: as TOML that `load` reads back, numbers to 12 digits, or as a line mesh.

    Parameters
    ----------
    obj : Cue, Scene or SideStrike
        What to write.
    path : str or path
        A .toml file; for a cue also a line mesh, .vtu, for other programs: a cell for each segment with its sizes
        and materials as cell data, SI. The file appears whole or not at all.

    Raises
    ------
    InputError
        If the file cannot be written.
    TypeError
        If ``obj`` is neither a cue nor a scene.
    ValueError
        If the scene holds arrays, which have no place in a file.

    Examples
    --------
    See `load`.
    """
    if not isinstance(obj, Cue | Scene | SideStrike):
        raise TypeError(f"save writes a Cue, a Scene or a SideStrike; got {shown(obj)}")
    path = Path(path)
    if path.suffix.lower() == ".toml":
        from cuefem.io.toml_text import toml_text

        content = toml_text(obj)
        write_whole(path, lambda temporary: temporary.write_text(content, encoding="utf-8"))
    elif path.suffix.lower() == MESH and isinstance(obj, Cue):
        from cuefem.io.line_mesh import save_line_mesh

        write_whole(path, lambda temporary: save_line_mesh(obj, temporary))
    else:
        allowed = ".toml or .vtu" if isinstance(obj, Cue) else ".toml, for a scene"
        raise InputError(path, "", f"must end in {allowed}; got {path.suffix!r}")


def save_page(text: str, path: str | os.PathLike[str]) -> None:
    """Write a page as .html, whole or not at all; InputError if that fails."""
    path = Path(path)
    if path.suffix != ".html":
        raise InputError(path, "", f"must end in .html; got {path.suffix!r}")
    write_whole(path, lambda temporary: temporary.write_text(text, encoding="utf-8"))


def write_whole(path: Path, put: Callable[[Path], object]) -> None:
    """Write into a file beside ``path`` and move it there whole, so that nothing half written is ever seen."""
    goal = Path(os.path.realpath(path))
    temporary = goal.with_name(f".{goal.stem}.{os.getpid()}{goal.suffix}")
    try:
        put(temporary)
        temporary.replace(goal)
    except OSError as error:
        raise InputError(path, "", f"cannot be written: {reason(error)}") from None
    finally:
        temporary.unlink(missing_ok=True)


def check_new(folder: Path) -> None:
    """InputError if a folder, or anything of its name, is there already."""
    if folder.exists() or folder.is_symlink():
        raise InputError(folder, "", "must be a new folder; there is one, or a file, of that name")


def write_whole_folder(folder: Path, put: Callable[[Path], object]) -> None:
    """Write into a new folder beside ``folder`` and move it there whole, so that nothing half written is ever seen."""
    check_new(folder)
    temporary = folder.with_name(f".{folder.name}.{os.getpid()}")
    try:
        temporary.mkdir()
        put(temporary)
        temporary.rename(folder)
    except OSError as error:
        raise InputError(folder, "", f"cannot be written: {reason(error)}") from None
    finally:
        shutil.rmtree(temporary, ignore_errors=True)


def check_place(path: Path) -> None:
    """Raise InputError, before anything is computed, if no file can be written at ``path``."""
    goal = Path(os.path.realpath(path))
    exists = goal.parent.is_dir()
    if goal.is_dir() or not exists or not os.access(goal.parent, os.W_OK):
        code = errno.EISDIR if goal.is_dir() else errno.EACCES if exists else errno.ENOENT
        raise InputError(path, "", f"cannot be written: {os.strerror(code)}")
