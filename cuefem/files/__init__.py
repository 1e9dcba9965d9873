"""Reading and writing of files: cues and scenes (TOML), lathe profiles (CSV), CAD surfaces, ParaView."""

from __future__ import annotations

import errno
import os
import shutil
from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, TypedDict, Unpack

from cuefem.cue import Cue, LumpedCue
from cuefem.files.cue_names import named_path
from cuefem.files.errors import InputError, as_input_error, check_path, os_error_text, quote
from cuefem.files.lathe_profile import (
    DEFAULT_MATERIAL,
    DRAWING_EXTENSIONS,
    SHAPE_EXTENSIONS,
    SPREADSHEET_EXTENSIONS,
    read_profile,
)
from cuefem.files.schema import named_material
from cuefem.files.shaft_additions import with_additions
from cuefem.files.toml_reader import cue_as_drawn, load_accuracy, load_cue, load_toml, other_tables
from cuefem.files.warnings_of_drawings import drawing_warnings
from cuefem.parameters.field_paths import with_fields
from cuefem.quantity.fields import Quantity
from cuefem.quantity.unit_checks import DrawingWarning, warn
from cuefem.results.plausibility import drawing_warnings_of
from cuefem.scene import Scene
from cuefem.scene.default_scene import without_leather

__all__ = [
    "DEFAULT_MATERIAL",
    "InputError",
    "check_new_folder",
    "check_writable",
    "load",
    "load_accuracy",
    "save",
    "save_page",
    "today",
    "write_atomically",
    "write_folder_atomically",
]

MESH = ".vtu"


class LoadOptions(TypedDict, total=False):
    """The options of `load`: see `cuefem.files.loaders.load`."""

    material: str | None
    length_unit: str | None
    front: str | None
    ferrule: str | None
    bore: str | None
    body_mass: str | float | None


def load(path: str | os.PathLike[str], **options: Unpack[LoadOptions]) -> Cue | Scene:
    """The content of a file, without what it leaves open: see `cuefem.files.loaders.load`."""
    for name in options:
        if name not in LoadOptions.__annotations__:
            raise TypeError(f"a file is loaded with {', '.join(LoadOptions.__annotations__)}; got {quote(name)}")
    path = named_path(Path(path))
    shape = path.suffix.lower() in SHAPE_EXTENSIONS
    material, body_mass = options.get("material"), options.get("body_mass")
    for name, whose in (("length_unit", "units of length"), ("front", "leather")):
        value = options.get(name)
        if value is not None and not shape:
            files = f"{', '.join(SHAPE_EXTENSIONS[:-1])} and {SHAPE_EXTENSIONS[-1]}"
            raise InputError(path, name, f"is only for {files} files: this one has its own {whose}; got {value!r}")
    if path.suffix.lower() == ".toml":
        loaded = load_toml(path, _load_cue)
    else:
        loaded = _load_cue(path, material if shape else None, options.get("length_unit"))
    additions: Any = {key: options.get(key) for key in ("material", "front", "ferrule", "bore")}
    changed = any(additions.values()) or material is not None
    if (changed or body_mass is not None) and isinstance(loaded, Scene) and loaded.lumped:
        raise InputError(path, "cue", "is a lumped cue, without material, ferrule, bore or body mass")
    if changed:
        with as_input_error(path, ""):
            cue: Any = loaded if isinstance(loaded, Cue) else loaded.cue
            if material is not None:
                named_material(material, path, "material")
            cue = with_additions(cue, **additions)
            loaded = cue if isinstance(loaded, Cue) else replace(loaded, cue=cue)
    drawn = loaded if isinstance(loaded, Cue) else loaded.cue
    for line in drawing_warnings_of(drawn) if isinstance(drawn, Cue) else ():
        warn(f"{path.name}: {line}")
    return loaded if body_mass is None else with_body_mass(loaded, path, "body_mass", body_mass)


def with_body_mass(thing: Any, path: Path, key: str, mass: str | float) -> Any:
    """The cue or scene with another mass behind the drawing: a text with its unit, or a number in kg."""
    with as_input_error(path, key):
        value = Quantity("kg", "[0, inf)").read(mass if isinstance(mass, str) else f"{mass!r} kg")
    cue: tuple[str, ...] = () if isinstance(thing, Cue) else ("cue",)
    return with_fields(thing, {(*cue, "body_mass"): value, (*cue, "assumed_body_mass"): 0.0})


def _load_cue(path: Path, material: str | None = None, length_unit: str | None = None) -> Cue:
    path = named_path(path)
    ending = path.suffix.lower()
    if ending == ".toml":
        return load_cue(path)
    if ending in SHAPE_EXTENSIONS:
        wood = named_material(material or DEFAULT_MATERIAL, path, "material")
        if ending == ".csv":
            cue = read_profile(path, wood, length_unit)[0]
        else:
            from cuefem.files.surface_reader import load_surface

            cue = load_surface(path, wood, length_unit)
        for line in drawing_warnings(path):
            warn(line, DrawingWarning)
        return cue
    if os.path.isdir(path):  # does not raise for a name that is too long, unlike Path.is_dir
        is_measured = (path / "measured.toml").exists()
        what = "a measured cue's folder: `cuefem compare`, cuefem.compare(folder)" if is_measured else "a folder"
        raise InputError(path, "", f"must be a file; got {what}")
    hint = "; save the table as .csv" if ending in SPREADSHEET_EXTENSIONS else ""
    endings = f"{', '.join(DRAWING_EXTENSIONS[:-1])} or {DRAWING_EXTENSIONS[-1]}"
    raise InputError(path, "", f"must end in {endings}; got {path.suffix!r}{hint}")


