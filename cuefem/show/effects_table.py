"""Sensitivity of a strike to each physical effect, removed or added: record and table of `cuefem effects`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict

from cuefem.contact.strike import strike, strike_modes
from cuefem.designs.effect_sensitivity import OutcomeChange, Variant, outcome_change, variants
from cuefem.endmass.definitions import equivalent_end_mass
from cuefem.results.convergence import refinement_levels
from cuefem.results.quantities import DASH, format_value
from cuefem.results.records import Record, Table
from cuefem.scene import Outcome, Scene
from cuefem.scene.solved_scene import corrected_tip_modes
from cuefem.show.scene_summary import assumptions, effect_text

DEFAULT_RTOL = 1e-2
# The numerical error of the strikes is the tolerance over this.
MARGIN = 3

Progress = Callable[[Sequence[Variant]], Iterable[Variant]]


def strike_at(scene: Scene, modes: int | None) -> Outcome:
    """Strike with a number of modes and a truncation correction. modes: None for a lumped cue."""
    return strike(scene) if modes is None else strike_modes(scene, corrected_tip_modes(scene, modes))


def effects_record(scene: Scene, *, rtol: float = DEFAULT_RTOL, progress: Progress = iter) -> Record:
    """Change of the strike by removing or adding each effect, and whether it exceeds the relative tolerance ``rtol``.

    All strikes have the resolution that the unmodified scene needs, so that discretisation errors cancel. progress:
    iterates over the variants with a progress bar.
    """
    modes = None
    if scene.lumped is None:
        *_, level = refinement_levels(scene, rtol / MARGIN)
        modes = level.modes
    base = strike_at(scene, modes)
    rows = [_row(variant, scene, base, rtol=rtol, modes=modes) for variant in progress(variants(scene))]
    rows.sort(key=lambda row: -1.0 if row["largest_change"] is None else row["largest_change"], reverse=True)
    return {
        "rtol": rtol,
        "modes": modes,
        "base": _results(base, scene),
        "effects": rows,
        "recommendation": recommendation(rows),
    }


def _results(outcome: Outcome, scene: Scene) -> Record:
    return {
        "squirt": outcome.squirt,
        "end_mass": _end_mass(outcome, scene),
        "ball_speed": outcome.ball_speed,
        "spin": outcome.spin,
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
        outcome = strike_at(variant.scene, modes)
    except (ValueError, RuntimeError) as error:
        return about | _failed(str(error))
    changed = outcome_change(outcome, base, offset=scene.stroke.offset)
    return about | {
        "failure": None,
        **_results(outcome, variant.scene),
        "change": _changes(changed),
        "largest_change": changed.max_relative,
        "significant": changed.max_relative >= rtol,
    }


def _failed(reason: str) -> Record:
    return {"failure": reason, "largest_change": None, "significant": None}


def _changes(changed: OutcomeChange) -> Record:
    absolute = asdict(changed)
    relative = absolute.pop("relative")
    return {
        name: {"absolute": outcome_change, "relative": relative.get(name)} for name, outcome_change in absolute.items()
    }


def recommendation(rows: Sequence[Record]) -> Record:
    """Labels of the effects to keep, to remove and to add, those with the largest change first."""
    tried = [row for row in rows if row["failure"] is None]

    def labels(listed: bool, significant: bool) -> list[str]:
        return [row["label"] for row in tried if (row["is_listed"], row["significant"]) == (listed, significant)]

    cases = {"keep": (True, True), "remove": (True, False), "add": (False, True)}
    return {f"effects_to_{verb}": labels(*case) for verb, case in cases.items()}


def tabulate_effects(record: Record, scene: Record) -> Table:
    """A row for each effect, the largest change first; the recommendation in the notes."""
    percent = f"{100 * record['rtol']:.3g} %"
    base, tried = record["base"], [row for row in record["effects"] if not row["failure"]]
    small = [row for row in tried if not row["significant"]]
    squirt, mass = format_value("squirt", base["squirt"]), format_value("mass", base["end_mass"])
    first = ("unmodified scene", squirt, mass, f"{base['ball_speed']:.4f}")
    rows: list[tuple[str, ...]] = [(*first, f"{base['spin']:.2f}")]
    rows += [_cells(row) for row in tried if row["significant"]]
    dim = range(len(rows), len(rows) + len(small) + 1)
    if small:  # a row of its own, since a terminal may have no styles
        rows += [(f"changes less than {percent}:", *[""] * 4), *map(_cells, small)]
    return Table(
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
            *recommendation_text(record, percent),
        ),
        styles={0: "bold"} | dict.fromkeys(dim, "dim"),
    )


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
    return (f"{word} {row['label']}", squirt, format_value("mass", row["end_mass"]), speed, spin)


def _percent(part: float | None) -> str:
    if part is None:
        return DASH
    return "0 %" if abs(part) < 5e-6 else f"{100 * part:+.3f} %" if abs(part) < 1e-3 else f"{100 * part:+.2f} %"


def recommendation_text(record: Record, percent: str) -> list[str]:
    """The recommendation as sentences."""
    names = record["recommendation"]
    lines = []
    if names["effects_to_remove"]:
        lines.append(f"Negligible, removing each changes less than {percent}: {', '.join(names['effects_to_remove'])}.")
    if names["effects_to_add"]:
        lines.append(f"Missing, each changes {percent} or more: {', '.join(names['effects_to_add'])}.")
    return lines or [f"At a tolerance of {percent} no listed effect is negligible and no unlisted effect matters."]
