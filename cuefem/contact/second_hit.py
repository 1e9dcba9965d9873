"""What comes after the first contact: cue and ball fly apart, and may touch again (the effect SecondHit)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cuefem.contact.phases import Kind, run
from cuefem.contact.ringing_tip import RINGING
from cuefem.contact.state import APART, Phase
from cuefem.scene import Outcome

# Tip and ball touch if they would overlap by this part of a stroke's length, speed times contact time: a dead tip
# leaves the ball with no relative velocity but rounding.
OVERLAP = 1e-10


class Hit(NamedTuple):
    """One contact of tip and ball: its start and end, s, and the impulse (t, n) on the ball in it, N s."""

    start: float
    end: float
    impulse: tuple[float, float]


def hits(outcome: Outcome) -> tuple[Hit, ...]:
    """List the contacts of a strike, the first one first.

    Parameters
    ----------
    outcome : Outcome
        Of a coupled strike; more than one contact needs the effect `SecondHit`.

    Returns
    -------
    tuple of Hit

    Examples
    --------
    >>> import cuefem as cf
    >>> from cuefem.contact.second_hit import hits
    >>> len(hits(cf.strike(cf.Scene(cf.LumpedCue(0.54, 0.01)))))
    1
    """
    parts: list[list[Phase]] = [[]]
    for phase in outcome.phases:
        if phase[:2] == APART:
            parts.append([])
        else:
            parts[-1].append(phase)
    found = []
    for part in parts:
        p_t, p_n = np.sum([phase.impulse for phase in part], axis=0)
        found.append(Hit(part[0].start, part[-1].end, (float(p_t), float(p_n))))
    return tuple(found)


def follow(kind: Kind, window: float) -> None:
    """Follow cue and ball for ``window``, s, after their separation, and through every contact that begins in it.

    ValueError for a dead or nearly dead tip: it would come back with the whole force of its peak at once, and chatter
    without end.
    """
    contact, laws = kind.contact, kind.contact.laws
    if laws.restitution <= RINGING:
        raise ValueError(f"SecondHit takes a Tip.restitution in ({RINGING:g}, 1]; got {laws.restitution}")
    until, near = contact.time + window, OVERLAP * laws.speed * laws.time
    start = contact.time
    while contact.time < until and kind.fly(until, near):  # a contact may end after the window: no flight back in time
        kind.longest += contact.time - start
        run(kind, "unload")
        start = contact.time
