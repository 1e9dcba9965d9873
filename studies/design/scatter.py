"""How much do two maple pool shafts of one drawing differ, and what drives the difference?

The causes and their sources are in scatter_maple.toml: wood (E, G and density, correlated), turning by +-0.05 mm,
ferrule, leather from new to worn, ball, contact time, and with them the dome and the shear of the tip. Monte Carlo over
scrambled Sobol points; Sobol indices by Saltelli's estimators (`cuefem.design.scatter`), correlated wood as one cause.
The coupled strike at b/R = 0.3, bare, with dome and tip shear, and the whole stroke: LeatherTip, waves along the
cue, thrust on the bent shaft (scatter_leather.toml). About 90 s.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from itertools import product
from typing import Any

import numpy as np

from cuefem.design import Response, evaluate
from cuefem.design.scatter import Drivers, Scatter, drivers, spread
from cuefem.io.study_files import load_scatter
from studies import pages
from studies.measured import pool
from studies.pages import STUDIES, predictions, table

MODELS = ("bare", "dome and tip shear")
COLOURS = ("#4477aa", "#cc6644", "#228855")
SHARES = (0.05, 0.25, 0.5, 0.75, 0.95)
SCALES = {"end_mass": ("end mass, g", 1e3), "squirt": ("squirt, °", float(np.degrees(1)))}
WORDS = {
    "wood": "wood: E, G, density",
    "turning": "turning ±0.05 mm",
    "ferrule": "ferrule ±0.5 mm, density",
    "leather": "leather 4 to 8 mm, density",
    "ball": "ball 156 to 170 g",
    "contact time": "contact 0.8 to 1.5 ms",
    "dome": "dome 9 to 10.6 mm",
    "tip shear": "tip shear 0.3 to 0.75",
    "hardness and speed": "80 to 300 MPa, 1 to 4 m/s",
    "Poisson's ratio": "Poisson's ratio 0.3 to 0.45",
}
UNITS = {"m": ("mm", 1e3), "kg": ("g", 1e3), "s": ("ms", 1e3), "kg/m^3": ("kg/m3", 1), "": ("", 1)}
FULL, SAMPLE = load_scatter(STUDIES / "design" / "scatter_maple.toml")
LEATHER, LEATHER_SAMPLE = load_scatter(STUDIES / "design" / "scatter_leather.toml")
# What LeatherTip alone should say, from leather_tip.md, and the whole stroke, from dome.md, each written down before it
# was run here. Not to be changed.
PREDICTED = {
    "first cause of squirt, and its share": "wood, 55 %; whole stroke: wood, 45 %",
    "second cause, and its share": "leather's height and density, 30 %; whole stroke: the same, 35 %",
    "share of leather's E and the speed": "below 5 %; whole stroke: 8 %",
    "share of turning": "0 %; whole stroke: 0 %",
    "nine in ten of squirts, deg": "1.65 to 2.05; whole stroke: 1.65 to 2.00",
}


def bare() -> Scatter:
    """What scatters with the effects of the tip left out."""
    study = FULL.study
    kept = tuple(vary for vary in study.vary if not vary.paths[0].startswith("effects"))
    return replace(FULL, study=replace(study, base=replace(study.base, effects=()), vary=kept))


@cache
def found(model: str) -> Drivers:
    return drivers(bare() if model == "bare" else FULL, SAMPLE.count, seed=SAMPLE.seed)


def causes() -> Iterator[list[str | float]]:
    """What varies, and between which values nine in ten of it lie: of factors relative to the drawing."""
    members = {name: group for group, names in FULL.groups.items() for name in names}
    for vary in FULL.study.vary:
        unit, scale = UNITS[vary.unit(FULL.study.base)]
        how = "times the drawing's" if vary.factor else f"{unit} more" if vary.shift else unit
        ends = (float(scale * vary.range.quantile(share)) for share in (0.05, 0.95))
        yield [members.get(vary.name, ""), vary.name, *ends, how]


def spreads() -> Iterator[list[str | float]]:
    for k, (words, scale) in enumerate(SCALES.values()):
        for model in MODELS:
            sample = found(model).spread
            numbers = [sample.mean[k], sample.sd[k], *sample.quantiles(SHARES)[:, k]]
            yield [f"{words}, {model}", *(float(scale * number) for number in numbers)]


def shares(model: str) -> Iterator[list[str]]:
    """Largest share of squirt first."""
    one = found(model)
    both = ((one.first, one.first_interval), (one.total, one.total_interval))
    for i in one.total[:, 1].argsort()[::-1]:
        cells = [_share(index[i, k], ends[:, i, k]) for k in (1, 0) for index, ends in both]
        yield [one.causes[i], *cells]


def _share(value: float, ends: np.ndarray) -> str:
    low, high = 100 * ends
    return f"{100 * value:.0f} ({low:.0f} to {high:.0f})".replace("-0 ", "0 ")


def woods() -> Iterator[list[str | float]]:
    """Wood alone: as correlated as assumed, and not at all."""
    asked = (Response("end_mass"), Response("tip_stiffness"))
    study = replace(bare().study, vary=FULL.study.vary[:3], responses=asked)
    for words, correlations in (("as assumed", FULL.correlations), ("none", {})):
        sample = spread(Scatter(study, correlations), SAMPLE.count, seed=SAMPLE.seed)
        yield [words, *(100 * sample.sd / sample.mean).tolist()]


def text() -> str:
    drawn = table(["cause", "what varies", "5 %", "95 %", ""], causes())
    first = table(["of the designs lie below", "mean", "sd", *(f"{100 * share:g} %" for share in SHARES)], spreads())
    columns = ["cause", *(f"{words}: {part}" for words in ("squirt", "end mass") for part in ("alone", "in all"))]
    rest = "\n".join(f"## {model}\n\n{table(columns, shares(model))}" for model in MODELS)
    wood = table(["correlations of the wood", "end mass, sd in %", "stiffness at the tip, sd in %"], woods(), 3)
    return (
        "# Scatter of maple pool shafts\n\nOffset b/R = 0.3; the causes are those of scatter_maple.toml. Shares of "
        f"the variance are in per cent, with 95 % intervals.\n\n{drawn}\n{first}\n{rest}\n## wood alone\n\n{wood}"
    )


@cache
def leather() -> Drivers:
    """Spread and causes in the whole stroke."""
    return drivers(LEATHER, LEATHER_SAMPLE.count, seed=LEATHER_SAMPLE.seed)


def leather_spread() -> list[float]:
    """Mean, standard deviation and quantiles of squirt in the whole stroke, deg."""
    sample = leather().spread
    return [float(np.degrees(x)) for x in (sample.mean[0], sample.sd[0], *sample.quantiles(SHARES)[:, 0])]


def leather_shares() -> Iterator[list[str]]:
    """Largest share of squirt first."""
    one = leather()
    for i in one.total[:, 0].argsort()[::-1]:
        both = ((one.first, one.first_interval), (one.total, one.total_interval))
        yield [one.causes[i], *(_share(index[i, 0], ends[:, i, 0]) for index, ends in both)]


def leather_found() -> dict[str, str]:
    """What was found, by the names of PREDICTED."""
    one, spread_found = leather(), leather_spread()
    share = {name: f"{max(100 * total, 0):.0f} %" for name, total in zip(one.causes, one.total[:, 0], strict=True)}
    first, second = sorted(one.causes, key=lambda name: -one.total[one.causes.index(name), 0])[:2]
    numbers = (
        f"{first}, {share[first]}",
        f"{second}, {share[second]}",
        share["hardness and speed"],
        share["turning"],
        f"{spread_found[2]:.2f} to {spread_found[-1]:.2f}",
    )
    return dict(zip(PREDICTED, numbers, strict=True))


def leather_ends() -> dict[tuple[float, float], float]:
    """Squirt of the middle shaft, deg, by the leather's modulus, Pa, and the speed, m/s, at the ends of both."""
    study = LEATHER.study
    middle = [vary.range.quantile(0.5) for vary in study.vary]
    i, j = ([vary.name for vary in study.vary].index(name) for name in ("leather's E", "speed"))
    ends = list(product(*(map(study.vary[k].range.quantile, (0.0, 1.0)) for k in (i, j))))
    scenes = [study.scene((*middle[:i], E, *middle[i + 1 : j], U, *middle[j + 1 :])) for E, U in ends]
    squirts = evaluate(scenes, study.responses, at=study.resolution).values[:, 0]
    return {end: float(np.degrees(squirt)) for end, squirt in zip(ends, squirts, strict=True)}


