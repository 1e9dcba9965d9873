"""The controls: their ranges, the parameter each changes in a scene, typed input, and each as a row of the page."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple, Protocol

from nicegui import ui

from cuefem.cue import Cue, Segment
from cuefem.cue.materials import LEATHERS, material_name, table_name
from cuefem.designer.state import FAILURES, Design, Step, one_line
from cuefem.files.shaft_additions import with_additions
from cuefem.parameters.parameter import PARAMETERS, with_parameters
from cuefem.parameters.parts import Layout, bore_mouth, max_bore_depth, split_segment, taper_position
from cuefem.quantity.fields import Quantity
from cuefem.quantity.units import plain_fractions, split_quantity, unit_of
from cuefem.scene import Scene
from cuefem.scene.default_scene import GAMES, usual_scene, without_leather

MIN_WALL = 0.0005  # m, the thinnest wall around a typed bore
NEW_FERRULE, NEW_BORE, NEW_DEPTH = "25 mm", 0.006, 0.127
DECIMALS = {"mm": 2, "g": 1}  # the most that are shown; of other units 3
NONE, DRILLED = "none", "drilled"
MAX_TEXT = 40
_UNITLESS = re.compile(r"[-+]?[\d./\s¼-¾⅐-⅞-]+")
FERRULE_BEGINS, LEATHER_BEGINS = "the ferrule; tip added", "the tip"


class Range(NamedTuple):
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


class Knob(NamedTuple):
    """A control: its group, its label ("{at}" is a position on the cue), and its range (None for a choice)."""

    group: str
    label: str
    range: Range | None = None


def _mm(low: float, high: float, step: float, least: float, most: float) -> Range:
    return Range("mm", 1e3, low, high, step, least, most)


# By the keys of the parameters that they change, where a parameter has it.
KNOBS = {
    "shaft_material": Knob("Shaft", "Material"),
    "tip_diameter": Knob("Shaft", "Tip diameter", _mm(8, 15, 0.05, 4, 30)),
    "taper_diameter": Knob("Shaft", "Taper, {at}", _mm(8, 20, 0.05, 4, 60)),
    "butt_diameter": Knob("Shaft", "Taper, end", _mm(12, 34, 0.1, 4, 60)),
    "ferrule": Knob("Shaft", "Ferrule"),
    "ferrule_length": Knob("Shaft", "Ferrule length", _mm(2, 40, 0.5, 0.5, 60)),
    "bore": Knob("Shaft", "Bore"),
    "bore_width": Knob("Shaft", "Bore width", _mm(1, 11, 0.1, 0.1, 30)),
    "bore_depth": Knob("Shaft", "Bore depth", _mm(0, 300, 1, 0, 3000)),
    "shaft_mass": Knob("Shaft", "Shaft weight, with tip", Range("g", 1e3, 0, 0, 0.1, 0.1, 100_000)),
    "body_mass": Knob("Shaft", "Rest of cue", Range("g", 1e3, 0, 0, 1, 0, 5000)),
    "leather": Knob("Tip", "Tip hardness"),
    "tip_height": Knob("Tip", "Tip height", _mm(2, 12, 0.1, 0.5, 40)),
    "dome": Knob("Tip", "Tip radius", _mm(6, 20, 0.1, 3, 500)),
    "contact_time": Knob("Tip", "Contact time", Range("ms", 1e3, 0.6, 3, 0.01, 0.2, 20)),
    "friction": Knob("Tip", "Friction", Range("", 1.0, 0.2, 1.2, 0.01, 0.01, 10)),
    "restitution": Knob("Tip", "Restitution", Range("", 1.0, 0.5, 0.95, 0.01, 0, 1)),
    "game": Knob("Stroke", "Game"),
    "speed": Knob("Stroke", "Cue speed", Range("m/s", 1.0, 0.3, 12, 0.1, 0.01, 40)),
    "offset": Knob("Stroke", "Tip offset b/R", Range("", 1.0, 0, 0.9, 0.01, -0.95, 0.95)),
    "ball_mass": Knob("Stroke", "Ball mass", Range("g", 1e3, 0, 0, 1, 1, 10_000)),
    "ball_diameter": Knob("Stroke", "Ball diameter", _mm(0, 0, 0.05, 1, 1000)),
    "front": Knob("", "Front of the drawing"),
}
GROUPS = ("Shaft", "Tip", "Stroke")
SI = {"mm": "m", "g": "kg", "ms": "s"}
# Controls whose uncertain parameters have other names in a verdict.
INPUTS = {"shaft_material": ("E", "G"), "shaft_mass": ("rho",), "bore": ("bore_width",)}


def label(key: str, scene: Scene) -> str:
    """A control's label."""
    return KNOBS[key].label.format(at=f"{1e3 * taper_position(scene.shaft):.0f}\u00a0mm")


