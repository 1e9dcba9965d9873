"""Error messages that echo what somebody typed: short, and in printable characters."""

from __future__ import annotations

import re

LONGEST = 60  # characters of an echoed value
MOST = 8  # names of a list

_LONG = re.compile(
    rf"(?P<quote>['\"])(?P<said>[^'\"]{{{LONGEST}}})[^'\"]+(?P=quote)|(?P<word>[^\s/'\"]{{{LONGEST}}})[^\s/'\"]+"
)


def brief(text: str) -> str:
    """The text in one line of printable characters, long values cut and long lists of names ended; paths stay whole."""

    def cut(match: re.Match[str]) -> str:
        quote = match["quote"] or ""
        return f"{quote}{match['said'] or match['word']}...{quote}"

    return "; ".join(map(_ended, _LONG.sub(cut, printable(text)).split("; ")))


def _ended(part: str) -> str:
    """A part of a message whose list of names ends after `MOST`, and what stands behind the list with "or"."""
    names = part.split(", ")
    rest = next((i for i, name in enumerate(names) if i >= MOST and name.startswith("or ")), len(names))
    return part if rest <= MOST else ", ".join([*names[:MOST], "...", *names[rest:]])


def printable(text: str) -> str:
    """The text in one line, with control characters as escapes such as \\x1b."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in " ".join(text.split()))
