"""Effective end mass of a cue by each definition."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from cuefem.analysis.reduction import PAPER_TONE, Reduction, reduction
from cuefem.endmass.definitions import DEFINITIONS, Drive
from cuefem.quantity.display_units import END_MASS, with_unit
from cuefem.results.closed_forms import cue_end_mass
from cuefem.results.records import Record, Table, tabulate
from cuefem.results.solved_design import Solvable, SolvedDesign
from cuefem.show.analysis import Analysis, Rows
from cuefem.show.charts import Chart
from cuefem.show.scene_summary import listed, stroke_line, tip_effect_notes

SQUIRT_END_MASS = "squirt-equivalent end mass"  # the one that pages and tables for people show


@dataclass(frozen=True)
class DefinedEndMass:
    """End mass by one definition.

    Parameters
    ----------
    end_mass : float or None
        Effective end mass m_e, kg; None where the definition has no value.
    cue_end_mass : float or None
        End mass m_c = 4 m_e of the two-part cue in Kim's paper, kg.
    eps : float or None
        m_c over the mass of the ball.
    reason : str
        Why there is no value.
    """

    end_mass: float | None
    cue_end_mass: float | None
    eps: float | None
    reason: str = ""


@dataclass(frozen=True)
class EndMasses(Rows, Analysis):
    """Effective end mass of a cue by each definition.

    Parameters
    ----------
    scene : Scene
        The analysed scene.
    contact_time : float
        Contact time of a rigid cue head-on, s.
    offset : float
        Offset b/R of the stroke.
    definitions : dict of str to DefinedEndMass
        The end mass by the name of its definition.
    reduction : Reduction or None
        The reduction to Kim's two-part cue, if it was asked for.
    """

    contact_time: float
    offset: float
    definitions: dict[str, DefinedEndMass]
    reduction: Reduction | None = field(default=None, repr=False)

    def values(self) -> Record:
        """The numbers in SI units; "reason" only where there is no value."""
        rows = {name: {**vars(mass)} for name, mass in self.definitions.items()}
        for row in rows.values():
            if not row["reason"]:
                del row["reason"]
        record = super().values() | {"definitions": rows}
        return record if self.reduction is None else record | {"reduction": self.reduction.values()}

    def frame_rows(self) -> list[Record]:
        """A row for each definition."""
        return [{"definition": name, **vars(mass)} for name, mass in self.definitions.items()]

    def tables(self) -> list[Table | str]:
        """A row for each definition, and the tables of the reduction."""
        rows = [{"name": name, **vars(mass)} for name, mass in self.definitions.items()]
        own = tabulate(
            "Effective end mass",
            {"definition": lambda row: self._label(row["name"]), "m_e": "end_mass"},
            rows,
            stroke_line(self.scene),
            *(f"{row['name']}: {row['reason']}" for row in rows if row["reason"]),
            "m_e: effective end mass, the transverse inertia of the cue at its tip; `report` and `compare` use squirt; "
            "two-part cue: offset; published end masses and pooltool: [A.31]",
            *tip_effect_notes(self.scene, _tip_effects_note()),
        )
        return [own, *([] if self.reduction is None else self.reduction.tables())]

    def charts(self) -> list[Chart]:
        """The charts of the reduction."""
        return [] if self.reduction is None else self.reduction.charts()

    def _label(self, name: str) -> str:
        """The name of a definition, and its label where that says more."""
        label = DEFINITIONS[name].label_at(self.offset)
        return name if label == name else f"{name} ({label})"


def _tip_effects_note() -> str:
    """Which definitions include effects at the tip: those from a coupled strike."""
    counting, others = (
        [definition.name for definition in DEFINITIONS.values() if definition.includes_tip is c] for c in (True, False)
    )
    return (
        f"{listed(counting)} include tip effects (dome, shear), axial waves and the butt; {listed(others)} "
        "exclude them, A.31 in `strike` the tip effects"
    )


def end_masses(
    scene: Solvable,
    *,
    with_reduction: bool = False,
    near: float = PAPER_TONE,
    cue_ends: Mapping[str, float] | None = None,
) -> EndMasses:
    """Effective end mass of a scene's cue, by each definition.

    Parameters
    ----------
    scene : Scene, or what `cuefem.solve` returns
        A stroke, or a solved one. Definitions of an off-centre stroke use its offset.
    with_reduction : bool
        Whether the result also has the `cuefem.reduction` to the two-part cue of Kim's paper.
    near, cue_ends
        Of that reduction.

    Returns
    -------
    EndMasses
        Show it with ``print``, in a notebook, or by ``.save("end_mass.html")``.

    Raises
    ------
    ValueError
        If an end mass is not positive: the tip is too soft for the contact time.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> scene = cf.Scene(cf.Cue((cf.Segment(0.7, 0.012, 0.021, wood),), body_mass=0.43), tip=cf.Tip(contact_time=1e-3))
    >>> masses = cf.end_masses(scene)
    >>> round(1e3 * masses.definitions["stick"].end_mass, 1)  # g
    4.8
    """
    design = SolvedDesign.of(scene)
    scene = design.scene
    masses: dict[str, DefinedEndMass] = {each.name: _end_mass(design, each.name) for each in DEFINITIONS.values()}
    reduced = reduction(design, near=near, cue_ends=cue_ends) if with_reduction else None
    return EndMasses(scene, scene.contact_time, scene.stroke.offset, masses, reduced)


def _end_mass(design: SolvedDesign, name: Drive) -> DefinedEndMass:
    scene = design.scene
    try:
        end_mass = design.end_mass(name, None)
    except ValueError as error:
        return DefinedEndMass(None, None, None, str(error))
    if not end_mass > 0:
        time = with_unit(float(scene.contact_time), "s")
        raise ValueError(
            f"an end mass of {with_unit(end_mass, END_MASS)} ({name}) is not plausible; the tip is too soft for a "
            f"contact of {time}: check dimensions, E and contact time"
        )
    cue_end = float(cue_end_mass(end_mass))
    return DefinedEndMass(end_mass, cue_end, cue_end / scene.ball.mass)
