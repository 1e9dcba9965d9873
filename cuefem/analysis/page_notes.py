"""What the page of a report says below its numbers: segments, definitions, accuracy of the model."""

from __future__ import annotations

import math
from dataclasses import dataclass

from cuefem.cue.materials import material_name
from cuefem.endmass.definitions import DEFINITIONS
from cuefem.quantity.display_units import with_heading
from cuefem.results.closed_forms import alciatore_a31_mass_ratio
from cuefem.results.quantities import DASH, RESULTS, format_value
from cuefem.results.records import Table
from cuefem.results.solved_design import Solvable, SolvedDesign
from cuefem.show.analysis import Analysis


@dataclass(frozen=True)
class Segments(Analysis):
    """The segments of the shaft of ``scene``."""

    def tables(self) -> list[Table | str]:
        """A row for each segment, from tip to butt."""
        cue = self.scene.shaft
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
        return [Table("Segments, from tip to butt", head, tuple(rows), texts=(5,))]


def segments(scene: Solvable) -> Segments:
    """The segments of the shaft as a table, from tip to butt.

    Parameters
    ----------
    scene : Scene
        A scene with a cue of segments.

    Returns
    -------
    Segments

    Raises
    ------
    TypeError
        If it is not a Scene.
    ValueError
        If its cue is lumped, which has no segments.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> scene = cf.usual_scene(cf.Cue((cf.Segment(0.7, 0.01275, 0.021, wood),), body_mass=0.43))
    >>> cf.segments(scene).tables()[0].rows
    (('0.0', '700.0', '12.75 – 21.00', '–', '111.8 g', 'E 12.6 GPa'),)
    """
    scene = SolvedDesign.of(scene).scene
    _ = scene.shaft  # ValueError for a lumped cue
    return Segments(scene)


@dataclass(frozen=True)
class EndMassDefinitions(Analysis):
    """The definitions of the end mass.

    alciatore_end_mass: the one whose squirt is that of the stroke by Alciatore's formula, kg; None without one.
    """

    alciatore_end_mass: float | None

    def tables(self) -> list[Table | str]:
        """A line for each definition, and the end mass by the formula, which published values use."""
        lines: list[Table | str] = [f"{known.name}: {known.meaning}." for known in DEFINITIONS.values()]
        if self.alciatore_end_mass is not None:
            mass = format_value("end_mass", self.alciatore_end_mass)
            lines.append(
                f"[A.31]: with {mass} Alciatore's formula (technical proof A.31, billiards.colostate.edu) gives this "
                "squirt. By this definition alone measured cues have 5.8 to 14 g (handbook: Effective end mass)."
            )
        return lines


def definitions(scene: Solvable) -> EndMassDefinitions:
    """The definitions of the end mass, with the value of Alciatore's for the stroke.

    Parameters
    ----------
    scene : Scene
        A stroke.

    Returns
    -------
    EndMassDefinitions
        With the end mass by Alciatore's formula, kg; None where no end mass gives the squirt.

    Raises
    ------
    TypeError
        If it is not a Scene.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> scene = cf.usual_scene(cf.Cue((cf.Segment(0.7, 0.01275, 0.021, wood),), body_mass=0.43))
    >>> round(cf.definitions(scene).alciatore_end_mass, 5)
    0.00846
    """
    design = SolvedDesign.of(scene)
    ball, offset = design.scene.ball, float(design.scene.stroke.offset)
    squirt = design.squirt_factor * design.strike().squirt
    try:
        ratio = alciatore_a31_mass_ratio(offset, squirt, inertia=ball.inertia)
    except ValueError:
        return EndMassDefinitions(design.scene, None)
    mass = float(ball.mass / ratio)
    return EndMassDefinitions(design.scene, mass if 0 < mass < math.inf else None)


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


@dataclass(frozen=True)
class ModelAccuracy(Analysis):
    """How far the model can be trusted; the size of its error is in `cuefem.results.uncertainty`.

    error: estimated relative numerical error of the stroke; None without an estimate.
    """

    error: float | None

    def tables(self) -> list[Table | str]:
        """The numerical error, what is known of the tip's model, and of ratios."""
        tip = SPRING if self.scene.contact_terms.tip is None else LAW
        if self.error is None:
            return [tip, COMPARING]
        return [f"Estimated numerical error of squirt, ball speed and spin: {100 * self.error:.2g} %.", tip, COMPARING]


def accuracy(scene: Solvable) -> ModelAccuracy:
    """How far the model can be trusted.

    Parameters
    ----------
    scene : Scene
        A stroke.

    Returns
    -------
    ModelAccuracy
        With the estimated relative numerical error; None without an estimate.

    Raises
    ------
    TypeError
        If it is not a Scene.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> scene = cf.usual_scene(cf.Cue((cf.Segment(0.7, 0.01275, 0.021, wood),), body_mass=0.43))
    >>> [text.partition(" ")[0] for text in cf.accuracy(scene).tables()]
    ['The', 'A']
    """
    design = SolvedDesign.of(scene)
    return ModelAccuracy(design.scene, design.strike().error)
