"""The changes that a shop can make to a shaft, in its sizes, and the limits that its maker sets."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

from cuefem.cue import Cue
from cuefem.cue.materials import MATERIALS, table_name
from cuefem.effects.leather_tip import DOMES
from cuefem.parameters.parts import TUBE_FRONT, Layout, is_tube, is_wooden, max_bore_depth, taper_position
from cuefem.parameters.table import PARAMETERS
from cuefem.quantity.display_units import DISTANCE, displayed_system, inch_fraction, short_number, with_unit
from cuefem.results.records import Record
from cuefem.scene import Scene

MM, INCH = 1e-3, 0.0254


class ShopSizes(NamedTuple):
    """The sizes of a shop, m: drills come in steps, a new bore has a usual width and depth.

    wider, deeper, shorter, lower, thinner: by how much one change alters bore, ferrule, tip and front.
    """

    drill_step: float
    new_bore: float
    new_depth: float
    wider: float
    deeper: float
    shorter: float
    thinner: float


SHOP = {
    "metric": ShopSizes(0.5 * MM, 6 * MM, 127 * MM, 1 * MM, 25 * MM, 5 * MM, 0.5 * MM),
    "us": ShopSizes(INCH / 64, INCH / 4, 5 * INCH, 3 / 64 * INCH, 1 * INCH, INCH / 4, 0.020 * INCH),
}
LOWER = 1 * MM  # of a tip's height
MIN_WOOD_WALL = 2.5 * MM  # of a bore in wood, 0.100 in: our judgement, no maker was asked
MIN_TUBE_WALL = 0.8 * MM  # the thinnest of carbon tubes (meshes/README.md); a thinner wall splits
MIN_LIMIT = 0.2 * MM  # a smaller least wall is a slip
MIN_FERRULE = 5 * MM  # length after the change
MIN_TIP = 2 * MM  # height after the change
WALL_STEP = 0.2 * MM  # two plies of prepreg, 0.1 mm each
EMPTY_FRONT, NEW_INSERT = 150 * MM, 25 * MM
CARBON_WALL = 1.5 * MM  # the middle of meshes/carbon.toml
PRO_GAIN = 0.5 * MM  # from the tip to the taper's position, as in meshes/pool_maple.toml
FERRULES = ("abs", "melamine", "phenolic")  # sold for cues; brass and steel are not suggested
SHAFT_WOODS = ("hard maple", "ash", "yellow birch", "purpleheart", "rosewood")
MIN_STIFFNESS_LOSS = 0.05  # perceptible relative loss of stiffness
WOOD = ("E", "G", "rho")
PARTS = ("bore", "ferrule", "tip", "taper", "wood")  # of a shaft that a maker may keep as they are
DRILLS = 4  # widths of a bore that are tried
DEEPEST, LONGEST_FERRULE, MOST_CUT, THICKEST_WALL = 250 * MM, 40 * MM, 2 * MM, 3 * MM


@dataclass(frozen=True)
class Limits:
    """What a maker does not accept of a design change.

    Parameters
    ----------
    wall : float, optional
        Least wall of a bore or a tube, m, at least 0.2 mm; by default 2.5 mm of wood and 0.8 mm of carbon, or the
        shaft's own where that is thinner.
    keep : collection of str
        Parts that stay as they are: "bore", "ferrule", "tip", "taper", "wood".
    stiffness_loss : float, default 0.05
        Largest relative loss of stiffness at the tip of several changes together, in [0, 1).

    Raises
    ------
    ValueError
        For a wall below 0.2 mm, an unknown part, a loss out of bounds, or if every part is kept.

    Examples
    --------
    >>> import cuefem as cf
    >>> cf.Limits(wall=0.0025, keep=("tip", "wood")).keep
    ('tip', 'wood')
    """

    wall: float | None = None
    keep: Collection[str] = ()
    stiffness_loss: float = MIN_STIFFNESS_LOSS

    def __post_init__(self) -> None:
        if self.wall is not None and not MIN_LIMIT <= self.wall < math.inf:
            raise ValueError(f"wall must be at least {with_unit(MIN_LIMIT, 'm')}; got {with_unit(self.wall, 'm')}")
        for part in self.keep:
            if part not in PARTS:
                raise ValueError(f"keep must name some of {', '.join(PARTS)}; got {part!r}")
        if {*self.keep} >= {*PARTS}:
            raise ValueError("keep names every part, so that nothing may change; leave one out")
        if not 0 <= self.stiffness_loss < 1:
            raise ValueError(f"stiffness_loss must be in [0, 1); got {self.stiffness_loss:g}")

    def least_wall(self, scene: Scene) -> float:
        """The least wall of a scene's shaft, m."""
        if self.wall is not None:
            return self.wall
        return MIN_TUBE_WALL if is_tube(scene.shaft) else MIN_WOOD_WALL


