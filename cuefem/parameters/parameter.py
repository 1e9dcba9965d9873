"""Parameters of a scene, and how to change them: by name ("ferrule length") or path ("cue.segments[0].tip_bore").

A parameter is one number or one material. A path leads through fields; "[*]" means every item of a list. It may begin
at a part of the drawing (`cuefem.parameters.parts`), as in "wood.E". Each name of `PARAMETERS` refers to a path or a
part. Studies, sliders, uncertain parameters and the options of commands derive from that table: an entry added there
appears in all of them.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Container, Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cache
from typing import Any, NamedTuple, get_args, get_type_hints

from cuefem.cue import Cue, LumpedCue, Material
from cuefem.cue.materials import LEATHER_BY_NAME, LEATHERS, MATERIALS, WOODS, leather_restitution, table_name
from cuefem.cue.materials import material as named_material
from cuefem.parameters.parts import (
    BODY_MASS,
    BORE_DEPTH,
    BORE_WIDTH,
    CONTACT_TIME_OF_SPRING,
    EMPTY_DEPTH,
    FERRULE_LENGTH,
    FERRULE_MATERIAL,
    FRONT_WALL,
    GROWTH,
    INSERT_DEPTH,
    PARTS,
    SHAFT_MATERIAL,
    WEIGHT,
    Layout,
    Part,
    diameter_at,
    main_material,
    taper_position,
)
from cuefem.quantity.fields import Quantity, quantity_fields, suggestion
from cuefem.quantity.units import parse_number
from cuefem.scene import Scene
from cuefem.scene.default_scene import BODY_MASS_RANGE

Step = str | int
Path = tuple[Step, ...]

_STEP = re.compile(r"\.?([A-Za-z_]\w*)|\[(\d+|\*)\]")
_TAPER = re.compile(r"taper at (.+)")
_SCENE_FIELDS = tuple(field.name for field in fields(Scene))


class Slider(NamedTuple):
    """The range of a slider, ``low`` to ``high`` in steps, and of typed values, ``least`` to ``most``.

    All in the display unit; ``scale`` is the factor from the SI unit. A range from 0 to 0 has no slider.
    """

    unit: str
    scale: float
    low: float
    high: float
    step: float
    least: float
    most: float


def millimetres(low: float, high: float, step: float, least: float, most: float) -> Slider:
    """A slider in mm."""
    return Slider("mm", 1e3, low, high, step, least, most)


@dataclass(frozen=True)
class Parameter:
    """A named parameter of scenes.

    Parameters
    ----------
    name
        Its name in files and options, with blanks or underscores.
    label
        A short description.
    path
        Its path; "" if it is a part.
    part
        How the value of a part is read and written, and its quantity; None for a path.
    materials
        The choices, if it is a material.
    spread
        Prior standard deviation of its logarithm, or a function of the scene for it. None: uncertain only if a file
        says so.
    below
        Relative uncertainty, downwards, of a number that is usually at its upper bound.
    option, help
        The metavariable and the text of a command's help; "" if it is no option.
    sets
        For each name of its value ("medium"): the values, by path, that the name sets, of this and other parameters.
    slider
        Range of its slider in the designer; None without one.
    dependent_values
        Function of scene and value: values of other parameters, by path, that change with it where it is uncertain.
    """

    name: str
    label: str
    path: str = ""
    part: Part | None = None
    materials: tuple[str, ...] = ()
    spread: float | Callable[[Scene], float | None] | None = None
    below: float | None = None
    option: str = ""
    help: str = ""
    sets: Mapping[str, Mapping[str, float]] | None = None
    slider: Slider | None = None
    dependent_values: Callable[[Scene, float], dict[Path, float]] | None = None

    @property
    def key(self) -> str:
        """Its name as an identifier."""
        return self.name.replace(" ", "_")

    @property
    def choices(self) -> tuple[str, ...]:
        """The names that a list offers: materials, or kinds of leather."""
        return self.materials or tuple(name for name in self.sets or () if name in LEATHERS)

    def steps(self) -> Path:
        """Its path, in steps."""
        return _steps(self.path) if self.path else (self.name,)

    def value(self, scene: Scene) -> Any:
        """Its value in a scene; None if the scene has no such parameter, or if it is infinite."""
        value = value_at(scene, self.steps())
        return None if isinstance(value, float) and not math.isfinite(value) else value

    @property
    def is_shareable(self) -> bool:
        """Whether it belongs to the tip or the butt, which two shafts may share."""
        return self.path.startswith(("leather.", "tip.", "waves.")) or self.part is CONTACT_TIME_OF_SPRING

    def scaled(self, scene: Scene, factor: float) -> dict[Path, float]:
        """Its value in a scene times a factor, and the dependent values, by path."""
        value = factor * self.value(scene)
        return {self.steps(): value} | (self.dependent_values(scene, value) if self.dependent_values else {})

    def spread_in(self, scene: Scene) -> float | None:
        """Its spread in a scene; None if it is not uncertain there."""
        return self.spread(scene) if callable(self.spread) else self.spread

    def quantity(self, scene: Scene) -> Quantity:
        """Unit and bounds of its number, and the names of values; ValueError if the scene has no such number."""
        number = quantity_at(scene, self.steps())
        if number is None:
            raise ValueError(f"{self.name} must be a number of this scene; got none")
        return replace(number, names=tuple((n, v[self.path]) for n, v in self.sets.items())) if self.sets else number

    def named_value(self, name: str) -> dict[Path, float]:
        """The values by path for a name of its value; empty if there is no such name."""
        return {_steps(path): value for path, value in (self.sets or {}).get(name.strip().lower(), {}).items()}


# --- paths -------------------------------------------------------------------------------------


def parameter(text: str) -> Parameter | None:
    """The parameter of a name; None if the text is a path. ValueError for "taper at" without a position."""
    taper = _TAPER.fullmatch(text.strip())
    if taper:
        try:
            position = parse_number(taper[1], "m")
        except ValueError:
            raise ValueError(f'must name a position such as "taper at 330 mm"; got {text!r}') from None
        return Parameter(text.strip(), f"diameter {taper[1]} from the front", part=diameter_at(lambda cue: position))
    return PARAMETERS.get(re.sub(r"[\s._]+", "_", text.strip()))


def _part(step: Step) -> Part | None:
    """The part at which a path begins; None if it begins at a field of scenes."""
    if step in PARTS or step in _SCENE_FIELDS:
        return PARTS.get(str(step))
    entry = parameter(str(step))
    return entry.part if entry else None


@cache
def _steps(text: str) -> Path:
    """The steps of a path: names of fields, and indices of lists or "*"."""
    steps, start = list[Step](), 0
    while start < len(text) or not text:
        step = _STEP.match(text, start)
        if not step:
            hint = suggestion(text, [entry.name for entry in PARAMETERS.values()])
            hint = hint or '; write a name such as "bore width" or a path such as cue.segments[0].tip_bore'
            raise ValueError(f"unknown parameter {text!r}{hint}")
        steps.append(step[1] or (step[2] if step[2] == "*" else int(step[2])))
        start = step.end()
    return ("cue", *steps) if steps[0] == "segments" else tuple(steps)


def paths(scene: Scene, text: str) -> tuple[Path, ...]:
    """The paths of a name or a path in a scene, "[*]" expanded; ValueError, with similar names, if it is unknown.

    Each leads to a number or a material.
    """
    entry = parameter(text)
    if entry is not None and value_at(scene, entry.steps()) is None and quantity_at(scene, entry.steps()) is None:
        raise ValueError(f"must name a parameter of the scene; got {text!r}, which this scene does not have")
    ends: list[tuple[Path, Any]] = [((), scene)]
    for step in entry.steps() if entry else _steps(text):
        ends = [end for path, value in ends for end in _below(path, value, step, text)]
    expanded = tuple(path for path, _ in ends)
    if not expanded or any(quantity_at(scene, path) is None and not is_material(scene, path) for path in expanded):
        contents = ", which holds " + ", ".join(map(str, _inner(ends[0][1]))) if ends and _inner(ends[0][1]) else ""
        raise ValueError(f"must name one number or a material; got {text!r}{contents}")
    return expanded


def _inner(value: Any) -> dict[Step, Any]:
    """The items or fields of a value, by index or name."""
    if isinstance(value, tuple):
        return dict(enumerate(value))
    return {field.name: getattr(value, field.name) for field in fields(value)} if is_dataclass(value) else {}


def _below(path: Path, value: Any, step: Step, text: str) -> list[tuple[Path, Any]]:
    """The paths and values one step below a value; the step is a field's name, an index or "*"."""
    inner = _inner(value)
    if step == "*" and isinstance(value, tuple):
        return [((*path, i), item) for i, item in inner.items()]
    if step in inner:
        return [((*path, step), inner[step])]
    if not path and (part := _part(step)):
        return [((step,), part.read(value))]
    owner, names = path_text(path) or "the scene", [name for name in inner if isinstance(name, str)]
    valid = names if path else [*names, *(entry.name for entry in PARAMETERS.values()), *PARTS]
    contents = ", ".join(names) if names else f"{len(inner)} items"
    hint = suggestion(str(step), valid) or f", where {owner} has {contents}"
    raise ValueError(f"must name a field of the scene; got {text!r}{hint}")


