"""Random shafts without their butt, each with a game, an offset and a dome; no tests."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

import cuefem as cf
from cuefem.cue.materials import MATERIALS
from cuefem.scene.default_scene import GAMES

MM = 1e-3
LENGTH, TAPER = 0.7366, 0.33  # m


@dataclass(frozen=True)
class RandomShaft:
    """A drawing, and the options of the commands with it: game, offset b/R, and radius of the dome, m."""

    cue: cf.Cue
    game: str
    offset: float
    dome: float

    @property
    def options(self) -> tuple[str, ...]:
        """The options of a command."""
        return "--game", self.game, "--offset", repr(self.offset), "--dome", self.dome_text

    @property
    def dome_text(self) -> str:
        """The radius of the dome with its unit, or "flat"."""
        return "flat" if np.isinf(self.dome) else f"{self.dome / MM!r} mm"


def random_shaft(seed: int) -> RandomShaft:
    """The shaft of a seed: a front of 8.5 to 14 mm, bores anywhere, steps, a ferrule, a dome from d/2 to flat."""
    rng = np.random.default_rng(seed)
    front, joint = rng.uniform(8.5, 14) * MM, rng.uniform(18, 23) * MM
    wood = MATERIALS[str(rng.choice(["hard maple", "ash", "purpleheart"]))].material
    ferrule = float(rng.uniform(5, 25)) * MM if rng.random() < 0.6 else 0.0
    bore = _bore(rng, front, ferrule)
    ends = sorted({0.0, ferrule, *(x for start, stop, _ in bore for x in (start, stop)), TAPER, LENGTH})
    step = rng.uniform(0, 0.3) * MM if rng.random() < 0.3 else 0.0  # of the diameter, at the taper's begin
    diameters = np.interp(ends, [0.0, TAPER, LENGTH], [front, front + rng.uniform(0, 1) * MM, joint])
    segments = []
    for i, (start, stop) in enumerate(pairwise(ends)):
        outer = float(diameters[i]) + (step if start == TAPER else 0.0), float(diameters[i + 1])
        width = next((width for first, last, width in bore if first <= start < last), 0.0)
        if stop <= ferrule:
            tenon = 0.62 * min(outer)
            segments.append(cf.Segment(stop - start, *outer, MATERIALS["melamine"].material, tenon, tenon, core=wood))
        else:
            segments.append(cf.Segment(stop - start, *outer, wood, width, width))
    offset = round(float(rng.uniform(0.05, 0.45) * rng.choice([-1, 1])), 4)
    flatter = rng.uniform(0.5, 1.5) if rng.random() < 0.9 else np.inf
    return RandomShaft(cf.Cue(tuple(segments)), str(rng.choice([*GAMES])), offset, round(float(front * flatter), 7))


def _bore(rng: np.random.Generator, front: float, ferrule: float) -> list[tuple[float, float, float]]:
    """Start, end and width of up to two bores behind the ferrule, m; the second may follow the first, in a step."""
    if rng.random() < 0.3:
        return []
    start = ferrule if rng.random() < 0.5 else float(rng.uniform(ferrule, 0.2))
    first = start, start + float(rng.uniform(0.02, 0.1)), float(rng.uniform(2, 7)) * MM
    if rng.random() < 0.6:
        return [first]
    begin = first[1] if rng.random() < 0.5 else first[1] + float(rng.uniform(0.01, 0.1))
    return [first, (begin, begin + float(rng.uniform(0.02, 0.1)), float(rng.uniform(2, 7)) * MM)]
