"""Effect sensitivity: the scene without each of its effects, and with each other effect, one at a time."""

from __future__ import annotations

from dataclasses import MISSING, dataclass, fields, replace
from typing import Any

from cuefem.effects.effect import Effect, effect_kinds
from cuefem.scene import Outcome, Scene

# Effects without a default describe an individual cue, such as a point mass.
NO_DEFAULT_VALUE = "no default value"


@dataclass(frozen=True)
class Variant:
    """A scene that differs by one effect.

    name: of the effect. effect: the one removed or added; None if it has no default. is_listed: whether the scene lists
    it. scene: the other scene; None if it is invalid; reason: why.
    """

    name: str
    effect: Effect | None
    is_listed: bool
    scene: Scene | None
    reason: str = ""


def variants(scene: Scene) -> tuple[Variant, ...]:
    """The scene without each of its effects, then with each other kind of effect, at typical values.

    A kind without typical values (`Effect.trial_values`) is added at its defaults, if every field has one.
    """
    removed = [_without(scene, i) for i in range(len(scene.effects))]
    names = {type(effect).__name__ for effect in scene.effects}
    return (*removed, *(_with(scene, name, kind) for name, kind in effect_kinds().items() if name not in names))


def _without(scene: Scene, index: int) -> Variant:
    effect = scene.effects[index]
    others = scene.effects[:index] + scene.effects[index + 1 :]
    return Variant(type(effect).__name__, effect, True, replace(scene, effects=others))


def _with(scene: Scene, name: str, kind: type[Effect]) -> Variant:
    if kind.trial_values is None and any(field.default is MISSING for field in fields(kind)):
        return Variant(name, None, False, None, NO_DEFAULT_VALUE)
    effect = kind(**(kind.trial_values.values if kind.trial_values else {}))
    try:
        return Variant(name, effect, False, replace(scene, effects=(*scene.effects, effect)))
    except ValueError as error:  # incompatible with this cue or with another effect
        return Variant(name, effect, False, None, _reason(scene, effect, error))


def _reason(scene: Scene, effect: Effect, error: ValueError) -> str:
    """Why the effect cannot be added, without an index in the list of effects."""
    name = type(effect).__name__
    if effect.needs_beam and not scene.cue.segments:
        return "requires a cue of segments"
    others = [other for other in scene.effects if name in other.excludes or type(other).__name__ in effect.excludes]
    if others:
        return f"is incompatible with {', '.join(type(other).__name__ for other in others)}"
    return str(error).replace(f"Scene.effects[{len(scene.effects)}]", name)


@dataclass(frozen=True)
class OutcomeChange:
    """Change of a strike, variant minus scene: squirt, rad; ball_speed, m/s; spin, rad/s; and relative to the scene's
    own, by the same names, positive where its size increases. At the centre, squirt and spin are zero by symmetry and
    omitted."""

    squirt: float
    ball_speed: float
    spin: float
    relative: dict[str, float]

    @property
    def max_relative(self) -> float:
        """The largest of the relative changes."""
        return max(map(abs, self.relative.values()))


def outcome_change(outcome: Outcome, base: Outcome, *, offset: Any) -> OutcomeChange:
    """The change from the outcome ``base`` of a scene to that of a variant, at ``offset`` b/R."""
    names = ("squirt", "ball_speed", "spin") if offset else ("ball_speed",)
    changes = dict.fromkeys(("squirt", "ball_speed", "spin"), 0.0)
    changes |= {name: float(getattr(outcome, name) - getattr(base, name)) for name in names}
    return OutcomeChange(**changes, relative={n: _relative(changes[n], float(getattr(base, n))) for n in names})


def _relative(change: float, value: float) -> float:
    return 0.0 if change == 0 else change / value if value else float("inf")
