"""Design changes of a cue, and the effect of each on its own by the coupled strike."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from cuefem.analysis.strike_models import regime_warning
from cuefem.cue import Cue
from cuefem.cue.materials import MATERIALS, table_name
from cuefem.designs.evaluation import Response
from cuefem.effects.leather_tip import DOMES
from cuefem.measurements.calibration import CalibratedSquirt, Calibration
from cuefem.parameters.parts import TUBE_FRONT, Layout, is_tube, is_wooden, shaft_word, taper_position
from cuefem.parameters.scene_changes import with_parameters
from cuefem.parameters.table import PARAMETERS
from cuefem.quantity.display_units import change_with_unit, format_change, short_number, with_unit
from cuefem.results.progress import Progress
from cuefem.results.records import Record, Table, tabulate
from cuefem.results.solved_design import Solvable, SolvedDesign, off_centre
from cuefem.results.uncertainty import miscue_note, model_share, ratio_error, squirt_changes
from cuefem.results.verdict import reject_no_verdict
from cuefem.scene import Scene
from cuefem.scene.solved_scene import SolvedScene
from cuefem.show.analysis import Analysis

MM = 1e-3
WIDER, DEEPER, SHORTER, LOWER, THINNER = 1 * MM, 25 * MM, 5 * MM, 1 * MM, 0.5 * MM
NEW_BORE, NEW_DEPTH = 6 * MM, 127 * MM  # of meshes/pool_hollow.toml, 5 in deep
MIN_WALL = 0.8 * MM  # the thinnest of carbon tubes (meshes/README.md); a thinner wall splits
MIN_FERRULE = 5 * MM  # length after the change
MIN_TIP = 2 * MM  # height after the change
WALL_STEP = 0.2 * MM  # two plies of prepreg, 0.1 mm each
EMPTY_FRONT, NEW_INSERT = 150 * MM, 25 * MM
CARBON_WALL = 1.5 * MM  # the middle of meshes/carbon.toml
PRO_GAIN = 0.5 * MM  # from the tip to the taper's position, as in meshes/pool_maple.toml
FERRULES = ("abs", "melamine", "phenolic")  # sold for cues; brass and steel are not suggested
SHAFT_WOODS = ("hard maple", "ash", "yellow birch", "purpleheart", "rosewood")
MIN_STIFFNESS_LOSS = 0.05  # perceptible relative loss of stiffness
MIN_CONTRIBUTION = 0.002  # of squirt: smaller contributions to its uncertainty are neglected in a change
NUMBERS = tuple(map(Response.of, ("squirt", "tip_stiffness", "shaft_mass", "frequency(1)")))
WOOD = ("E", "G", "rho")
STYLES = {"worthwhile": "bold", "more squirt": "dim", "within uncertainty": "dim"}


class DesignChange(NamedTuple):
    """A change: its label, and the values that it sets, SI or names of materials, by parameter.

    resets: uncertain parameters whose value it replaces, so that the error of the new one is independent.
    """

    label: str
    values: dict[str, Any]
    resets: tuple[str, ...] = ()


def changes_of(scene: Scene) -> list[DesignChange]:
    """Candidate changes of this cue; `design_changes` drops those that its geometry does not allow."""
    values = {key: parameter.value(scene) for key, parameter in PARAMETERS.items()}
    if is_tube(scene.shaft):
        return [*_walls(values), *_fillings(values), *_ferrules(values), *_tips(values)]
    changes = [*_bores(scene.shaft, values), *_ferrules(values), *_tips(values)]
    if is_wooden(scene.shaft):
        changes += [*_tapers(scene.shaft, values), *_woods(scene.shaft)]
    return changes


def _walls(values: Record) -> Iterator[DesignChange]:
    """Another wall in front: a tube is made on a mandrel, and is neither turned nor replaced by solid wood."""
    wall = values["front_wall"]
    if wall is None:
        return
    where = f"over the first {with_unit(TUBE_FRONT, 'm')}"
    for name, new in (("thinner", wall - WALL_STEP), ("thicker", wall + WALL_STEP)):
        yield DesignChange(f"wall {name}, {_from_to(wall, new)} {where}", {"front wall": new})


def _fillings(values: Record) -> Iterator[DesignChange]:
    """Nothing inside the front of the tube, or a maple insert."""
    empty, insert = values["empty_depth"], values["insert_depth"]
    if empty == insert == 0:
        label = f"no filling in the first {with_unit(EMPTY_FRONT, 'm')} of the tube"
        yield DesignChange(label, {"empty depth": EMPTY_FRONT})
    if insert == 0:
        yield DesignChange(f"maple insert, {with_unit(NEW_INSERT, 'm')} long, in front", {"insert depth": NEW_INSERT})
    elif insert is not None:
        yield DesignChange("no insert in front", {"insert depth": 0.0})


def _bores(cue: Cue, values: Record) -> Iterator[DesignChange]:
    depth, width = values["bore_depth"], values["bore_width"]
    if depth is None:
        return
    if depth <= 0:
        new = {"bore depth": NEW_DEPTH, "bore width": NEW_BORE}
        yield DesignChange(f"bore, {with_unit(NEW_BORE, 'm')} wide and {with_unit(NEW_DEPTH, 'm')} deep", new)
        return
    bored = [cue.segments[i] for i in Layout.of(cue).bore or ()]
    is_cylinder = all(s.tip_bore == s.butt_bore == width for s in bored)
    at_mouth = "" if is_cylinder else " at its mouth"
    yield DesignChange(f"bore wider, {_from_to(width, width + WIDER)}{at_mouth}", {"bore width": width + WIDER})
    yield DesignChange(f"bore deeper, {_from_to(depth, depth + DEEPER)}", {"bore depth": depth + DEEPER})


def _ferrules(values: Record) -> Iterator[DesignChange]:
    length, material = values["ferrule_length"], values["ferrule_material"]
    if length is None:
        return
    if length - SHORTER >= MIN_FERRULE:
        yield DesignChange(
            f"ferrule shorter, {_from_to(length, length - SHORTER)}", {"ferrule length": length - SHORTER}
        )
    for name in FERRULES:
        if MATERIALS[name].material != material:
            yield DesignChange(f"{'ABS' if name == 'abs' else name} ferrule", {"ferrule material": name})


def _tips(values: Record) -> Iterator[DesignChange]:
    height, dome = values["tip_height"], values["dome"]
    if height is not None and height - LOWER >= MIN_TIP:
        yield DesignChange(f"tip height {_from_to(height, height - LOWER)}", {"tip height": height - LOWER})
    for name in ("dime", "nickel"):
        if dome is not None and abs(DOMES[name] - dome) > 0.1 * MM:
            yield DesignChange(f"tip radius of a {name}", {"dome": DOMES[name]}, ("dome",))


def _tapers(cue: Cue, values: Record) -> Iterator[DesignChange]:
    tip, taper, end = (values[f"{name}_diameter"] for name in ("tip", "taper", "butt"))
    x = taper_position(cue)
    at = with_unit(x, "m", decimals=0)
    thinner = {"tip diameter": tip - THINNER, "taper diameter": taper - THINNER}
    yield DesignChange(f"{with_unit(THINNER, 'm')} thinner from the front to {at}", thinner)
    cone, pro = tip + (end - tip) * x / cue.length, tip + PRO_GAIN
    for name, diameter in (("straight taper, a cone", cone), ("pro taper", pro)):
        if abs(diameter - taper) > 0.2 * MM:
            yield DesignChange(f"{name}, {with_unit(diameter, 'm')} at {at}", {"taper diameter": diameter})


def _woods(cue: Cue) -> Iterator[DesignChange]:
    shaft = Layout.of(cue).shaft
    current = table_name(cue.segments[shaft.start].material)
    for name in SHAFT_WOODS:
        if name != current:
            yield DesignChange(f"{name} shaft", {"shaft material": name}, WOOD)
    tube: dict[str, Any] = {}
    for i in shaft:
        segment = cue.segments[i]
        tube |= {
            f"cue.segments[{i}].material": "carbon fibre",
            f"cue.segments[{i}].core": "foam",
            f"cue.segments[{i}].tip_bore": segment.tip_diameter - 2 * CARBON_WALL,
            f"cue.segments[{i}].butt_bore": segment.butt_diameter - 2 * CARBON_WALL,
        }
    yield DesignChange(f"carbon tube, wall {with_unit(CARBON_WALL, 'm')}, foam inside", tube, WOOD)


def _from_to(old: float, new: float) -> str:
    return f"{short_number(old, 'm')} → {with_unit(new, 'm')}"


@dataclass(frozen=True)
class ChangedDesign:
    """A cue with one change.

    Parameters
    ----------
    change : str
        The change in words.
    values : dict of str to object
        The parameters that it sets, as `cuefem.with_parameters` takes them.
    squirt, tip_stiffness, shaft_mass, frequency : float
        Squirt (rad), static stiffness of the tip (N/m), mass of the drawn part (kg) and first natural frequency (Hz).
    squirt_change, tip_stiffness_change : float
        Relative changes.
    shaft_mass_change, frequency_change : float
        Absolute changes, kg and Hz.
    squirt_change_error : float
        Uncertainty of squirt_change, 1 sigma.
    verdict : str
        The recommendation: "within uncertainty" if the change of squirt is smaller than its error.
    """

    change: str
    values: dict[str, Any]
    squirt: float
    tip_stiffness: float
    shaft_mass: float
    frequency: float
    squirt_change: float
    tip_stiffness_change: float
    shaft_mass_change: float
    frequency_change: float
    squirt_change_error: float
    verdict: str


@dataclass(frozen=True)
class DesignChanges(Analysis):
    """Changes that a maker can make to a cue, each on its own.

    Parameters
    ----------
    scene : Scene
        The analysed scene.
    offset : float
        Offset b/R of the strikes: a head-on stroke is computed at the game's default offset.
    regime : str
        State of the contact, as `Outcome.regime`.
    unmodified : dict of str to float
        Squirt (rad), tip stiffness (N/m), shaft mass (kg) and first natural frequency (Hz) of the cue itself.
    changes : list of ChangedDesign
        The changes, lowest squirt first.
    miscues : tuple of str
        Inputs that make the stroke of the cue itself a miscue one standard deviation up or down: their part of the
        uncertainties is that of the other side.
    calibrated : CalibratedSquirt or None
        The calibration by which every squirt is given: all changes carry the factor of the cue itself.
    """

    offset: float
    regime: str
    unmodified: dict[str, float]
    changes: list[ChangedDesign]
    miscues: tuple[str, ...] = ()
    calibrated: CalibratedSquirt | None = None

    def tables(self) -> list[Table | str]:
        """A table with a row for each change, after the calibration of the cue itself."""
        return [*self._calibration_lines(), self.table()]

    def _calibration_lines(self) -> list[str]:
        """The calibrated squirt of the cue itself, and warnings; empty without a calibration."""
        own = self.calibrated
        if own is None:
            return []
        squirt = with_unit(abs(own.squirt), "rad", error=own.squirt_error)
        return [f"squirt {squirt} (1σ), {own.origin()}", own.basis(), *own.warning_lines(), ""]

    def table(self) -> Table:
        """A row for each change, the lowest squirt first."""
        table = tabulate(
            "Design changes",
            {
                "change": "{change}",
                "squirt change": lambda row: format_change(
                    100 * row["squirt_change"], 1, f"± {100 * row['squirt_change_error']:.1f} %"
                ),
                "stiffness change": lambda row: _percent(row["tip_stiffness_change"]),
                "mass change": lambda row: change_with_unit(row["shaft_mass_change"], "kg", 1),
                "natural frequency change": lambda row: format_change(row["frequency_change"], 1, "Hz"),
                "recommendation": "{verdict}",
            },
            map(vars, self.changes),
            *self._notes(),
            texts=(0, 5),
        )
        styles = {i: STYLES[row.verdict] for i, row in enumerate(self.changes) if row.verdict in STYLES}
        return replace(table, styles=styles, more=(2, 3, 4))

    def _notes(self) -> list[str]:
        """Definitions of the table's columns."""
        warning = regime_warning(self.regime)
        own = with_unit(self.unmodified["squirt"], "rad", decimals=2)
        return [
            *([warning] if warning else []),
            f"Each change on its own, by the coupled strike at b/R {self.offset:.4g}; this cue: {own}. "
            f"±: uncertainty of the change (1σ): model, unmeasured {shaft_word(self.scene)} and tip, and 1 %. "
            "Worthwhile: squirt falls by more than its uncertainty; within uncertainty: the change is smaller than its "
            "uncertainty.",
            *([note] if (note := miscue_note(self.miscues)) else []),
            "Stiffness: static, at the tip, joint end clamped. Costs stiffness: by 5 % or more. Natural frequency: of "
            "the first mode.",
        ]


