"""The parts of a cue that no field holds, told by its drawing: what each is, and how another one is put in its place.

- The leather that is drawn is the soft material at the tip. The ferrule is the segment behind it, if that is short and
  of another material than the segment that follows. The shaft is all that follows, up to the next change of material.
- A diameter is set at three positions: at the tip, `TAPER_AT` behind it, and at the end of the drawing. What is added
  at one of them becomes less and less towards the next, so that every segment stays a cone.
- A longer ferrule takes its length from the wood behind it and ends flush with that wood. The cue stays as long as it
  was, the cone of the shaft stays where it was, and the bore behind the ferrule stays as deep as it was.
- The bore is the empty one behind the leather, or behind the ferrule if the ferrule sits on a tenon. Its depth is
  counted from where it begins. A bore that is filled cannot be varied.
- The joint is the first `Joint` among the effects, the bridge the first soft `Support`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any, NamedTuple

import numpy as np

from cuefem.cue import SOFT, Cue, Material, Segment
from cuefem.effects import AxialWaves, Effect, Joint, LeatherTip, Support
from cuefem.effects.on_cue import MOST_DENSITY
from cuefem.quantity.fields import DIAMETER, LENGTH, Quantity

LONGEST_FERRULE = 0.06  # m
TAPER_AT = 0.3302  # m, 13 in: so far pool shafts stay nearly straight; half the length of a cue shorter than twice that
BRIDGE_AT = 0.2032  # m, 8 in
USUAL_BORE = 0.006  # m, the width of a new bore
LEAST_DENSITY = 20.0  # kg/m3, foam's: of a material that a weight tells
SAME = 1e-9  # relative to a length: positions closer than this are the same


class Part(NamedTuple):
    """A part of a scene that no field holds.

    read: what the scene has there: a dataclass, a material or, with its ``quantity``, a number; None if it has no such
    part. write: the scene with another one in its place. keeps: parts that stay as they were where this one changes.
    """

    read: Callable[[Any], Any]
    write: Callable[[Any, Any], Any]
    quantity: Quantity | None = None
    keeps: tuple[str, ...] = ()


@dataclass(frozen=True)
class Ferrule:
    """Its length, m."""

    length: Annotated[float, LENGTH]


@dataclass(frozen=True)
class Diameters:
    """Outer diameters at the tip, at `taper_position` and at the end of the drawing, m."""

    tip: Annotated[float, DIAMETER]
    taper: Annotated[float, DIAMETER]
    butt: Annotated[float, DIAMETER]


@dataclass(frozen=True)
class Bore:
    """Its depth from its mouth, and its width, m; a cue without a bore has one of no depth."""

    depth: Annotated[float, Quantity("m", "[0, 1000]")]
    width: Annotated[float, DIAMETER]


@dataclass(frozen=True)
class Woods:
    """The materials of the ferrule, if there is one, and of the shaft with its tenon."""

    ferrule: Material | None
    shaft: Material


@dataclass(frozen=True)
class Weight:
    """The mass of all that is drawn, a leather tip included, kg."""

    mass: Annotated[float, Quantity("kg", "(0, 100]")]


class Layout(NamedTuple):
    """Where a cue's parts are, by its segments' indices. ferrule: empty without one. bore: None if it is filled."""

    ferrule: range
    shaft: range
    bore: range | None

    @classmethod
    def of(cls, cue: Cue) -> Layout:
        """The layout, told by the drawing."""
        segments = cue.segments
        last = len(segments) - 1
        front = next((i for i, s in enumerate(segments) if s.material.E >= SOFT), last)
        first = _next_material(segments, front)
        if first > last or cue.nodes[first] - cue.nodes[front] > LONGEST_FERRULE * (1 + SAME):
            first = front
        mouth = front if _is_bored(segments[front]) else first
        closed = next((i for i in range(mouth, len(segments)) if not _is_bored(segments[i])), len(segments))
        bore = None if segments[mouth].core else range(mouth, closed)
        return cls(range(front, first), range(first, _next_material(segments, first)), bore)


def _next_material(segments: Sequence[Segment], first: int) -> int:
    """Where another material begins."""
    same = segments[first].material
    return next((i for i in range(first, len(segments)) if segments[i].material != same), len(segments))


def _is_bored(segment: Segment) -> bool:
    return segment.core is None and _width(segment) > 0


def _width(segment: Segment) -> float:
    return max(segment.tip_bore, segment.butt_bore)


def taper_position(cue: Cue) -> float:
    """Where the middle of the `Diameters` is measured, m from the tip."""
    return TAPER_AT if cue.length >= 2 * TAPER_AT else cue.length / 2


def bore_mouth(cue: Cue) -> float:
    """Where the bore begins, m from the tip."""
    bore = Layout.of(cue).bore
    return 0.0 if bore is None else float(cue.nodes[bore.start])


def deepest_bore(cue: Cue) -> float:
    """How deep the bore can be, m from its mouth: up to what is filled, or the cue's end."""
    bore = Layout.of(cue).bore
    if bore is None:
        return 0.0
    filled = (i for i in range(bore.start, len(cue.segments)) if cue.segments[i].core is not None)
    return float(cue.nodes[next(filled, len(cue.segments))] - cue.nodes[bore.start])


