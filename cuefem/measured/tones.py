"""The tones of a ringing body: damped sinusoids in noise, each with its frequency, decay and uncertainties.

x(t) = sum over k of exp(-a_k t) (p_k cos w_k t + q_k sin w_k t) + noise, the same w_k, a_k in every trace. Tones are
found in the spectrum of what is not yet explained, under exponential windows (a damped tone's matched filter), and all
are fitted together by variable projection (Golub & Pereyra, SIAM J. Numer. Anal. 10 (1973) 413, with Kaufman's
Jacobian) in the Fourier transform, where the noise is weighted as loud as it is. In white noise that is the maximum of
the likelihood, so the covariance is the bound of Cramer and Rao.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations_with_replacement, pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.signal import find_peaks
from scipy.special import gammainccinv

from cuefem.cue import Array
from cuefem.measured.ringing import Ringing

Complex = NDArray[np.complex128]

LOW, HIGH = 60.0, 8000.0  # Hz: what a phone hears of a shaft
LOWEST = 15.0  # Hz: tones below `LOW` are fitted too, so that their flanks bias no other tone, but not reported
WINDOWS = (3.0, 12.0, 50.0, 200.0)  # 1/s, decays of the matched filters: a factor of four loses 0.5 dB
FALSE_ALARM = 1e-8  # of a bin under a window; a recording has 1e5 of them
BLOCK = (100.0, 0.35)  # Hz and of the frequency: over either, whichever is wider, the noise is taken to be level
DEEPEST = 1e-11  # of the loudest bin: no recording is quieter, 16 bits are 1e-10
QUIET = 0.2  # quantile of a block's power: less of the tones is in it than in the median
MOST = 40
VAGUE = 3e-3  # a tone with a larger relative error than this does not tell a mode's frequency
STEPS, ROUGH = 12, 3  # steps of the last fit; of those between which more tones are sought
SMALL = 1e-2  # gain of a step in squared standard deviations; the next one is far smaller
FEWEST = 30  # bins of a block of noise
PIECE = 1024  # bins that are summed at a time: they stay in the cache
SLOWEST, FASTEST = 0.01, 0.1  # decay, 1/s; decay over angular frequency
LOSSY = 0.15  # loss factor above which it is no tone but fills a gap of the model
STEADY = 0.5  # 1/s: what decays more slowly is a hum and no struck body
NEAR, SHADOW = 0.03, 0.05  # relative: a peak so near a stronger tone, below this part of its amplitude, is its shadow
HARMONICS = (2, 3, 4, 5, 7)
LOUD = 4  # how many of the loudest tones may add up to another one
WEAKER = 0.35  # a square wave's third harmonic has a third of its amplitude
CLOCK = 5e-5  # relative, of a phone's sampling rate
FAINT = 2.0  # times the smallest amplitude of a tone: below it, two overlapping tones could not be told from one


@dataclass(frozen=True)
class Tone:
    """One tone. frequency: of the undamped body, Hz; error: its standard deviation, Hz, `CLOCK` included.

    decay: of the amplitude, 1/s, and decay_error. level: amplitude at the start, all traces together, in the
    recording's units. snr: that over its standard deviation. kind: "tone"; "faint" (two overlapping tones could not be
    told from it, so its error includes the width of its line); "steady" (a hum); "harmonic" (a multiple or a sum of
    louder ones, as clipping makes); "twin" (the weaker tone of two planes of bending; the error of the stronger one
    includes their distance).
    """

    frequency: float
    error: float
    decay: float
    decay_error: float
    level: float
    snr: float
    kind: str = "tone"

    @property
    def loss(self) -> float:
        """Loss factor, 2 decay over angular frequency."""
        return self.decay / (np.pi * self.frequency)


def tones(heard: Ringing) -> tuple[Tone, ...]:
    """All tones between `LOW` and `HIGH`, in ascending order. RuntimeError if none of them decays.

    Cost: a few matrix products of (bins x tones^2); under a second for a second of sound.
    """
    spectrum = _Spectrum.of(heard)
    w, a = np.empty(0), np.empty(0)
    for _ in range(MOST):
        more = spectrum.unexplained(w, a)
        if not len(more) or len(w) >= MOST:
            break
        w, a = spectrum.fitted(np.concatenate([w, more.real]), np.concatenate([a, more.imag]), steps=ROUGH)
    if len(w):
        w, a = spectrum.fitted(w, a)
    ascending = sorted(spectrum.tones(w, a), key=lambda tone: tone.frequency)
    kinds = _harmonics(_twins(ascending))
    if not any(tone.kind == "tone" for tone in kinds):
        raise RuntimeError(f"a recording must hold a decaying tone between {LOW:g} and {HIGH:g} Hz; got none")
    return tuple(kinds)


@dataclass(frozen=True)
class _Spectrum:
    """Fourier transform of the traces in the band.

    omega: (bins,), rad/s. X: (traces, bins). turn: exp(-i omega) a sample. bins, blocks: indices of the band in the
    whole transform, bounds of blocks of even noise. size: samples.
    """

    omega: Array
    X: Complex
    turn: Complex
    bins: NDArray[np.intp]
    blocks: NDArray[np.intp]
    size: int
    rate: float

    @classmethod
    def of(cls, heard: Ringing) -> _Spectrum:
        size = heard.traces.shape[1]
        frequencies = np.asarray(np.fft.rfftfreq(size, 1 / heard.rate), float)
        bins = np.flatnonzero((frequencies > 0) & (frequencies <= min(1.1 * HIGH, 0.48 * heard.rate)))
        X = np.fft.rfft(heard.traces)[:, bins]
        omega = 2 * np.pi * frequencies[bins]
        return cls(omega, X, np.exp(-1j * omega / heard.rate), bins, _blocks(frequencies[bins]), size, heard.rate)

    def unexplained(self, w: Array, a: Array) -> Complex:
        """Peaks that stand out of the residual of the tones (w, a), as w + i a; of near ones the strongest."""
        residual = self.X - self._explained(w, a)[0]
        whole = np.zeros((len(self.X), self.size // 2 + 1), complex)
        whole[:, self.bins] = residual
        sound, time = np.fft.irfft(whole, self.size), np.arange(self.size) / self.rate
        level = self._level(np.abs(residual) ** 2)
        peaks: list[tuple[float, float, complex]] = []
        for decay in WINDOWS:
            window = np.exp(-decay * time)
            power = np.abs(np.fft.rfft(sound * window)[:, self.bins]) ** 2
            score = (power / level).sum(axis=0) / np.mean(window**2)
            at, _ = find_peaks(score, height=gammainccinv(len(self.X), FALSE_ALARM))
            # exp(-2 decay t)/2 of the amplitude is what a window of the tone's own decay sums
            sizes = 4 * decay / self.rate * np.sqrt(power[:, at].sum(axis=0))
            peaks += [
                (float(score[i]), float(A), complex(self.omega[i], decay)) for i, A in zip(at, sizes, strict=True)
            ]
        return self._apart(sorted(peaks, key=lambda peak: -peak[0]), w, a)

    def _apart(self, peaks: list[tuple[float, float, complex]], w: Array, a: Array) -> Complex:
        """Places of the peaks (score, amplitude, place) that are no flank of a stronger peak nor shadow of a tone."""
        apart: list[complex] = []
        level = self._amplitudes(w, a)
        for _, amplitude, peak in peaks:
            f, far = peak.real, np.abs(w - peak.real)
            if not 2 * np.pi * LOWEST <= f <= 2 * np.pi * HIGH or len(apart) + len(w) >= MOST:
                continue
            close = far < NEAR * w + 2 * a
            shadow = close.any() and (amplitude < SHADOW * level[close].max() or far.min() < 1e-3 * f)
            if not shadow and all(abs(f - k.real) >= NEAR * k.real + 4 * k.imag for k in apart):
                apart.append(peak)
        return np.array(apart, complex)

    def _level(self, power: Array) -> Array:
        """Mean power of the noise at every bin, (traces, bins), from the quiet bins of blocks: exponential there."""
        bounds = self.blocks
        quiet = [np.quantile(power[:, i:j], QUIET, axis=1) for i, j in pairwise(bounds)]
        floor = np.maximum(np.array(quiet).T / -np.log1p(-QUIET), DEEPEST * power.max() + np.finfo(float).tiny)
        middles = (bounds[:-1] + bounds[1:]) / 2
        return np.array([np.exp(np.interp(np.arange(len(self.omega)), middles, np.log(row))) for row in floor])

    def _basis(self, w: Array, a: Array) -> Complex:
        """Transforms of exp(-at) cos, exp(-at) sin and of t times both: (4, tones, bins)."""
        plus, plus_t = self._geometric(w, a)
        minus, minus_t = self._geometric(-w, a)
        return np.array([(plus + minus) / 2, (plus - minus) / 2j, (plus_t + minus_t) / 2, (plus_t - minus_t) / 2j])

    def _geometric(self, w: Array, a: Array) -> tuple[Complex, Complex]:
        """Sums over the samples of z^n and n z^n / rate with z = exp((-a + i w - i omega)/rate)."""
        s, n = (-a + 1j * w)[:, None] / self.rate, self.size
        z, last = np.exp(s) * self.turn, np.exp(n * s)  # exp(-i omega n/rate) = 1 at every bin
        over = 1 / (1 - z)
        whole = (1 - last) * over
        return whole, (z * whole - n * last) * over / self.rate

    def _explained(self, w: Array, a: Array) -> tuple[Complex, Array, Array]:
        """(model, p and q (traces, 2 tones), noise as the residual's power) of tones as they stand."""
        noise = self._level(np.abs(self.X) ** 2)
        if not len(w):
            return np.zeros_like(self.X), np.zeros((len(self.X), 0)), noise
        basis = self._basis(w, a)[:2].reshape(2 * len(w), -1)
        for _ in range(2):  # the noise from the residual of a fit with the noise of the sound itself
            linear = np.array([_solve(g, r) for g, r in zip(*self._normal(basis, noise), strict=True)])
            model = linear @ basis
            noise = self._level(np.abs(self.X - model) ** 2)
        return model, linear, noise

    def _normal(self, basis: Complex, noise: Array) -> tuple[Array, Array]:
        """Real normal matrices and right sides of every trace, weighted by the noise: of its variance a half each in
        real and imaginary part."""
        rows, whole = np.hstack([basis.real, basis.imag]), np.hstack([self.X.real, self.X.imag])
        weights = np.sqrt(2 / np.hstack([noise, noise]))
        grams, right = np.zeros((len(noise), len(rows), len(rows))), np.zeros((len(noise), len(rows)))
        for start in range(0, rows.shape[1], PIECE):
            piece = slice(start, start + PIECE)
            for i, (x, weight) in enumerate(zip(whole[:, piece], weights[:, piece], strict=True)):
                weighted = rows[:, piece] * weight
                grams[i] += weighted @ weighted.T
                right[i] += weighted @ (x * weight)
        return grams, right

    def _amplitudes(self, w: Array, a: Array) -> Array:
        linear = self._explained(w, a)[1].reshape(len(self.X), 2, -1)
        return np.sqrt(np.square(linear).sum(axis=(0, 1)))

    def _step(self, w: Array, a: Array, noise: Array) -> tuple[Array, Array, Array, float]:
        """(Gauss-Newton step of w and a, its normal matrix, p and q, squared weighted residual)."""
        basis, n = self._basis(w, a).reshape(4 * len(w), -1), len(w)
        gram, right = self._normal(basis, noise)
        power = float((2 * np.abs(self.X) ** 2 / noise).sum())
        H, g, linear = np.zeros((2 * n, 2 * n)), np.zeros(2 * n), []
        for G, r in zip(gram, right, strict=True):
            c = _solve(G[: 2 * n, : 2 * n], r[: 2 * n])
            p, q = c[:n], c[n:]
            # d/dw and d/da of p exp(-at) cos wt + q exp(-at) sin wt, in the basis' columns of t exp(-at) cos, sin
            D = np.block([[np.diag(q), -np.diag(p)], [-np.diag(p), -np.diag(q)]])
            lean = _solve(G[: 2 * n, : 2 * n], G[: 2 * n, 2 * n :])
            H += D.T @ (G[2 * n :, 2 * n :] - G[2 * n :, : 2 * n] @ lean) @ D
            g += D.T @ (r[2 * n :] - G[2 * n :, : 2 * n] @ c)
            power -= float(c @ r[: 2 * n])
            linear.append(c)
        return _solve(H, g), H, np.array(linear), power

    def fitted(self, w: Array, a: Array, steps: int = STEPS) -> tuple[Array, Array]:
        """The tones of smallest residual, from a start within a line's width, in at most ``steps`` steps."""
        noise = self._explained(w, a)[2]
        step, _, _, best = self._step(w, a, noise)
        for _ in range(steps):
            n, scale = len(w), 1.0
            far = np.maximum(2 * a, 1.0)
            limited = np.concatenate([np.clip(step[:n], -far, far), np.clip(step[n:], -0.6 * a, 2 * a)])
            for _ in range(5):
                there = w + scale * limited[:n], np.clip(a + scale * limited[n:], SLOWEST, FASTEST * w)
                after = self._step(*there, noise)
                if after[3] <= best:
                    break
                scale /= 4
            else:
                break
            gain, best = best - after[3], after[3]
            (w, a), step = there, after[0]
            if gain < SMALL:
                break
        return w, a

    def tones(self, w: Array, a: Array) -> list[Tone]:
        """Tones with their uncertainties, without those that are too faint."""
        if not len(w):
            return []
        noise = self._explained(w, a)[2]
        _, H, linear, _ = self._step(w, a, noise)
        errors = np.sqrt(np.diag(np.linalg.pinv(H, hermitian=True))).reshape(2, -1)
        linear = linear.reshape(len(self.X), 2, -1)
        level = np.sqrt(np.square(linear).sum(axis=(0, 1)))
        basis = self._basis(w, a)[:2]
        heard = np.sqrt((2 * np.abs(np.einsum("tck,ckb->tkb", linear, basis)) ** 2 / noise[:, None]).sum(axis=(0, 2)))
        tones, faintest = [], gammainccinv(len(self.X) + 1, FALSE_ALARM)
        for k in range(len(w)):
            natural = np.hypot(w[k], a[k]) / (2 * np.pi)
            error = np.hypot(errors[0, k] / (2 * np.pi), CLOCK * natural)
            vague = error / natural
            kind = "steady" if a[k] < STEADY else "tone"
            if kind == "tone" and heard[k] < FAINT * np.sqrt(2 * faintest):
                kind, error = "faint", np.hypot(error, a[k] / (2 * np.pi))
            lossy = 2 * a[k] > LOSSY * w[k]
            if heard[k] ** 2 / 2 >= faintest and vague < VAGUE and not lossy and LOW <= natural <= HIGH:
                tones.append(Tone(natural, error, a[k], errors[1, k], level[k], heard[k], kind))
        return tones


def _blocks(frequencies: Array) -> NDArray[np.intp]:
    """Bounds, as indices, of blocks as wide as `BLOCK` says."""
    bounds = [0]
    while bounds[-1] < len(frequencies):
        start = frequencies[bounds[-1]]
        end = int(np.searchsorted(frequencies, start + max(BLOCK[0], BLOCK[1] * start)))
        bounds.append(max(end, bounds[-1] + FEWEST))
    bounds[-2:] = [len(frequencies)] if len(bounds) > 2 else bounds[-2:]  # the last is joined to the one before
    return np.array(bounds)


def _solve(matrix: Array, right: Array) -> Array:
    """Solution of a positive semidefinite system with scaled columns; the smallest one if tones coincide."""
    scale = 1 / np.sqrt(np.maximum(np.diag(matrix), np.finfo(float).tiny))
    scaled = matrix * scale[:, None] * scale
    values, vectors = np.linalg.eigh(scaled)
    inverse = np.where(values > 1e-12 * values[-1], 1 / np.where(values > 0, values, 1), 0.0)
    turned = vectors.T @ (right.T * scale).T
    return np.asarray(((vectors @ (turned.T * inverse).T).T * scale).T)


def _twins(tones: list[Tone]) -> list[Tone]:
    """Pairs of tones of a shaft that is not quite round: the mean stands for both, half the distance is its error.

    Bending modes lie farther apart than `NEAR`.
    """
    made = list(tones)
    for i in range(len(made) - 1):
        low, high = made[i], made[i + 1]
        if low.kind == high.kind == "tone" and high.frequency - low.frequency < NEAR * low.frequency:
            strong, weak = (i, i + 1) if low.level >= high.level else (i + 1, i)
            half = (high.frequency - low.frequency) / 2
            error = float(np.hypot(half, max(low.error, high.error)))
            made[strong] = replace(made[strong], frequency=low.frequency + half, error=error)
            made[weak] = replace(made[weak], kind="twin")
    return made


def _harmonics(tones: list[Tone]) -> list[Tone]:
    """Mark whole multiples of louder tones, and third-order sums of the loudest: clipping and limiters make them."""
    loud = sorted((tone for tone in tones if tone.kind == "tone"), key=lambda tone: -tone.level)
    sums = [[(k, low)] for low in loud for k in HARMONICS]
    for parts in combinations_with_replacement(loud[:LOUD], 3):
        for signs in ((1, 1, 1), (1, 1, -1), (1, -1, 1), (-1, 1, 1)):
            sums.append(list(zip(signs, parts, strict=True)))

    def is_made_of(tone: Tone, parts: list[tuple[int, Tone]]) -> bool:
        if any(low is tone or tone.level > low.level for _, low in parts):
            return False
        gap = abs(tone.frequency - abs(sum(k * low.frequency for k, low in parts)))
        error = tone.error + sum(abs(k) * low.error for k, low in parts)
        return gap < 4 * error + 1e-3 * tone.frequency and tone.level < WEAKER * max(low.level for _, low in parts)

    doubtful = [tone for tone in loud if any(is_made_of(tone, parts) for parts in sums)]
    return [replace(tone, kind="harmonic") if tone in doubtful else tone for tone in tones]
