"""Numbers that cannot be meant: in SI units no cue has them, and in mm, g or ms it would.

A class of this table checks its numbers when it is made. Only such numbers are remarked: a scene may be scaled, and a
limit may be taken (a dome of one metre is nearly flat), without a word.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from types import FrameType
from typing import NamedTuple

from cuefem.quantity.units import scale


class Unusual(UserWarning):
    """A number that looks like one in another unit: everything in Python is in SI units.

    Where warnings are errors, `warnings.filterwarnings("ignore", category=cuefem.Unusual)` lets such numbers pass.

    Examples
    --------
    >>> import warnings
    >>> import cuefem as cf
    >>> with warnings.catch_warnings(record=True) as told:
    ...     warnings.simplefilter("always")
    ...     dome = cf.TipDome(9.5)
    >>> print(told[0].message)
    TipDome.radius is 9.5 m, which no cue has: is it 9.5 mm? Write 0.0095 (m)
    """


class RealRange(NamedTuple):
    """Between which numbers (SI) a field of real cues lies, its unit, and other units that people think in."""

    least: float
    most: float
    unit: str
    others: tuple[str, ...]


CUE_LENGTH = RealRange(0.3, 1.6, "m", ("mm", "in"))
_PLACE = RealRange(0.01, 1.6, "m", ("mm", "in"))
CUE_DIAMETER = RealRange(0.0075, 0.04, "m", ("mm", "in"))
_BORE = RealRange(0.001, 0.03, "m", ("mm", "in"))
_DOME = RealRange(0.005, 0.02, "m", ("mm", "in"))
_STIFF = RealRange(5e6, 6e11, "Pa", ("GPa", "MPa"))
_DENSITY = RealRange(40.0, 2e4, "kg/m^3", ("g/cm^3",))
_TIME = RealRange(2e-4, 0.01, "s", ("ms", "us"))

USUAL = {
    ("Material", "E"): _STIFF,
    ("Material", "G"): _STIFF,
    ("Material", "rho"): _DENSITY,
    ("Segment", "length"): RealRange(0.002, 1.6, "m", ("mm", "in")),
    ("Segment", "tip_diameter"): CUE_DIAMETER,
    ("Segment", "butt_diameter"): CUE_DIAMETER,
    ("Segment", "tip_bore"): _BORE,
    ("Segment", "butt_bore"): _BORE,
    ("Cue", "body_mass"): RealRange(0.05, 0.8, "kg", ("g", "oz")),
    ("LumpedCue", "mass"): RealRange(0.1, 1.0, "kg", ("g", "oz")),
    ("LumpedCue", "end_mass"): RealRange(1e-3, 0.1, "kg", ("g",)),
    ("Cue", "length"): CUE_LENGTH,
    ("Stroke", "speed"): RealRange(0.01, 30.0, "m/s", ()),
    ("Ball", "mass"): RealRange(0.08, 0.4, "kg", ("g", "oz")),
    ("Ball", "radius"): RealRange(0.02, 0.04, "m", ("mm", "in")),
    ("Tip", "contact_time"): _TIME,
    ("TipDome", "radius"): _DOME,
    ("LeatherTip", "height"): RealRange(0.001, 0.015, "m", ("mm", "in")),
    ("LeatherTip", "dome_radius"): _DOME,
    ("LeatherTip", "E"): RealRange(5e6, 1e9, "Pa", ("GPa", "MPa")),
    ("LeatherTip", "rho"): _DENSITY,
    ("PointMass", "position"): _PLACE,
    ("PointMass", "mass"): RealRange(5e-4, 0.1, "kg", ("g", "oz")),
    ("Support", "position"): _PLACE,
    ("Joint", "position"): _PLACE,
    ("SecondHit", "window"): RealRange(1e-3, 0.1, "s", ("ms",)),
}
FAR = 5.0  # times beyond the usual: nearer than this a number may be meant
LIGHTEST = 0.25  # kg, of a whole cue: a child's
WHOLE = (0.3, 1.2)  # m, of a drawing that is a shaft's and not a whole cue's: a model to scale is left alone
SHORTEST, LONGEST = 1e-6, 0.1  # N/m or s: springs of such stiffness hold no striker, and contacts last so long
_PACKAGE = str(Path(__file__).parents[1])
_trying = ContextVar("whether a search of this package tries numbers of its own", default=False)


def slip(kind: str, name: str, value: float) -> str:
    """What is said of a field whose number cannot be meant; "" of all others."""
    usual = USUAL.get((kind, name))
    if usual is None or usual.least / FAR <= value <= FAR * usual.most or not math.isfinite(value):
        return ""
    scales = [(unit, float(scale(unit, usual.unit))) for unit in usual.others]
    meant = [(unit, per) for unit, per in scales if usual.least <= value * per <= usual.most]
    if not meant:
        return ""
    units = " or ".join(f"{value:g} {unit}" for unit, _ in meant)
    written = " or ".join(f"{value * per:.4g}" for _, per in meant)
    return f"{kind}.{name} is {value:g} {usual.unit}, which no cue has: is it {units}? Write {written} ({usual.unit})"


@contextmanager
def trying() -> Iterator[None]:
    """Remark nothing while a search tries numbers that nobody wrote."""
    before = _trying.set(True)
    try:
        yield
    finally:
        _trying.reset(before)


def remark(kind: str, name: str, value: float) -> None:
    """Warn of a number that cannot be meant, at the line that lies outside this package."""
    said = slip(kind, name, value)
    if said and not _trying.get():
        _warn(said)


def remark_time_as_stiffness(kind: str, stiffness: float | None) -> None:
    """Warn of a stiffness so small that it must be a contact time: the third number of a `Striker` is a stiffness."""
    if stiffness is not None and SHORTEST <= stiffness <= LONGEST:
        said = f"{kind}.stiffness is {stiffness:g} N/m, which nothing has: is it a contact time in s? "
        _warn(f"{said}Write {kind}(..., contact_time={stiffness:g})")


def remark_light(mass: float, length: float) -> None:
    """Warn of a shaft, in its real size, that is about to be struck without the rest of its cue."""
    if mass < LIGHTEST and WHOLE[0] <= length <= WHOLE[1]:
        said = f"Cue.body_mass is 0 kg, so the whole cue weighs {mass:.3g} kg; 0.4 to 0.7 is usual: what is behind the "
        _warn(f"{said}shaft counts in a stroke (dataclasses.replace(cue, body_mass=0.43))")


def remark_said(*said: str) -> None:
    """Warn of what the parts of a scene say of each other, if anything."""
    for text in filter(None, said):
        if not _trying.get():
            _warn(text)


def _warn(said: str) -> None:
    """Warn at the line outside this package; of a field that this line was warned of in the words of that time, which
    Python's filter knows, so that a sweep is warned once."""
    level = _outside()
    frame = sys._getframe(level - 1)
    field, known = said.partition(" is ")[0], frame.f_globals.get("__warningregistry__", {})
    told = (key[0] for key in known if isinstance(key, tuple) and key[1:] == (Unusual, frame.f_lineno))
    warnings.warn(next((text for text in told if text.startswith(f"{field} is ")), said), Unusual, level)


def _outside() -> int:
    """How many frames above `_warn` the call into this package stands."""
    frame: FrameType | None = sys._getframe(1)
    level, inside = 0, 0
    while frame is not None:
        level += 1
        name = frame.f_code.co_filename
        written = name == "<string>" and inside == level - 1 and frame.f_back is not None  # dataclasses' own __init__
        inside = level if name.startswith(_PACKAGE) or written else inside
        frame = frame.f_back
    return inside + 1
