"""Charts as geometry: positions of curves, ticks and labels in SVG units; the template draws them.

A drawing is WIDE units wide. The page sets the size of texts, which remain readable on a phone.

Charts are drawn here, and not by a script, since print, mail without scripts and screen readers need them. A charting
library would draw each a second time only to show values at the pointer, which `charts.js` reads off the drawing.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

WIDTH = 440.0


class Tick(NamedTuple):
    """A position on an axis, in its units or in those of the drawing, and the label there."""

    at: float
    label: str


class Curve(NamedTuple):
    """A named line of a chart through points in the axes' units; nan breaks it. style: its CSS class."""

    name: str
    x: ArrayLike
    y: ArrayLike
    style: str


class Shade(NamedTuple):
    """A shaded span of the x axis, from ``start`` to ``end`` in its units. style: its CSS class."""

    start: float
    end: float
    style: str


@dataclass(frozen=True)
class Axis:
    """An axis: its label and its ends; an end of None is fitted to the data."""

    label: str
    low: float | None = None
    high: float | None = None

    def scale_for(self, values: Sequence[ArrayLike]) -> Scale:
        """The scale for these values; ends of None become round numbers."""
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
    """The ends of an axis, and the step of its ticks."""

    low: float
    high: float
    step: float

    def position(self, value: Any, first: float, last: float) -> Any:
        """The position of a value on an axis drawn from ``first`` to ``last``."""
        return first + (np.asarray(value, float) - self.low) / (self.high - self.low) * (last - first)

    def ticks(self, first: float, last: float) -> tuple[Tick, ...]:
        """A tick at every multiple of the step between the ends."""
        count = range(math.ceil(self.low / self.step - 1e-9), math.floor(self.high / self.step + 1e-9) + 1)
        decimals = max(0, -math.floor(math.log10(self.step) + 1e-9))
        return tuple(
            Tick(float(self.position(i * self.step, first, last)), f"{i * self.step:.{decimals}f}".replace("-", "−"))
            for i in count
        )


def round_step(length: float, most: int = 6) -> float:
    """The smallest step of 1, 2 or 5 times a power of ten that divides a length into at most ``most`` parts."""
    power = 10.0 ** math.floor(math.log10(length / most))
    return next(power * factor for factor in (1, 2, 5, 10) if length / (power * factor) <= most + 1e-9)


def path(x: ArrayLike, y: ArrayLike) -> str:
    """Points as an SVG path with two decimals, interrupted where they are not finite."""
    pieces, begun = [], False
    for a, b in zip(np.ravel(np.asarray(x, float)), np.ravel(np.asarray(y, float)), strict=True):
        if math.isfinite(a) and math.isfinite(b):
            pieces.append(f"{'L' if begun else 'M'}{a:.2f} {b:.2f}")
        begun = math.isfinite(a) and math.isfinite(b)
    return "".join(pieces)


@dataclass(frozen=True)
class Chart:
    """A chart with all positions in SVG units."""

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
    labels: tuple[Tick, ...]  # of the marks, without overlap
    x_scale: Scale
    y_scale: Scale


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
    """A chart of curves, clipped at the ends of the axes."""
    left, top, right, bottom = 44.0, 22.0 if marks else 10.0, WIDTH - 8, height - 40
    x_scale = x.scale_for([curve.x for curve in curves])
    y_scale = y.scale_for([curve.y for curve in curves])
    lines = tuple(Tick(float(x_scale.position(mark.at, left, right)), mark.label) for mark in marks)
    positions = spread_labels([line.at for line in lines], left, right)
    return Chart(
        title,
        x.label,
        y.label,
        height,
        (left, top, right, bottom),
        x_scale.ticks(left, right),
        y_scale.ticks(bottom, top),
        tuple(
            (c.name, c.style, path(x_scale.position(c.x, left, right), _within(y_scale, c.y, bottom=bottom, top=top)))
            for c in curves
        ),
        tuple((*x_scale.position((span.start, span.end), left, right).tolist(), span.style) for span in spans),
        lines,
        tuple(Tick(at, line.label) for at, line in zip(positions, lines, strict=True)),
        x_scale,
        y_scale,
    )


def spread_labels(positions: Sequence[float], first: float, last: float, *, gap: float = 14.0) -> list[float]:
    """Ascending positions moved to be at least ``gap`` apart, from ``first`` to ``last``."""
    moved: list[float] = []
    for position in positions:
        moved.append(max([position, first, *(m + gap for m in moved[-1:])]))
    for i in range(len(moved) - 1, -1, -1):
        moved[i] = min([moved[i], last, *(m - gap for m in moved[i + 1 : i + 2])])
    return moved


def _within(scale: Scale, values: ArrayLike, *, bottom: float, top: float) -> Any:
    """Positions of values, far ones limited to half a chart's height beyond it; the page clips them."""
    return np.clip(scale.position(values, bottom, top), 2 * top - 1.5 * bottom, 2 * bottom)
