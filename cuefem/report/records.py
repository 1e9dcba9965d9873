"""Results as records: dictionaries of SI numbers, texts and lists that JSON can say (no NaN, no infinity)."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import asdict, replace
from typing import Any

import numpy as np

from cuefem.cue import Cue, LumpedCue
from cuefem.effects import TipEffect
from cuefem.endmass import Drive, Spread, end_mass_spreads, formula_of, lump_modes, stick_at_offset
from cuefem.impulse import impulse
from cuefem.materials import MATERIALS
from cuefem.modes import TipModes, modes
from cuefem.quantity import scalar
from cuefem.resolution import tip_modes_of
from cuefem.scene import Outcome, Scene
from cuefem.squirt import alciatore_a31, cue_end_mass, natural_pivot_length
from cuefem.strike import strike, strike_modes
from cuefem.validation import Claim

DRIVES: tuple[Drive, ...] = ("stick", "offset", "velocity", "force", "squirt")
OFFSETS = (0.1, 0.2, 0.3, 0.4, 0.5)
PAPER_CUE_END_MASS = 0.012  # kg, [Kim]'s m_c of a real cue; the tip feels a quarter of it

Record = dict[str, Any]

UNITS = {
    **dict.fromkeys(("mass", "shaft_mass", "body_mass", "end_mass", "cue_end_mass", "lowest", "highest"), "kg"),
    **dict.fromkeys(("length", "balance_point", "radius", "pivot_length"), "m"),
    **dict.fromkeys(("speed", "ball_speed", "ball_velocity", "cue_speed"), "m/s"),
    **dict.fromkeys(("contact_time", "duration"), "s"),
    **dict.fromkeys(("frequencies", "near", "nearest"), "Hz"),
    **{"tip_amplitudes": "1/sqrt(kg)", "squirt": "rad", "spin": "rad/s"},
    **{"coupling": "1/kg", "seconds": "s", "impulse": "N s", "energy": "J", "E": "Pa", "G": "Pa", "rho": "kg/m^3"},
}


def plain(value: Any) -> Any:
    """A value as JSON can say it: arrays as lists, what is infinite or undefined as null."""
    if isinstance(value, dict):
        return {str(key): plain(inner) for key, inner in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist())
    if isinstance(value, list | tuple):
        return [plain(inner) for inner in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def cue_record(cue: Cue | LumpedCue) -> Record:
    """What a cue is, in a few numbers."""
    if isinstance(cue, LumpedCue):
        return {"mass": cue.mass, "end_mass": cue.end_mass, "coupling": cue.coupling}
    names = ("length", "mass", "shaft_mass", "body_mass", "balance_point")
    return {name: getattr(cue, name) for name in names} | {"segments": len(cue.segments)}


def scene_record(scene: Scene) -> Record:
    """What a stroke's numbers rest on: cue, ball, tip, stroke and effects."""
    return {
        "cue": cue_record(scene.cue),
        "ball": asdict(scene.ball),
        "tip": {name: value for name, value in asdict(scene.tip).items() if value is not None}
        | {"contact_time": scene.contact_time},
        "stroke": asdict(scene.stroke),
        "effects": [{"type": type(effect).__name__, **asdict(effect)} for effect in scene.effects],
        "effects_at_tip": [type(effect).__name__ for effect in scene.effects if isinstance(effect, TipEffect)],
    }


def modes_record(scene: Scene, *, count: int, near: float | None) -> Record:
    """Frequencies and tip amplitudes of the scene's cue: the ``count`` lowest modes or those nearest ``near`` Hz.

    "nearest": the frequency nearest ``near``, None without it.
    """
    if not isinstance(scene.cue, Cue):
        raise ValueError("modes need a cue of segments; got a lumped cue, which has none")
    found = modes(scene.cue, count, near, effects=scene.cue_effects)
    amplitudes, _ = found.shape(0.0)
    nearest = None if near is None else min(found.frequencies.tolist(), key=lambda f: abs(f - near))
    return {
        "near": near,
        "nearest": nearest,
        "rigid": found.rigid,
        "frequencies": found.frequencies.tolist(),
        "tip_amplitudes": amplitudes.tolist(),
    }


