"""Reasons to doubt a tap test: modes are missing, the tones fit no better than by chance, or the wood is odd."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from cuefem.cue import Cue, Material, shear_coefficient
from cuefem.materials import MATERIALS, WOODS, Range
from cuefem.measured.chance import LEVEL
from cuefem.measured.fit import TapFit
from cuefem.measured.matching import FACTOR, RATIOS
from cuefem.measured.tones import LOW

FAR = 0.97  # of ln `FACTOR`: an E this far from the file's is at the end of the search
WIDEST = 1.5  # a range is widened by its own width at both ends, at most by this factor
# Shares of the clear tones' power: if the shaft explains less than MOST, the sound comes mostly from something else; if
# less than NEARLY_ALL, the drawing may be that of another shaft.
MOST, NEARLY_ALL = 0.5, 0.8
POOR = 5e-3  # misfit that a good drawing of an even shaft does not have
KEPT = 0.25  # error of the file's ln G/E, if the tones do not determine it
DENSITY = 0.1  # relative error of the file's density, if the shaft was not weighed (Wood Handbook, spread of a wood)
RATES = (8000.0, 16000.0, 22050.0, 32000.0, 44100.0, 48000.0, 88200.0, 96000.0)  # usual ones, samples a second
WRONG_RATES = {44.1 / 48: "44.1 kHz for 48", 48 / 44.1: "48 kHz for 44.1"} | {
    0.5: "half of what it says",
    2.0: "twice what it says",
}
UNITS = {"E": (1e9, "GPa"), "G": (1e9, "GPa"), "rho": (1.0, "kg/m³")}


def missing(fit: TapFit) -> list[int]:
    """Modes, 1 the lowest, between `LOW` and the highest one heard that were not heard, not even faintly."""
    ours = [match.mode for match in fit.matched if match.mode is not None]
    faint = [match.tone for match in fit.matched if match.tone.kind == "faint"]
    return [
        mode
        for mode, f in enumerate(fit.frequencies[: max(ours)], start=1)
        if f > LOW and mode not in ours and not any(abs(tone.frequency - f) < 2 * tone.error for tone in faint)
    ]


def explained(fit: TapFit) -> float:
    """The share of the clear tones' power that lies in modes of the shaft; 1 without clear tones."""
    clear = [match for match in fit.matched if match.tone.kind == "tone"]
    loud = sum(match.tone.level**2 for match in clear)
    return sum(match.tone.level**2 for match in clear if match.mode is not None) / loud if loud else 1.0


def refusals(fit: TapFit, *, edge: bool = False) -> list[str]:
    """Reasons not to trust this result, one line each; edge: whether G/E stopped at a bound of the search."""
    lines = []
    heard = {match.mode for match in fit.matched if match.mode is not None}
    clear = sum(match.tone.kind == "tone" for match in fit.matched)
    if fit.chance > LEVEL:
        sets = f"random sets of {clear} tones" if clear > 1 else "random single tones"
        share = f"{100 * fit.chance:.2g} % of {sets} fit as well, above {100 * LEVEL:g} %"
        lines.append(f"the tones fit this shaft no better than by chance ({share})")
    if fit.note:
        of = sum(match.tone.kind in ("tone", "harmonic") for match in fit.matched)
        lines.append(
            f"a string, a pipe or a voice explains the tones better: {fit.note.partials} of {of} are partials of a "
            f"note of {fit.note.frequency:.4g} Hz"
        )
    if len(missed := missing(fit)) > len(heard):
        lines.append(f"{len(missed)} of the {len(missed) + len(heard)} modes that should be heard are missing")
    if explained(fit) < MOST:
        lines.append("most of the sound's power is in tones that this shaft does not have")
    if fit.rivals:
        others = ", ".join(f"{E / 1e9:.3g} GPa (odds 1 : {odds:.2g})" for E, odds in fit.rivals)
        lines.append(f"the tones cannot be told apart: E may be {fit.wood.E / 1e9:.3g} GPa or {others}")
    if abs(np.log(fit.wood.E / fit.before.E)) > FAR * np.log(FACTOR):
        lines.append(f"E is at the end of the search, a factor {FACTOR:g} from the file's")
    if edge:
        lines.append(f"G/E is at the end of what shafts have, {RATIOS[0]:.3g} to {RATIOS[1]:.3g}")
    return lines + unlike(fit.wood, fit.before) + wrong_rate(fit)


