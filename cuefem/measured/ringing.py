"""Where a recording rings: each tap's free decay cut out of it, clipped samples left out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from cuefem.cue import Array
from cuefem.measured.hum import Hum, without_hum
from cuefem.quantity.fields import Quantity

HOP = 0.02  # s, of the envelope: two periods of the lowest tone that a phone hears
RISE = 4.0  # of the power from one hop to the next: a tap, where beating tones never rise so fast
FAINT = 0.05  # of the loudest hop's power: taps below are left out
CONTACT = 0.002  # s after the loudest sample: by then the knuckle or mallet has left
SHORTEST, LONGEST = 0.1, 0.6  # s of ringing: less does not tell tones apart, more is noise
TAPS = 6
LOUDEST = 1e12  # in any unit: beyond this, powers overflow
RATES = Quantity("Hz", "[8000, 384000]")


@dataclass(frozen=True)
class Ringing:
    """Free decays after taps, all of one length.

    traces: (traces, samples), one for each tap and channel. rate: samples a second, Hz. taps: how many. clipped: the
    longest time after a tap, s, that was left out because samples were clipped; 0 if none was. hum: the mains hum that
    was removed, if any.
    """

    traces: Array
    rate: float
    taps: int
    clipped: float
    hum: Hum | None = None


def ringing(signal: ArrayLike, rate: float) -> Ringing:
    """The free decays in a recording, (samples,) or (samples, channels), of at most `TAPS` taps.

    ValueError if it is too short, not finite, beyond `LOUDEST`, silent, or clipped to its end.
    """
    rate = RATES.check("ringing rate", rate)
    signal = np.asarray(signal, float)
    signal = signal[:, None] if signal.ndim == 1 else signal
    if signal.ndim != 2 or len(signal) < 2 * SHORTEST * rate:
        raise ValueError(f"a recording must last {2 * SHORTEST:g} s or more; got {len(signal) / rate:.3g} s")
    if not np.isfinite(signal).all():
        raise ValueError("a recording must hold finite samples; got nan or inf")
    if (peak := float(np.abs(signal).max(initial=0.0))) > LOUDEST:
        raise ValueError(f"a recording must hold samples within [-{LOUDEST:g}, {LOUDEST:g}]; got {peak:.3g}")
    signal = _channels(signal - signal.mean(axis=0))
    clipped = _clipped(signal)
    signal, hum = without_hum(signal, rate)
    onsets = _onsets(signal, rate)
    ends = [*onsets[1:], len(signal)]
    begun = [_after(clipped, a, b) for a, b in zip(onsets, ends, strict=True)]
    lengths = np.subtract(ends, begun)
    if lengths.max() < SHORTEST * rate:
        why = "clipped beyond use: record with less gain or farther away" if clipped.any() else "tapped at its end"
        raise ValueError(f"a recording must ring freely for {SHORTEST:g} s after a tap; got one that is {why}")
    enough = np.flatnonzero(lengths >= max(SHORTEST * rate, 0.5 * min(lengths.max(), LONGEST * rate)))
    loudest = sorted(enough, key=lambda i: -float(np.square(signal[begun[i] : ends[i]]).sum()))[:TAPS]
    size = int(min(lengths[loudest].min(), LONGEST * rate))
    traces = np.concatenate([signal[begun[i] : begun[i] + size].T for i in loudest])
    lost = max((begun[i] - onsets[i]) / rate for i in loudest)
    return Ringing(traces, rate, len(loudest), lost, hum)


def _channels(signal: Array) -> Array:
    """The channels, without silent ones and copies of others."""
    channels: list[Array] = []
    for channel in signal.T:
        power = channel @ channel
        copies = (abs(channel @ other) > (1 - 1e-6) * np.sqrt(power * (other @ other)) for other in channels)
        if power > 0 and not any(copies):
            channels.append(channel)
    if not channels:
        raise ValueError("a recording must hold a sound; got silence")
    return np.stack(channels, axis=1)


def _onsets(signal: Array, rate: float) -> list[int]:
    """The first free sample after each tap: a rise of the envelope, its loudest sample, and the end of contact."""
    hop = int(HOP * rate)
    count = len(signal) // hop
    hops = np.square(signal[: count * hop]).sum(axis=1).reshape(count, hop).sum(axis=1)
    before = np.concatenate([[0.0], hops[:-1]])
    risen = np.flatnonzero((hops > RISE * before) & (hops > FAINT * hops.max()))
    onsets: list[int] = []
    for i in risen if len(risen) else [int(hops.argmax())]:
        window = np.abs(signal[i * hop : (i + 2) * hop]).max(axis=1)
        start = int(i * hop + window.argmax() + CONTACT * rate)
        if not onsets or start - onsets[-1] > hop:
            onsets.append(start)
        else:
            onsets[-1] = start
    return onsets


def _clipped(signal: Array) -> Array:
    """Which samples are cut off, (samples,): two runs or more of equal samples at a channel's very top or bottom."""
    cut = np.zeros(len(signal), bool)
    for channel in signal.T:
        for end in (channel.max(), channel.min()):
            flat = np.abs(channel - end) <= 1e-9 * abs(end)
            run = flat & (np.roll(flat, 1) | np.roll(flat, -1))
            if np.sum(run[1:] & ~run[:-1]) >= 2:
                cut |= run
    return cut


def _after(clipped: Array, start: int, end: int) -> int:
    """The first sample from ``start`` on after which none is clipped before ``end``."""
    within = np.flatnonzero(clipped[start:end])
    return int(start + within[-1] + 1) if len(within) else start