def end_mass_record(scene: Scene, *, tip: TipModes | None = None) -> Record:
    """The end masses m_e, how far they spread over the modes kept, [Kim]'s m_c and eps = m_c/M of each.

    "offset" and "squirt" are those at the scene's own offset. A definition that has no answer here says why instead.
    tip: better tip modes than those that the spread is over, where they are known.
    """
    spread = end_mass_spreads(scene)
    return {
        "contact_time": scene.contact_time,
        "offset": scene.stroke.offset,
        "drives": {drive: _end_mass(scene, spread, drive, tip=tip) for drive in DRIVES},
    }


def _end_mass(scene: Scene, spread: Callable[[Drive], Spread], drive: Drive, *, tip: TipModes | None = None) -> Record:
    try:
        felt, lowest, highest, _ = spread(drive)
        if tip is not None:
            felt = formula_of(drive)(tip, scene)
    except ValueError as error:
        names = ("end_mass", "lowest", "highest", "cue_end_mass", "eps")
        return {**dict.fromkeys(names), "reason": str(error)}
    if not felt > 0:
        raise ValueError(
            f"the end mass comes out as {1e3 * felt:.4g} g ({drive}), which no cue has: its tip is far too weak for a "
            f"contact of {1e3 * float(scene.contact_time):.4g} ms; check sizes, E and the contact time"
        )
    whole = float(cue_end_mass(felt))
    return {
        "end_mass": felt,
        "lowest": lowest,
        "highest": highest,
        "cue_end_mass": whole,
        "eps": whole / scene.ball.mass,
    }


def two_part_cues(scene: Scene, offsets: Sequence[float], tip: TipModes | None) -> list[LumpedCue | None]:
    """The scene's cue as the impulse solver takes it at each offset, without effects at its tip.

    Its end mass is that of a tip that sticks at this offset; None where none has that squirt. tip: the cue's tip modes,
    None of a lumped cue, which keeps its end mass.
    """
    if tip is None:
        assert isinstance(scene.cue, LumpedCue)
        return [replace(scene.cue, coupling=0.0)] * len(offsets)
    bare = replace(scene, effects=tuple(effect for effect in scene.effects if not isinstance(effect, TipEffect)))
    try:
        masses = stick_at_offset(tip, _at(bare, np.array(offsets)))
    except ValueError:
        if len(offsets) == 1:
            return [None]
        return [cue for offset in offsets for cue in two_part_cues(scene, [offset], tip)]
    return [LumpedCue(scene.axial_mass, felt) for felt in masses.tolist()]


def _coupling_slope(scene: Scene, tip: TipModes | None) -> float:
    """What effects at the tip add to `two_part_cues`, as a coupling per b/R; zero where no lumped cue has them.

    It is found at the scene's own offset, or head on at 0.1.
    """
    offset = scalar("Stroke.offset", scene.stroke.offset) or 0.1
    try:
        cue = scene.cue if tip is None else lump_modes(_at(scene, offset), tip)
    except ValueError:  # an offset, or an effect, beyond any lumped cue's coupling
        return 0.0
    assert isinstance(cue, LumpedCue)
    return scalar("LumpedCue.coupling", cue.coupling) / abs(offset)


def _coupled(cue: LumpedCue | None, coupling: float) -> LumpedCue | None:
    """The cue with a coupling; None where no cue has it."""
    try:
        return cue and replace(cue, coupling=coupling)
    except ValueError:
        return None


def _at(scene: Scene, offset: Any) -> Scene:
    return replace(scene, stroke=replace(scene.stroke, offset=offset))


def _known_tip(scene: Scene) -> TipModes | None:
    return None if isinstance(scene.cue, LumpedCue) else tip_modes_of(scene)


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
    offset, tip = scalar("Stroke.offset", scene.stroke.offset), _known_tip(scene)
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