def range_of(key: str) -> Range:
    """The ranges of a number's slider and of its typed values."""
    known = KNOBS[key].range
    assert known is not None
    return known


def value(key: str, scene: Scene) -> Any:
    """A control's value in a scene: an SI number, or the name of a choice; None if it does not apply."""
    cue, layout = scene.shaft, Layout.of(scene.shaft)
    if key == "ferrule":
        return _name(cue.segments[layout.ferrule.start].material) if layout.ferrule else NONE
    if key in ("bore", "bore_width", "bore_depth") and not layout.bore:
        filling = layout.filling
        return None if key != "bore" else f"{_name(filling)} core" if filling else NONE
    if key == "bore":
        return DRILLED
    if key == "shaft_material":
        return _name(cue.segments[layout.shaft.start].material)
    if key == "leather":
        E = PARAMETERS[key].value(scene)
        return E and next((n for n, known in LEATHERS.items() if known.E == E), f"E {E / 1e6:.4g} MPa")
    if key == "game":
        return next((name for name, game in GAMES.items() if game.ball == scene.ball), "another ball")
    if key == "front":
        return None if PARAMETERS["tip_height"].value(scene) is None else FERRULE_BEGINS
    if key in ("ball_mass", "ball_diameter"):
        return scene.ball.mass if key == "ball_mass" else 2 * scene.ball.radius
    return PARAMETERS[key].value(scene)


def _name(known: Any) -> str:
    return table_name(known) or material_name(known)


def options(key: str, scene: Scene) -> list[str]:
    """The options of a choice, including the scene's own."""
    offered = {
        "shaft_material": PARAMETERS["shaft_material"].materials,
        "ferrule": (NONE, *PARAMETERS["ferrule_material"].materials),
        "bore": () if Layout.of(scene.shaft).bore is None else (NONE, DRILLED),
        "leather": (*LEATHERS,),
        "game": (*GAMES,),
        "front": (FERRULE_BEGINS, LEATHER_BEGINS),
    }[key]
    own = value(key, scene)
    return [*offered] if own in offered or own is None else [own, *offered]


def with_value(scene: Scene, key: str, new: Any) -> Scene:
    """The scene with a control at another value; ValueError if that scene is invalid."""
    made = _with_value(scene, key, new)
    if key.startswith(("ferrule", "bore")):  # which cut segments, and would cut them anew with every move
        made = replace(made, cue=_merged(made.shaft))
    return made


def _merged(cue: Cue) -> Cue:
    """The cue with adjacent segments merged if they form one cone of one material."""
    segments = list(cue.segments[:1])
    for piece in cue.segments[1:]:
        last = segments[-1]
        length = last.length + piece.length
        whole = replace(piece, length=length, tip_diameter=last.tip_diameter, tip_bore=last.tip_bore)
        front, back = split_segment(whole, last.length / length)
        ends = zip(_sizes(front) + _sizes(back), _sizes(last) + _sizes(piece), strict=True)
        alike = (last.material, last.core, last.kappa) == (piece.material, piece.core, piece.kappa)
        if alike and all(math.isclose(a, b, rel_tol=1e-9, abs_tol=1e-12) for a, b in ends):
            segments[-1] = whole
        else:
            segments.append(piece)
    return replace(cue, segments=tuple(segments))


def _sizes(piece: Segment) -> tuple[float, ...]:
    return piece.tip_diameter, piece.butt_diameter, piece.tip_bore, piece.butt_bore


