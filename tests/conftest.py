"""Settings of every test: hypothesis draws the same examples in every run, except in the profile "nightly"."""

import gc
import os
import pkgutil
import sys
from contextlib import suppress
from importlib import import_module

# With PYTHONDONTWRITEBYTECODE every worker and every process that a test starts would compile tests and package anew,
# half a second or more each. What pip has compiled is read as it stands.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False

gc.disable()  # until the tests are collected

# Set before NumPy is imported: BLAS threads do not accelerate the package's small dense matrices, and two of them on a
# busy machine can be a hundred times slower than one.
for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(name, "1")

os.environ.pop("CUEFEM_UNITS", None)  # tests read metric texts

import pytest  # noqa: E402
from hypothesis import HealthCheck, given, settings, strategies  # noqa: E402

import cuefem  # noqa: E402
from cuefem.beam import blas_threads  # noqa: E402
from cuefem.contact.kernel.library import library  # noqa: E402

pytest.register_assert_rewrite("tests.helpers")  # so that their failures show values, as those of tests do

settings.register_profile("cuefem", derandomize=True, deadline=None, database=None, print_blob=True)
# `pytest --hypothesis-profile=nightly`: other examples in each run, ten times as many; a failing one prints its blob
settings.register_profile(
    "nightly",
    settings.get_profile("cuefem"),
    derandomize=False,
    max_examples=1000,
    suppress_health_check=[HealthCheck.too_slow],  # of a machine that does other work
)
settings.load_profile("cuefem")


@pytest.fixture(scope="session", autouse=True)
def _every_module() -> None:
    """hypothesis draws from the constants of imported modules: with all of them the order of a worker has no effect."""
    for module in pkgutil.walk_packages(cuefem.__path__, "cuefem."):
        with suppress(ImportError):  # an extra that is not installed
            import_module(module.name)


def pytest_addoption(parser: pytest.Parser) -> None:
    """`--update` writes golden files anew (tests/test_golden_files.py)."""
    parser.addoption("--update", action="store_true", help="write the golden files of tests/golden anew")


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Properties and long verifications take limits and scale models, whose warnings are not of interest there.

    Any other test that takes them has the same mark.
    """
    for item in items:
        if any(item.get_closest_marker(name) for name in ("hypothesis", "heavy", "nightly")):
            item.add_marker(pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning"))


SOLVED_AT_COLLECTION = pytest.StashKey[list[str]]()  # what test_imports.py asserts to be empty


@given(strategies.none())
def first_example(_: None) -> None:
    """Let hypothesis register its random generator, for which it collects garbage and looks for the generator's owner.

    It would find none in frozen objects, and warn: the owner is a dict, and Python tracks each from its beginning from
    3.14 on (cpython issue 127010).
    """


def pytest_collection_finish(session: pytest.Session) -> None:
    """Note what tests have solved at their collection, and keep the collected objects out of the garbage collector."""
    uses = {"an eigenproblem": blas_threads._libraries, "a strike": library}
    session.config.stash[SOLVED_AT_COLLECTION] = [name for name, used in uses.items() if used.cache_info().currsize]
    first_example()
    gc.enable()
    gc.freeze()  # a million objects, which each later collection would walk
