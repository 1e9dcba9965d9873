"""What the designer shows of a scene: the numbers of `cuefem end-mass`, `strike` and `modes`, by the same functions.

At once it shows the strike at the scene's own offset, which takes few modes. The stick end mass takes many more; it
follows with the tones and the static stiffness as soon as no newer move waits. Later, while nobody turns a knob, come
the coupled squirt at other offsets, strike by strike, and where end mass lives.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from cuefem.beam.modes import Modes, modes
from cuefem.beam.tip import TipModes
from cuefem.beam.waves import mesh_for
from cuefem.contact.outcome import MISSED, grip_of
from cuefem.contact.strike import strike_modes
from cuefem.cue import Array
from cuefem.design.sensitivity import sensitivity
from cuefem.endmass.definitions import DEFINITIONS
from cuefem.io.ready import ready_cues
from cuefem.report.squirt import two_part_curve
from cuefem.report.strike_table import outcome_record
from cuefem.results.asking import listed
from cuefem.results.closed_forms import pivot_length
from cuefem.results.designs import TONES, OneDesign, at_offset, strikes_at
from cuefem.results.records import Record
from cuefem.results.verdict import verdict_record
from cuefem.scene import Outcome, Resolution, Scene
from cuefem.tip_modes import Solved, default_resolution

FIRST = "stick"  # the definition of the end mass that is computed before the others
CURVE_OFFSETS = tuple(round(0.04 * i, 2) for i in range(1, 21))  # b/R of both curves
MISCUES = 3  # of the coupled curve's points that miscue, one after the other: nothing new comes after them
MOST_DENSITY_MODES = 45  # where end mass lives takes all modes of the mesh: cubic


@dataclass(frozen=True)
class SquirtCurve:
    """Squirt, rad, and natural pivot length, m, against `CURVE_OFFSETS`; nan where it is not known, or not yet."""

    squirt: Array
    pivot_length: Array


class Point(NamedTuple):
    """Squirt, rad, and natural pivot length, m, of the coupled strike at an offset b/R, and how safe it is."""

    offset: float
    squirt: float
    pivot_length: float
    safety: str  # "safe", "slips" or "miscue"


def safety(outcome: Outcome) -> str:
    """How far a stroke is from its limit: "miscue"; "slips" through much of the blow, or at first; or "safe"."""
    grip = grip_of(outcome)
    return "miscue" if grip in MISSED else "safe" if grip == "stick" else "slips"


@dataclass(frozen=True)
class Density:
    """Where the stick end mass of the bare cue lives: kg a metre at x m from the tip; end_mass: the whole, kg.

    from_mass: what the mass there adds; from_stiffness: what the stiffness there adds. Together they integrate to the
    end mass except for the parts of the ball's mass and of the mass along the axis (handbook: Effective end mass).
    """

    x: Array
    from_mass: Array
    from_stiffness: Array
    weights: Array
    end_mass: float


@dataclass(frozen=True)
class Answers:
    """The numbers of a design, SI; those that are not computed yet are missing or None.

    strike: as `outcome_record`, of the coupled strike at the scene's own offset. safety: see `safety`. solved, outcome:
    for what is computed later. end_masses: by definition, None where one has no answer. bending: the lowest bending
    modes. numbers: every listed result, by name. lumped: the impulse solver's curve, with the end mass of a tip that
    sticks at each offset and without effects at the tip. verdict: see `verdict_record`; empty until it is computed.
    """

    scene: Scene
    strike: Record
    solved: Solved
    safety: str
    outcome: Outcome
    end_masses: Mapping[str, float | None] = field(default_factory=dict)
    bending: Modes | None = None
    numbers: Mapping[str, float | None] = field(default_factory=dict)
    lumped: SquirtCurve | None = None
    verdict: Record = field(default_factory=dict)

    @property
    def tip(self) -> TipModes:
        """The tip modes."""
        return self.solved.tip

    @property
    def has_end_mass(self) -> bool:
        """Whether `with_end_mass` has added its numbers."""
        return self.bending is not None

    @property
    def complete(self) -> bool:
        """Whether `completed` has added the slower numbers."""
        return self.lumped is not None

    @property
    def frequencies(self) -> Array:
        """The lowest bending frequencies, Hz; none if they are not computed yet."""
        return self.bending.frequencies if self.bending is not None else np.zeros(0)


def answers(scene: Scene) -> Answers:
    """The numbers of one strike, for a cue of segments: all that is computed before they are shown."""
    _ = scene.shaft  # ValueError for a lumped cue
    solved = Solved(scene)
    outcome = strike_modes(scene, solved.tip)
    record, small = outcome_record(outcome, scene), replace(outcome, history=None)
    numbers = listed(OneDesign(solved, small), at_once=True)
    return Answers(scene, record, solved.without_spectra(), safety(outcome), small, numbers=numbers)


def with_end_mass(known: Answers) -> Answers:
    """The numbers with the stick end mass, the tones, and every listed result."""
    scene, cue = known.scene, known.scene.shaft
    first = _end_mass(FIRST, known.solved)
    return replace(
        known,
        solved=known.solved.without_spectra(),
        end_masses={FIRST: first},
        bending=modes(cue, TONES, effects=scene.cue_effects),
        numbers=listed(OneDesign(known.solved, known.outcome)),
    )


def completing(known: Answers) -> Iterator[Answers]:
    """The numbers with the verdict, one more definition of the end mass each time, and at last the lumped curve."""
    if not known.verdict:
        known = replace(known, verdict=verdict_record(known.scene, known.outcome, ready_cues(), solved=known.solved))
        yield known
    for drive in DEFINITIONS:
        if drive not in known.end_masses:
            known = replace(known, end_masses={**known.end_masses, drive: _end_mass(drive, known.solved)})
            yield known
    yield replace(known, lumped=lumped_curve(known.solved))


def completed(known: Answers) -> Answers:
    """The numbers with all definitions of the end mass, and the lumped curve."""
    *_, whole = completing(known)
    return whole


def _end_mass(drive: str, solved: Solved) -> float | None:
    try:
        return float(DEFINITIONS[drive].of_solved(solved))
    except ValueError:
        return None


def lumped_curve(solved: Solved) -> SquirtCurve:
    """The impulse solver's curve, with the cue lumped at each offset; nan if no lumped cue has that squirt."""
    curve = two_part_curve(solved, CURVE_OFFSETS)
    return SquirtCurve(curve["squirt"], curve["pivot_length"])