def _with_value(scene: Scene, key: str, new: Any) -> Scene:
    if key == "ferrule":
        return _with_ferrule(scene, new)
    if key == "bore":
        depth = min(NEW_DEPTH, max_bore_depth(scene.shaft))
        return with_parameters(
            scene, {"bore depth": 0.0} if new == NONE else {"bore depth": depth, "bore width": NEW_BORE}
        )
    if key == "game":
        return _with_game(scene, new)
    if key == "front":
        height = f"leather {PARAMETERS['tip_height'].value(scene):.9g} m"
        return replace(
            scene,
            cue=without_leather(with_additions(scene.shaft, front=height if new == LEATHER_BEGINS else "ferrule")),
        )
    if key == "ball_diameter":
        return with_parameters(scene, {"ball.radius": new / 2})
    return with_parameters(scene, {{"ball_mass": "ball.mass"}.get(key, key): new})


def _with_ferrule(scene: Scene, name: str) -> Scene:
    """The scene with a ferrule of a material, a new one on a tenon; or with wood instead of it."""
    layout = Layout.of(scene.shaft)
    if name == NONE or not layout.ferrule:
        ferrule = name if name == NONE else f"{NEW_FERRULE} {name}"
        return replace(scene, cue=with_additions(scene.shaft, ferrule=ferrule))
    return with_parameters(scene, {"ferrule material": name})


def _with_game(scene: Scene, name: str) -> Scene:
    """The scene with a game's ball, tip and stroke; effects on the cue are unchanged."""
    usual = usual_scene(scene.shaft, name)
    brought = {type(effect) for effect in usual.effects}
    staying = tuple(effect for effect in scene.effects if not effect.at_tip and type(effect) not in brought)
    return replace(usual, effects=(*usual.effects, *staying))


def value_text(key: str, shown: float, whole: Callable[[float], int] = round) -> str:
    """A number with its unit, to the digits of a slider's step, or to its own up to `DECIMALS`: "12.40 mm".

    whole: how the last digit is rounded.
    """
    known = range_of(key)
    most = DECIMALS.get(known.unit, 3)
    number = whole(10**most * known.scale * shown) / 10**most
    decimals = max(len(f"{known.step:g}".partition(".")[2]), len(f"{number:.{most}f}".rstrip("0").partition(".")[2]))
    return f"{number:.{decimals}f} {known.unit}".rstrip()


def parse(key: str, text: str, scene: Scene, last: str = "") -> float:
    """The SI number of a typed text such as "11,8", "1/4 in", "15 oz". last: see `with_unit`."""
    bare = text.strip().replace(",", ".").replace("−", "-")
    if len(text) > MAX_TEXT or not bare:
        raise ValueError(f"must be a number of at most {MAX_TEXT} characters")
    unit, unitless = range_of(key).unit, _UNITLESS.fullmatch(bare)
    if key == "offset" and not unitless:
        return _check_limits(key, Quantity("m").read(bare) / scene.ball.radius, text, scene)
    if not unit:
        return _check_limits(key, Quantity("").read(_float(bare)), text, scene)
    return _check_limits(key, Quantity(SI.get(unit, unit)).read(with_unit(key, bare, last)), text, scene)


def with_unit(key: str, text: str, last: str = "") -> str:
    """A typed text with its unit; the default is that of ``last``, the previous input, else the displayed one.

    A fraction is in inches unless it has a unit.
    """
    unit = range_of(key).unit
    if not unit or not _UNITLESS.fullmatch(text.replace(",", ".").replace("−", "-")):
        return text
    typed = split_quantity(last.replace(",", "."))[1] or unit
    if unit == "mm" and "/" in plain_fractions(text) and unit_of(typed) != unit_of("in"):
        raise ValueError(f"{text.strip()} in or {text.strip()} {typed}?")
    return f"{text} {typed}"


def _float(text: str) -> Any:
    """A bare number; the text itself if it is none."""
    try:
        return float(text)
    except ValueError:
        return text


