"""Parts of a cue that are identified from its drawing, and how to read and replace each.

- Leather is the soft material at the tip. The ferrule is the segment behind it, if that is short and its material
  differs from that of the next segment. The shaft follows, up to the next change of material.
- A change of diameter at a position decreases linearly to zero at both ends of the drawing; a change at an end, to
  `taper_position`. Every segment remains a cone.
- A longer ferrule replaces wood behind it and ends flush with that wood. The lengths of cue and bore and the cone of
  the shaft do not change.
- The bore is the first hollow, tenons excepted, that begins in front of `taper_position`: at the front, behind a
  ferrule on a tenon or behind a plug. Its depth is measured from where it begins. A filled bore cannot be varied. A new
  or deeper bore leaves wider ones on its way as they are.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from cuefem.cue import MAX_LEATHER_MODULUS, POSITION_TOLERANCE, Cue, Material, Segment
from cuefem.cue.materials import MATERIALS, table_name
from cuefem.quantity.display_units import short_number, span_text, with_unit
from cuefem.quantity.fields import CONTACT_TIME, DIAMETER, LENGTH, Quantity

MAX_FERRULE = 0.06  # m
TAPER_AT = 0.3302  # m, 13 in: so far pool shafts stay nearly straight; half the length of a cue shorter than twice that
DEFAULT_BORE = 0.006  # m, the width of a new bore, where the front is wide enough
MIN_DENSITY, MAX_DENSITY = 20.0, 23_000.0  # kg/m3, foam and platinum: of a material that a weight determines


class Part(NamedTuple):
    """A part of a scene, identified from its drawing or its effects.

    read: its value in a scene: an effect, a material or, with its ``quantity``, a number; None if it is absent.
    write: the scene with another value. unchanged: parameters that a change of it must not change.
    """

    read: Callable[[Any], Any]
    write: Callable[[Any, Any], Any]
    quantity: Quantity | None = None
    unchanged: tuple[str, ...] = ()

    def number(self, scene: Any) -> Quantity | None:
        """Unit and bounds of its number; None if it is no number or the scene has none."""
        return self.quantity if self.quantity and self.read(scene) is not None else None


class Layout(NamedTuple):
    """Segment indices of a cue's parts, and the material that fills its bore.

    ferrule: empty without one. bore: empty without one, None if it is filled.
    """

    ferrule: range
    shaft: range
    bore: range | None
    filling: Material | None

    @classmethod
    def of(cls, cue: Cue) -> Layout:
        """The layout of a drawing."""
        segments = cue.segments
        last = len(segments) - 1
        front = next((i for i, s in enumerate(segments) if s.material.E >= MAX_LEATHER_MODULUS), last)
        first = _next_material(segments, front)
        if first > last or cue.nodes[first] - cue.nodes[front] > MAX_FERRULE * (1 + POSITION_TOLERANCE):
            first = front
        shaft = range(first, _next_material(segments, first))
        mouth = _mouth(cue, front, first)
        closed = next((i for i in range(mouth, len(segments)) if not _is_bored(segments[i])), len(segments))
        filling = segments[mouth].core
        return cls(range(front, first), shaft, None if filling else range(mouth, closed), filling)


def _mouth(cue: Cue, front: int, first: int) -> int:
    """Index of the segment with which the bore begins; without a bore, of the first one behind the ferrule."""
    for i in range(front, len(cue.segments)):
        if cue.nodes[i] > taper_position(cue) * (1 + POSITION_TOLERANCE):
            break
        is_tenon = i < first and cue.segments[i].core is not None
        if _width(cue.segments[i]) > 0 and not is_tenon:
            return i
    return first


def _next_material(segments: Sequence[Segment], first: int) -> int:
    """Index of the next segment of another material."""
    same = segments[first].material
    return next((i for i in range(first, len(segments)) if segments[i].material != same), len(segments))


def _is_bored(segment: Segment) -> bool:
    return segment.core is None and _width(segment) > 0


def _width(segment: Segment) -> float:
    return max(segment.tip_bore, segment.butt_bore)


def taper_position(cue: Cue) -> float:
    """Position of the taper diameter, m from the tip."""
    return TAPER_AT if cue.length >= 2 * TAPER_AT else cue.length / 2


def bore_mouth(cue: Cue) -> float:
    """Where the bore begins, m from the tip."""
    bore = Layout.of(cue).bore
    return 0.0 if bore is None else float(cue.nodes[bore.start])


def max_bore_depth(cue: Cue) -> float:
    """Maximum depth of the bore, m from its mouth: up to a filled bore, or the end of the cue."""
    bore = Layout.of(cue).bore
    if bore is None:
        return 0.0
    filled = (i for i in range(bore.start, len(cue.segments)) if cue.segments[i].core is not None)
    return float(cue.nodes[next(filled, len(cue.segments))] - cue.nodes[bore.start])


def outer_diameter(cue: Cue, x: float) -> float:
    """Outer diameter at x m from the tip; at a jump that of the butt side."""
    i = min(int(np.searchsorted(cue.nodes, x, side="right")) - 1, len(cue.segments) - 1)
    segment = cue.segments[i]
    t = 1.0 if x == cue.length else (x - cue.nodes[i]) / segment.length
    return float(segment.tip_diameter + (segment.butt_diameter - segment.tip_diameter) * t)


def with_segments(scene: Any, segments: Sequence[Segment]) -> Any:
    """The scene with other segments in its cue."""
    return replace(scene, cue=replace(scene.shaft, segments=tuple(segments)))


def with_material(cue: Cue, old: Material, new: Material) -> Cue:
    """The cue with a material replaced in all segments and cores."""
    pieces = (
        replace(s, material=new if s.material == old else s.material, core=new if s.core == old else s.core)
        for s in cue.segments
    )
    return replace(cue, segments=tuple(pieces))


def main_material(cue: Cue) -> Material:
    """The material that fills most of the cue's length."""
    lengths: dict[Material, float] = {}
    for s in cue.segments:
        lengths[s.material] = lengths.get(s.material, 0.0) + s.length
    return max(lengths, key=lambda material: lengths[material])