def path_text(path: Path) -> str:
    """A path as text."""
    return "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in path).removeprefix(".")


def value_at(scene: Any, path: Path) -> Any:
    """The value at a path; None if the scene has no such part."""
    if not path:
        return scene
    part = _part(path[0])
    return _inside(part.read(scene), path[1:]) if part else _inside(scene, path)


def _inside(value: Any, path: Path) -> Any:
    """The value at a path of fields and indices inside a value; None inside None."""
    for step in path:
        value = None if value is None else value[step] if isinstance(step, int) else getattr(value, step)
    return value


def quantity_at(scene: Scene, path: Path) -> Quantity | None:
    """Unit and bounds of the number at a path; None if it is no number."""
    part = _part(path[0]) if len(path) == 1 else None
    if part is not None:
        return part.quantity if part.quantity and part.read(scene) is not None else None
    owner: Any = value_at(scene, path[:-1])
    if not is_dataclass(owner):
        return None
    return next((quantity for name, quantity, *_ in quantity_fields(type(owner)) if name == path[-1]), None)  # type: ignore[arg-type]


def is_material(scene: Scene, path: Path) -> bool:
    """Whether the value at a path is, or may be, a material."""
    owner: Any = value_at(scene, path[:-1])
    if len(path) == 1 or not is_dataclass(owner):
        return isinstance(value_at(scene, path), Material)
    return Material in _kinds(type(owner)).get(str(path[-1]), ())  # type: ignore[arg-type]


