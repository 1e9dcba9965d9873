"""What a file leaves out and the defaults supply, in words for whoever reads the result."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path
from typing import Any

from cuefem.io.profile import DEFAULT_MATERIAL, DEFAULT_UNIT, SHAPES, SURFACES
from cuefem.io.toml import read_tables
from cuefem.scene import DEFAULT_CONTACT_TIME, Ball, Stroke, Tip


def assumed(path: Path, given: Collection[str]) -> list[str]:
    """What a loaded cue or scene file leaves to defaults. given: options said besides, such as "offset"."""
    found = read_tables(path) if path.suffix.lower() == ".toml" else {}
    if "cue" not in found:
        return _profile(path, given, " (choose with --material)")
    cue = found["cue"]
    return [*(_profile(path.parent / cue, given) if isinstance(cue, str) else []), *_tables(found, given)]


def _profile(path: Path, given: Collection[str], choose: str = "") -> list[str]:
    """What a lathe profile or a surface cannot say: its unit, its material, and what is screwed to the shaft."""
    if path.suffix.lower() not in SHAPES:
        return []
    lengths = path.suffix.lower() in SURFACES and "length_unit" not in given
    unit = f"lengths in {DEFAULT_UNIT}{choose and ' (--length-unit gives another)'}"
    return [
        *([unit] if lengths else []),
        *(_fit(path) if path.suffix.lower() in SURFACES else []),
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


def _tables(found: dict[str, Any], given: Collection[str]) -> list[str]:
    """What a scene's tables leave out."""
    ball, tip, stroke = (found.get(name, {}) for name in ("ball", "tip", "stroke"))
    timed = {"contact_time", "stiffness"} & {*tip, *given}
    known = (
        ("mass" in ball, f"ball {1e3 * Ball().mass:g} g"),
        ("radius" in ball, f"ball diameter {2e3 * Ball().radius:g} mm"),
        (bool(timed), f"contact time {1e3 * DEFAULT_CONTACT_TIME:g} ms"),
        ("restitution" in tip, f"e {Tip().restitution:g}"),
        ("friction" in tip, f"mu {Tip().friction:g}"),
        ("speed" in stroke, f"stroke {Stroke().speed:g} m/s"),
        ("offset" in stroke or "offset" in given, f"offset b/R {Stroke().offset:g}"),
    )
    return [words for said, words in known if not said]