def coupled_points(known: Answers) -> Iterator[Point]:
    """The coupled strike offset by offset, each computed when it is asked for; it ends well beyond the miscue."""
    missed = 0
    for offset, outcome in zip(CURVE_OFFSETS, strikes_at(known.scene, CURVE_OFFSETS, known.tip), strict=True):
        pivot = pivot_length(at_offset(known.scene, offset), outcome.squirt)
        yield Point(offset, outcome.squirt, float(pivot), safety(outcome))
        missed = missed + 1 if outcome.regime == "miscue" else 0
        if missed == MISCUES:
            return


def curve_of(points: Sequence[Point]) -> SquirtCurve:
    """The curve through points at the first of `CURVE_OFFSETS`."""
    squirt, pivot = np.full(len(CURVE_OFFSETS), np.nan), np.full(len(CURVE_OFFSETS), np.nan)
    squirt[: len(points)] = [point.squirt for point in points]
    pivot[: len(points)] = [point.pivot_length for point in points]
    return SquirtCurve(squirt, pivot)


def density(scene: Scene) -> Density:
    """Where the stick end mass of the cue lives, without the scene's effects."""
    bare = replace(scene, effects=())
    at = default_resolution(bare)
    if at.modes > MOST_DENSITY_MODES:
        at = Resolution(*mesh_for(bare.shaft, MOST_DENSITY_MODES), MOST_DENSITY_MODES)
    effect = sensitivity(bare, at)
    section = bare.shaft.section(effect.x)
    return Density(
        x=effect.x,
        from_mass=effect.rhoA * section.rhoA + effect.rhoI * section.rhoI,
        from_stiffness=effect.EI * section.EI + effect.kGA * section.kGA,
        weights=effect.weights,
        end_mass=effect.end_mass,
    )


NOTES = ("C", "C♯", "D", "D♯", "E", "F", "F♯", "G", "G♯", "A", "A♯", "B")


def note(frequency: float) -> str:
    """The nearest note of a frequency, Hz, and how many cents it lies from that: "A4 +12"; A4 is 440 Hz."""
    steps = 12 * math.log2(frequency / 440)
    nearest = round(steps)
    octave, name = divmod(nearest + 57, 12)
    return f"{NOTES[name]}{octave} {round(100 * (steps - nearest)):+d}".replace("-", "−")
