"""Recordings of a freely suspended, tapped shaft, made from its own modes; no tests."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.io import wavfile

import cuefem as cf
from cuefem.effects.damping import section_loss
from cuefem.parameters.parts import main_material, with_material

LOSS = 0.012  # of maple, used where a file states none
PULSE = 3e-4  # s, a small hard mallet: a half sine
BEFORE, SECONDS = 0.15, 1.2  # s of silence before a tap, and from one to the next
MICROPHONES = (0.04, 0.12)  # positions of two microphones, from the tip, over the length


def other_wood(cue: cf.Cue, *, E: float = 1.15, G: float = 0.85, rho: float = 1.06) -> cf.Cue:
    """The cue with the main material's constants times these factors."""
    wood = main_material(cue)
    return with_material(cue, wood, replace(wood, E=E * wood.E, G=G * wood.G, rho=rho * wood.rho))


def tap_sound(shaft: cf.Cue, rate: float = 44100.0, *, missing: Sequence[int] = ()) -> np.ndarray:
    """Signal of two microphones after a tap at the butt, (samples, 2); missing: silent modes, 1 the lowest."""
    result = cf.modes(shaft, 26)
    loss = result.loss_factors(section_loss(shaft, result.points, None))
    loss = loss if loss.max() > 0 else np.full(len(loss), LOSS)
    at_butt, _ = result.shape(shaft.length)
    t = np.arange(int(SECONDS * rate)) / rate - BEFORE
    sound, sounding = np.zeros((len(t), len(MICROPHONES))), t >= 0
    for k, w in enumerate(result.omega):
        if k + 1 in missing or result.frequencies[k] > 0.45 * rate:
            continue
        amplitude = at_butt[k] * result.shape(shaft.length * np.array(MICROPHONES))[0][k]
        x, decay = w * PULSE / np.pi, loss[k] * w / 2
        pulse = np.pi / 4 * (np.sinc((x - 1) / 2) + np.sinc((x + 1) / 2))
        tone = np.exp(-decay * t[sounding]) * np.cos(np.sqrt(w**2 - decay**2) * t[sounding])
        sound[sounding] += pulse * amplitude * tone[:, None]
    return sound


def recording(sound: np.ndarray, snr: float, seed: int, *, taps: int = 3) -> np.ndarray:
    """Taps of a sound in white noise ``snr`` dB below its mean power, 16 bits of full scale 1."""
    clean = np.tile(sound, (taps, 1))
    noise = np.sqrt(np.mean(clean**2) * 10 ** (-snr / 10))
    signal = clean + noise * np.random.default_rng(seed).standard_normal(clean.shape)
    return np.round(signal / np.abs(signal).max() * 0.98 * 32767) / 32768


def save_wav(path: Path, samples: np.ndarray, rate: int = 44100) -> None:
    """Write samples of full scale 1 as 16 bits."""
    wavfile.write(path, rate, np.round(samples * 32768).astype(np.int16))
