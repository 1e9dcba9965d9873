"""Committed tables of long studies, derived again in part; no tests.

A study computes its whole table when it is run. A test that computes it whole again would take as long, so it derives
a part of the rows, drawn once by a seed, and holds them against the page.
"""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from typing import TypeVar

from cuefem.validation import disagreements

T = TypeVar("T")


def drawn(among: Sequence[T], count: int, seed: int) -> tuple[T, ...]:
    """Some of these, in their order."""
    places = sorted(random.Random(seed).sample(range(len(among)), count))
    return tuple(among[place] for place in places)


def drawn_of(among: Mapping[str, T], count: int, seed: int) -> dict[str, T]:
    """Some entries, in their order."""
    return {name: among[name] for name in drawn(tuple(among), count, seed)}


def not_committed(page: str, derived: str) -> list[str]:
    """Lines of a derived part of a page that do not stand in it in this order; empty where all do.

    A number may be one off in its last printed place, as in `cuefem.validation.disagreements`.
    """
    left, missing = page.splitlines(), []
    for line in derived.splitlines():
        place = next((i for i, other in enumerate(left) if not disagreements(other, line)), None)
        if place is None:
            missing.append(line)
        else:
            left = left[place + 1 :]
    return missing
