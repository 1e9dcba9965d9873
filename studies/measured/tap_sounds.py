"""Sounds that a phone may hear instead of a tap, made by formula: speech, coughs, claps, notes, slams, other things.

Each is drawn by a seed. None is a recording; they stand for kinds of sound, not for one voice or room.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.signal import lfilter

Sound = np.ndarray
Draw = np.random.Generator

RATE = 8000  # 1/s: a telephone's band
SECONDS = 0.9
# Hz, formants of vowels: Peterson & Barney, J. Acoust. Soc. Am. 24 (1952) 175, men
VOWELS = (
    (270, 2290, 3010),
    (390, 1990, 2550),
    (530, 1840, 2480),
    (660, 1720, 2410),
    (730, 1090, 2440),
    (570, 840, 2410),
    (440, 1020, 2240),
    (300, 870, 2240),
    (640, 1190, 2390),
    (490, 1350, 1690),
)


def resonated(sound: Sound, frequency: float, width: float, rate: float = RATE) -> Sound:
    """A sound through a resonator of this frequency and width, Hz."""
    radius, angle = np.exp(-np.pi * width / rate), 2 * np.pi * frequency / rate
    return np.asarray(lfilter([1 - radius], [1, -2 * radius * np.cos(angle), radius**2], sound))


def hissed(draw: Draw, size: int, low: float, high: float) -> Sound:
    """Noise between two frequencies, Hz."""
    spectrum = np.fft.rfft(draw.standard_normal(size))
    f = np.fft.rfftfreq(size, 1 / RATE)
    spectrum[(f < low) | (f > high)] = 0
    return np.fft.irfft(spectrum, size)


def voiced(draw: Draw, seconds: float, pitch: float) -> Sound:
    """A vowel gliding to another: glottal pulses with vibrato and falling pitch through five resonators."""
    size = int(seconds * RATE)
    t = np.arange(size) / RATE
    f0 = pitch * (1 - draw.uniform(0, 0.15) * t / seconds)
    f0 = f0 * (1 + draw.uniform(0, 0.02) * np.sin(2 * np.pi * draw.uniform(4, 7) * t))
    phase = np.cumsum(f0) / RATE
    opened = np.mod(phase, 1.0)
    flow = np.where(opened < 0.6, opened**2 * (0.6 - opened), 0.0)
    source = np.diff(flow, prepend=0.0) + 2e-4 * draw.standard_normal(size)
    stretch = draw.uniform(0.95, 1.25)  # of the vocal tract: women and children have shorter ones
    made = np.zeros(size)
    for share, vowel in zip((1 - t / seconds, t / seconds), draw.choice(len(VOWELS), 2), strict=True):
        through = source
        for frequency, width in zip((*VOWELS[vowel], 3500, 4500), (60, 90, 120, 200, 300), strict=True):
            if stretch * frequency < 0.45 * RATE:
                through = resonated(through, stretch * frequency, width)
        made += share * through / np.abs(through).max()
    return made * np.minimum(1, np.minimum(t, seconds - t) / 0.02)


def speech(draw: Draw) -> Sound:
    """Syllables: a burst or a hiss, a vowel, sometimes a pause."""
    pitch, parts = draw.uniform(85, 260), []
    while sum(map(len, parts)) < SECONDS * RATE:
        kind = draw.uniform()
        if kind < 0.35:
            size = int(draw.uniform(0.05, 0.12) * RATE)
            parts.append(0.02 * hissed(draw, size, draw.uniform(1000, 2500), 0.5 * RATE) * np.hanning(size))
        elif kind < 0.7:
            size = int(0.06 * RATE)
            burst = hissed(draw, size, 200, draw.uniform(1500, 4000)) * np.exp(-np.arange(size) / RATE / 0.006)
            parts.append(np.concatenate([np.zeros(size), 0.1 * burst]))
        parts.append(draw.uniform(0.5, 1) * voiced(draw, draw.uniform(0.1, 0.4), pitch * draw.uniform(0.9, 1.15)))
        if draw.uniform() < 0.3:
            parts.append(np.zeros(int(draw.uniform(0.05, 0.2) * RATE)))
    return np.concatenate(parts)[: int(SECONDS * RATE)]


def bursts(draw: Draw, count: int, made: Callable[[], Sound]) -> Sound:
    """Some short sounds, one after the other with silence before."""
    sound = np.zeros(int(SECONDS * RATE))
    for start in np.linspace(0.1, SECONDS - 0.4, count, endpoint=False) + draw.uniform(0, 0.1, count):
        one, at = made(), int(start * RATE)
        one = one[: len(sound) - at]
        sound[at : at + len(one)] += draw.uniform(0.5, 1) * one / np.abs(one).max()
    return sound


def cough(draw: Draw) -> Sound:
    """Bursts of air through the resonances of a throat, with a voiced end."""

    def one() -> Sound:
        size = int(draw.uniform(0.2, 0.4) * RATE)
        t = np.arange(size) / RATE
        through = draw.standard_normal(size) * (np.exp(-t / 0.03) + 0.3 * np.exp(-(((t - 0.1) / 0.06) ** 2)))
        for frequency in (draw.uniform(400, 800), draw.uniform(1000, 1700), draw.uniform(2200, 3200)):
            through = through + 2 * resonated(through, frequency, draw.uniform(60, 200))
        tail = voiced(draw, size / RATE, draw.uniform(100, 300))[:size]
        return through / np.abs(through).max() + draw.uniform(0, 0.4) * np.pad(tail, (0, size - len(tail)))

    return bursts(draw, int(draw.integers(1, 3)), one)


def clap(draw: Draw) -> Sound:
    """Hands: a click through the cavity between them, and the room's echo."""
    cavity, echo = draw.uniform(500, 2500), draw.uniform(0.05, 0.25)

    def one() -> Sound:
        size = int(0.5 * RATE)
        t = np.arange(size) / RATE
        click = resonated(draw.standard_normal(size) * np.exp(-t / 0.002), cavity, cavity / draw.uniform(1.5, 6))
        room = hissed(draw, size, 200, 4000) * np.exp(-t / echo)
        return click / np.abs(click).max() + draw.uniform(0.02, 0.2) * room / np.abs(room).max()

    return bursts(draw, int(draw.integers(1, 3)), one)


