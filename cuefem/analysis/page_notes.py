"""What the page of a report says below its numbers: segments, definitions, accuracy of the model."""

from __future__ import annotations

import math

from cuefem.cue import Cue
from cuefem.cue.materials import material_name
from cuefem.endmass.definitions import DEFINITIONS
from cuefem.quantity.display_units import with_heading
from cuefem.results.closed_forms import alciatore_a31_mass_ratio
from cuefem.results.quantities import DASH, RESULTS, format_value
from cuefem.results.records import Table
from cuefem.scene import Scene

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


def page_notes(scene: Scene, squirt: float, error: float | None) -> dict[str, tuple[str, list[Table | str]]]:
    """The notes of a stroke's page: title and tables or lines, by key.

    squirt: calibrated, rad. error: estimated relative numerical error of the strike, if any.
    """
    notes: dict[str, tuple[str, list[Table | str]]] = {}
    if scene.lumped is None:
        notes["segments"] = ("Segments", [segment_table(scene.shaft)])
    notes["meanings"] = ("Definitions of the end mass", [*_definitions(scene, squirt)])
    notes["accuracy"] = ("Accuracy of the model", [*_accuracy(scene, error)])
    return notes


def segment_table(cue: Cue) -> Table:
    """A row for each segment, from tip to butt."""
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
    return Table("Segments, from tip to butt", head, tuple(rows), texts=(5,))


def _definitions(scene: Scene, squirt: float) -> list[str]:
    """A line for each definition, and the end mass of the squirt by Alciatore's formula, which published values use."""
    lines = [f"{known.name}: {known.meaning}." for known in DEFINITIONS.values()]
    try:
        ratio = alciatore_a31_mass_ratio(float(scene.stroke.offset), squirt, inertia=scene.ball.inertia)
    except ValueError:
        return lines
    mass = float(scene.ball.mass / ratio)
    if not 0 < mass < math.inf:
        return lines
    return [
        *lines,
        f"[A.31]: with {format_value('end_mass', mass)} Alciatore's formula (technical proof A.31, "
        "billiards.colostate.edu) gives this squirt. By this definition alone measured cues have 5.8 to 14 g "
        "(handbook: Effective end mass).",
    ]


def _accuracy(scene: Scene, error: float | None) -> list[str]:
    """The numerical error, what is known of the tip's model, and of ratios."""
    tip = SPRING if scene.contact_terms.tip is None else LAW
    if error is None:
        return [tip, COMPARING]
    return [f"Estimated numerical error of squirt, ball speed and spin: {100 * error:.2g} %.", tip, COMPARING]
