"""Random lathe profiles of plausible shafts and cues, and slips in them; no tests."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Profile = tuple[list[float], list[float]]  # positions and diameters, m
SLIPS = (1e-3, 1e-2, 0.1, 10.0, 100.0, 1e3, 25.4, 1 / 25.4)  # a decimal point, or the other system of units
FRONTS = {"pool": (11.5, 13.2), "carom": (10.5, 12.5), "snooker": (8.0, 10.2)}  # mm


def random_profile(seed: int) -> Profile:
    """The profile of a seed: two rows to 400, with any of ferrule step, collar, dome, chamfer, bumper and noise."""
    rng = np.random.default_rng(seed)
    front = rng.uniform(*FRONTS[str(rng.choice([*FRONTS]))])
    is_whole_cue = rng.random() < 0.2
    length, end = (rng.uniform(1420, 1490), rng.uniform(28, 34)) if is_whole_cue else (rng.uniform(650, 790), 21)
    end = end if is_whole_cue else rng.uniform(18, 23)
    taper = rng.uniform(0.2, 0.55) * length
    corners = ([0.0, taper, length], [front, front + rng.uniform(0, 1.0), end])
    if rng.random() < 0.3:  # one cone
        corners = ([0.0, length], [front, end])
    x = _positions(rng, corners[0], length)
    d = np.interp(x, *corners)
    if rng.random() < 0.3:
        x, d = _with_step(x, d, at=rng.uniform(8, 30), ratio=rng.uniform(0.9, 1.02))
    if rng.random() < 0.3:
        x, d = _with_step(x, d, at=length - rng.uniform(10, 40), ratio=1 / rng.uniform(1.0, 1.5), is_behind=True)
    d = d + rng.normal(0, 0.02, len(d)) * (rng.random() < 0.5)
    if rng.random() < 0.3:
        x, d = _with_dome(x, d, rows=int(rng.integers(2, 9)))
    if rng.random() < 0.3:
        x, d = _with_chamfer(x, d, depth=rng.uniform(0.5, 4.0), width=rng.uniform(0.3, 0.9))
    return [float(each) * 1e-3 for each in x], [float(each) * 1e-3 for each in d]


def _positions(rng: np.random.Generator, corners: Sequence[float], length: float) -> NDArray[np.float64]:
    """Positions of rows, mm: the corners alone, a tape measure's, or those of a machine."""
    count = int(rng.choice([0, 3, 6, 12, 30, 100, 400]))
    return np.unique([*corners, *np.round(rng.uniform(0, length, count), 1)])


def _with_step(
    x: NDArray[np.float64], d: NDArray[np.float64], *, at: float, ratio: float, is_behind: bool = False
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The profile with a ferrule or a collar that ends or begins in a step, two rows at one position."""
    here = float(np.interp(at, x, d))
    inside = x > at if is_behind else x < at
    scaled = np.where(inside, d / ratio if is_behind else d * ratio, d)
    two = [here, here / ratio] if is_behind else [here * ratio, here]
    place = int(np.searchsorted(x, at))
    return np.insert(x, place, [at, at]), np.insert(scaled, place, two)


def _with_dome(
    x: NDArray[np.float64], d: NDArray[np.float64], *, rows: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The profile behind a tip drawn with its dome, of the radius of a nickel."""
    radius = max(10.6, d[0] / 2)
    height = radius - np.sqrt(radius**2 - (d[0] / 2) ** 2)
    down = np.linspace(0, height, rows + 1)[:-1]
    widths = 2 * np.sqrt(np.maximum(radius**2 - (radius - down) ** 2, 0.05**2))
    return np.append(down, x + height + 4.0), np.append(np.minimum(widths, d[0]), d)


def _with_chamfer(
    x: NDArray[np.float64], d: NDArray[np.float64], *, depth: float, width: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The profile whose last millimetres fall to a part of the width."""
    return np.append(x, x[-1] + depth), np.append(d, width * d[-1])
