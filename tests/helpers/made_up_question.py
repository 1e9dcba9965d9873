"""A question registered by its line in `QUESTIONS` alone; no tests."""

from __future__ import annotations

from dataclasses import dataclass

import cuefem as cf
from cuefem.results.records import Table
from cuefem.results.solved_design import SolvedDesign
from cuefem.show.analysis import Analysis


@dataclass(frozen=True)
class Weight(Analysis):
    """The weight of a cue, N."""

    weight: float

    def tables(self) -> list[Table | str]:
        """A row with the weight."""
        return [Table("Weight of the cue", ("", "N"), (("weight", f"{self.weight:.3f}"),))]


def weight(scene: cf.Scene | SolvedDesign) -> Weight:
    """Weigh a cue.

    Parameters
    ----------
    scene : Scene
        A stroke.
    """
    scene = SolvedDesign.of(scene).scene
    return Weight(scene, 9.81 * scene.cue.mass)
