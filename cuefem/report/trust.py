"""What the model's error rests on, in sentences; its size is in `cuefem.results.uncertainty`."""

from __future__ import annotations

from cuefem.scene import Scene

LAW = (
    "The tip is modelled as elastic leather of given height, dome and E. Its compliance is that of the elastic solid "
    "to 0.3 % (95 % of contacts; at worst 1.1 %); the model has not been tested on real tips. Computed squirt changes "
    "by 6 % from soft to hard leather; players find no difference, to ±5 % at best. Do not choose a tip's hardness by "
    "this number."
)
SPRING = (
    "The tip is modelled as a linear spring with the given contact time. No real tip was measured for it, and squirt "
    "depends on it: for a spring tip without dome and shear by 50 % from 0.7 to 2 ms."
)
COMPARING = (
    "A ratio of two designs is more accurate than the squirt of one: a low-deflection shaft was measured with 0.72 "
    "of the squirt of a maple shaft; the model computes 0.70 to 0.78 (handbook: Measured squirt)."
)


def trust_lines(scene: Scene) -> tuple[str, ...]:
    """What stands behind the model's error, in sentences."""
    return (LAW if scene.contact_terms.tip is not None else SPRING, COMPARING)
