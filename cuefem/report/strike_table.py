"""One strike by every model, and the lumped cues beside the coupled strike: record and sheet."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from cuefem.beam.tip import TipModes
from cuefem.contact.strike import strike_modes
from cuefem.cue import LumpedCue
from cuefem.endmass.definitions import stick_at_offsets
from cuefem.endmass.lumped import impulse, lump_modes
from cuefem.report.scene_words import assumptions, tip_effect_notes
from cuefem.results.closed_forms import alciatore_a31, pivot_length
from cuefem.results.quantities import DEFINITION_OF_MISCUE, REGIMES, RESULTS, written
from cuefem.results.records import Record, Sheet
from cuefem.results.solved_design import at_offset
from cuefem.scene import Outcome, Scene
from cuefem.scene.solved_scene import Solved


def lumped_cues(
    scene: Scene, offsets: Sequence[float], tip: TipModes
) -> tuple[dict[str, list[LumpedCue | None]], float]:
    """The lumped cues of "lumped" and "two-part" at each offset, None where there is none; and the coupling per b/R.

    "two-part" has the end mass of a tip that sticks, without effects at the tip; "lumped" adds the coupling of these
    effects, and is missing where they add none.
    """
    cues, slope = two_part_cues(scene, offsets, tip), coupling_slope(scene, tip)
    coupled = [_with_coupling(cue, slope * abs(b)) for cue, b in zip(cues, offsets, strict=True)]
    return ({"lumped": coupled} if slope else {}) | {"two-part": cues}, slope


def two_part_cues(scene: Scene, offsets: Sequence[float], tip: TipModes) -> list[LumpedCue | None]:
    """The lumped cue that the impulse solver takes at each offset, with the end mass of a tip that sticks there.

    Effects at the tip are left out. None at an offset where no end mass has that squirt. A lumped cue keeps its own
    end mass. tip: the cue's tip modes as an end mass takes them.
    """
    if scene.lumped is not None:
        return [replace(scene.lumped, coupling=0.0)] * len(offsets)
    masses = stick_at_offsets(tip, scene.bare, offsets)
    return [None if math.isnan(felt) else LumpedCue(scene.axial_mass, felt) for felt in masses]


def coupling_slope(scene: Scene, tip: TipModes) -> float:
    """The coupling per b/R that effects at the tip add to `two_part_cues`; zero if no lumped cue has such a coupling.

    It is found at the scene's own offset, or at 0.1 for a head-on stroke.
    """
    offset = scene.stroke.offset or 0.1
    try:
        cue = lump_modes(at_offset(scene, offset), tip)
    except ValueError:  # an offset, or an effect, beyond any lumped cue's coupling
        return 0.0
    return cue.coupling / abs(offset)


def _with_coupling(cue: LumpedCue | None, coupling: float) -> LumpedCue | None:
    """The cue with a coupling; None if no cue can have it."""
    try:
        return cue and replace(cue, coupling=coupling)
    except ValueError:
        return None


def lumped_strike(scene: Scene, cue: LumpedCue) -> Outcome:
    """What the impulse solver says of a scene with a lumped cue in its cue's place, and without effects."""
    return impulse(replace(scene, cue=cue, effects=()))


def a31_squirt(scene: Scene, cue: LumpedCue) -> Any:
    """The squirt of Alciatore's formula [A.31] for the end mass of a lumped cue, rad."""
    return alciatore_a31(scene.stroke.offset, mass_ratio=scene.ball.mass / cue.end_mass, inertia=scene.ball.inertia)


def outcome_record(outcome: Outcome, scene: Scene) -> Record:
    """A strike's outcome with the natural pivot length of its squirt (None at offset 0)."""
    names = ("squirt", "ball_speed", "ball_velocity", "spin", "cue_speed", "impulse", "duration", "regime")
    record = {name: getattr(outcome, name) for name in (*names, "energy", "unknowns", "error")}
    return record | {"pivot_length": pivot_length(scene, outcome.squirt)}


