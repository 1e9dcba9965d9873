"""The examples in the docstrings of the public names run and print what they say (regression)."""

import doctest

import pytest

import cuefem as cf

FLAGS = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS


# Strikes a cue for every change.
SLOW = pytest.param("design_changes", marks=pytest.mark.heavy)


@pytest.mark.parametrize("name", [SLOW if name == "design_changes" else name for name in cf.__all__])
def test_docstring_examples_of_public_name_run(name: str) -> None:
    public = getattr(cf, name)
    failures: list[str] = []
    for example in doctest.DocTestFinder(recurse=False).find(public, name, globs={"cf": cf}):
        doctest.DocTestRunner(optionflags=FLAGS).run(example, out=failures.append)
    assert "".join(failures) == ""
