"""Design changes of a cue, and the effect of each on its own by the coupled strike."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from cuefem.cue import Cue
from cuefem.cue.materials import MATERIALS, WOODS, table_name
from cuefem.design.evaluation import Response
from cuefem.effects.leather_tip import DOMES
from cuefem.parameters.parameter import PARAMETERS, with_parameters
from cuefem.parameters.parts import Layout, taper_position
from cuefem.results.quantities import to_display, with_unit
from cuefem.results.records import Record
from cuefem.results.solved_design import SolvedDesign, off_centre
from cuefem.results.uncertainty import model_share, ratio_error, squirt_changes
from cuefem.results.verdict import reject_no_verdict
from cuefem.scene import Scene
from cuefem.scene.solved_scene import SolvedScene

MM = 1e-3
WIDER, DEEPER, SHORTER, LOWER, THINNER = 1 * MM, 25 * MM, 5 * MM, 1 * MM, 0.5 * MM
NEW_BORE, NEW_DEPTH = 6 * MM, 127 * MM  # of meshes/pool_hollow.toml, 5 in deep
MIN_WALL = 0.8 * MM  # the thinnest of carbon tubes (meshes/README.md); a thinner wall splits
MIN_FERRULE = 5 * MM  # length after the change
MIN_TIP = 2 * MM  # height after the change
CARBON_WALL = 1.5 * MM  # the middle of meshes/carbon.toml
PRO_GAIN = 0.5 * MM  # from the tip to the taper's position, as in meshes/pool_maple.toml
FERRULES = ("abs", "melamine", "phenolic")  # sold for cues; brass and steel are not suggested
MIN_STIFFNESS_LOSS = 0.05  # perceptible relative loss of stiffness
MIN_CONTRIBUTION = 0.002  # of squirt: smaller contributions to its uncertainty are neglected in a change
NUMBERS = tuple(map(Response.of, ("squirt", "tip_stiffness", "shaft_mass", "frequency(1)")))
WOOD = ("E", "G", "rho")
Progress = Callable[[Sequence[Any]], Iterable[Any]]


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
    return [
        *_bores(scene.shaft, values),
        *_ferrules(values),
        *_tips(values),
        *_woods_and_tapers(scene.shaft, values),
    ]


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


def _woods_and_tapers(cue: Cue, values: Record) -> Iterator[DesignChange]:
    """Changes of a wooden shaft; a tube is made on a mandrel, and is neither turned nor replaced by solid wood."""
    if table_name(values["shaft_material"]) != "carbon fibre":
        yield from _tapers(cue, values)
        yield from _woods(cue)


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
    for name in WOODS:
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
    return f"{to_display(old, 'm'):.4g} → {with_unit(new, 'm')}"


def design_changes(scene: Scene, *, solved: SolvedScene | None = None, progress: Progress = list) -> Record:
    """The design changes of a cue, and the effect of each on its own.

    Parameters
    ----------
    scene : Scene
        A stroke with a cue of segments, such as that of `usual_scene`. A centre-ball stroke is computed at the game's
        default offset.
    solved, progress : optional
        The solved scene, if it is known; and a function of the list of changes that shows progress.

    Returns
    -------
    dict
        "offset", b/R; "regime", the contact's (`Outcome.regime`); "unmodified", the cue's squirt (rad), tip
        stiffness (N/m), shaft mass (kg) and first natural frequency (Hz); "changes", a list of dicts sorted by squirt,
        lowest first: "change", the label, "values", the argument of `cuefem.parameters.parameter.with_parameters`, the
        four numbers, relative changes of squirt (with "squirt_change_error", 1 sigma) and stiffness, absolute ones of
        mass and frequency, and a "verdict": a change of squirt smaller than its error is "within uncertainty".

    Raises
    ------
    ValueError
        If the cue is lumped, or the stroke a miscue.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> scene = cf.usual_scene(cf.Cue((cf.Segment(0.7, 0.01275, 0.021, wood),), body_mass=0.43))
    >>> rows = cf.design_changes(scene)["changes"]
    >>> rows[0]["squirt_change"] < rows[-1]["squirt_change"]
    True
    """
    struck = off_centre(scene)
    solved = SolvedScene(struck) if solved is None or struck is not scene else solved
    outcome = SolvedDesign(solved).strike()
    reject_no_verdict(struck, outcome)
    base = _numbers(solved)
    before = {key: x for key, x in squirt_changes(solved, base["squirt"]).items() if abs(x) > MIN_CONTRIBUTION}
    rows = []
    for change in progress(changes_of(struck)):
        try:
            variant = with_parameters(struck, change.values)
            if _wall(variant) < min(MIN_WALL, _wall(struck)):
                continue
            new = SolvedScene(variant)
            numbers = _numbers(new)
            after = squirt_changes(new, numbers["squirt"], before)
            residual = (_residual(before.get(key, 0.0), after.get(key, 0.0), key in change.resets) for key in before)
            error = ratio_error(numbers["squirt"] / base["squirt"], model_share(struck, variant), *residual)
            rows.append(_row(change, base, numbers, error))
        except (ValueError, RuntimeError):
            continue
    rows.sort(key=lambda row: row["squirt_change"])
    return {"offset": float(struck.stroke.offset), "regime": outcome.regime, "unmodified": base, "changes": rows}


def _numbers(solved: SolvedScene) -> Record:
    design = SolvedDesign(solved)
    return {response.kind: response.value(design) for response in NUMBERS}


def _wall(scene: Scene) -> float:
    """The thinnest wall of an empty bore, m; inf without one."""
    empty = [s for s in scene.shaft.segments if s.core is None and max(s.tip_bore, s.butt_bore) > 0]
    return min((min(s.tip_diameter - s.tip_bore, s.butt_diameter - s.butt_bore) / 2 for s in empty), default=np.inf)


def _residual(before: float, after: float, independent: bool) -> float:
    """Uncertainty of an uncertain parameter in ln(after/before); independent: the change replaces its value.

    A parameter of the changed cue alone, such as the width of a drilled bore, is known.
    """
    return math.hypot(before, after) if independent else after - before


def _row(change: DesignChange, base: Record, numbers: Record, error: float) -> Record:
    relative = {name: numbers[name] / base[name] - 1 for name in ("squirt", "tip_stiffness")}
    absolute = {name: numbers[name] - base[name] for name in ("shaft_mass", "frequency")}
    changes = {f"{name}_change": value for name, value in (relative | absolute).items()}
    verdict = {"squirt_change_error": error, "verdict": _verdict(relative, error)}
    return {"change": change.label, "values": change.values} | numbers | changes | verdict


def _verdict(relative: Record, error: float) -> str:
    if abs(relative["squirt"]) <= error:
        return "within uncertainty"
    if relative["squirt"] > 0:
        return "more squirt"
    return "worthwhile, costs stiffness" if relative["tip_stiffness"] < -MIN_STIFFNESS_LOSS else "worthwhile"
