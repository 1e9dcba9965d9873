"""Which bending mode each tone is: hypotheses about a shaft's wood, weighed by how well they explain the tones heard.

A hypothesis is E and G/E of the wood; every pair of a tone and a mode proposes some. Under a hypothesis each tone
either belongs to a mode, within `TOLERANCE`, or is wrong and may lie anywhere in the band, and every mode below the
highest one heard that was not heard counts a little against it. So neither a missing mode nor a wrong tone shifts the
numbers of the others, as it would if modes were counted upwards.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.interpolate import RectBivariateSpline

from cuefem.beam.modes import modes
from cuefem.cue import Array, Cue, Material
from cuefem.measured.tones import HIGH, LOW, Tone
from cuefem.parts import with_material

MODES = 24
FACTOR = 3.0  # E of the wood lies within this factor of the file's
RATIOS = (1 / 45, 1 / 2.3)  # of G/E: woods 1/16 to 1/9, tubes of carbon fibre to 1/2.5
TOLERANCE = 4e-3  # relative, of a tone against its mode: beam, drawing and grain
WRONG, DOUBTFUL = 0.05, 0.5  # chances that a tone, or one that is a multiple of a louder one, is no mode
UNHEARD = 0.3  # chance that the recording misses a mode
TWICE = 6.0  # ln of the odds against two tones on one mode: one of them is wrong
SPREADS = (0.5, 0.5)  # of ln E and ln G/E about the file's, standard deviations before anything is heard
REFINED = 20  # hypotheses
RIVAL = np.log(20)  # a hypothesis whose odds are better than 1 : 20 is not ruled out
SAME = 0.02  # relative: hypotheses whose E is closer are one


@dataclass(frozen=True)
class Shaft:
    """A cue whose wood is sought. wood: as the file has it. effects: what stays on the cue while it hangs."""

    cue: Cue
    wood: Material
    effects: tuple[Any, ...] = ()

    def of(self, E: float, ratio: float, rho: float) -> Cue:
        """The cue with other wood; ratio: G/E."""
        return with_material(self.cue, self.wood, replace(self.wood, E=E, G=ratio * E, rho=rho))

    def log_frequencies(self, theta: Array) -> Array:
        """ln of the `MODES` lowest frequencies, Hz, at theta = (ln E, ln G/E, ln rho)."""
        return np.asarray(np.log(modes(self.of(*np.exp(theta)), MODES, effects=self.effects).frequencies))

    @property
    def start(self) -> Array:
        """(ln E, ln G/E, ln rho) of the file."""
        return np.log([self.wood.E, self.wood.G / self.wood.E, self.wood.rho])

    @property
    def ratios(self) -> tuple[float, float]:
        """Bounds of ln G/E: `RATIOS`, and no higher than the wood's Poisson ratio allows (`Material`)."""
        top = min(RATIOS[1], 0.95 / (2 * self.wood.nu)) if self.wood.nu else RATIOS[1]
        return float(np.log(RATIOS[0])), float(np.log(top))


@dataclass(frozen=True)
class Hypothesis:
    """theta: (ln E, ln G/E). modes: the mode of each tone, 0 is the lowest, -1 means none. score: ln of its weight."""

    theta: Array
    modes: tuple[int, ...]
    score: float


