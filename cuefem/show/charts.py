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
LEFT, SHORT_LABEL, LETTER = (
    44.0,
    5,
    7.5,
)  # room for the y axis: of labels of so many letters; for a letter of longer ones
MAX_LETTERS = 20  # of a label
LEAST_SPAN = 1e-6  # relative: values closer than that are equal


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


class Dots(NamedTuple):
    """Named dots of a chart, in the axes' units; without a name they belong to a curve. style: their CSS class.

    title: what the page says of them at the pointer, if not the name.
    """

    name: str
    x: ArrayLike
    y: ArrayLike
    style: str
    title: str = ""


class Shade(NamedTuple):
    """A shaded span of the x axis, from ``start`` to ``end`` in its units. style: its CSS class."""

    start: float
    end: float
    style: str


@dataclass(frozen=True)
class Axis:
    """An axis: its label and its ends; an end of None is fitted to the data.

    from_zero: a fitted axis includes 0. names: what its whole numbers 0, 1, ... stand for.
    """

    label: str
    low: float | None = None
    high: float | None = None
    from_zero: bool = True
    names: tuple[str, ...] = ()

    def scale_for(self, values: Sequence[ArrayLike]) -> Scale:
        """The scale for these values; ends of None become round numbers."""
        if self.names:
            return Scale(-0.5, len(self.names) - 0.5, 1.0)
        all_values = np.concatenate([np.ravel(np.asarray(v, float)) for v in values])
        finite = all_values[np.isfinite(all_values)]
        anchor = {"initial": 0.0} if self.from_zero else {}
        low = float(finite.min(**anchor)) if self.low is None else self.low
        high = float(finite.max(**anchor)) if self.high is None else self.high
        if not self.from_zero and high - low < LEAST_SPAN * abs(high):
            low, high = low - 0.1 * abs(low), high + 0.1 * abs(high)
        if high <= low:
            high = low + 1.0
        step = round_step(high - low)
        low = step * math.floor(low / step + 1e-9) if self.low is None else low
        high = step * math.ceil(high / step - 1e-9) if self.high is None else high
        return Scale(low, high, step)

    def ticks(self, scale: Scale, first: float, last: float) -> tuple[Tick, ...]:
        """The ticks of its scale on an axis drawn from ``first`` to ``last``: at round numbers, or at each name."""
        if not self.names:
            return scale.ticks(first, last)
        return tuple(Tick(float(scale.position(i, first, last)), shortened(name)) for i, name in enumerate(self.names))


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


def shortened(name: str) -> str:
    """A label of at most `MAX_LETTERS`."""
    return name if len(name) <= MAX_LETTERS else f"{name[: MAX_LETTERS - 1]}…"


def round_step(length: float, most: int = 6) -> float:
    """The smallest step of 1, 2 or 5 times a power of ten that divides a length into at most ``most`` parts."""
    power = 10.0 ** math.floor(math.log10(length / most))
    return next(power * factor for factor in (1, 2, 5, 10) if length / (power * factor) <= most + 1e-9)


def dots(x: ArrayLike, y: ArrayLike) -> str:
    """Points as one SVG path of dots: pieces without length, which round line caps show."""
    pairs = np.stack([np.ravel(np.asarray(values, float)) for values in (x, y)], axis=1)
    return "".join(f"M{a:.2f} {b:.2f}h0" for a, b in pairs[np.isfinite(pairs).all(axis=1)].tolist())


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
    points: tuple[tuple[str, str, str, str], ...]  # the same, and the title at the pointer
    spans: tuple[tuple[float, float, str], ...]  # left, right, style
    marks: tuple[Tick, ...]
    labels: tuple[Tick, ...]  # of the marks, without overlap
    x_scale: Scale
    y_scale: Scale
    is_read: bool  # whether its curves have values at the pointer


def chart(
    title: str,
    curves: Sequence[Curve],
    *,
    x: Axis,
    y: Axis,
    points: Sequence[Dots] = (),
    spans: Sequence[Shade] = (),
    marks: Sequence[Tick] = (),
    height: float = 260.0,
) -> Chart:
    """A chart of curves, clipped at the ends of the axes, over points."""
    top, right, bottom = 22.0 if marks else 10.0, WIDTH - 8, height - 40
    x_scale = x.scale_for([*(curve.x for curve in curves), *(each.x for each in points)])
    y_scale = y.scale_for([*(curve.y for curve in curves), *(each.y for each in points)])
    y_ticks = y.ticks(y_scale, bottom, top)
    left = max([LEFT, *(LETTER * len(tick.label) + 6 for tick in y_ticks if len(tick.label) > SHORT_LABEL)])
    lines = tuple(Tick(float(x_scale.position(mark.at, left, right)), mark.label) for mark in marks)
    widest = max([0, *(len(line.label) for line in lines)])
    positions = spread_labels([line.at for line in lines], left, right, gap=max(14.0, LETTER * widest))
    return Chart(
        title,
        x.label,
        y.label,
        height,
        (left, top, right, bottom),
        x.ticks(x_scale, left, right),
        y_ticks,
        tuple(
            (c.name, c.style, path(x_scale.position(c.x, left, right), _within(y_scale, c.y, bottom=bottom, top=top)))
            for c in curves
        ),
        tuple(
            (
                p.name,
                p.style,
                dots(x_scale.position(p.x, left, right), y_scale.position(p.y, bottom, top)),
                p.title or p.name,
            )
            for p in points
        ),
        tuple((*x_scale.position((span.start, span.end), left, right).tolist(), span.style) for span in spans),
        lines,
        tuple(Tick(at, line.label) for at, line in zip(positions, lines, strict=True)),
        x_scale,
        y_scale,
        is_read=bool(curves) and not y.names,
    )


def spread_labels(positions: Sequence[float], first: float, last: float, *, gap: float = 14.0) -> list[float]:
    """Ascending positions moved to be at least ``gap`` apart, from ``first`` to ``last``."""
    steps = gap * np.arange(len(positions))
    onwards = np.maximum.accumulate(np.maximum(positions, first) - steps) + steps
    back = np.minimum.accumulate((np.minimum(onwards, last) - steps)[::-1])[::-1] + steps
    return back.tolist()


def _within(scale: Scale, values: ArrayLike, *, bottom: float, top: float) -> Any:
    """Positions of values, far ones limited to half a chart's height beyond it; the page clips them."""
    return np.clip(scale.position(values, bottom, top), 2 * top - 1.5 * bottom, 2 * bottom)
