"""Output in the encoding of the terminal: what it lacks is spelt in ASCII, such as "+/-" for "±"."""

from __future__ import annotations

import codecs
import sys
import unicodedata

HANDLER = "cuefem.ascii_spelling"
SPELLINGS = {
    "±": "+/-",
    "−": "-",
    "–": "-",
    "—": "-",
    "°": " deg",
    "·": ".",
    "•": "*",
    "×": "x",
    "→": "->",
    "√": "sqrt ",
    "∞": "inf",
    "∂": "d",
    "∫": "int ",
    "⌀": "dia. ",
    "Ø": "dia. ",
    "ø": "o",
    "µ": "u",
    "●": "o",
    "━": "=",
    "″": '"',
    "”": '"',
    "“": '"',
    "’": "'",
    "‘": "'",
}


def ascii_spelling(character: str) -> str:
    """A character in ASCII: Greek letters by name, others without accents; "?" if there is no spelling."""
    if character in SPELLINGS:
        return SPELLINGS[character]
    name = unicodedata.name(character, "")
    if name.startswith("GREEK"):
        letter = name.split()[-1]
        return letter.capitalize() if "CAPITAL" in name else letter.lower()
    decomposed = unicodedata.normalize("NFKD", character)
    return decomposed.replace("⁄", "/").encode("ascii", "ignore").decode() or "?"


def _spell(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    lacking = error.object[error.start : error.end]
    return "".join(map(ascii_spelling, lacking)), error.end


def spell_lacking_characters() -> None:
    """Let stdout and stderr spell what their encodings lack, instead of an error."""
    codecs.register_error(HANDLER, _spell)
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):  # not a StringIO
            stream.reconfigure(errors=HANDLER)


def is_unicode(encoding: str | None) -> bool:
    """Whether an encoding has all characters; that of a StringIO, None, has."""
    return encoding is None or codecs.lookup(encoding).name.startswith("utf")