def _curve(
    scene: Scene,
    offsets: Sequence[float],
    cues: Sequence[LumpedCue | None],
    squirt: Callable[[Scene, LumpedCue], Any] = lambda scene, cue: impulse(bare_scene(scene, cue)).squirt,
) -> Record:
    """Squirt and natural pivot length of a lumped cue an offset, nan where there is none."""
    found: Record = {"squirt": np.full(len(offsets), np.nan), "pivot_length": np.full(len(offsets), np.nan)}
    for i, (offset, cue) in enumerate(zip(offsets, cues, strict=True)):
        if cue is not None:
            struck = _at(scene, offset)
            found["squirt"][i] = squirt(struck, cue)
            found["pivot_length"][i] = _pivot_length(struck, found["squirt"][i])
    return found


def two_part_curve(scene: Scene, offsets: Sequence[float], tip: TipModes | None) -> Record:
    """The impulse solver's squirt and natural pivot length against the offset, each with its own `two_part_cues`."""
    return _curve(scene, offsets, two_part_cues(scene, offsets, tip))


def squirt_record(scene: Scene, offsets: Sequence[float] = OFFSETS, *, tip: TipModes | None = None) -> Record:
    """Squirt and natural pivot length against the offset: coupled in time, lumped (where effects at the tip couple the
    cue's motions), two parts of this cue, [Kim]'s 12 g, [A.31]; nan where there is no lumped cue. "end_mass": that of
    the tip that sticks at each offset, without effects at the tip.

    tip: the cue's tip modes, where they are known.
    """
    tip = _known_tip(scene) if tip is None else tip
    cues, slope = two_part_cues(scene, offsets, tip), _coupling_slope(scene, tip)
    struck = _struck(scene, offsets, tip)
    coupled = np.array([outcome.squirt for outcome in struck])
    pivots = _pivot_length(_at(scene, np.array(offsets)), coupled)
    found: Record = {"coupled, this cue": {"squirt": coupled, "pivot_length": pivots}}
    if slope:
        lumped = [_coupled(cue, slope * abs(b)) for cue, b in zip(cues, offsets, strict=True)]
        found["lumped, this cue"] = _curve(scene, offsets, lumped)
    papers = LumpedCue.two_part(scene.axial_mass, PAPER_CUE_END_MASS)
    found["two-part, this cue"] = _curve(scene, offsets, cues)
    found["two-part, 12 g"] = _curve(scene, offsets, [papers] * len(offsets))
    found["A.31, this cue"] = _curve(scene, offsets, cues, _a31)
    found["coupled, this cue"]["regime"] = [outcome.regime for outcome in struck]
    return {
        "offsets": list(offsets),
        "end_mass": [None if cue is None else cue.end_mass for cue in cues],
        "coupling": slope,
        "models": found,
    }


def _struck(scene: Scene, offsets: Sequence[float], tip: TipModes | None) -> list[Outcome]:
    scenes = [replace(scene, stroke=replace(scene.stroke, offset=b)) for b in offsets]
    if tip is None:
        return [strike(one) for one in scenes]
    return [strike_modes(one, tip) for one in scenes]


def report_record(scene: Scene, *, count: int = 6) -> Record:
    """All of it: modes, end masses, squirt and pivot length; and how the scene's own stroke goes."""
    found: Record = {"modes": modes_record(scene, count=count, near=None)} if isinstance(scene.cue, Cue) else {}
    found |= {"end_masses": end_mass_record(scene), "squirt": squirt_record(scene)}
    return found | {"regime": strike(scene).regime}


def claims_record(claims: Sequence[tuple[str, Claim]]) -> list[Record]:
    """Claims of sources, each with the study that holds it and its relative difference."""
    return [{"study": study, **asdict(claim), "difference": claim.difference} for study, claim in claims]


def materials_record() -> Record:
    """The materials that a file can name: values, ranges, sources."""
    return {
        "materials": {
            name: {
                **asdict(known.material),
                "ranges": {key: list(ends) for key, ends in known.ranges.items()},
                "source": known.source,
                "note": known.note,
            }
            for name, known in MATERIALS.items()
        },
        "units": {name: UNITS[name] for name in ("E", "G", "rho")},
    }
