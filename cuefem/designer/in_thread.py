"""Work outside the event loop of the page."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

import numpy as np
from nicegui import run

from cuefem.quantity.unit_checks import FLOAT_ERRORS

TIME_LIMIT = 60.0  # s, time limit of a result; playing cues need less than a tenth


async def run_in_thread(work: Callable[..., Any], *arguments: Any) -> Any:
    """Run the work in a thread, with overflows as errors; RuntimeError at the time limit."""

    def guarded() -> Any:
        with np.errstate(**FLOAT_ERRORS):
            return work(*arguments)

    # not run.io_bound, whose result at the time limit is None: it takes the cancellation as its own end
    result = asyncio.get_running_loop().run_in_executor(run.thread_pool, guarded)
    try:
        return await asyncio.wait_for(result, TIME_LIMIT)
    except TimeoutError:
        raise RuntimeError(f"this takes more than {TIME_LIMIT:g} s: draw fewer segments, or check sizes") from None
