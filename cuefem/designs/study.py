"""A design study: a base scene, its parameters with their ranges, and the responses of every design."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import product
from typing import Any, Protocol

import numpy as np

from cuefem.cue.materials import material
from cuefem.designs.evaluation import Evaluation, Failed, Response, evaluate
from cuefem.designs.sampling import Levels, Normal, Span, Value
from cuefem.parameters.field_paths import Path, path_text
from cuefem.parameters.scene_changes import check_bore, with_values_at
from cuefem.parameters.scene_paths import paths, quantity_at, value_at
from cuefem.quantity.display import one_line
from cuefem.quantity.fields import quote
from cuefem.quantity.unit_checks import FLOAT_ERRORS
from cuefem.scene import Resolution, Scene


class DesignSample(Protocol):
    """Points in the unit cube, one a design, such as a `Sample`."""

    @property
    def count(self) -> int:
        """Number of points."""

    def points(self, dimensions: int) -> Iterator[list[float]]:
        """The points, each of ``dimensions`` numbers."""


class StudyDefinition(Protocol):
    """The definition of a study of any kind: a `Study` (a sweep), a `Scatter` or a `Problem` (an optimum)."""

    @property
    def study(self) -> Study:
        """Parameters and responses."""

    @property
    def all_designs(self) -> Study:
        """The study of all designs to compute."""

    def calibrated(self, squirt_factor: float) -> StudyDefinition:
        """The same with the squirt factor of a calibration, `Calibration.factor` of the base."""


def check_column_name(what: str, name: str) -> None:
    """ValueError for control characters, and for a first character that makes a cell of a spreadsheet a formula."""
    if not name.isprintable() or name.strip()[:1] in "=+-@":
        raise ValueError(f"{what} must be printable text that begins with none of = + - @; got {quote(name)}")


@dataclass(frozen=True)
class Vary:
    """A parameter of a study: fields, and the range of their common values.

    Parameters
    ----------
    paths : str or tuple of str
        The fields: a name ("bore width") or a path ("cue.segments[0].tip_bore"); "[*]" means every item of a list.
    range : Levels, Span or Normal
        The values: SI numbers (pure numbers for a factor) or names of materials.
    name : str
        Name of the column; the default is the paths.
    factor : bool
        Multiply the fields by the value, instead of setting them to it.
    shift : bool
        Add the value to the fields, instead of setting them to it.
    compensating_path : tuple of str
        Fields that decrease by the increase of the first path: a length that is compensated by the next segment's
        leaves the length of the cue unchanged.

    Raises
    ------
    ValueError
        If no field is named, ``factor`` and ``shift`` are both set, or the name is not printable.

    Examples
    --------
    >>> import cuefem as cf
    >>> cf.Vary("tip diameter", cf.Span(0.011, 0.013, count=3)).name
    'tip diameter'
    >>> cf.Vary("cue.segments[*].material.E", cf.Normal(1.0, 0.1), name="modulus", factor=True).operation
    'factor'
    """

    paths: tuple[str, ...] | str
    range: Levels | Span | Normal
    name: str = ""
    factor: bool = False
    shift: bool = False
    compensating_path: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for name in ("paths", "compensating_path"):
            if isinstance(text := getattr(self, name), str):
                object.__setattr__(self, name, (text,))
        if not self.paths:
            raise ValueError("path must name a field; got none")
        if self.factor and self.shift:
            raise ValueError("factor and shift must not both be set")
        object.__setattr__(self, "name", self.name or ", ".join(self.paths))
        check_column_name("name", self.name)

    def fields(self, base: Scene) -> tuple[Path, ...]:
        """The fields of a scene that vary; ValueError if a path names no field, or a value does not fit the field."""
        fields = tuple(path for text in self.paths for path in paths(base, text))
        for path in fields:
            self._check_field(base, path)
        return fields

    def compensating_fields(self, base: Scene) -> tuple[Path, ...]:
        """The fields of `compensating_path`; ValueError if one is no number, or has another unit than the paths."""
        fields = tuple(path for text in self.compensating_path for path in paths(base, text))
        first = self.fields(base)[0]
        for path in fields:
            numbers = all(isinstance(value_at(base, each), float) for each in (path, first))
            if not numbers or quantity_at(base, path).unit != quantity_at(base, first).unit:  # type: ignore[union-attr]
                raise ValueError(f"compensating_path must name numbers of the unit of path; got {path_text(path)}")
        return fields

    def _check_field(self, base: Scene, path: Path) -> None:
        quantity, values = quantity_at(base, path), self.range.ends
        moves = "factor must multiply" if self.factor else "shift must move" if self.shift else ""
        if moves and (quantity is None or value_at(base, path) is None):
            raise ValueError(f"{moves} a number; got {path_text(path)}, which is none")
        if quantity is None and not all(isinstance(value, str) for value in values):
            raise ValueError(f"{path_text(path)} must be names of materials; got {values[0]!r}")
        if quantity is not None and any(isinstance(value, str) for value in values):
            raise ValueError(f"{path_text(path)} must be numbers in {quantity.bounds}; got {values[0]!r}")

    def unit(self, base: Scene) -> str:
        """SI unit of its values, "" for factors and names; ValueError if its fields have different units."""
        quantities = [quantity_at(base, path) for path in self.fields(base)]
        units = sorted({"" if self.factor or quantity is None else quantity.unit for quantity in quantities})
        if len(units) > 1:
            raise ValueError(f"path must name fields of one unit; got {' and '.join(map(repr, units))}")
        return units[0]

    @property
    def operation(self) -> str:
        """How its value changes the fields: "set", "factor" or "shift"."""
        return "factor" if self.factor else "shift" if self.shift else "set"

    def apply(self, value: float, before: Any) -> float:
        """The new value of a field, from its value ``before`` and the value of the range."""
        return before * value if self.factor else before + value if self.shift else value


@dataclass(frozen=True)
class StudyDesign:
    """A design of a study: its scene, and the values of its parameters and responses by name, in SI units.

    failure: the reason for a missing response, such as the squirt of a miscue.
    """

    scene: Scene
    values: dict[str, Value]
    responses: dict[str, float]
    failure: str | None = field(default=None, kw_only=True)


@dataclass(frozen=True)
class Study:
    """A design study: a base scene, its parameters, and the responses of every design.

    Parameters
    ----------
    base : Scene
        The scene in which fields vary.
    vary : tuple of Vary
        The parameters. Without a sample, all combinations are designs (a grid); the last one varies fastest.
    responses : tuple of Response
        The responses of every design.
    sample : Sample, optional
        A quasi-random sample instead of the grid; any object with its ``count`` and ``points``.
    at : Resolution, optional
        One resolution for all designs. By default each design has its own, that of `cuefem.strike` and
        `cuefem.end_mass`.
    squirt_factor : float, default 1.0
        Of a calibration, as `SolvedDesign` takes it: all designs carry that of the base.

    Raises
    ------
    ValueError
        If a path names no field, two columns have one name, or a response needs segments and the cue is lumped.

    Examples
    --------
    >>> import cuefem as cf
    >>> cue = cf.Cue((cf.Segment(0.7, 0.012, 0.021, cf.material("hard maple")),), body_mass=0.42)
    >>> width = cf.Vary("tip diameter", cf.Span(0.011, 0.013, count=3))
    >>> wood = cf.Vary("wood", cf.Levels(("ash", "hard maple")))
    >>> cf.Study(cf.Scene(cue), (width, wood), (cf.Response("end_mass"),)).size
    6
    """

    base: Scene
    vary: tuple[Vary, ...]
    responses: tuple[Response, ...]
    sample: DesignSample | None = None
    at: Resolution | None = None
    squirt_factor: float = 1.0

    def __post_init__(self) -> None:
        if not self.vary or not self.responses:
            raise ValueError("a study must have parameters and responses; got none")
        self._check_fields()
        names = [name.casefold() for name in (*self.columns, "design", "failure")]
        repeated = [name for name in names if names.count(name) > 1]
        if repeated:
            raise ValueError(f"columns must have different names; got {repeated[0]!r} twice")
        needs_segments = [response.name for response in self.responses if response.result.segments]
        if needs_segments and not self.base.cue.segments:
            raise ValueError(f"{needs_segments[0]} needs a cue of segments; got a lumped cue")

    def _check_fields(self) -> None:
        changed: set[tuple[Path, str]] = set()
        for vary in self.vary:
            vary.unit(self.base)
            vary.compensating_fields(self.base)
            for path in vary.fields(self.base):
                if (path, vary.operation) in changed:
                    raise ValueError(f"a field must vary once; got {path_text(path)} twice")
                changed.add((path, vary.operation))
        if not any(path[0] == "cue" for path, _ in changed):  # which may draw a bore
            check_bore(self.base, {path[0] for path, _ in changed})

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the parameters and the responses."""
        return (*(vary.name for vary in self.vary), *(response.name for response in self.responses))

    @property
    def units(self) -> tuple[str, ...]:
        """SI units of the columns, "" for pure numbers and names."""
        return (*(vary.unit(self.base) for vary in self.vary), *(response.unit for response in self.responses))

    @property
    def study(self) -> Study:
        """Itself: parameters and responses, as of every kind of study."""
        return self

    @property
    def all_designs(self) -> Study:
        """Itself: the study of all designs to compute, as of every kind of study."""
        return self

    def calibrated(self, squirt_factor: float) -> Study:
        """The same study with another squirt factor."""
        return replace(self, squirt_factor=squirt_factor)

    @property
    def size(self) -> int:
        """Number of designs."""
        return self.sample.count if self.sample else math.prod(len(vary.range.levels) for vary in self.vary)

    def designs(self) -> Iterator[tuple[Value, ...]]:
        """The parameter values of each design, computed on demand."""
        ranges = [vary.range for vary in self.vary]
        if not self.sample:
            yield from product(*(each.levels for each in ranges))
            return
        for point in self.sample.points(len(ranges)):
            yield tuple(each.quantile(u) for each, u in zip(ranges, point, strict=True))

    @cached_property
    def _fields(self) -> tuple[tuple[Path, ...], ...]:
        return tuple(vary.fields(self.base) for vary in self.vary)

    @cached_property
    def _compensating_fields(self) -> tuple[tuple[Path, ...], ...]:
        return tuple(vary.compensating_fields(self.base) for vary in self.vary)

    @np.errstate(**FLOAT_ERRORS)
    def scene(self, values: tuple[Value, ...]) -> Scene:
        """The design with these values; ValueError if it is invalid, such as a bore wider than its shaft.

        Order: materials, numbers, factors, shifts, and last the compensating fields.
        """
        materials = {p: material(v) for i, v in enumerate(values) if isinstance(v, str) for p in self._fields[i]}
        scene: Scene = with_values_at(self.base, materials) if materials else self.base
        numbers, shifts = dict[Path, Any](), list[tuple[Path, Any]]()

        def current(path: Path) -> Any:
            return numbers.get(path, value_at(scene, path))

        for operation in ("set", "factor", "shift"):
            for i, value in enumerate(values):
                vary, fields = self.vary[i], self._fields[i]
                if isinstance(value, str) or vary.operation != operation:
                    continue
                before = [current(path) for path in fields]
                numbers |= {p: vary.apply(value, old) for p, old in zip(fields, before, strict=True)}
                shifts += [(path, numbers[fields[0]] - before[0]) for path in self._compensating_fields[i]]
        for path, gain in shifts:
            numbers[path] = current(path) - gain
        return with_values_at(scene, numbers) if numbers else scene

    def evaluate(self, designs: Sequence[tuple[Value, ...]]) -> Evaluation:
        """The responses of designs with these values; nan and a reason for an invalid one."""
        return self.evaluate_scenes([self.scene_or_reason(values) for values in designs])

    def scene_or_reason(self, values: tuple[Value, ...]) -> Scene | str:
        """The design with these values, or the reason why it is invalid."""
        try:
            return self.scene(values)
        except Failed as error:
            return one_line(str(error))

    def evaluate_scenes(self, scenes: Sequence[Scene | str]) -> Evaluation:
        """The responses of scenes; nan for the reason of an invalid one."""
        valid = {i: scene for i, scene in enumerate(scenes) if not isinstance(scene, str)}
        evaluation = evaluate([*valid.values()], self.responses, at=self.at, squirt_factor=self.squirt_factor)
        values = np.full((len(scenes), len(self.responses)), np.nan)
        values[[*valid]] = evaluation.values
        reasons = dict(zip(valid, evaluation.reasons, strict=True))
        return Evaluation(values, tuple(s if isinstance(s, str) else reasons[i] for i, s in enumerate(scenes)))
