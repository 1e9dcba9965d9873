"""One browser and one designer for all the tests that look at the page."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from tests.helpers.designer_browser import launched, served


@pytest.fixture(scope="module")  # Playwright drives one at a time
def browser() -> Iterator[Any]:
    with launched() as made:
        yield made


@pytest.fixture(scope="session")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with served(tmp_path_factory.mktemp("designer")) as made:
        yield made
