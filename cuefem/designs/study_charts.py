"""Charts of a study: the trade-off and each parameter of a sweep, distributions and factors of a tolerance analysis."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from cuefem.cue import Array
from cuefem.designs.evaluation import Response
from cuefem.designs.scatter import SobolIndices
from cuefem.designs.study_statistics import SweepStatistics, groups_of
from cuefem.designs.study_table import column_label
from cuefem.quantity.display_units import to_display, with_heading
from cuefem.show.charts import Axis, Chart, Curve, Dots, Tick, chart

MAX_POINTS = 2000  # designs of a chart: of more an evenly spaced part is drawn
MAX_BINS = 40  # of a histogram
HEIGHT, ROW, ROWS_END = 260.0, 22.0, 60.0  # of a chart; of a name in a chart of names, and of its axis
QUANTILES = ("5 %", "50 %", "95 %")


def sweep_charts(sweep: SweepStatistics) -> list[Chart]:
    """The trade-off, and the first response against each parameter; of a single design none."""
    if len(sweep.numbers) < 2:
        return []
    varied = [j for j, column in enumerate(sweep.values) if len(np.unique(column)) > 1]
    trade_off = [] if sweep.pair is None else [_trade_off(sweep, *sweep.pair)]
    return [*trade_off, *(_parameter_chart(sweep, j, sweep.ranked[0]) for j in varied)]


def _trade_off(sweep: SweepStatistics, first: int, second: int) -> Chart:
    """Designs by two responses, and the front."""
    x, y = (to_display(sweep.results[:, k], sweep.responses[k].display_key) for k in (second, first))
    shown, name = _shown(sweep.having(first, second))
    front = sweep.front
    return chart(
        f"Trade-off: {sweep.responses[first].label}",
        [Curve("best trade-offs (Pareto front)", x[front], y[front], "c1")],
        x=Axis(sweep.responses[second].heading, from_zero=False),
        y=Axis(sweep.responses[first].heading, from_zero=False),
        points=[Dots(name, x[shown], y[shown], "c5"), Dots("", x[front], y[front], "c1")],
        height=HEIGHT,
    )


def _shown(rows: NDArray[np.int_]) -> tuple[NDArray[np.int_], str]:
    """The rows of designs that a chart draws, and their name in the legend."""
    count = len(rows)
    if count <= MAX_POINTS:
        return rows, "designs"
    spaced = np.linspace(0, count - 1, MAX_POINTS).round().astype(int)
    return rows[spaced], f"{MAX_POINTS} of {count} designs, evenly spaced"


def _parameter_chart(sweep: SweepStatistics, j: int, k: int) -> Chart:
    """A response against a parameter, with its median at each value or range of values."""
    rows = sweep.rows[k]
    response, column, label = sweep.responses[k], sweep.values[j][rows], column_label(sweep.names[j])
    results = to_display(sweep.results[rows, k], response.display_key)
    if column.dtype.kind not in "fi":
        return _names_chart(response, label, column, results)
    values = to_display(column, sweep.units[j])
    medians = _medians(column, np.stack([values, results], axis=1))
    shown, name = _shown(np.arange(len(column)))
    is_single = len(medians) == len(column)
    return chart(
        f"{response.label} by {label}",
        [Curve("the response" if is_single else "median", medians[:, 0], medians[:, 1], "c1")],
        x=Axis(with_heading(label, sweep.units[j]), from_zero=False),
        y=Axis(response.heading, from_zero=False),
        points=[Dots(name, values[shown], results[shown], "c5")],
        height=HEIGHT,
    )


def _medians(column: np.ndarray, results: Array) -> Array:
    """Medians of results (designs, n) by groups of a column, (groups, n)."""
    group, _ = groups_of(column)
    return np.array([np.median(results[group == i], axis=0) for i in range(group.max() + 1)])


def _names_chart(response: Response, label: str, column: np.ndarray, results: Array) -> Chart:
    """A response for each name in a column, the first on top, with their medians."""
    names = [*dict.fromkeys(column.tolist())][::-1]
    rows = np.array([names.index(name) for name in column.tolist()])
    medians = _medians(rows, results[:, None])[:, 0]
    shown, name = _shown(np.arange(len(rows)))
    points = [Dots(name, results[shown], rows[shown], "c5")]
    if len(names) < len(rows):
        points.append(Dots("median", medians, np.arange(len(names)), "c1"))
    return chart(
        f"{response.label} by {label}",
        [],
        x=Axis(response.heading, from_zero=False),
        y=Axis(label, names=tuple(names)),
        points=points,
        height=ROW * len(names) + ROWS_END,
    )


def scatter_charts(
    responses: Sequence[Response],
    samples: Mapping[str, Array],
    spread: Mapping[str, Mapping[str, float]],
    drivers: SobolIndices,
) -> list[Chart]:
    """The distribution of each response, and the share of each factor in its variance.

    samples: finite responses of the two independent samples, by name.
    """
    charts = []
    for k, response in enumerate(responses):
        if response.name in spread:
            charts += [
                _histogram(response, samples[response.name], spread[response.name]),
                _factors_chart(response, drivers, k),
            ]
    return charts


def _histogram(response: Response, sample: Array, spread: Mapping[str, float]) -> Chart:
    """The share of the designs in equal intervals of a response."""
    values = to_display(sample, response.display_key)
    bins = min(MAX_BINS, len(np.histogram_bin_edges(values, "auto")) - 1)
    counts, edges = np.histogram(values, bins)
    outline = np.r_[0.0, np.repeat(100 * counts / len(values), 2), 0.0]
    marks = [Tick(float(to_display(spread[name], response.display_key)), name) for name in QUANTILES]
    return chart(
        f"Distribution: {response.label}",
        [Curve("share of the designs", np.repeat(edges, 2), outline, "c1 bars")],
        x=Axis(response.heading, from_zero=False),
        y=Axis("designs in %", 0.0),
        marks=marks,
        height=HEIGHT,
    )


def _factors_chart(response: Response, drivers: SobolIndices, k: int) -> Chart:
    """The total index of each factor with its interval, the strongest on top."""
    order = drivers.total[:, k].argsort()
    share, interval = 100 * drivers.total[order, k], 100 * drivers.total_interval[:, order, k]
    rows = np.arange(len(order))
    gaps = np.full(len(order), np.nan)
    lines = Curve("95 % interval", np.stack([*interval, gaps]).T, np.stack([rows, rows, gaps]).T, "c1")
    return chart(
        f"Factors: {response.label}",
        [lines],
        x=Axis("total share of the variance, %", 0.0),
        y=Axis("factor", names=tuple(drivers.factors[i] for i in order)),
        points=[Dots("share", share, rows, "c1")],
        height=ROW * len(order) + ROWS_END,
    )