def replaced_segments(path: Path, scene: Scene, **options: Any) -> int:
    """Number of drawn segments, the first of the file, that a `LeatherTip` replaces in the scene.

    options: of `load`, with which the scene was loaded.
    """
    loaded = load(path, **options)
    drawn = cue_as_drawn(path, _load_cue) if isinstance(loaded, Scene) else loaded
    if isinstance(drawn, LumpedCue) or scene.shaft.leather_height:
        return 0
    return len(drawn.segments) - len(without_leather(drawn).segments)


def save(obj: Cue | Scene, path: str | os.PathLike[str]) -> None:
    """Save a cue or a scene as TOML for `load`, numbers to 12 digits, or a cue as a line mesh.

    Parameters
    ----------
    obj : Cue or Scene
        The object to save.
    path : str or path
        A .toml file; for a cue also a line mesh (.vtu) for other programs: one cell per segment, dimensions and
        materials as cell data in SI units. Writing is atomic: a failure leaves no partial file.

    Raises
    ------
    InputError
        If the file cannot be written.
    TypeError
        If ``obj`` is neither a cue nor a scene.
    ValueError
        If the scene contains arrays.

    Examples
    --------
    See `load`.
    """
    _save(obj, Path(path), {})


def save_changed(obj: Cue | Scene, path: Path, source: Path) -> None:
    """Save what a file held, changed, with the order and the accuracy that stand beside it in that file."""
    _save(obj, path, other_tables(source))


def _save(obj: Cue | Scene, path: Path, tables: dict[str, Any]) -> None:
    """Save a cue or a scene; tables: others of its file."""
    if not isinstance(obj, Cue | Scene):
        raise TypeError(f"save writes a Cue or a Scene; got {quote(obj)}")
    if path.suffix.lower() == ".toml":
        from cuefem.files.toml_writer import toml_text

        content = toml_text(obj, **tables)
        write_atomically(path, lambda temporary: temporary.write_text(content, encoding="utf-8"))
    elif path.suffix.lower() == MESH and isinstance(obj, Cue):
        from cuefem.files.line_mesh import save_line_mesh

        write_atomically(path, lambda temporary: save_line_mesh(obj, temporary))
    else:
        allowed = ".toml or .vtu" if isinstance(obj, Cue) else ".toml, for a scene"
        raise InputError(path, "", f"must end in {allowed}; got {path.suffix!r}")


def today() -> str:
    """The date of a page, as "2026-11-27"; that of SOURCE_DATE_EPOCH, if it is set, so that pages can be made again."""
    fixed = os.environ.get("SOURCE_DATE_EPOCH", "")
    now = datetime.fromtimestamp(int(fixed), UTC) if fixed.isdecimal() else datetime.now().astimezone()
    return now.date().isoformat()


def save_page(text: str, path: str | os.PathLike[str]) -> None:
    """Write a page as .html atomically; InputError on failure."""
    path = Path(path)
    if path.suffix.lower() != ".html":
        raise InputError(path, "", f"must end in .html; got {path.suffix!r}")
    write_atomically(path, lambda temporary: temporary.write_text(text, encoding="utf-8"))


def write_atomically(path: Path, write: Callable[[Path], object]) -> None:
    """Write a temporary file beside ``path`` and rename it to ``path``, so that no partial file appears."""
    check_path(path)
    goal = Path(os.path.realpath(path))
    temporary = goal.with_name(f".{goal.stem}.{os.getpid()}{goal.suffix}")
    try:
        write(temporary)
        temporary.replace(goal)
    except OSError as error:
        raise InputError(path, "", f"cannot be written: {os_error_text(error)}") from None
    finally:
        temporary.unlink(missing_ok=True)


def check_new_folder(folder: Path) -> None:
    """InputError if the folder, or a file of its name, exists."""
    check_path(folder)
    if folder.exists() or folder.is_symlink():
        raise InputError(folder, "", "must be a new folder; a folder or file of this name exists")


def write_folder_atomically(folder: Path, write: Callable[[Path], object]) -> None:
    """Write a temporary folder beside ``folder`` and rename it, so that no partial folder appears."""
    check_new_folder(folder)
    temporary = folder.with_name(f".{folder.name}.{os.getpid()}")
    try:
        temporary.mkdir()
        write(temporary)
        temporary.rename(folder)
    except OSError as error:
        raise InputError(folder, "", f"cannot be written: {os_error_text(error)}") from None
    finally:
        shutil.rmtree(temporary, ignore_errors=True)


def check_writable(path: Path) -> None:
    """InputError if no file can be written at ``path``; called before the computation."""
    check_path(path)
    goal = Path(os.path.realpath(path))
    exists = goal.parent.is_dir()
    if goal.is_dir() or not exists or not os.access(goal.parent, os.W_OK):
        code = errno.EISDIR if goal.is_dir() else errno.EACCES if exists else errno.ENOENT
        raise InputError(path, "", f"cannot be written: {os.strerror(code)}")