def is_wood_of(tabulated: Material, weighed: Material) -> bool:
    """Whether a material is the one of the table of which a weighed one has another density."""
    name = table_name(weighed)
    return name is not None and MATERIALS[name].material == tabulated


# --- the mass ------------------------------------------------------------------------------


def with_shaft_mass(cue: Cue, mass: float) -> Cue:
    """The cue with the density of its main material for which its segments weigh ``mass``, kg.

    ValueError if that density is out of bounds.
    """
    wood = main_material(cue)
    half = with_material(cue, wood, replace(wood, rho=wood.rho / 2)).shaft_mass
    volume = (cue.shaft_mass - half) / (wood.rho / 2)  # m3 of that material
    others = cue.shaft_mass - volume * wood.rho
    rho = (mass - others) / volume
    if not MIN_DENSITY <= rho <= MAX_DENSITY:
        least, most = (others + volume * end for end in (MIN_DENSITY, MAX_DENSITY))
        raise ValueError(
            f"must be {span_text(least, most, 'kg')} (density of its main material {MIN_DENSITY:g} to "
            f"{MAX_DENSITY:g} kg/m3); got {with_unit(mass, 'kg')}"
        )
    return replace(with_material(cue, wood, replace(wood, rho=rho)), shaft_mass_measured=True)


def _tip_mass(scene: Any) -> float:
    """The mass of a leather tip in front of the drawing, kg."""
    leather = _leather(scene)
    return 0.0 if leather is None else float(leather.mass_on(scene.shaft))


WEIGHT = Part(
    lambda scene: scene.shaft.shaft_mass + _tip_mass(scene),
    lambda scene, mass: replace(scene, cue=with_shaft_mass(scene.shaft, mass - _tip_mass(scene))),
    Quantity("kg", "(0, 100]"),
)


def _with_body_mass(scene: Any, mass: float) -> Any:
    return replace(scene, cue=replace(scene.shaft, body_mass=mass, assumed_body_mass=0.0))


BODY_MASS = Part(lambda scene: scene.shaft.body_mass, _with_body_mass, Quantity("kg", "[0, inf)"))

# --- the ferrule, and the materials of ferrule and shaft ----------------------------------


def _ferrule_length(scene: Any) -> float | None:
    ferrule = Layout.of(scene.shaft).ferrule
    return float(np.ptp(scene.shaft.nodes[[ferrule.start, ferrule.stop]])) if ferrule else None