class ModeTable:
    """Frequencies of a shaft's modes over E and G/E, for the search: splines, good to about 1e-3.

    rho: of the wood, kg/m3. Cost: 27 solutions of the shaft's modes.
    """

    def __init__(self, shaft: Shaft, rho: float) -> None:
        self.shaft = shaft
        self.E = shaft.start[0] + np.linspace(-1, 1, 3) * np.log(FACTOR)
        self.ratio = np.linspace(*shaft.ratios, 9)
        pairs = itertools.product(self.E, self.ratio)
        values = np.array([shaft.log_frequencies(np.array([E, r, np.log(rho)])) for E, r in pairs])
        grid = values.reshape(len(self.E), len(self.ratio), MODES)
        self.splines = [RectBivariateSpline(self.E, self.ratio, grid[..., k], kx=2, ky=3) for k in range(MODES)]

    def log_frequencies(self, E: Array, ratio: Array, *, dE: int = 0, dratio: int = 0) -> Array:
        """ln of the frequencies at ln E, ln G/E, arrays (n,), or a derivative of it: (n, modes)."""
        return np.array([spline(E, ratio, dx=dE, dy=dratio, grid=False) for spline in self.splines]).T

    def hypotheses(self, tones: Sequence[Tone]) -> list[Hypothesis]:
        """Hypotheses that explain a tone or more, the best first, no two of the same E."""
        heard = np.log([tone.frequency for tone in tones])
        wrong = chances_of_no_mode(tones)
        ratios = np.linspace(*self.shaft.ratios, 41)
        proposed = np.concatenate([self._proposed(heard, r) for r in ratios])
        scores = self._scores(proposed, heard, wrong, 3 * TOLERANCE)
        best: dict[tuple[int, ...], Hypothesis] = {}
        for theta in self._unlike(proposed[np.argsort(-scores)[:200]], heard):
            refined = self._refined(theta, heard, wrong)
            if max(refined.modes) < 0:
                continue
            if refined.modes not in best or best[refined.modes].score < refined.score:
                best[refined.modes] = refined
        apart: list[Hypothesis] = []
        for hypothesis in sorted(best.values(), key=lambda h: -h.score):
            if all(abs(hypothesis.theta[0] - other.theta[0]) > SAME for other in apart):
                apart.append(hypothesis)
        return apart

    def _unlike(self, proposed: Array, heard: Array) -> list[Array]:
        """The first `REFINED` of the hypotheses (n, 2) that differ in the mode of some tone."""
        f = self.log_frequencies(*proposed.T)
        first: dict[tuple[int, ...], Array] = {}
        for theta, row in zip(proposed, f, strict=True):
            first.setdefault(tuple(map(int, assigned(heard, row, 4 * TOLERANCE))), theta)
        return list(first.values())[:REFINED]

    def _proposed(self, heard: Array, ratio: float) -> Array:
        """(ln E, ln G/E) that put one tone on one mode, (n, 2)."""
        start = self.shaft.start[0]
        own = self.log_frequencies(np.array([start]), np.array([ratio]))[0]
        E = start + 2 * (heard[:, None] - own).ravel()
        E = E[np.abs(E - start) <= np.log(FACTOR)]
        return np.column_stack([E, np.full(len(E), ratio)])

    def _scores(self, theta: Array, heard: Array, wrong: Array, tolerance: float) -> Array:
        """ln of the weight of every hypothesis (n, 2): tones explained, modes unheard, what is known of wood."""
        known = ((theta - self.shaft.start[:2]) / SPREADS) ** 2
        return weighed(self.log_frequencies(*theta.T), heard, wrong, tolerance) - known.sum(axis=1) / 2

    def _refined(self, theta: Array, heard: Array, wrong: Array) -> Hypothesis:
        """The hypothesis where its own tones fit best, and which tones those are."""
        low, high = [self.E[0], self.ratio[0]], [self.E[-1], self.ratio[-1]]
        for width in (4 * TOLERANCE, 4 * TOLERANCE, 3 * TOLERANCE, 3 * TOLERANCE):
            E, r = theta[:1], theta[1:]
            f = self.log_frequencies(E, r)[0]
            own = assigned(heard, f, width)
            here = own >= 0
            J = np.column_stack([self.log_frequencies(E, r, **d)[0] for d in ({"dE": 1}, {"dratio": 1})])[own[here]]
            rows = np.vstack([J / TOLERANCE, np.diag(1 / np.array(SPREADS))])
            right = np.concatenate([(heard - f[own])[here] / TOLERANCE, (self.shaft.start[:2] - theta) / SPREADS])
            theta = np.clip(theta + np.linalg.lstsq(rows, right)[0], low, high)
        own = assigned(heard, self.log_frequencies(theta[:1], theta[1:])[0], 3 * TOLERANCE)
        score = float(self._scores(theta[None], heard, wrong, TOLERANCE)[0])
        return Hypothesis(theta, tuple(map(int, own)), score)


def assigned(heard: Array, f: Array, width: float | Array) -> Array:
    """The mode of each tone: the nearest within ``width`` (in ln f) that no nearer tone has, or -1."""
    gaps = np.abs(heard[:, None] - f)
    own, width = np.full(len(heard), -1), np.broadcast_to(width, len(heard))
    for i in np.argsort(gaps.min(axis=1)):
        mode = int(gaps[i].argmin())
        if gaps[i, mode] <= width[i] and mode not in own:
            own[i] = mode
    return own


def chances_of_no_mode(tones: Sequence[Tone]) -> Array:
    """The chance of each tone to belong to no mode."""
    return np.array([DOUBTFUL if tone.kind == "harmonic" else WRONG for tone in tones])


def weighed(f: Array, heard: Array, wrong: Array, tolerance: float) -> Array:
    """ln of the weight of every body (n,) with tones f, ln Hz, (n, modes): tones explained, and modes unheard."""
    gaps = np.abs(heard[:, None] - f[:, None, :])  # (n, tones, modes)
    nearest, gap = gaps.argmin(axis=2), gaps.min(axis=2)
    audible = ((f > np.log(LOW)) & (f < np.log(HIGH))).sum(axis=1)
    density = -((gap / tolerance) ** 2) / 2 - np.log(tolerance * np.sqrt(2 * np.pi) * np.maximum(audible, 1))[:, None]
    own, none = density + np.log1p(-wrong), np.log(wrong / np.log(HIGH / LOW))
    explained = own > none
    used = np.zeros(f.shape, bool)
    rows = np.arange(len(f))[:, None]
    used[np.broadcast_to(rows, nearest.shape)[explained], nearest[explained]] = True
    top = np.where(used, f, -np.inf).max(axis=1)
    unheard = ((f > np.log(LOW)) & (f < top[:, None]) & ~used).sum(axis=1)
    twice = explained.sum(axis=1) - used.sum(axis=1)
    return np.asarray(np.maximum(own, none).sum(axis=1) + unheard * np.log(UNHEARD) - TWICE * twice)
