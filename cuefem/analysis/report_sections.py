"""The report of a cue: one list of sections, which terminal, page and JSON show in its order."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

from cuefem.analysis.contact_history import ContactHistory
from cuefem.analysis.design_changes import design_changes
from cuefem.analysis.end_mass import SQUIRT_END_MASS, end_masses
from cuefem.analysis.natural_frequencies import natural_frequencies
from cuefem.analysis.reduction import reduction
from cuefem.analysis.squirt_curve import squirt_curve
from cuefem.analysis.strike_models import strike_models
from cuefem.analysis.tip_impacts import tip_impacts
from cuefem.analysis.verdict import verdict
from cuefem.cue.materials import material_name
from cuefem.endmass.definitions import DEFINITIONS
from cuefem.quantity.display_units import with_heading
from cuefem.results.closed_forms import alciatore_a31_mass_ratio
from cuefem.results.computable_results import listed_results
from cuefem.results.quantities import DASH, RESULTS, format_value
from cuefem.results.records import Record, Table, tabulate_values, value_rows
from cuefem.results.solved_design import SolvedDesign
from cuefem.scene import Scene
from cuefem.show.analysis import Analysis
from cuefem.show.scene_summary import assumptions, scene_record


@dataclass(frozen=True)
class CueNumbers(Analysis):
    """Every listed result of the registry, by its name, in SI units."""

    numbers: dict[str, float | None]
    squirt_end_mass: float | None

    def values(self) -> Record:
        """The results by name."""
        return self.numbers

    def tables(self) -> list[Table | str]:
        """A row for each result."""
        about = scene_record(self.scene)
        title = f"Cue, and stroke at offset b/R {self.scene.stroke.offset:.4g}"
        end_mass = (SQUIRT_END_MASS, format_value("end_mass", self.squirt_end_mass))
        return [tabulate_values(title, [end_mass, *value_rows(self.numbers)], assumptions(about))]


@dataclass(frozen=True)
class Remarks(Analysis):
    """Tables and texts of a page that no program reads."""

    shown: list[Table | str]

    def tables(self) -> list[Table | str]:
        """The tables and texts."""
        return self.shown


def segments(design: SolvedDesign) -> Remarks:
    """A row for each segment, from tip to butt."""
    cue = design.scene.shaft
    position, diameter = RESULTS["position"].number, RESULTS["radius"].number
    rows = (
        (
            position(x),
            position(s.length),
            f"{diameter(s.tip_diameter)} – {diameter(s.butt_diameter)}",
            f"{diameter(s.tip_bore)} – {diameter(s.butt_bore)}" if s.tip_bore or s.butt_bore else DASH,
            format_value("mass", s.mass),
            material_name(s.material) + (f", core {material_name(s.core)}" if s.core else ""),
        )
        for x, s in zip(cue.nodes[:-1], cue.segments, strict=True)
    )
    head = (*(with_heading(name, "m") for name in ("at", "length", "diameter", "bore")), "mass", "material")
    return Remarks(design.scene, [Table("Segments, from tip to butt", head, tuple(rows), texts=(5,))])


def definitions(design: SolvedDesign) -> Remarks:
    """The definitions of the end mass, and the end mass by Alciatore's formula, which published values use."""
    scene, squirt = design.scene, design.strike().squirt
    lines: list[Table | str] = [f"{known.name}: {known.meaning}." for known in DEFINITIONS.values()]
    try:
        ratio = alciatore_a31_mass_ratio(float(scene.stroke.offset), squirt, inertia=scene.ball.inertia)
    except ValueError:
        return Remarks(scene, lines)
    mass = float(scene.ball.mass / ratio)
    if 0 < mass < math.inf:
        lines.append(
            f"[A.31]: with {format_value('end_mass', mass)} Alciatore's formula (technical proof A.31, "
            "billiards.colostate.edu) gives this squirt. By this definition alone measured cues have 5.8 to 14 g "
            "(handbook: Effective end mass)."
        )
    return Remarks(scene, lines)


def accuracy(design: SolvedDesign) -> Remarks:
    """How far the model can be trusted; the size of its error is in `cuefem.results.uncertainty`."""
    error = design.strike().error
    numerical = f"Estimated numerical error of squirt, ball speed and spin: {100 * (error or 0):.2g} %."
    tip = SPRING if design.scene.contact_terms.tip is None else LAW
    return Remarks(design.scene, [*([] if error is None else [numerical]), tip, COMPARING])


LAW = (
    "The tip is modelled as elastic leather of given height, dome and E. Its compliance is that of the elastic solid "
    "to 0.3 % (95 % of the contacts of 36 tips) and 2.0 % (maximum of 20 others); it has not been tested on real tips. "
    "Computed squirt of soft leather is 9 % below medium, of hard 3 % below (b/R 0.3); players find no difference, to "
    "±5 % at best. Do not choose a tip's hardness by this number."
)
SPRING = (
    "The tip is modelled as a linear spring with the given contact time. No real tip was measured for it, and squirt "
    "depends on it: for a spring tip without dome and shear by 50 % from 0.7 to 2 ms."
)
COMPARING = (
    "A ratio of two designs is more accurate than the squirt of one: a low-deflection shaft was measured with 0.72 "
    "of the squirt of a maple shaft; the model computes 0.70 to 0.78 (handbook: Measured squirt)."
)


def cue_numbers(design: SolvedDesign) -> CueNumbers:
    """All listed results, and the end mass that has the squirt."""
    try:
        mass = design.end_mass("squirt", None)
    except ValueError:
        mass = None
    return CueNumbers(design.scene, listed_results(design), mass)


def contact_history(design: SolvedDesign) -> ContactHistory:
    """The contact over time."""
    return ContactHistory(design.scene, design.strike().energy, design.strike())


class Section(NamedTuple):
    """A part of the report.

    key: of JSON, and of the class of the page's section. page_only: long or slow parts, which terminal and JSON leave
    out; folded: closed on a page. needs: what the scene must have.
    """

    key: str
    title: str
    analyse: Callable[..., Analysis]
    page_only: bool = False
    folded: bool = False
    needs: Callable[[Scene], Any] = lambda scene: True


def has_segments(scene: Scene) -> bool:
    """Whether the cue is drawn, not lumped."""
    return bool(scene.cue.segments)


def _has_leather(scene: Scene) -> bool:
    return scene.contact_terms.tip is not None


SECTIONS = (
    Section("verdict", "Squirt", verdict),
    Section("reduction", "From the drawing to squirt", reduction),
    Section("advice", "Design changes", design_changes, page_only=True, needs=has_segments),
    Section("squirt", "Squirt and tip offset", squirt_curve),
    Section("modes", "Natural frequencies", natural_frequencies, needs=has_segments),
    Section("numbers", "Cue and stroke", cue_numbers),
    Section("end_masses", "Effective end mass", end_masses),
    Section("tip", "Leather tip, head-on impact", tip_impacts, needs=_has_leather),
    Section("strike", "Stroke by model", strike_models, page_only=True, folded=True),
    Section("contact", "The contact", contact_history, page_only=True, folded=True),
    Section("segments", "Segments", segments, page_only=True, folded=True, needs=has_segments),
    Section("meanings", "Definitions of the end mass", definitions, page_only=True, folded=True),
    Section("accuracy", "Accuracy of the model", accuracy, page_only=True, folded=True),
)
