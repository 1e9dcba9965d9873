"""The pictures of the makers' handbook with computed numbers; run as a program, it writes them.

python -m tests.helpers.maker_pictures
"""

import json
import math
import re
from functools import cache
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from cuefem.quantity.display_units import format_change
from tests.helpers.command_line import call

ROOT = Path(__file__).parents[2]
MAPLE = ROOT / "meshes" / "pool_maple.toml"
FOLDER = ROOT / "cuefem" / "handbook"
# Squirt of one cue at one offset, degrees: the robot's two values, and the series of 2007 between its points
# (studies/measured/squirt.md).
MEASURED = {"by a robot, 2008": 2.43, "the same, once more": 2.30, "the year before": 1.87}
OFFSET = 0.375  # of all of them


@cache
def command_json(command: str, *options: str) -> Any:
    """The record that a command prints for the plain maple shaft with --json."""
    status, out, err = call(command, MAPLE, "--json", *options)
    assert (status, err) == (0, "")
    return json.loads(out)


def changes() -> dict[str, float]:
    """Change of squirt, %, by the name of the design change."""
    return {row["change"]: 100 * row["squirt_change"] for row in command_json("improve")["changes"]}


def reference_squirts() -> dict[str, float]:
    """Squirt of the reference cues, degrees."""
    return {name: math.degrees(row["squirt"]) for name, row in command_json("report")["verdict"]["references"].items()}


def picture(height: int, label: str, *inside: str) -> str:
    """An SVG image of the handbook's width."""
    head = f'<svg viewBox="0 0 340 {height}" class="small" role="img" aria-label="{escape(label)}">'
    return "\n".join([head, *inside, "</svg>", ""])


def svg_text(x: float, y: float, text: str, attributes: str = "") -> str:
    """A text at x, y."""
    return f'<text x="{x:.0f}" y="{y:.0f}"{attributes}>{escape(text)}</text>'


MIDDLE, END, CAPTION = ' text-anchor="middle"', ' text-anchor="end"', ' class="label"'


def on_scale(rows: dict[str, float], verdict: Any, label: str, caption: str, *, x0: int, unit: int, last: float) -> str:
    """Squirts of other cues, and the own one with its uncertainty, on a scale from 0 to ``last``, degrees."""
    squirt = math.degrees(verdict["squirt"])
    outside = squirt * verdict["uncertainty"]["total"]

    def at(degrees: float) -> str:
        return f"{x0 + unit * degrees:.0f}"

    y = 24 + 26 * len(rows)
    texts = [
        f'{svg_text(x0 - 10, 24 + 26 * i, name, END)}<circle class="ball" cx="{at(value)}" cy="{20 + 26 * i}" r="5"/>'
        for i, (name, value) in enumerate(rows.items())
    ]
    return picture(
        y + 40,
        label,
        *texts,
        svg_text(x0 - 10, y, caption, f"{END}{CAPTION}"),
        f'<path class="arrow" d="M{at(squirt - outside)} {y - 4}H{at(squirt + outside)}"/>',
        f'<circle class="wood" cx="{at(squirt)}" cy="{y - 4}" r="5"/>',
        f'<path class="measure" d="M{at(0)} {y + 12}H{at(last)}"/>',
        *(svg_text(float(at(d)), y + 26, f"{d:g}°", MIDDLE) for d in np.arange(0, last + 0.1, 0.5)),
    )


def scale() -> str:
    """The verdict's scale of the plain maple shaft."""
    rows = dict(sorted(reference_squirts().items(), key=lambda item: item[1]))
    label = "Squirt of the reference shafts and of yours on one scale, yours with its uncertainty"
    return on_scale(rows, command_json("report")["verdict"], label, "yours", x0=100, unit=90, last=2.5)


def changes_chart() -> str:
    """Bars of the change of squirt, sorted."""
    bars = sorted(changes().items(), key=lambda item: item[1])
    texts = []
    for i, (name, percent) in enumerate(bars):
        y, end = 14 + 20 * i, 250 + 7.5 * percent
        style = "wood" if percent < 0 else "block"
        texts.append(f'<path class="{style}" d="M250 {y - 8}H{end:.0f}V{y + 2}H250Z"/>')
        texts.append(svg_text(4, y, re.split(", wall|, a cone| wide and| from the", name)[0]))
        texts.append(
            svg_text(end + (-3 if percent < 0 else 3), y, format_change(percent, 0, "%"), END if percent < 0 else "")
        )
    height = 20 * len(bars) + 10
    label = "Bars of how much each change lowers or raises squirt, from the best to the worst"
    return picture(height, label, f'<path class="measure" d="M250 0V{height - 8}"/>', *texts)


def trust() -> str:
    """One cue, measured three times, and computed with its uncertainty."""
    verdict = command_json("report", "--offset", str(OFFSET))["verdict"]
    label = "Squirt of one plain maple cue: measured three times, and computed with its uncertainty"
    rows = {f"{name}, {value:.2f}°": value for name, value in MEASURED.items()}
    return on_scale(rows, verdict, label, "computed", x0=175, unit=50, last=3)


PICTURES = {"scale": scale, "changes": changes_chart, "trust": trust}

if __name__ == "__main__":
    for name, draw in PICTURES.items():
        (FOLDER / f"{name}.svg").write_text(draw(), encoding="utf-8")
