"""The knobs of a cue, and a scene with its knobs turned.

A knob that was not moved changes nothing: the scene stays as its file has it. What has no knob (other segments and
effects, the ball) is kept as well. The parts that the knobs change are found in the drawing:

- The leather is the soft material at the tip. The ferrule is the segment behind it, if that is short and of another
  material than the segment that follows. The shaft is all that follows, up to the next change of material.
- A diameter is set at three places: at the tip, `TAPER_AT` behind it, and at the end of the drawing. What is added at
  one place becomes less and less towards the next, so that every piece stays a cone.
- A longer ferrule takes its length from the wood behind it and ends flush with that wood. The cue stays as long as it
  was, and the cone of the shaft stays where it was.
- The bore is the empty one behind the leather, or behind the ferrule if the ferrule sits on a tenon. Its depth is
  counted from where it begins. A bore that is filled has no knob.
- The joint is the first `Joint` among the effects. Its knob sets how far it bends.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from cuefem.cue import SOFT, Cue, Material, Segment
from cuefem.effects import Effect, Joint, LeatherTip, Support
from cuefem.scene import Scene

LONGEST_FERRULE = 0.06  # m
TAPER_AT = 0.3302  # m, 13 in: so far pool shafts stay nearly straight; half the length of a cue shorter than twice that
BRIDGE_AT = 0.2032  # m, 8 in
USUAL_BORE = 0.006  # m, the width of a new bore
SAME = 1e-9  # relative to a length: places closer than this are the same


@dataclass(frozen=True)
class Knobs:
    """The settings of all knobs, in SI units. None: the scene has no such part, or one that no knob can change.

    Diameters at the tip, `TAPER_AT` behind it and at the end, m; bore: depth from its mouth and width, m; joint:
    distance from the tip, m, and rotational compliance, rad/(N m); bridge: distance from the tip, m, and stiffness,
    N/m; contact time of a head-on blow, s; of a leather tip: height and radius of the dome, m, and E, Pa; speed, m/s;
    offset b/R; mass behind the segments, kg.
    """

    tip_diameter: float
    taper_diameter: float
    butt_diameter: float
    bore_depth: float | None
    bore_width: float | None
    ferrule_length: float | None
    ferrule_material: Material | None
    shaft_material: Material
    joint_position: float
    joint_compliance: float
    contact_time: float | None
    tip_height: float | None
    tip_dome: float | None
    leather: float | None
    restitution: float
    friction: float | None
    bridge_position: float
    bridge_stiffness: float
    speed: float
    offset: float
    body_mass: float


@dataclass(frozen=True)
class Parts:
    """Where a cue's parts are, by its segments' indices. ferrule: empty without one. bore: None if it is filled."""

    ferrule: range
    shaft: range
    bore: range | None

    @classmethod
    def of(cls, cue: Cue) -> Parts:
        """The parts, told by the drawing."""
        pieces = cue.segments
        last = len(pieces) - 1
        front = next((i for i, s in enumerate(pieces) if s.material.E >= SOFT), last)
        first = _run(pieces, front)
        if first > last or cue.nodes[first] - cue.nodes[front] > LONGEST_FERRULE:
            first = front
        mouth = front if _empty_bore(pieces[front]) else first
        bore = None if pieces[mouth].core else range(mouth, _first_without_bore(pieces, mouth))
        return cls(range(front, first), range(first, _run(pieces, first)), bore)


def _run(pieces: Sequence[Segment], first: int) -> int:
    """Where another material begins."""
    return next((i for i in range(first, len(pieces)) if pieces[i].material != pieces[first].material), len(pieces))


def _empty_bore(segment: Segment) -> bool:
    return segment.core is None and _width(segment) > 0


def _width(segment: Segment) -> float:
    return max(segment.tip_bore, segment.butt_bore)


def _first_without_bore(pieces: Sequence[Segment], first: int) -> int:
    return next((i for i in range(first, len(pieces)) if not _empty_bore(pieces[i])), len(pieces))


def cue_of(scene: Scene) -> Cue:
    """The scene's cue; ValueError for a lumped one, which has no shape."""
    return scene.shaft


def taper_position(cue: Cue) -> float:
    """Where the taper's knob measures the diameter, m from the tip."""
    return TAPER_AT if cue.length >= 2 * TAPER_AT else cue.length / 2