def design_changes(
    scene: Solvable, *, calibration: Calibration | None = None, progress: Progress = list
) -> DesignChanges:
    """Changes that a maker can make to a cue, and the effect of each on its own.

    Parameters
    ----------
    scene : Scene
        A stroke with a cue of segments, such as that of `usual_scene`. A head-on stroke is computed at the game's
        default offset.
    calibration : Calibration, optional
        Squirt that was measured on another shaft with the same tip: every squirt is calibrated. A change alters squirt
        by the same share.
    progress : callable
        Wraps the list of changes, to show progress.

    Returns
    -------
    DesignChanges

    Raises
    ------
    ValueError
        If the cue is lumped, or the stroke a miscue.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> scene = cf.usual_scene(cf.Cue((cf.Segment(0.7, 0.01275, 0.021, wood),), body_mass=0.43))
    >>> changes = cf.design_changes(scene).changes
    >>> changes[0].squirt_change < changes[-1].squirt_change
    True
    """
    design = SolvedDesign.of(scene)
    struck = off_centre(design.scene)
    if struck is not design.scene:
        design = SolvedDesign.of(struck)
    outcome = design.strike()
    reject_no_verdict(struck, outcome)
    calibrated = calibration.squirt(struck) if calibration else None
    factor = calibrated.factor if calibrated else 1.0
    base = _numbers(design.solved)
    changes = squirt_changes(design.solved, base["squirt"])
    before = {key: x for key, x in changes.of("squirt").items() if abs(x) > MIN_CONTRIBUTION}
    rows = []
    for change in progress(changes_of(struck)):
        try:
            variant = with_parameters(struck, change.values)
            if _wall(variant) < (1 - 1e-9) * min(MIN_WALL, _wall(struck)):
                continue
            new = SolvedScene(variant)
            numbers = _numbers(new)
            after = squirt_changes(new, numbers["squirt"], before).of("squirt")
            residual = (_residual(before.get(key, 0.0), after.get(key, 0.0), key in change.resets) for key in before)
            error = ratio_error(numbers["squirt"] / base["squirt"], model_share(struck, variant), *residual)
            rows.append(_changed_design(change, base, numbers, error))
        except (ValueError, RuntimeError):
            continue
    rows = [replace(row, squirt=factor * row.squirt) for row in rows]
    rows.sort(key=lambda row: row.squirt_change)
    base["squirt"] *= factor
    return DesignChanges(
        design.scene, float(struck.stroke.offset), outcome.regime, base, rows, changes.miscues, calibrated
    )


