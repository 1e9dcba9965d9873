"""What CONTRIBUTING.md says: its recipes, and their code as modules; no tests."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).parents[2]
GUIDE = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")


def recipe(title: str) -> str:
    """The section of CONTRIBUTING.md with a title."""
    _, found, rest = GUIDE.partition(f"\n### {title}\n")
    assert found, title
    return re.split(r"\n##+ ", rest)[0]


def module_of(title: str, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """The code of a recipe as a module, which can be imported."""
    (code,) = re.findall(r"```python\n(.*?)```", recipe(title), flags=re.DOTALL)
    module = ModuleType(f"guide_{re.sub('[^a-z]', '_', title.lower())}")
    monkeypatch.setitem(sys.modules, module.__name__, module)
    exec(compile(code, "CONTRIBUTING.md", "exec"), vars(module))
    return module
