"""Truncation correction: a few Ritz vectors that replace the truncated modes of a sum.

A truncated modal sum over the lowest n modes converges only like 1/n to n^-1.3: the truncated modes also contribute
flexibility under the force at the tip and carry waves away from it. A few Ritz vectors (residual flexibility) on a
dashpot (absorbing termination) do both. With the same number of modes, the error of a strike falls by a factor of 10 to
1000.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cuefem.cue import Array

# Measured: one Lanczos step is up to 30 times worse and three are no better; any dashpot from 0.35 to 1.5 changes
# errors by less than a factor of 2.
LANCZOS_STEPS = 2
TERMINATION_DASHPOT = 0.5  # in units of 1/(the highest retained frequency)


class TruncationCorrection(NamedTuple):
    """Angular frequencies (k,), rad/s, combination of the truncated modes, mass-normalised, (modes, k), and radiation
    (k, k), 1/s (see `TipModes`), of k vectors."""

    omega: Array
    mix: Array
    radiation: Array


def truncation_correction(mu: Array, participation: Array, *, shift: float, cutoff: float) -> TruncationCorrection:
    """Correction for the truncated modes, from their mu = 1/(omega^2 + shift), descending, and their participation.

    participation: (modes, loads), the work of the loads on the modes, with q' (K + shift M) q = 1. `LANCZOS_STEPS`
    Lanczos steps from the static deflections match the first moments of the flexibility in mu. The chain ends in a
    dashpot, like a matched transmission line: waves above the ``cutoff``, the highest retained frequency, rad/s, leave
    the tip without reflection.
    """
    weights = mu[:, None]
    basis = np.linalg.qr(np.concatenate([weights**step * participation for step in range(LANCZOS_STEPS)], axis=1))[0]
    t, mix = np.linalg.eigh(basis.T @ (weights * basis))
    t, mix = t[::-1], (mix / np.sqrt(t))[:, ::-1]
    ends = mix[-participation.shape[1] :]
    return TruncationCorrection(np.sqrt(1 / t - shift), basis @ mix, TERMINATION_DASHPOT / cutoff * (ends.T @ ends))
