"""What can be asked of a design, by name: "end_mass", "frequency(2)", "squirt(0.3)"."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from cuefem.cue import Array
from cuefem.design.batch import CueBatch
from cuefem.design.solvers import Solver
from cuefem.endmass.drives import DEFINITIONS, Definition
from cuefem.squirt import natural_pivot_length

# The offset that stands for the limit b -> 0 in formulas; they leave an error of its square.
SMALL = 1e-6


class Kind(NamedTuple):
    """A family of responses: its unit, what it is, what its argument is ("", "mode", "offset"), how it is found.

    label: what tables and pages call it. strikes: whether it needs the tip's modes up to the contact's cutoff.
    segments: whether it needs a cue of segments.
    limit: whether without an offset it is the limit of small offsets, instead of the value at the scene's own offset.
    reasons: for each design, why its response is nan, or None if it is a number. better: which a player wants, "lower"
    or "higher", by which a summary picks designs; "" if neither.
    """

    unit: str
    label: str
    about: str
    values: Callable[[Solver, Any], Array]
    argument: str = ""
    strikes: bool = False
    segments: bool = False
    limit: bool = False
    reasons: Callable[[Solver], Sequence[str | None]] | None = None
    better: str = "lower"


def _small_offset_pivot(solver: Solver, _: Any) -> Array:
    slopes = solver.stick.squirt
    return np.array([_pivot(solver, i, SMALL, slope * np.arcsin(SMALL)) for i, slope in enumerate(slopes)])


def _pivot(solver: Solver, i: int, offset: float, squirt: float) -> float:
    scene = solver.scenes[i]
    return float(natural_pivot_length(offset, squirt, radius=scene.ball.radius, dome_radius=scene.dome_radius))


def _struck(value: Callable[[Solver, int, Any], float]) -> Callable[[Solver, Any], Array]:
    """A response of one coupled strike of each design, at the given offset; by default at the scene's own."""

    def values(solver: Solver, offset: float | None) -> Array:
        return np.array([value(solver, i, solver.strike(i, offset)) for i in range(len(solver.scenes))])

    return values


def _pivot_length(solver: Solver, offset: float | None) -> Array:
    if offset is None:
        return _small_offset_pivot(solver, None)
    return _struck(lambda solver, i, found: _pivot(solver, i, offset, found.squirt))(solver, offset)


def _end_mass(solver: Solver, offset: float | None) -> Array:
    return solver.stick.end_mass if offset is None else solver.stick_at(offset)


def _stick_reasons(solver: Solver) -> Sequence[str | None]:
    return solver.stick.reasons


def _drawn(value: Callable[[CueBatch], Array]) -> Callable[[Solver, Any], Array]:
    """A response that follows from the drawings of designs with equally many segments."""
    return lambda solver, _: value(CueBatch.of([scene.shaft for scene in solver.scenes]))


_SQUIRT = _struck(lambda s, i, found: found.squirt)
_SPEED = _struck(lambda s, i, found: found.ball_speed)
_VIBRATION = _struck(lambda s, i, found: found.energy["cue vibration"])
_PIVOT = "natural pivot length: of small offsets, or of the coupled strike at an offset"
_END_MASS = "stick end mass, of small offsets; of a tip that sticks at an offset"
_STATIC = "static: force across the tip over its deflection, the butt end clamped"
_BALANCE = "centre of the segments' mass, from the tip"
_WALL = "thinnest wall of the segments, at their ends; where solid, the radius"
KINDS = {
    "end_mass": Kind(
        "kg", "end mass", _END_MASS, _end_mass, "offset", strikes=True, limit=True, reasons=_stick_reasons
    ),
    "squirt_slope": Kind(
        "",
        "squirt slope",
        "squirt over phi in the limit of small offsets",
        lambda s, _: s.stick.squirt,
        strikes=True,
    ),
    "pivot_length": Kind(
        "m", "natural pivot length", _PIVOT, _pivot_length, "offset", strikes=True, limit=True, better="higher"
    ),
    "mass": Kind("kg", "cue mass", "mass of the cue", lambda s, _: s.mass, better=""),
    "shaft_mass": Kind("kg", "shaft mass", "mass of the segments", lambda s, _: s.shaft_mass, segments=True, better=""),
    "balance_point": Kind("m", "balance point", _BALANCE, lambda s, _: s.balance_point, segments=True, better=""),
    "tip_stiffness": Kind(
        "N/m", "stiffness at the tip", _STATIC, lambda s, _: s.tip_stiffness, segments=True, better="higher"
    ),
    "tip_diameter": Kind(
        "m",
        "tip diameter",
        "diameter of the tip",
        _drawn(lambda b: b.rows.tip_diameter[:, 0]),
        segments=True,
        better="",
    ),
    "wall": Kind("m", "thinnest wall", _WALL, _drawn(lambda b: b.walls.min(axis=1)), segments=True, better="higher"),
    "frequency": Kind(
        "Hz", "tone", "of a bending mode", lambda s, n: s.frequencies[:, n - 1], "mode", segments=True, better=""
    ),
    "squirt": Kind("rad", "squirt", "of the coupled strike", _SQUIRT, "offset", strikes=True),
    "ball_speed": Kind(
        "m/s", "ball speed", "after the coupled strike", _SPEED, "offset", strikes=True, better="higher"
    ),
    "vibration_energy": Kind(
        "J", "energy of vibration", "left ringing in the cue by the coupled strike", _VIBRATION, "offset", strikes=True
    ),
}


