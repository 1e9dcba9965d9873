"""The one way to change a scene: its places, by name ("ferrule length") or by path ("cue.segments[0].tip_bore").

A place holds one number or one material. A path leads through fields; "[*]" stands for every item of a list, and it may
begin at a part that the drawing tells (`cuefem.parameters.parts`), as in "wood.E". A name of `PLACES` stands for a
path. Sweeps, optima, scatters, knobs, unknowns and the options of commands all derive from that table: an entry there
is a new one in each of them.
"""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cache
from typing import Any, NamedTuple, get_args, get_type_hints

from cuefem.cue import Cue, LumpedCue, Material
from cuefem.cue.materials import LEATHER_NAMES, MATERIALS, WOODS, material_name, table_name
from cuefem.cue.materials import material as named_material
from cuefem.parameters.parts import (
    BORED_WIDTH,
    GROWTH,
    PARTS,
    Layout,
    Part,
    bore_mouth,
    deepest_bore,
    main_material,
    taper_at,
    taper_position,
)
from cuefem.quantity.fields import CONTACT_TIME, Quantity, quantities
from cuefem.quantity.units import number
from cuefem.scene import Scene

Step = str | int
Path = tuple[Step, ...]

_STEP = re.compile(r"\.?([A-Za-z_]\w*)|\[(\d+|\*)\]")
_TAPER = re.compile(r"taper at (.+)")
_FIELDS = tuple(field.name for field in fields(Scene))
# Fields that each fix what others do: setting one clears the others.
_INSTEAD = {
    ("Tip", "contact_time"): ("stiffness",),
    ("Tip", "stiffness"): ("contact_time",),
    ("Striker", "contact_time"): ("stiffness", "modulus", "radius"),
}


class Range(NamedTuple):
    """What a slider reaches from ``low`` to ``high`` in steps, and what may be typed, from ``least`` to ``most``.

    All in a unit that people read; ``scale`` is one SI unit in it.
    """

    unit: str
    scale: float
    low: float
    high: float
    step: float
    least: float
    most: float


@dataclass(frozen=True)
class Place:
    """A named place of scenes, declared once for all that vary it.

    Parameters
    ----------
    name
        As files and options write it, with blanks or underscores.
    words
        What it is.
    path
        The path that it stands for; without one it is a part of its own:
    part
        how its value is read and written, and its quantity.
    also
        Other names.
    group, label, at, absent, hint
        The heading over its knob ("" for no knob) and the knob's label if that is not ``words``; "{exact}" in
        it stands for ``at``, a position on the cue, m from the tip; what is said where a cue has no such place; what
        its knob says of itself where one points at it.
    range
        Of the slider; it may depend on the cue.
    materials
        Those on offer, if it holds a material.
    spread
        As an unknown of an estimate: the standard deviation of its logarithm; None if only a file makes it one.
    below
        Of a number that is usually at its upper bound: by what part of it less it may be, in a verdict's uncertainty.
    option, help
        The word for its value in a command's help, "" if it is no option; and what the help says.
    sets
        What names of its value set beside it, in the dataclass that holds it.
    """

    name: str
    words: str
    path: str = ""
    part: Part | None = None
    also: tuple[str, ...] = ()
    group: str = ""
    label: str = ""
    at: Callable[[Cue], float] | None = None
    absent: str = ""
    hint: str = ""
    range: Range | Callable[[Cue], Range] | None = None
    materials: tuple[str, ...] = ()
    spread: float | Callable[[Scene], float | None] | None = None
    below: float | None = None
    option: str = ""
    help: str = ""
    sets: Mapping[str, Mapping[str, float]] | None = None

    @property
    def key(self) -> str:
        """Its name as an identifier."""
        return self.name.replace(" ", "_")

    def steps(self) -> Path:
        """Its path, as the paths of fields."""
        return _steps(self.path) if self.path else (self.name,)

    def value(self, scene: Scene) -> Any:
        """What a scene has there; None if it has no such place, or an infinite number there."""
        return _finite(value_at(scene, self.steps()))

    def quantity(self, scene: Scene) -> Quantity:
        """Unit and bounds of its number, and the names that stand for numbers."""
        known = quantity_at(scene, self.steps())
        if known is None:
            raise ValueError(f"{self.name} must be a number of this scene; it has none there")
        field = str(self.steps()[-1])
        return replace(known, words=tuple((n, v[field]) for n, v in self.sets.items())) if self.sets else known

    def meant(self, name: str) -> dict[Path, float]:
        """What a name of its value sets, by paths; nothing if it is no such name."""
        return {(*self.steps()[:-1], field): v for field, v in (self.sets or {}).get(name.strip().lower(), {}).items()}

    @property
    def title(self) -> str:
        """Its label on a page."""
        return self.label or f"{self.words[0].upper()}{self.words[1:]}"

    def reach(self, cue: Cue) -> Range | None:
        """The range of its slider on a cue."""
        return self.range(cue) if callable(self.range) else self.range


