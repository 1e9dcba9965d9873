"""How likely is it that tones which are not the shaft's fit it as well as these do?

The modes of a shaft whose E and G are free lie so close together that many sounds match the modes of some wood. So the
same search is run over random sets of tones: as many tones, equally dense, each drawn evenly (in ln f) between the
midpoints to its neighbours. The p-value is the share of all sets, the recorded one included, that are explained as well
as the recorded one or better. If the tones have nothing to do with the shaft, it falls below `LEVEL` in a share `LEVEL`
of recordings.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cuefem.cue import Array
from cuefem.measured.matching import SPREADS, TWICE, UNHEARD, WRONG, ModeTable
from cuefem.measured.tones import HIGH, LOW, Tone

LEVEL = 0.01
SETS = 199
WIDTH = 8e-3  # relative, of a tone against its mode in this search; the steps of E and G/E are as fine
STEP_E, RATIOS = 0.012, 31  # of ln E; number of G/E
BIN = 4e-3  # of ln f
SEED = 20
Bits = NDArray[np.uint32]


def random_sets(frequencies: Array, count: int, seed: int = SEED) -> Array:
    """Random sets of ln f, (count, tones), as dense as these frequencies, Hz."""
    heard = np.sort(np.log(frequencies))
    if len(heard) == 1:
        return np.random.default_rng(seed).uniform(np.log(LOW), np.log(HIGH), (count, 1))
    middles = (heard[1:] + heard[:-1]) / 2
    low = np.maximum(np.concatenate([[2 * heard[0] - middles[0]], middles]), np.log(LOW))
    high = np.minimum(np.concatenate([middles, [2 * heard[-1] - middles[-1]]]), np.log(HIGH))
    return np.asarray(low + (high - low) * np.random.default_rng(seed).uniform(size=(count, len(heard))))


def by_chance(table: ModeTable, tones: Sequence[Tone]) -> float:
    """The p-value of these tones; 1 if there are none. Cost: a table of a few thousand woods, and sums over it."""
    clear = [tone.frequency for tone in tones if tone.kind == "tone"]
    if not clear:
        return 1.0
    sets = np.vstack([np.sort(np.log(clear)), random_sets(np.array(clear), SETS)])
    best = _best(table, sets)
    return float(np.mean(best >= best[0] - 1e-4))


def _best(table: ModeTable, sets: Array) -> Array:
    """The score of the wood that explains each set best, as `ModeTable` weighs it: (sets,)."""
    E = np.arange(table.E[0], table.E[-1] + STEP_E / 2, STEP_E)
    place = np.clip(np.rint((sets - np.log(LOW)) / BIN).astype(int), 0, int(np.log(HIGH / LOW) / BIN))
    best = np.full(len(sets), -np.inf)
    score, hits = np.empty((2, len(sets), len(E)), np.float32)
    chosen, own = np.empty((2, len(sets), len(E)), np.uint32)
    for ratio in np.linspace(*table.shaft.ratios, RATIOS):
        value, bit, audible, known = _explained(table, E, np.full(len(E), ratio))
        score[:] = known
        chosen[:], hits[:] = 0, 0.0
        for column in place.T:
            score += value[column]
            np.take(bit, column, axis=0, out=own)
            hits += own > 0
            chosen |= own
        below: Any = chosen.copy()
        for shift in (1, 2, 4, 8, 16):
            below |= below >> shift
        score += _count(below & audible & ~chosen) * np.float32(np.log(UNHEARD))
        score -= np.float32(TWICE) * (hits - _count(chosen))
        np.maximum(best, score.max(axis=1), out=best)
    return best


def _explained(table: ModeTable, E: Array, ratio: Array) -> tuple[Any, Bits, Bits, Array]:
    """For every ln f and wood the weight and the bit of the nearest mode, (bins, woods); each wood's audible modes and
    prior."""
    f = table.log_frequencies(E, ratio)
    heard = (np.log(LOW) + BIN * np.arange(int(np.log(HIGH / LOW) / BIN) + 1)).astype(np.float32)
    nearest = np.array([np.searchsorted((row[1:] + row[:-1]) / 2, heard) for row in f]).T
    gap = heard[:, None] - f.astype(np.float32)[np.arange(len(E)), nearest]
    inside = (f > np.log(LOW)) & (f < np.log(HIGH))
    count = np.maximum(inside.sum(axis=1), 1)
    level = np.log1p(-WRONG) - np.log(WIDTH * np.sqrt(2 * np.pi) * count)
    own = level.astype(np.float32) - np.float32(0.5 / WIDTH**2) * gap**2
    none = np.float32(np.log(WRONG / np.log(HIGH / LOW)))
    bit = np.where(own > none, np.uint32(1) << nearest.astype(np.uint32), np.uint32(0))
    audible = (inside * (np.uint32(1) << np.arange(f.shape[1], dtype=np.uint32))).sum(axis=1).astype(np.uint32)
    known = ((np.column_stack([E, ratio]) - table.shaft.start[:2]) / SPREADS) ** 2
    return np.maximum(own, none), bit, audible, -known.sum(axis=1) / 2


def _count(bits: Any) -> Any:
    """How many bits of 32 are set."""
    bits = bits - ((bits >> 1) & 0x55555555)
    bits = (bits & 0x33333333) + ((bits >> 2) & 0x33333333)
    return (((bits + (bits >> 4)) & 0x0F0F0F0F) * np.uint32(0x01010101)) >> 24
