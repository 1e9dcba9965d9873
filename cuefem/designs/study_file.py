"""Studies as TOML: the path of a base scene, [[vary]] tables, and responses, [tolerances] or an [objective].

The handbook's chapter on studies lists every key.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import Any

from cuefem.designs import Levels, Normal, Response, Sample, Span, Study, Vary
from cuefem.designs.optimum import Limit, Problem
from cuefem.designs.scatter import Scatter
from cuefem.files import load, replaced_segments
from cuefem.files.defaults_report import Assumption, assumptions, offered_assumptions
from cuefem.files.errors import InputError, as_input_error, errors_name_key, file_state, quote
from cuefem.files.lathe_profile import SHAPE_EXTENSIONS
from cuefem.files.schema import build, key_path, named_material
from cuefem.files.shaft_additions import SHAFT_ADDITIONS
from cuefem.files.toml_reader import game_of, read_tables
from cuefem.parameters.scene_changes import with_parameters
from cuefem.parameters.scene_paths import paths, quantity_at
from cuefem.parameters.table import PARAMETERS
from cuefem.quantity.fields import Quantity
from cuefem.scene import Resolution, Scene, Stroke
from cuefem.scene.default_scene import KIM, StrokeName, usual_scene

OFFSET = 0.3  # b/R, for a cue without a scene and the game "kim"
FACTOR = Quantity("", "(0, inf)")
_SEGMENT = re.compile(r"((?:cue\.)?segments)\[(\d+)\]")
Texts = str | tuple[str, ...]


@dataclass(frozen=True)
class VaryTable:
    """[[vary]] of a file: values, or low and high, or median and sd, in the unit of the field."""

    path: Texts
    name: str = ""
    values: tuple[Any, ...] | None = None
    low: Any = None
    high: Any = None
    count: int | None = None
    median: Any = None
    sd: Any = None
    spacing: str = "linear"
    factor: bool = False
    shift: bool = False
    compensating_path: Texts = ()

    def __post_init__(self) -> None:
        if self.spacing not in ("linear", "logarithmic"):
            raise ValueError(f"VaryTable.spacing must be linear or logarithmic; got {quote(self.spacing)}")


@dataclass(frozen=True)
class LimitTable:
    """[[limit]] of a file."""

    response: str
    low: Any = None
    high: Any = None


@dataclass(frozen=True)
class ObjectiveTable:
    """[objective] of a file: a response to minimize, maximize or bring to a target; another to trade it against."""

    minimize: str | None = None
    maximize: str | None = None
    response: str | None = None
    target: Any = None
    against: str | None = None
    count: int = Problem.count

    def __post_init__(self) -> None:
        if len(self.aims) != 1:
            raise ValueError(f"must have one of minimize, maximize, response; got {' and '.join(self.aims) or 'none'}")
        if (self.response is None) != (self.target is None):
            raise ValueError('must have response and target together, such as response = "squirt", target = "1.3 deg"')

    @property
    def aims(self) -> list[str]:
        """The keys that name the response."""
        return [name for name in ("minimize", "maximize", "response") if getattr(self, name) is not None]


@dataclass(frozen=True)
class TolerancesTable:
    """[tolerances] of a file; the defaults are those of `Scatter`."""

    count: int = Scatter.count
    seed: int = Scatter.seed
    correlations: tuple[Any, ...] = ()
    groups: dict[str, tuple[str, ...]] = field(default_factory=dict)


@dataclass(frozen=True)
class StudyTable:
    """All keys of a study's file."""

    scene: str
    vary: tuple[VaryTable, ...]
    responses: tuple[str, ...] = ()
    game: str | None = None
    material: str | None = None
    length_unit: str | None = None
    front: str | None = None
    ferrule: str | None = None
    bore: str | None = None
    body_mass: str | None = None
    shaft_mass: str | None = None
    resolution: Resolution | None = None
    sample: Sample | None = None
    tolerances: TolerancesTable | None = None
    objective: ObjectiveTable | None = None
    limit: tuple[LimitTable, ...] = ()

    def __post_init__(self) -> None:
        kinds = [name for name in ("objective", "tolerances", "sample") if getattr(self, name) is not None]
        if len(kinds) > 1:
            raise ValueError(f"StudyTable.{kinds[1]} must be omitted with [{kinds[0]}]: a study has one kind")
        if self.objective and self.responses:
            raise ValueError("StudyTable.responses must be omitted with [objective], which names the response")
        if self.limit and not self.objective:
            raise ValueError("StudyTable.limit needs an [objective]")

    @property
    def drawing_options(self) -> dict[str, str]:
        """The options of `cuefem.load` that are set: they supplement or replace values of the drawing."""
        return {name: value for name in SHAFT_ADDITIONS if (value := getattr(self, name)) is not None}


