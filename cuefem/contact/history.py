"""Forces and velocities of a contact at any time of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from cuefem.contact.flow import ORDERS, Piece
from cuefem.contact.marched import Marched
from cuefem.contact.marched import Piece as Marching
from cuefem.contact.stretches import Stepping
from cuefem.cue import Array

# The outputs of every phase, in this order.
V_T, V_N, F_N, F_T = range(4)


@dataclass(frozen=True)
class History:
    """Forces and velocities at any time of a contact, without stepping error.

    Call it with times, s, in [0, duration]. It returns a dict of arrays of their shape: "force_t" and "force_n" on the
    ball, N; "velocity_t" and "velocity_n" of the ball against the tip, m/s. ValueError for other times.

    Examples
    --------
    >>> import cuefem as cf
    >>> outcome = cf.strike(cf.Scene(cf.LumpedCue(0.54, 0.01), stroke=cf.Stroke(offset=0.3)))
    >>> sorted(outcome.history(outcome.duration / 2))
    ['force_n', 'force_t', 'velocity_n', 'velocity_t']
    """

    pieces: tuple[Piece, ...]
    mirror: float

    def __call__(self, time: ArrayLike) -> dict[str, Array]:
        """Evaluate the Taylor polynomials of the cells the times fall in."""
        time, which = _places(time, self.pieces)
        values = np.empty((4, *time.shape))
        for i in set(which.ravel().tolist()):
            here, piece = which == i, self.pieces[i]
            ends = piece.ends
            cell = np.minimum(np.searchsorted(ends, time[here], side="right"), len(ends) - 1)
            place = 1 + (time[here] - ends[cell]) / piece.lengths[cell]
            own = piece.coefficients[:4].transpose(2, 0, 1)[cell]  # (times, outputs, terms)
            values[:, here] = np.einsum("tok,tk->ot", own, np.vander(place, len(ORDERS), increasing=True))
        return _named(values, self.mirror)


@dataclass(frozen=True)
class SteppedHistory:
    """What `History` gives, for a contact that was stepped in time; accurate to the interpolants, about 1e-9."""

    stretches: tuple[Stepping, ...]
    mirror: float

    def __call__(self, time: ArrayLike) -> dict[str, Array]:
        """Evaluate the interpolants of the phases the times fall in."""
        time, which = _places(time, self.stretches)
        values = [self.stretches[int(i)].outputs(t) for i, t in zip(which.ravel(), time.ravel(), strict=True)]
        return _named(np.array(values).reshape(-1, 4).T.reshape(4, *time.shape), self.mirror)


@dataclass(frozen=True)
class MarchedHistory:
    """What `History` gives, for a contact stepped with the exact turns of its modes; accurate to about 1e-9.

    marches: gives the phases and flights, whose steps nobody may ask for.
    """

    marches: Callable[[], Sequence[Marched]]
    mirror: float

    @cached_property
    def pieces(self) -> tuple[Marching, ...]:
        """The steps."""
        return tuple(chain.from_iterable(each.pieces for each in self.marches()))

    def __call__(self, time: ArrayLike) -> dict[str, Array]:
        """Evaluate the polynomials of the steps the times fall in."""
        time, which = _places(time, self.pieces)
        values = np.empty((4, *time.shape))
        for i in set(which.ravel().tolist()):
            here = which == i
            values[:, here] = self.pieces[i].outputs(time[here])
        return _named(values, self.mirror)


AnyHistory = History | SteppedHistory | MarchedHistory


def _places(time: ArrayLike, parts: Sequence[Piece] | Sequence[Stepping] | Sequence[Marching]) -> tuple[Array, Any]:
    """Times as an array, and the index of the part that each falls in."""
    time = np.asarray(time, float)
    if not parts:
        raise ValueError("History takes times in [0, duration] s; this contact is a blow, without any")
    end = parts[-1].end
    if not np.all((time >= 0) & (time <= end * (1 + 1e-12))):
        raise ValueError(f"History takes times in [0, {end}] s, the contact's; got {time}")
    return time, np.asarray(np.searchsorted([part.start for part in parts], time, side="right") - 1)


def _named(values: Array, mirror: float) -> dict[str, Array]:
    """The first four outputs by name; mirror: -1 for a stroke on the other side."""
    names = {"force_t": F_T, "force_n": F_N, "velocity_t": V_T, "velocity_n": V_N}
    return {name: values[row] * (mirror if name[-1] == "t" else 1.0) for name, row in names.items()}