class DesignChange(NamedTuple):
    """A change: its label, and the values that it sets, SI or names of materials, by parameter.

    resets: uncertain parameters whose value it replaces, so that the error of the new one is independent. part: of
    `PARTS`. is_new_shaft: whether it needs another piece of wood, so that it is none of several changes together.
    """

    label: str
    values: dict[str, Any]
    resets: tuple[str, ...] = ()
    part: str = "taper"
    is_new_shaft: bool = False


class Dimension(NamedTuple):
    """A dimension that a shop chooses: the change for each size between that of the shaft and the farthest one, m.

    step: to which a shop holds it; each size is a multiple of it from the first one.
    """

    change: Callable[[float], DesignChange]
    first: float
    last: float
    step: float

    @property
    def steps(self) -> int:
        """The number of sizes after the first one."""
        return round(abs(self.last - self.first) / self.step)

    def size(self, k: int) -> float:
        """The k-th size, m."""
        return self.first + math.copysign(k * self.step, self.last - self.first)


def dimensions_of(scene: Scene) -> list[Dimension]:
    """The dimensions of this cue that a shop can choose, each in both directions; walls and stiffness bound them."""
    cue, values = scene.shaft, {key: parameter.value(scene) for key, parameter in PARAMETERS.items()}
    wall, insert, ferrule = (values[key] for key in ("front_wall", "insert_depth", "ferrule_length"))
    ferrules = _sizes(partial(_ferrule_length, ferrule), ferrule, (MIN_FERRULE, LONGEST_FERRULE), 0.1 * MM)
    if is_tube(cue):
        walls = _sizes(partial(_wall, wall), wall, (MIN_TUBE_WALL, THICKEST_WALL), 0.01 * MM)
        return [*walls, *_sizes(_insert, insert, (EMPTY_FRONT, 0.0), MM), *ferrules]
    fronts = _sizes(partial(_cut, cue, values), 0.0, (MOST_CUT, -MOST_CUT), 0.01 * MM) if is_wooden(cue) else []
    return [*_bore_sizes(cue, values), *ferrules, *fronts]


def _sizes(
    change: Callable[[float], DesignChange], first: float | None, lasts: Iterable[float], step: float
) -> list[Dimension]:
    """A dimension from its size in both directions; none of a part that the shaft does not have."""
    return [] if first is None else [Dimension(change, first, last, step) for last in lasts]


def _bore_sizes(cue: Cue, values: Record) -> list[Dimension]:
    """The depth of a bore of the shaft's own width, and of some wider drills."""
    depth, shop = values["bore_depth"], SHOP[displayed_system()]
    if depth is None:
        return []
    is_bored = depth > 0
    own = values["bore_width"] if is_bored else shop.new_bore
    deepest = min(DEEPEST, max_bore_depth(cue))
    depths = _sizes(partial(_bore_depth, depth), depth, (max(depth, deepest), 0.0), MM) if is_bored else []
    next_drill = 1 if is_bored else 0
    widths = [shop.drill_step * round(own / shop.drill_step + next_drill + k) for k in range(DRILLS)]
    return [*depths, *(Dimension(partial(_bore, width), max(depth, MM), deepest, MM) for width in widths)]


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
    for new in (wall - WALL_STEP, wall + WALL_STEP):
        yield _wall(wall, new)


def _wall(wall: float, new: float) -> DesignChange:
    name, where = "thinner" if new < wall else "thicker", f"over the first {with_unit(TUBE_FRONT, 'm')}"
    label = f"wall {name}, {_from_to(wall, new)} {where}"
    return DesignChange(label, {"front wall": new}, part="wood", is_new_shaft=True)


def _fillings(values: Record) -> Iterator[DesignChange]:
    """Nothing inside the front of the tube, or a maple insert."""
    empty, insert = values["empty_depth"], values["insert_depth"]
    if empty == insert == 0:
        label = f"no filling in the first {with_unit(EMPTY_FRONT, 'm')} of the tube"
        yield DesignChange(label, {"empty depth": EMPTY_FRONT}, part="bore")
    if insert is not None:
        yield _insert(0.0 if insert else NEW_INSERT)


def _insert(length: float) -> DesignChange:
    label = f"maple insert, {with_unit(length, 'm')} long, in front" if length else "no insert in front"
    return DesignChange(label, {"insert depth": length}, part="bore")


def _bores(cue: Cue, values: Record) -> Iterator[DesignChange]:
    depth, width, shop = values["bore_depth"], values["bore_width"], SHOP[displayed_system()]
    if depth is None:
        return
    if depth <= 0:
        yield _bore(shop.new_bore, shop.new_depth)
        return
    bored = [cue.segments[i] for i in Layout.of(cue).bore or ()]
    is_cylinder = all(s.tip_bore == s.butt_bore == width for s in bored)
    at_mouth = "" if is_cylinder else " at its mouth"
    wider = shop.drill_step * round((width + shop.wider) / shop.drill_step)
    label = f"bore wider, {short_number(width, 'm')} → {drill_text(wider)}{at_mouth}"
    yield DesignChange(label, {"bore width": wider}, part="bore")
    yield _bore_depth(depth, depth + shop.deeper)


