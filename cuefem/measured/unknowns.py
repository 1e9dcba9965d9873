"""What a drawing leaves open: the wood, the bore, the tip; each with a prior that its source bounds.

The prior of a positive number is lognormal about the drawing's value. Its spread, the standard deviation of the
logarithm, comes from the table of materials where that has a range (which spans one standard deviation either way), and
from the file of a documented cue where that gives one.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Annotated, Any, NamedTuple

from cuefem.cue import Segment
from cuefem.effects import LeatherTip
from cuefem.materials import MATERIALS
from cuefem.measured.kinds import Measurement, Setup, Squirt
from cuefem.quantity import Quantity, check_fields
from cuefem.scene import Scene
from cuefem.tap.matching import main_material, with_material

MODEL_OF_SQUIRT = 0.1  # relative, one for all squirts: what the law of the shrinking patch is worth (leather_tip.md)
ZERO, SQUIRT_MODEL = "zero", "squirt model"


@dataclass(frozen=True)
class Unknown:
    """A number that is not known: its value in the drawing, and its prior.

    spread: standard deviation of its logarithm; of the number itself, in its unit, if ``plain``. put: a setup with
    another value.
    """

    name: str
    words: str
    unit: str
    usual: float
    spread: float
    put: Callable[[Setup, float], Setup] = field(repr=False)
    plain: bool = False

    def value(self, z: float) -> float:
        """Its value ``z`` standard deviations of the prior from the usual one."""
        return self.usual + z * self.spread if self.plain else self.usual * math.exp(z * self.spread)

    def setup(self, setup: Setup, z: float) -> Setup:
        """The setup with that value."""
        return self.put(setup, self.value(z))


@dataclass(frozen=True)
class Prior:
    """What a file says of an unknown: its spread, or a low and a high value, one standard deviation either way."""

    name: str
    spread: Annotated[float | None, Quantity("", "[0, 3]")] = None
    low: float | None = None
    high: float | None = None

    def __post_init__(self) -> None:
        check_fields(self)
        if self.name not in NAMES:
            raise ValueError(f"Prior.name must be one of {', '.join(NAMES)}; got {self.name!r}")
        ends = (self.low is None) + (self.high is None)
        if ends == 1 or (ends == 0) == (self.spread is not None):
            raise ValueError("Prior.spread must be given, a relative one, or low and high without it")
        if self.low is not None and self.high is not None and not 0 < self.low < self.high:
            raise ValueError(f"Prior.low must be in (0, high); got low {self.low:g} and high {self.high:g}")


class Kind(NamedTuple):
    """A kind of unknown: words, unit, its value in a scene (None: there is none), its spread, how it is changed.

    always: whether it is open unless a file closes it.
    """

    words: str
    unit: str
    of: Callable[[Scene], float | None]
    spread: Callable[[Scene], float]
    put: Callable[[Scene, float], Scene]
    always: bool = True


def _wood_spread(name: str) -> Callable[[Scene], float]:
    def spread(scene: Scene) -> float:
        wood = main_material(scene.shaft)
        known = next((one for one in MATERIALS.values() if one.material == wood), MATERIALS["hard maple"])
        low, high = known.ranges[name]
        return math.log(high / low) / 2

    return spread


def _put_wood(name: str) -> Callable[[Scene, float], Scene]:
    def put(scene: Scene, value: float) -> Scene:
        cue = scene.shaft
        wood = main_material(cue)
        return replace(scene, cue=with_material(cue, wood, replace(wood, **{name: value})))

    return put


def _wood(words: str, name: str, unit: str) -> Kind:
    return Kind(
        words, unit, lambda scene: getattr(main_material(scene.shaft), name), _wood_spread(name), _put_wood(name)
    )


def _bored(segment: Segment) -> bool:
    return segment.core is None and segment.tip_bore > 0


def _bore(scene: Scene) -> float | None:
    return next((segment.tip_bore for segment in scene.shaft.segments if _bored(segment)), None)


def _put_bore(scene: Scene, value: float) -> Scene:
    usual = _bore(scene)
    assert usual is not None
    f = value / usual
    segments = (
        replace(s, tip_bore=f * s.tip_bore, butt_bore=f * s.butt_bore) if _bored(s) else s for s in scene.shaft.segments
    )
    return replace(scene, cue=replace(scene.shaft, segments=tuple(segments)))


def _growth(scene: Scene) -> float | None:
    first, last = scene.shaft.segments[0], scene.shaft.segments[-1]
    return last.butt_diameter - first.tip_diameter if last.butt_diameter > first.tip_diameter else None


def _put_growth(scene: Scene, value: float) -> Scene:
    usual, d0 = _growth(scene), scene.shaft.segments[0].tip_diameter
    assert usual is not None
    f = value / usual
    segments = (
        replace(s, tip_diameter=d0 + f * (s.tip_diameter - d0), butt_diameter=d0 + f * (s.butt_diameter - d0))
        for s in scene.shaft.segments
    )
    return replace(scene, cue=replace(scene.shaft, segments=tuple(segments)))


def _tip(words: str, name: str, unit: str, spread: float) -> Kind:
    """A field of the whole tip."""

    def of(scene: Scene) -> float | None:
        if scene.contact_terms.tip is None:
            return None
        value = float(getattr(scene.leather, name))
        return value if math.isfinite(value) else None

    def put(scene: Scene, value: float) -> Scene:
        old: LeatherTip = scene.leather
        given: dict[str, Any] = {name: value}
        new = replace(old, **given)
        return replace(scene, effects=tuple(new if effect is old else effect for effect in scene.effects))

    return Kind(words, unit, of, lambda _: spread, put)


def _time(scene: Scene) -> float | None:
    return None if scene.contact_terms.tip is not None else float(scene.contact_time)


def _put_time(scene: Scene, value: float) -> Scene:
    return replace(scene, tip=replace(scene.tip, contact_time=value, stiffness=None))


_LOW, _HIGH = MATERIALS["leather"].ranges["E"]
KINDS: dict[str, Kind] = {
    "E": _wood("E of the wood", "E", "Pa"),
    "G": _wood("G of the wood", "G", "Pa"),
    "rho": _wood("density of the wood", "rho", "kg/m^3"),
    "bore": Kind("diameter of the bore", "m", _bore, lambda _: math.log(7.5 / 6) / 2, _put_bore),  # meshes/README.md
    "taper": Kind("diameter gained to the joint", "m", _growth, lambda _: 0.1, _put_growth, always=False),
    "leather": _tip("E of the leather", "E", "Pa", math.log(_HIGH / _LOW) / 2),
    "tip height": _tip("height of the tip", "height", "m", 0.1),
    "dome": _tip("radius of the dome", "dome_radius", "m", 0.1),  # a dime's 8.95 to a nickel's 10.6 mm
    "contact time": Kind("contact time", "s", _time, lambda _: 0.1, _put_time),  # leather 1.0 to 1.2 ms
}
NAMES = (*KINDS, SQUIRT_MODEL)


def unknowns_of(scene: Scene, found: Sequence[Measurement], priors: Sequence[Prior] = ()) -> tuple[Unknown, ...]:
    """What is open in a documented cue: the usual unknowns, those of the file, and what its measurements bring along.

    ValueError if a prior is of something that the scene does not have.
    """
    said = {prior.name: prior for prior in priors}
    made = []
    for name, kind in KINDS.items():
        usual = kind.of(scene)
        if usual is None:
            if name in said:
                raise ValueError(f"unknowns must be of this cue; got {name!r}, which it does not have")
            continue
        if kind.always or name in said:
            middle, spread = _prior(said.get(name), usual, kind.spread(scene))
            made.append(Unknown(name, kind.words, kind.unit, middle, spread, _on_scene(kind.put)))
    squirts = [one for one in found if isinstance(one, Squirt)]
    _, spread = _prior(said.get(SQUIRT_MODEL), 1.0, MODEL_OF_SQUIRT)
    if squirts:
        put: Any = lambda setup, value: setup._replace(squirt_factor=value)  # noqa: E731
        made.append(Unknown(SQUIRT_MODEL, "true squirt over the model's", "", 1.0, spread, put))
    series: dict[str, float] = {}
    for one in squirts:
        if one.zero_error is not None:
            series[one.series] = max(one.zero_error, series.get(one.series, 0.0))
    for name, error in series.items():
        words = f"zero of the offset{', ' + name if name else ''}"
        made.append(Unknown(f"{ZERO} {name}".strip(), words, "m", 0.0, error, _zero(name), plain=True))
    return tuple(unknown for unknown in made if unknown.spread > 0)


def _prior(said: Prior | None, usual: float, spread: float) -> tuple[float, float]:
    """Middle and spread."""
    if said is None:
        return usual, spread
    if said.low is not None and said.high is not None:
        return math.sqrt(said.low * said.high), math.log(said.high / said.low) / 2
    assert said.spread is not None
    return usual, said.spread


def _on_scene(put: Callable[[Scene, float], Scene]) -> Callable[[Setup, float], Setup]:
    return lambda setup, value: setup._replace(scene=put(setup.scene, value))


def _zero(name: str) -> Callable[[Setup, float], Setup]:
    return lambda setup, value: setup._replace(zeros={**setup.zeros, name: value})