def outer_diameter(cue: Cue, x: float) -> float:
    """Outer diameter at x m from the tip; at a jump that of the butt side."""
    i = min(int(np.searchsorted(cue.nodes, x, side="right")) - 1, len(cue.segments) - 1)
    segment = cue.segments[i]
    t = (x - cue.nodes[i]) / segment.length
    return float(segment.tip_diameter + (segment.butt_diameter - segment.tip_diameter) * t)


def with_segments(scene: Any, segments: Sequence[Segment]) -> Any:
    """The scene with other segments in its cue."""
    return replace(scene, cue=replace(scene.shaft, segments=tuple(segments)))


def with_material(cue: Cue, old: Material, new: Material) -> Cue:
    """The cue with a material replaced wherever it stands, cores included."""
    return _with_materials(cue, {old: new})


def _with_materials(cue: Cue, new: Mapping[Any, Any]) -> Cue:
    return replace(
        cue,
        segments=tuple(
            replace(s, material=new.get(s.material, s.material), core=new.get(s.core, s.core)) for s in cue.segments
        ),
    )


def main_material(cue: Cue, segment: int | None = None) -> Material:
    """The material that fills most of the cue's length, or that of a segment, 0 at the tip. ValueError beyond."""
    if segment is not None:
        if not 0 <= segment < len(cue.segments):
            raise ValueError(f"segment must be in [0, {len(cue.segments) - 1}], 0 at the tip; got {segment}")
        return cue.segments[segment].material
    lengths: dict[Material, float] = {}
    for s in cue.segments:
        lengths[s.material] = lengths.get(s.material, 0.0) + s.length
    return max(lengths, key=lambda material: lengths[material])


def materials_in(cue: Cue) -> tuple[Material, ...]:
    """The materials of a cue, each once, from tip to butt."""
    return tuple(dict.fromkeys(m for s in cue.segments for m in (s.material, s.core) if m is not None))


# --- the weight ----------------------------------------------------------------------------


def with_shaft_mass(cue: Cue, mass: float) -> Cue:
    """The cue with the density of its main material such that what is drawn weighs ``mass``, kg.

    ValueError if the other materials weigh as much, or if no material has such a density.
    """
    wood = main_material(cue)
    half = _with_materials(cue, {wood: replace(wood, rho=wood.rho / 2)}).shaft_mass
    volume = (cue.shaft_mass - half) / (wood.rho / 2)  # m3 of that material
    others = cue.shaft_mass - volume * wood.rho
    rho = (mass - others) / volume
    if not LEAST_DENSITY <= rho <= MOST_DENSITY:
        least, most = (1e3 * (others + volume * end) for end in (LEAST_DENSITY, MOST_DENSITY))
        raise ValueError(
            f"must be {least:.4g} to {most:.4g} g, with which its main material has {LEAST_DENSITY:g} to "
            f"{MOST_DENSITY:g} kg/m3; got {1e3 * mass:.4g} g"
        )
    return replace(with_material(cue, wood, replace(wood, rho=rho)), weighed=True)


def _tip_mass(scene: Any) -> float:
    """The mass of a leather tip in front of what is drawn, kg."""
    leather = _leather(scene)
    return 0.0 if leather is None else leather.mass_on(scene.shaft)


