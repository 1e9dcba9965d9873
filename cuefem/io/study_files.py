"""Studies as TOML: a base scene by its path, [[vary]] tables, and what is asked: responses of a sweep, a scatter with
[tolerances], or the [objective] of an optimum. The handbook's chapter on studies has every key."""

from __future__ import annotations

import re
from contextlib import ExitStack
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import Any

from cuefem.design import Levels, Normal, Response, Sample, Span, Study, Vary
from cuefem.design.optimum import Limit, Problem
from cuefem.design.scatter import Scatter
from cuefem.design.study_result import StudyResult, found
from cuefem.design.sweep import pool_of
from cuefem.io import load_stroke, replaced_segments
from cuefem.io.assumed import assumed, in_words
from cuefem.io.errors import InputError, faults_of, shown, state_of
from cuefem.io.profile import SHAPES
from cuefem.io.schema import build, joined
from cuefem.io.store import SqliteStore
from cuefem.io.toml import game_of, named_material, read_tables
from cuefem.parameters.parameter import paths, quantity_at
from cuefem.quantity.fields import Quantity
from cuefem.scene import Resolution, Scene, Stroke
from cuefem.scene.default_scene import KIM, usual_scene

OFFSET = 0.3  # b/R, of a cue alone with the game "kim"
FACTOR = Quantity("", "(0, inf)")
_SEGMENT = re.compile(r"((?:cue\.)?segments)\[(\d+)\]")
Texts = str | tuple[str, ...]


@dataclass(frozen=True)
class VaryTable:
    """[[vary]] as it is in a file: values, or low and high, or middle and sd, in the unit of the field."""

    path: Texts
    name: str = ""
    values: tuple[Any, ...] | None = None
    low: Any = None
    high: Any = None
    count: int | None = None
    middle: Any = None
    sd: Any = None
    spacing: str = "linear"
    factor: bool = False
    shift: bool = False
    taken_from: Texts = ()

    def __post_init__(self) -> None:
        if self.spacing not in ("linear", "logarithmic"):
            raise ValueError(f"VaryTable.spacing must be linear or logarithmic; got {shown(self.spacing)}")


@dataclass(frozen=True)
class LimitTable:
    """[[limit]] as it is in a file."""

    response: str
    low: Any = None
    high: Any = None


@dataclass(frozen=True)
class ObjectiveTable:
    """[objective]: the response to make least or largest."""

    minimize: str | None = None
    maximize: str | None = None

    def __post_init__(self) -> None:
        if (self.minimize is None) == (self.maximize is None):
            raise ValueError('must be a table such as minimize = "squirt(0.3)"; got both keys or none')


@dataclass(frozen=True)
class TolerancesTable:
    """[tolerances] as it is in a file; what is left out is that of `Scatter`."""

    count: int = Scatter.count
    seed: int = Scatter.seed
    correlations: tuple[Any, ...] = ()
    groups: dict[str, tuple[str, ...]] = field(default_factory=dict)


@dataclass(frozen=True)
class StudyTable:
    """A study's file: all its keys."""

    scene: str
    vary: tuple[VaryTable, ...]
    responses: tuple[str, ...] = ()
    game: str | None = None
    resolution: Resolution | None = None
    sample: Sample | None = None
    tolerances: TolerancesTable | None = None
    objective: ObjectiveTable | None = None
    limit: tuple[LimitTable, ...] = ()

    def __post_init__(self) -> None:
        kinds = [name for name in ("objective", "tolerances", "sample") if getattr(self, name) is not None]
        if len(kinds) > 1:
            raise ValueError(f"StudyTable.{kinds[1]} must be left out beside [{kinds[0]}]: a study is of one kind")
        if self.objective and self.responses:
            raise ValueError("StudyTable.responses must be left out beside [objective], which asks")
        if self.limit and not self.objective:
            raise ValueError("StudyTable.limit must stand beside an [objective]")


def load_study(path: str | PathLike[str]) -> Study | Scatter | Problem:
    """Load a study from a TOML file; InputError in one line if it is not valid.

    [objective] makes it a `Problem`, [tolerances] a `Scatter`, else it is a `Study`. A base that is a cue alone gets
    the default stroke of the ``game`` that the file names. Values carry their units as text.
    """
    path = Path(path)
    told = build(StudyTable, _study_tables(path), file=str(path), key="")
    base = _base(told, path)
    vary = _varied(told, base, path)
    if told.objective is not None:
        return _problem(told, told.objective, base, vary, path)
    responses = tuple(_response(text, path, joined("responses", i)) for i, text in enumerate(told.responses))
    with faults_of(path, ""):
        study = Study(base, vary, responses, told.sample, told.resolution)
    if told.tolerances is None:
        return study
    tolerances = told.tolerances
    correlations = _correlations(tolerances.correlations, path)
    with faults_of(path, "tolerances"):
        return Scatter(study, correlations, tolerances.groups, tolerances.count, tolerances.seed)


