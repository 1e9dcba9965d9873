"""Short text of objects, values and messages, in printable characters."""

from __future__ import annotations

import dataclasses
import re
import unicodedata
from collections.abc import Iterable
from functools import cache
from html import escape
from typing import Any

MAX_VALUE_CHARACTERS = 60  # characters of an echoed value
MAX_LISTED = 8  # names of a list

_LONG = re.compile(
    rf"(?<!\w)(?P<quote>['\"])(?P<quoted>[^'\"]{{{MAX_VALUE_CHARACTERS}}})[^'\"]+(?P=quote)|(?P<word>[^\s/'\"]{{{MAX_VALUE_CHARACTERS}}})[^\s/'\"]+"
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
def _repr_fields(kind: type) -> tuple[str, ...]:
    """The names of a dataclass's fields with ``repr``."""
    return tuple(field.name for field in dataclasses.fields(kind) if field.repr)


def full_repr(value: Any) -> str:
    """The full representation of an object, equal for equal objects."""
    if type(value) is float:
        return repr(value)
    if getattr(value, "ndim", 0):
        return f"array({value.tolist()!r}, {value.dtype})"
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        inner = ", ".join(f"{name}={full_repr(getattr(value, name))}" for name in _repr_fields(type(value)))
        return f"{type(value).__qualname__}({inner})"
    if type(value) is tuple:
        return f"({', '.join(map(full_repr, value))}{',' if len(value) == 1 else ''})"
    return repr(value)


def html_table(caption: str, head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """A table for a notebook, of plain texts."""
    lines = [("th", head), *(("td", row) for row in rows)]
    cells = ["".join(f"<{kind}>{escape(text)}</{kind}>" for text in line) for kind, line in lines]
    return f"<table><caption>{escape(caption)}</caption>{''.join(f'<tr>{line}</tr>' for line in cells)}</table>"


def counted(count: int, noun: str) -> str:
    """A number of things.

    >>> counted(1, "design"), counted(12, "design")
    ('1 design', '12 designs')
    """
    return f"{count} {noun}{'' if count == 1 else 's'}"


def one_line(text: str) -> str:
    """The text in one line of printable characters, with long values and lists shortened, paths excepted."""

    def cut(match: re.Match[str]) -> str:
        quote = match["quote"] or ""
        return f"{quote}{match['quoted'] or match['word']}...{quote}"

    return "; ".join(map(_shorten, _LONG.sub(cut, printable(text)).split("; ")))


def _shorten(item: str) -> str:
    """An item of a message, its list of names cut after `MAX_LISTED`; a final name with "or" remains."""
    names = item.split(", ")
    final = next((i for i, name in enumerate(names) if i >= MAX_LISTED and name.startswith("or ")), len(names))
    return item if final <= MAX_LISTED else ", ".join([*names[:MAX_LISTED], "...", *names[final:]])


def printable(text: str) -> str:
    """The text in one line, with control characters as escapes such as \\x1b."""
    return "".join(c if c.isprintable() else _escape(c) for c in " ".join(text.split()))


def visible(text: str) -> str:
    r"""A text with control characters, and those that turn the direction of a line, as escapes; line breaks stay.

    >>> visible("oak\x1b[2J \u202e")
    'oak\\x1b[2J \\u202e'
    """
    return "".join(_escape(character) if _is_control(character) else character for character in text)


def _is_control(character: str) -> bool:
    return character != "\n" and unicodedata.category(character) in ("Cc", "Cf", "Cs", "Zl", "Zp")


def _escape(character: str) -> str:
    return character.encode("unicode_escape").decode()
