"""Tones of a string, a pipe or a voice: nearly whole multiples of one note, which a shaft's bending tones are not.

High modes of a beam lie almost evenly apart, so that some wood explains every second partial of a string by chance. The
same tones are therefore weighed as the partials f n sqrt(1 + B n^2) of a stiff string (H. Fletcher, J. Acoust. Soc. Am.
36 (1964) 203), by the rules by which `cuefem.measured.matching` weighs a wood: partials that are not heard count
against it, tones beside them too.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from cuefem.cue import Array
from cuefem.measured.matching import RIVAL, TOLERANCE, chances_of_no_mode, weighed
from cuefem.measured.tones import HIGH, LOW, Tone

PARTIALS = 80
FIRST = 4  # the loudest tones are at most this partial
LOUDEST = 12  # tones of which pairs propose a string
STIFFEST = 3e-3  # B of a string; a mode of a bar rises faster
MOST = 64  # strings weighed at a time
FEWEST = 5  # partials of a note: three tones of a heavy cue may be near 1, 2 and 3 times one


class Note(NamedTuple):
    """A string. frequency: of its note, Hz. partials: how many tones are its own. score: ln of its weight."""

    frequency: float
    partials: int
    score: float


def better_note(tones: Sequence[Tone], score: float) -> Note | None:
    """The string that explains tones clearly better than a wood of this weight, if there is one."""
    note = note_of(tones)
    return note if note.partials >= FEWEST and note.score > score + RIVAL else None


def note_of(tones: Sequence[Tone]) -> Note:
    """The string that explains tones best."""
    heard = np.log([tone.frequency for tone in tones])
    wrong = chances_of_no_mode(tones)
    strings = _proposed(np.exp(heard[np.argsort([-tone.level for tone in tones])[:LOUDEST]]))
    best = Note(0.0, 0, -np.inf)
    for piece in np.array_split(strings, -(-len(strings) // MOST)):
        partials = log_partials(*piece.T)
        scores = weighed(partials, heard, wrong, TOLERANCE)
        i = int(np.argmax(scores))
        if scores[i] > best.score:
            near = np.abs(heard[:, None] - partials[i]).min(axis=1) < 3 * TOLERANCE
            best = Note(float(piece[i, 0]), int(near.sum()), float(scores[i]))
    return best


def log_partials(frequency: Array, stiffness: Array) -> Array:
    """ln of the partials, Hz, of strings: (strings, `PARTIALS`)."""
    n = np.arange(1, PARTIALS + 1)
    return np.asarray(np.log(frequency[:, None] * n * np.sqrt(1 + stiffness[:, None] * n**2)))


def _proposed(loud: Array) -> Array:
    """(frequency, B) of strings that put a tone on a low partial, and another one on the partial that is nearest."""
    low, low_order = (each.ravel() for each in np.meshgrid(loud, np.arange(1.0, FIRST + 1), indexing="ij"))
    order = np.maximum(np.rint(loud / (low / low_order)[:, None]), 1)
    # (f/n)^2 = f0^2 (1 + B n^2) at both orders
    lower, other = (low / low_order)[:, None] ** 2, (loud / order) ** 2
    with np.errstate(divide="ignore", invalid="ignore"):
        rise = (other - lower) / (lower * order**2 - other * low_order[:, None] ** 2)
    B = np.clip(np.nan_to_num(rise, nan=0.0, posinf=0.0, neginf=0.0), 0.0, STIFFEST)
    f = np.sqrt(lower / (1 + B * low_order[:, None] ** 2))
    made = np.column_stack([f.ravel(), B.ravel()])
    return made[(made[:, 0] >= LOW / FIRST) & (made[:, 0] <= HIGH)]
