"""The definitions of the end mass on the command line: a choice of them, and a help that explains them."""

from __future__ import annotations

import click

from cuefem.endmass.drives import DEFINITIONS


class Definitions(click.Choice[str]):
    """The names of the table's definitions as they are when a command is called, and ``more``."""

    def __init__(self, *more: str) -> None:
        self.more, self.case_sensitive = more, True

    @property
    def choices(self) -> tuple[str, ...]:  # type: ignore[override]
        """All names."""
        return (*self.more, *DEFINITIONS)


class WithDefinitions(click.Command):
    """A command whose help ends with the definitions of the end mass."""

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write name and meaning of every definition."""
        with formatter.section("Definitions of the end mass"):
            formatter.write_dl([(definition.name, definition.meaning) for definition in DEFINITIONS.values()])
