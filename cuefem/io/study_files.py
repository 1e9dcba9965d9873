"""Studies as TOML: a base scene by its path, [[vary]] tables, and what is asked: responses of a sweep, a scatter with
[tolerances], or the [objective] of an optimum. The handbook's chapter on studies has every key."""

from __future__ import annotations

import re
from collections.abc import Callable
from contextlib import ExitStack
from os import PathLike
from pathlib import Path
from typing import Any

from cuefem.design import METHODS, Levels, Normal, Response, Sample, Span, Study, Vary
from cuefem.design.optimum import Limit, Problem
from cuefem.design.scatter import Scatter
from cuefem.design.study_result import StudyResult, found
from cuefem.design.sweep import pool_of
from cuefem.io import load_stroke, replaced_segments
from cuefem.io.errors import InputError, faults_of, shown, state_of
from cuefem.io.profile import SHAPES
from cuefem.io.schema import build, joined, unknown_key
from cuefem.io.store import SqliteStore
from cuefem.io.toml import game_of, named_material, read_tables
from cuefem.parameters.parameter import paths, quantity_at, value_at
from cuefem.quantity.fields import Quantity
from cuefem.results.quantities import with_unit
from cuefem.scene import Resolution, Scene, Stroke
from cuefem.scene.default_scene import KIM, usual_scene

KEYS = ["scene", "game", "responses", "vary", "resolution"]
SWEEP_KEYS, SCATTER_KEYS = [*KEYS, "sample"], [*KEYS, "tolerances"]
OPTIMUM_KEYS = ["scene", "game", "objective", "limit", "vary", "resolution"]
LIMIT_KEYS = ["response", "low", "high"]
VARY_KEYS = [
    *("path", "name", "values", "low", "high", "count", "spacing", "middle", "sd", "factor", "shift", "taken_from"),
]
SAMPLE_KEYS = ["method", "count", "seed"]
TOLERANCE_KEYS = ["count", "seed", "correlations", "groups"]
OFFSET = 0.3  # b/R, of a cue alone with the game "kim"
FACTOR = Quantity("", "(0, inf)")
_SEGMENT = re.compile(r"((?:cue\.)?segments)\[(\d+)\]")


def load_study(path: str | PathLike[str]) -> Study | Scatter | Problem:
    """Load a study from a TOML file; InputError in one line if it is not valid.

    [objective] makes it a `Problem`, [tolerances] a `Scatter`, else it is a `Study`. A base that is a cue alone gets
    the default stroke of the ``game`` that the file names. Values carry their units as text.
    """
    path = Path(path)
    tables = _study_tables(path)
    both = [name for name in ("objective", "tolerances", "sample") if name in tables]
    if len(both) > 1:
        raise InputError(path, both[1], f"must be left out beside [{both[0]}]: a study is of one kind")
    kinds: dict[str, tuple[list[str], Callable[..., Study | Scatter | Problem]]] = {
        "objective": (OPTIMUM_KEYS, _problem),
        "tolerances": (SCATTER_KEYS, _scatter),
    }
    keys, load = kinds.get("".join(both), (SWEEP_KEYS, _study))
    _check_keys(tables, [*dict.fromkeys((*SWEEP_KEYS, *SCATTER_KEYS, *OPTIMUM_KEYS))], path, "")
    _check_keys(tables, keys, path, "")
    return load(tables, path)


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


def _study(tables: dict[str, Any], path: Path) -> Study:
    base = _base(tables, path)
    asked = enumerate(_list(tables, "responses", path))
    responses = tuple(_response(text, path, joined("responses", i)) for i, text in asked)
    vary = _varied(tables, base, path, sampled="sample" in tables or "tolerances" in tables)
    sample = _sample(tables["sample"], path) if "sample" in tables else None
    with faults_of(path, ""):
        return Study(base, vary, responses, sample, _resolution(tables, path))


def _scatter(tables: dict[str, Any], path: Path) -> Scatter:
    told = tables["tolerances"]
    _check_keys(told, TOLERANCE_KEYS, path, "tolerances")
    study, correlations = _study(tables, path), _correlations(told.get("correlations", []), path)
    numbers = {name: told[name] for name in ("count", "seed") if name in told}
    with faults_of(path, "tolerances"):
        return Scatter(study, correlations, _groups(told.get("groups", {}), path), **numbers)