def bore_mouth(cue: Cue) -> float:
    """Where the bore begins, m from the tip."""
    bore = Parts.of(cue).bore
    return float(cue.nodes[bore.start]) if bore is not None else 0.0


def deepest_bore(cue: Cue) -> float:
    """How deep the bore can be, m from its mouth: up to what is filled, or the cue's end."""
    bore = Parts.of(cue).bore
    if bore is None:
        return 0.0
    filled = (i for i in range(bore.start, len(cue.segments)) if cue.segments[i].core is not None)
    return float(cue.nodes[next(filled, len(cue.segments))] - cue.nodes[bore.start])


def knobs_of(scene: Scene) -> Knobs:
    """The settings of a scene's knobs; ValueError for a lumped cue."""
    cue = cue_of(scene)
    parts, pieces = Parts.of(cue), cue.segments
    ferrule = parts.ferrule
    joint, bridge = joint_of(scene), bridge_of(scene)
    leather = scene.leather if scene.contact_terms.tip is not None else None
    return Knobs(
        tip_diameter=pieces[0].tip_diameter,
        taper_diameter=outer_diameter(cue, taper_position(cue)),
        butt_diameter=pieces[-1].butt_diameter,
        bore_depth=None if parts.bore is None else float(cue.nodes[parts.bore.stop] - cue.nodes[parts.bore.start]),
        bore_width=None if parts.bore is None else _width(pieces[parts.bore.start]) if parts.bore else USUAL_BORE,
        ferrule_length=float(np.ptp(cue.nodes[[ferrule.start, ferrule.stop]])) if ferrule else None,
        ferrule_material=pieces[ferrule.start].material if ferrule else None,
        shaft_material=pieces[parts.shaft.start].material,
        joint_position=joint.position,
        joint_compliance=joint.rotational_compliance,
        contact_time=None if scene.contact_terms.tip is not None else float(scene.contact_time),
        tip_height=leather.height if leather else None,
        tip_dome=leather.dome_radius if leather and math.isfinite(leather.dome_radius) else None,
        leather=leather.E if leather else None,
        restitution=float(scene.tip.restitution),
        friction=float(scene.tip.friction) if math.isfinite(scene.tip.friction) else None,
        bridge_position=bridge.position,
        bridge_stiffness=bridge.stiffness,
        speed=float(scene.stroke.speed),
        offset=float(scene.stroke.offset),
        body_mass=cue.body_mass,
    )


def bridge_of(scene: Scene) -> Support:
    """The scene's first soft support across the cue; without one, a hand that does not hold it, 8 in behind the tip."""
    own = (e for e in scene.effects if isinstance(e, Support) and math.isfinite(e.stiffness))
    return next(own, Support(min(BRIDGE_AT, 0.5 * cue_of(scene).length), 0.0))


def joint_of(scene: Scene) -> Joint:
    """The scene's first joint; without one, a stiff one at the back end of the shaft's material or inside the cue."""
    own = next((effect for effect in scene.effects if isinstance(effect, Joint)), None)
    if own is not None:
        return own
    cue = cue_of(scene)
    back = float(cue.nodes[Parts.of(cue).shaft.stop])
    return Joint(back if back < 0.99 * cue.length else 0.9 * cue.length)


def outer_diameter(cue: Cue, x: float) -> float:
    """Outer diameter at x m from the tip; at a jump that of the butt side."""
    i = min(int(np.searchsorted(cue.nodes, x, side="right")) - 1, len(cue.segments) - 1)
    piece = cue.segments[i]
    t = (x - cue.nodes[i]) / piece.length
    return float(piece.tip_diameter + (piece.butt_diameter - piece.tip_diameter) * t)


def turned(scene: Scene, knobs: Knobs) -> Scene:
    """The scene with its knobs turned, or the scene itself if none was. ValueError if no such cue can be made."""
    cue = cue_of(scene)
    own = knobs_of(scene)
    changed = _with_bore(_with_diameters(_with_ferrule(cue, own, knobs), own, knobs), knobs)
    changed = _with_materials(changed, knobs)  # last, because the parts are told by their materials
    if knobs.body_mass != own.body_mass:
        changed = replace(changed, body_mass=knobs.body_mass)
    parts: dict[str, Any] = {
        "cue": changed,
        "tip": _with_fields(scene.tip, own, knobs, ("restitution", "friction")),
        "stroke": _with_fields(scene.stroke, own, knobs, ("speed", "offset")),
        "effects": _with_bridge(_with_joint(_with_leather(scene, own, knobs), scene, knobs), scene, knobs),
    }
    if own.contact_time is not None and knobs.contact_time != own.contact_time:
        parts["tip"] = replace(parts["tip"], contact_time=knobs.contact_time, stiffness=None)
    same = all(value is getattr(scene, name) or value == getattr(scene, name) for name, value in parts.items())
    return scene if same else replace(scene, **parts)


