"""The kinds of contact, and which of them a scene's terms ask for."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cuefem.beam.tip import TipModes
from cuefem.contact.linear import Exact
from cuefem.contact.phases import Kind
from cuefem.contact.ringing_tip import RINGING
from cuefem.contact.state import Laws
from cuefem.effects.terms import ContactTerms
from cuefem.quantity import scalar
from cuefem.scene import Scene

if TYPE_CHECKING:
    from cuefem.contact.turns import Turns


def contact_of(
    scene: Scene, tip: TipModes, laws: Laws, terms: ContactTerms | None = None, turns: Turns | None = None
) -> Kind:
    """The cheapest contact that honours the terms of the scene's effects: exact linear phases where it can.

    terms: the scene's, where they are known. turns: what strikes with this cue share, if they do. ValueError for terms
    that no contact honours together: a raised cue turns neither normal nor patch, and its tip gives something back.
    """
    terms = terms or scene.contact_terms
    if terms.tip is not None:
        from cuefem.contact.leather import whole_tip_contact  # loaded when used

        return whole_tip_contact(scene, tip, laws, terms, turns)
    compliance, radius = terms.compliance / laws.stiffness, scalar("Ball.radius", scene.ball.radius)
    if terms.table is None and terms.law is None and not terms.turns:
        if compliance:
            return Exact.of(tip, laws, compliance)
        return Exact.averaged(tip, laws) if 0 < laws.restitution <= RINGING else Exact.of(tip, laws)
    from cuefem.contact.nonlinear import law_of, stepped_contact  # loaded when used: they need a solver

    law, clock = law_of(scene, laws)
    if terms.table is None:
        return stepped_contact(terms, tip, laws, law=law, clock=clock, radius=radius)
    from cuefem.contact.elevation import raised_contact

    if compliance or terms.turns or terms.window is not None:
        raise ValueError("a raised cue (Elevation) takes a tip without give sideways, a fixed normal and a single hit")
    return raised_contact(terms.table, tip, laws, law=law, clock=clock, radius=radius)
