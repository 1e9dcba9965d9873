"""The tail: a few vectors that stand for the modes left out of a sum.

A plain sum over the lowest n modes converges only like 1/n to n^-1.3, because the modes left out also give way under
the force at the tip and carry waves away from it. A tail of a few Ritz vectors on a dashpot does both. With the same
number of modes the error of a strike falls ten to a thousand times.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cuefem.cue import Array

# Number of Lanczos steps, and the dashpot in units of 1/(the highest frequency kept). Measured: one step is up to
# thirty times worse and three are no better; any dashpot from 0.35 to 1.5 changes errors by less than a factor of two.
STEPS, DASHPOT = 2, 0.5


class Tail(NamedTuple):
    """k vectors: their angular frequencies (k,), how they are mixed from the modes left out, mass-normalised, (modes,
    k), and their radiation (k, k), 1/s (see `TipModes`)."""

    omega: Array
    mix: Array
    radiation: Array


def tail(mu: Array, felt: Array, *, shift: float, highest: float) -> Tail:
    """Tail of the modes left out, from their mu = 1/(omega^2 + shift), descending, and what the loads feel of them.

    felt: (modes, loads), the loads' shares in the modes, with q' (K + shift M) q = 1. Their flexibility, as each load
    feels it, by `STEPS` steps of Lanczos from the static deflections, which match its first moments in mu. The chain
    ends in a dashpot, as the matching end of a line does: waves above the ``highest`` frequency kept, rad/s, leave the
    tip and do not come back; without it the end would ring.
    """
    weights = mu[:, None]
    basis = np.linalg.qr(np.concatenate([weights**step * felt for step in range(STEPS)], axis=1))[0]
    t, mix = np.linalg.eigh(basis.T @ (weights * basis))
    t, mix = t[::-1], (mix / np.sqrt(t))[:, ::-1]
    ends = mix[-felt.shape[1] :]
    return Tail(np.sqrt(1 / t - shift), basis @ mix, DASHPOT / highest * (ends.T @ ends))
