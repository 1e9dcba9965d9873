"""How cuefem's objects show themselves: short texts in a terminal, tables and an outline in a notebook."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Sequence
from functools import cache
from html import escape
from typing import Any

import numpy as np


def brief(value: Any) -> str:
    """A value in a few letters: numbers to four digits, arrays by their shape unless they are short."""
    if isinstance(value, np.ndarray):
        if value.ndim == 1 and len(value) <= 8:
            return f"[{', '.join(brief(each) for each in value)}]"
        return f"array{value.shape}" if value.ndim else brief(value[()])
    if isinstance(value, bool | np.bool_):
        return str(bool(value))
    if isinstance(value, float | np.floating):
        return f"{float(value):.4g}"
    return repr(str(value) if isinstance(value, str) else value)


def said(kind: str, fields: Iterable[tuple[str, Any]]) -> str:
    """``Kind(name=value, ...)`` with brief values."""
    return f"{kind}({', '.join(f'{name}={brief(value)}' for name, value in fields)})"


@cache
def _shown_fields(kind: type) -> tuple[str, ...]:
    """The names of a dataclass's fields that it shows."""
    return tuple(field.name for field in dataclasses.fields(kind) if field.repr)


def spelt_out(thing: Any) -> str:
    """All that an object holds, as dataclasses write themselves: what tells two of them apart."""
    if type(thing) is float:
        return repr(thing)
    if isinstance(thing, np.ndarray):
        return f"array({thing.tolist()!r}, {thing.dtype})"
    if dataclasses.is_dataclass(thing) and not isinstance(thing, type):
        inner = ", ".join(f"{name}={spelt_out(getattr(thing, name))}" for name in _shown_fields(type(thing)))
        return f"{type(thing).__qualname__}({inner})"
    if type(thing) is tuple:
        return f"({', '.join(map(spelt_out, thing))}{',' if len(thing) == 1 else ''})"
    return repr(thing)


def table(head: Sequence[str], rows: Iterable[Sequence[Any]], caption: str = "") -> str:
    """A table for a notebook."""
    top = "".join(f"<th>{escape(name)}</th>" for name in head)
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(cell if isinstance(cell, str) else brief(cell))}</td>" for cell in row) + "</tr>"
        for row in rows
    )
    title = f"<caption>{escape(caption)}</caption>" if caption else ""
    return f"<table>{title}{f'<tr>{top}</tr>' if head else ''}{body}</table>"


def outline(pieces: Sequence[tuple[float, float, float, float, float]]) -> str:
    """A cue from its side as a small drawing, widths five times enlarged; what fills a bore is drawn as it is empty.

    pieces: of each segment its length, its outer diameters and its bores at the two ends, tip side first, m.
    """
    length = sum(piece[0] for piece in pieces)
    widest = max(max(piece[1:3]) for piece in pieces)
    across, wide = 5.0, 600.0
    scale = wide / length
    high = across * scale * widest + 4
    parts, x = [], 0.0
    for long, tip, butt, *bores in pieces:
        for ends, fill in (((tip, butt), "#e8d5b0"), (tuple(bores), "#ffffff")):
            if any(ends):
                near, far = (across * scale * end / 2 for end in ends)
                corners = ((x, -near), (x + long, -far), (x + long, far), (x, near))
                points = " ".join(f"{scale * place:.1f},{high / 2 + y:.1f}" for place, y in corners)
                parts.append(f'<polygon points="{points}" fill="{fill}" stroke="#555" stroke-width="0.6"/>')
        x += long
    about = 'role="img" aria-label="the cue from its side, tip on the left, widths five times enlarged"'
    size = f'width="{wide:.0f}" height="{high:.0f}" viewBox="-1 0 {wide + 2:.0f} {high:.0f}"'
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size} {about}>{"".join(parts)}</svg>'
