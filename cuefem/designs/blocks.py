"""Blocks of designs, the tasks of a study: computed anywhere, in any order, each bit for bit as it is alone."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import islice
from time import perf_counter
from typing import NamedTuple

import numpy as np

from cuefem.cue import Array
from cuefem.designs.design_key import code_digest, design_key
from cuefem.designs.sampling import Value
from cuefem.designs.study import Study
from cuefem.quantity.display_units import displayed_in

FIRST_SIZE, MAX_SIZE = 16, 1024  # designs of a block, which is stored in one transaction
LOST = "ended its worker twice: out of memory, or killed"  # the reason for a design that is not computed
SHORT = 0.1  # s; a block that takes less doubles the size of the next ones


class Block(NamedTuple):
    """Designs by number, with their parameter values."""

    numbers: list[int]
    values: list[tuple[Value, ...]]

    def singles(self) -> list[Block]:
        """A block of each design."""
        return [Block([number], [values]) for number, values in zip(*self, strict=True)]


class BlockResult(NamedTuple):
    """A block's keys, and its responses, (designs, responses) in SI, nan if missing; failures: reasons by place in it.

    version: hash of the code that computed it. keys: b"" if they were not asked for. values: None if only keys
    were. seconds: of the computation. is_lost: whether its workers ended, so that it must not be stored.
    """

    block: Block
    version: str
    keys: bytes
    values: Array | None
    failures: dict[int, str]
    seconds: float = 0.0
    is_lost: bool = False


class Blocks:
    """Designs, by number and values, in blocks whose size grows while they take less than `SHORT`."""

    def __init__(self, designs: Iterable[tuple[int, tuple[Value, ...]]]) -> None:
        self.designs, self.size = iter(designs), FIRST_SIZE

    def __iter__(self) -> Iterator[Block]:
        while pairs := [*islice(self.designs, self.size)]:
            numbers, values = zip(*pairs, strict=True)
            yield Block([*numbers], [*values])

    def adapt(self, result: BlockResult) -> None:
        """Set the size of the next blocks by the seconds of one."""
        if result.seconds < SHORT and len(result.block.numbers) == self.size < MAX_SIZE:
            self.size *= 2


def block_keys(study: Study, block: Block) -> BlockResult:
    """The keys of a block."""
    begun = perf_counter()
    scenes = (study.scene_or_reason(values) for values in block.values)
    keys = b"".join(design_key(scene, study.at, study.squirt_factor) for scene in scenes)
    return BlockResult(block, code_digest(), keys, None, {}, perf_counter() - begun)


@displayed_in("metric")
def compute_block(study: Study, with_keys: bool, block: Block) -> BlockResult:
    """The responses of a block, reasons in metric units, and its keys if they are needed."""
    begun = perf_counter()
    scenes = [study.scene_or_reason(values) for values in block.values]
    keys = b"".join(design_key(scene, study.at, study.squirt_factor) for scene in scenes) if with_keys else b""
    evaluation = study.evaluate_scenes(scenes)
    failures = {i: reason for i, reason in enumerate(evaluation.reasons) if reason}
    return BlockResult(block, code_digest(), keys, evaluation.values, failures, perf_counter() - begun)


def lost_block(study: Study, block: Block) -> BlockResult:
    """The result of a block that cannot be computed: every design failed, to be tried again by the next run."""
    missing = np.full((len(block.numbers), len(study.responses)), np.nan)
    failures = dict.fromkeys(range(len(block.numbers)), LOST)
    return BlockResult(block, code_digest(), b"", missing, failures, is_lost=True)
