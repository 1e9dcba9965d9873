"""Phrases that the terms of the field replaced everywhere stay out of what people read (regression)."""

import ast
import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
BANNED = re.compile(
    r"give or take|is told|stands in its place|left out here|in the place of|by hand over|ready cue|usual stroke|"
    r"aside in a metre|give of the tip|nobody knows|how it rings",
    re.IGNORECASE,
)


def texts(path: Path) -> list[str]:
    """The text of a page, or the string literals of a module, docstrings included."""
    text = path.read_text(encoding="utf-8")
    if path.suffix != ".py":
        return [text]
    values = (node.value for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Constant))
    return [value for value in values if isinstance(value, str)]


def test_replaced_phrases_stay_out_of_help_messages_and_pages() -> None:
    pages = [path for path in (ROOT / "cuefem").rglob("*") if path.suffix in (".py", ".md", ".j2", ".toml")]
    found = {
        path: [" ".join(m.split()) for t in texts(path) for m in BANNED.findall(" ".join(t.split()))] for path in pages
    }
    found |= {
        path: BANNED.findall(" ".join(path.read_text(encoding="utf-8").split())) for path in ROOT.glob("README.md")
    }
    assert {str(path): phrases for path, phrases in found.items() if phrases} == {}
