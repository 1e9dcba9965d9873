"""Sensitivity of a strike to each physical effect: the scene without each of its effects, and with each other one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import MISSING, asdict, dataclass, fields, replace

from cuefem.analysis.strike_models import regime_warning
from cuefem.contact.refinement import RTOL, refinement_levels
from cuefem.contact.strike import strike, strike_modes
from cuefem.effects.effect import Effect, effect_kinds
from cuefem.endmass.definitions import equivalent_end_mass
from cuefem.quantity.display_units import format_change, number_text, with_heading
from cuefem.results.progress import Progress
from cuefem.results.quantities import DASH, format_value
from cuefem.results.records import Record, Table
from cuefem.scene import Outcome, Scene, check_scene
from cuefem.scene.solved_scene import corrected_tip_modes
from cuefem.show.analysis import Analysis, Rows
from cuefem.show.scene_summary import effect_text, stroke_line

DEFAULT_RTOL = 1e-2
# The numerical error of the strikes is the tolerance over this.
MARGIN = 3


@dataclass(frozen=True)
class EffectSensitivity(Rows, Analysis):
    """Change of a strike by removing each effect of a scene and by adding each other one.

    Parameters
    ----------
    scene : Scene
        The analysed stroke.
    rtol : float
        Relative change of squirt, ball speed or spin from which an effect is significant.
    modes : int or None
        Number of modes of all strikes; None for a lumped cue.
    base : dict
        "squirt", rad; "end_mass", the squirt-equivalent one, kg, or None; "ball_speed", m/s; "spin", rad/s; "regime",
        as `Outcome.regime`, of the scene.
    effects : list of dict
        For each effect, the largest change first: "name", "values", "label"; "is_listed", whether the scene has it and
        the strike is without it; "failure", why it was not tried, or None; the results as of ``base``; "change", by
        result "absolute" and "relative"; "largest_change", relative; and whether it is "significant".
    recommendation : dict
        Labels of the effects to keep, to remove and to add: "effects_to_keep", "effects_to_remove", "effects_to_add".
    """

    rtol: float
    modes: int | None
    base: Record
    effects: list[Record]
    recommendation: dict[str, list[str]]

    def frame_rows(self) -> list[Record]:
        """The unmodified scene, then a row for each effect."""
        whole = self.base
        return [{"name": "", "is_listed": None} | whole] + [
            {key: value for key, value in row.items() if key not in ("values", "label", "change")}
            for row in self.effects
        ]

    def tables(self) -> list[Table | str]:
        """A row for each effect, the largest change first; the recommendation in the notes."""
        percent = f"{100 * self.rtol:.3g} %"
        base, tried = self.base, [row for row in self.effects if not row["failure"]]
        small = [row for row in tried if not row["significant"]]
        squirt, mass = format_value("squirt", base["squirt"]), format_value("end_mass", base["end_mass"])
        first = ("unmodified scene", squirt, mass, number_text(base["ball_speed"], "m/s", decimals=4))
        rows: list[tuple[str, ...]] = [(*first, f"{base['spin']:.2f}")]
        rows += [_cells(row) for row in tried if row["significant"]]
        significant = len(rows)
        if small:  # a row of its own, since a terminal may have no styles
            rows += [(f"changes less than {percent}:", *[""] * 4), *map(_cells, small)]
        table = Table(
            f"Sensitivity to each effect at offset b/R = {self.scene.stroke.offset:.4g}",
            ("", "squirt", "end mass", with_heading("ball speed", "m/s"), with_heading("spin", "rad/s")),
            tuple(rows),
            (
                "without: this effect removed; with: an effect that is not listed added, at a default value; %: change "
                "from the first row",
                f"end mass: of the lumped cue with the same squirt; {percent}: the tolerance of squirt, ball speed and "
                "spin",
                *filter(None, [regime_warning(base["regime"])]),
                *_not_tried(self.effects),
                stroke_line(self.scene),
                "",
                *self.recommendation_text(),
            ),
            styles={0: "bold"} | dict.fromkeys(range(significant, len(rows)), "dim"),
        )
        return [table]

    def recommendation_text(self) -> list[str]:
        """The recommendation as sentences."""
        names, percent = self.recommendation, f"{100 * self.rtol:.3g} %"
        lines = []
        if names["effects_to_remove"]:
            removed = ", ".join(names["effects_to_remove"])
            lines.append(f"Negligible, removing each changes less than {percent}: {removed}.")
        if names["effects_to_add"]:
            lines.append(f"Missing, each changes {percent} or more: {', '.join(names['effects_to_add'])}.")
        return lines or [f"At a tolerance of {percent} no listed effect is negligible and no unlisted effect matters."]


def effect_sensitivity(scene: Scene, rtol: float | None = None, *, progress: Progress = iter) -> EffectSensitivity:
    """Sensitivity of a strike to the physical effects: each of the scene removed, each other one added.

    All strikes have the resolution that the unmodified scene needs, so that discretisation errors cancel. An effect is
    significant if squirt, ball speed or spin changes by at least rtol, relative ([accuracy] of a scene's file, default
    1e-2).

    Parameters
    ----------
    scene : Scene
        A stroke.
    rtol : float, optional
        Relative change of squirt, ball speed or spin from which an effect is significant; 1e-2 by default.
    progress : callable, optional
        Wraps the list of effects, to show progress.

    Returns
    -------
    EffectSensitivity
        Show it with ``print``, in a notebook, or by ``.save("effects.html")``.

    Examples
    --------
    >>> import cuefem as cf
    >>> cue = cf.LumpedCue(mass=0.54, end_mass=0.006)
    >>> found = cf.effect_sensitivity(cf.Scene(cue, stroke=cf.Stroke(offset=0.3), effects=(cf.RollingContact(),)))
    >>> found.recommendation["effects_to_keep"], round(1e3 * found.base["end_mass"], 1)
    (['RollingContact'], 6.2)
    """
    check_scene("effect_sensitivity scene", scene)
    rtol = DEFAULT_RTOL if rtol is None else RTOL.check("effect_sensitivity rtol", rtol)
    modes = None
    if scene.lumped is None:
        *_, level = refinement_levels(scene, rtol / MARGIN)
        modes = level.modes
    base = _strike_at(scene, modes)
    rows = [_row(variant, scene, base, rtol=rtol, modes=modes) for variant in progress(variants(scene))]
    rows.sort(key=lambda row: -1.0 if row["largest_change"] is None else row["largest_change"], reverse=True)
    return EffectSensitivity(
        scene,
        rtol=rtol,
        modes=modes,
        base=_results(base, scene),
        effects=rows,
        recommendation=recommendation(rows),
    )


def _strike_at(scene: Scene, modes: int | None) -> Outcome:
    """Strike with a number of modes and a truncation correction. modes: None for a lumped cue."""
    return strike(scene) if modes is None else strike_modes(scene, *corrected_tip_modes(scene, modes))


def _results(outcome: Outcome, scene: Scene) -> Record:
    return {
        "squirt": outcome.squirt,
        "end_mass": _end_mass(outcome, scene),
        "ball_speed": outcome.ball_speed,
        "spin": outcome.spin,
        "regime": outcome.regime,
    }


def _end_mass(outcome: Outcome, scene: Scene) -> float | None:
    """Squirt-equivalent end mass, kg; None at offset 0, in a miscue, and if no lumped cue has this squirt."""
    try:
        return equivalent_end_mass(outcome, scene) if scene.stroke.offset else None
    except ValueError:
        return None


def _row(variant: Variant, scene: Scene, base: Outcome, *, rtol: float, modes: int | None) -> Record:
    about: Record = {
        "name": variant.name,
        "values": None if variant.effect is None else asdict(variant.effect),
        "label": variant.name if variant.effect is None else effect_text(variant.effect),
        "is_listed": variant.is_listed,
    }
    if variant.scene is None:
        return about | _failed(variant.reason)
    try:
        outcome = _strike_at(variant.scene, modes)
    except (ValueError, RuntimeError) as error:
        return about | _failed(str(error))
    changes = _changes(outcome, base, scene.stroke.offset)
    largest = max(abs(each["relative"]) for each in changes.values() if each["relative"] is not None)
    return about | {
        "failure": None,
        **_results(outcome, variant.scene),
        "change": changes,
        "largest_change": largest,
        "significant": largest >= rtol,
    }


def _failed(reason: str) -> Record:
    return {"failure": reason, "largest_change": None, "significant": None}


def _changes(outcome: Outcome, base: Outcome, offset: float) -> dict[str, Record]:
    """Changes from the outcome of a scene to that of a variant: absolute, and relative, positive where a size grows.

    At the centre, squirt and spin are zero by symmetry and have no relative change.
    """
    changes = {}
    for name in ("squirt", "ball_speed", "spin"):
        has_value = bool(offset) or name == "ball_speed"
        own = float(getattr(base, name))
        change = float(getattr(outcome, name)) - own if has_value else 0.0
        changes[name] = {"absolute": change, "relative": _relative(change, own) if has_value else None}
    return changes


def recommendation(rows: Sequence[Record]) -> Record:
    """Labels of the effects to keep, to remove and to add, those with the largest change first."""
    tried = [row for row in rows if row["failure"] is None]

    def labels(listed: bool, significant: bool) -> list[str]:
        return [row["label"] for row in tried if (row["is_listed"], row["significant"]) == (listed, significant)]

    cases = {"keep": (True, True), "remove": (True, False), "add": (False, True)}
    return {f"effects_to_{verb}": labels(*case) for verb, case in cases.items()}


def _not_tried(rows: Sequence[Record]) -> list[str]:
    """The effects that failed, grouped by reason."""
    reasons: dict[str, list[str]] = {}
    for row in rows:
        if row["failure"]:
            reasons.setdefault(row["failure"], []).append(row["label"])
    return [f"not tried: {', '.join(names)}: {reason}" for reason, names in reasons.items()]


def _cells(row: Record) -> tuple[str, ...]:
    word = "without" if row["is_listed"] else "with"
    squirt, speed, spin = (_percent(row["change"][name]["relative"]) for name in ("squirt", "ball_speed", "spin"))
    miscue = ": miscue" if row["regime"] == "miscue" else ""
    return (f"{word} {row['label']}{miscue}", squirt, format_value("end_mass", row["end_mass"]), speed, spin)


def _percent(part: float | None) -> str:
    if part is None:
        return DASH
    return format_change(100 * part, 2, "%")


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


def _relative(change: float, value: float) -> float:
    return 0.0 if change == 0 else change / value if value else float("inf")
