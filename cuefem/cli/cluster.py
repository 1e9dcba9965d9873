"""The executor of a Dask cluster; `distributed` is loaded only for it."""

from __future__ import annotations

import importlib
import logging
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager

import click

TIMEOUT = 10.0  # s, for a scheduler to respond


@contextmanager
def dask_executor(address: str) -> Iterator[Executor]:
    """The executor of a Dask scheduler, which gives the blocks of a dead worker to another one.

    UsageError if `distributed` is missing or no scheduler responds.
    """
    try:
        distributed = importlib.import_module("distributed")
    except ModuleNotFoundError:
        raise click.UsageError("--scheduler needs Dask: pip install 'cuefem[cluster]'") from None
    for name in [*logging.root.manager.loggerDict]:
        if name.startswith(("distributed", "tornado")):
            logging.getLogger(name).setLevel(logging.CRITICAL)  # the one-line error is enough
    try:
        distributed.comm.parse_host_port(distributed.comm.parse_address(address)[1])
        client = distributed.Client(address, timeout=TIMEOUT, set_as_default=False)
    except (OSError, ValueError) as error:
        raise click.UsageError(f"--scheduler: no Dask scheduler responds at {address}: {error}") from None
    try:
        yield client.get_executor(pure=False)
    finally:
        client.close(timeout=1)
