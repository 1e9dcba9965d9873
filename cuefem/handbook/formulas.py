"""The handbook's formulas as `.ci/formulas.py` stores them: MathML for pages, plain text for terminals."""

from __future__ import annotations

import json
import re
from functools import cache
from hashlib import sha256
from importlib.resources import files
from typing import Any

FENCE = re.compile(r"```math\n(.*?)\n```", re.DOTALL)


def key(latex: str) -> str:
    """The key of a formula in ``formulas.json``: a changed formula has no entry there until it is stored again."""
    return sha256(latex.strip().encode()).hexdigest()[:12]


@cache
def _stored() -> Any:
    return json.loads(files(__package__).joinpath("formulas.json").read_text(encoding="utf-8"))


def as_mathml(latex: str) -> str:
    """A formula for pages."""
    return _stored()[key(latex)]["mathml"]


def with_plain_formulas(markdown: str) -> str:
    """A chapter with its formulas as blocks of plain text."""
    return FENCE.sub(lambda fence: f"```text\n{_stored()[key(fence[1])]['text']}\n```", markdown)
