"""Recordings: .wav files as samples."""

from __future__ import annotations

import io
import struct
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.io import wavfile

from cuefem.cue import Array
from cuefem.io.errors import InputError, read_bytes

LONGEST = 120.0  # s: a few taps, no concert
LARGEST_SOUND = 100_000_000  # bytes: as long, of two channels at 96 kHz in 32 bit


@dataclass(frozen=True)
class Recording:
    """samples: (samples, channels), of full scale 1. rate: samples a second, Hz."""

    samples: Array
    rate: float


def load_recording(path: str | Path) -> Recording:
    """A .wav file of 8, 16, 24 or 32 bit or of floats, of `LONGEST` seconds at most. Errors: InputError."""
    path = Path(path)
    if path.suffix.lower() != ".wav":
        raise InputError(path, "", f"must end in .wav; got {path.suffix!r} (ffmpeg -i tap.m4a tap.wav converts)")
    content = read_bytes(path, LARGEST_SOUND)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", wavfile.WavFileWarning)  # what phones write beside the sound
            rate, samples = wavfile.read(io.BytesIO(content))
    except (ValueError, TypeError, ArithmeticError, MemoryError, struct.error, UnboundLocalError) as error:
        detail = "" if isinstance(error, UnboundLocalError) else f" ({error})"  # no data in it
        raise InputError(path, "", f"must be a .wav file of sound{detail}") from None
    if samples.size == 0 or rate <= 0:
        raise InputError(path, "", "must hold a sound; got none")
    if len(samples) > LONGEST * rate:
        raise InputError(path, "", f"must last {LONGEST:g} s at most; got {len(samples) / rate:.0f} s")
    return Recording(_scaled(samples.reshape(len(samples), -1)), float(rate))


def _scaled(samples: np.ndarray) -> Array:
    """Samples as fractions of full scale; 24 bits stand in the upper ones of 32."""
    if samples.dtype.kind == "f":
        return samples.astype(float)
    middle = 128.0 if samples.dtype.kind == "u" else 0.0
    return (samples.astype(float) - middle) / 2.0 ** (8 * samples.dtype.itemsize - 1)
