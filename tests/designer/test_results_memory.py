"""What the designer keeps of a design's results is small: no matrix of a beam stays behind (regression)."""

from __future__ import annotations

import gc
import tracemalloc
from dataclasses import replace

from cuefem.designer.answers import answers, with_end_mass
from cuefem.designer.start import first_scene

LARGEST = 1.5e6  # bytes of one design, where the matrices alone take 4e6


def test_the_results_of_a_design_are_small() -> None:
    scene = first_scene()
    with_end_mass(answers(scene))  # fills what is made once
    kept = []
    tracemalloc.start()
    try:
        gc.collect()
        before, _ = tracemalloc.get_traced_memory()
        for mass in (0.16, 0.175):
            kept.append(with_end_mass(answers(replace(scene, ball=replace(scene.ball, mass=mass)))))
        gc.collect()
        after, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert 0 < (after - before) / len(kept) < LARGEST