def _with_ferrule_length(scene: Any, length: float) -> Any:
    segments, old, at = list(scene.shaft.segments), _ferrule_length(scene), Layout.of(scene.shaft).ferrule.stop
    if old is None or length == old:
        return scene
    ferrule, wood = segments[at - 1], segments[at]
    gain = length - old
    if not -ferrule.length < gain < wood.length:
        least, most = short_number(old - ferrule.length, "m", 6), with_unit(old + wood.length, "m", 6)
        raise ValueError(
            f"the ferrule must be more than {least} and less than {most} long, as its neighbours allow; "
            f"got {with_unit(length, 'm', 6)}"
        )
    shift = -gain / wood.length  # along the unchanged cone behind the ferrule
    outer = wood.tip_diameter + (wood.tip_diameter - wood.butt_diameter) * shift
    bore = max(0.0, wood.tip_bore + (wood.tip_bore - wood.butt_bore) * shift)
    flush = ferrule.butt_diameter + outer - wood.tip_diameter
    segments[at - 1] = replace(ferrule, length=ferrule.length + gain, butt_diameter=flush)
    segments[at] = replace(wood, length=wood.length - gain, tip_diameter=outer, tip_bore=bore)
    return with_segments(scene, segments)


FERRULE_LENGTH = Part(_ferrule_length, _with_ferrule_length, LENGTH, ("bore depth", "bore width"))


def _material_of(part: str) -> Callable[[Any], Material | None]:
    def read(scene: Any) -> Material | None:
        pieces: range = getattr(Layout.of(scene.shaft), part)
        return scene.shaft.segments[pieces.start].material if pieces else None

    return read


def _with_ferrule_material(scene: Any, new: Material) -> Any:
    ferrule = Layout.of(scene.shaft).ferrule
    segments = scene.shaft.segments
    return with_segments(scene, [replace(s, material=new) if i in ferrule else s for i, s in enumerate(segments)])


def _with_shaft_material(scene: Any, new: Material) -> Any:
    """Set the shaft's material; a tenon of its wood changes with it. A weighed density is kept with its own wood."""
    layout, segments = Layout.of(scene.shaft), list(scene.shaft.segments)
    old = segments[layout.shaft.start].material
    if new == old or (scene.shaft.shaft_mass_measured and is_wood_of(new, old)):
        return scene
    for i in layout.shaft:
        segments[i] = replace(segments[i], material=new)
    for i in layout.ferrule:
        segments[i] = replace(segments[i], core=new if segments[i].core == old else segments[i].core)
    return replace(scene, cue=replace(scene.shaft, segments=tuple(segments), shaft_mass_measured=False))


FERRULE_MATERIAL = Part(_material_of("ferrule"), _with_ferrule_material)
SHAFT_MATERIAL = Part(_material_of("shaft"), _with_shaft_material)

# --- the taper -------------------------------------------------------------------------------------


def _with_gains(scene: Any, positions: Sequence[float], gains: Sequence[float]) -> Any:
    """The scene with diameters that are larger by ``gains`` at the cue's ends and one position between them."""
    cue, (_, middle, end) = scene.shaft, positions
    if abs(gains[1] - np.interp(middle, [0, end], [gains[0], gains[2]])) > POSITION_TOLERANCE * end:
        cue = split_at(cue, middle)

    def widen(segment: Segment, start: float) -> Segment:
        first, last = np.interp([start, start + segment.length], positions, gains)
        ends = segment.tip_diameter + float(first), segment.butt_diameter + float(last)
        if min(ends) <= 0:
            raise ValueError(
                f"the cue's diameter must be more than {with_unit(0.0, 'm')}; got {with_unit(min(ends), 'm')}"
            )
        return replace(segment, tip_diameter=ends[0], butt_diameter=ends[1])

    return with_segments(scene, [widen(segment, float(x)) for segment, x in zip(cue.segments, cue.nodes, strict=False)])


