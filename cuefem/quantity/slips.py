"""Numbers that cannot be meant: in SI units no cue has them, and in mm, g or ms it would.

A field with usual numbers is checked for them when its object is made. Only such numbers are remarked: a scene may be
scaled, and a limit may be taken (a dome of one metre is nearly flat), without a word.
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


CUE_LENGTH, CUE_DIAMETER = (0.3, 1.6), (0.0075, 0.04)  # m, of what is drawn of real cues
# Units that people think in, by the SI unit of a field.
OTHERS = {"m": ("mm", "in"), "kg": ("g", "oz"), "s": ("ms", "us"), "Pa": ("GPa", "MPa"), "kg/m^3": ("g/cm^3",)}
FAR = 5.0  # times beyond the usual: nearer than this a number may be meant
LIGHTEST = 0.25  # kg, of a whole cue: a child's
WHOLE = (0.3, 1.2)  # m, of a drawing that is a shaft's and not a whole cue's: a model to scale is left alone
SHORTEST, LONGEST = 1e-6, 0.1  # N/m or s: springs of such stiffness hold no striker, and contacts last so long
_PACKAGE = str(Path(__file__).parents[1])
_trying = ContextVar("whether a search of this package tries numbers of its own", default=False)


def slip(name: str, value: float, unit: str, usual: tuple[float, float]) -> str:
    """What is said of a number that cannot be meant, given between which numbers it usually lies; "" of all others."""
    least, most = usual
    if least / FAR <= value <= FAR * most or not math.isfinite(value):
        return ""
    scales = [(other, float(scale(other, unit))) for other in OTHERS.get(unit, ())]
    meant = [(other, per) for other, per in scales if least <= value * per <= most]
    if not meant:
        return ""
    units = " or ".join(f"{value:g} {other}" for other, _ in meant)
    written = " or ".join(f"{value * per:.4g}" for _, per in meant)
    return f"{name} is {value:g} {unit}, which no cue has: is it {units}? Write {written} ({unit})"


@contextmanager
def trying() -> Iterator[None]:
    """Remark nothing while a search tries numbers that nobody wrote."""
    before = _trying.set(True)
    try:
        yield
    finally:
        _trying.reset(before)


def remark(*said: str) -> None:
    """Warn of numbers that cannot be meant, in these words if there are any, at the line outside this package."""
    for text in filter(None, said):
        if not _trying.get():
            _warn(text)


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
