"""Results of a contact: its phases, force and velocity histories, and the contact state."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import takewhile
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from cuefem.cue import Array
from cuefem.quantity.equality import equal_fields
from cuefem.scene import Outcome

# Shares of the normal impulse during slip. Gross slip: above the first. Miscue: above the second in all, or the third
# without a break up to the end; squirt then grows fast. Both are needed: a bare tip that slips through the first 79 %
# and then sticks squirts 20 % more than closer to the centre (after 46 % hardly more), and leather that slips through
# the last 39 % squirts 75 % more.
GROSS_SLIP_SHARE, MISCUE_SHARE, MISCUE_SHARE_AT_END = 0.25, 0.5, 1 / 3
# Friction loss over the ball's kinetic energy above which parts of a patch slip through much of the impulse: squirt of
# a leather tip, in proportion to b/R closer to the centre, is then 7 to 15 % above that line and rises fast.
PARTIAL_SLIP_LOSS = 0.05
SLIP_STATES = ("slip", "slip back")
# State of an impact of infinite friction; state and normal phase between separation and a second hit.
IMPACT, SEPARATION = "impulse", ("separated", "free")


class Phase(NamedTuple):
    """One phase of a contact.

    Attributes
    ----------
    state : str
        Friction state: "slip", "stick" or "slip back"; "impulse" for the impact of infinite friction, "separated"
        between two hits. A patch of annuli (`LeatherTip`) slips where all of them slip.
    normal_phase : str
        Normal phase: "load", "unload", or "free" between two hits.
    start, end : float
        Times from first touch, s.
    impulse : tuple of float
        Impulse (t, n) on the ball in this phase, N s, with the signs of `Outcome.impulse`, of which it is a part.
    """

    state: str
    normal_phase: str
    start: float
    end: float
    impulse: tuple[float, float]


@dataclass(frozen=True, eq=False)
class History:
    """Forces and velocities at any time of a contact.

    Call it with times, s, in [0, duration]. It returns a dict of arrays of their shape: "force_t" and "force_n" on the
    ball, N; "velocity_t" and "velocity_n" of the ball against the tip, m/s. ValueError for other times.

    Attributes
    ----------
    force_times : (n + 2,) array
        The first touch, the middles of the steps and the last separation, s.
    forces : (n + 2, 2) array
        (t, n) there, N.
    ends : (n + 1,) array
        The first touch and the ends of the steps, s.
    velocities : (n + 1, 2) array
        (t, n) there, m/s.
    velocity, spin : (3,) array or None
        Of the ball after a raised stroke (`Elevation`): x right, y forward, z up, in m/s and rad/s.

    Examples
    --------
    >>> import cuefem as cf
    >>> outcome = cf.strike(cf.Scene(cf.LumpedCue(0.54, 0.01), stroke=cf.Stroke(offset=0.3)))
    >>> sorted(outcome.history(outcome.duration / 2))
    ['force_n', 'force_t', 'velocity_n', 'velocity_t']
    """

    force_times: Array
    forces: Array
    ends: Array
    velocities: Array
    velocity: Array | None = None
    spin: Array | None = None

    __eq__ = equal_fields
    __hash__ = None  # type: ignore[assignment]

    @property
    def duration(self) -> float:
        """End of the last contact, s."""
        return float(self.ends[-1])

    def __call__(self, time: ArrayLike) -> dict[str, Array]:
        """Interpolate the steps by straight lines."""
        time = np.asarray(time, float)
        if len(self.ends) < 2:
            raise ValueError("History takes times in [0, duration] s; this contact is an impact of zero duration")
        if not np.all((time >= 0) & (time <= self.duration * (1 + 1e-12))):
            raise ValueError(f"History takes times in [0, {self.duration}] s, the contact's; got {time}")
        series = {"force": (self.force_times, self.forces), "velocity": (self.ends, self.velocities)}
        return {
            f"{name}_{axis}": np.asarray(np.interp(time, times, values[:, i]))
            for name, (times, values) in series.items()
            for i, axis in enumerate("tn")
        }


def contact_state(phases: Sequence[Phase], energy: Mapping[str, float]) -> str:
    """The contact state from phases and energies, J: the `regime` of an outcome.

    The tangential force of soft leather builds up slowly, so that it sticks at first touch at every offset and slips
    later.
    """
    state = end_of_first_slip(phases)
    if state not in ("stick", "late stick"):
        return state
    share, share_at_end = _slip_shares(phases)
    if share > MISCUE_SHARE or share_at_end > MISCUE_SHARE_AT_END:
        return "miscue"
    if share > GROSS_SLIP_SHARE:
        return "gross slip"
    slips = energy["friction loss"] > PARTIAL_SLIP_LOSS * (energy["ball translation"] + energy["ball rotation"])
    return "partial slip" if state == "stick" and slips else state


def slips_at_end(outcome: Outcome) -> bool:
    """Whether the tip slips through the last third of the normal impulse: squirt then depends on friction alone."""
    if outcome.duration is None:  # of the impulse solver, which has no phases in time
        return bool(outcome.regime == "miscue")
    return _slip_shares(outcome.phases)[1] > MISCUE_SHARE_AT_END


def _slip_shares(phases: Sequence[Phase]) -> tuple[float, float]:
    """Shares of the normal impulse during slip: in total, and without interruption up to the end."""
    slips = [(phase.state in SLIP_STATES, abs(phase.impulse[1])) for phase in phases]
    total = sum(impulse for _, impulse in slips) or 1.0
    last = takewhile(lambda item: item[0] or item[1] < 1e-3 * total, reversed(slips))
    return sum(impulse for slip, impulse in slips if slip) / total, sum(impulse for _, impulse in last) / total


def end_of_first_slip(phases: Sequence[Phase]) -> str:
    """End of the slip at first touch, as a regime of the impulse solver."""
    first_touch = list(takewhile(lambda phase: phase[:2] != SEPARATION, phases))
    first_other = next((i for i, phase in enumerate(first_touch) if phase.state != "slip"), None)
    if first_other is None:
        return "miscue"
    if first_touch[first_other].state == "slip back":
        return "slip reversal"
    return "stick" if all(phase.normal_phase == "load" for phase in first_touch[: first_other + 1]) else "late stick"