def diameter_at(position: Callable[[Cue], float]) -> Part:
    """The outer diameter at a position, m from the tip; a change decreases linearly towards the ends."""

    def read(scene: Any) -> float | None:
        x = position(scene.shaft)
        return outer_diameter(scene.shaft, x) if 0 <= x <= scene.shaft.length else None

    def write(scene: Any, value: float) -> Any:
        cue, x = scene.shaft, position(scene.shaft)
        more = value - outer_diameter(cue, x)
        knots = [0.0, x if 0 < x < cue.length else taper_position(cue), cue.length]
        return _with_gains(scene, knots, [more if knot == x else 0.0 for knot in knots]) if more else scene

    return Part(read, write, DIAMETER)


def _growth(scene: Any) -> float | None:
    first, last = scene.shaft.segments[0], scene.shaft.segments[-1]
    return last.butt_diameter - first.tip_diameter if last.butt_diameter > first.tip_diameter else None


def _with_growth(scene: Any, value: float) -> Any:
    segments, d0, f = scene.shaft.segments, scene.shaft.segments[0].tip_diameter, value / (_growth(scene) or value)
    scaled = (
        replace(s, tip_diameter=d0 + f * (s.tip_diameter - d0), butt_diameter=d0 + f * (s.butt_diameter - d0))
        for s in segments
    )
    return with_segments(scene, tuple(scaled))


GROWTH = Part(_growth, _with_growth, DIAMETER)

# --- the bore -------------------------------------------------------------------------------------


def _bore(scene: Any) -> tuple[float, float] | None:
    """Depth from its mouth and width, m; without a bore, 0 and the width of a new one."""
    cue, bore = scene.shaft, Layout.of(scene.shaft).bore
    if bore is None:
        return None
    new = min(DEFAULT_BORE, 0.9 * outer_diameter(cue, bore_mouth(cue)))
    return float(cue.nodes[bore.stop] - cue.nodes[bore.start]), _width(cue.segments[bore.start]) if bore else new


def _with_bore(scene: Any, depth: float | None = None, width: float | None = None) -> Any:
    """The scene with another depth or width of the bore; a deeper one continues with the width at its end."""
    cue, old = scene.shaft, _bore(scene)
    if old is None or (depth in (None, old[0]) and width in (None, old[1])):
        return scene
    depth, new_width = old[0] if depth is None else depth, old[1] if width is None else width
    bore, deepest, tolerance = Layout.of(cue).bore or range(0), max_bore_depth(cue), POSITION_TOLERANCE * cue.length
    mouth = bore_mouth(cue)
    old_end = mouth + old[0]
    if depth > deepest + tolerance:
        raise ValueError(f"the bore must be at most {with_unit(deepest, 'm', 6)} deep; got {with_unit(depth, 'm', 6)}")
    wider = new_width / old[1]
    new_bore = wider * cue.segments[bore.stop - 1].butt_bore if bore else new_width
    end = mouth + min(depth, deepest)

    def drill(segment: Segment, start: float) -> Segment:
        before, after = (mouth - tolerance <= start < stop - tolerance for stop in (old_end, end))
        if not (before or after):
            return segment
        widened = (wider * segment.tip_bore, wider * segment.butt_bore)
        deeper = (max(new_bore, segment.tip_bore), max(new_bore, segment.butt_bore))  # another bore may be there
        ends = (0.0, 0.0) if not after else widened if before else deeper
        outside = ((segment.tip_diameter, start), (segment.butt_diameter, start + segment.length))
        for inner, (outer, x) in zip(ends, outside, strict=True):
            if inner >= outer:
                where = f"the cue, {with_unit(outer, 'm')} wide at {with_unit(x, 'm')} from the tip"
                raise ValueError(f"the bore must be narrower than {where}; got {with_unit(inner, 'm')}")
        return replace(segment, tip_bore=ends[0], butt_bore=ends[1])

    cue = split_at(cue, end)
    return with_segments(scene, [drill(piece, float(x)) for piece, x in zip(cue.segments, cue.nodes, strict=False)])


def split_at(cue: Cue, x: float) -> Cue:
    """The same cue with a segment's end at x m from the tip."""
    if np.abs(cue.nodes - x).min() <= POSITION_TOLERANCE * cue.length or not 0 < x < cue.length:
        return cue
    i = int(np.searchsorted(cue.nodes, x)) - 1
    front, back = split_segment(cue.segments[i], float(x - cue.nodes[i]) / cue.segments[i].length)
    return replace(cue, segments=(*cue.segments[:i], front, back, *cue.segments[i + 1 :]))


