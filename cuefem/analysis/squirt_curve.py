"""Squirt and natural pivot length against the tip offset, by every model."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, ClassVar

import numpy as np

from cuefem.analysis.reduction import PAPER_CUE_ENDS
from cuefem.analysis.strike_models import PIVOT_NOTE, a31_cues, a31_squirt, lumped_strike, two_part_cue
from cuefem.analysis.verdict import with_cue
from cuefem.cue import LumpedCue
from cuefem.files.reference_cues import reference_cues
from cuefem.results.closed_forms import pivot_length
from cuefem.results.quantities import format_value
from cuefem.results.records import Record, Table
from cuefem.results.solved_design import OFFSETS, Solvable, SolvedDesign, at_offset, coupled_curve
from cuefem.scene import Scene
from cuefem.scene.solved_scene import SolvedScene
from cuefem.show.analysis import Analysis, MoreCharts, Rows
from cuefem.show.charts import Chart
from cuefem.show.offset_charts import offset_charts
from cuefem.show.scene_summary import stroke_line

FINE_OFFSETS = tuple(i / 40 for i in range(1, 25))  # b/R of the curves of a page; a table has each 0.1
MAX_ROWS = 20  # a table of more offsets has only each 0.1
OWN = "coupled, this cue"
# CSS classes of the models' curves.
STYLES = {
    OWN: "c1",
    "two-part, this cue": "c2",
    "two-part, 12 g": "c5",
    "A.31, this cue": "c4",
}

MODELS = (
    "Coupled: the vibrating cue, integrated in time. Two-part replaces the cue by its axial mass and its end mass at "
    "the offset of this stroke; A.31 by the end mass at each offset without effects at the tip, as published end "
    "masses are. 12 g: the two-part cue with the paper’s cue end, of which the effective end mass is a quarter."
)


@dataclass(frozen=True)
class SquirtCurve(Rows, Analysis):
    """Squirt and natural pivot length against the tip offset.

    Parameters
    ----------
    scene : Scene
        The analysed stroke.
    offsets : list of float
        Offsets b/R.
    end_mass : float or None
        End mass of the two-part cue, kg, at the offset of the stroke; None if no end mass has the squirt.
    a31_end_mass : list of float or None
        End mass of A.31 at each offset, kg, without effects at the tip; None where no end mass fits.
    squirt_factor : float, default 1.0
        Of a calibration: that of the coupled curve over the computed one, and of the reference cue beside it.
    models : dict of str to dict
        "squirt", rad, and "pivot_length", m, at each offset by the model's name; nan where no end mass fits.
    """

    offsets: list[float]
    end_mass: float | None
    a31_end_mass: list[float | None]
    models: dict[str, dict[str, Any]]
    squirt_factor: float = 1.0
    about: ClassVar[str] = (
        "The tip offset b/R is the distance of the contact from the ball’s centre line, in ball radii. Pivoting the "
        "cue about the point at the natural pivot length from the tip cancels squirt. Curves end at the first miscue."
    )

    def frame_rows(self) -> list[Record]:
        """A row for each model and offset."""
        return [
            {"model": name, "offset": offset} | {key: values[i] for key, values in model.items()}
            for name, model in self.models.items()
            for i, offset in enumerate(self.offsets)
        ]

    def tables(self) -> list[Table | str]:
        """A table with a row for each offset."""
        return [self.table()]

    def table(self) -> Table:
        """Squirt, natural pivot length and contact state of the coupled strike, a row for each offset."""
        own = self.models[OWN]
        rows = []
        for i in self._rows():
            offset, regime = self.offsets[i], own["regime"][i]
            values = (None if regime == "miscue" else own[name][i] for name in ("squirt", "pivot_length"))
            texts = map(format_value, ("squirt", "pivot_length"), values)
            rows.append((f"{offset:g}", *texts, regime))
        head = ("b/R", "squirt", "natural pivot length", "contact")
        left_out = f"{len(rows)} of {len(self.offsets)} offsets, each 0.1."
        notes = (
            stroke_line(self.scene),
            PIVOT_NOTE,
            *([left_out] if len(rows) < len(self.offsets) else []),
        )
        return Table("Squirt and tip offset", head, tuple(rows), notes, texts=(3,))

    def _rows(self) -> list[int]:
        """Indices of the offsets in the table: all; of more than `MAX_ROWS` those at each 0.1, if there are any."""
        every = list(range(len(self.offsets)))
        tenths = [i for i in every if math.isclose(10 * self.offsets[i], round(10 * self.offsets[i]), abs_tol=1e-9)]
        return tenths if tenths and len(every) > MAX_ROWS else every

    def charts(self) -> list[Chart]:
        """Squirt and natural pivot length against the offset, of this cue and of the first reference cue."""
        name, reference = next(iter(reference_cues().items()))
        lines = [("this cue", "c1", self.models[OWN])]
        other = with_cue(self.scene, reference)
        beside = None if other.cue == self.scene.cue else _other_curve(other, tuple(self.offsets), self.squirt_factor)
        if beside is not None:
            lines.append((name, "c2", beside))
        return self._charts(lines, "{}", 260.0)

    def more_charts(self) -> list[MoreCharts]:
        """The same of published models, which no calibration changes."""
        about = MODELS if self.squirt_factor == 1.0 else f"{MODELS} Of these curves only the coupled one is calibrated."
        lines = [(name, STYLES[name], curve) for name, curve in self.models.items()]
        return [MoreCharts("Other models", self._charts(lines, "{} by model", 220.0), about)]

    def _charts(self, lines: Sequence[tuple[str, str, Record]], title: str, height: float) -> list[Chart]:
        regimes, own = self.models[OWN]["regime"], self.scene.stroke.offset
        return [*offset_charts(lines, self.offsets, own, height=height, regimes=regimes, title=title)]


@lru_cache(maxsize=16)  # the designer draws the same reference for every change of the cue
def _other_curve(scene: Scene, offsets: tuple[float, ...], squirt_factor: float) -> Record | None:
    """The coupled curve of another cue; None if its strike fails."""
    try:
        return coupled_curve(scene, offsets, SolvedScene(scene).tip, squirt_factor)
    except (ValueError, RuntimeError):
        return None


def squirt_curve(scene: Solvable, offsets: Sequence[float] = OFFSETS) -> SquirtCurve:
    """Squirt and natural pivot length at each offset, by every model.

    Parameters
    ----------
    scene : Scene
        A stroke; its own offset is only marked.
    offsets : sequence of float
        Offsets b/R, one at least.

    Returns
    -------
    SquirtCurve
        Models: the coupled strike; two-part, with this cue's end mass and with Kim's 12 g; Alciatore's formula [A.31].

    Raises
    ------
    ValueError
        If there is no offset, or one is not between -1 and 1.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> scene = cf.usual_scene(cf.Cue((cf.Segment(0.7, 0.01275, 0.021, wood),), body_mass=0.43))
    >>> curve = cf.squirt_curve(scene, (0.1, 0.3))
    >>> np.degrees(curve.models["coupled, this cue"]["squirt"]).round(2).tolist()
    [0.59, 1.75]
    """
    if not len(offsets):
        raise ValueError("squirt_curve offsets must be at least one b/R between -1 and 1; got none")
    design = SolvedDesign.of(scene)
    scene, solved = design.scene, design.solved
    (own, _), published = two_part_cue(design), a31_cues(design, offsets)
    guess = LumpedCue.two_part(scene.axial_mass, PAPER_CUE_ENDS["Kim's guess"])
    cues: dict[str, list[LumpedCue | None]] = {
        "two-part, this cue": [own] * len(offsets),
        "two-part, 12 g": [guess] * len(offsets),
        "A.31, this cue": published,
    }
    struck = [at_offset(scene, offset) for offset in offsets]
    models: Record = {OWN: coupled_curve(scene, offsets, solved.tip, design.squirt_factor)}
    for name, each in cues.items():
        squirt = a31_squirt if name.startswith("A.31") else lambda at, cue: lumped_strike(at, cue).squirt
        pairs = zip(struck, each, strict=True)
        angles = np.array([np.nan if cue is None else float(squirt(at, cue)) for at, cue in pairs])
        models[name] = {"squirt": angles, "pivot_length": pivot_length(scene, angles, np.array(offsets))}
    return SquirtCurve(
        scene,
        list(offsets),
        None if own is None else own.end_mass,
        [None if cue is None else cue.end_mass for cue in published],
        models,
        design.squirt_factor,
    )