@cache
def _kinds(kind: type) -> dict[str, tuple[Any, ...]]:
    """The types of each field of a dataclass."""
    return {name: (hint, *get_args(hint)) for name, hint in get_type_hints(kind).items()}


# --- changes -------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Draft:
    """A scene under construction, without checks."""

    cue: Cue | LumpedCue
    ball: Any
    tip: Any
    stroke: Any
    effects: tuple[Any, ...]

    @property
    def shaft(self) -> Any:
        """The cue; only scenes with a cue of segments have parts."""
        return self.cue


def with_parameters(scene: Scene, changes: Mapping[str, Any]) -> Scene:
    """A scene with other values of some parameters, changed together and then checked.

    Parameters
    ----------
    scene : Scene
        The original scene.
    changes : mapping
        SI numbers, materials, or names of materials and leathers, by parameter name ("bore width"; `cuefem guide study`
        lists them) or path ("cue.segments[0].tip_bore").

    Returns
    -------
    Scene
        With these values; dependent values change with them.

    Raises
    ------
    ValueError
        If this scene has no such parameter, or the new scene is invalid.

    Examples
    --------
    >>> import cuefem as cf
    >>> scene = cf.usual_scene(cf.Cue((cf.Segment(0.7, 0.012, 0.021, cf.material("hard maple")),)))
    >>> changed = cf.with_parameters(scene, {"shaft material": "ash", "bore depth": 0.1, "speed": 3.0})
    >>> [segment.length for segment in changed.cue.segments], changed.cue.segments[0].tip_bore, changed.stroke.speed
    ([0.1, 0.6], 0.006, 3.0)
    """
    values = dict[Path, Any]()
    for text, value in changes.items():
        entry = parameter(text)
        by_name: dict[Path, Any] = entry.named_value(value) if entry and isinstance(value, str) else {}
        for path in paths(scene, text):
            is_name = is_material(scene, path) and isinstance(value, str)
            values |= by_name if by_name else {path: named_material(value) if is_name else value}
    return with_values_at(scene, values)


