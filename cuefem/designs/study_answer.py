"""`cuefem.study`: the answer to a study's file or definition, by its kind."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor
from contextlib import nullcontext
from os import PathLike
from typing import Any, TypedDict, Unpack, overload

import numpy as np

from cuefem.designs.many_designs import Columns, compute_designs
from cuefem.designs.optimum import Optimum, OptimumResult, Problem
from cuefem.designs.scatter import Scatter, ScatterResult
from cuefem.designs.search import optimum
from cuefem.designs.store import SqliteStore
from cuefem.designs.study import Study
from cuefem.designs.study_file import load_study, study_kind
from cuefem.designs.sweep import SweepResult
from cuefem.designs.trade_off import TradeOffResult, trade_off
from cuefem.quantity.fields import check_kind


class StudyOptions(TypedDict, total=False):
    """The options of `study`."""

    store: str | PathLike[str] | SqliteStore | None
    workers: int | Executor | None
    progress: Callable[[Any], object]
    rounds: int


@overload
def study(what: Study, **options: Unpack[StudyOptions]) -> SweepResult: ...
@overload
def study(what: Scatter, **options: Unpack[StudyOptions]) -> ScatterResult: ...
@overload
def study(what: Problem, **options: Unpack[StudyOptions]) -> OptimumResult: ...
@overload
def study(
    what: str | PathLike[str] | Study | Scatter | Problem, **options: Unpack[StudyOptions]
) -> SweepResult | ScatterResult | OptimumResult: ...
def study(
    what: str | PathLike[str] | Study | Scatter | Problem,
    *,
    store: str | PathLike[str] | SqliteStore | None = None,
    workers: int | Executor | None = None,
    progress: Callable[[Any], object] = lambda step: None,
    rounds: int = 60,
) -> SweepResult | ScatterResult | OptimumResult:
    """Compute a study: a sweep over designs, a scatter with tolerances, or an optimum within limits.

    Parameters
    ----------
    what : str, path, Study, Scatter or Problem
        A study's file (.toml; see `cuefem guide study`), or the object that `load_study` makes of it.
    store : str, path or SqliteStore, optional
        A file (.sqlite) for the designs, with which an interrupted or edited study resumes. Not for an optimum.
    workers : int or Executor, optional
        Number of worker processes, by default none; or any `concurrent.futures.Executor`, such as a cluster's, which
        the caller closes.
    progress : callable, optional
        Called with the number of designs that were computed since its last call; of an optimum with each round.
    rounds : int, optional
        Largest number of rounds of an optimum.

    Returns
    -------
    SweepResult, ScatterResult or OptimumResult
        ``designs`` and ``responses`` are arrays by name, in the SI ``units``; ``best`` has the best design by response,
        ``spread`` mean, standard deviation and quantiles; a scatter has ``sobol_indices``, an optimum ``optimum``.
        ``to_frame()`` converts it to a pandas frame. Show it with ``print``, in a notebook, or by
        ``.save("study.html")``.

    Raises
    ------
    ValueError
        If the file is not a study, a response does not exist, no design is within the limits, or a worker has no or
        another cuefem.
    RuntimeError
        If worker processes die repeatedly, or the executor is lost.

    Examples
    --------
    >>> import cuefem as cf
    >>> cue = cf.Cue((cf.Segment(0.7, 0.012, 0.021, cf.material("hard maple")),), 0.42)
    >>> tip = cf.Vary("tip diameter", cf.Span(0.011, 0.013, count=3), name="tip")
    >>> responses = (cf.Response("tip_stiffness"), cf.Response("shaft_mass"))
    >>> result = cf.study(cf.Study(cf.Scene(cue), (tip,), responses))
    >>> result
    <SweepResult: 3 designs that vary tip; tip_stiffness: 671.6 N/m, tip 13 mm; shaft_mass: 108.3 ± 2.5 g, mean ± sd>
    >>> result.designs["tip"], result.units["tip"]
    (array([0.011, 0.012, 0.013]), 'm')
    """
    is_optimum = study_kind(what) == "optimum" if isinstance(what, str | PathLike) else isinstance(what, Problem)
    if is_optimum and (store or workers):
        raise ValueError("an optimum takes no store or workers: it computes one design after the other")
    definition = load_study(what) if isinstance(what, str | PathLike) else what
    check_kind("study what", definition, (Study, Scatter, Problem))
    base, designs = definition.study.base, definition.all_designs
    if isinstance(definition, Problem):
        if definition.against is None:
            best = optimum(definition, rounds=rounds, progress=progress)
            return OptimumResult(base, definition, _columns(definition, (best,)), best)
        front = trade_off(definition, rounds=rounds, progress=progress)
        return TradeOffResult(base, definition, _columns(definition, front), front[0], trade_off=front)
    with SqliteStore(store, designs) if isinstance(store, str | PathLike) else nullcontext(store) as stored:
        columns = compute_designs(designs, stored, workers=workers, progress=progress)
    if isinstance(definition, Scatter):
        return ScatterResult.of(definition, columns)
    return SweepResult(base, definition, columns)


def _columns(problem: Problem, designs: tuple[Optimum, ...]) -> Columns:
    """The responses of designs of an optimization."""
    names = [response.name for response in problem.study.responses]
    return Columns(np.array([[design.responses[name] for name in names] for design in designs]), {})