def _with_fields(held: Any, own: Knobs, knobs: Knobs, names: Sequence[str]) -> Any:
    """A part of the scene with those of its fields changed whose knobs were turned."""
    changed = {name: getattr(knobs, name) for name in names if getattr(knobs, name) != getattr(own, name)}
    return replace(held, **changed) if changed else held


def _with_leather(scene: Scene, own: Knobs, knobs: Knobs) -> tuple[Effect, ...]:
    """The effects with the leather tip's fields changed whose knobs were turned."""
    fields = {"tip_height": "height", "tip_dome": "dome_radius", "leather": "E"}
    turned_ones = [(field, name) for name, field in fields.items() if getattr(knobs, name) != getattr(own, name)]
    changed: dict[str, Any] = {field: getattr(knobs, name) for field, name in turned_ones}
    return tuple(replace(e, **changed) if changed and isinstance(e, LeatherTip) else e for e in scene.effects)


def _with_materials(cue: Cue, knobs: Knobs) -> Cue:
    """Set the ferrule's and the shaft's material; a tenon of the shaft's wood changes with the shaft."""
    parts, pieces = Parts.of(cue), list(cue.segments)
    old = pieces[parts.shaft.start].material
    for i in parts.shaft:
        pieces[i] = _of_material(pieces[i], knobs.shaft_material)
    for i in parts.ferrule:
        ferrule = _of_material(pieces[i], knobs.ferrule_material or pieces[i].material)
        pieces[i] = replace(ferrule, core=knobs.shaft_material) if ferrule.core == old else ferrule
    return _with_segments(cue, pieces)


def _of_material(segment: Segment, material: Material) -> Segment:
    return segment if segment.material == material else replace(segment, material=material)


def _with_segments(cue: Cue, pieces: Sequence[Segment]) -> Cue:
    return cue if tuple(pieces) == cue.segments else replace(cue, segments=tuple(pieces))


def _with_ferrule(cue: Cue, own: Knobs, knobs: Knobs) -> Cue:
    if own.ferrule_length is None or knobs.ferrule_length is None or knobs.ferrule_length == own.ferrule_length:
        return cue
    pieces, behind_it = list(cue.segments), Parts.of(cue).ferrule.stop
    ferrule, behind = pieces[behind_it - 1], pieces[behind_it]
    more = knobs.ferrule_length - own.ferrule_length
    if not -ferrule.length < more < behind.length:
        least, most = (1e3 * (own.ferrule_length + by) for by in (-ferrule.length, behind.length))
        got = 1e3 * knobs.ferrule_length
        raise ValueError(
            f"the ferrule must be in ({least:.6g}, {most:.6g}) mm long, as its neighbours allow; got {got:.6g} mm"
        )
    onward = -more / behind.length  # of the cone behind the ferrule, which keeps its line
    outer = behind.tip_diameter + (behind.tip_diameter - behind.butt_diameter) * onward
    bore = max(0.0, behind.tip_bore + (behind.tip_bore - behind.butt_bore) * onward)
    flush = ferrule.butt_diameter + outer - behind.tip_diameter
    pieces[behind_it - 1] = replace(ferrule, length=ferrule.length + more, butt_diameter=flush)
    pieces[behind_it] = replace(behind, length=behind.length - more, tip_diameter=outer, tip_bore=bore)
    return _with_segments(cue, pieces)


def _with_diameters(cue: Cue, own: Knobs, knobs: Knobs) -> Cue:
    names = ("tip_diameter", "taper_diameter", "butt_diameter")
    more = [getattr(knobs, name) - getattr(own, name) for name in names]
    if not any(more):
        return cue
    middle = taper_position(cue)
    if abs(more[1] - np.interp(middle, [0, cue.length], [more[0], more[2]])) > SAME * cue.length:
        cue = _split_at(cue, middle)

    def grown(piece: Segment, start: float) -> Segment:
        first, last = np.interp([start, start + piece.length], [0, middle, cue.length], more)
        ends = piece.tip_diameter + float(first), piece.butt_diameter + float(last)
        if min(ends) <= 0:
            raise ValueError(f"the cue must be thicker than nothing; got {1e3 * min(ends):.4g} mm")
        return replace(piece, tip_diameter=ends[0], butt_diameter=ends[1])

    pieces = [grown(piece, float(x)) for piece, x in zip(cue.segments, cue.nodes, strict=False)]
    return _with_segments(cue, pieces)