def limits(key: str, scene: Scene) -> tuple[float, float, str]:
    """The limits of typed values, SI, and the reason of each; they depend on the cue."""
    known, cue = range_of(key), scene.shaft
    least, most, why = known.least / known.scale, known.most / known.scale, ""
    if key == "bore_width" and (bore := Layout.of(cue).bore):
        narrow = min(min(cue.segments[i].tip_diameter, cue.segments[i].butt_diameter) for i in bore)
        most, why = narrow - 2 * MIN_WALL, f"a wall of {1e3 * MIN_WALL:g} mm in {1e3 * narrow:.2f} mm"
    elif key == "bore_depth":
        most, why = max_bore_depth(cue), f"to the end, from {1e3 * bore_mouth(cue):.0f} mm behind the tip"
    elif key == "dome":
        least, why = max(least, scene.tip_diameter / 2), f"half of the tip's {1e3 * scene.tip_diameter:.2f} mm"
    return least, most, why


def _check_limits(key: str, new: float, text: str, scene: Scene) -> float:
    least, most, why = limits(key, scene)
    if math.isnan(new) or not least * (1 - 1e-9) <= new <= most * (1 + 1e-9):
        if low := not new > least:
            size, end = "small: at least", value_text(key, least, lambda x: math.ceil(x - 1e-6))
        else:
            size, end = "large: at most", value_text(key, most, lambda x: math.floor(x + 1e-6))
        reason = f" ({why})" if why and low == (key == "dome") else ""
        raise ValueError(f"{text.strip()} is too {size} {end}{reason}.")
    return new


class KnobHost(Protocol):
    """The page as a control's row uses it."""

    @property
    def step(self) -> Step:
        """The displayed step: the design, and the other one."""

    def set_knob(self, key: str, new: Any, text: str = "", *, slid: bool = False) -> None:
        """Set a control to a value; ValueError if that design is invalid."""

    def undo_redo(self, steps: int) -> None:
        """Undo (-1) or redo (1)."""