def study(
    what: str | PathLike[str] | Study | Scatter | Problem,
    *,
    store: str | PathLike[str] | None = None,
    workers: int | None = None,
    dask: str | None = None,
) -> StudyResult:
    """Compute a study: a sweep over designs, a scatter with tolerances, or an optimum within limits.

    Parameters
    ----------
    what : str, path, Study, Scatter or Problem
        A study's file (.toml), as `cuefem study` takes it (`cuefem guide study`), or the object that it means.
    store : str or path, optional
        A file (.sqlite) for the designs, from which an interrupted or edited study goes on. An optimum has none.
    workers : int, optional
        Number of worker processes; by default none is started.
    dask : str, optional
        The address of a Dask scheduler to work on instead, such as "tcp://host:8786".

    Returns
    -------
    StudyResult
        ``designs`` and ``responses`` are arrays by name, in the SI ``units``; ``best`` has the best design by response,
        ``spread`` mean, standard deviation and quantiles; ``optimum`` and ``drivers`` what such studies have besides.
        ``cf.frames.of_study`` makes a pandas frame of it.

    Raises
    ------
    ValueError
        If the file is no study, a response does not exist, or no design is within the limits.
    RuntimeError
        If worker processes die time after time, or the scheduler is gone.

    Examples
    --------
    >>> import cuefem as cf
    >>> from cuefem.design import Response, Span, Study, Vary
    >>> cue = cf.Cue((cf.Segment(0.7, 0.012, 0.021, cf.Material(12.6e9, 0.84e9, 700.0)),), 0.42)
    >>> tip = Vary(("cue.segments[0].tip_diameter",), Span(0.011, 0.013, count=3), name="tip")
    >>> found = cf.study(Study(cf.Scene(cue), (tip,), (Response("tip_stiffness"), Response("shaft_mass"))))
    >>> found
    StudyResult(sweep of 3 designs)
      tip_stiffness: 649.4 N/m, tip 13 mm
      shaft_mass: 107.5 ± 5.8 g, mean ± sd
    >>> found.designs["tip"], found.units["tip"]
    (array([0.011, 0.012, 0.013]), 'm')
    """
    asked = load_study(what) if isinstance(what, str | PathLike) else what
    if isinstance(asked, Problem):
        if store or workers or dask:
            raise ValueError("an optimum takes no store, workers or dask: its designs follow from one another")
        return found(asked)
    designs = asked.designs if isinstance(asked, Scatter) else asked
    with ExitStack() as opened:
        pool = opened.enter_context(pool_of(workers, dask))
        kept = opened.enter_context(SqliteStore(store, designs)) if store else None
        return found(asked, store=kept, pool=pool)


def _problem(told: StudyTable, objective: ObjectiveTable, base: Scene, vary: tuple[Vary, ...], path: Path) -> Problem:
    aim = "maximize" if objective.minimize is None else "minimize"
    asked = _response(getattr(objective, aim), path, joined("objective", aim))
    limits = tuple(_limit(table, path, joined("limit", i)) for i, table in enumerate(told.limit))
    with faults_of(path, ""):
        return Problem(base, vary, asked, limits, told.resolution, largest=aim == "maximize")


def _limit(told: LimitTable, path: Path, key: str) -> Limit:
    response = _response(told.response, path, joined(key, "response"))
    unit, sides = Quantity(response.unit), {"low": told.low, "high": told.high}
    bounds = {side: _number(value, unit, path, joined(key, side)) for side, value in sides.items() if value is not None}
    with faults_of(path, key):
        return Limit(response, **bounds)


def _correlations(listed: tuple[Any, ...], path: Path) -> dict[tuple[str, str], float]:
    correlations = dict[tuple[str, str], float]()
    for i, entry in enumerate(listed):
        key = joined("tolerances.correlations", i)
        match entry:
            case [str(one), str(other), int() | float() as r] if not isinstance(r, bool):
                if (one, other) in correlations:
                    raise InputError(path, key, f"must be said once; got {one} and {other} twice")
                correlations[one, other] = float(r)
            case _:
                raise InputError(path, key, f"must be [name, name, number]; got {shown(entry)}")
    return correlations


def _study_tables(path: Path) -> dict[str, Any]:
    """The tables of a study's file; a drawing or a scene given instead of a study is rejected as one."""
    state_of(path)
    shape = path.suffix.lower() in SHAPES
    tables = {} if shape else read_tables(path)
    if shape or (not {"scene", "vary"} & set(tables) and {"segments", "cue"} & set(tables)):
        what = "a drawing of a shaft" if shape or "segments" in tables else "a scene"
        wanted = f'must be a study, with scene = "{path.name}" and [[vary]] tables, as studies/sweeps/bore.toml is'
        raise InputError(path, "", f"{wanted}; got {what}")
    return tables


def _base(told: StudyTable, path: Path) -> Scene:
    base, game = load_stroke(path.parent / told.scene), _game(told, path)
    if not isinstance(base, Scene):
        with faults_of(path, "game"):
            return Scene(base, stroke=Stroke(offset=OFFSET)) if game == KIM else usual_scene(base, game)
    if told.game is not None:
        problem = f"must be left out: {told.scene} is a scene, which has its own ball, tip and stroke"
        raise InputError(path, "game", f"{problem}; got {shown(game)}")
    return base


