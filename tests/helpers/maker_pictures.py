"""The pictures of the makers' handbook that show computed numbers; as a program it writes them anew.

python -m tests.helpers.maker_pictures
"""

import json
import math
import re
from functools import cache
from html import escape
from pathlib import Path
from typing import Any

from tests.helpers.command_line import call

ROOT = Path(__file__).parents[2]
MAPLE = ROOT / "meshes" / "pool_maple.toml"
FOLDER = ROOT / "cuefem" / "handbook"
# Squirt of one cue at one offset, degrees: the robot's two values, and the series of 2007 between its points
# (studies/measured/squirt.md).
MEASURED = {"by a robot, 2008": 2.43, "the same, once more": 2.30, "the year before": 1.87}
OFFSET = 0.375  # of all of them


@cache
def answers(command: str, *options: str) -> Any:
    """What a command says of the plain maple shaft, as a program is told."""
    status, out, err = call(command, MAPLE, "--json", *options)
    assert (status, err) == (0, "")
    return json.loads(out)


def changes() -> dict[str, float]:
    """The change of squirt, %, of the changes that the picture shows, by their words."""
    return {row["change"]: 100 * row["squirt_change"] for row in answers("improve")["changes"]}


def ready() -> dict[str, float]:
    """Squirt of the ready cues, degrees."""
    return {name: math.degrees(row["squirt"]) for name, row in answers("report")["verdict"]["among"].items()}


def picture(height: int, label: str, *inside: str) -> str:
    """A drawing of the handbook's width."""
    head = f'<svg viewBox="0 0 340 {height}" class="small" role="img" aria-label="{escape(label)}">'
    return "\n".join([head, *inside, "</svg>", ""])


def words(x: float, y: float, text: str, more: str = "") -> str:
    """A text at its place."""
    return f'<text x="{x:.0f}" y="{y:.0f}"{more}>{escape(text)}</text>'


MIDDLE, END, SAID = ' text-anchor="middle"', ' text-anchor="end"', ' class="said"'


def scale() -> str:
    """The verdict's scale of the plain maple shaft."""
    verdict = answers("report")["verdict"]
    rows = sorted(ready().items(), key=lambda item: item[1])
    own, off = math.degrees(verdict["squirt"]), math.degrees(verdict["squirt"]) * verdict["uncertainty"]["total"]
    place = lambda degrees: 100 + 90 * degrees  # noqa: E731
    texts = [
        f'{words(90, 24 + 26 * i, name, END)}<circle class="ball" cx="{place(value):.0f}" cy="{20 + 26 * i}" r="5"/>'
        for i, (name, value) in enumerate(rows)
    ]
    y = 24 + 26 * len(rows)
    return picture(
        y + 40,
        "Squirt of the ready shafts and of yours on one scale, yours with what it may be off",
        *texts,
        words(90, y, "yours", f"{END}{SAID}"),
        f'<path class="arrow" d="M{place(own - off):.0f} {y - 4}H{place(own + off):.0f}"/>',
        f'<circle class="wood" cx="{place(own):.0f}" cy="{y - 4}" r="5"/>',
        f'<path class="measure" d="M{place(0):.0f} {y + 12}H{place(2.5):.0f}"/>',
        *(words(place(d), y + 26, f"{d:g}°", MIDDLE) for d in (0, 0.5, 1, 1.5, 2, 2.5)),
    )


def changes_drawn() -> str:
    """Bars of the change of squirt, sorted."""
    bars = sorted(changes().items(), key=lambda item: item[1])
    texts = []
    for i, (name, percent) in enumerate(bars):
        y, end = 14 + 20 * i, 250 + 7.5 * percent
        style = "wood" if percent < 0 else "block"
        texts.append(f'<path class="{style}" d="M250 {y - 8}H{end:.0f}V{y + 2}H250Z"/>')
        texts.append(words(4, y, re.split(", wall|, a cone| wide and| from the", name)[0]))
        texts.append(
            words(
                end + (-3 if percent < 0 else 3), y, f"{percent:+.0f} %".replace("-", "−"), END if percent < 0 else ""
            )
        )
    height = 20 * len(bars) + 10
    said = "Bars of how much each change lowers or raises squirt, from the best to the worst"
    return picture(height, said, f'<path class="measure" d="M250 0V{height - 8}"/>', *texts)


def trust() -> str:
    """One cue, measured three times, and computed with its uncertainty."""
    verdict = answers("report", "--offset", str(OFFSET))["verdict"]
    own, off = math.degrees(verdict["squirt"]), math.degrees(verdict["squirt"]) * verdict["uncertainty"]["total"]
    place = lambda degrees: 135 + 60 * degrees  # noqa: E731
    texts = [
        words(125, 24 + 26 * i, name, END)
        + f'<circle class="ball" cx="{place(value):.0f}" cy="{20 + 26 * i}" r="5"/>'
        + words(place(value) + 10, 24 + 26 * i, f"{value}°")
        for i, (name, value) in enumerate(MEASURED.items())
    ]
    return picture(
        140,
        "Squirt of one plain maple cue: measured three times, and computed with what it may be off",
        *texts,
        words(125, 102, "computed", f"{END}{SAID}"),
        f'<path class="arrow" d="M{place(own - off):.0f} 98H{place(own + off):.0f}"/>',
        f'<circle class="wood" cx="{place(own):.0f}" cy="98" r="5"/>',
        f'<path class="measure" d="M{place(0):.0f} 112H{place(3):.0f}"/>',
        *(words(place(d), 126, f"{d}°", MIDDLE) for d in (0, 1, 2, 3)),
    )


PICTURES = {"scale": scale, "changes": changes_drawn, "trust": trust}

if __name__ == "__main__":
    for name, draw in PICTURES.items():
        (FOLDER / f"{name}.svg").write_text(draw(), encoding="utf-8")
