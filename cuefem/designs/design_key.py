"""Keys of designs: hashes of the scene, the resolution and the code that computes it."""

from __future__ import annotations

import hashlib
import json
from functools import cache
from pathlib import Path
from typing import Any

from cuefem.quantity.display import full_repr
from cuefem.scene import Resolution, Scene

KEY_BYTES = 16


def digest(*parts: Any) -> bytes:
    """Hash of texts and numbers, all bits included, `KEY_BYTES` long."""
    text = json.dumps(parts).encode("utf-8", "backslashreplace")
    return hashlib.blake2b(text, digest_size=KEY_BYTES).digest()


@cache
def code_digest() -> str:
    """Hash of the package's sources and tables: another version computes designs again."""
    every, content = Path(__file__).parents[1].rglob("*"), hashlib.blake2b(digest_size=KEY_BYTES)
    for path in sorted(path for path in every if path.suffix in (".py", ".c", ".h", ".toml", ".npz")):
        content.update(path.read_bytes())
    return content.hexdigest()


def design_key(scene: Scene | str, at: Resolution | None, squirt_factor: float) -> bytes:
    """The key of a design: of its scene, or of the reason why it is invalid, and of what computes it."""
    text = f"invalid: {scene}" if isinstance(scene, str) else full_repr(scene)
    return digest(code_digest(), text, repr(at), squirt_factor)