def _problem(tables: dict[str, Any], path: Path) -> Problem:
    base, objective = _base(tables, path), tables["objective"]
    if not isinstance(objective, dict) or len(objective) != 1 or not {"minimize", "maximize"} & set(objective):
        raise InputError(path, "objective", f'must be a table such as minimize = "squirt(0.3)"; got {shown(objective)}')
    ((aim, asked),) = objective.items()
    limits = _list(tables, "limit", path) if "limit" in tables else []
    with faults_of(path, ""):
        return Problem(
            base,
            _varied(tables, base, path, sampled=True),
            _response(asked, path, joined("objective", aim)),
            tuple(_limit(table, path, joined("limit", i)) for i, table in enumerate(limits)),
            _resolution(tables, path),
            largest=aim == "maximize",
        )


def _limit(table: Any, path: Path, key: str) -> Limit:
    _check_keys(table, LIMIT_KEYS, path, key)
    response = _response(table.get("response"), path, joined(key, "response"))
    unit = Quantity(response.unit)
    sides = {side: _value(table[side], unit, path, joined(key, side)) for side in ("low", "high") if side in table}
    with faults_of(path, key):
        return Limit(response, **sides)  # type: ignore[arg-type]


def _correlations(listed: Any, path: Path) -> dict[tuple[str, str], float]:
    key, correlations = "tolerances.correlations", dict[tuple[str, str], float]()
    if not isinstance(listed, list):
        raise InputError(path, key, f"must be a list of [name, name, number]; got {shown(listed)}")
    for i, entry in enumerate(listed):
        fits = isinstance(entry, list) and len(entry) == 3 and all(isinstance(name, str) for name in entry[:2])
        if not fits or isinstance(entry[2], bool) or not isinstance(entry[2], int | float):
            raise InputError(path, joined(key, i), f"must be [name, name, number]; got {shown(entry)}")
        if tuple(entry[:2]) in correlations:
            raise InputError(path, joined(key, i), f"must be said once; got {entry[0]} and {entry[1]} twice")
        correlations[entry[0], entry[1]] = float(entry[2])
    return correlations


def _groups(groups: Any, path: Path) -> dict[str, tuple[str, ...]]:
    key = "tolerances.groups"
    if not isinstance(groups, dict):
        raise InputError(path, key, f"must be a table of lists of names; got {shown(groups)}")
    for group, names in groups.items():
        if not isinstance(names, list) or not names or not all(isinstance(name, str) for name in names):
            raise InputError(path, joined(key, group), f"must be a list of names; got {shown(names)}")
    return {group: tuple(names) for group, names in groups.items()}


def _resolution(tables: dict[str, Any], path: Path) -> Resolution | None:
    if "resolution" not in tables:
        return None
    return build(Resolution, tables["resolution"], file=str(path), key="resolution")


def _study_tables(path: Path) -> dict[str, Any]:
    """The tables of a study's file; a drawing or a scene that stands in the place of a study is refused as one."""
    state_of(path)
    shape = path.suffix.lower() in SHAPES
    tables = {} if shape else read_tables(path)
    if shape or (not {"scene", "vary"} & set(tables) and {"segments", "cue"} & set(tables)):
        what = "a drawing of a shaft" if shape or "segments" in tables else "a scene"
        wanted = f'must be a study, with scene = "{path.name}" and [[vary]] tables, as studies/sweeps/bore.toml is'
        raise InputError(path, "", f"{wanted}; got {what}")
    return tables


def _check_keys(table: Any, known: list[str], path: Path, key: str) -> None:
    if not isinstance(table, dict):
        raise InputError(path, key, f"must be a table with the keys {', '.join(known)}; got {shown(table)}")
    for name, value in table.items():
        if name not in known:
            raise unknown_key(name, value, known, file=str(path), key=key)


def _list(tables: dict[str, Any], key: str, path: Path) -> list[Any]:
    value = tables.get(key)
    if not isinstance(value, list) or not value:
        what = f"[[{key}]] tables" if key != "responses" else 'a list such as ["end_mass", "squirt(0.3)"]'
        raise InputError(path, key, f"must be {what}, one at least; got {shown(value) if key in tables else 'nothing'}")
    return value


