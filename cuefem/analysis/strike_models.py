"""One stroke by the coupled strike, by the two-part cue and by Alciatore's formula."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from cuefem.cue import LumpedCue
from cuefem.endmass.definitions import stick_at_offsets
from cuefem.endmass.lumped import impulse
from cuefem.quantity.display_units import END_MASS, with_unit
from cuefem.results.closed_forms import alciatore_a31, pivot_length
from cuefem.results.quantities import REGIMES, RESULTS, format_value
from cuefem.results.records import Record, Table
from cuefem.results.solved_design import Solvable, SolvedDesign
from cuefem.results.verdict import MISCUE_DEFINITION
from cuefem.scene import Outcome, Scene
from cuefem.show.analysis import Analysis, Rows
from cuefem.show.scene_summary import stroke_line, tip_effect_notes

# Rows of the table: quantity, component of a vector (0 tangential, 1 normal), and the end of the label.
ROWS: tuple[tuple[str, int | None, str], ...] = (
    *((name, None, "") for name in ("squirt", "pivot_length", "ball_speed")),
    *(("ball_velocity", 1, ", normal"), ("ball_velocity", 0, ", tangential")),
    *((name, None, "") for name in ("spin", "cue_speed", "duration", "regime", "error")),
)
SPEED_NOTE_THRESHOLD = 0.02  # relative deficit of the two-part cue's ball speed from which a note explains it
TWO_PART_SPEED_NOTE = (
    "ball speed: use the coupled value; the two-part cue omits axial waves, which raise the restitution of the whole "
    "cue above that of its tip"
)
PIVOT_NOTE = (
    "natural pivot length: distance from the end of the tip to the point about which pivoting the cue cancels squirt "
    "(back-hand English)"
)
NO_END_MASS = "left out, because no end mass that is found has the squirt of a tip that sticks at this offset"
UNCERTAINTY_NOTE = "run `cuefem report FILE` for the uncertainty of squirt"
MISCUE_NOTE = f"miscue: {MISCUE_DEFINITION}. Do not use squirt and natural pivot length; use a smaller offset"


def _components(value: Any) -> dict[str, Any]:
    """A value, or each component of a vector or a dict, by what follows its name."""
    if isinstance(value, Mapping):
        return {f"_{key.replace(' ', '_')}": number for key, number in value.items()}
    return (
        {f"_{axis}": number for axis, number in zip("tn", value, strict=True)}
        if isinstance(value, tuple | list) or np.ndim(value)
        else {"": value}
    )


def regime_warning(regime: str) -> str:
    """The warning for a miscue, or for slip that increases squirt; "" for other contact states."""
    return MISCUE_NOTE if regime == "miscue" else REGIMES[regime] if regime in ("partial slip", "gross slip") else ""


@dataclass(frozen=True)
class StrikeModels(Rows, Analysis):
    """One stroke by each model.

    Parameters
    ----------
    scene : Scene
        The analysed stroke.
    end_mass : float or None
        End mass of the two-part cue, kg: "offset" of `cuefem.end_masses`; None if no end mass has the squirt.
    a31_end_mass : float or None
        End mass of A.31, kg: that at this offset without effects at the tip, as in published values.
    models : dict of str to dict
        Squirt (rad), natural pivot length (m), speeds (m/s), spin (rad/s) and other values by the model's name.
        "coupled": integrated in time. "two-part": the impulse solver for axial mass and end mass, as in
        `cuefem.reduction`. "A.31": Alciatore's formula, squirt and pivot length only.
    missing : str
        Why the two-part cue has no end mass; "" if it has one.
    """

    end_mass: float | None
    a31_end_mass: float | None
    models: dict[str, Record]
    missing: str = ""

    def frame_rows(self) -> list[Record]:
        """A row for each model; of vectors a column for each component."""
        return [
            {"model": name}
            | {f"{key}{part}": number for key, each in model.items() for part, number in _components(each).items()}
            for name, model in self.models.items()
        ]

    def tables(self) -> list[Table | str]:
        """A table with a column for each model."""
        return [self.table()]

    def table(self) -> Table:
        """A column for each model, a row for each quantity that any model has."""
        coupled, offset = self.models["coupled"], self.scene.stroke.offset
        rows = []
        for name, part, component in ROWS:
            values = [model.get(name) for model in self.models.values()]
            if any(value is not None for value in values):
                parts = (value if value is None or part is None else value[part] for value in values)
                rows.append((RESULTS[name].label + component, *(format_value(name, value) for value in parts)))
        miscue = [MISCUE_NOTE] if coupled["regime"] == "miscue" else []
        notes = (
            *miscue,
            stroke_line(self.scene),
            *self._model_notes(),
            *([PIVOT_NOTE] if any(row[0] == RESULTS["pivot_length"].label for row in rows) else []),
            *([] if miscue else [f"contact: {REGIMES[coupled['regime']]}"]),
            *self._speed_notes(),
            UNCERTAINTY_NOTE,
        )
        return Table(f"Stroke at offset b/R {offset:.4g}, by model", ("", *self.models), tuple(rows), notes)

    def _model_notes(self) -> list[str]:
        """Which model to use, and the definitions of the models, for a vibrating or a lumped cue."""
        use = "use the coupled column; the others are simpler published models, for comparison"
        if self.scene.lumped is not None:
            models = "coupled: contact integrated in time; two-part and A.31: two masses, with the cue's end mass"
            tip = tip_effect_notes(self.scene, "only coupled includes the effects at the tip")
            return [use, models, *tip]
        is_default = self.models["coupled"]["error"] is None
        accuracy = ", numerical error of squirt at most 0.1 % for 95 % of default strikes" if is_default else ""
        beam = f"coupled: vibrating shaft in time{accuracy}"
        where = f"stick at b/R {self.scene.stroke.offset:.4g}"
        if self.end_mass is None and self.a31_end_mass is None:
            return [use, beam, f"two-part and A.31: left out; {self.missing}"]
        two_part = f"two-part: {_mass_text(self.end_mass, where, beside='one axial mass and ')}"
        if self.end_mass == self.a31_end_mass:
            return [use, beam, f"{two_part}; A.31: the same end mass"]
        bare = f"{where} without effects at the tip, as published ones"
        return [use, beam, two_part, f"A.31: {_mass_text(self.a31_end_mass, bare)}"]

    def _speed_notes(self) -> list[str]:
        """A note on the lower ball speed of the two-part cue, which omits the axial waves of the coupled strike."""
        if not any(type(effect).__name__ == "AxialWaves" for effect in self.scene.effects):
            return []
        coupled, *others = (model["ball_speed"] for model in self.models.values() if "ball_speed" in model)
        return [TWO_PART_SPEED_NOTE] if any(other < (1 - SPEED_NOTE_THRESHOLD) * coupled for other in others) else []


def strike_models(scene: Solvable, rtol: float | None = None) -> StrikeModels:
    """One stroke by the coupled strike, by the two-part cue and by Alciatore's formula.

    Parameters
    ----------
    scene : Scene
        A stroke.
    rtol : float, optional
        Relative numerical error target of the coupled strike; by default that of a default strike.

    Returns
    -------
    StrikeModels

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> cue = cf.Cue((cf.Segment(0.7, 0.012, 0.021, wood),), body_mass=0.43)
    >>> scene = cf.Scene(cue, tip=cf.Tip(contact_time=1e-3), stroke=cf.Stroke(offset=0.3))
    >>> list(cf.strike_models(scene).models)
    ['coupled', 'two-part', 'A.31']
    """
    design = SolvedDesign.of(scene, rtol)
    scene = design.scene
    models = {"coupled": outcome_record(design.strike(), scene)}
    cue, missing = two_part_cue(design)
    if cue is not None:
        models["two-part"] = outcome_record(lumped_strike(scene, cue), scene)
    (a31_cue,) = a31_cues(design, [scene.stroke.offset])
    if a31_cue is not None:
        squirt = a31_squirt(scene, a31_cue)
        models["A.31"] = {"squirt": squirt, "pivot_length": pivot_length(scene, squirt)}
    end_mass, a31_end_mass = (None if each is None else each.end_mass for each in (cue, a31_cue))
    return StrikeModels(scene, end_mass, a31_end_mass, models, missing)


def _mass_text(end_mass: float | None, where: str, beside: str = "") -> str:
    return NO_END_MASS if end_mass is None else f"{beside}an end mass of {with_unit(end_mass, END_MASS)}, {where}"


def two_part_cue(design: SolvedDesign) -> tuple[LumpedCue | None, str]:
    """The two-part cue of a scene, of its axial mass and its end mass at the stroke's offset; a lumped cue itself.

    None if no end mass with the squirt is found; then with the reason.
    """
    scene = design.scene
    if scene.lumped is not None:
        return scene.lumped, ""
    try:
        return LumpedCue(scene.axial_mass, design.end_mass("offset", None)), ""
    except (ValueError, RuntimeError) as error:
        return None, str(error)


def a31_cues(design: SolvedDesign, offsets: Sequence[float]) -> list[LumpedCue | None]:
    """The cues of Alciatore's formula at each offset; None where no end mass has the squirt.

    Their end mass is that of sticking contact at the offset without effects at the tip, as in published
    values. A scene's own lumped cue has its own end mass.
    """
    scene = design.scene
    if scene.lumped is not None:
        return [replace(scene.lumped, coupling=0.0)] * len(offsets)
    masses = stick_at_offsets(design.solved.step_tip, scene.without_tip_effects, offsets)
    return [None if math.isnan(mass) else LumpedCue(scene.axial_mass, mass) for mass in masses]


def lumped_strike(scene: Scene, cue: LumpedCue) -> Outcome:
    """The outcome of the scene's stroke with a lumped cue and without effects, by the impulse solver."""
    return impulse(replace(scene, cue=cue, effects=()))


def a31_squirt(scene: Scene, cue: LumpedCue) -> Any:
    """Squirt, rad, by Alciatore's formula [A.31] with the end mass of a lumped cue."""
    return alciatore_a31(scene.stroke.offset, mass_ratio=scene.ball.mass / cue.end_mass, inertia=scene.ball.inertia)


def outcome_record(outcome: Outcome, scene: Scene) -> Record:
    """The outcome of a strike with its natural pivot length, m (None at offset 0)."""
    names = ("squirt", "ball_speed", "ball_velocity", "spin", "cue_speed", "impulse", "duration", "regime")
    record = {name: getattr(outcome, name) for name in (*names, "energy", "unknowns", "error")}
    return record | {"pivot_length": pivot_length(scene, outcome.squirt)}