def rung(draw: Draw, frequencies: np.ndarray, loss: float, slope: float) -> Sound:
    """Decaying tones, weaker by ``slope`` powers of the frequency."""
    t = np.arange(int(1.2 * RATE)) / RATE
    sound = np.zeros(len(t))
    for f in frequencies[frequencies < 0.45 * RATE]:
        size = (f / frequencies[0]) ** -slope * draw.uniform(0.3, 1)
        sound += size * np.exp(-np.pi * loss * f * t) * np.sin(2 * np.pi * f * t + draw.uniform(0, 6.28))
    return sound


def note(draw: Draw) -> Sound:
    """A plucked or struck string, or a chord of them, slightly stiff."""

    def one() -> Sound:
        keys, k = draw.integers(40, 70, int(draw.integers(1, 3))), np.arange(1, 20)
        stiff = draw.uniform(0, 1e-3)
        loss, slope = draw.uniform(0.001, 0.01), draw.uniform(0.5, 1.5)
        return sum(
            rung(draw, 440 * 2 ** ((key - 69) / 12) * k * np.sqrt(1 + stiff * k**2), loss, slope) for key in keys
        )

    return bursts(draw, int(draw.integers(1, 3)), one)


def slam(draw: Draw) -> Sound:
    """A door: low noise through broad resonances of the leaf and the frame, and the latch's click."""

    def one() -> Sound:
        size = int(0.6 * RATE)
        t = np.arange(size) / RATE
        shock = draw.standard_normal(size) * np.exp(-t / draw.uniform(0.01, 0.04))
        low = sum(resonated(shock, f, f * draw.uniform(0.03, 0.2)) for f in draw.uniform(60, 900, 8))
        click = hissed(draw, size, 1000, 4000) * np.exp(-t / 0.004)
        return low / np.abs(low).max() + draw.uniform(0, 0.5) * click / np.abs(click).max()

    return bursts(draw, 1, one)


def plate(draw: Draw) -> Sound:
    """A struck board, tray or pane: the modes of a supported plate."""
    m, n = np.meshgrid(np.arange(1, 12), np.arange(1, 12))
    frequencies = np.sort((m**2 + draw.uniform(0.2, 3) * n**2).ravel())
    base, loss = draw.uniform(60, 400), draw.uniform(0.003, 0.03)
    chosen = base * frequencies[:25] / frequencies[0]
    return bursts(draw, int(draw.integers(1, 3)), lambda: rung(draw, chosen, loss, 0.7))


def jingle(draw: Draw) -> Sound:
    """Glasses, keys, cans: a few tones without order."""
    base, count = draw.uniform(80, 1500), int(draw.integers(2, 12))
    chosen = np.sort(base * np.exp(draw.uniform(0, 2.5, count)))
    return bursts(draw, int(draw.integers(1, 3)), lambda: rung(draw, chosen, draw.uniform(0.003, 0.02), 0.5))


def hum(draw: Draw, size: int, rate: float, *, mains: float = 50.0, harmonics: int = 12) -> Sound:
    """Mains hum of mean power 1: a frequency near the mains', even and odd harmonics that fall."""
    t, base = np.arange(size) / rate, mains * (1 + draw.uniform(-1e-3, 1e-3))
    sizes = draw.uniform(0.2, 1, harmonics) / np.arange(1, harmonics + 1) ** 0.7
    tones = (A * np.sin(2 * np.pi * (k + 1) * base * t + draw.uniform(0, 6.28)) for k, A in enumerate(sizes))
    sound = np.asarray(sum(tones))
    return sound / np.sqrt(np.mean(sound**2))


def hum_and_clicks(draw: Draw) -> Sound:
    """Hum with the clicks of a switch."""
    clicks = bursts(draw, 2, lambda: hissed(draw, 400, 500, 4000) * np.exp(-np.arange(400) / 60))
    return 0.2 * hum(draw, len(clicks), RATE, mains=float(draw.choice([50.0, 60.0]))) + clicks


KINDS: dict[str, Callable[[Draw], Sound]] = {
    "speech": speech,
    "cough": cough,
    "claps": clap,
    "notes": note,
    "door": slam,
    "struck plate": plate,
    "jingle": jingle,
    "hum and clicks": hum_and_clicks,
}


def other_sound(kind: str, seed: int) -> Sound:
    """A sound of a kind, in a little noise, full scale 1, (samples,)."""
    draw = np.random.default_rng([seed, *kind.encode()])
    sound = KINDS[kind](draw)
    sound = sound / np.abs(sound).max()
    return sound + 10 ** draw.uniform(-4, -2) * draw.standard_normal(len(sound))