# --- paths -------------------------------------------------------------------------------------


def place(text: str) -> Place | None:
    """The named place that a text names; None if it is a path."""
    taper = _TAPER.fullmatch(text.strip())
    if taper:
        try:
            position = number(taper[1], "m")
        except ValueError:
            raise ValueError(f'must name a position such as "taper at 330 mm"; got {text!r}') from None
        return Place(text.strip(), f"diameter {taper[1]} from the tip", part=taper_at(position))
    key = re.sub(r"[\s._]+", "_", text.strip())
    return PLACES.get(key) or next((known for known in PLACES.values() if key in known.also), None)


def _part(step: Step) -> Part | None:
    """The part that a path begins at; None if it begins at a field of scenes."""
    if step in PARTS or step in _FIELDS:
        return PARTS.get(str(step))
    known = place(str(step))
    return known.part if known else None


@cache
def _steps(text: str) -> Path:
    """The steps of a path; those into lists are numbers or "*"."""
    steps, start = list[Step](), 0
    while start < len(text) or not text:
        step = _STEP.match(text, start)
        if not step:
            close = difflib.get_close_matches(text, [known.name for known in PLACES.values()], n=3)
            hint = f"; did you mean {' or '.join(close)}?" if close else ""
            raise ValueError(f"must be a path such as cue.segments[0].tip_bore; got {text!r}{hint}")
        steps.append(step[1] or (step[2] if step[2] == "*" else int(step[2])))
        start = step.end()
    return ("cue", *steps) if steps[0] == "segments" else tuple(steps)


def paths(scene: Scene, text: str) -> tuple[Path, ...]:
    """The places of a scene that a name or a path names, "[*]" spelt out; ValueError if there is none.

    The error suggests similar names. A place holds a number or a whole material.
    """
    known = place(text)
    if known is not None and value_at(scene, known.steps()) is None and quantity_at(scene, known.steps()) is None:
        raise ValueError(f"must name a place of the scene; got {text!r}, which this scene does not have")
    ends: list[tuple[Path, Any]] = [((), scene)]
    for step in known.steps() if known else _steps(text):
        ends = [end for path, value in ends for end in _below(path, value, step, text)]
    if not ends:
        raise ValueError(f"must name a field of the scene; got {text!r}, of an empty list")
    return tuple(_checked(scene, path, text) for path, _ in ends)


def _below(path: Path, value: Any, step: Step, text: str) -> list[tuple[Path, Any]]:
    """What lies one step below a value; the step is a field's name, an index or "*"."""
    here = spelt(path) or "the scene"
    if step == "*" or isinstance(step, int):
        if not isinstance(value, tuple):
            raise ValueError(f"must name a field of the scene; got {text!r}, where {here} is no list")
        if step == "*":
            return [((*path, i), item) for i, item in enumerate(value)]
        if step >= len(value):  # type: ignore[operator]
            raise ValueError(f"must name a field of the scene; got {text!r}, where {here} has {len(value)} items")
        return [((*path, step), value[step])]  # type: ignore[index]
    names = [field.name for field in fields(value)] if is_dataclass(value) else []
    if step in names:
        return [((*path, step), getattr(value, step))]
    if not path and (part := _part(step)):
        return [((step,), part.read(value))]
    if value is None:
        raise ValueError(f"must name a field of the scene; got {text!r}, where {here} is empty")
    raise ValueError(f"must name a field of the scene; got {text!r}{_meant(here, step, names, top=not path)}")


