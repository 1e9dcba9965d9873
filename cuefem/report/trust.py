"""How far the numbers of a page can be trusted: the solver's error is small, and the model's is told beside it."""

from __future__ import annotations

from cuefem.scene import Scene

# Root mean square of the differences from seven measured strokes; handbook: Measured squirt.
LEATHER_OFF, SPRING_OFF = "24 %", "20 to 25 %"
SOLVED = "0.5 %"  # of squirt at the default resolution
LAW = (
    "The tip is taken as elastic leather, by its height, its dome and its stiffness E. The force that such a tip makes "
    "is known to 0.5 % in most cases and to 2.5 % at worst; that a real tip behaves so is assumed. Nobody has "
    "measured yet whether squirt depends on a tip's hardness as little as is computed here."
)
SPRING = (
    "The tip is taken as a spring that presses for the contact time that is given. No real tip was measured for it, "
    "and squirt changes with it: for a bare tip by half of itself from 0.7 to 2 ms."
)
COMPARING = (
    "Differences between two designs are safer than the degrees of one: a low-deflection shaft was measured with 0.72 "
    "of the squirt of a maple shaft, and the model says 0.67 to 0.74. Measured strokes squirted less than computed "
    "more often than not. The numbers are in the handbook, in the chapter Measured squirt."
)


def off(scene: Scene) -> str:
    """How far the model of this scene's tip was off from measured squirt."""
    return LEATHER_OFF if scene.contact_terms.tip is not None else SPRING_OFF


def trust_line(scene: Scene) -> str:
    """Both errors in a sentence."""
    return (
        f"Squirt is computed to {SOLVED} of what the model says; the model itself was off by {off(scene)} from seven "
        "strokes that were measured on real cues."
    )


def trust_lines(scene: Scene) -> tuple[str, ...]:
    """What stands behind the model's error, in sentences."""
    return (LAW if scene.contact_terms.tip is not None else SPRING, COMPARING)