def with_values_at(scene: Scene, changes: Mapping[Path, Any]) -> Scene:
    """A scene with the values at some paths replaced, changed together and then checked.

    Fields of the scene are written first, then parts of the drawing in the order of `PARAMETERS`.
    """
    below: dict[str, dict[Path, Any]] = {}
    for (head, *rest), value in changes.items():
        below.setdefault(str(head), {})[tuple(rest)] = value
    draft = _Draft(**{name: getattr(scene, name) for name in _SCENE_FIELDS})
    draft = with_fields(draft, {path: value for path, value in changes.items() if path[0] in _SCENE_FIELDS})
    heads = (*(entry.name for entry in PARAMETERS.values()), *PARTS, *below)
    parts = {head: part for head in heads if (part := _part(head))}  # in writing order
    for head, inner in below.items():
        if head in parts and () in inner:
            _check_part(head, parts[head], inner[()])
    values = {
        head: with_fields(None if () in inner else parts[head].read(draft), inner)
        for head, inner in below.items()
        if head in parts
    }
    check_bore(draft, values)
    unchanged = {name for head in values for name in parts[head].unchanged} - {*values}
    values |= {name: parts[name].read(draft) for name in unchanged}
    for head, part in parts.items():
        if values.get(head) is not None:
            draft = part.write(draft, values[head])
    return Scene(**{name: getattr(draft, name) for name in _SCENE_FIELDS})


def _check_part(name: str, part: Part, value: Any) -> None:
    """TypeError or ValueError for a number of a part that is none, or out of its bounds."""
    if part.quantity is not None:
        part.quantity.check(name, value)


def check_bore(scene: Any, names: Container[Step]) -> None:
    """ValueError if the width of a bore changes in a cue without one: "bore width" is then that of a new bore."""
    if "bore width" in names and "bore depth" not in names and BORE_DEPTH.read(scene) == 0:
        raise ValueError("bore width has no effect: the cue has no bore; change bore depth too, or draw a bore")


def with_fields(instance: Any, changes: Mapping[Path, Any]) -> Any:
    """A dataclass (or tuple) with the values at some paths replaced, changed together and then checked.

    A material is replaced before its own fields.
    """
    if () in changes:
        own_fields = {path: value for path, value in changes.items() if path}
        return with_fields(changes[()], own_fields) if own_fields else changes[()]
    below: dict[Step, dict[Path, Any]] = {}
    for (step, *rest), value in changes.items():
        below.setdefault(step, {})[tuple(rest)] = value
    if isinstance(instance, tuple):
        return tuple(with_fields(item, below[i]) if i in below else item for i, item in enumerate(instance))
    new = {str(step): with_fields(getattr(instance, str(step)), inner) for step, inner in below.items()}
    return replace(instance, **new)


# --- the table -------------------------------------------------------------------------------------


def _wood_spread(name: str) -> Callable[[Scene], float | None]:
    """Half the width of the wood's range, in logarithms; None for a weighed density."""

    def spread(scene: Scene) -> float | None:
        if name == "rho" and scene.shaft.shaft_mass_measured:
            return None
        wood = main_material(scene.shaft)
        low, high = MATERIALS[table_name(wood) or "hard maple"].ranges[name]
        return math.log(high / low) / 2

    return spread


def _leather_spread(scene: Scene) -> float | None:
    """From a contact time of ±10 % (1.0 to 1.2 ms) for a named leather, ±5 % for a custom E; None without one."""
    if scene.contact_terms.tip is None:
        return None
    is_tabulated = any(tip.E == scene.leather_tip.E for tip in LEATHERS.values())
    return CONTACT_TIME_POWER * (0.1 if is_tabulated else 0.05)