def _meant(here: str, name: str, names: list[str], *, top: bool) -> str:
    """Words that suggest similar names, or all names."""
    if not names:
        return f", where {here} has no fields"
    offered = [*names, *(known.name for known in PLACES.values()), *PARTS] if top else names
    close = difflib.get_close_matches(name, offered, n=3, cutoff=0.5)
    return f"; did you mean {' or '.join(close)}?" if close else f", where {here} has {', '.join(names)}"


def _checked(scene: Scene, path: Path, text: str) -> Path:
    """The path, checked to end at a number or a material."""
    if quantity_at(scene, path) is None and not is_material(scene, path):
        below = value_at(scene, path)
        names = [field.name for field in fields(below)] if is_dataclass(below) else []
        hint = f", which holds {', '.join(names)}" if names else ""
        raise ValueError(f"must name one number or a material; got {text!r}{hint}")
    return path


def spelt(path: Path) -> str:
    """A path as text."""
    return "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in path).removeprefix(".")


def value_at(scene: Any, path: Path) -> Any:
    """What stands at a path; None where a scene has no such part."""
    if not path:
        return scene
    part = _part(path[0])
    return _inside(part.read(scene), path[1:]) if part else _inside(scene, path)


def _inside(value: Any, path: Path) -> Any:
    """What stands at a path of fields and indices inside a value; None in what is None."""
    for step in path:
        value = None if value is None else value[step] if isinstance(step, int) else getattr(value, step)
    return value


def quantity_at(scene: Scene, path: Path) -> Quantity | None:
    """Unit and bounds of the number at a path; None if no number stands there."""
    part = _part(path[0]) if len(path) == 1 else None
    if part is not None:
        return part.quantity if part.quantity and part.read(scene) is not None else None
    owner: Any = value_at(scene, path[:-1])
    if not is_dataclass(owner):
        return None
    return next((quantity for name, quantity, *_ in quantities(type(owner)) if name == path[-1]), None)  # type: ignore[arg-type]


def is_material(scene: Scene, path: Path) -> bool:
    """Whether a whole material stands, or may stand, at a path."""
    owner: Any = value_at(scene, path[:-1])
    if len(path) == 1 or not is_dataclass(owner):
        return isinstance(value_at(scene, path), Material)
    return Material in _kinds(type(owner)).get(str(path[-1]), ())  # type: ignore[arg-type]


@cache
def _kinds(kind: type) -> dict[str, tuple[Any, ...]]:
    """What each field of a dataclass may hold."""
    return {name: (hint, *get_args(hint)) for name, hint in get_type_hints(kind).items()}


def named_pieces(scene: Scene, of: Sequence[Path]) -> list[str]:
    """The pieces of a cue that hold some paths, each with its material and extent from the tip."""
    cue = scene.shaft
    layout = Layout.of(cue)
    parts = {"ferrule": layout.ferrule, "bore": layout.bore or range(0), "drilling": layout.bore or range(0)}
    woods = {"ferrule": layout.ferrule, "shaft": layout.shaft}
    found = set[int]()
    for path in of:
        if path[:2] == ("cue", "segments") and len(path) > 2:
            found.add(int(path[2]))
        else:
            found |= {*(woods.get(str(path[-1]), ()) if path[0] == "woods" else parts.get(str(path[0]), ()))}
    runs = list[list[int]]()
    for i in sorted(found):
        if runs and runs[-1][-1] == i - 1 and _piece_name(cue, layout, i) == _piece_name(cue, layout, i - 1):
            runs[-1].append(i)
        else:
            runs.append([i])
    ends = ((cue.nodes[run[0]], cue.nodes[run[-1] + 1]) for run in runs)
    return [
        f"{_piece_name(cue, layout, run[0])}, {1e3 * first:.5g} to {1e3 * last:.5g} mm"
        for run, (first, last) in zip(runs, ends, strict=True)
    ]


def _piece_name(cue: Cue, layout: Layout, i: int) -> str:
    """A segment's part and material."""
    segment = cue.segments[i]
    hollow = "bored " if layout.bore and i in layout.bore else ""
    part = "ferrule" if i in layout.ferrule else "shaft" if i in layout.shaft else f"segment {i}"
    return f"{hollow}{part} of {material_name(segment.material)}"


# --- changes -------------------------------------------------------------------------------------


def _finite(value: Any) -> Any:
    """The value; None for infinity."""
    return None if isinstance(value, float) and not math.isfinite(value) else value