def _numbers(solved: SolvedScene) -> Record:
    design = SolvedDesign(solved)
    return {response.kind: response.value(design) for response in NUMBERS}


def _wall(scene: Scene) -> float:
    """The thinnest wall of an empty bore or of a tube, m; where solid, the radius; infinite if all bores are filled."""
    tube = is_tube(scene.shaft)
    empty = [s for s in scene.shaft.segments if tube or s.core is None]
    return min((min(s.tip_diameter - s.tip_bore, s.butt_diameter - s.butt_bore) / 2 for s in empty), default=np.inf)


def _residual(before: float, after: float, independent: bool) -> float:
    """Uncertainty of an uncertain parameter in ln(after/before); independent: the change replaces its value.

    A parameter of the changed cue alone, such as the width of a drilled bore, is known.
    """
    return math.hypot(before, after) if independent else after - before


def _changed_design(change: DesignChange, base: Record, numbers: Record, error: float) -> ChangedDesign:
    squirt = numbers["squirt"] / base["squirt"] - 1
    stiffness = numbers["tip_stiffness"] / base["tip_stiffness"] - 1
    return ChangedDesign(
        change.label,
        change.values,
        **numbers,
        squirt_change=squirt,
        tip_stiffness_change=stiffness,
        shaft_mass_change=numbers["shaft_mass"] - base["shaft_mass"],
        frequency_change=numbers["frequency"] - base["frequency"],
        squirt_change_error=error,
        verdict=_verdict(squirt, stiffness, error),
    )


def _verdict(squirt: float, stiffness: float, error: float) -> str:
    if abs(squirt) <= error:
        return "within uncertainty"
    if squirt > 0:
        return "more squirt"
    return "worthwhile, costs stiffness" if stiffness < -MIN_STIFFNESS_LOSS else "worthwhile"


def _percent(share: float) -> str:
    return format_change(100 * share, 1 if abs(share) < 0.095 else 0, "%")
