"""Sounds of plucked strings and sung vowels, that a tap test must not take for a shaft."""

from __future__ import annotations

import numpy as np
from scipy.signal import lfilter

RATE = 22050
SECONDS = 1.4


def plucked(
    note: float, *, stiffness: float = 0.0, place: float = 0.2, loss: float = 2e-3, seed: int = 0
) -> np.ndarray:
    """A string that is plucked at a part of its length: stiff partials, of one loss factor."""
    t, order = np.arange(int(SECONDS * RATE)) / RATE, np.arange(1, 40)
    frequencies = note * order * np.sqrt(1 + stiffness * order**2)
    heard = frequencies < 0.45 * RATE
    phases = np.random.default_rng(seed).uniform(0, 2 * np.pi, len(order))
    sizes = np.abs(np.sin(np.pi * order * place)) / order
    sound = sum(
        size * np.exp(-np.pi * loss * f * t) * np.sin(2 * np.pi * f * t + phase)
        for size, f, phase in zip(sizes[heard], frequencies[heard], phases[heard], strict=True)
    )
    return recorded(np.asarray(sound), seed)


def looped(note: float, *, damping: float = 3e-3, softness: float = 0.4, seed: int = 0) -> np.ndarray:
    """A burst of noise going round in a loop that takes its highs (K. Karplus, A. Strong, 1983)."""
    length = int(RATE / note)
    burst = np.zeros(int(SECONDS * RATE))
    burst[:length] = np.random.default_rng(seed).uniform(-1, 1, length)
    loop = np.zeros(length + 2)
    loop[[0, length, length + 1]] = 1, -(1 - damping) * (1 - softness), -(1 - damping) * softness
    return recorded(np.asarray(lfilter([1.0], loop, burst)), seed)


def sung(
    note: float, vowel: tuple[float, ...] = (730.0, 1090.0, 2440.0), decay: float = 0.2, seed: int = 0
) -> np.ndarray:
    """Multiples of a note, those near the resonances of a vowel louder, dying away."""
    t = np.arange(int(SECONDS * RATE)) / RATE
    f = note * np.arange(1, int(5000 / note))
    sizes = 0.02 + sum(1 / (1 + ((f - formant) / 100) ** 2) for formant in vowel)
    tones = (size / k * np.sin(2 * np.pi * each * t) for k, (size, each) in enumerate(zip(sizes, f, strict=True), 1))
    return recorded(np.exp(-t / decay) * sum(tones), seed)


def recorded(sound: np.ndarray, seed: int) -> np.ndarray:
    """The sound after a tenth of a second of silence, full scale 1, in noise 60 dB below."""
    noise = np.random.default_rng([seed, 1]).standard_normal(int(SECONDS * RATE) + RATE // 10)
    noise[RATE // 10 :] += 1e3 * sound / np.abs(sound).max()
    return 1e-3 * noise