def split_segment(segment: Segment, share: float) -> tuple[Segment, Segment]:
    """A segment cut in two pieces of the same cone, the front one with a share of its length."""
    outer = segment.tip_diameter + (segment.butt_diameter - segment.tip_diameter) * share
    bore = segment.tip_bore + (segment.butt_bore - segment.tip_bore) * share
    front = replace(segment, length=segment.length * share, butt_diameter=outer, butt_bore=bore)
    return front, replace(segment, length=segment.length - front.length, tip_diameter=outer, tip_bore=bore)


def _of_bore(which: int) -> Callable[[Any], float | None]:
    def read(scene: Any) -> float | None:
        bore = _bore(scene)
        return None if bore is None else bore[which]

    return read


BORE_DEPTH = Part(_of_bore(0), lambda scene, depth: _with_bore(scene, depth=depth), Quantity("m", "[0, 1000]"))
BORE_WIDTH = Part(_of_bore(1), lambda scene, width: _with_bore(scene, width=width), DIAMETER)

# --- the tube -------------------------------------------------------------------------------------

TUBE_FRONT = 0.15  # m from the front: the part of a tube whose mass squirt senses most
MAX_WOOD_MODULUS = 25e9  # Pa: woods of the table of materials reach 22.3 GPa, carbon fibre begins at 29.6 GPa


def is_wooden(cue: Cue) -> bool:
    """Whether the shaft behind its ferrule is no stiffer than wood."""
    return cue.segments[Layout.of(cue).shaft.start].material.E <= MAX_WOOD_MODULUS


def is_tube(cue: Cue) -> bool:
    """Whether the shaft is hollow along most of its length, empty or filled, and no bored wood."""
    hollow = sum(cue.segments[i].length for i in _hollow(cue))
    return not is_wooden(cue) and hollow > sum(cue.segments[i].length for i in Layout.of(cue).shaft) / 2


def shaft_word(scene: Any) -> str:
    """What the shaft of a scene is called in a sentence on its material: "tube" or "wood"."""
    return "tube" if scene.lumped is None and is_tube(scene.shaft) else "wood"


def _hollow(cue: Cue) -> list[int]:
    """Indices of the hollow segments of the shaft, empty or filled."""
    return [i for i in Layout.of(cue).shaft if _width(cue.segments[i]) > 0]


def _front_hollow(cue: Cue) -> list[int]:
    """Indices of the hollow segments that follow one another from the front of the shaft, up to a solid one."""
    hollow = _hollow(cue)
    return [i for place, i in enumerate(hollow) if i == hollow[0] + place]


def _tube_front(cue: Cue) -> list[int]:
    """Indices of the hollow segments of a tube that begin within `TUBE_FRONT`; none of another shaft."""
    if not is_tube(cue):
        return []
    return [i for i in _hollow(cue) if cue.nodes[i] < TUBE_FRONT - POSITION_TOLERANCE * cue.length]


def _wall(scene: Any) -> float | None:
    """Wall of a tube at its front end, m."""
    front = _tube_front(scene.shaft)
    if not front:
        return None
    segment = scene.shaft.segments[front[0]]
    return (segment.tip_diameter - segment.tip_bore) / 2


def _with_wall(scene: Any, wall: float) -> Any:
    """The scene with a wall that is thicker or thinner by the same amount along the front of its tube."""
    old = _wall(scene)
    if old is None or wall == old:
        return scene
    cue = split_at(scene.shaft, TUBE_FRONT)
    front, narrower = _tube_front(cue), 2 * (wall - old)
    segments = list(cue.segments)
    for i in front:
        bores = segments[i].tip_bore - narrower, segments[i].butt_bore - narrower
        outer = segments[i].tip_diameter, segments[i].butt_diameter
        if min(bores) <= 0 or outer[0] <= bores[0] or outer[1] <= bores[1]:
            radius = with_unit(segments[i].tip_diameter / 2, "m")
            raise ValueError(
                f"the wall must be above 0 and leave a hollow in a tube of radius {radius}; got {with_unit(wall, 'm')}"
            )
        segments[i] = replace(segments[i], tip_bore=bores[0], butt_bore=bores[1])
    return replace(scene, cue=replace(cue, segments=tuple(segments)))