def leather_text() -> str:
    """The end of the page: the whole stroke."""
    columns = ["of the designs lie below", "mean", "sd", *(f"{100 * share:g} %" for share in SHARES)]
    runs = len(leather().causes) + 2
    said = [f"{squirt:.2f}° at {E / 1e6:.0f} MPa and {U:g} m/s" for (E, U), squirt in leather_ends().items()]
    return (
        "## LeatherTip\n\nThe whole stroke: LeatherTip, waves along the cue and the thrust on the bent shaft. Its "
        "causes are those of scatter_leather.toml: the leather's modulus and the speed of the stroke in the "
        f"place of the contact time, Poisson's ratio in that of the shear. {runs * LEATHER_SAMPLE.count} strikes, "
        "fewer than above, so the intervals are wider. Of hardness and speed it is the hardness that counts. The "
        f"middle shaft squirts {', '.join(said)}.\n\n"
        f"{table(columns, [[f'squirt, °, {pool.MODERN}', *leather_spread()]])}\n"
        f"{table(['cause', 'squirt: alone', 'squirt: in all'], leather_shares())}\n"
        + predictions(PREDICTED, leather_found())
    )


def draw(axes: Any) -> None:
    for k, (axis, (words, scale)) in enumerate(zip(axes[0], SCALES.values(), strict=False)):
        samples = {model: scale * found(model).spread.responses[:, k] for model in MODELS}
        if k:
            samples[pool.MODERN] = scale * leather().spread.responses[:, 0]
        _histograms(axis, samples)
        axis.set(xlabel=words.replace(",", " at b/R 0.3,") if k else words, ylabel="part of the shafts and strokes")
    handles, labels = axes[0, 1].get_legend_handles_labels()
    axes[0, 2].legend(handles, labels, loc="center", title="dashed: median; shaded: nine in ten")
    axes[0, 2].set_axis_off()
    for axis, model, colour in zip(axes[1], MODELS, COLOURS, strict=False):
        _bars(axis, found(model), 1, model, colour)
    _bars(axes[1, 2], leather(), 0, pool.MODERN, COLOURS[2])