@dataclass(frozen=True)
class _Draft:
    """A scene in the making, which is checked only when all of its parts are in place."""

    cue: Cue | LumpedCue
    ball: Any
    tip: Any
    stroke: Any
    effects: tuple[Any, ...]

    @property
    def shaft(self) -> Any:
        """The cue; parts are only of scenes that have one of segments."""
        return self.cue


def varied(scene: Scene, changes: Mapping[str, Any]) -> Scene:
    """A scene with other values at some places: all at once, then checked as when it is made.

    Parameters
    ----------
    scene : Scene
        The scene as it is; it stays.
    changes : mapping
        SI numbers, materials, or names of materials and leathers, by the name or path of their places.

    Returns
    -------
    Scene
        With these values; what goes with them moves along.

    Raises
    ------
    ValueError
        If a name is of no place of this scene, or no such scene can be made.

    Examples
    --------
    >>> import cuefem as cf
    >>> from cuefem.parameters.parameter import varied
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> scene = cf.usual_scene(cf.Cue((cf.Segment(0.7, 0.012, 0.021, wood),)))
    >>> made = varied(scene, {"wood": "ash", "bore depth": 0.1, "speed": 3.0})
    >>> [segment.length for segment in made.cue.segments], made.cue.segments[0].tip_bore, made.stroke.speed
    ([0.1, 0.6], 0.006, 3.0)
    """
    values = dict[Path, Any]()
    for text, value in changes.items():
        known = place(text)
        beside: dict[Path, Any] = known.meant(value) if known and isinstance(value, str) else {}
        for path in paths(scene, text):
            whole = is_material(scene, path) and isinstance(value, str)
            values |= beside if beside else {path: named_material(value) if whole else value}
    return replaced(scene, values)


def replaced(scene: Scene, changes: Mapping[Path, Any]) -> Scene:
    """A scene with the values at some paths replaced: all at once, then checked as when it is made."""
    inside: dict[Step, dict[Path, Any]] = {}
    for (head, *rest), value in changes.items():
        if head not in _FIELDS:
            inside.setdefault(head, {})[tuple(rest)] = value
    draft = _Draft(**{name: getattr(scene, name) for name in _FIELDS})
    draft = with_fields(draft, {path: value for path, value in changes.items() if path[0] not in inside})
    parts = {str(head): part for head in (*PARTS, *inside) if (part := _part(head))}
    stay = {name for head in inside for name in parts[str(head)].keeps if name not in inside}
    wanted = {
        head: with_fields(None if () in below else parts[str(head)].read(draft), below)
        for head, below in inside.items()
    } | {name: parts[name].read(draft) for name in stay}
    for head, part in parts.items():
        if wanted.get(head) is not None:
            draft = part.write(draft, wanted[head])
    return Scene(**{name: getattr(draft, name) for name in _FIELDS})


def with_fields(thing: Any, changes: Mapping[Path, Any]) -> Any:
    """A dataclass (or tuple) with the values at some paths replaced: all at once, then checked as when it is made.

    A whole material goes in before what changes inside it.
    """
    if () in changes:
        inside = {path: value for path, value in changes.items() if path}
        return with_fields(changes[()], inside) if inside else changes[()]
    below: dict[Step, dict[Path, Any]] = {}
    for (step, *rest), value in changes.items():
        below.setdefault(step, {})[tuple(rest)] = value
    if isinstance(thing, tuple):
        return tuple(with_fields(item, below[i]) if i in below else item for i, item in enumerate(thing))
    new = {str(step): with_fields(getattr(thing, str(step)), inner) for step, inner in below.items()}
    kind = type(thing).__name__
    others = (other for name in new if new[name] is not None for other in _INSTEAD.get((kind, name), ()))
    return replace(thing, **({other: None for other in others if other not in new} | new))


# --- the table -------------------------------------------------------------------------------------


def knobs_of(scene: Scene) -> dict[str, Any]:
    """The values of all places that have a knob, by their keys; ValueError for a lumped cue, which has no shape."""
    _ = scene.shaft
    knobs = {known.key: known.steps() for known in PLACES.values() if known.group}
    tops = {head: value_at(scene, (head,)) for head in dict.fromkeys(path[0] for path in knobs.values())}  # each once
    values = {key: _finite(_inside(tops[head], tuple(rest))) for key, (head, *rest) in knobs.items()}
    return {key: value for key, value in values.items() if value is not None}


