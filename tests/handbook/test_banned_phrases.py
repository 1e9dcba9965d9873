"""Phrases that the field's terms replaced are absent from code, help, pages and README (regression)."""

from pathlib import Path

ROOT = Path(__file__).parents[2]
BANNED = (
    *(
        "give or take",
        "is told",
        "stands in its place",
        "left out here",
        "in the place of",
        "by hand over",
        "ready cue",
    ),
    *("usual stroke", "aside in a metre", "give of the tip", "nobody knows", "how it rings"),
)


def test_banned_phrases_are_absent_from_texts() -> None:
    pages = [path for path in (ROOT / "cuefem").rglob("*") if path.suffix in (".py", ".md", ".j2", ".toml")]
    pages.remove(ROOT / "cuefem/handbook/terms.md")  # which lists them
    whole = {path: " ".join(path.read_text(encoding="utf-8").lower().split()) for path in (*pages, ROOT / "README.md")}
    matches = {str(path): [phrase for phrase in BANNED if phrase in text] for path, text in whole.items()}
    assert {path: phrases for path, phrases in matches.items() if phrases} == {}
