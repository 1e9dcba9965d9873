"""One strike by every model: record and sheet."""

from __future__ import annotations

from dataclasses import replace

from cuefem.contact.outcome import MISSED, grip_of
from cuefem.contact.strike import strike_modes
from cuefem.endmass.lumped import impulse
from cuefem.quantity.fields import scalar
from cuefem.report.models import (
    a31_squirt,
    bare_scene,
    coupling_slope,
    model_notes,
    offset_words,
    two_part_cues,
    with_coupling,
)
from cuefem.report.scene_words import assumptions
from cuefem.results.closed_forms import pivot_length
from cuefem.results.quantities import DEFINITION_OF_MISCUE, GRIPS, RESULTS, written
from cuefem.results.records import Record, Sheet
from cuefem.scene import Outcome, Scene
from cuefem.tip_modes import Solved


def outcome_record(outcome: Outcome, scene: Scene) -> Record:
    """A strike's outcome with the natural pivot length of its squirt (None at offset 0)."""
    names = ("squirt", "ball_speed", "ball_velocity", "spin", "cue_speed", "impulse", "duration", "regime")
    record = {name: getattr(outcome, name) for name in names} | {"grip": grip_of(outcome)}
    record |= {name: getattr(outcome, name) for name in ("energy", "unknowns", "error")}
    return record | {"pivot_length": pivot_length(scene, outcome.squirt)}


def strike_record(scene: Scene, outcome: Outcome | None = None, *, solved: Solved | None = None) -> Record:
    """One strike by every model, by the model's name; a model that says less leaves keys out.

    "coupled" is the vibrating cue in time. "two-part" (the impulse solver) and "A.31" take the end mass of a tip that
    sticks at this offset, leave out effects at the tip, and are missing if no end mass has that squirt. "lumped" is
    the impulse solver with the coupling that effects at the tip add, if they add any. outcome: of the coupled strike,
    if it is known already; solved: the scene's modes, if they are.
    """
    solved = solved or Solved(scene)
    offset = scalar("Stroke.offset", scene.stroke.offset)
    (cue,) = two_part_cues(scene, [offset], solved.tip_stuck)
    coupling = coupling_slope(scene, solved.tip_stuck) * abs(offset)
    models = {"coupled": outcome_record(outcome or strike_modes(scene, solved.tip), scene)}
    coupled = with_coupling(cue, coupling) if coupling else None
    if coupled is not None:
        models["lumped"] = outcome_record(impulse(bare_scene(scene, coupled)), scene)
    if cue is not None:
        models["two-part"] = outcome_record(impulse(bare_scene(scene, cue)), scene)
        squirt = a31_squirt(scene, cue)
        models["A.31"] = {"squirt": squirt, "pivot_length": pivot_length(scene, squirt)}
    return {
        "end_mass": None if cue is None else cue.end_mass,
        "coupling": 0.0 if coupled is None else coupling,
        "models": models,
    }


# What is shown of a strike, in this order; a vector by its parts (along the tangent, along the normal).
BRIEF = ("squirt", "pivot_length", "ball_speed", "spin", "cue_speed", "grip")
WHOLE = (
    *("squirt", "pivot_length", "ball_speed", ("ball_velocity", 1, "normal"), ("ball_velocity", 0, "tangent")),
    *("spin", "cue_speed", "duration", "grip", "error"),
)


def models_sheet(record: Record, shown: tuple[str | tuple[str, int, str], ...] = WHOLE) -> Sheet:
    """A column for each model, and a row for every quantity that any of the models has."""
    rows = []
    for row in shown:
        name, part, words = row if isinstance(row, tuple) else (row, None, "")
        values = [model.get(name) for model in record["models"].values()]
        if any(value is not None for value in values):
            label = f"{RESULTS[name].words}, {words}" if words else RESULTS[name].words
            parts = [value if value is None or part is None else value[part] for value in values]
            rows.append((label, *(written(name, value, brief=shown is BRIEF) for value in parts)))
    return Sheet("", ("", *record["models"]), tuple(rows))


SLOWER = 0.02  # relative: a lumped cue whose ball is slower by more gets a note
LUMPED = (
    "ball speed: use the coupled value; the lumped models omit axial waves, which raise the restitution of the whole "
    "cue above that of its tip"
)
OFF = "uncertainty of squirt: cuefem report"
MISCUE = f"miscue: {DEFINITION_OF_MISCUE}. Ignore squirt and pivot length"


def grip_warning(grip: str) -> str:
    """What stands beside a squirt that miscues, or to which slip adds; "" for others."""
    return MISCUE if grip in MISSED else GRIPS[grip][1] if grip in ("partial slip", "slides") else ""


def strike_sheet(record: Record, scene: Record) -> Sheet:
    """One strike, a column for each model."""
    coupled = record["models"]["coupled"]
    missed = [MISCUE] if coupled["grip"] in MISSED else []
    exact = (
        ", numerical error of squirt at most 0.1 % for 95 % of default strikes"
        if "length" in scene["cue"] and coupled["error"] is None
        else ""
    )
    pivots = any(model.get("pivot_length") is not None for model in record["models"].values())
    return replace(
        models_sheet(record),
        title=f"Strike at offset b/R = {scene['stroke']['offset']:.4g}",
        notes=(
            *missed,
            assumptions(scene),
            f"coupled: vibrating shaft in time{exact}; two-part and A.31: two masses, with the end mass of a "
            f"tip that sticks ({offset_words(scene)}; `cuefem end-mass`)",
            *([f"natural pivot length: {PIVOT}"] if pivots else []),
            *([] if missed else [f"contact: {GRIPS[coupled['grip']][1]}"]),
            *_on_speed(record, scene),
            OFF,
            *model_notes(scene, record, "/kg"),
        ),
    )


def _on_speed(record: Record, scene: Record) -> list[str]:
    """Why the ball of a lumped cue is slower, where waves along the cue act in the coupled strike alone."""
    if "AxialWaves" not in {effect["type"] for effect in scene["effects"]}:
        return []
    coupled, *others = (model["ball_speed"] for model in record["models"].values() if "ball_speed" in model)
    return [LUMPED] if any(other < (1 - SLOWER) * coupled for other in others) else []


PIVOT = "distance from the tip to the point about which pivoting the cue cancels squirt (back-hand English)"