def _histograms(axis: Any, samples: dict[str, np.ndarray]) -> None:
    bins = np.linspace(min(map(np.min, samples.values())), max(map(np.max, samples.values())), 24)
    for (model, sample), colour in zip(samples.items(), COLOURS, strict=False):
        low, middle, high = np.quantile(sample, (0.05, 0.5, 0.95))
        weights = np.full(len(sample), 1 / len(sample))
        axis.hist(sample, bins, weights=weights, histtype="stepfilled", alpha=0.3, color=colour, label=model)
        axis.hist(sample, bins, weights=weights, histtype="step", color=colour)
        axis.axvspan(low, high, color=colour, alpha=0.06)
        axis.axvline(middle, color=colour, linestyle="--", linewidth=1)


def _bars(axis: Any, one: Drivers, k: int, model: str, colour: str) -> None:
    order = one.total[:, k].argsort()
    share, ends = 100 * one.total[order, k], 100 * one.total_interval[:, order, k]
    names = [WORDS[one.causes[i]] for i in order]
    names = [name.replace(": ", ":\n").replace(" MPa, ", " MPa,\n").replace(" mm, ", " mm,\n") for name in names]
    axis.barh(names, share, color=colour, alpha=0.6, xerr=np.abs(ends - share), ecolor="#333333", capsize=3)
    axis.set(title=f"squirt, {model}", xlabel="share of squirt's variance, %", xlim=(0, 100))
    axis.tick_params(axis="y", labelsize=8)
    axis.grid(visible=False, axis="y")


STUDY = pages.Study(
    __file__,
    lambda: pages.paragraphs(text(), leather_text()),
    {"scatter.svg": pages.Figure(draw, (2, 3), (13, 7.2))},
    again={
        # Two rows of spreads; a heading, a head and the rows of causes.
        "bare": pages.Again(text, until=pages.LEATHER, left_out=7 + len(FULL.causes), instead={"MODELS": MODELS[:1]}),
        "LeatherTip": pages.Again(leather_text, since=pages.LEATHER),
    },
    predicted=PREDICTED,
)


if __name__ == "__main__":
    STUDY.write()