def _bore(width: float, depth: float) -> DesignChange:
    label = f"bore, {drill_text(width)} wide and {with_unit(depth, 'm')} deep"
    return DesignChange(label, {"bore depth": depth, "bore width": width}, part="bore")


def _bore_depth(depth: float, new: float) -> DesignChange:
    is_deeper = new > depth  # a shallower one is drilled into another shaft
    label = f"bore {'deeper' if is_deeper else 'shallower'}, {_from_to(depth, new)}"
    return DesignChange(label, {"bore depth": new}, part="bore", is_new_shaft=not is_deeper)


def drill_text(width: float) -> str:
    """The width of a drill: "6.5 mm", or a fraction of an inch in US units, "17/64 in"."""
    return f"{inch_fraction(width)} in" if displayed_system() == "us" else with_unit(width, "m")


def _ferrules(values: Record) -> Iterator[DesignChange]:
    length, material = values["ferrule_length"], values["ferrule_material"]
    if length is None:
        return
    shorter = length - SHOP[displayed_system()].shorter
    if shorter >= MIN_FERRULE:
        yield _ferrule_length(length, shorter)
    yield from ferrule_materials(material)


def _ferrule_length(length: float, new: float) -> DesignChange:
    label = f"ferrule {'shorter' if new < length else 'longer'}, {_from_to(length, new)}"
    return DesignChange(label, {"ferrule length": new}, part="ferrule")


def ferrule_materials(material: Any) -> Iterator[DesignChange]:
    """Ferrules of another material than this."""
    for name in FERRULES:
        if MATERIALS[name].material != material:
            label = f"{'ABS' if name == 'abs' else name} ferrule"
            yield DesignChange(label, {"ferrule material": name}, part="ferrule")


def _tips(values: Record) -> Iterator[DesignChange]:
    height, dome = values["tip_height"], values["dome"]
    if height is not None and height - LOWER >= MIN_TIP:
        yield DesignChange(f"tip height {_from_to(height, height - LOWER)}", {"tip height": height - LOWER}, part="tip")
    for name in ("dime", "nickel"):
        if dome is not None and abs(DOMES[name] - dome) > 0.1 * MM:
            yield DesignChange(f"tip radius of a {name}", {"dome": DOMES[name]}, ("dome",), "tip")


def _tapers(cue: Cue, values: Record) -> Iterator[DesignChange]:
    tip, taper, end = (values[f"{name}_diameter"] for name in ("tip", "taper", "butt"))
    x = taper_position(cue)
    at = with_unit(x, DISTANCE)
    yield _cut(cue, values, SHOP[displayed_system()].thinner)
    cone, pro = tip + (end - tip) * x / cue.length, tip + PRO_GAIN
    for name, diameter in (("straight taper, a cone", cone), ("pro taper", pro)):
        if abs(diameter - taper) > 0.2 * MM:
            label = f"{name}, {with_unit(diameter, 'm')} at {at}"
            adds_wood = diameter > taper
            yield DesignChange(label, {"taper diameter": diameter}, is_new_shaft=adds_wood)


def _cut(cue: Cue, values: Record, cut: float) -> DesignChange:
    """So much off the front's diameter; a negative one adds wood, in another shaft."""
    new = {"tip diameter": values["tip_diameter"] - cut, "taper diameter": values["taper_diameter"] - cut}
    at = with_unit(taper_position(cue), DISTANCE)
    label = f"{with_unit(abs(cut), 'm')} {'thicker' if cut < 0 else 'thinner'} from the front to {at}"
    return DesignChange(label, new, is_new_shaft=cut < 0)


def _woods(cue: Cue) -> Iterator[DesignChange]:
    shaft = Layout.of(cue).shaft
    current = table_name(cue.segments[shaft.start].material)
    for name in SHAFT_WOODS:
        if name != current:
            yield DesignChange(f"{name} shaft", {"shaft material": name}, WOOD, "wood", is_new_shaft=True)
    tube: dict[str, Any] = {}
    for i in shaft:
        segment = cue.segments[i]
        tube |= {
            f"cue.segments[{i}].material": "carbon fibre",
            f"cue.segments[{i}].core": "foam",
            f"cue.segments[{i}].tip_bore": segment.tip_diameter - 2 * CARBON_WALL,
            f"cue.segments[{i}].butt_bore": segment.butt_diameter - 2 * CARBON_WALL,
        }
    yield DesignChange(
        f"carbon tube, wall {with_unit(CARBON_WALL, 'm')}, foam inside", tube, WOOD, "wood", is_new_shaft=True
    )


def _from_to(old: float, new: float) -> str:
    return f"{short_number(old, 'm')} → {with_unit(new, 'm')}"