FRONT_WALL = Part(_wall, _with_wall, DIAMETER)


def _front_core(core: Material | None) -> Callable[[Any], float | None]:
    """A function that reads the length of the leading part of a tube with a core, m; None for another shaft."""

    def read(scene: Any) -> float | None:
        cue = scene.shaft
        if not is_tube(cue):
            return None
        hollow = _front_hollow(cue)
        end = next((i for i in hollow if cue.segments[i].core != core), hollow[-1] + 1)
        return float(cue.nodes[end] - cue.nodes[hollow[0]])

    return read


def _with_front_core(read: Callable[[Any], float | None], core: Material | None) -> Callable[[Any, float], Any]:
    """A function that writes the length of that part; a shorter one is filled as the tube behind it."""

    def write(scene: Any, length: float) -> Any:
        old = read(scene)
        if old is None or length == old:
            return scene
        cue = scene.shaft
        tube = _front_hollow(cue)
        begin, end = (float(cue.nodes[i]) for i in (tube[0], tube[-1] + 1))
        whole = end - begin
        longest = with_unit(whole, "m", 6)
        if length > whole:
            raise ValueError(f"the tube is {longest} long; got {with_unit(length, 'm', 6)}")
        if old > whole - POSITION_TOLERANCE * cue.length:
            inside = "empty" if core is None else "filled like that"
            raise ValueError(
                f"the tube is {inside} along all its {longest}, so that nothing is known to fill the rest with; got "
                f"{with_unit(length, 'm', 6)}: state the core of its segments"
            )
        behind = next((i for i in tube if cue.nodes[i] >= begin + old - POSITION_TOLERANCE * cue.length), tube[-1])
        filling = cue.segments[behind].core
        cue = split_at(split_at(cue, begin + length), begin + old)
        tolerance = POSITION_TOLERANCE * cue.length
        segments = [
            replace(piece, core=core if x < begin + length - tolerance else filling)
            if begin - tolerance <= x < begin + max(length, old) - tolerance
            else piece
            for piece, x in zip(cue.segments, cue.nodes, strict=False)
        ]
        return with_segments(replace(scene, cue=cue), segments)

    return write


INSERT = MATERIALS["hard maple"].material


def _length_with_core(core: Material | None) -> Part:
    """The part whose value is the length of the leading part of a tube with a core, or without any."""
    read = _front_core(core)
    return Part(read, _with_front_core(read, core), Quantity("m", "[0, 1000]"))


EMPTY_DEPTH, INSERT_DEPTH = _length_with_core(None), _length_with_core(INSERT)

# --- the tip, and whole materials ------------------------------------------------------------


def _leather(scene: Any) -> Any:
    """The `LeatherTip` effect, or None."""
    return next((effect for effect in scene.effects if effect.defines_tip), None)


def _waves(scene: Any) -> Any:
    """The effect that models the rest of the cue as a rod, or None."""
    rods = (effect for effect in scene.effects if getattr(effect, "wave_speed", None) is not None)
    return next((effect for effect in rods if effect.with_butt(scene.shaft) is not scene.shaft), None)


def _effect(read: Callable[[Any], Any]) -> Part:
    """The part whose value is the effect ``read`` from a scene."""

    def write(scene: Any, new: Any) -> Any:
        old = read(scene)
        return replace(scene, effects=tuple(new if effect == old else effect for effect in scene.effects))

    return Part(read, write)


def _spring_time(scene: Any) -> float | None:
    return None if _leather(scene) is not None else float(scene.contact_time)


def _with_spring_time(scene: Any, time: float) -> Any:
    return replace(scene, tip=replace(scene.tip, contact_time=time, stiffness=None))


CONTACT_TIME_OF_SPRING = Part(_spring_time, _with_spring_time, CONTACT_TIME)


# Heads of paths, in addition to the fields of a scene.
PARTS: dict[str, Part] = {
    "leather": _effect(_leather),
    "ferrule": FERRULE_MATERIAL,
    "waves": _effect(_waves),
    "wood": Part(
        lambda scene: main_material(scene.shaft),
        lambda scene, new: replace(scene, cue=with_material(scene.shaft, main_material(scene.shaft), new)),
    ),
}
