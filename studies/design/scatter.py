"""How much do two maple pool shafts of one drawing differ, and which inputs cause the difference?

The default stroke of pool at b/R 0.3 and 2 m/s with 16 inputs drawn at random (ranges and sources:
scatter_leather.toml): wood (E, G and density, correlated), turning by 0.05 mm, ferrule, leather from new to worn and
from soft to hard, speed, ball. Sobol' points; total indices of variance by Jansen's estimator, correlated wood as one
cause.
"""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
from scipy.stats import norm, qmc

import cuefem as cf
from studies import pages, strokes
from studies.pages import table

COUNT, SEED = 64, 1
CAUSES = {  # columns of the drawn points
    "wood: E, G, density": (0, 1, 2),
    "turning, ±0.05 mm": (3, 4, 5),
    "ferrule, ±0.5 mm, density": (6, 7),
    "leather, 4 to 8 mm high, density": (8, 9),
    "hardness, 80 to 300 MPa, and speed, 1 to 4 m/s": (10, 11),
    "ball, 156 to 170 g": (12,),
    "dome, 8.95 to 10.6 mm": (13,),
    "Poisson's ratio of the leather, 0.3 to 0.45": (14,),
}
DIMENSIONS = 15
WOOD = np.linalg.cholesky([[1, 0.3, 0.32], [0.3, 1, 0.3], [0.32, 0.3, 1]])  # of E, G and density: estimates


def scene(point: Sequence[float]) -> cf.Scene:
    """The stroke of a point of the unit cube."""
    E, G, rho = np.exp([0.22, 0.15, 0.10] * (WOOD @ norm.ppf(point[:3])))  # [FPL] tables 5-6, 5-11
    at = np.asarray(point)
    tip, first, second = 0.05e-3 * (2 * at[3:6] - 1)
    longer, density = 0.5e-3 * (2 * at[6] - 1), 1400 + 120 * at[7]
    leather = {"height": 4e-3 + 4e-3 * at[8], "rho": 850 + 250 * at[9], "E": 80e6 * (300 / 80) ** at[10]}
    leather |= {"dome_radius": 8.95e-3 + 1.65e-3 * at[13], "nu": 0.3 + 0.15 * at[14]}
    base = strokes.full_model(strokes.cue("pool_maple"), 0.3, 1 + 3 * at[11], **leather)

    def grown(wood: cf.Material) -> cf.Material:
        return replace(wood, E=E * wood.E, G=G * wood.G, rho=rho * wood.rho)

    ferrule, front, middle, *back = base.shaft.segments
    ferrule = replace(
        ferrule,
        length=ferrule.length + longer,
        tip_diameter=ferrule.tip_diameter + tip,
        butt_diameter=ferrule.butt_diameter + tip,
        material=replace(ferrule.material, rho=density),
        core=grown(ferrule.core) if ferrule.core else None,
    )
    front = replace(
        front,
        length=front.length - longer,
        tip_diameter=front.tip_diameter + tip,
        butt_diameter=front.butt_diameter + first,
        material=grown(front.material),
    )
    middle = replace(
        middle,
        tip_diameter=middle.tip_diameter + first,
        butt_diameter=middle.butt_diameter + second,
        material=grown(middle.material),
    )
    butt = replace(back[0], tip_diameter=back[0].tip_diameter + second, material=grown(back[0].material))
    cue = replace(base.shaft, segments=(ferrule, front, middle, butt, *back[1:]))
    return replace(base, cue=cue, ball=replace(base.ball, mass=0.156 + 0.014 * at[12]))


@cache
def samples() -> tuple[np.ndarray, np.ndarray, dict[str, np.ndarray]]:
    """Squirt, deg, of points A, of points B, and of A with one cause from B."""
    both = qmc.Sobol(2 * DIMENSIONS, seed=SEED).random(COUNT)
    A, B = both[:, :DIMENSIONS], both[:, DIMENSIONS:]

    def squirts(points: np.ndarray) -> np.ndarray:
        return np.degrees(cf.batch_strike([scene(point) for point in points]).squirt)

    mixed = {}
    for cause, columns in CAUSES.items():
        points = A.copy()
        points[:, columns] = B[:, columns]
        mixed[cause] = squirts(points)
    return squirts(A), squirts(B), mixed


@cache
def shares() -> dict[str, float]:
    """Share of the variance that a cause makes, alone and with others, %."""
    a, b, mixed = samples()
    variance = np.var(np.r_[a, b])
    parts = {cause: float(100 * np.mean((a - ab) ** 2) / 2 / variance) for cause, ab in mixed.items()}
    return dict(sorted(parts.items(), key=lambda item: -item[1]))


def text() -> str:
    squirts = np.concatenate([*samples()[:2]])
    low, middle, high = np.quantile(squirts, (0.05, 0.5, 0.95))
    parts = [f"{cause.split(',')[0].split(':')[0]} {share:.0f} %" for cause, share in list(shares().items())[:3]]
    return pages.page(
        "Tolerance analysis of maple pool shafts",
        "How much do two maple pool shafts of one drawing differ in squirt, and why?",
        f"Squirt of 90 % of the strokes is {low:.2f} to {high:.2f}° (median {middle:.2f}°, standard deviation "
        f"{np.std(squirts):.2f}°). Causes of the variance: {', '.join(parts)}. Turning to 0.05 mm contributes nothing.",
        f"Default stroke of pool at b/R 0.3; {COUNT * (len(CAUSES) + 2)} strikes, so the standard error of a share is "
        "about 10 % of the variance. The shares are total Sobol indices: they include interactions with other causes, "
        "and their sum exceeds 100 %.",
        table(["cause", "share of the variance, %"], [[cause, f"{share:.0f}"] for cause, share in shares().items()]),
    )


def draw(panels: Any) -> None:
    """The spread, and the shares."""
    left, right = panels
    left.hist(np.concatenate([*samples()[:2]]), 20)
    left.set(xlabel="squirt at b/R 0.3, degrees", ylabel="shafts and strokes")
    names = [textwrap.fill(cause, 26) for cause in shares()][::-1]
    right.barh(names, list(shares().values())[::-1])
    right.set(xlabel="share of the variance, %")


EXAMPLE = """\
import numpy as np
from dataclasses import replace
import cuefem as cf

scene = cf.load_scene("meshes/pool_maple.toml")
speeds = np.random.default_rng(1).uniform(1.0, 4.0, 20)
squirt = cf.batch_strike([replace(scene, stroke=cf.Stroke(speed, 0.3)) for speed in speeds]).squirt
print(f"by the speed alone: {np.degrees(squirt.mean()):.2f} ± {np.degrees(squirt.std()):.2f} degrees")
"""
STUDY = pages.Study(__file__, text, {"scatter.svg": pages.Figure(draw, (1, 2), (10, 4))}, example=EXAMPLE)

if __name__ == "__main__":
    STUDY.write()