def _dependent_restitution(scene: Scene, E: float) -> dict[Path, float]:
    """The tip's restitution for another E of its leather, at the same restitution of the whole cue."""
    change = leather_restitution(E) - leather_restitution(scene.leather_tip.E)
    return {("tip", "restitution"): min(max(float(scene.tip.restitution) + change, 0.1), 1.0)}


def _restitution_spread(scene: Scene) -> float | None:
    """For whole cues of 0.71 to 0.75 (tips 0.575 to 0.633, `cuefem.identify_tip`); None without leather."""
    return None if scene.contact_terms.tip is None else 0.05


def _friction_spread(scene: Scene) -> float | None:
    """Root mean square distance of three published values from 0.7, in logarithms; None without friction.

    A tip slips first at offsets of 0.5 to 0.55 R, tan φ 0.577 and 0.659 ([TP 2.1]); [Kim] takes 0.7.
    """
    published = (math.tan(math.asin(0.5)), math.tan(math.asin(0.55)), 0.7)
    squares = [math.log(friction / 0.7) ** 2 for friction in published]
    return math.sqrt(sum(squares) / len(squares)) if scene.tip.friction else None


def _body_spread(scene: Scene) -> float | None:
    """Half the range of usual cues, in logarithms, of an assumed mass; None for another."""
    return math.log(BODY_MASS_RANGE[1] / BODY_MASS_RANGE[0]) / 2 if scene.shaft.is_body_mass_assumed else None


def _bore_spread(scene: Scene) -> float | None:
    """Half the range of drilled bores, 6 to 7.5 mm (meshes/README.md), in logarithms; None without a bore."""
    return math.log(7.5 / 6) / 2 if Layout.of(scene.shaft).bore else None


SHAFTS = (*WOODS, "carbon fibre")
CONTACT_TIME_POWER = 3.5  # a leather's E goes as that power of 1/contact time (`cuefem.identify_tip`)
FERRULES = tuple(name for name in MATERIALS if name not in (*SHAFTS, "foam", "leather"))
_LEATHERS = {
    name: {"leather.E": tip.E, "leather.nu": tip.nu, "leather.rho": tip.rho, "tip.restitution": tip.restitution}
    for name, tip in LEATHER_BY_NAME.items()
}