def _base(tables: dict[str, Any], path: Path) -> Scene:
    name = tables.get("scene")
    if not isinstance(name, str):
        got = shown(name) if "scene" in tables else "nothing"
        raise InputError(path, "scene", f"must be the path of a scene or a cue, from this file's folder; got {got}")
    base, game = load_stroke(path.parent / name), game_of(tables, path)
    if not isinstance(base, Scene):
        with faults_of(path, "game"):
            return Scene(base, stroke=Stroke(offset=OFFSET)) if game == KIM else usual_scene(base, game)
    if "game" in tables:
        problem = f"must be left out: {name} is a scene, which has its own ball, tip and stroke"
        raise InputError(path, "game", f"{problem}; got {shown(game)}")
    return base


def assumed_base(path: Path, base: Scene) -> list[str]:
    """What the base of a study is struck with, where the file that it names holds a cue alone."""
    tables = read_tables(path)
    if isinstance(load_stroke(path.parent / tables["scene"]), Scene):
        return []
    game = game_of(tables, path)
    if game != KIM:
        return [f"{tables['scene']} is a cue alone, struck with a usual stroke of {game} (game)"]
    ball, time = with_unit(float(base.ball.mass), "kg", 6), with_unit(float(base.contact_time), "s", 6)
    told = f"{tables['scene']} is a cue alone, struck with a ball of {ball} and a flat tip in contact for {time}"
    return [f"{told}, b/R {base.stroke.offset:.4g} (game)"]


def _response(text: Any, path: Path, key: str) -> Response:
    with faults_of(path, key):
        return Response.of(text if isinstance(text, str) else repr(text))


def _varied(tables: dict[str, Any], base: Scene, path: Path, *, sampled: bool) -> tuple[Vary, ...]:
    """What varies, by the [[vary]] tables of a study."""
    replaced = replaced_segments(path.parent / tables["scene"], base)
    return tuple(_vary(table, base, replaced, path, i, sampled) for i, table in enumerate(_list(tables, "vary", path)))


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


def _vary(table: Any, base: Scene, replaced: int, path: Path, i: int, sampled: bool) -> Vary:
    key = joined("vary", i)
    _check_keys(table, VARY_KEYS, path, key)
    named = table.get("path")
    written = [named] if isinstance(named, str) else named
    if not isinstance(written, list) or not written or not all(isinstance(text, str) for text in written):
        problem = f'must be a field such as "cue.segments[0].tip_bore", or a list of them; got {shown(named)}'
        raise InputError(path, joined(key, "path"), problem)
    texts = [_in_scene(text, base, replaced, path, joined(key, "path")) for text in written]
    for name, kind, what in (("name", str, "a text"), *((n, bool, "true or false") for n in ("factor", "shift"))):
        if name in table and not isinstance(table[name], kind):
            raise InputError(path, joined(key, name), f"must be {what}; got {shown(table[name])}")
    how = {name: bool(table.get(name, False)) for name in ("factor", "shift")}
    wanted = _wanted(texts, base, how, path, joined(key, "path"))
    drawn = _range(table, wanted, path, key, sampled)
    giver, of_giver = table.get("taken_from", []), joined(key, "taken_from")
    givers = [giver] if isinstance(giver, str) else giver
    if not isinstance(givers, list) or not all(isinstance(text, str) for text in givers):
        raise InputError(path, of_giver, f"must be a field, or a list of them; got {shown(giver)}")
    name = table.get("name", "") or ", ".join(written)
    with faults_of(path, key):
        taken = tuple(_in_scene(text, base, replaced, path, of_giver) for text in givers)
        made = Vary(tuple(texts), drawn, name, taken_from=taken, **how)
    for name, check in (("path", made.unit), ("taken_from", made.givers)):
        with faults_of(path, joined(key, name)):
            check(base)
    return made


def _wanted(texts: list[str], base: Scene, how: dict[str, bool], path: Path, key: str) -> Quantity | None:
    """Unit and bounds of the values; None for names of materials."""
    with faults_of(path, key):
        field = next(place for text in texts for place in paths(base, text))
    value = quantity_at(base, field)
    if not any(how.values()):
        return value
    if value is None or value_at(base, field) is None:
        word = "factor must multiply" if how["factor"] else "shift must move"
        raise InputError(path, key, f"{word} a number; got {texts[0]}, which holds none")
    return FACTOR if how["factor"] else Quantity(value.unit)


