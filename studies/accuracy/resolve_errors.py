"""Do the errors that `resolve` and `resolve_end_mass` promise hold? Measured over three families of random scenes.

What: every rung of the ladder that has an estimate, up to some fifty modes (25 where the contact is stepped in time),
against references of 1.5 and 2 times the modes of the last rung, on another mesh of another order. The true error is
known no better than the two references agree: what they differ by is taken off it before it is divided by the estimate.
The families: resolve_family.py. Left out: lumped cues, which are exact, and accuracies that take more modes than that.
Takes about 20 minutes.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from cuefem import Elevation, PowerLawTip, RollingContact
from cuefem.accuracy import end_mass_ladder, ladder, relative_error
from cuefem.endmass.drives import stick
from studies import pages
from studies.accuracy import resolve_family as family
from studies.strokes import strike_modes

ASKED = (1e-2, 1e-3, 3e-4)
# Rungs go up to so many modes, fewer in a contact that is stepped in time; there are at least so many rungs.
MOST, MOST_STEPPED, FEWEST = 47, 24, 6
STEPPED = (PowerLawTip, RollingContact, Elevation)
EVERY = 3  # of the scenes that are not stepped, each third is asked for its end mass too


class Climb(NamedTuple):
    """The rungs of one scene: modes, estimates, true errors, and how far these are known."""

    number: int
    modes: list[int]
    estimates: list[float]
    errors: list[float]
    known: float

    @property
    def ratios(self) -> list[float]:
        """True error, less what is not known of it, over the estimate, of every rung that has one."""
        return [max(t - self.known, 0) / e for t, e in zip(self.errors, self.estimates, strict=True)]

    def picked(self, rtol: float) -> int | None:
        """Index of the rung that answers an accuracy asked for; None where none does."""
        return next((i for i, estimate in enumerate(self.estimates) if estimate <= rtol), None)


def top(number: int) -> int:
    """The modes from which on the ladder of a scene is not followed."""
    return MOST_STEPPED if any(isinstance(effect, STEPPED) for effect in family.scene(number).effects) else MOST


def strikes(number: int) -> Climb:
    """The rungs of a scene's strike."""
    scene = family.scene(number)
    climbed = []
    for rung in ladder(scene):
        climbed.append(rung)
        if rung.at.modes >= top(number) and len(climbed) >= FEWEST:
            break
    last = climbed[-1].at.modes
    rough, best = (strike_modes(scene, family.reference(scene, round(times * last))) for times in (1.5, 2.0))
    judged = [rung for rung in climbed if rung.outcome.error is not None]
    return Climb(
        number,
        [rung.at.modes for rung in judged],
        [rung.outcome.error for rung in judged],
        [relative_error(rung.outcome, best, scene) for rung in judged],
        relative_error(rough, best, scene),
    )


def end_masses(number: int) -> Climb:
    """The rungs of a scene's stick end mass."""
    scene = family.scene(number)
    climbed = []
    for rung in end_mass_ladder(scene, stick):
        climbed.append(rung)
        if rung[0] >= top(number) and len(climbed) >= FEWEST:
            break
    last = climbed[-1][0]
    rough, best = (float(stick(family.reference(scene, round(times * last)), scene)) for times in (1.5, 2.0))
    judged = [rung for rung in climbed if math.isfinite(rung[2])]
    modes, values, estimates = (list(part) for part in zip(*judged, strict=True))
    return Climb(number, modes, estimates, [abs(value / best - 1) for value in values], abs(rough / best - 1))


def row(climb: Climb) -> list[str]:
    """The row of a scene: what it is, its worst rung, and for each accuracy modes and true error."""
    scene = family.scene(climb.number)
    cells = []
    for rtol in ASKED:
        i = climb.picked(rtol)
        cells.append("-" if i is None else f"{climb.modes[i]} ({climb.errors[i]:.0e})")
    names = ", ".join(type(effect).__name__ for effect in scene.effects) or "none"
    about = [f"{scene.tip.friction:.2f}", f"{scene.tip.restitution:.2f}", f"{1e3 * scene.contact_time:.2f}"]
    return [str(climb.number), names, *about, f"{max(climb.ratios):.2f}", f"{climb.known:.0e}", *cells]


