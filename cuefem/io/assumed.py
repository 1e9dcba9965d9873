"""What a file leaves out and the defaults supply, in words for whoever reads the result."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path
from typing import Any

from cuefem.effects import effect_kinds
from cuefem.io.profile import DEFAULT_MATERIAL, DEFAULT_UNIT, SHAPES, SURFACES, profile_notes
from cuefem.io.toml import read_tables
from cuefem.scene import DEFAULT_CONTACT_TIME, Ball, Stroke, Tip

SHORTER = "; about 1 ms is usual"  # a pool ball's, measured; 2 ms is [Kim]'s


def assumed(path: Path, given: Collection[str], *, offered: Collection[str] = (), blow: bool = True) -> list[str]:
    """What a loaded cue or scene file leaves to defaults.

    given: the options that were given as well, such as "offset". offered: all options that the command has. blow:
    whether ball, tip and stroke count.
    """
    found = read_tables(path) if path.suffix.lower() == ".toml" else {}
    if "cue" not in found:
        return _profile(path, given, " (choose with --material)")
    cue = found["cue"]
    shaft = _profile(path.parent / cue, given) if isinstance(cue, str) else []
    return [*shaft, *(assumed_blow(found, given, offered=offered) if blow else [])]


def _profile(path: Path, given: Collection[str], choose: str = "") -> list[str]:
    """What a lathe profile or a surface cannot say: its unit, its material, and what is screwed to the shaft."""
    if path.suffix.lower() not in SHAPES:
        return []
    lengths = path.suffix.lower() in SURFACES and "length_unit" not in given
    unit = f"lengths in {DEFAULT_UNIT}{choose and ' (--length-unit gives another)'}"
    return [
        *([unit] if lengths else []),
        *(_fit(path) if path.suffix.lower() in SURFACES else profile_notes(path)),
        *([] if "material" in given else [f"material {DEFAULT_MATERIAL}{choose}"]),
        *([] if "body_mass" in given else ["no mass behind the shaft (--body-mass gives it)"]),
    ]


def _fit(path: Path) -> list[str]:
    """How near a surface's segments keep to it, and how far its facets leave the round form open."""
    from cuefem.io.surface import read_surface

    found = read_surface(path)
    fit, corners = found.fit / found.widest, 2 * found.facets / found.widest
    count = len(found.pieces)
    return [
        f"{count} conical segment{'s' if count > 1 else ''}, diameters within {max(fit, 1e-9):.0e} of the widest",
        f"facets round (their corners lie up to {corners:.0e} of the widest diameter further out)",
        "the thinner end is the tip",
    ]


def assumed_blow(
    found: dict[str, Any], given: Collection[str], *, offered: Collection[str], offset: float | None = None
) -> list[str]:
    """What a scene's tables leave out of ball, tip and stroke. offset: of a cue alone, which has no tables."""
    ball, tip, stroke = (found.get(name, {}) for name in ("ball", "tip", "stroke"))
    grams, across = f"{1e3 * Ball().mass:g} g", f"{2e3 * Ball().radius:g} mm"
    neither = not {"mass", "radius"} & {*ball}
    effects = (effect_kinds().get(str(effect.get("type"))) for effect in found.get("effects", ()))
    timed = {"contact_time", "stiffness"} & {*tip, *given} or any(kind and kind.whole_tip for kind in effects)
    option = "--offset or " if "offset" in offered else ""
    head_on = f" (head on: {option}[stroke] offset gives another)" if offset is None else ""
    known = (
        ("ball" in given or not neither, f"carom ball {grams}, {across}{_option('ball', offered)}"),
        ("ball" in given or neither or "mass" in ball, f"ball {grams}"),
        ("ball" in given or neither or "radius" in ball, f"ball diameter {across}"),
        (bool(timed), f"contact time {1e3 * DEFAULT_CONTACT_TIME:g} ms{_option('contact_time', offered, SHORTER)}"),
        ("restitution" in tip, f"e {Tip().restitution:g}"),
        ("friction" in tip, f"mu {Tip().friction:g}"),
        ("speed" in stroke, f"stroke {Stroke().speed:g} m/s"),
        ("offset" in stroke or "offset" in given, f"offset b/R {offset or Stroke().offset:g}{head_on}"),
    )
    return [words for said, words in known if not said]


def _option(name: str, offered: Collection[str], more: str = "") -> str:
    """The option that gives another value, if the command has it."""
    return f" (--{name.replace('_', '-')}{more})" if name in offered else ""