def _range(
    table: dict[str, Any], wanted: Quantity | None, path: Path, key: str, sampled: bool
) -> Levels | Span | Normal:
    kinds = {"values": {"values"}, "low and high": {"low", "high", "count"}, "middle and sd": {"middle", "sd"}}
    asked = [kind for kind, keys in kinds.items() if keys & set(table)]
    if len(asked) != 1:
        got = ", and ".join(asked) or "none of them"
        raise InputError(path, key, f"must have values, or low and high, or middle and sd; got {got}")
    if asked == ["middle and sd"]:
        return _normal(table, wanted, path, key, sampled)
    if "values" in table:
        values = table["values"]
        if not isinstance(values, list) or not values:
            problem = f"must be a list of one value at least; got {shown(values)}, an empty range"
            raise InputError(path, joined(key, "values"), problem)
        read = (_value(value, wanted, path, joined(joined(key, "values"), i)) for i, value in enumerate(values))
        return Levels(tuple(read))
    return _span(table, wanted, path, key, sampled)


def _value(value: Any, wanted: Quantity | None, path: Path, key: str) -> float | str:
    with faults_of(path, key):
        if wanted is not None:
            return wanted.read(value)
        if not isinstance(value, str):
            raise ValueError(f"must be the name of a material (see `cuefem parts`); got {shown(value)}")
        named_material(value, path, key)
        return value


def _span(table: dict[str, Any], wanted: Quantity | None, path: Path, key: str, sampled: bool) -> Span:
    if wanted is None:
        raise InputError(path, key, "must have values, names of materials, which have no low and high")
    for name in ("low", "high") if sampled else ("low", "high", "count"):
        if name not in table:
            raise InputError(path, joined(key, name), "must be given, beside low and high; got nothing")
    low, high = (_value(table[name], wanted, path, joined(key, name)) for name in ("low", "high"))
    logarithmic = _spacing(table, path, key)
    assert isinstance(low, float)
    assert isinstance(high, float)
    if not low < high:
        got = f"low = {shown(table['low'])}, high = {shown(table['high'])}"
        raise InputError(path, key, f"low must be below high; got {got}, an empty range")
    with faults_of(path, key):
        return Span(low, high, table.get("count", 1), logarithmic)


def _normal(table: dict[str, Any], wanted: Quantity | None, path: Path, key: str, sampled: bool) -> Normal:
    if wanted is None or not sampled:
        problem = (
            "middle and sd are of numbers, drawn by a sample: give [sample] or [tolerances]"
            if wanted
            else "names have no middle"
        )
        raise InputError(path, key, problem)
    logarithmic = _spacing(table, path, key)
    each = {"middle": wanted, "sd": Quantity("" if logarithmic else wanted.unit, "(0, inf)")}
    for name in each:
        if name not in table:
            raise InputError(path, joined(key, name), "must be given: a normal range has middle and sd; got nothing")
    middle, sd = (_value(table[name], unit, path, joined(key, name)) for name, unit in each.items())
    assert isinstance(middle, float)
    assert isinstance(sd, float)
    with faults_of(path, key):
        return Normal(middle, sd, logarithmic)


def _spacing(table: dict[str, Any], path: Path, key: str) -> bool:
    """Whether it is logarithmic."""
    spacing = table.get("spacing", "linear")
    if spacing not in ("linear", "logarithmic"):
        raise InputError(path, joined(key, "spacing"), f"must be linear or logarithmic; got {shown(spacing)}")
    return bool(spacing == "logarithmic")


def _sample(table: Any, path: Path) -> Sample:
    _check_keys(table, SAMPLE_KEYS, path, "sample")
    for name in SAMPLE_KEYS:
        if name not in table:
            what = f"one of {', '.join(METHODS)}" if name == "method" else "a whole number"
            raise InputError(path, joined("sample", name), f"must be given, {what}; got nothing")
    with faults_of(path, "sample"):
        return Sample(table["method"], table["count"], table["seed"])
