"""What the model's error rests on, in sentences; its size is in `cuefem.results.uncertainty`."""

from __future__ import annotations

from cuefem.scene import Scene

LAW = (
    "The tip is taken as elastic leather, by its height, its dome and its stiffness E. The force that such a tip makes "
    "is known to 0.5 % in most cases and to 2.5 % at worst; that a real tip behaves so is assumed. Computed "
    "squirt changes by 6 % from soft to hard leather, and players find no difference, to ±5 % at best: do not choose "
    "a tip's hardness by this number."
)
SPRING = (
    "The tip is taken as a spring that presses for the contact time that is given. No real tip was measured for it, "
    "and squirt changes with it: for a bare tip by half of itself from 0.7 to 2 ms."
)
COMPARING = (
    "Differences between two designs are safer than the degrees of one: a low-deflection shaft was measured with 0.72 "
    "of the squirt of a maple shaft, and the model says 0.70 to 0.78. The numbers are in the handbook, in the chapter "
    "Measured squirt."
)


def trust_lines(scene: Scene) -> tuple[str, ...]:
    """What stands behind the model's error, in sentences."""
    return (LAW if scene.contact_terms.tip is not None else SPRING, COMPARING)
