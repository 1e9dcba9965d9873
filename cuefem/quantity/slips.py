"""Numbers that cannot be meant: in SI units no cue has them, and in mm, g or ms it would.

A field with usual numbers is checked for them when its object is made. Only such numbers are remarked: a scene may be
scaled, and a limit may be taken (a dome of one metre is nearly flat), without a word.
"""

from __future__ import annotations

import math
import sys
import traceback
import warnings
from pathlib import Path

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
_PACKAGE = str(Path(__file__).parents[1])


def slip(name: str, value: float, unit: str, usual: tuple[float, float]) -> str:
    """What is said of a number that cannot be meant, given between which numbers it usually lies; "" of all others."""
    least, most = usual
    if least / FAR <= value <= FAR * most or not math.isfinite(value):
        return ""
    scales = ((other, float(scale(other, unit))) for other in OTHERS.get(unit, ()))
    meant = {other: value * per for other, per in scales if least <= value * per <= most}
    units = " or ".join(f"{value:g} {other}" for other in meant)
    written = " or ".join(f"{number:.4g}" for number in meant.values())
    return f"{name} is {value:g} {unit}, which no cue has: is it {units}? Write {written} ({unit})" if meant else ""


def remark(said: str) -> None:
    """Warn of a number that cannot be meant, in these words if there are any, at the line outside this package."""
    if said:
        warnings.warn(said, Unusual, _level())


def remark_light(mass: float, length: float) -> None:
    """Warn of a shaft, in its real size, that is about to be struck without the rest of its cue."""
    if mass < LIGHTEST and WHOLE[0] <= length <= WHOLE[1]:
        said = f"Cue.body_mass is 0 kg, so the whole cue weighs {mass:.3g} kg; 0.4 to 0.7 is usual: what is behind the "
        remark(f"{said}shaft counts in a stroke (dataclasses.replace(cue, body_mass=0.43))")


def _level() -> int:
    """The stack level, as `remark` gives it to a warning, of the line that calls into this package."""
    files = [frame.f_code.co_filename for frame, _ in traceback.walk_stack(sys._getframe())]
    last = max(i for i, file in enumerate(files) if file.startswith(_PACKAGE))
    made = files[last + 1 : last + 2] == ["<string>"]  # a dataclass's own __init__
    return last + 1 + made