HEAD = ["scene", "effects", "mu", "e", "T, ms", "worst true/estimate", "known to", "modes for 1e-2", "1e-3", "3e-4"]


def summary(climbs: list[Climb], drawn: int) -> list[str]:
    """How well the estimates hold over all rungs, and the accuracies asked for over all scenes of one family."""
    ratios = np.array([ratio for climb in climbs for ratio in climb.ratios])
    lines = [
        f"- {len(climbs)} of {drawn} scenes, {len(ratios)} rungs: true/estimate {np.median(ratios):.2f} at the median, "
        f"above 1 in {100 * np.mean(ratios > 1):.1f} %, above 3 in {np.sum(ratios > 3)}, at most {ratios.max():.1f}"
    ]
    for rtol in ASKED:
        found = [(climb, i) for climb in climbs if (i := climb.picked(rtol)) is not None]
        met = sum(climb.errors[i] - climb.known <= rtol for climb, i in found)
        modes = np.median([climb.modes[i] for climb, i in found]) if found else math.nan
        lines.append(
            f"- {rtol:.0e} asked for: answered within these rungs in {len(found)} scenes, at {modes:.0f} modes at the "
            f"median; met in {met}"
        )
    return lines


FAMILIES = ("The first family:", "The second family:", "The third family, the check:")


def section(title: str, climbs: list[Climb]) -> list[str]:
    """One quantity: how well its estimates hold in each family, and the table of all scenes."""
    climbs = sorted(climbs)
    lines = [f"## {title}\n"]
    for index, (heading, (_, drawn)) in enumerate(zip(FAMILIES, family.FAMILIES, strict=True)):
        found = [climb for climb in climbs if family.family_of(climb.number) == index]
        lines += [f"{heading}\n", *summary(found, drawn), ""]
    return [*lines, str(pages.table(HEAD, [row(climb) for climb in climbs]))]


def report(struck: list[Climb], masses: list[Climb]) -> str:
    """The tables."""
    return "\n".join(
        [
            "# Do the errors that resolve promises hold?\n",
            "Three families of random scenes with every effect (resolve_family.py). The estimates were made on the",
            f"first, of {family.FAMILIES[0][1]} scenes, and mended once on the second; the third is their check.",
            f"Every rung of the ladder up to {MOST} modes ({MOST_STEPPED} where the contact is stepped in time) is",
            "compared with a reference of twice the modes of the last rung, on another mesh of another order.",
            "Columns: the worst true error over its estimate of a scene's rungs; how far its two references (1.5 and 2",
            "times the modes) agree, which is taken off the true errors; the modes of the first rung whose estimate is",
            "below the accuracy asked for, and in brackets its true error; -: no rung up to there promises it.\n",
            *section("Strikes: squirt, ball speed and spin", struck),
            *section("Stick end mass", masses),
        ]
    )


def asked_for_end_mass(number: int) -> bool:
    """Whether the study asks a scene for its end mass."""
    return number % EVERY == 0 and top(number) == MOST


def everything() -> str:
    """The page of all scenes."""
    numbers = range(family.SCENES)
    masses = [end_masses(number) for number in numbers if asked_for_end_mass(number)]
    return report([strikes(number) for number in numbers], masses)


STUDY = pages.Study(
    __file__,
    everything,
    again={
        **{
            f"strikes, scene {k}": pages.Again(
                lambda k=k: pages.row(row(strikes(k))), until="## Stick", left_out=None, heavy=k != 4
            )
            for k in (4, 9, 11, 13, 17)
        },
        "end masses, scene 9": pages.Again(lambda: pages.row(row(end_masses(9))), since="## Stick", left_out=None),
    },
)


if __name__ == "__main__":
    STUDY.write()
