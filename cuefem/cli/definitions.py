"""A help that explains the definitions of the end mass."""

from __future__ import annotations

import click

from cuefem.endmass.drives import DEFINITIONS


class WithDefinitions(click.Command):
    """A command whose help ends with the definitions of the end mass."""

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write name and meaning of every definition."""
        with formatter.section("Definitions of the end mass"):
            formatter.write_dl([(definition.name, definition.meaning) for definition in DEFINITIONS.values()])
