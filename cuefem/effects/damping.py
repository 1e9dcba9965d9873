"""The damping of the modes from the loss factors of a cue's materials."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from cuefem.beam.assembly import Points
from cuefem.beam.axial_modes import RodModes
from cuefem.beam.modes import Modes
from cuefem.beam.tip_modes import TipModes
from cuefem.cue import Array, Cue, Section, Segment
from cuefem.cue.geometry import SegmentRows, section_properties


def damp_tip_modes(tip: TipModes, families: Sequence[tuple[Cue, Modes | RodModes]], *, loss: float | None) -> TipModes:
    """Tip modes with the loss factor eta_k of each vibrating mode k, which is damped at the rate eta_k omega_k.

    families: the vibrating modes of the tip, one family after the other, each with its cue. loss: loss factor used for
    every material instead of its own.
    """
    factors = np.concatenate([family.loss_factors(section_loss(cue, family.points, loss)) for cue, family in families])
    of_modes = np.pad(factors, (len(tip.omega) - len(factors), 0))  # rigid-body modes come first and have no loss
    together = tip.loss + of_modes
    if together.max(initial=0.0) >= 1:
        raise ValueError(
            "StructuralDamping: the loss factors of all such effects must add up to less than 1; got "
            f"{together.max():.4g} in a mode"
        )
    return replace(tip, loss=together)


def section_loss(cue: Cue, points: Points, loss: float | None) -> Section:
    """Loss factor of each stiffness of the section at the Gauss points, (points,), shell and core together.

    A loss factor is the imaginary part of a modulus over its real part, and the stiffnesses are linear in the moduli.
    The result is therefore the section with every modulus multiplied by its loss factor, over the elastic section.
    """
    rows = np.array([_lossy(segment, loss) for segment in cue.segments]).T
    lossy = section_properties(SegmentRows(*rows[:, points.segment]), points.from_segment_end)
    return Section(*(imaginary / real for imaginary, real in zip(lossy, points.section, strict=True)))


def _lossy(segment: Segment, loss: float | None) -> Array:
    """The constants of a segment with every modulus multiplied by its loss factor."""
    shell = segment.material.loss if loss is None else loss
    core = 0.0 if segment.core is None else segment.core.loss if loss is None else loss
    c = SegmentRows(*segment.constants)
    return np.array(c._replace(E=c.E * shell, G=c.G * shell, core_E=c.core_E * core, core_G=c.core_G * core))
