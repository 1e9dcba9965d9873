"""Effective end mass of a scene by each definition: record and table."""

from __future__ import annotations

from cuefem.endmass.definitions import DEFINITIONS
from cuefem.results.closed_forms import cue_end_mass
from cuefem.results.quantities import with_unit
from cuefem.results.records import Record, Table, tabulate
from cuefem.scene import Scene
from cuefem.scene.solved_scene import SolvedScene
from cuefem.show.scene_summary import assumptions, listed, tip_effect_notes

SQUIRT_END_MASS = "squirt-equivalent end mass"  # the one that pages and tables for people show


def end_mass_record(scene: Scene, *, solved: SolvedScene | None = None) -> Record:
    """End mass m_e, kg, by each definition, with [Kim]'s m_c and eps = m_c/M.

    A definition `at_offset` takes the offset of the scene's stroke; where a definition has no value, "reason" states
    why. solved: the scene's modes, if already computed.
    """
    solved = solved or SolvedScene(scene)
    return {
        "contact_time": scene.contact_time,
        "offset": scene.stroke.offset,
        "definitions": {name: _end_mass(solved, name) for name in DEFINITIONS},
    }


def _end_mass(solved: SolvedScene, drive: str) -> Record:
    scene = solved.scene
    try:
        end_mass = float(DEFINITIONS[drive].of_design(solved))
    except ValueError as error:
        return {"end_mass": None, "cue_end_mass": None, "eps": None, "reason": str(error)}
    if not end_mass > 0:
        time = with_unit(float(scene.contact_time), "s")
        raise ValueError(
            f"an end mass of {with_unit(end_mass, 'kg')} ({drive}) is not plausible; the tip is too soft for a "
            f"contact of {time}: check dimensions, E and contact time"
        )
    cue_end = float(cue_end_mass(end_mass))
    return {"end_mass": end_mass, "cue_end_mass": cue_end, "eps": cue_end / scene.ball.mass}


def tabulate_end_masses(record: Record, scene: Record, *, paper: bool = False) -> Table:
    """A row for each definition. paper: add [Kim]'s m_c and eps."""
    papers = {"m_c": "cue_end_mass", "eps": "{eps:.4f}"} if paper else {}
    their = "m_c = 4 m_e: end mass of the two-part cue in Kim's paper (nu_c 1/3); eps: m_c over the mass of the ball"
    rows = [{"name": name, **values} for name, values in record["definitions"].items()]
    return tabulate(
        "Effective end mass",
        {
            "definition": lambda row: _definition(row["name"], record["offset"]),
            "m_e": "end_mass",
            **papers,
        },
        rows,
        assumptions(scene),
        *(f"{row['name']}: {row['reason']}" for row in rows if row["end_mass"] is None),
        "m_e: effective end mass, the transverse inertia of the cue at its tip; `report` and `compare` use squirt; "
        "lumped models: offset without tip effects; published end masses and pooltool: [A.31]",
        *([their] if paper else []),
        *tip_effect_notes(scene, _tip_effects_note()),
    )


def _definition(name: str, offset: float) -> str:
    """The name of a definition, and its label where that says more."""
    label = DEFINITIONS[name].label_at(offset)
    return name if label == name else f"{name} ({label})"


def _tip_effects_note() -> str:
    """Which definitions include effects at the tip: those from a coupled strike."""
    counting, others = (
        [definition.name for definition in DEFINITIONS.values() if definition.includes_tip is c] for c in (True, False)
    )
    return (
        f"{listed(counting)} include tip effects (dome, shear), axial waves and the butt; {listed(others)} and the "
        "two-part model of `strike` and `report` exclude them"
    )