class KnobRow:
    """A control on the page: label, slider or note, field or list, and its error. short: in the list of assumptions.

    It is empty until `show` is called.
    """

    def __init__(self, key: str, page: KnobHost, *, short: bool = False) -> None:
        self.key, self.page, self.short = key, page, short
        self.knob, self.shown = KNOBS[key], ""
        self.slider: Any = None
        with ui.element("div").classes("knob").props(f'data-knob="{key}"') as self.root:
            self.label = ui.label().classes("name")
            self.note = ui.label().classes("note")
            if self.knob.range is None:
                self.root.classes("pick")
                self.field: Any = ui.select([], on_change=self._on_choice).props("outlined dense options-dense")
            else:
                if self.knob.range.high and not short:
                    self.slider = ui.element("input").classes("slide").props("type=range")
                    self.slider.on("input", self._slid, throttle=0.05, js_handler="(e) => emit(e.target.valueAsNumber)")
                    self.slider.on("keydown.ctrl.z", lambda: page.undo_redo(-1)).on(
                        "keydown.ctrl.y", lambda: page.undo_redo(1)
                    )
                self.field = ui.input().props("outlined dense autocomplete=off").classes("number")
                self.field.on("keydown.enter", lambda: self._on_input(entered=True)).on("blur", self._on_input)
            self.error = ui.label().classes("error").props("role=alert")

    def show(self) -> None:
        """Show the design's value, the other design's, and no error."""
        design, other = self.page.step.design, self.page.step.other
        mine = value(self.key, design.scene)
        self.root.set_visibility(mine is not None)
        self._fail("")
        if mine is None:
            return
        name = label(self.key, design.scene)
        self.label.set_text(name)
        _classes(self.field, "assumed", self.key in design.assumed)
        self.shown = self._text(design, mine)
        beside = None if other is None else value(self.key, other.design.scene)
        if self.knob.range is None:
            offered = options(self.key, design.scene)
            if self.field.options != offered:
                self.field.set_options(offered, value=mine)
            self.field.set_value(mine)
        else:
            self.field.set_value(self.shown)
            if self.key == "shaft_mass":
                self.field.props(f'placeholder="{"not weighed" if self.short else "weigh it"}"')
        _set_accessible_name(self.field, name)
        if self.slider is not None:
            self._place(name, mine, beside, design.scene)
        alike = other is None or _alike(mine, beside)
        self.note.set_text("" if self.short else self._note(design, mine, mine if alike else beside))
        _classes(self.note, "other", not alike)

    def _text(self, design: Design, mine: Any) -> str:
        if self.knob.range is None:
            return str(mine)
        if self.key == "shaft_mass" and not design.scene.shaft.shaft_mass_measured:
            return ""
        return design.typed.get(self.key) or value_text(self.key, mine)

    def _note(self, design: Design, mine: Any, beside: Any) -> str:
        """The note below the label: the weight, or a typed value in mm or g; and the other design's, if it differs."""
        own, there = (
            NONE if each is None else f"{each}" if self.knob.range is None else value_text(self.key, each)
            for each in (mine, beside)
        )
        plain = not self.knob.range or (not self.knob.range.unit and bool(_UNITLESS.fullmatch(self.shown)))
        note = f"= {own}" if self.key in design.typed and self.shown != own and not plain else ""
        if self.key == "shaft_mass":
            note = f"{'now' if design.scene.shaft.shaft_mass_measured else 'computed'} {own}"
        parts = [note, there] if beside != mine else [note]
        text = ", other ".join(filter(None, parts))
        return text if self.knob.range is None else re.sub(r"(?<=\d) ", "\u00a0", text)

    def _place(self, name: str, mine: float, beside: float | None, scene: Scene) -> None:
        known = range_of(self.key)
        least, most, _ = limits(self.key, scene)
        low, high = max(known.low, known.scale * least), min(known.high, known.scale * most)
        low, high = (
            known.step * f(end / known.step + e) for f, end, e in ((math.ceil, low, -1e-6), (math.floor, high, 1e-6))
        )
        at = round(known.scale * mine, 9)
        first, last = (round(end, 9) for end in (min(low, at), max(high, at)))
        spans = {"low": at, "tick": None if beside is None else known.scale * beside}
        shares = {name: (end - first) / ((last - first) or 1.0) for name, end in spans.items() if end is not None}
        style = f"--at: {shares['low']:.4f}; --tick: {shares.get('tick', -1):.4f}"
        wanted = {
            "min": first,
            "max": last,
            "step": known.step,
            "value": at,
            "style": style,
            "aria-label": f"{name}, slider",
        }
        wanted["aria-valuetext"] = value_text(self.key, mine)
        if any(self.slider.props.get(key) != own for key, own in wanted.items()):
            self.slider.props.update(wanted)
            self.slider.update()

    def _set(self, new: Any, text: str = "", *, slid: bool = False) -> None:
        try:
            self.page.set_knob(self.key, new, text, slid=slid)
        except FAILURES as error:
            self._fail(one_line(error))

    def _fail(self, words: str) -> None:
        self.error.set_text(words)
        self.error.set_visibility(bool(words))
        _classes(self.field, "wrong", bool(words))

    def _on_choice(self, event: Any) -> None:
        if event.value is not None and event.value != value(self.key, self.page.step.design.scene):
            self._set(event.value)

    def _slid(self, event: Any) -> None:
        scene = self.page.step.design.scene
        mine, known = value(self.key, scene), range_of(self.key)
        at = event.args
        if mine is not None and isinstance(at, int | float) and abs(at - known.scale * mine) > 1e-9 * known.step:
            self._set(float(f"{at / known.scale:.12g}"), slid=True)

    def _on_input(self, *_: Any, entered: bool = False) -> None:
        text, scene = str(self.field.value or "").strip(), self.page.step.design.scene
        if text == self.shown and not (entered and self.key in self.page.step.design.assumed):
            self._fail("")
            return
        if not text and self.key == "shaft_mass":
            return
        try:
            last = self.page.step.design.typed.get(self.key, "")
            new, text = parse(self.key, text, scene, last), with_unit(self.key, text, last)
        except FAILURES as error:
            words = one_line(error)
            self._fail(f"{label(self.key, scene)} {words}" if words.startswith("must ") else words)
            return
        self._set(new, text)


def _alike(mine: Any, other: Any) -> bool:
    """Whether two values are the same but for rounding."""
    numbers = isinstance(mine, float) and isinstance(other, float)
    return math.isclose(mine, other, rel_tol=1e-9) if numbers else mine == other


def _classes(element: Any, name: str, on: bool) -> None:
    element.classes(**{"add" if on else "remove": name})


def _set_accessible_name(element: Any, name: str) -> None:
    element.props(f'aria-label="{name}"')
