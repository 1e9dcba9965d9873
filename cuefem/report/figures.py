"""Figures of commands as the content of a file, the same at every run."""

from __future__ import annotations

from collections.abc import Callable
from io import BytesIO
from typing import Any


def figure_content(kind: str, draw: Callable[[Any, Any], object], **options: Any) -> bytes:
    """What ``draw`` draws on a figure and its axes; kind: "png", "svg"; options: of matplotlib's ``subplots``."""
    import matplotlib

    matplotlib.use("agg")
    import matplotlib.pyplot as plt

    with plt.rc_context({"svg.hashsalt": "cuefem", "axes.grid": True, "grid.alpha": 0.3, "font.size": 10}):
        canvas, axes = plt.subplots(layout="constrained", **options)
        draw(canvas, axes)
        content = BytesIO()
        canvas.savefig(content, format=kind, dpi=150, metadata={"Date": None} if kind == "svg" else None)
        plt.close(canvas)
    return content.getvalue()
