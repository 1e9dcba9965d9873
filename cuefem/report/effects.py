"""What each effect of a scene changes, as a record and as a sheet."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict

from cuefem.contact.strike import strike, strike_modes
from cuefem.design.worth import Change, Variant, change, variants
from cuefem.endmass.definitions import equivalent_end_mass
from cuefem.report.scene_words import assumptions, effect_words
from cuefem.results.convergence import levels
from cuefem.results.quantities import NONE, degrees, grams
from cuefem.results.records import Record, Sheet
from cuefem.scene import Outcome, Resolution, Scene
from cuefem.scene.solved_scene import ended_tip_modes

DEFAULT_RTOL = 1e-2
# Strikes are this many times as exact as the tolerance.
MARGIN = 3

Track = Callable[[Sequence[Variant]], Iterable[Variant]]


def struck(scene: Scene, at: Resolution | None) -> Outcome:
    """A scene's strike with as many modes as a resolution has, ended by a tail; None for a lumped cue."""
    return strike(scene) if at is None else strike_modes(scene, ended_tip_modes(scene, at.modes))


def effects_record(scene: Scene, *, rtol: float = DEFAULT_RTOL, track: Track = iter) -> Record:
    """Every effect dropped or added, what that changes, and which matter at the tolerance ``rtol``.

    All strikes are at the resolution that the scene itself needs, so that their errors are alike and it is the effect
    that shows. track: follows the work, an iterator over the variants.
    """
    at = None
    if scene.lumped is None:
        *_, level = levels(scene, rtol / MARGIN)
        at = level.at
    base = struck(scene, at)
    rows = [_row(variant, scene, base, rtol=rtol, at=at) for variant in track(variants(scene))]
    rows.sort(key=lambda row: -1.0 if row["weight"] is None else row["weight"], reverse=True)
    return {
        "rtol": rtol,
        "resolution": None if at is None else asdict(at),
        "base": _figures(base, scene),
        "effects": rows,
        "worth": worth(rows),
    }


def _figures(outcome: Outcome, scene: Scene) -> Record:
    return {
        "squirt": outcome.squirt,
        "end_mass": _end_mass(outcome, scene),
        "ball_speed": outcome.ball_speed,
        "spin": outcome.spin,
    }


def _end_mass(outcome: Outcome, scene: Scene) -> float | None:
    """The squirt-equivalent end mass; None head on, in a miscue, and if no lumped cue has that squirt."""
    try:
        return equivalent_end_mass(outcome, scene) if scene.stroke.offset else None
    except ValueError:
        return None


def _row(variant: Variant, scene: Scene, base: Outcome, *, rtol: float, at: Resolution | None) -> Record:
    about: Record = {
        "name": variant.name,
        "values": None if variant.effect is None else asdict(variant.effect),
        "words": variant.name if variant.effect is None else effect_words(variant.effect),
        "listed": variant.listed,
    }
    if variant.scene is None:
        return about | _refused(variant.reason)
    try:
        outcome = struck(variant.scene, at)
    except (ValueError, RuntimeError) as error:
        return about | _refused(str(error))
    changed = change(outcome, base, offset=scene.stroke.offset)
    return about | {
        "refused": None,
        **_figures(outcome, variant.scene),
        "change": _changes(changed),
        "weight": changed.weight,
        "matters": changed.weight >= rtol,
    }


def _refused(reason: str) -> Record:
    return {"refused": reason, "weight": None, "matters": None}


def _changes(changed: Change) -> Record:
    gaps = asdict(changed)
    relative = gaps.pop("relative")
    return {name: {"by": gap, "relative": relative.get(name)} for name, gap in gaps.items()}


def worth(rows: Sequence[Record]) -> Record:
    """Which effects to keep, which to drop, and which to add, by name, in the order of what they change."""
    tried = [row for row in rows if row["refused"] is None]

    def chosen(listed: bool, matters: bool) -> list[str]:
        return [row["words"] for row in tried if (row["listed"], row["matters"]) == (listed, matters)]

    return {"keep": chosen(True, True), "drop": chosen(True, False), "add": chosen(False, True)}


def effects_sheet(record: Record, scene: Record) -> Sheet:
    """The effects, what matters most first, and what to make of it."""
    percent = f"{100 * record['rtol']:.3g} %"
    base, tried = record["base"], [row for row in record["effects"] if not row["refused"]]
    small = [row for row in tried if not row["matters"]]
    first = ("unmodified scene", degrees(base["squirt"]), grams(base["end_mass"]), f"{base['ball_speed']:.4f}")
    rows: list[tuple[str, ...]] = [(*first, f"{base['spin']:.2f}")]
    rows += [_cells(row) for row in tried if row["matters"]]
    dim = range(len(rows), len(rows) + len(small) + 1)
    if small:  # a row and no style alone says so, also where colours are not
        rows += [(f"changes less than {percent}:", *[""] * 4), *map(_cells, small)]
    return Sheet(
        f"Sensitivity to each effect at offset b/R = {scene['stroke']['offset']:.4g}",
        ("", "squirt", "end mass", "ball speed, m/s", "spin, rad/s"),
        tuple(rows),
        (
            "without: this effect removed; with: an effect that is not listed added, at a default value; %: change "
            "from the first row",
            f"end mass: of the lumped cue with the same squirt; {percent}: the tolerance of squirt, ball speed and "
            "spin",
            *_not_tried(record["effects"]),
            assumptions(scene),
            "",
            *advice(record, percent),
        ),
        styles={0: "bold"} | dict.fromkeys(dim, "dim"),
    )


def _not_tried(rows: Sequence[Record]) -> list[str]:
    """Why effects were not tried, each reason once."""
    reasons: dict[str, list[str]] = {}
    for row in rows:
        if row["refused"]:
            reasons.setdefault(row["refused"], []).append(row["words"])
    return [f"not tried: {', '.join(names)}: {reason}" for reason, names in reasons.items()]


def _cells(row: Record) -> tuple[str, ...]:
    word = "without" if row["listed"] else "with"
    squirt, speed, spin = (_percent(row["change"][name]["relative"]) for name in ("squirt", "ball_speed", "spin"))
    return (f"{word} {row['words']}", squirt, grams(row["end_mass"]), speed, spin)


def _percent(part: float | None) -> str:
    if part is None:
        return NONE
    return "0 %" if abs(part) < 5e-6 else f"{100 * part:+.3f} %" if abs(part) < 1e-3 else f"{100 * part:+.2f} %"


def advice(record: Record, percent: str) -> list[str]:
    """The recommendation, in sentences."""
    found = record["worth"]
    lines = []
    if found["drop"]:
        lines.append(f"Negligible, removing each changes less than {percent}: {', '.join(found['drop'])}.")
    if found["add"]:
        lines.append(f"Missing, each changes {percent} or more: {', '.join(found['add'])}.")
    return lines or [f"At a tolerance of {percent} no listed effect is negligible and no unlisted effect matters."]