def turned(scene: Scene, knobs: Mapping[str, Any]) -> Scene:
    """The scene with its knobs turned, or the scene itself if none was. ValueError if no such cue can be made."""
    own = knobs_of(scene)
    changes = {PLACES[key].steps(): value for key, value in knobs.items() if value != own[key]}
    return replaced(scene, changes) if changes else scene


def _wood_spread(name: str) -> Callable[[Scene], float | None]:
    """Half the width of the range in which real pieces of the wood lie, in logarithms; None for a weighed density."""

    def spread(scene: Scene) -> float | None:
        if name == "rho" and scene.shaft.weighed:
            return None
        wood = main_material(scene.shaft)
        low, high = MATERIALS[table_name(wood) or "hard maple"].ranges[name]
        return math.log(high / low) / 2

    return spread


def _spring_time(scene: Any) -> float | None:
    return None if scene.contact_terms.tip is not None else float(scene.contact_time)


def _mm(low: float, high: float, step: float, least: float, most: float) -> Range:
    return Range("mm", 1e3, low, high, step, least, most)


def _positions(least_end: float) -> Callable[[Cue], Range]:
    """Along the cue, up to so many mm from its end; the slider stops 10 mm before it."""
    return lambda cue: _mm(20, round(1e3 * cue.length - 10), 1, 1, round(1e3 * cue.length - least_end))


SHAFTS = (*WOODS, "carbon fibre")
FERRULES = tuple(name for name in MATERIALS if name not in (*SHAFTS, "foam", "leather"))
_LEATHER_LOW, _LEATHER_HIGH = MATERIALS["leather"].ranges["E"]
_BEHIND = "Joint, bridge and butt"

