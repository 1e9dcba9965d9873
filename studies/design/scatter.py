"""How much do two maple pool shafts of one drawing differ, and which inputs cause the difference?

The default stroke of pool at b/R 0.3 and 2 m/s with the inputs of scatter_leather.toml (ranges and sources there) drawn
at random: wood (E, G and density, correlated), turning by 0.05 mm, ferrule, leather from new to worn and from soft to
hard, speed, ball. `cuefem study` gives the same numbers.
"""

from __future__ import annotations

import textwrap
from functools import cache
from typing import Any

import numpy as np

import cuefem as cf
from cuefem.designs.scatter import Scatter, ScatterResult
from cuefem.designs.study_file import load_study
from studies import pages
from studies.pages import table

CAUSES = {  # what the factors of the file are, in full
    "wood": "wood: E, G, density",
    "turning": "turning, ±0.05 mm",
    "ferrule": "ferrule, ±0.5 mm, density",
    "leather": "leather, 4 to 8 mm high, density",
    "hardness and speed": "hardness, 80 to 300 MPa, and speed, 1 to 4 m/s",
    "ball": "ball, 156 to 170 g",
    "dome": "dome, 8.95 to 10.6 mm",
    "Poisson's ratio": "Poisson's ratio of the leather, 0.3 to 0.45",
}


@cache
def result() -> ScatterResult:
    """The study of the file."""
    definition = load_study(pages.STUDIES / "design" / "scatter_leather.toml")
    assert isinstance(definition, Scatter)
    return cf.study(definition)


def squirts() -> np.ndarray:
    """Squirt of the independent designs, degrees."""
    return np.degrees(result().finite_samples["squirt"])


def shares() -> dict[str, float]:
    """Share of the variance that a cause makes, alone and with others, %; the largest first."""
    indices = result().sobol_indices
    parts = dict(zip(indices.factors, 100 * indices.total[:, 0], strict=True))
    return {CAUSES[factor]: share for factor, share in sorted(parts.items(), key=lambda item: -item[1])}


def text() -> str:
    low, middle, high = np.quantile(squirts(), (0.05, 0.5, 0.95))
    parts = [f"{cause.split(',')[0].split(':')[0]} {share:.0f} %" for cause, share in list(shares().items())[:3]]
    return pages.page(
        "Tolerance analysis of maple pool shafts",
        "How much do two maple pool shafts of one drawing differ in squirt, and why?",
        f"Squirt of 90 % of the strokes is {low:.2f} to {high:.2f}° (median {middle:.2f}°, standard deviation "
        f"{np.std(squirts()):.2f}°). Causes of the variance: {', '.join(parts)}. Turning to 0.05 mm contributes "
        "nothing.",
        f"Default stroke of pool at b/R 0.3; {result().count} strikes, so the standard error of a share is "
        "about 10 % of the variance. The shares are total Sobol indices: they include interactions with other causes, "
        "and their sum exceeds 100 %. `cuefem study studies/design/scatter_leather.toml` prints them with intervals.",
        table(["cause", "share of the variance, %"], [[cause, f"{share:.0f}"] for cause, share in shares().items()]),
    )


def draw(panels: Any) -> None:
    """The spread, and the shares."""
    left, right = panels
    left.hist(squirts(), 20)
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
