"""Tables for people stay whole: at any width every label and every number that the widest shows (properties)."""

import io
import re
from typing import Any

from rich.console import Console

from cuefem.report.table import terminal
from cuefem.results.records import Sheet

POOL = "studies/scenes/pool_low_deflection.toml"
# Every table that a command makes, at least once; the word is one that its table holds.
COMMANDS = {
    "modes": (["modes", POOL, "--near", "250"], "frequency"),
    "end mass": (["end-mass", POOL], "squirt, at b/R 0.375"),
    "strike": (["strike", POOL], "natural pivot length"),
    "bare strike": (["strike", "meshes/kim.toml"], "ball velocity, normal"),
    "effects": (["effects", POOL], "RollingContact"),
    "cost": (["cost", POOL, "--most", "24"], "elements x order"),
    "check": (["check", "meshes/kim.toml"], "give of the tip, cue free"),
    "report": (["report", POOL], "two-part, this cue"),
    "lumped report": (["report", "{lumped}"], "two-part, this cue"),
    "materials": (["materials"], "yellow birch"),
    "validate": (["validate", "--studies", "{studies}"], "printed"),
    "scatter": (["study", "{scatter}"], "95 %"),
    "tap": (["tap", "{recording}", "--scene", "meshes/kim.toml", "--mass", "118 g"], "of the fitted shaft"),
}
CLAIMS = """
from cuefem.validation import Claim
WHAT = "first natural frequency of the free shaft with its ferrule, as [Kim] prints it in table 2"
def claims():
    return [Claim("Kim, table 2", WHAT, 251.5, 251.4987, "Hz", "agrees", "the mesh is the paper's")]
"""


def rendered(things: list[Any], width: int) -> str:
    out = io.StringIO()
    console = Console(file=out, width=width, force_terminal=False, highlight=False)
    for thing in things:
        console.print(thing, crop=False) if not isinstance(thing, str) else console.print(thing, markup=False)
    return out.getvalue()


def words(text: str) -> list[str]:
    return sorted(word for word in text.split() if set(word) != {"─"})


def test_headings_wrap_before_texts_and_numbers_never() -> None:
    table = terminal(
        Sheet("A title", ("what", "a long heading", "another one"), (("[words] of text", "-1.2345 m/s", "3.4e-12"),))
    )

    def lines(width: int) -> list[str]:
        return [line.strip() for line in rendered([table], width).splitlines()[1:] if line.strip()]

    head, _, row = lines(60)
    assert head.split() == ["what", "a", "long", "heading", "another", "one"]
    assert re.fullmatch(r"\[words\] of text +-1.2345 m/s +3.4e-12", row)
    above, head, _, row = lines(39)
    assert (above.split(), head.split()) == (["a", "long", "another"], ["what", "heading", "one"])
    assert re.fullmatch(r"\[words\] of text +-1.2345 m/s +3.4e-12", row)
    *_, row, rest = lines(32)
    assert (row.split("  ")[0], rest) == ("[words] of", "text")
    assert lines(20) == lines(60)  # even the least is too wide: the terminal may wrap it
