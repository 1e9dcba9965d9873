"""What strikes with one cue share: how its modes turn between forces, and what forces at its tip make of them.

Neither depends on the stroke. Modes turn as they do whatever the ball and the offset are, and the steps of a contact
(`cuefem.contact.leather`) have lengths that strikes at other speeds have too.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from cuefem.beam.tip import TipModes
from cuefem.contact.state import Contact, Laws, Resistance
from cuefem.cue import Array

if TYPE_CHECKING:
    from cuefem.contact.response import Complex, FreeMotion


class Turns:
    """Of a cue by its tip modes, made when they are first asked for; threads may share one.

    resistance: of the modes. compiled: what the compiled kernel keeps (`cuefem.contact.kernel.leather.Shared`). None
    where no contact has been made yet.
    """

    def __init__(self, tip: TipModes) -> None:
        self.tip = tip
        self.resistance: Resistance | None = None
        self.compiled: Any = None
        self._free: tuple[Complex, Complex, Complex] | None = None

    def contact(self, tip: TipModes, laws: Laws, names: tuple[str, ...]) -> Contact:
        """A contact of this cue; tip: its modes at the place where it touches the tip."""
        found = Contact(tip, laws, names, resistance=self.resistance)
        self.resistance = found.resistance
        return found

    def free(self, contact: Contact, rows: Array) -> FreeMotion:
        """Its free motion; rows: see `FreeMotion`."""
        from cuefem.contact.response import FreeMotion  # loaded when used

        if self._free is None:
            found = FreeMotion.of(contact, rows)
            self._free = found.rates, found.vectors, found.onto
            return found
        return FreeMotion(*self._free, rows)

    def ways(self, contact: Contact) -> Array:
        """What reads the velocities of the tip along and across the cue, and the one at which it turns, from a state.

        (3, size).
        """
        found = np.zeros((3, contact.slots.size))
        found[:, contact.slots.velocities] = [*self.tip.amplitude.T, self.tip.rotation]
        return found


def mixing(phi: float, lever: tuple[float, float]) -> Array:
    """How a contact's rows (t, n, the ball's spin, the tip's turning; `Leather`) read the tip's ways, (4, 3).

    phi: angle of the contact, rad; lever: (u, w) of it per rotation of the tip, m.
    """
    s, c = np.sin(phi), np.cos(phi)
    along, across = np.array([1.0, 0.0, lever[0]]), np.array([0.0, 1.0, lever[1]])
    return np.array([-s * along - c * across, s * across - c * along, np.zeros(3), [0.0, 0.0, -1.0]])