def strike_record(scene: Scene, outcome: Outcome | None = None, *, solved: Solved | None = None) -> Record:
    """One strike by every model, by the model's name; a model that says less leaves keys out.

    "coupled" is the vibrating cue in time. "two-part" (the impulse solver) and "A.31" take the end mass of a tip that
    sticks at this offset, leave out effects at the tip, and are missing if no end mass has that squirt. "lumped" is
    the impulse solver with the coupling that effects at the tip add, if they add any. outcome: of the coupled strike,
    if it is known already; solved: the scene's modes, if they are.
    """
    solved = solved or Solved(scene)
    offset = scene.stroke.offset
    cues, slope = lumped_cues(scene, [offset], solved.tip_stuck)
    models = {"coupled": outcome_record(outcome or strike_modes(scene, solved.tip), scene)}
    models |= {name: outcome_record(lumped_strike(scene, cue), scene) for name, (cue,) in cues.items() if cue}
    (cue,) = cues["two-part"]
    if cue:
        squirt = a31_squirt(scene, cue)
        models["A.31"] = {"squirt": squirt, "pivot_length": pivot_length(scene, squirt)}
    return {
        "end_mass": cue and cue.end_mass,
        "coupling": slope * abs(offset) if "lumped" in models else 0.0,
        "models": models,
    }


# What is shown of a strike, in this order; a vector by its parts (along the tangent, along the normal).
SHOWN: tuple[tuple[str, int | None, str], ...] = (
    *((name, None, "") for name in ("squirt", "pivot_length", "ball_speed")),
    *(("ball_velocity", 1, ", normal"), ("ball_velocity", 0, ", tangent")),
    *((name, None, "") for name in ("spin", "cue_speed", "duration", "regime", "error")),
)
SLOWER = 0.02  # relative: a lumped cue whose ball is slower by more gets a note
LUMPED = (
    "ball speed: use the coupled value; the lumped models omit axial waves, which raise the restitution of the whole "
    "cue above that of its tip"
)
PIVOT = "distance from the tip to the point about which pivoting the cue cancels squirt (back-hand English)"
OFF = "uncertainty of squirt: cuefem report"
MISCUE = f"miscue: {DEFINITION_OF_MISCUE}. Ignore squirt and pivot length"


def regime_warning(regime: str) -> str:
    """What stands beside a squirt that miscues, or to which slip adds; "" for others."""
    return MISCUE if regime == "miscue" else REGIMES[regime] if regime in ("partial slip", "gross slip") else ""


def strike_sheet(record: Record, scene: Record) -> Sheet:
    """A column for each model, and a row for every quantity that any of the models has."""
    coupled = record["models"]["coupled"]
    rows = []
    for name, part, words in SHOWN:
        values = [model.get(name) for model in record["models"].values()]
        if any(value is not None for value in values):
            parts = (value if value is None or part is None else value[part] for value in values)
            rows.append((RESULTS[name].words + words, *(written(name, value) for value in parts)))
    missed = [MISCUE] if coupled["regime"] == "miscue" else []
    exact = (
        ", numerical error of squirt at most 0.1 % for 95 % of default strikes"
        if "length" in scene["cue"] and coupled["error"] is None
        else ""
    )
    offset = "offset, without the effects at the tip" if scene["effects_at_tip"] else "offset"
    lumped = (
        f"; lumped includes them as a coupling of {record['coupling']:.4g} /kg, the tip's speed across the cue by a "
        "unit of impulse along it"
        if record["coupling"]
        else ""
    )
    notes = (
        *missed,
        assumptions(scene),
        f"coupled: vibrating shaft in time{exact}; two-part and A.31: two masses, with the end mass of a tip that "
        f"sticks ({offset}; `cuefem end-mass`)",
        *([f"natural pivot length: {PIVOT}"] if any(row[0] == RESULTS["pivot_length"].words for row in rows) else []),
        *([] if missed else [f"contact: {REGIMES[coupled['regime']]}"]),
        *_on_speed(record, scene),
        OFF,
        *tip_effect_notes(scene, f"two-part and A.31 leave the effects at the tip out{lumped}"),
    )
    return Sheet(f"Strike at offset b/R = {scene['stroke']['offset']:.4g}", ("", *record["models"]), tuple(rows), notes)


def _on_speed(record: Record, scene: Record) -> list[str]:
    """Why the ball of a lumped cue is slower, where waves along the cue act in the coupled strike alone."""
    if "AxialWaves" not in {effect["type"] for effect in scene["effects"]}:
        return []
    coupled, *others = (model["ball_speed"] for model in record["models"].values() if "ball_speed" in model)
    return [LUMPED] if any(other < (1 - SLOWER) * coupled for other in others) else []
