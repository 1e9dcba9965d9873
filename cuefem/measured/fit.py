"""What a tap test finds: tones and their modes, the wood, and whether to believe it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cuefem.cue import Array, Cue, Material
from cuefem.measured.strings import Note
from cuefem.measured.tones import Tone


@dataclass(frozen=True)
class Matched:
    """A tone and its mode (1 is the lowest), None if it has none. frequency: of that mode in the fitted shaft, Hz."""

    tone: Tone
    mode: int | None
    frequency: float | None


@dataclass(frozen=True)
class TapFit:
    """What a tap tells about a shaft's wood.

    cue: with the fitted wood. frequencies: of its modes, Hz. wood, before: its material, fitted and as the file had
    it. covariance: of (ln E, ln G/E, ln rho), (3, 3). matched: every tone. told: whether the tones determine G;
    otherwise the file's G/E is kept. weighed: whether rho comes from a mass. rivals: other wood that explains the tones
    nearly as well: (E in Pa, odds against it). loss: median loss factor of the tones matched, an upper bound of the
    wood's. misfit: root mean square of the tones' relative distances from their modes, sharp tones counting more.
    notes: what a person should know, one line each. chance: p-value, the share of random sets of tones that a shaft
    would fit as well: small is good (`cuefem.measured.chance`). shear_coefficients: smallest and largest kappa
    along the wood; the tones tell kappa G alone, and G is for these. note: the string or voice that explains the
    tones better than this shaft, if one does (`cuefem.measured.strings`). refusals: reasons not to trust the
    result, one line each; empty for a sound one.
    """

    cue: Cue
    frequencies: Array
    wood: Material
    before: Material
    covariance: Array
    matched: tuple[Matched, ...]
    told: bool
    weighed: bool
    rivals: tuple[tuple[float, float], ...]
    loss: float
    misfit: float
    notes: tuple[str, ...]
    chance: float = 1.0
    shear_coefficients: tuple[float, float] = (0.0, 0.0)
    note: Note | None = None
    refusals: tuple[str, ...] = ()

    @property
    def errors(self) -> tuple[float, float, float]:
        """Standard deviations of E, Pa, G, Pa, and rho, kg/m3."""
        E, r, rho = np.sqrt(np.diag(self.covariance))
        both = np.sqrt(max(E**2 + r**2 + 2 * self.covariance[0, 1], 0.0))
        return self.wood.E * E, self.wood.G * both, self.wood.rho * rho
