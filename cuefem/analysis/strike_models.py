"""One stroke by the coupled strike and by lumped models."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from cuefem.beam.tip_modes import TipModes
from cuefem.cue import LumpedCue
from cuefem.endmass.definitions import stick_at_offsets
from cuefem.endmass.lumped import impulse, lump_modes
from cuefem.quantity.display_units import END_MASS, with_unit
from cuefem.results.closed_forms import alciatore_a31, pivot_length
from cuefem.results.quantities import REGIMES, RESULTS, format_value
from cuefem.results.records import Record, Table
from cuefem.results.solved_design import Solvable, SolvedDesign, at_offset
from cuefem.results.verdict import MISCUE_DEFINITION
from cuefem.scene import Outcome, Scene
from cuefem.show.analysis import Analysis
from cuefem.show.scene_summary import assumptions, scene_record, tip_effect_notes

# Rows of the table: quantity, component of a vector (0 tangential, 1 normal), and the end of the label.
ROWS: tuple[tuple[str, int | None, str], ...] = (
    *((name, None, "") for name in ("squirt", "pivot_length", "ball_speed")),
    *(("ball_velocity", 1, ", normal"), ("ball_velocity", 0, ", tangential")),
    *((name, None, "") for name in ("spin", "cue_speed", "duration", "regime", "error")),
)
SPEED_NOTE_THRESHOLD = 0.02  # relative deficit of a lumped model's ball speed from which a note explains it
LUMPED_SPEED_NOTE = (
    "ball speed: use the coupled value; the lumped models omit axial waves, which raise the restitution of the whole "
    "cue above that of its tip"
)
PIVOT_NOTE = (
    "natural pivot length: distance from the end of the tip to the point about which pivoting the cue cancels squirt "
    "(back-hand English)"
)
UNCERTAINTY_NOTE = "run `cuefem report FILE` for the uncertainty of squirt"
MISCUE_NOTE = f"miscue: {MISCUE_DEFINITION}. Do not use squirt and natural pivot length; use a smaller offset"


def regime_warning(regime: str) -> str:
    """The warning for a miscue, or for slip that increases squirt; "" for other contact states."""
    return MISCUE_NOTE if regime == "miscue" else REGIMES[regime] if regime in ("partial slip", "gross slip") else ""


@dataclass(frozen=True)
class StrikeModels(Analysis):
    """One stroke by each model.

    Parameters
    ----------
    scene : Scene
        The analysed stroke.
    end_mass : float or None
        End mass of the lumped models, kg; None if no lumped cue has the squirt.
    coupling : float
        Coupling of the model "lumped": transverse velocity of the tip per unit axial impulse, 1/kg.
    models : dict of str to dict
        Squirt (rad), natural pivot length (m), speeds (m/s), spin (rad/s) and other values by the model's name.
        "coupled": integrated in time. "lumped" and "two-part": the impulse solver for the cues of `lumped_cues`.
        "A.31": Alciatore's formula with the end mass of "two-part", squirt and pivot length only.
    """

    end_mass: float | None
    coupling: float
    models: dict[str, Record]

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
            assumptions(scene_record(self.scene)),
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
        coupling = f"coupling of {self.coupling:.4g} /kg (transverse tip velocity per unit axial impulse)"
        if self.scene.lumped is not None:
            own = [f"two-part and A.31 exclude the cue's {coupling}"] if self.coupling else []
            models = "coupled: contact integrated in time; two-part and A.31: two masses, with the cue's end mass"
            tip = tip_effect_notes(scene_record(self.scene), "only coupled includes the effects at the tip")
            return [use, models, *own, *tip]
        is_default = self.models["coupled"]["error"] is None
        accuracy = ", numerical error of squirt at most 0.1 % for 95 % of default strikes" if is_default else ""
        beam = f"coupled: vibrating shaft in time{accuracy}"
        end_mass = f"an end mass of {with_unit(self.end_mass, END_MASS)}, " if self.end_mass else "an end mass, "
        where = f"stick at b/R {self.scene.stroke.offset:.4g} without tip effects"
        masses = f"one axial mass and {end_mass}{where}"
        if not self.coupling:
            return [use, beam, f"two-part and A.31: {masses}"]
        return [use, beam, f"two-part and A.31: {masses}; lumped: the same, with the tip effects as a {coupling}"]

    def _speed_notes(self) -> list[str]:
        """A note on the lower ball speed of lumped models, which omit the axial waves of the coupled strike."""
        if not any(type(effect).__name__ == "AxialWaves" for effect in self.scene.effects):
            return []
        coupled, *others = (model["ball_speed"] for model in self.models.values() if "ball_speed" in model)
        return [LUMPED_SPEED_NOTE] if any(other < (1 - SPEED_NOTE_THRESHOLD) * coupled for other in others) else []


def strike_models(scene: Solvable, rtol: float | None = None) -> StrikeModels:
    """One stroke by the coupled strike and by lumped models.

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
    scene, solved = design.scene, design.solved
    cues = lumped_cues(scene, [scene.stroke.offset], solved.step_tip)
    models = {"coupled": outcome_record(design.strike(), scene)}
    models |= {name: outcome_record(lumped_strike(scene, cue), scene) for name, (cue,) in cues.items() if cue}
    (cue,), (lumped,) = cues["two-part"], cues.get("lumped", [None])
    if cue:
        squirt = a31_squirt(scene, cue)
        models["A.31"] = {"squirt": squirt, "pivot_length": pivot_length(scene, squirt)}
    return StrikeModels(scene, cue.end_mass if cue else None, lumped.coupling if lumped else 0.0, models)


def lumped_cues(scene: Scene, offsets: Sequence[float], tip: TipModes) -> dict[str, list[LumpedCue | None]]:
    """The lumped cues of "lumped" and "two-part" at each offset; None where no lumped cue has the squirt.

    "two-part" has the end mass for sticking contact at that offset, without effects at the tip and without coupling.
    "lumped" adds the coupling by effects at the tip, proportional to |b/R|; it is absent if they add none, or if no
    lumped cue has the squirt with them. A scene's own lumped cue has its own end mass and, as "lumped", its own
    coupling, both at all offsets. tip: the cue's tip modes with sticking contact.
    """
    if (own := scene.lumped) is not None:
        coupled: list[LumpedCue | None] = [own] * len(offsets)
        return ({"lumped": coupled} if own.coupling else {}) | {"two-part": [replace(own, coupling=0.0)] * len(offsets)}
    masses = stick_at_offsets(tip, scene.without_tip_effects, offsets)
    cues = [None if math.isnan(mass) else LumpedCue(scene.axial_mass, mass) for mass in masses]
    slope = _coupling_slope(scene, tip)
    coupled = [_with_coupling(cue, slope * abs(b)) for cue, b in zip(cues, offsets, strict=True)]
    return ({"lumped": coupled} if slope else {}) | {"two-part": cues}


def _coupling_slope(scene: Scene, tip: TipModes) -> float:
    """The coupling by effects at the tip per b/R, 1/kg, at the offset of the stroke, or at 0.1 of a central impact.

    Zero without such effects, or if no lumped cue with the squirt is found.
    """
    offset = scene.stroke.offset or 0.1
    try:
        cue = lump_modes(at_offset(scene, offset), tip)
    except (ValueError, RuntimeError):
        return 0.0
    return cue.coupling / abs(offset)


def _with_coupling(cue: LumpedCue | None, coupling: float) -> LumpedCue | None:
    """The cue with a coupling; None without a cue, or if the coupling is out of its bounds."""
    try:
        return cue and replace(cue, coupling=coupling)
    except ValueError:
        return None


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