PLACES: dict[str, Place] = {
    known.key: known
    for known in (
        Place("E", "E of the wood", "wood.E", spread=_wood_spread("E")),
        Place("G", "G of the wood", "wood.G", spread=_wood_spread("G")),
        Place("rho", "density of the wood", "wood.rho", spread=_wood_spread("rho")),
        Place("bore", "diameter of the bore", part=BORED_WIDTH, spread=math.log(7.5 / 6) / 2),  # meshes/README.md
        Place("taper", "diameter gained to the joint", part=GROWTH),
        # half the logarithm of E's and rho's variation in one wood (22 and 10 %, `cuefem.materials`), in quadrature
        Place("wave speed", "speed of axial waves in the butt", "waves.wave_speed", spread=0.12),
        Place(
            *("shaft mass", "weight of the shaft as drawn, with its tip", "weight.mass"),
            option="MASS",
            help='Weight of the shaft as FILE draws it, with its tip, e.g. "112 g": sets the density of its wood.',
        ),
        Place(
            *("tip diameter", "Tip diameter", "diameters.tip"),
            group="Shaft",
            range=_mm(8, 15, 0.05, 4, 30),
        ),
        Place(
            *("taper diameter", "Taper, at {exact}", "diameters.taper"),
            group="Shaft",
            hint="From here the diameter changes evenly to the tip and to the end",
            at=taper_position,
            range=_mm(8, 20, 0.05, 4, 60),
        ),
        Place(
            *("butt diameter", "Taper, at the end", "diameters.butt"),
            group="Shaft",
            range=_mm(12, 34, 0.1, 4, 60),
        ),
        Place(
            *("bore depth", "Bore depth, from {exact} on", "drilling.depth"),
            group="Shaft",
            at=bore_mouth,
            absent="the bore behind the tip is filled, so it stays as it is",
            range=lambda cue: _mm(0, round(min(300.0, 1e3 * deepest_bore(cue)), 1), 1, 0, 1e3 * deepest_bore(cue)),
        ),
        Place("bore width", "Bore width", "drilling.width", group="Shaft", range=_mm(1, 11, 0.1, 0.1, 30)),
        Place(
            *("ferrule length", "Ferrule length", "ferrule.length"),
            group="Shaft",
            hint="A longer ferrule takes its length from the wood behind it: the cue stays as long",
            absent="no ferrule is drawn behind the tip, so there is no knob for it",
            range=_mm(2, 40, 0.5, 0.5, 60),
        ),
        Place("ferrule material", "Ferrule material", "woods.ferrule", group="Shaft", materials=FERRULES),
        Place("shaft material", "Shaft material", "woods.shaft", group="Shaft", materials=SHAFTS),
        Place(
            *("leather", "E of the leather", "leather.E"),
            group="Tip",
            label="Leather, E (30 soft, 140 medium, 360 hard)",
            range=Range("MPa", 1e-6, 20, 500, 5, 1, 20_000),
            spread=math.log(_LEATHER_HIGH / _LEATHER_LOW) / 2,
            option="LEATHER",
            help='Its leather: soft, medium, hard, a tip of `cuefem parts`, or its E, e.g. "140 MPa".',
            sets=LEATHER_NAMES,
        ),
        Place(
            *("tip height", "height of the tip", "leather.height"),
            group="Tip",
            label="Height of the leather",
            range=_mm(2, 12, 0.1, 0.5, 40),
            spread=0.1,
            option="LENGTH",
            help='Height of the leather tip, e.g. "6 mm".',
        ),
        Place(
            *("dome", "radius of the dome", "leather.dome_radius"),
            also=("tip_dome",),
            group="Tip",
            label="Radius of the dome",
            range=_mm(6, 20, 0.1, 3, 500),
            spread=0.1,  # a dime's 8.95 to a nickel's 10.6 mm
            option="RADIUS",
            help='Radius of its dome: nickel, dime, flat or a length, e.g. "9.5 mm".',
        ),
        Place(
            *("surface restitution", "restitution along the leather's surface", "leather.surface_restitution"),
            below=0.05,  # nobody measured it; 0.9 is worth 7 % of squirt, and a robot's has it nearer to 1
        ),
        Place(
            *("contact time", "contact time"),
            part=Part(
                _spring_time, lambda scene, value: with_fields(scene, {("tip", "contact_time"): value}), CONTACT_TIME
            ),
            group="Tip",
            label="Contact time (hard–soft tip)",
            absent="the contact time follows from the leather tip, so there is no knob for it",
            range=Range("ms", 1e3, 0.6, 3, 0.01, 0.2, 20),
            spread=0.1,  # leather 1.0 to 1.2 ms
        ),
        Place(
            *("restitution", "Bounce of the tip, e", "tip.restitution"),
            group="Tip",
            range=Range("", 1.0, 0.5, 0.95, 0.01, 0, 1),
            option="E",
            help="Coefficient of restitution of the tip alone, in [0, 1]; a cue's 0.73 is about 0.6 of its tip's.",
        ),
        Place(
            *("friction", "Friction of tip and ball", "tip.friction"),
            group="Tip",
            range=Range("", 1.0, 0.2, 1.2, 0.01, 0.01, 10),
            option="MU",
            help="Coefficient of friction of tip and ball.",
        ),
        Place(
            *("speed", "Speed of the cue", "stroke.speed"),
            group="Stroke",
            range=Range("m/s", 1.0, 0.3, 12, 0.1, 0.01, 40),
            option="SPEED",
            help='Speed of the cue, e.g. "3 m/s".',
        ),
        Place(
            *("offset", "Offset b/R", "stroke.offset"),
            group="Stroke",
            range=Range("", 1.0, 0, 0.9, 0.01, -0.95, 0.95),
            option="B/R",
            help='How far off centre the tip hits: in ball radii, in (-1, 1), or a length, e.g. "8 mm".',
        ),
        Place(
            *("joint compliance", "Joint bends", "joint.rotational_compliance"),
            group=_BEHIND,
            hint="How far the joint gives under a torque: at 0 it is stiff",
            range=Range("mrad/(N m)", 1e3, 0, 5, 0.05, 0, 100),
        ),
        Place("joint position", "Joint at", "joint.position", group=_BEHIND, range=_positions(10)),
        Place(
            *("bridge stiffness", "Bridge hand holds", "bridge.stiffness"),
            group=_BEHIND,
            range=Range("N/mm", 1e-3, 0, 30, 0.5, 0, 1000),
        ),
        Place("bridge position", "Bridge at", "bridge.position", group=_BEHIND, range=_positions(1)),
        Place(
            *("body mass", "Mass behind what is drawn", "cue.body_mass"),
            group=_BEHIND,
            range=Range("g", 1e3, 0, 700, 5, 0, 5000),
            option="MASS",
            help='Mass of the cue behind FILE\'s segments, e.g. "420 g".',
        ),
    )
}
