"""Mains hum in a recording: 50 or 60 Hz and its multiples, found by their steadiness and taken out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cuefem.cue import Array

MAINS = (50.0, 60.0)  # Hz
ASTRAY = 0.3  # Hz that a grid runs fast or slow, the clock of the recorder included
MOST = 24  # multiples that are looked for
WINDOW = 0.2  # s: the multiples are told apart, and a tap spoils few windows
PIECE = 4.0  # s over which the grid keeps its frequency
LIKE, STEADY = 0.35, 0.6  # a hum's amplitude is within LIKE of its median in at least STEADY of the windows
LEAST = 3e-3  # of the sound's own amplitude: a weaker line may be the flank of another tone
FEWEST = 2  # multiples: a single steady line may be anything
FITS, FARTHEST = 6, 0.02  # fits of the hum's sines; Hz by which one of them moves the mains frequency at most


@dataclass(frozen=True)
class Hum:
    """mains: measured frequency, Hz. multiples: those removed. level: their mean power over the rest's, dB."""

    mains: float
    multiples: tuple[int, ...]
    level: float


def without_hum(signal: Array, rate: float) -> tuple[Array, Hum | None]:
    """The recording, (samples, channels), without its mains hum, and that hum; None if no hum was found."""
    pieces = np.array_split(signal, max(1, round(len(signal) / (PIECE * rate))))
    hums = [_hum(piece, rate) for piece in pieces]
    heard = [(base, multiples) for base, multiples, _ in hums if multiples]
    if not heard:
        return signal, None
    clean = np.concatenate([piece - hum for piece, (_, _, hum) in zip(pieces, hums, strict=True)])
    power = np.square(signal - clean).sum() / max(np.square(clean).sum(), np.finfo(float).tiny)
    multiples = sorted(set().union(*(own for _, own in heard)))
    return clean, Hum(float(np.median([base for base, _ in heard])), tuple(multiples), float(10 * np.log10(power)))


def _hum(piece: Array, rate: float) -> tuple[float, tuple[int, ...], Array]:
    """(mains frequency, its multiples heard, their sound) of some seconds."""
    best: tuple[float, float, tuple[int, ...]] = (0.0, 0.0, ())
    for mains in MAINS:
        strength, base, multiples = _steady(piece, rate, mains)
        if multiples and strength > best[0]:
            best = strength, base, multiples
    _, base, multiples = best
    if not multiples:
        return base, multiples, np.zeros_like(piece)
    base, sound = _sound(piece, rate, base, multiples)
    return base, multiples, sound


def _steady(piece: Array, rate: float, mains: float) -> tuple[float, float, tuple[int, ...]]:
    """(power of the steady multiples, the mains frequency as measured, the numbers of those multiples)."""
    size = int(WINDOW * rate)
    starts = np.arange(0, len(piece) - size + 1, size // 2)
    if len(starts) < 4:
        return 0.0, mains, ()
    k = np.arange(1, 1 + min(MOST, int(0.45 * rate / mains)))
    wave = np.exp(-2j * np.pi * mains * np.outer(k, np.arange(size)) / rate) * np.hanning(size)
    heard = np.array([wave @ piece[start : start + size] for start in starts])  # (windows, multiples, channels)
    heard = heard * np.exp(-2j * np.pi * mains * np.outer(starts, k) / rate)[:, :, None]
    turns = 2 * np.pi * k * (starts / rate)[:, None]
    unit = heard / np.maximum(np.abs(heard), np.finfo(float).tiny)
    off = np.linspace(-ASTRAY, ASTRAY, 2 * int(ASTRAY * 12 * k[-1] * len(piece) / rate) + 1)
    together = [np.square(np.abs((unit * np.exp(-1j * turns * d)[:, :, None]).mean(axis=0))).sum() for d in off]
    best = float(off[int(np.argmax(together))])
    turned = heard * np.exp(-1j * turns * best)[:, :, None]
    middle = np.median(turned.real, axis=0) + 1j * np.median(turned.imag, axis=0)
    like = (np.abs(turned - middle) <= LIKE * np.abs(middle)).mean(axis=0)  # (multiples, channels)
    steady = ((like >= STEADY) & (np.abs(middle) > LEAST * size / 4 * np.sqrt(np.mean(piece**2)))).any(axis=1)
    strength = float(np.square(np.abs(middle[steady])).sum())
    # a tap disturbs some multiples: if a few are steady, all up to the highest of them count as hum
    multiples = tuple(range(1, int(k[steady][-1]) + 1)) if steady.sum() >= FEWEST else ()
    return strength, mains + best, multiples


def _sound(piece: Array, rate: float, base: float, multiples: tuple[int, ...]) -> tuple[float, Array]:
    """The mains frequency and the multiples' sines, by least squares in which loud stretches, after a tap, count less.

    The frequency is refined by Gauss and Newton's method, since the tap's own ring may have pulled the first estimate.
    """
    t = np.arange(len(piece)) / rate
    turns = 2 * np.pi * t[:, None] * np.array(multiples)
    hop = int(WINDOW / 4 * rate)
    weight, sound = np.ones(len(piece)), np.zeros_like(piece)
    for _ in range(FITS):
        cosine, sine = np.cos(base * turns), np.sin(base * turns)
        basis = np.hstack([cosine, sine])
        scaled = basis * weight[:, None]
        gram = scaled.T @ basis
        parts = np.linalg.solve(gram, scaled.T @ piece)
        sound = basis @ parts
        rest = piece - sound
        drift = (turns * cosine) @ parts[len(multiples) :] - (turns * sine) @ parts[: len(multiples)]  # d sound/d base
        drift -= basis @ np.linalg.solve(gram, scaled.T @ drift)
        weighted = drift * weight[:, None]
        step = float((weighted * rest).sum() / max((weighted * drift).sum(), np.finfo(float).tiny))
        base += float(np.clip(step, -FARTHEST, FARTHEST))
        level = np.sqrt(np.add.reduceat(np.square(rest).sum(axis=1), np.arange(0, len(rest), hop)) / hop)
        weight = np.repeat(1 / (level + 1e-3 * level.max() + np.finfo(float).tiny), hop)[: len(piece)] ** 2
    return base, np.asarray(sound)