def _game(told: StudyTable, path: Path) -> str:
    return game_of({} if told.game is None else {"game": told.game}, path)


def assumed_base(path: Path, base: Scene) -> list[str]:
    """What the file that a study names leaves to defaults, in words."""
    tables = read_tables(path)
    return in_words(assumed(path.parent / tables["scene"], base, {k: tables[k] for k in ("game",) if k in tables}))


def _response(text: str, path: Path, key: str) -> Response:
    with faults_of(path, key):
        return Response.of(text)


def _varied(told: StudyTable, base: Scene, path: Path) -> tuple[Vary, ...]:
    """What varies, by the [[vary]] tables of a study."""
    replaced = replaced_segments(path.parent / told.scene, base)
    grid = told.objective is None and told.tolerances is None and told.sample is None
    return tuple(_vary(table, base, replaced, path, i, grid) for i, table in enumerate(told.vary))


def _in_scene(text: str, base: Scene, replaced: int, path: Path, key: str) -> str:
    """A path whose segments count as in the cue's file, as a path of the scene, in which a `LeatherTip` replaces the
    first ``replaced`` segments."""
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


def _vary(told: VaryTable, base: Scene, replaced: int, path: Path, i: int, grid: bool) -> Vary:
    key = joined("vary", i)
    fields, givers = (
        tuple(_in_scene(text, base, replaced, path, joined(key, name)) for text in _listed(texts))
        for name, texts in (("path", told.path), ("taken_from", told.taken_from))
    )
    wanted = _wanted(fields, base, told, path, joined(key, "path"))
    drawn = _range(told, wanted, path, key, grid)
    name = told.name or ", ".join(_listed(told.path))
    with faults_of(path, key):
        made = Vary(fields, drawn, name, told.factor, told.shift, givers)
    for name, check in (("path", made.unit), ("taken_from", made.givers)):
        with faults_of(path, joined(key, name)):
            check(base)
    return made


def _listed(texts: Texts) -> tuple[str, ...]:
    return (texts,) if isinstance(texts, str) else texts


def _wanted(texts: tuple[str, ...], base: Scene, told: VaryTable, path: Path, key: str) -> Quantity | None:
    """Unit and bounds of the values; None for names of materials."""
    with faults_of(path, key):
        field = next((place for text in texts for place in paths(base, text)), None)
        if field is None:
            raise ValueError("must name a field; got none")
    value = quantity_at(base, field)
    if value is None or not (told.factor or told.shift):
        return value
    return FACTOR if told.factor else Quantity(value.unit)


def _range(told: VaryTable, wanted: Quantity | None, path: Path, key: str, grid: bool) -> Levels | Span | Normal:
    """The range of the one pair of keys that a table has."""
    pairs = (("values", "values"), ("low", "high"), ("middle", "sd"))
    asked = [pair for pair in pairs if any(getattr(told, name) is not None for name in pair)]
    if len(asked) != 1:
        got = ", and ".join(" and ".join(dict.fromkeys(pair)) for pair in asked) or "none of them"
        raise InputError(path, key, f"must have values, or low and high, or middle and sd; got {got}")
    if told.values is not None:
        levels = tuple(_level(v, wanted, path, joined(joined(key, "values"), i)) for i, v in enumerate(told.values))
        with faults_of(path, joined(key, "values")):
            return Levels(levels)
    normal, logarithmic = told.low is None and told.high is None, told.spacing == "logarithmic"
    if wanted is None:
        raise InputError(path, key, "must have values, names of materials, which have no low and high, and no middle")
    if normal and grid:
        raise InputError(path, key, "middle and sd are of numbers, drawn by a sample: give [sample] or [tolerances]")
    for name in (*asked[0], *(["count"] if grid else [])):
        if getattr(told, name) is None:
            raise InputError(path, joined(key, name), f"must be given, beside {' and '.join(asked[0])}; got nothing")
    deviation = Quantity("" if logarithmic else wanted.unit, "(0, inf)")
    marks = zip(asked[0], (wanted, deviation if normal else wanted), strict=True)
    first, last = (_number(getattr(told, name), mark, path, joined(key, name)) for name, mark in marks)
    with faults_of(path, key):
        if normal:
            return Normal(first, last, logarithmic)
        return Span(first, last, 1 if told.count is None else told.count, logarithmic)


def _number(value: Any, wanted: Quantity, path: Path, key: str) -> float:
    with faults_of(path, key):
        return wanted.read(value)


def _level(value: Any, wanted: Quantity | None, path: Path, key: str) -> float | str:
    if wanted is not None:
        return _number(value, wanted, path, key)
    if not isinstance(value, str):
        raise InputError(path, key, f"must be the name of a material (see `cuefem parts`); got {shown(value)}")
    named_material(value, path, key)
    return value
