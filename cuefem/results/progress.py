"""What a ``progress`` argument is: it wraps the items of long work, as a progress bar does; ``list`` shows nothing."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any

Progress = Callable[[Sequence[Any]], Iterable[Any]]
