"""Writer of cues and scenes as TOML; a separate module, since tomlkit is only needed for writing."""

from __future__ import annotations

import re
from typing import Any

import tomlkit

from cuefem.cue import Cue
from cuefem.files.schema import table
from cuefem.scene import Scene


def toml_text(thing: Cue | Scene, **tables: dict[str, Any]) -> str:
    """A cue or scene as TOML text that `load_toml` converts back exactly, and other tables behind it."""
    document = tomlkit.document()
    if isinstance(thing, Scene) and not thing.effects:  # without the key they would be those of pool
        document.add("effects", tomlkit.array())
    for name, value in table(thing).items():
        document.add(name, _item(value))
    for name, content in tables.items():
        document.add(name, tomlkit.item(content))
    return re.sub(r"(?<!\n)\n\[", "\n\n[", tomlkit.dumps(document)).rstrip("\n") + "\n"  # a blank line before a table


def _item(value: Any, *, inside: bool = False) -> Any:
    """Segments and effects as [[tables]], their own tables in one line."""
    if isinstance(value, dict):
        made = tomlkit.inline_table() if inside else tomlkit.table()
        for name, inner in value.items():
            made.add(name, _item(inner, inside=inside))
        return made
    if isinstance(value, list) and value and isinstance(value[0], dict):
        tables = tomlkit.aot()
        for row in value:
            tables.append(made := tomlkit.table())
            for name, inner in row.items():
                made.add(name, _item(inner, inside=True))
        return tables
    return value
