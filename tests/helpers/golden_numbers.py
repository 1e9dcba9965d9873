"""Numbers of tests against tests/golden/numbers.json; no tests."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

import pytest

GOLDEN = Path(__file__).parents[1] / "golden" / "numbers.json"


def assert_golden_numbers(
    name: str, now: Mapping[str, float], request: pytest.FixtureRequest, rel: float = 1e-9
) -> None:
    """Numbers equal those of the golden file, which `--update` writes; below 1e-9 they are round-off, as 0."""
    now = {key: value if abs(value) > 1e-9 else 0.0 for key, value in now.items()}
    stored = json.loads(GOLDEN.read_text())
    if request.config.getoption("--update"):
        old = stored.get(name, {})
        alike = {key: old[key] for key in now if key in old and old[key] == pytest.approx(now[key], rel=rel, abs=1e-15)}
        stored[name] = {**now, **alike}  # the diff of an update shows no round-off
        GOLDEN.write_text(json.dumps(stored, indent=1, sort_keys=True) + "\n")
    assert now == pytest.approx(stored[name], rel=rel, abs=1e-15)
