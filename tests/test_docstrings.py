"""The examples in the docstrings of the public names run and print what they say (regression)."""

import doctest

import pytest

import cuefem as cf

FLAGS = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS


@pytest.mark.parametrize("name", cf.__all__)
def test_examples_run(name: str) -> None:
    public = getattr(cf, name)
    failures: list[str] = []
    for found in doctest.DocTestFinder(recurse=False).find(public, name, globs={"cf": cf}):
        doctest.DocTestRunner(optionflags=FLAGS).run(found, out=failures.append)
    assert "".join(failures) == ""
