"""Phrases that the field's terms replaced are absent from code, help, pages and Markdown (regression)."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
BANNED = re.compile(
    r"\b(give or take|is told|stands in|left out here|in the place of|lets? go|ready cues?|usual stroke"
    r"|aside in a metre|give of the tip|nobody knows|how it rings)\b"
)
SUFFIXES = (".py", ".md", ".j2", ".toml", ".svg", ".js", ".c", ".h")
JOINTS = re.compile(r'"\s*f?"|\n\s*(?:#|//|\*)')  # of string literals, and of the lines of a comment
EXEMPT = {ROOT / "cuefem/handbook/terms.md", ROOT / "CHANGELOG.md"}  # which list former names


def test_banned_phrases_are_absent_from_texts() -> None:
    files = [path for path in (ROOT / "cuefem").rglob("*") if path.suffix in SUFFIXES]
    files += [*ROOT.glob("*.md"), *(ROOT / "meshes").rglob("*.md")]
    matches = {}
    for path in {*files} - EXEMPT:
        text = JOINTS.sub(" ", path.read_text(encoding="utf-8").lower())
        matches[str(path)] = BANNED.findall(" ".join(text.split()))
    assert {path: phrases for path, phrases in matches.items() if phrases} == {}