def _with_weight(scene: Any, new: Weight) -> Any:
    return replace(scene, cue=with_shaft_mass(scene.shaft, new.mass - _tip_mass(scene)))


# --- the ferrule, and what ferrule and shaft are made of ----------------------------------


def _ferrule(scene: Any) -> Ferrule | None:
    ferrule = Layout.of(scene.shaft).ferrule
    return Ferrule(float(np.ptp(scene.shaft.nodes[[ferrule.start, ferrule.stop]]))) if ferrule else None


def _with_ferrule(scene: Any, new: Ferrule) -> Any:
    segments, old, at = list(scene.shaft.segments), _ferrule(scene), Layout.of(scene.shaft).ferrule.stop
    if old is None or new == old:
        return scene
    ferrule, behind = segments[at - 1], segments[at]
    more = new.length - old.length
    if not -ferrule.length < more < behind.length:
        least, most = (1e3 * (old.length + by) for by in (-ferrule.length, behind.length))
        raise ValueError(
            f"the ferrule must be more than {least:.6g} and less than {most:.6g} mm long, as its neighbours allow; "
            f"got {1e3 * new.length:.6g} mm"
        )
    onward = -more / behind.length  # of the cone behind the ferrule, which keeps its line
    outer = behind.tip_diameter + (behind.tip_diameter - behind.butt_diameter) * onward
    bore = max(0.0, behind.tip_bore + (behind.tip_bore - behind.butt_bore) * onward)
    flush = ferrule.butt_diameter + outer - behind.tip_diameter
    segments[at - 1] = replace(ferrule, length=ferrule.length + more, butt_diameter=flush)
    segments[at] = replace(behind, length=behind.length - more, tip_diameter=outer, tip_bore=bore)
    return with_segments(scene, segments)


def _woods(scene: Any) -> Woods:
    layout, segments = Layout.of(scene.shaft), scene.shaft.segments
    ferrule = segments[layout.ferrule.start].material if layout.ferrule else None
    return Woods(ferrule, segments[layout.shaft.start].material)


def _with_woods(scene: Any, new: Woods) -> Any:
    """Set the ferrule's and the shaft's material; a tenon of the shaft's wood changes with the shaft."""
    layout, segments = Layout.of(scene.shaft), list(scene.shaft.segments)
    old = segments[layout.shaft.start].material
    for i in layout.shaft:
        segments[i] = replace(segments[i], material=new.shaft)
    for i in layout.ferrule:
        core = new.shaft if segments[i].core == old else segments[i].core
        segments[i] = replace(segments[i], material=new.ferrule or segments[i].material, core=core)
    made = with_segments(scene, segments)
    return made if new.shaft == old else replace(made, cue=replace(made.cue, weighed=False))


# --- the taper -------------------------------------------------------------------------------------


def _diameters(scene: Any) -> Diameters:
    cue, segments = scene.shaft, scene.shaft.segments
    middle = outer_diameter(cue, taper_position(cue))
    return Diameters(segments[0].tip_diameter, middle, segments[-1].butt_diameter)


def _with_diameters(scene: Any, new: Diameters) -> Any:
    cue, old = scene.shaft, _diameters(scene)
    more = [new.tip - old.tip, new.taper - old.taper, new.butt - old.butt]
    return _grown(scene, [0.0, taper_position(cue), cue.length], more) if any(more) else scene


def _grown(scene: Any, positions: Sequence[float], more: Sequence[float]) -> Any:
    """The scene with diameters that are larger by ``more`` at the cue's ends and one position between them."""
    cue, (_, middle, end) = scene.shaft, positions
    if abs(more[1] - np.interp(middle, [0, end], [more[0], more[2]])) > SAME * end:
        cue = split_at(cue, middle)

    def grown(segment: Segment, start: float) -> Segment:
        first, last = np.interp([start, start + segment.length], positions, more)
        ends = segment.tip_diameter + float(first), segment.butt_diameter + float(last)
        if min(ends) <= 0:
            raise ValueError(f"the cue must be thicker than nothing; got {1e3 * min(ends):.4g} mm")
        return replace(segment, tip_diameter=ends[0], butt_diameter=ends[1])

    return with_segments(scene, [grown(segment, float(x)) for segment, x in zip(cue.segments, cue.nodes, strict=False)])


