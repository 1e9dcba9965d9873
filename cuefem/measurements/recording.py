"""Natural frequencies of a shaft from recordings: spectral peaks, numbered by the modes of the drawing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from cuefem.cue import Array
from cuefem.measurements.measurement_types import Tone

SAMPLE_RATES = (4e3, 4e5)  # Hz, of samples: a telephone line has 8 kHz, a studio 192 kHz
TRANSFORM_TIME, MIN_TIME = 0.4, 0.1  # s that are transformed after the loudest sample, and that there must be
NOISE_BLOCK = 600.0  # Hz, over which the median is the noise: wider than a peak
MIN_ABOVE_NOISE = 12.0  # dB of a peak, which noise alone exceeds once in 50 recordings
MAX_BELOW_PEAK = 40.0  # dB below the highest peak
MIN_SPACING, MAX_MODE_DISTANCE = 0.05, 0.05  # ln f: of two peaks, of a peak from its mode
SHIFT_SD, MAX_SHIFT = 0.15, 0.35  # ln f, of sqrt(E/rho) from that of the drawing: standard deviation, and largest
# Where a recording is cut off, its peaks are as high as one another. Of 5,000 random taps at most 0.06 % of the samples
# lie within AT_TOP of the largest, and of those with two tones within ONE_TONE at most 8.5 % of the first NEAR_TIME
# within NEAR_TOP; a gain of 1.3 beyond full scale cuts 0.14 % off, and tanh(4 x) brings 16 % near the top.
AT_TOP, MAX_AT_TOP = 1e-3, 1e-3
NEAR_TOP, NEAR_TIME, MAX_NEAR_TOP, ONE_TONE = 0.05, 0.1, 0.1, 12.0  # relative, s, share, dB
MIN_TONES = 3  # tones: any two peaks are near two modes of some wood


@dataclass(frozen=True, kw_only=True)
class Recording:
    """A .wav file of the freely suspended shaft, tapped once or more; the loudest tap counts."""

    file: str
    source: str = ""


class Peak(NamedTuple):
    """A peak of a spectrum, and its standard error, Hz."""

    frequency: float
    error: float


def spectral_peaks(samples: Array, rate: float, low: float, high: float) -> list[Peak]:
    """Peaks between ``low`` and ``high``, Hz, after the loudest sample.

    samples: (n, channels). rate: samples per second, Hz. ValueError for silence, for less than `MIN_TIME` after the
    tap, for a rate beyond `SAMPLE_RATES`, and for clipping.
    """
    if not SAMPLE_RATES[0] <= rate <= SAMPLE_RATES[1]:
        raise ValueError(f"must have {SAMPLE_RATES[0]:g} to {SAMPLE_RATES[1]:g} samples per second; got {rate:g}")
    if not np.isfinite(samples).all():
        raise ValueError("must hold finite samples; got inf or nan")
    size = np.abs(samples - samples.mean(axis=0)).max(axis=1)
    if not size.max() > 0:
        raise ValueError("must hold a sound; got silence")
    sound = samples[size.argmax() :][: int(TRANSFORM_TIME * rate)]
    if len(sound) < MIN_TIME * rate:
        raise ValueError(f"must last {MIN_TIME:g} s or more after its loudest tap; got {len(sound) / rate:.2g} s")
    window = np.hanning(2 * len(sound))[len(sound) :, None]
    count = 1 << int(np.ceil(np.log2(4 * rate)))  # bins of 1/4 Hz or less
    power = np.square(np.abs(np.fft.rfft(window * (sound - sound.mean(axis=0)), count, axis=0))).sum(axis=1)
    level, step = 10 * np.log10(power + 1e-30), rate / count
    noise = _noise(level, int(NOISE_BLOCK / step))
    maxima = 1 + np.flatnonzero((level[1:-1] > level[:-2]) & (level[1:-1] >= level[2:]))
    maxima = maxima[(maxima * step > low) & (maxima * step < high) & (level[maxima] > noise[maxima] + MIN_ABOVE_NOISE)]
    peaks: list[int] = []
    for at in maxima[np.argsort(-level[maxima])].tolist():
        if level[at] > level[peaks[0] if peaks else at] - MAX_BELOW_PEAK and all(
            abs(np.log(at / other)) > MIN_SPACING for other in peaks
        ):
            peaks.append(at)
    is_one_tone = len(peaks) < 2 or level[peaks[0]] - level[peaks[1]] > ONE_TONE
    _check_not_clipped(sound - samples.mean(axis=0), rate, is_one_tone=is_one_tone)
    return [_peak(level, at, noise[at], step) for at in peaks]


def _noise(level: Array, block: int) -> Array:
    """The level of the noise, dB: medians of blocks, between which it is interpolated."""
    count = len(level) // block
    medians = np.median(level[: count * block].reshape(count, block), axis=1)
    return np.interp(np.arange(len(level)), (np.arange(count) + 0.5) * block, medians)


def _peak(level: Array, at: int, noise: float, step: float) -> Peak:
    """The vertex of the parabola through three levels; error: half the width at -3 dB times noise over signal."""
    before, peak, after = level[at - 1 : at + 2]
    vertex = at + (before - after) / 2 / (before - 2 * peak + after)
    below = np.flatnonzero(level < peak - 3)
    i = int(np.searchsorted(below, at))
    width = (below[i] if i < len(below) else len(level)) - (below[i - 1] if i else 0)
    return Peak(float(vertex * step), float(width / 2 * 10 ** ((noise - peak) / 20) * step))


def _check_not_clipped(sound: Array, rate: float, *, is_one_tone: bool) -> None:
    """ValueError for a sound whose peaks were cut off, or flattened by a compressor: both distort its spectrum.

    is_one_tone: whether one tone is so much louder that its peaks are nearly as high as one another anyway.
    """
    size = np.abs(sound)
    relative = size / np.maximum(size.max(axis=0), np.finfo(float).tiny)
    cut = (relative >= 1 - AT_TOP).mean(axis=0).max()
    flat = (relative[: int(NEAR_TIME * rate)] >= 1 - NEAR_TOP).mean(axis=0).max()
    if cut > MAX_AT_TOP or (flat > MAX_NEAR_TOP and not is_one_tone):
        problem = "must not be clipped or compressed; got peaks that are all as high as one another"
        raise ValueError(f"{problem}: record with a lower gain, or from further away")


def assign_modes(peaks: Sequence[Peak], frequencies: Array) -> dict[int, Peak]:
    """The peak of each mode, 1 the lowest, of a shaft with these natural frequencies, Hz, by its drawing.

    One factor for all modes is searched first, sqrt(E/rho) of the true wood over the drawing's: it brings most
    peaks nearest to modes, and is near 1. A silent mode therefore does not shift the numbers of the others.
    """
    shifts = np.linspace(-MAX_SHIFT, MAX_SHIFT, 281)
    distances = np.log([[peak.frequency] for peak in peaks]) - np.log(frequencies)  # (peaks, modes)
    errors = np.abs(distances - shifts[:, None, None])
    cost = np.minimum(errors.min(axis=2) / MAX_MODE_DISTANCE, 1) ** 2
    best = errors[np.argmin(cost.sum(axis=1) + (shifts / SHIFT_SD) ** 2)]
    nearest = best.argmin(axis=0)  # of the peaks, for each mode
    return {mode + 1: peaks[i] for mode, i in enumerate(nearest) if best[i, mode] == best[i].min() < MAX_MODE_DISTANCE}


def tones_in(samples: Array, rate: float, frequencies: Array, source: str = "") -> tuple[Tone, ...]:
    """The natural frequencies of a shaft in a recording.

    Parameters
    ----------
    samples : (n, channels) array
        Of the recording.
    rate : float
        Samples per second, Hz.
    frequencies : array
        Natural frequencies of the drawing, freely suspended, Hz.
    source : str
        Of the tones.

    Raises
    ------
    ValueError
        If the recording is silent or clipped, ends too soon, or has no three peaks near modes of the drawing.

    Examples
    --------
    >>> import numpy as np
    >>> from cuefem.measurements.recording import tones_in
    >>> time = np.arange(22050) / 44100
    >>> sound = sum(np.exp(-20 * time) * np.cos(2 * np.pi * f * time) for f in (100.0, 570.0, 970.0))
    >>> drawn = np.array([95.0, 280.0, 560.0, 930.0])
    >>> [(tone.mode, round(tone.value)) for tone in tones_in(sound[:, None], 44100.0, drawn)]
    [(1, 100), (3, 570), (4, 970)]
    """
    margin = np.exp(MAX_SHIFT)
    peaks = spectral_peaks(samples, rate, frequencies[0] / margin, frequencies[-1] * margin)
    numbered = assign_modes(peaks, frequencies) if peaks else {}
    if len(numbered) < MIN_TONES:
        text = ", ".join(f"{peak.frequency:.0f}" for peak in sorted(peaks)) or "none"
        modes = ", ".join(f"{hertz:.0f}" for hertz in frequencies)
        raise ValueError(f"must have at least {MIN_TONES} peaks near the natural frequencies, {modes} Hz; got {text}")
    return tuple(Tone(mode=k, value=peak.frequency, error=peak.error, source=source) for k, peak in numbered.items())


def combine_tones(tones: Sequence[Tone]) -> tuple[Tone, ...]:
    """One frequency per mode from several recordings: the weighted mean, its error at least that of their scatter."""
    means = []
    for mode in sorted({tone.mode for tone in tones}):
        group = [tone for tone in tones if tone.mode == mode]
        values, weights = np.array([tone.value for tone in group]), np.array([tone.error**-2.0 for tone in group])
        mean, error = float(np.average(values, weights=weights)), float(weights.sum() ** -0.5)
        scatter = float(np.sqrt(np.average((values - mean) ** 2, weights=weights) / max(len(group) - 1, 1)))
        sources = ", ".join(dict.fromkeys(tone.source for tone in group))
        means.append(replace(group[0], value=mean, error=max(error, scatter), source=sources))
    return tuple(means)