def kinds() -> dict[str, Kind]:
    """All kinds of responses by name: `KINDS`, and "end_mass_NAME" for every definition of the end mass."""
    return KINDS | {f"end_mass_{name}": _defined(one) for name, one in DEFINITIONS.items()}


def _defined(definition: Definition) -> Kind:
    def values(solver: Solver, offset: float | None) -> Array:
        return np.array([solver.end_mass(i, definition, offset) for i in range(len(solver.scenes))])

    about = f"end mass: {definition.meaning}"
    return Kind(
        "kg", f"end mass, {definition.label}", about, values, "offset" if definition.at_offset else "", strikes=True
    )


_NAME = re.compile(r"(\w+)(?:\(\s*([^()\s]+)\s*\))?")


@dataclass(frozen=True)
class Response:
    """One number asked of every design: the name of a kind, and the number of the mode or the offset b/R.

    Without an offset, a strike is at the scene's own; "pivot_length" and "end_mass" are then the limits of small
    offsets.
    """

    kind: str
    argument: float | int | None = None

    @classmethod
    def of(cls, text: str) -> Response:
        """Read text such as "squirt(0.3)"; ValueError, suggesting similar names, if no response matches."""
        found = _NAME.fullmatch(text.strip())
        if not found or found[1] not in kinds():
            close = difflib.get_close_matches(text.partition("(")[0], kinds(), n=3, cutoff=0.5)
            hint = f"; did you mean {' or '.join(close)}?" if close else ""
            raise ValueError(f"must be one of {', '.join(map(_usage, kinds()))}; got {text!r}{hint}")
        return cls(found[1], _argument(found[1], found[2], text))

    @property
    def name(self) -> str:
        """The response as text that `of` reads back."""
        return self.kind if self.argument is None else f"{self.kind}({self.argument!r})"

    @property
    def label(self) -> str:
        """What tables and pages call it: "squirt at b/R 0.3", "tone 2"."""
        kind = kinds()[self.kind]
        if self.argument is None:
            return f"{kind.label} at the stroke's offset" if self.in_time else kind.label
        return f"{kind.label} {'' if kind.argument == 'mode' else 'at b/R '}{self.argument}"

    @property
    def unit(self) -> str:
        """SI unit, "" for a pure number."""
        return kinds()[self.kind].unit

    @property
    def better(self) -> str:
        """Which a player wants: "lower", "higher", or neither, ""."""
        return kinds()[self.kind].better

    @property
    def strikes(self) -> bool:
        """Whether it takes the tip's modes up to the contact's cutoff."""
        return kinds()[self.kind].strikes

    @property
    def in_time(self) -> bool:
        """Whether it takes a strike in time, some milliseconds a design."""
        kind = kinds()[self.kind]
        return kind.argument == "offset" and not (kind.limit and self.argument is None)

    @property
    def segments(self) -> bool:
        """Whether it needs a cue of segments."""
        return kinds()[self.kind].segments

    @property
    def modes(self) -> int:
        """How many frequencies it takes."""
        return int(self.argument or 0) if self.kind == "frequency" else 0

    def values(self, solver: Solver) -> Array:
        """The response of every design, (designs,)."""
        return kinds()[self.kind].values(solver, self.argument)

    def reason(self, solver: Solver, i: int) -> str | None:
        """Why a design's response is nan, if that is known."""
        reasons = kinds()[self.kind].reasons
        return None if reasons is None else reasons(solver)[i]


def _usage(kind: str) -> str:
    argument = kinds()[kind].argument
    return f"{kind}({argument})" if argument == "mode" else f"{kind}[({argument})]" if argument else kind


def _argument(kind: str, given: str | None, text: str) -> float | int | None:
    wanted = kinds()[kind].argument
    if given is None and wanted != "mode":
        return None
    if wanted == "":
        raise ValueError(f"must be {kind}, which takes nothing in brackets; got {text!r}")
    try:
        number = float(given or "nan")
    except ValueError:
        number = float("nan")
    if wanted == "mode":
        if not (number >= 1 and number == int(number)):
            raise ValueError(f"must be {kind}(n), n a whole number >= 1; got {text!r}")
        return int(number)
    if not -1 < number < 1 or (number == 0 and kind == "pivot_length"):
        without = " without 0" if kind == "pivot_length" else ""
        raise ValueError(f"must be {kind}(b), b an offset b/R in (-1, 1){without}; got {text!r}")
    return number