def taper_at(x: float) -> Part:
    """The outer diameter at x m from the tip; those at the two ends stay."""

    def read(scene: Any) -> float | None:
        return outer_diameter(scene.shaft, x) if 0 < x < scene.shaft.length else None

    def write(scene: Any, value: float) -> Any:
        cue = scene.shaft
        return _grown(scene, [0.0, x, cue.length], [0.0, value - outer_diameter(cue, x), 0.0])

    return Part(read, write, DIAMETER)


def _growth(scene: Any) -> float | None:
    first, last = scene.shaft.segments[0], scene.shaft.segments[-1]
    return last.butt_diameter - first.tip_diameter if last.butt_diameter > first.tip_diameter else None


def _with_growth(scene: Any, value: float) -> Any:
    segments, d0, f = scene.shaft.segments, scene.shaft.segments[0].tip_diameter, value / (_growth(scene) or value)
    grown = (
        replace(s, tip_diameter=d0 + f * (s.tip_diameter - d0), butt_diameter=d0 + f * (s.butt_diameter - d0))
        for s in segments
    )
    return with_segments(scene, tuple(grown))


GROWTH = Part(_growth, _with_growth, DIAMETER)

# --- the bore -------------------------------------------------------------------------------------


def _bore(scene: Any) -> Bore | None:
    cue, bore = scene.shaft, Layout.of(scene.shaft).bore
    if bore is None:
        return None
    width = _width(cue.segments[bore.start]) if bore else USUAL_BORE
    return Bore(float(cue.nodes[bore.stop] - cue.nodes[bore.start]), width)


def _with_bore(scene: Any, new: Bore) -> Any:
    """The bore as deep and wide as ``new``: its shape is widened, and continued as wide as it ends."""
    cue = scene.shaft
    bore, deepest, near = Layout.of(cue).bore, deepest_bore(cue), SAME * cue.length
    if bore is None:
        return scene
    mouth, old_end = float(cue.nodes[bore.start]), float(cue.nodes[bore.stop])
    width = _width(cue.segments[bore.start]) if bore else new.width
    if abs(new.depth - (old_end - mouth)) <= near and new.width == width:
        return scene
    if new.depth > deepest + near:
        raise ValueError(f"the bore must be at most {1e3 * deepest:g} mm deep; got {1e3 * new.depth:g} mm")
    wider = new.width / width if width else 1.0
    onward = wider * cue.segments[bore.stop - 1].butt_bore if bore else new.width
    end = mouth + min(new.depth, deepest)

    def bored(segment: Segment, start: float) -> Segment:
        was, is_now = (mouth - near <= start < stop - near for stop in (old_end, end))
        if not (was or is_now):
            return segment
        widened = (wider * segment.tip_bore, wider * segment.butt_bore)
        ends = (0.0, 0.0) if not is_now else widened if was else (onward, onward)
        for inner, outer in zip(ends, (segment.tip_diameter, segment.butt_diameter), strict=True):
            if inner >= outer:
                raise ValueError(
                    f"the bore must be narrower than the cue, {1e3 * outer:.4g} mm there; got {1e3 * inner:.4g} mm"
                )
        return replace(segment, tip_bore=ends[0], butt_bore=ends[1])

    cue = split_at(cue, end)
    return with_segments(scene, [bored(piece, float(x)) for piece, x in zip(cue.segments, cue.nodes, strict=False)])


def split_at(cue: Cue, x: float) -> Cue:
    """The same cue with a segment's end at x m from the tip."""
    if np.abs(cue.nodes - x).min() <= SAME * cue.length or not 0 < x < cue.length:
        return cue
    i = int(np.searchsorted(cue.nodes, x)) - 1
    front, back = halves(cue.segments[i], float(x - cue.nodes[i]) / cue.segments[i].length)
    return replace(cue, segments=(*cue.segments[:i], front, back, *cue.segments[i + 1 :]))


