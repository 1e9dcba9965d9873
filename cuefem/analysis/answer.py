"""An analysis whose numbers are a record: its keys are attributes, as of SciPy's OptimizeResult."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from cuefem.analysis.base import Analysis
from cuefem.results.records import Record, Table

if TYPE_CHECKING:
    from cuefem.show.charts import Chart


@dataclass(frozen=True)
class Answer(Analysis):
    """The answer to a question as a record.

    Parameters
    ----------
    scene : Scene
        The analysed scene.
    record : dict
        The numbers, in SI units, by name.
    tabulate : callable
        The tables of a record.
    draw : callable
        The charts of a record.
    """

    record: Record
    tabulate: Callable[[Record], list[Table | str]] = field(repr=False)
    draw: Callable[[Record], list[Chart]] = field(default=lambda record: [], repr=False)

    def __getattr__(self, name: str) -> Any:
        try:
            return self.__dict__["record"][name]
        except KeyError:
            raise AttributeError(name) from None

    def values(self) -> Record:
        """The numbers, in SI units."""
        return self.record

    def tables(self) -> list[Table | str]:
        """The tables."""
        return self.tabulate(self.record)

    def charts(self) -> list[Chart]:
        """The charts."""
        return self.draw(self.record)
