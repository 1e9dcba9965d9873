"""The number of examples that a property draws; no tests."""

from hypothesis import settings

USUAL = 100  # examples of a profile that does not say


def examples(count: int) -> settings:
    """So many examples; ten times as many in the profile "nightly" of tests/conftest.py."""
    return settings(max_examples=count * settings.default.max_examples // USUAL)