def load_study(path: str | PathLike[str]) -> Study | Scatter | Problem:
    """Load a study from a TOML file; InputError for an invalid one.

    [objective] makes it a `Problem`, [tolerances] a `Scatter`, else it is a `Study`. A base without a stroke (a cue)
    gets the default stroke of the file's ``game``. Values are texts with units.
    """
    path = Path(path)
    tables = build(StudyTable, _study_tables(path), file=str(path), key="")
    base = _base(tables, path)
    vary = _varied(tables, base, path)
    if tables.objective is not None:
        return _problem(tables, tables.objective, base, vary, path)
    responses = tuple(_response(text, path, key_path("responses", i)) for i, text in enumerate(tables.responses))
    with as_input_error(path, ""):
        study = Study(base, vary, responses, tables.sample, tables.resolution)
    if tables.tolerances is None:
        return study
    tolerances = tables.tolerances
    correlations = _correlations(tolerances.correlations, path)
    with as_input_error(path, "tolerances"):
        return Scatter(study, correlations, tolerances.groups, tolerances.count, tolerances.seed)


def study_kind(path: str | PathLike[str]) -> str:
    """ "optimum", "scatter" or "sweep": the kind of a study's file, without its scene, which takes seconds to build."""
    tables = _study_tables(Path(path))
    return "optimum" if "objective" in tables else "scatter" if "tolerances" in tables else "sweep"


def _problem(tables: StudyTable, objective: ObjectiveTable, base: Scene, vary: tuple[Vary, ...], path: Path) -> Problem:
    (aim,) = objective.aims
    response = _response(getattr(objective, aim), path, key_path("objective", aim))
    key, target = key_path("objective", "target"), objective.target
    target = None if target is None else _number(target, Quantity(response.unit), path, key)
    limits = tuple(_limit(table, path, key_path("limit", i)) for i, table in enumerate(tables.limit))
    other = objective.against
    against = None if other is None else _response(other, path, key_path("objective", "against"))
    with as_input_error(path, ""):
        return Problem(
            base,
            vary,
            response,
            limits,
            tables.resolution,
            maximize=aim == "maximize",
            against=against,
            count=objective.count,
            target=target,
        )


def _limit(tables: LimitTable, path: Path, key: str) -> Limit:
    response = _response(tables.response, path, key_path(key, "response"))
    unit, sides = Quantity(response.unit), {"low": tables.low, "high": tables.high}
    bounds = {
        side: _number(value, unit, path, key_path(key, side)) for side, value in sides.items() if value is not None
    }
    with as_input_error(path, key):
        return Limit(response, **bounds)


def _correlations(listed: tuple[Any, ...], path: Path) -> dict[tuple[str, str], float]:
    correlations = dict[tuple[str, str], float]()
    for i, entry in enumerate(listed):
        key = key_path("tolerances.correlations", i)
        match entry:
            case [str(one), str(other), int() | float() as r] if not isinstance(r, bool):
                if (one, other) in correlations:
                    raise InputError(path, key, f"must be listed once; got {one} and {other} twice")
                correlations[one, other] = float(r)
            case _:
                raise InputError(path, key, f"must be [name, name, number]; got {quote(entry)}")
    return correlations


