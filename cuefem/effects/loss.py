"""Modal damping from the loss factors of a cue's materials."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from cuefem.beam.basis import table
from cuefem.beam.system import System
from cuefem.beam.tip import TipModes
from cuefem.cue import Array, Cue, Section, Segment, SegmentRows, section_properties
from cuefem.effects.base import Vibrations


def damped(tip: TipModes, cue: Cue, families: Sequence[Vibrations], *, loss: float | None) -> TipModes:
    """Tip modes whose vibrating modes, the families' one after the other, lose eta_k omega_k each.

    loss: of every material instead of its own.
    """
    factors = section_loss(cue, families[0].system, loss)
    rates = [family.loss_factors(factors) * family.omega for family in families]
    flexible = np.concatenate(rates)
    diagonal = np.diag(np.concatenate([np.zeros(len(tip.omega) - len(flexible)), flexible]))
    return replace(tip, damping=diagonal if tip.damping is None else tip.damping + diagonal)


def section_loss(cue: Cue, system: System, loss: float | None) -> Section:
    """Loss factor of each of a section's stiffnesses at the Gauss points, (elements, q): shell and core, weighted.

    A loss factor is the imaginary part of a modulus over its real part, and stiffnesses are linear in the moduli: the
    ratio of a section with moduli times loss factors to the elastic one.
    """
    mesh, elastic = system.mesh, system.section
    rows = np.array([_lossy(segment, loss) for segment in cue.segments]).T
    s = mesh.offset[:, None] + mesh.sizes[:, None] * table(mesh.order).points
    lossy = section_properties(SegmentRows(*rows[:, mesh.piece[:, None]]), s)
    return Section(*(part / whole for part, whole in zip(lossy, elastic, strict=True)))


def _lossy(segment: Segment, loss: float | None) -> Array:
    """The segment's constants with moduli times loss factors."""
    shell = segment.material.loss if loss is None else loss
    core = 0.0 if segment.core is None else segment.core.loss if loss is None else loss
    c = SegmentRows(*segment.constants)
    return np.array(c._replace(E=c.E * shell, G=c.G * shell, core_E=c.core_E * core, core_G=c.core_G * core))
