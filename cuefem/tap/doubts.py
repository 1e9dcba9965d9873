"""When a tap test is no result to build on: modes missing, tones explained no better than by chance, odd wood."""

from __future__ import annotations

import numpy as np

from cuefem.cue import Cue, Material, shear_coefficient
from cuefem.materials import MATERIALS, WOODS, Range
from cuefem.tap.chance import LEVEL
from cuefem.tap.fit import TapFit
from cuefem.tap.matching import FACTOR, RATIOS
from cuefem.tap.tones import LOW

FAR = 0.97  # of ln `FACTOR`: an E as far from the file's is at the end of the search
WIDEST = 1.5  # beyond an end of a range: as far as the range is wide, and at most this factor
OURS = 0.5  # of the clear tones' power: with less explained, most of the sound is another thing's
UNITS = {"E": (1e9, "GPa"), "G": (1e9, "GPa"), "rho": (1.0, "kg/m³")}


def missing(found: TapFit) -> list[int]:
    """Modes between `LOW` and the highest one heard that were not heard, 1 the lowest."""
    ours = [match.mode for match in found.matched if match.mode is not None]
    audible = [k for k, f in enumerate(found.frequencies, start=1) if f > LOW and k < max(ours)]
    return sorted(set(audible) - set(ours))


def refusals(found: TapFit, *, edge: bool = False) -> list[str]:
    """Why the wood should not be believed, one line each."""
    lines = []
    ours = {match.mode for match in found.matched if match.mode is not None}
    clear = [match for match in found.matched if match.tone.kind == "tone"]
    if found.chance > LEVEL:
        share = f"{100 * found.chance:.2g} % of random sets of {len(clear)} tones fit as well, above {100 * LEVEL:g} %"
        lines.append(f"the tones fit this shaft no better than by chance ({share})")
    if len(missed := missing(found)) > len(ours):
        lines.append(f"{len(missed)} of the {len(missed) + len(ours)} modes that should be heard are missing")
    loud = sum(match.tone.level**2 for match in clear)
    if sum(match.tone.level**2 for match in clear if match.mode is not None) < OURS * loud:
        lines.append("most of the sound's power is in tones that are none of this shaft's")
    if found.rivals:
        others = ", ".join(f"{E / 1e9:.3g}" for E, _ in found.rivals)
        lines.append(f"tones cannot be told apart: E {found.wood.E / 1e9:.3g} or {others} GPa")
    if abs(np.log(found.wood.E / found.before.E)) > FAR * np.log(FACTOR):
        lines.append(f"E is at the end of the search, a factor {FACTOR:g} from the file's")
    if edge:
        lines.append(f"G/E is at the end of what shafts have, {RATIOS[0]:.3g} to {RATIOS[1]:.3g}")
    return lines + unlike(found.wood, found.before)


def unlike(wood: Material, before: Material) -> list[str]:
    """Which of E, G and rho lie far outside the table's ranges for materials like the file's, one line each.

    Materials like the file's: all woods for a wood, otherwise the entries themselves whose widened ranges hold the
    file's E, G and rho. Nothing is said of a file's material that is like none in the table. A range is widened by its
    own width, at most by `WIDEST`: for the density and E of woods, whose ranges are one standard deviation, to three.
    """
    like = [name for name in MATERIALS if all(_within(getattr(before, key), [name], key) for key in UNITS)]
    if any(name in WOODS for name in like):
        like = list(WOODS)
    lines = []
    for key, (scale, unit) in UNITS.items():
        value = getattr(wood, key)
        if like and not _within(value, like, key):
            ranges = [MATERIALS[name].ranges[key] for name in like]
            low, high = min(r[0] for r in ranges) / scale, max(r[1] for r in ranges) / scale
            what = "woods have" if like[0] in WOODS else f"{', '.join(like)} has"
            lines.append(
                f"{key} {value / scale:.3g} {unit} is far outside the {low:.3g} to {high:.3g} {unit} that {what}"
            )
    return lines


def _within(value: float, names: list[str], key: str) -> bool:
    return any(low <= value <= high for low, high in (_widened(MATERIALS[name].ranges[key]) for name in names))


def _widened(own: Range) -> Range:
    low, high = own
    factor = min(high / low, WIDEST)
    return low / factor, high * factor


def shear_coefficients(cue: Cue, wood: Material) -> tuple[float, float]:
    """Least and largest shear coefficient of the sections of this material, where it is the shell."""
    found = []
    for segment in cue.segments:
        if segment.material != wood and segment.core != wood:
            continue
        if segment.kappa is not None:
            found.append(segment.kappa)
        elif segment.material != wood:
            found.append(float(shear_coefficient(wood.effective_poisson_ratio)))
        else:
            ends = (segment.tip_bore / segment.tip_diameter, segment.butt_bore / segment.butt_diameter)
            found += [float(shear_coefficient(wood.effective_poisson_ratio, np.array(ratio))) for ratio in ends]
    return min(found), max(found)