def _study_tables(path: Path) -> dict[str, Any]:
    """The tables of a study's file; InputError for a drawing or a scene."""
    file_state(path)
    shape = path.suffix.lower() in SHAPE_EXTENSIONS
    tables = {} if shape else read_tables(path)
    if shape or (not {"scene", "vary"} & set(tables) and {"segments", "cue"} & set(tables)):
        what = "a drawing of a shaft" if shape or "segments" in tables else "a scene"
        expected = f'must be a study, with scene = "{path.name}" and [[vary]] tables, such as studies/sweeps/bore.toml'
        raise InputError(path, "", f"{expected}; got {what}")
    return tables


def _base(tables: StudyTable, path: Path) -> Scene:
    game = _game(tables, path)
    with errors_name_key(path, "scene"), _errors_name_option(tables, path):
        base = load(path.parent / tables.scene, **tables.drawing_options)
    if not isinstance(base, Scene):
        with as_input_error(path, "scene" if tables.game is None else "game"):
            scene = Scene(base, stroke=Stroke(offset=OFFSET)) if game == KIM else usual_scene(base, game)
        return _with_masses(scene, tables, path)
    if tables.game is not None:
        problem = f"must be omitted: {tables.scene} is a scene, which has its own ball, tip and stroke"
        raise InputError(path, "game", f"{problem}; got {quote(game)}")
    return _with_masses(base, tables, path)


@contextmanager
def _errors_name_option(tables: StudyTable, path: Path) -> Iterator[None]:
    """Turn an error about an option of the drawing into one about the key of the study that sets it."""
    try:
        yield
    except InputError as error:
        name, _, problem = f"{error.key}: {error.problem}".removeprefix(": ").partition(": ")
        raise InputError(path, name, problem) if name in tables.drawing_options else error from None


def _with_masses(scene: Scene, tables: StudyTable, path: Path) -> Scene:
    """The scene with the masses that the study sets: of the butt, and of the shaft with its tip."""
    for name in ("body_mass", "shaft_mass"):
        text = getattr(tables, name)
        if text is not None:
            with as_input_error(path, name):
                scene = with_parameters(scene, {name: PARAMETERS[name].quantity(scene).read(text)})
    return scene


def _game(tables: StudyTable, path: Path) -> StrokeName:
    return game_of({} if tables.game is None else {"game": tables.game}, path)


def base_assumptions(path: Path, base: Scene) -> list[Assumption]:
    """The assumptions for the base file of a study."""
    tables = read_tables(path)
    options = {key: tables[key] for key in ("game", "body_mass", "shaft_mass", *SHAFT_ADDITIONS) if key in tables}
    return offered_assumptions(assumptions(path.parent / tables["scene"], base, options))


def _response(text: str, path: Path, key: str) -> Response:
    with as_input_error(path, key):
        return Response.of(text)


def _varied(tables: StudyTable, base: Scene, path: Path) -> tuple[Vary, ...]:
    """The [[vary]] tables of a study as objects."""
    replaced = replaced_segments(path.parent / tables.scene, base, **tables.drawing_options)
    grid = tables.objective is None and tables.tolerances is None and tables.sample is None
    return tuple(_vary(table, base, replaced, path, i, grid) for i, table in enumerate(tables.vary))


def _in_scene(text: str, base: Scene, replaced: int, path: Path, key: str) -> str:
    """Convert a path with the segment numbers of the cue's file to those of the scene.

    In the scene a `LeatherTip` replaces the first ``replaced`` segments.
    """
    match = _SEGMENT.match(text)
    if match is None or not base.cue.segments:
        return text
    i, last = int(match[2]), replaced + len(base.cue.segments) - 1
    if i > last:
        raise InputError(path, key, f"must name a segment of the cue's file, 0 to {last}, 0 at the tip; got {text!r}")
    if i < replaced:
        names = '"tip height" or "leather"'
        raise InputError(
            path,
            key,
            f"must not name the drawn leather, which LeatherTip replaces: {names} varies the tip; got {text!r}",
        )
    return f"{match[1]}[{i - replaced}]{text[match.end() :]}"


