"""Every listed result of one stroke of a cue."""

from __future__ import annotations

from dataclasses import dataclass

from cuefem.analysis.end_mass import SQUIRT_END_MASS
from cuefem.results.computable_results import listed_results
from cuefem.results.quantities import RESULTS, UNITS, format_value
from cuefem.results.records import Record, Table
from cuefem.results.solved_design import Solvable, SolvedDesign
from cuefem.show.analysis import Analysis, Rows
from cuefem.show.scene_summary import stroke_line


@dataclass(frozen=True)
class CueNumbers(Rows, Analysis):
    """Every listed result of the registry.

    Parameters
    ----------
    scene : Scene
        The analysed stroke.
    numbers : dict of str to float or None
        The results by their names in `RESULTS`, in SI units; None where the scene has none.
    squirt_end_mass : float or None
        The end mass that has the squirt of the stroke, kg; None where no end mass has it.
    """

    numbers: dict[str, float | None]
    squirt_end_mass: float | None

    def values(self) -> Record:
        """The results by name."""
        return {**self.numbers}

    def frame_rows(self) -> list[Record]:
        """A row for each quantity."""
        return [{"quantity": name, "value": value, "unit": UNITS.get(name, "")} for name, value in self.numbers.items()]

    def tables(self) -> list[Table | str]:
        """A row for each result."""
        title = f"Cue, and stroke at offset b/R {self.scene.stroke.offset:.4g}"
        end_mass = (SQUIRT_END_MASS, format_value("end_mass", self.squirt_end_mass))
        rows = [(RESULTS[name].label, format_value(name, value)) for name, value in self.numbers.items()]
        return [Table(title, ("", "value"), (end_mass, *rows), (stroke_line(self.scene),))]


def cue_numbers(scene: Solvable) -> CueNumbers:
    """All listed results, and the end mass that has the squirt.

    Parameters
    ----------
    scene : Scene
        A stroke.

    Returns
    -------
    CueNumbers
        In SI units by name; None where the scene has no such result.

    Raises
    ------
    TypeError
        If it is not a Scene.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> scene = cf.usual_scene(cf.Cue((cf.Segment(0.7, 0.01275, 0.021, wood),), body_mass=0.43))
    >>> found = cf.cue_numbers(scene)
    >>> f"{1e3 * found.numbers['shaft_mass']:.1f} g, end mass {1e3 * found.squirt_end_mass:.2f} g"
    '111.8 g, end mass 6.56 g'
    """
    design = SolvedDesign.of(scene)
    try:
        mass = design.end_mass("squirt", None)
    except ValueError:
        mass = None
    return CueNumbers(design.scene, listed_results(design), mass)
