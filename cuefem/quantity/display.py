"""Short text of objects, values and messages, in printable characters."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterable
from functools import cache
from typing import Any

MAX_VALUE_CHARACTERS = 60  # characters of an echoed value
MAX_LISTED = 8  # names of a list

_LONG = re.compile(
    rf"(?P<quote>['\"])(?P<quoted>[^'\"]{{{MAX_VALUE_CHARACTERS}}})[^'\"]+(?P=quote)|(?P<word>[^\s/'\"]{{{MAX_VALUE_CHARACTERS}}})[^\s/'\"]+"
)


def brief(value: Any) -> str:
    """A short representation of a value: numbers to four digits, long arrays by their shape."""
    if hasattr(value, "ndim"):  # of numpy, which is not imported here: commands that print no number do not load it
        if value.ndim == 0:
            return brief(value.item())
        return f"[{', '.join(map(brief, value))}]" if value.shape < (9,) and value.ndim == 1 else f"array{value.shape}"
    if isinstance(value, float):
        return f"{value:.4g}"
    return repr(value)


def brief_repr(kind: str, fields: Iterable[tuple[str, Any]]) -> str:
    """``Kind(name=value, ...)`` with brief values."""
    return f"{kind}({', '.join(f'{name}={brief(value)}' for name, value in fields)})"


@cache
def _shown_fields(kind: type) -> tuple[str, ...]:
    """The names of a dataclass's fields with ``repr``."""
    return tuple(field.name for field in dataclasses.fields(kind) if field.repr)


def full_repr(thing: Any) -> str:
    """The full representation of an object, equal for equal objects."""
    if type(thing) is float:
        return repr(thing)
    if getattr(thing, "ndim", 0):
        return f"array({thing.tolist()!r}, {thing.dtype})"
    if dataclasses.is_dataclass(thing) and not isinstance(thing, type):
        inner = ", ".join(f"{name}={full_repr(getattr(thing, name))}" for name in _shown_fields(type(thing)))
        return f"{type(thing).__qualname__}({inner})"
    if type(thing) is tuple:
        return f"({', '.join(map(full_repr, thing))}{',' if len(thing) == 1 else ''})"
    return repr(thing)


def one_line(text: str) -> str:
    """The text in one line of printable characters, with long values and lists shortened; paths stay whole."""

    def cut(match: re.Match[str]) -> str:
        quote = match["quote"] or ""
        return f"{quote}{match['quoted'] or match['word']}...{quote}"

    return "; ".join(map(_shortened, _LONG.sub(cut, printable(text)).split("; ")))


def _shortened(part: str) -> str:
    """A part of a message whose list of names is cut after `MAX_LISTED`; a final item with "or" remains."""
    names = part.split(", ")
    rest = next((i for i, name in enumerate(names) if i >= MAX_LISTED and name.startswith("or ")), len(names))
    return part if rest <= MAX_LISTED else ", ".join([*names[:MAX_LISTED], "...", *names[rest:]])


def printable(text: str) -> str:
    """The text in one line, with control characters as escapes such as \\x1b."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in " ".join(text.split()))