def _vary(tables: VaryTable, base: Scene, replaced: int, path: Path, i: int, grid: bool) -> Vary:
    key = key_path("vary", i)
    fields, compensating_fields = (
        tuple(_in_scene(text, base, replaced, path, key_path(key, name)) for text in _listed(texts))
        for name, texts in (("path", tables.path), ("compensating_path", tables.compensating_path))
    )
    quantity = _quantity(fields, base, tables, path, key_path(key, "path"))
    drawn = _range(tables, quantity, path, key, grid)
    name = tables.name or ", ".join(_listed(tables.path))
    with as_input_error(path, key):
        made = Vary(fields, drawn, name, tables.factor, tables.shift, compensating_fields)
    for name, check in (("path", made.unit), ("compensating_path", made.compensating_fields)):
        with as_input_error(path, key_path(key, name)):
            check(base)
    return made


def _listed(texts: Texts) -> tuple[str, ...]:
    return (texts,) if isinstance(texts, str) else texts


def _quantity(texts: tuple[str, ...], base: Scene, tables: VaryTable, path: Path, key: str) -> Quantity | None:
    """Unit and bounds of the values; None for materials."""
    with as_input_error(path, key):
        field = next((place for text in texts for place in paths(base, text)), None)
        if field is None:
            raise ValueError("must name a field; got none")
    value = quantity_at(base, field)
    if value is None or not (tables.factor or tables.shift):
        return value
    return FACTOR if tables.factor else Quantity(value.unit)


def _range(tables: VaryTable, quantity: Quantity | None, path: Path, key: str, grid: bool) -> Levels | Span | Normal:
    """The range by the keys of a table: values, low and high, or median and sd."""
    pairs = (("values", "values"), ("low", "high"), ("median", "sd"))
    present = [pair for pair in pairs if any(getattr(tables, name) is not None for name in pair)]
    if len(present) != 1:
        got = ", and ".join(" and ".join(dict.fromkeys(pair)) for pair in present) or "none of them"
        raise InputError(path, key, f"must have values, or low and high, or median and sd; got {got}")
    if tables.values is not None:
        levels = tuple(
            _level(v, quantity, path, key_path(key_path(key, "values"), i)) for i, v in enumerate(tables.values)
        )
        with as_input_error(path, key_path(key, "values")):
            return Levels(levels)
    normal, logarithmic = tables.low is None and tables.high is None, tables.spacing == "logarithmic"
    if quantity is None:
        raise InputError(
            path, key, "must have values, a list of material names: materials have no low and high, or median and sd"
        )
    if normal and grid:
        raise InputError(path, key, "median and sd need random designs: give [sample] or [tolerances]")
    for name in (*present[0], *(["count"] if grid else [])):
        if getattr(tables, name) is None:
            raise InputError(
                path, key_path(key, name), f"must be given, beside {' and '.join(present[0])}; got nothing"
            )
    deviation = Quantity("" if logarithmic else quantity.unit, "(0, inf)")
    marks = zip(present[0], (quantity, deviation if normal else quantity), strict=True)
    first, last = (_number(getattr(tables, name), mark, path, key_path(key, name)) for name, mark in marks)
    with as_input_error(path, key):
        if normal:
            return Normal(first, last, logarithmic)
        return Span(first, last, 1 if tables.count is None else tables.count, logarithmic)


def _number(value: Any, quantity: Quantity, path: Path, key: str) -> float:
    with as_input_error(path, key):
        return quantity.read(value)


def _level(value: Any, quantity: Quantity | None, path: Path, key: str) -> float | str:
    if quantity is not None:
        return _number(value, quantity, path, key)
    if not isinstance(value, str):
        raise InputError(path, key, f"must be the name of a material (see `cuefem parts`); got {quote(value)}")
    named_material(value, path, key)
    return value
