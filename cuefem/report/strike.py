"""One strike by every model: record and table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from rich.console import Group

from cuefem.beam.tip import TipModes
from cuefem.contact.strike import strike
from cuefem.cue import LumpedCue
from cuefem.effects import TipEffect
from cuefem.endmass.drives import stick_at_offset
from cuefem.endmass.lumped import impulse, lump_modes
from cuefem.quantity import scalar
from cuefem.report.record import Record
from cuefem.report.table import NONE, table_of, with_caption
from cuefem.report.words import _tip_effects, assumptions, degrees, grams, millimetres
from cuefem.scene import Outcome, Scene
from cuefem.squirt import alciatore_a31, natural_pivot_length
from cuefem.tip_modes import tip_modes_of


def two_part_cues(scene: Scene, offsets: Sequence[float], tip: TipModes) -> list[LumpedCue | None]:
    """The scene's cue as the impulse solver takes it at each offset, without effects at its tip.

    Its end mass is that of a tip that sticks at this offset; None where none has that squirt. A lumped cue keeps its
    end mass. tip: the cue's tip modes.
    """
    if scene.lumped is not None:
        return [replace(scene.lumped, coupling=0.0)] * len(offsets)
    bare = replace(scene, effects=tuple(effect for effect in scene.effects if not isinstance(effect, TipEffect)))
    try:
        masses = stick_at_offset(tip, _at(bare, np.array(offsets)))
    except ValueError:
        if len(offsets) == 1:
            return [None]
        return [cue for offset in offsets for cue in two_part_cues(scene, [offset], tip)]
    return [LumpedCue(scene.axial_mass, felt) for felt in masses.tolist()]


def _coupling_slope(scene: Scene, tip: TipModes) -> float:
    """What effects at the tip add to `two_part_cues`, as a coupling per b/R; zero where no lumped cue has them.

    It is found at the scene's own offset, or head on at 0.1.
    """
    offset = scalar("Stroke.offset", scene.stroke.offset) or 0.1
    try:
        cue = lump_modes(_at(scene, offset), tip)
    except ValueError:  # an offset, or an effect, beyond any lumped cue's coupling
        return 0.0
    return scalar("LumpedCue.coupling", cue.coupling) / abs(offset)


def _coupled(cue: LumpedCue | None, coupling: float) -> LumpedCue | None:
    """The cue with a coupling; None where no cue has it."""
    try:
        return cue and replace(cue, coupling=coupling)
    except ValueError:
        return None


def _at(scene: Scene, offset: Any) -> Scene:
    return replace(scene, stroke=replace(scene.stroke, offset=offset))


def bare_scene(scene: Scene, cue: LumpedCue) -> Scene:
    """The scene with a lumped cue in its cue's place, and without effects."""
    return replace(scene, cue=cue, effects=())


def outcome_record(outcome: Outcome, scene: Scene) -> Record:
    """A strike's outcome with the natural pivot length of its squirt (none at offset 0)."""
    names = ("squirt", "ball_speed", "ball_velocity", "spin", "cue_speed", "impulse", "duration", "regime", "energy")
    found = {name: getattr(outcome, name) for name in (*names, "unknowns", "error")}
    return found | {"pivot_length": _pivot_length(scene, outcome.squirt)}


def _pivot_length(scene: Scene, squirt: Any) -> Any:
    if not np.all(scene.stroke.offset):
        return None
    radii = {"radius": scene.ball.radius, "dome_radius": scene.dome_radius}
    return natural_pivot_length(scene.stroke.offset, squirt, **radii)


def strike_record(scene: Scene, outcome: Outcome | None = None) -> Record:
    """One strike by every model, by the model's name; a model that says less leaves keys out.

    outcome: of the coupled strike, where it is known. "lumped" is there where effects at the tip couple the cue's
    motion along and across; "two-part" and "A.31" leave those effects out. They take the end mass of a tip that sticks
    at this offset, and are left out where there is none.
    """
    offset, tip = scalar("Stroke.offset", scene.stroke.offset), tip_modes_of(scene)
    (cue,), coupling = two_part_cues(scene, [offset], tip), _coupling_slope(scene, tip) * abs(offset)
    models = {"coupled": outcome_record(strike(scene) if outcome is None else outcome, scene)}
    coupled = _coupled(cue, coupling) if coupling else None
    if coupled is not None:
        models["lumped"] = outcome_record(impulse(bare_scene(scene, coupled)), scene)
    if cue is not None:
        models["two-part"] = outcome_record(impulse(bare_scene(scene, cue)), scene)
        a31 = _a31(scene, cue)
        models["A.31"] = {"squirt": a31, "pivot_length": _pivot_length(scene, a31)}
    return {
        "end_mass": None if cue is None else cue.end_mass,
        "coupling": 0.0 if coupled is None else coupling,
        "models": models,
    }


def _a31(scene: Scene, cue: LumpedCue) -> Any:
    return alciatore_a31(scene.stroke.offset, mass_ratio=scene.ball.mass / cue.end_mass, inertia=scene.ball.inertia)


_ROWS: tuple[tuple[str, str, Any], ...] = (
    ("squirt", "squirt", degrees),
    ("natural pivot length", "pivot_length", millimetres),
    ("ball speed", "ball_speed", lambda v: f"{v:.4f} m/s"),
    ("ball velocity, normal", "ball_velocity", lambda v: f"{v[1]:.4f} m/s"),
    ("ball velocity, tangent", "ball_velocity", lambda v: f"{v[0]:.4f} m/s"),
    ("spin", "spin", lambda v: f"{v:.3f} rad/s"),
    ("cue speed after", "cue_speed", lambda v: f"{v:.4f} m/s"),
    ("contact time", "duration", lambda v: f"{1e3 * v:.4f} ms"),
    ("how it went", "regime", str),
    ("estimated error", "error", lambda v: f"{v:.1e}"),
)

MISCUE = "this stroke miscues: the tip slips on the ball to the end; its squirt and pivot length are no shot's"


def strike_table(record: Record, scene: Record) -> Group:
    """One strike, a column for each model."""
    models = record["models"]
    offset = scene["stroke"]["offset"]
    table = table_of(f"Strike at offset b/R = {offset:g}", ["", *models])
    for label, key, written in _ROWS:
        values = [model.get(key) for model in models.values()]
        if any(value is not None for value in values):
            table.add_row(label, *(NONE if value is None else written(value) for value in values))
    felt = NONE if record["end_mass"] is None else grams(record["end_mass"])
    coupled = record["models"].get("coupled", {})
    missed = [MISCUE] if coupled.get("regime") == "miscue" else []
    exact = ", modes kept for 0.5 % of squirt" if "length" in scene["cue"] and coupled.get("error") is None else ""
    models = [f"coupled: vibrating shaft in time{exact}; two-part and A.31: end mass m_e {felt} (offset)"]
    return with_caption(table, *missed, assumptions(scene), *models, *_left_out(scene, record, "/kg"))


def _left_out(scene: Record, record: Record, unit: str) -> list[str]:
    """What the lumped models make of the effects at the tip."""
    lumped = (
        f"; lumped has them as a coupling of {record['coupling']:.4g} {unit}, the tip's "
        "speed across the cue by a unit of impulse along it"
        if record["coupling"]
        else ""
    )
    return _tip_effects(scene, f"two-part and A.31 leave the effects at the tip out{lumped}")