def wrong_rate(fit: TapFit) -> list[str]:
    """What the lowest tone and E would be at another sampling rate, if only that makes the wood one that exists."""
    for factor, words in WRONG_RATES.items():
        wood = replace(fit.wood, E=factor**2 * fit.wood.E, G=factor**2 * fit.wood.G)
        if unlike(fit.wood, fit.before) and not unlike(wood, fit.before):
            return [f"if the file's sampling rate is wrong, {words}, {at_rate(fit, factor)}"]
    return []


def other_rate(fit: TapFit, rate: float) -> str:
    """What the tap would tell at the usual sampling rate that is nearest to the one its file says."""
    usual = min((each for each in RATES if abs(each - rate) > 1.0), key=lambda each: abs(np.log(each / rate)))
    return (
        f"the file says {rate:g} samples a second, which is believed; if it was recorded at {usual:g}, "
        f"{at_rate(fit, usual / rate)}"
    )


def at_rate(fit: TapFit, factor: float) -> str:
    """The lowest tone and E at a sampling rate ``factor`` times that of the file.

    All tones of a shaft rise with the root of E and G together, so a wrong rate is heard as other wood.
    """
    lowest = min(match.tone.frequency for match in fit.matched if match.mode is not None)
    return (
        f"the lowest tone is {factor * lowest:.4g} Hz, not {lowest:.4g} Hz, and "
        f"E is {factor**2 * fit.wood.E / 1e9:.3g} GPa, not {fit.wood.E / 1e9:.3g} GPa"
    )


def remarks(fit: TapFit, rate: float | None = None) -> list[str]:
    """What else is worth knowing about a result, one line each, without repeating `refusals`.

    rate: of the recording, by its file, samples a second.
    """
    heard = [match.mode for match in fit.matched if match.mode is not None]
    lines = []
    if not fit.told:
        why = "one tone cannot tell" if len(heard) == 1 else "these tones cannot tell"
        lines.append(f"{why} G from E: the file's G/E is kept, and assumed known to {100 * KEPT:.0f} %")
    if not fit.weighed:
        lines.append(
            f"the shaft was not weighed: its density is kept as it is, and assumed known to {100 * DENSITY:.0f} %"
        )
    if MOST <= explained(fit) < NEARLY_ALL:
        lines.append("some loud tones are not this shaft's: check that it is the one drawn, and that it hung free")
    if fit.misfit > POOR:
        lines.append(f"the tones fit to {100 * fit.misfit:.2g} % only: check the drawing; errors are widened")
    if foreign := [match.tone for match in fit.matched if match.tone.kind == "tone" and match.mode is None]:
        lines.append(f"not a bending tone of this shaft: {', '.join(f'{tone.frequency:.1f}' for tone in foreign)} Hz")
    if missed := missing(fit):
        lines.append(f"not heard: mode{'s' if len(missed) > 1 else ''} {', '.join(map(str, missed))}")
    if any(match.tone.kind == "twin" for match in fit.matched):
        lines.append("some tones are double: the shaft bends differently in two planes; their means are used")
    if rate is not None and not wrong_rate(fit):
        lines.append(other_rate(fit, rate))
    return lines


def unlike(wood: Material, before: Material) -> list[str]:
    """Which of E, G and rho lie far outside the table's ranges for materials like the file's, one line each.

    If the file's material is a wood, it is compared with all woods; otherwise with those entries whose widened ranges
    hold its E, G and rho. If there is no such entry, nothing is refused. A range is widened by its own width, at most
    by the factor `WIDEST`: the ranges of the density and E of woods are one standard deviation to either side, and
    become three.
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
    """Smallest and largest shear coefficient of the sections that are made of this material."""
    coefficients = []
    for segment in cue.segments:
        if segment.material != wood and segment.core != wood:
            continue
        if segment.kappa is not None:
            coefficients.append(segment.kappa)
        elif segment.material != wood:
            coefficients.append(float(shear_coefficient(wood.effective_poisson_ratio)))
        else:
            ends = (segment.tip_bore / segment.tip_diameter, segment.butt_bore / segment.butt_diameter)
            coefficients += [float(shear_coefficient(wood.effective_poisson_ratio, np.array(ratio))) for ratio in ends]
    return min(coefficients), max(coefficients)
