"""Equality of values that hold arrays."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np


def equal_fields(first: Any, second: Any) -> bool:
    """``__eq__`` of dataclasses with arrays: whether two of one class have equal fields; nan equals nan in arrays."""
    if type(first) is not type(second):
        return NotImplemented
    pairs = ((getattr(first, field.name), getattr(second, field.name)) for field in fields(first))
    return all(_equal(a, b) for a, b in pairs)


def _equal(first: Any, second: Any) -> bool:
    if isinstance(first, dict) and isinstance(second, dict):
        return first.keys() == second.keys() and all(_equal(first[name], second[name]) for name in first)
    if isinstance(first, tuple | list) and isinstance(second, tuple | list):
        return len(first) == len(second) and all(_equal(a, b) for a, b in zip(first, second, strict=True))
    if isinstance(first, np.ndarray) and isinstance(second, np.ndarray):
        return np.array_equal(first, second, equal_nan=first.dtype.kind == "f" == second.dtype.kind)
    return bool(np.all(first == second))
