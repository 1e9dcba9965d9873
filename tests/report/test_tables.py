"""Tables for people stay whole: at any width every label and every number that the widest shows (properties)."""

import io
import re
from typing import Any

from rich.console import Console

from cuefem.report.table import terminal
from cuefem.results.records import Sheet


def rendered(things: list[Any], width: int) -> str:
    out = io.StringIO()
    console = Console(file=out, width=width, force_terminal=False, highlight=False)
    for thing in things:
        console.print(thing, crop=False) if not isinstance(thing, str) else console.print(thing, markup=False)
    return out.getvalue()


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