def _split_at(cue: Cue, x: float) -> Cue:
    """The same cue with a segment's end at x m from the tip."""
    if np.abs(cue.nodes - x).min() <= SAME * cue.length or not 0 < x < cue.length:
        return cue
    i = int(np.searchsorted(cue.nodes, x)) - 1
    piece, part = cue.segments[i], float(x - cue.nodes[i])
    outer = piece.tip_diameter + (piece.butt_diameter - piece.tip_diameter) * part / piece.length
    bore = piece.tip_bore + (piece.butt_bore - piece.tip_bore) * part / piece.length
    front = replace(piece, length=part, butt_diameter=outer, butt_bore=bore)
    back = replace(piece, length=piece.length - part, tip_diameter=outer, tip_bore=bore)
    return replace(cue, segments=(*cue.segments[:i], front, back, *cue.segments[i + 1 :]))


def _with_bore(cue: Cue, knobs: Knobs) -> Cue:
    """The bore as deep and wide as the knobs say: its shape is widened, and continued as wide as it ends."""
    bore, deepest, near = Parts.of(cue).bore, deepest_bore(cue), SAME * cue.length
    if bore is None or knobs.bore_depth is None or knobs.bore_width is None:
        return cue
    mouth, old_end = float(cue.nodes[bore.start]), float(cue.nodes[bore.stop])
    width = _width(cue.segments[bore.start]) if bore else knobs.bore_width
    if abs(knobs.bore_depth - (old_end - mouth)) <= near and knobs.bore_width == width:
        return cue
    if knobs.bore_depth > deepest + near:
        raise ValueError(f"the bore must be at most {1e3 * deepest:g} mm deep; got {1e3 * knobs.bore_depth:g} mm")
    wider = knobs.bore_width / width if width else 1.0
    onward = wider * cue.segments[bore.stop - 1].butt_bore if bore else knobs.bore_width
    end = mouth + min(knobs.bore_depth, deepest)

    def bored(piece: Segment, start: float) -> Segment:
        was, is_now = (mouth - near <= start < stop - near for stop in (old_end, end))
        if not (was or is_now):
            return piece
        ends = (0.0, 0.0) if not is_now else (wider * piece.tip_bore, wider * piece.butt_bore) if was else (onward,) * 2
        for inner, outer in zip(ends, (piece.tip_diameter, piece.butt_diameter), strict=True):
            if inner >= outer:
                raise ValueError(
                    f"the bore must be narrower than the cue, {1e3 * outer:.4g} mm there; got {1e3 * inner:.4g} mm"
                )
        return replace(piece, tip_bore=ends[0], butt_bore=ends[1])

    cue = _split_at(cue, end)
    pieces = [bored(piece, float(x)) for piece, x in zip(cue.segments, cue.nodes, strict=False)]
    return _with_segments(cue, pieces)


def _with_joint(effects: tuple[Effect, ...], scene: Scene, knobs: Knobs) -> tuple[Effect, ...]:
    joint = joint_of(scene)
    moved = replace(joint, position=knobs.joint_position, rotational_compliance=knobs.joint_compliance)
    return _exchanged(effects, joint, moved, needed=knobs.joint_compliance > 0)


def _with_bridge(effects: tuple[Effect, ...], scene: Scene, knobs: Knobs) -> tuple[Effect, ...]:
    bridge = bridge_of(scene)
    moved = replace(bridge, position=knobs.bridge_position, stiffness=knobs.bridge_stiffness)
    return _exchanged(effects, bridge, moved, needed=knobs.bridge_stiffness > 0)


def _exchanged(effects: tuple[Effect, ...], old: Effect, new: Effect, *, needed: bool) -> tuple[Effect, ...]:
    """The effects with one exchanged for another, which is added, if it is needed, where they do not have the first."""
    if old in effects:
        return tuple(new if effect == old else effect for effect in effects)
    return (*effects, new) if needed else effects
