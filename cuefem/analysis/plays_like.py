"""The smallest change of a shaft that gives it the squirt of another cue, within the limits of its maker."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import NamedTuple

from cuefem.analysis.comparison import compare_cues, with_same_stroke
from cuefem.analysis.design_changes import DesignChanges, Trial, are_compatible, joined
from cuefem.analysis.shop_changes import DesignChange, Dimension, Limits, dimensions_of, ferrule_materials
from cuefem.analysis.verdict import squirt_difference
from cuefem.measurements.calibration import Calibration
from cuefem.parameters.scene_changes import with_parameters
from cuefem.parameters.table import PARAMETERS
from cuefem.quantity.display_units import with_unit
from cuefem.results.progress import Progress
from cuefem.results.records import Record, Table
from cuefem.results.uncertainty import RATIO_FLOOR, squirt_of
from cuefem.scene import Scene, check_scene

SAME = RATIO_FLOOR  # relative difference of squirt that calipers leave: such cues play alike
SIZES = 5  # of a dimension that are struck on the way to its farthest size
MAX_TOGETHER = 3  # changes
BASES = 2  # changes, the nearest ones, that are combined with another
MAX_ROWS = 7


@dataclass(frozen=True)
class PlaysLike(DesignChanges):
    """Changes of a shaft that give it the squirt of another cue, the one that alters the shaft least first.

    Parameters
    ----------
    like : str
        Name of the other cue.
    target : float
        Its squirt, rad.
    is_reached : bool
        Whether the changes reach it, but for the tolerance of calipers (`SAME`); else the one change is the nearest.
    difference : dict, optional
        Of the other cue from the first of the changes, or from the shaft where no change is needed: relative
        "difference" of squirt, its "error" (1 sigma) and whether it is "distinct".
    """

    like: str = field(kw_only=True)
    target: float = field(kw_only=True)
    is_reached: bool = field(kw_only=True)
    difference: Record | None = field(kw_only=True)

    def tables(self) -> list[Table | str]:
        """What reaches the squirt of the other cue, and a table of the changes."""
        lines = [*self.calibration_lines(), *self.like_lines()]
        return [*lines, "", self.table()] if self.changes else [*lines]

    def like_lines(self) -> list[str]:
        """Whether and by what the squirt of the other cue is reached, and how sure it is that the two are alike."""
        aim = f"the squirt of {self.like}, {with_unit(self.target, 'rad', decimals=2)}"
        if not self.changes:
            found = f"this shaft has {aim}, already"
        elif self.is_reached:
            found = (
                f"like {self.like} ({with_unit(self.target, 'rad', decimals=2)}): {self.together_text(self.changes[0])}"
            )
        else:
            found = f"no change within the limits reaches {aim}; the nearest: {self.together_text(self.changes[0])}"
        if self.difference is None:
            return [found]
        return [found, f"{self.like}: {squirt_difference(**self.difference)} that shaft (1σ)"]


def plays_like(
    scene: Scene,
    other: Scene,
    *,
    name: str = "the other cue",
    limits: Limits = Limits(),  # noqa: B008  # frozen
    calibration: Calibration | None = None,
    progress: Progress = list,
) -> PlaysLike:
    """The smallest change of a shaft that gives it the squirt of another cue, within the limits of its maker.

    Parameters
    ----------
    scene : Scene
        A stroke with the shaft that is changed.
    other : Scene
        A stroke with the other cue, which is struck with the ball and the stroke of the shaft.
    name : str, default "the other cue"
        In texts.
    limits : Limits
        What the maker does not accept. The largest loss of stiffness holds for one change, too.
    calibration : Calibration, optional
        Squirt that was measured on another shaft with the same tip: its factor scales every squirt.
    progress : callable
        Wraps the list of dimensions, to show progress.

    Returns
    -------
    PlaysLike

    Raises
    ------
    ValueError
        If a cue is lumped, a stroke is a miscue, or the limits leave no dimension to change.

    Notes
    -----
    A dimension (bore with a drill of the shop, ferrule, front, wall of a tube) goes from its size to the nearest one
    that reaches the squirt. If none does, each of the two nearest changes is combined with another dimension,
    three together at most. The change that alters stiffness, mass and first natural frequency least is the first.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> scene = cf.usual_scene(cf.Cue((cf.Segment(0.7, 0.01275, 0.021, wood),), body_mass=0.43))
    >>> found = cf.plays_like(scene, cf.with_parameters(scene, {"bore depth": 0.08, "bore width": 0.0065}))
    >>> found.is_reached, abs(found.changes[0].squirt / found.target - 1) < 0.01
    (True, True)
    """
    check_scene("plays_like scene", scene)
    check_scene("plays_like other", other)
    struck = with_same_stroke({"shaft": scene, "other": other})
    trial = Trial.of(struck["shaft"], limits, calibration)
    search = _ShaftSearch(trial, abs(squirt_of(struck["other"])))
    dimensions = [each for each in _choices(trial.struck) if each.change(each.first).part not in limits.keep]
    if not dimensions:
        raise ValueError(f"keep leaves no dimension of this shaft to change; got {', '.join(limits.keep)}")
    found = [] if search.is_same else search.run(dimensions, progress)
    found.sort(key=partial(_alteration, trial.base))
    rows = [row for each in found[:MAX_ROWS] if (row := trial.changed(each.change))]
    best = with_parameters(trial.struck, rows[0].values) if rows else trial.struck
    compared = compare_cues({"shaft": best, "other": struck["other"]}, names=("squirt",))
    made = trial.answer(rows)
    return PlaysLike(
        **vars(made),
        like=name,
        target=trial.factor * search.target,
        is_reached=not found or abs(found[0].gap) < SAME,
        difference=compared.differences["other"].get("squirt"),
    )


def _choices(scene: Scene) -> list[Dimension]:
    """The dimensions of a shaft, and other materials of its ferrule, as dimensions of one size."""
    materials = list[DesignChange]()
    if PARAMETERS["ferrule_length"].value(scene) is not None:
        materials = [*ferrule_materials(PARAMETERS["ferrule_material"].value(scene))]
    return [*dimensions_of(scene), *map(_of_one_size, materials)]


def _of_one_size(change: DesignChange) -> Dimension:
    """A change that has no size."""
    return Dimension(lambda _: change, 0.0, 0.0, 1.0)


def _alteration(base: Record, point: _ChangedShaft) -> float:
    """How much else a change alters: the largest relative change of stiffness, mass and first natural frequency."""
    return max(abs(point.numbers[name] / base[name] - 1) for name in ("tip_stiffness", "shaft_mass", "frequency"))


class _ChangedShaft(NamedTuple):
    """A changed shaft: its numbers, and the logarithm of its squirt over that of the other cue."""

    change: DesignChange
    numbers: Record
    gap: float


class _ShaftSearch:
    """The search for changes that reach a squirt, rad."""

    def __init__(self, trial: Trial, target: float) -> None:
        self.trial, self.target = trial, target
        self.own_gap = math.log(abs(trial.base["squirt"]) / target)

    @property
    def is_same(self) -> bool:
        """Whether the shaft has that squirt itself."""
        return abs(self.own_gap) < SAME

    def run(self, dimensions: Sequence[Dimension], progress: Progress) -> list[_ChangedShaft]:
        """The changes that reach the squirt, as few together as possible; else the nearest one."""
        ends = [(end, each) for each in progress(dimensions) if (end := self.end(None, each)) is not None]
        ends.sort(key=lambda pair: abs(pair[0].gap))
        points = [point for point, _ in ends]
        useful = _best_of_each_kind(pair for pair in ends if abs(pair[0].gap) < abs(self.own_gap))
        for _ in range(MAX_TOGETHER - 1):
            if points and abs(points[0].gap) < SAME:
                break
            before = [point for point in points if point.gap * self.own_gap > 0]  # not yet beyond the squirt
            fixed = [point for point in before[BASES:] if tuple(point.change.values) == ("ferrule material",)]
            pairs = [(base, dimension) for base in [*before[:BASES], *fixed[:1]] for dimension in useful]
            more = [end for pair in progress(pairs) if (end := self.end(*pair)) is not None]
            shafts = {frozenset(point.change.values.items()): point for point in [*points, *more]}  # in either order
            points = sorted(shafts.values(), key=lambda point: abs(point.gap))
        return [point for point in points if abs(point.gap) < SAME] or points[:1]

    def end(self, base: _ChangedShaft | None, dimension: Dimension) -> _ChangedShaft | None:
        """The first size of a dimension, beside other changes, that reaches the squirt; else the nearest one."""
        if base is not None and not are_compatible([base.change, dimension.change(dimension.last)]):
            return None
        points = self._walk(partial(self.point, base, dimension), dimension.steps)
        return min(points, key=lambda point: abs(point.gap), default=None)

    def _walk(self, at: Callable[[int], _ChangedShaft | None], count: int) -> list[_ChangedShaft]:
        """Shafts with larger and larger sizes, until the squirt is crossed or farther away, or the limits are met."""
        points = list[_ChangedShaft]()
        before = 0
        for k in sorted({round(count * i / SIZES) for i in range(SIZES + 1)}):
            point = at(k)
            is_end = point is None
            if point is None:
                if not points:
                    break
                k, point = _last_before(at, before, points[-1], k, lambda _: True)
            if points and point.gap * points[-1].gap < 0:
                size, last = _last_before(at, before, points[-1], k, partial(_is_on_side, point))
                return [*points, last, at(size + 1) or point]
            is_farther = bool(points) and abs(point.gap) > abs(points[-1].gap)
            points.append(point)
            before = k
            if is_end or is_farther:
                break
        return points

    def point(self, base: _ChangedShaft | None, dimension: Dimension, k: int) -> _ChangedShaft | None:
        """The shaft with the k-th size; None where its geometry or the limits do not allow it."""
        change = dimension.change(dimension.size(k))
        if base is not None:
            change = joined([base.change, change])
        variant = self.trial.variant(change)
        if variant is None or not self.trial.is_stiff(variant[1]):
            return None
        numbers = variant[1]
        return _ChangedShaft(change, numbers, math.log(abs(numbers["squirt"]) / self.target))


def _last_before(
    at: Callable[[int], _ChangedShaft | None],
    low: int,
    point: _ChangedShaft,
    stop: int,
    is_before: Callable[[_ChangedShaft], bool],
) -> tuple[int, _ChangedShaft]:
    """The last size from one, that of a point, that is allowed and before something, and its point, by bisection."""
    while stop - low > 1:
        middle = (low + stop) // 2
        tried = at(middle)
        if tried is not None and is_before(tried):
            low, point = middle, tried
        else:
            stop = middle
    return low, point


def _is_on_side(end: _ChangedShaft, point: _ChangedShaft) -> bool:
    """Whether a shaft is not yet on the side of the other cue's squirt where the end is."""
    return end.gap * point.gap < 0


def _best_of_each_kind(ends: Iterable[tuple[_ChangedShaft, Dimension]]) -> list[Dimension]:
    """The dimension with the nearest end of all that set the same parameters; ends: the nearest first."""
    best = dict[tuple[str, ...], Dimension]()
    for point, dimension in ends:
        best.setdefault(tuple(point.change.values), dimension)
    return [*best.values()]