# Parts are written in this order: the shaft mass first, because it is measured before other changes; materials last,
# because ferrule and shaft are identified by theirs.
PARAMETERS: dict[str, Parameter] = {
    entry.key: entry
    for entry in (
        Parameter("E", "E of the wood", "wood.E", spread=_wood_spread("E")),
        Parameter("G", "G of the wood", "wood.G", spread=_wood_spread("G")),
        Parameter("rho", "density of the wood", "wood.rho", spread=_wood_spread("rho")),
        # half the logarithm of E's and rho's variation in one wood (22 and 10 %, materials.toml), in quadrature
        Parameter("wave speed", "speed of axial waves in the butt", "waves.wave_speed", spread=0.12),
        Parameter(
            name="shaft mass",
            label="weight of the shaft as drawn, with its tip",
            part=WEIGHT,
            option="MASS",
            help='Measured mass of the shaft as drawn, with its tip, e.g. "112 g"; sets the density of its wood.',
            slider=Slider("g", 1e3, 0, 0, 0.1, 0.1, 100_000),
        ),
        Parameter(
            "ferrule length", "length of the ferrule", part=FERRULE_LENGTH, slider=millimetres(2, 40, 0.5, 0.5, 60)
        ),
        Parameter(
            name="tip diameter",
            label="diameter at the tip",
            part=diameter_at(lambda cue: 0.0),
            slider=millimetres(8, 15, 0.05, 4, 30),
        ),
        Parameter(
            name="taper diameter",
            label="diameter where the taper begins",
            part=diameter_at(taper_position),
            slider=millimetres(8, 20, 0.05, 4, 60),
        ),
        Parameter(
            name="butt diameter",
            label="diameter at the end",
            part=diameter_at(lambda cue: cue.length),
            slider=millimetres(12, 34, 0.1, 4, 60),
        ),
        Parameter("taper", "diameter gained to the joint", part=GROWTH),
        Parameter(
            name="bore depth",
            label="depth of the bore",
            part=BORE_DEPTH,
            slider=millimetres(0, 300, 1, 0, 3000),
        ),
        Parameter(
            name="bore width",
            label="width of the bore",
            part=BORE_WIDTH,
            spread=_bore_spread,
            slider=millimetres(1, 11, 0.1, 0.1, 30),
        ),
        Parameter("front wall", "wall of a tube in its first 150 mm, at its front end", part=FRONT_WALL),
        Parameter("empty depth", "length of a tube that is not filled, from its front end", part=EMPTY_DEPTH),
        Parameter("insert depth", "length of a maple insert in the front of a tube", part=INSERT_DEPTH),
        Parameter(
            name="leather",
            label="E of the leather",
            path="leather.E",
            spread=_leather_spread,
            dependent_values=_dependent_restitution,
            option="LEATHER",
            help='Leather of the tip: soft, medium, hard, a tip of `cuefem parts`, or its E, e.g. "200 MPa".',
            sets=_LEATHERS,
        ),
        Parameter(
            name="tip height",
            label="height of the tip",
            path="leather.height",
            spread=0.1,
            option="LENGTH",
            help='Height of the leather tip, e.g. "6 mm".',
            slider=millimetres(2, 12, 0.1, 0.5, 40),
        ),
        Parameter(
            name="dome",
            label="tip radius (dome)",
            path="leather.dome_radius",
            spread=0.1,  # a dime's 8.95 to a nickel's 10.6 mm
            option="RADIUS",
            help='Tip radius (dome): nickel, dime, flat or a length, e.g. "9.5 mm".',
            slider=millimetres(6, 20, 0.1, 3, 500),
        ),
        Parameter(
            name="surface restitution",
            label="restitution along the leather's surface",
            path="leather.surface_restitution",
            below=0.05,  # not measured: 0.9 changes squirt by 7 %, and a robot's strokes suggest a value near 1
        ),
        # leather 1.0 to 1.2 ms
        Parameter(
            name="contact time",
            label="contact time",
            part=CONTACT_TIME_OF_SPRING,
            spread=0.1,
            slider=Slider("ms", 1e3, 0.6, 3, 0.01, 0.2, 20),
        ),
        Parameter(
            name="restitution",
            label="restitution of the tip",
            path="tip.restitution",
            spread=_restitution_spread,
            option="E",
            help="Restitution of the tip alone, 0 to 1; with axial waves a tip of 0.6 gives a whole cue 0.73.",
            slider=Slider("", 1.0, 0.5, 0.95, 0.01, 0, 1),
        ),
        Parameter(
            name="friction",
            label="friction of tip and ball",
            path="tip.friction",
            spread=_friction_spread,
            option="MU",
            help="Coefficient of friction between tip and ball.",
            slider=Slider("", 1.0, 0.2, 1.2, 0.01, 0.01, 10),
        ),
        Parameter(
            name="speed",
            label="speed of the cue",
            path="stroke.speed",
            option="SPEED",
            help='Cue speed at impact, e.g. "3 m/s".',
            slider=Slider("m/s", 1.0, 0.3, 12, 0.1, 0.01, 40),
        ),
        Parameter(
            name="offset",
            label="offset b/R",
            path="stroke.offset",
            option="B/R",
            help='Tip offset from the ball centre: b/R in (-1, 1), or a length, e.g. "8 mm".',
            slider=Slider("", 1.0, 0, 0.9, 0.01, -0.95, 0.95),
        ),
        Parameter(
            name="body mass",
            label="mass of the butt",
            part=BODY_MASS,
            spread=_body_spread,
            option="MASS",
            help='Mass of the butt, the rest of the cue behind what FILE draws, e.g. "420 g".',
            slider=Slider("g", 1e3, 0, 0, 1, 0, 5000),
        ),
        Parameter("ferrule material", "material of the ferrule", part=FERRULE_MATERIAL, materials=FERRULES),
        Parameter("shaft material", "material of the shaft", part=SHAFT_MATERIAL, materials=SHAFTS),
    )
}