def halves(segment: Segment, share: float) -> tuple[Segment, Segment]:
    """A segment cut in two pieces of the same cone, the front one with a share of its length."""
    outer = segment.tip_diameter + (segment.butt_diameter - segment.tip_diameter) * share
    bore = segment.tip_bore + (segment.butt_bore - segment.tip_bore) * share
    front = replace(segment, length=segment.length * share, butt_diameter=outer, butt_bore=bore)
    return front, replace(segment, length=segment.length - front.length, tip_diameter=outer, tip_bore=bore)


def _bored_width(scene: Any) -> float | None:
    return next((s.tip_bore for s in scene.shaft.segments if s.core is None and s.tip_bore > 0), None)


def _with_bored_width(scene: Any, value: float) -> Any:
    f = value / (_bored_width(scene) or value)
    segments = (
        replace(s, tip_bore=f * s.tip_bore, butt_bore=f * s.butt_bore) if s.core is None and s.tip_bore > 0 else s
        for s in scene.shaft.segments
    )
    return with_segments(scene, tuple(segments))


BORED_WIDTH = Part(_bored_width, _with_bored_width, DIAMETER)

# --- what acts on the cue, and the tip ----------------------------------------------------


def _bridge(scene: Any) -> Support:
    """The scene's first soft support across the cue; without one, a hand that does not hold it, 8 in behind the tip."""
    own = (e for e in scene.effects if isinstance(e, Support) and math.isfinite(e.stiffness))
    return next(own, Support(min(BRIDGE_AT, 0.5 * scene.shaft.length), 0.0))


def _joint(scene: Any) -> Joint:
    """The scene's first joint; without one, a stiff one at the back end of the shaft's material or inside the cue."""
    own = next((effect for effect in scene.effects if isinstance(effect, Joint)), None)
    if own is not None:
        return own
    cue: Cue = scene.shaft
    back = float(cue.nodes[Layout.of(cue).shaft.stop])
    return Joint(back if back < 0.99 * cue.length else 0.9 * cue.length)


def _leather(scene: Any) -> LeatherTip | None:
    return next((effect for effect in scene.effects if isinstance(effect, LeatherTip)), None)


def _waves(scene: Any) -> AxialWaves | None:
    """The waves that see the rest of the cue as a rod."""
    own = next((effect for effect in scene.effects if isinstance(effect, AxialWaves)), None)
    return own if own is not None and own.with_butt(scene.shaft) is not scene.shaft else None


def _exchanged(read: Callable[[Any], Effect | None], acts: Callable[[Any], bool]) -> Callable[[Any, Any], Any]:
    """Exchange the effect that ``read`` tells for another one, which is added where it was not listed and acts."""

    def write(scene: Any, new: Effect) -> Any:
        old = read(scene)
        if old in scene.effects:
            return replace(scene, effects=tuple(new if effect == old else effect for effect in scene.effects))
        return replace(scene, effects=(*scene.effects, new)) if acts(new) else scene

    return write


# In the order in which they are written: the weight first, that of the shaft before other changes; materials last,
# because the ferrule and the shaft are told by theirs.
PARTS: dict[str, Part] = {
    "weight": Part(lambda scene: Weight(scene.shaft.shaft_mass + _tip_mass(scene)), _with_weight),
    "ferrule": Part(_ferrule, _with_ferrule, keeps=("drilling",)),
    "diameters": Part(_diameters, _with_diameters),
    "drilling": Part(_bore, _with_bore),
    "joint": Part(_joint, _exchanged(_joint, lambda joint: joint.rotational_compliance > 0)),
    "bridge": Part(_bridge, _exchanged(_bridge, lambda bridge: bridge.stiffness > 0)),
    "leather": Part(_leather, _exchanged(_leather, lambda leather: True)),
    "waves": Part(_waves, _exchanged(_waves, lambda waves: True)),
    "woods": Part(_woods, _with_woods),
    "materials": Part(
        lambda scene: materials_in(scene.shaft),
        lambda scene, new: replace(
            scene, cue=_with_materials(scene.shaft, dict(zip(materials_in(scene.shaft), new, strict=True)))
        ),
    ),
    "wood": Part(
        lambda scene: main_material(scene.shaft),
        lambda scene, new: replace(scene, cue=with_material(scene.shaft, main_material(scene.shaft), new)),
    ),
}
