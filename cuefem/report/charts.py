"""The page's figures as geometry: where lines, ticks and labels stand in a drawing's own units.

A drawing is WIDE units wide. The template draws it; texts are sized by the page, so that they stay readable on a phone.

A chart must be there in print, in a mail that runs no script, and for a screen reader, so that it is drawn here. A
charting library would draw each a second time (uPlot with 50 kB in every report, ECharts with 600 kB); what it would
add is the values under the pointer, and `charts.js` reads these off the drawing.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

WIDE = 440.0


class Tick(NamedTuple):
    """A place on an axis, in its units or in those of the drawing, and what stands there."""

    at: float
    label: str


class Curve(NamedTuple):
    """A named line of a chart through points in the axes' units; nan breaks it. style: its class on the page."""

    name: str
    x: ArrayLike
    y: ArrayLike
    style: str


class Shade(NamedTuple):
    """A part of the x axis that is shaded, from ``start`` to ``end`` in its units; style: its class on the page."""

    start: float
    end: float
    style: str


@dataclass(frozen=True)
class Axis:
    """An axis: what it measures, and its ends in those units (None: fitted to the data)."""

    label: str
    low: float | None = None
    high: float | None = None

    def over(self, values: Sequence[ArrayLike]) -> Scale:
        """The axis over these values; ends that are not given are set to round numbers."""
        all_values = np.concatenate([np.ravel(np.asarray(v, float)) for v in values])
        finite = all_values[np.isfinite(all_values)]
        low = float(finite.min(initial=0.0)) if self.low is None else self.low
        high = float(finite.max(initial=0.0)) if self.high is None else self.high
        if high <= low:
            high = low + 1.0
        step = round_step(high - low)
        low = step * math.floor(low / step + 1e-9) if self.low is None else low
        high = step * math.ceil(high / step - 1e-9) if self.high is None else high
        return Scale(low, high, step)


class Scale(NamedTuple):
    """An axis with numbers: its ends and the step of its ticks."""

    low: float
    high: float
    step: float

    def place(self, value: Any, first: float, last: float) -> Any:
        """Where a value stands between ``first`` and ``last``."""
        return first + (np.asarray(value, float) - self.low) / (self.high - self.low) * (last - first)

    def ticks(self, first: float, last: float) -> tuple[Tick, ...]:
        """Every round number between the ends."""
        count = range(math.ceil(self.low / self.step - 1e-9), math.floor(self.high / self.step + 1e-9) + 1)
        decimals = max(0, -math.floor(math.log10(self.step) + 1e-9))
        return tuple(
            Tick(float(self.place(i * self.step, first, last)), f"{i * self.step:.{decimals}f}") for i in count
        )


def round_step(length: float, most: int = 6) -> float:
    """The smallest step of 1, 2 or 5 times a power of ten that divides a length into at most so many parts."""
    power = 10.0 ** math.floor(math.log10(length / most))
    return next(power * factor for factor in (1, 2, 5, 10) if length / (power * factor) <= most + 1e-9)


def path(x: ArrayLike, y: ArrayLike) -> str:
    """Points as an SVG path to a hundredth of a unit, interrupted where they are not numbers."""
    pieces, begun = [], False
    for a, b in zip(np.ravel(np.asarray(x, float)), np.ravel(np.asarray(y, float)), strict=True):
        if math.isfinite(a) and math.isfinite(b):
            pieces.append(f"{'L' if begun else 'M'}{a:.2f} {b:.2f}")
        begun = math.isfinite(a) and math.isfinite(b)
    return "".join(pieces)


@dataclass(frozen=True)
class Chart:
    """Curves over axes, ready to draw: see the module."""

    title: str
    x_label: str
    y_label: str
    height: float
    box: tuple[float, float, float, float]  # left, top, right, bottom of the plot
    x_ticks: tuple[Tick, ...]
    y_ticks: tuple[Tick, ...]
    curves: tuple[tuple[str, str, str], ...]  # name, style, path
    spans: tuple[tuple[float, float, str], ...]  # left, right, style
    marks: tuple[Tick, ...]
    labels: tuple[Tick, ...]  # of the marks, moved apart
    across: Scale
    up: Scale


def chart(
    title: str,
    curves: Sequence[Curve],
    *,
    x: Axis,
    y: Axis,
    spans: Sequence[Shade] = (),
    marks: Sequence[Tick] = (),
    height: float = 260.0,
) -> Chart:
    """A chart of curves; what lies beyond the axes' ends is cut off."""
    left, top, right, bottom = 50.0, 22.0 if marks else 10.0, WIDE - 8, height - 36
    across = x.over([curve.x for curve in curves])
    up = y.over([curve.y for curve in curves])
    lines = tuple(Tick(float(across.place(mark.at, left, right)), mark.label) for mark in marks)
    return Chart(
        title,
        x.label,
        y.label,
        height,
        (left, top, right, bottom),
        across.ticks(left, right),
        up.ticks(bottom, top),
        tuple(
            (c.name, c.style, path(across.place(c.x, left, right), _within(up, c.y, bottom=bottom, top=top)))
            for c in curves
        ),
        tuple((*across.place((span.start, span.end), left, right).tolist(), span.style) for span in spans),
        lines,
        tuple(Tick(at, line.label) for at, line in zip(apart([m.at for m in lines], left, right), lines, strict=True)),
        across,
        up,
    )


def apart(places: Sequence[float], first: float, last: float, *, gap: float = 14.0) -> list[float]:
    """Ascending places moved as little as it takes to stand ``gap`` apart, from ``first`` to ``last``."""
    moved: list[float] = []
    for place in places:
        moved.append(max([place, first, *(m + gap for m in moved[-1:])]))
    for i in range(len(moved) - 1, -1, -1):
        moved[i] = min([moved[i], last, *(m - gap for m in moved[i + 1 : i + 2])])
    return moved


def _within(scale: Scale, values: ArrayLike, *, bottom: float, top: float) -> Any:
    """Places of values, far ones kept near enough to be drawn; the page clips them."""
    return np.clip(scale.place(values, bottom, top), 2 * top - 1.5 * bottom, 2 * bottom)
