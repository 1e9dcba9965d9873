"""How well does a tap test tell a shaft's wood, and its end mass?

Each cue of meshes/ is given other wood (`TRUE` times its file's E, G and density), hung free and tapped at its butt end
by a half-sine of 0.3 ms; two microphones near the tip hear the sum of its damped modes, sampled at 48 kHz with 16 bits,
in white noise. `cuefem.measured.wood` has the file, the weighed mass and the recording; errors are medians over
`SEEDS`.

`python -m studies.measured.tap example.wav` writes such a recording of pool_maple to try `cuefem tap` on. About 100 s.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from scipy.io import wavfile

from cuefem import Cue, end_mass, modes
from cuefem.effects.loss import section_loss
from cuefem.measured.fit import TapFit
from cuefem.measured.ringing import ringing
from cuefem.measured.tones import tones
from cuefem.measured.wood import TapTest
from cuefem.parts import main_material, with_material
from cuefem.report.tap_table import draw_spectrum
from studies import pages
from studies.pages import table
from studies.strokes import NAMES, cue, scene

TRUE = {"E": 1.15, "G": 0.85, "rho": 1.06}
NOISES = (10.0, 20.0, 30.0)  # dB, mean power of the ringing over that of the noise
SEEDS = 3
LOSS = 0.012  # maple's, where a file gives none
PULSE = 3e-4  # s, a small hard mallet
BEFORE, SECONDS = 0.15, 1.2  # s of silence before a tap, and from one to the next
EARS = (0.04, 0.12)  # places of the microphones, of the length from the tip


@cache
def true(name: str) -> Cue:
    """A cue of meshes/ whose main material is other than its file says."""
    return other_wood(cue(name), **TRUE)


def other_wood(drawn: Cue, *, E: float = 1.0, G: float = 1.0, rho: float = 1.0) -> Cue:
    wood = main_material(drawn)
    return with_material(drawn, wood, replace(wood, E=E * wood.E, G=G * wood.G, rho=rho * wood.rho))


def ringing_shaft(shaft: Cue, rate: float = 48000.0, *, missing: Sequence[int] = (), split: float = 0.0) -> np.ndarray:
    """What the two microphones hear of one tap, without noise, (samples, 2).

    missing: modes (1 the lowest) that do not sound. split: relative distance of the tones of the two planes.
    """
    found = modes(shaft, 26)
    loss = found.loss_factors(section_loss(shaft, found.system, None))
    loss = loss if loss.max() > 0 else np.full(len(loss), LOSS)
    at_butt, _ = found.shape(shaft.length)
    t = np.arange(int(SECONDS * rate)) / rate - BEFORE
    sound = np.zeros((len(t), len(EARS)))
    after = t >= 0
    for k in range(len(found.frequencies)):
        if k + 1 in missing or found.frequencies[k] > 0.45 * rate:
            continue
        heard = at_butt[k] * found.shape(shaft.length * np.array(EARS))[0][k]
        for plane, share in ((1 + split / 2, 1.0), (1 - split / 2, 0.6))[: 2 if split else 1]:
            w = plane * found.omega[k]
            decay = loss[k] * w / 2
            tone = np.exp(-decay * t[after]) * np.cos(np.sqrt(w**2 - decay**2) * t[after])
            sound[after] += share * _pulse(w) * heard * tone[:, None]
    return sound


def _pulse(w: float) -> float:
    """Fourier transform of a half-sine of length `PULSE`, over that at 0."""
    x = w * PULSE / np.pi
    return float(np.pi / 4 * (np.sinc((x - 1) / 2) + np.sinc((x + 1) / 2)))


def recording(sound: np.ndarray, snr: float, seed: int, *, taps: int = 1, clip: float = np.inf) -> np.ndarray:
    """Taps of a sound with noise ``snr`` dB below its mean power, full scale 1; cut off at ``clip`` of its peak."""
    whole = np.tile(sound, (taps, 1))
    noise = np.sqrt(np.mean(whole**2) * 10 ** (-snr / 10))
    heard = whole + noise * np.random.default_rng(seed).standard_normal(whole.shape)
    peak = np.abs(heard).max()
    return np.round(np.clip(heard, -clip * peak, clip * peak) / peak / min(clip, 1.0) * 0.98 * 32767) / 32768


@cache
def hung(name: str) -> TapTest:
    """The file, hung, and the true shaft's mass."""
    return TapTest(cue(name), mass=true(name).shaft_mass)


@cache
def fits(name: str, snr: float) -> tuple[TapFit, ...]:
    sound = ringing_shaft(true(name))
    return tuple(hung(name).fit(tones(ringing(recording(sound, snr, seed), 48000))) for seed in range(SEEDS))


def rows() -> Iterator[list[str | float]]:
    for name in NAMES:
        wood, felt, drawn = main_material(true(name)), end_mass(scene(true(name))), end_mass(scene(cue(name)))
        for snr in NOISES:
            found = fits(name, snr)
            counts = sorted(sum(m.mode is not None for m in fit.matched) for fit in found)
            off = np.array(
                [[fit.wood.E / wood.E, fit.wood.G / wood.G, end_mass(scene(fit.cue)) / felt] for fit in found]
            )
            errors = np.median(np.abs(100 * (off - 1)), axis=0)
            said = np.median([100 * np.array(fit.errors[:2]) / (fit.wood.E, fit.wood.G) for fit in found], axis=0)
            cells = [errors[0], said[0], errors[1], said[1], errors[2], abs(100 * (drawn / felt - 1))]
            digits = (2, 2, 1, 1, 2, 2)
            numbers = (f"{value:.{d}f}" for value, d in zip(cells, digits, strict=True))
            yield [name, f"{snr:.0f}", f"{counts[0]} to {counts[-1]}", *numbers]


def text() -> str:
    columns = ["cue", "SNR, dB", "tones matched", "E off, %", "E ±, %", "G off, %", "G ±, %"]
    own = table([*columns, "end mass off, %", "file's end mass off, %"], rows())
    given = ", ".join(f"{name} {value:g}" for name, value in TRUE.items())
    return (
        f"# A tap test on recordings made by the model\n\nTrue wood over the file's: {given}. Medians of {SEEDS} "
        f"recordings; ±: the standard deviation that the fit tells, a model error of 0.2 % of each tone and 0.5 g of "
        f"the scale included.\n\n{own}"
    )


def draw(axes: Any) -> None:
    heard = ringing(recording(ringing_shaft(true("pool_maple")), 20.0, 0), 48000)
    draw_spectrum(axes, hung("pool_maple").fit(tones(heard)), heard)


def write_example(path: Path) -> None:
    """Three taps of pool_maple with other wood, 44.1 kHz, stereo, 16 bits, 25 dB."""
    samples = recording(ringing_shaft(true("pool_maple"), 44100), 25.0, 0, taps=3)
    wavfile.write(path, 44100, np.round(samples * 32768).astype(np.int16))
    print(f"wrote {path}: pool_maple's shaft with other wood, {1e3 * true('pool_maple').shaft_mass:.1f} g")


STUDY = pages.Study(
    __file__,
    text,
    {"tap.svg": pages.Figure(draw, size=(9.0, 4.4))},
    # Two cues, the whole cue not among them: it alone takes as long.
    again={"two cues": pages.Again(text, left_out=3 * len(NOISES), instead={"NAMES": pages.some(NAMES[:-1], 2)})},
)


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].endswith(".wav"):
        sys.exit("python -m studies.measured.tap, or python -m studies.measured.tap RECORDING.wav for one to try")
    if len(sys.argv) > 1:
        write_example(Path(sys.argv[1]))
    else:
        STUDY.write()
