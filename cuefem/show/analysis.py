"""What all answers share: the record of numbers, and the text, page and notebook views of tables and charts."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass, field, fields, is_dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np

from cuefem.files import InputError, save_page, write_atomically
from cuefem.files.defaults_report import Assumption, held_assumptions, offered_assumptions
from cuefem.quantity.display import brief
from cuefem.quantity.display_units import displayed_in
from cuefem.quantity.frames import frame_of
from cuefem.results.plausibility import plausibility_warnings
from cuefem.results.quantities import UNITS
from cuefem.results.records import Record, Table, json_value
from cuefem.scene import Scene
from cuefem.show.charts import Chart
from cuefem.show.drawings import CueDrawing
from cuefem.show.scene_summary import cue_line, effect_name, effect_text, scene_record

if TYPE_CHECKING:
    import pandas as pd


CHANGEABLE = (dict, list, np.ndarray)
MAX_SHOWN, MAX_REPR = 12, 320  # of `__repr__`: entries of a container, characters
DESIGN_STYLES = ("c1", "c2", "c3", "c4", "c5")  # CSS classes of designs side by side


class MoreCharts(NamedTuple):
    """Charts that a page folds below an answer: title, charts, and the definitions of their curves."""

    title: str
    charts: Sequence[Chart]
    about: str = ""


class PageFrame(NamedTuple):
    """What a page says around an answer: name of the file, assumptions, warnings, and the date at its end.

    inline: whether it is a part of a notebook, in its colours, at full height.
    """

    name: str
    assumptions: Sequence[Assumption]
    warnings: Sequence[str]
    made: str
    inline: bool


@dataclass(frozen=True)
class Answer:
    """The answer to one question, which prints, draws and saves itself.

    A subclass adds its numbers as fields, in SI units, and defines `tables`. A field with ``repr=False`` is not part of
    the record: intermediate results, and options of the tables.
    """

    def __init_subclass__(cls, **options: Any) -> None:
        """Keep the inherited `__repr__`, which a dataclass would replace."""
        super().__init_subclass__(**options)
        if "__repr__" not in cls.__dict__:
            cls.__repr__ = cls.__repr__  # type: ignore[method-assign]

    has_stroke: ClassVar[bool] = True  # whether ball, tip and stroke matter to the answer
    about: ClassVar[str] = ""  # definitions, for pages
    folds_assumptions: ClassVar[bool] = False  # on its page
    own_units: ClassVar[Mapping[str, str]] = MappingProxyType({})  # of numbers that are no quantities of the registry

    def tables(self) -> list[Table | str]:
        """Tables and lines of text, in the order of terminal, page and notebook."""
        raise NotImplementedError

    def charts(self) -> Sequence[Chart | CueDrawing]:
        """Charts and drawings, for pages and notebooks."""
        return []

    def more_charts(self) -> Sequence[MoreCharts]:
        """Charts for few readers, which a report folds."""
        return []

    def heading(self) -> str:
        """The first line: what was analysed."""
        return ""

    def effects_line(self) -> str:
        """The effects of the scene as one line, or an empty line."""
        return ""

    @property
    def warnings(self) -> list[str]:
        """What is implausible in the input, a line each."""
        return []

    @property
    def assumptions(self) -> list[Assumption]:
        """What neither the file nor a later change of its scene set, as `cuefem.load_scene` found it."""
        return []

    def headline(self) -> str:
        """The answer in one line, or an empty line."""
        return ""

    def problem(self) -> str:
        """Why a part of the answer is missing; a command then ends with an error."""
        return ""

    def gaps(self) -> list[str]:
        """Warnings of the answer itself, such as what parts lack, a line each: on a page, and first in a terminal."""
        return []

    def values(self) -> Record:
        """The numbers alone, in SI units; a caller may change its arrays, lists and dicts. `to_dict` has plain ones."""
        named = {each.name: getattr(self, each.name) for each in fields(self) if each.repr}
        return {name: deepcopy(value) if isinstance(value, CHANGEABLE) else value for name, value in named.items()}

    def said(self) -> Record:
        """Assumptions and warnings as texts."""
        return {"assumptions": [*map(str, self.assumptions)], "warnings": [*self.warnings]}

    def to_dict(self) -> Record:
        """The record: numbers in SI units, and the unit of each, as JSON has them: lists, and None for nan."""
        return json_value({**self.values(), "units": {**UNITS, **self.own_units}})

    def page_title(self, name: str, question: str) -> str:
        """The title of a page on a file."""
        return f"{name}: {question}" if name else question

    def lines(
        self, name: str = "", assumptions: Sequence[Assumption] = (), hints: Sequence[Table | str] = ()
    ) -> list[Table | str]:
        """What a terminal and a plain page show: heading, tables, hints, effects and assumptions."""
        heading = ": ".join(filter(None, (name, self.heading())))
        return [*([heading, ""] if heading else []), *self.gaps(), *self._body(assumptions, hints)]

    def _body(self, assumptions: Sequence[Assumption], hints: Sequence[Table | str] = ()) -> list[Table | str]:
        """Tables, hints, effects and assumptions."""
        effects = self.effects_line()
        return [
            *self.tables(),
            *(["", *hints] if hints else []),
            "",
            *([f"effects: {effects}"] if effects else []),
            *(["assumed:", *(f"  {each}" for each in assumptions)] if assumptions else []),
        ]

    def to_html(
        self,
        name: str = "",
        assumptions: Sequence[Assumption] | None = None,
        warnings: Sequence[str] | None = None,
        made: str = "",
        *,
        inline: bool = False,
    ) -> str:
        """A self-contained page with tables and charts.

        Parameters
        ----------
        name : str
            Of the file, in the page's title.
        assumptions, warnings : sequence, optional
            Instead of the answer's own.
        made : str
            The date at the page's end.
        inline : bool, default False
            Whether the page is a part of a notebook.

        Returns
        -------
        str
            HTML.
        """
        noted = self.assumptions if assumptions is None else assumptions
        warned = [f"warning: {line}" for line in self.warnings] if warnings is None else warnings
        return self._markup(PageFrame(name, noted, warned, made, inline))

    def _markup(self, frame: PageFrame) -> str:
        """The page."""
        from cuefem.show.templates import plain_page  # templates take 0.1 s to load

        title = frame.name or effect_name(type(self).__name__).capitalize()
        file = frame.name.partition(":")[0]
        heading = "" if self.heading() in title else ": ".join(filter(None, (file, self.heading())))
        more = (chart for folded in self.more_charts() for chart in folded.charts)
        folded = [*map(str, frame.assumptions)] if self.folds_assumptions else []
        things = [heading, *self.charts(), *more, *self._body(() if folded else frame.assumptions)]
        said = [*self.gaps(), *frame.warnings]
        return plain_page(title, things, frame.made, said, notes=folded, inline=frame.inline)

    def save(self, path: str | Path) -> None:
        """Write the record (.json) or a page (.html); the extension sets the format."""
        write(Path(path), self.to_dict, self.to_html)

    def __str__(self) -> str:
        from cuefem.show.renderers import plain_text

        warnings = [f"warning: {line}" for line in self.warnings]
        return plain_text([*warnings, *self.lines(assumptions=self.assumptions)])

    def __repr__(self) -> str:
        """Class, headline or heading, numbers to four digits, and the sizes of longer fields, in one line."""
        values = ((each.name, getattr(self, each.name)) for each in fields(self) if each.repr)
        shown = [f"{name}={_brief(value)}" for name, value in values if not _is_empty(value)]
        return self._in_one_line("; ".join(filter(None, [self.headline() or self.heading(), ", ".join(shown)])))

    def _in_one_line(self, text: str) -> str:
        """The class and the beginning of a text."""
        return f"<{type(self).__name__}: {text if len(text) <= MAX_REPR else f'{text[:MAX_REPR]}...'}>"

    def _repr_pretty_(self, printer: Any, cycle: bool) -> None:
        """The tables, in IPython."""
        printer.text(str(self))

    def _repr_html_(self) -> str:
        """The page's content as a part of the notebook, in its colours, at full height."""
        return self.to_html(inline=True)


@dataclass(frozen=True)
class Analysis(Answer):
    """The answer to one question about a scene.

    Parameters
    ----------
    scene : Scene
        The scene that was analysed.
    """

    scene: Scene = field(repr=False)

    def heading(self) -> str:
        """The first line: the analysed cue."""
        return cue_line(self.scene.cue)

    def effects_line(self) -> str:
        """The effects of the scene as one line, or an empty line."""
        return ", ".join(map(effect_text, self.scene.effects))

    @property
    def warnings(self) -> list[str]:
        """What is implausible in the scene and in the file that it is of, a line each."""
        return [*self.scene.file_warnings, *plausibility_warnings(self.scene, with_impact=self.has_stroke)]

    @property
    def assumptions(self) -> list[Assumption]:
        """What neither the file nor a later change of its scene set, as `cuefem.load_scene` found it."""
        return offered_assumptions(held_assumptions(self.scene), with_impact=self.has_stroke)

    def to_dict(self) -> Record:
        """The record: assumptions, warnings, scene, numbers in SI units, and the unit of each."""
        about = scene_record(self.scene)
        if not self.has_stroke:
            about = {name: about[name] for name in ("cue", "effects")}
        return {**json_value({**self.said(), "scene": about}), **super().to_dict()}


class Rows:
    """An answer whose numbers are a table."""

    own_units: ClassVar[Mapping[str, str]]

    def frame_rows(self) -> list[Record]:
        """The rows of the table as records, SI units."""
        raise NotImplementedError

    def to_frame(self) -> pd.DataFrame:
        """The rows as a pandas frame, in SI units; ``attrs["units"]`` has the unit of each column.

        Returns
        -------
        pandas.DataFrame

        Raises
        ------
        RuntimeError
            If pandas is not installed.
        """
        return frame_of(self.frame_rows(), {**UNITS, **self.own_units})


def write(path: Path, record: Callable[[], Record], html: Callable[[], str]) -> None:
    """Write a record, metric, as .json, or a page as .html; InputError for another extension."""
    if path.suffix.lower() not in (".html", ".json"):
        raise InputError(path, "", f"must end in .html or .json; got {path.suffix!r}")
    if path.suffix.lower() == ".html":
        return save_page(html(), path)
    from cuefem.show.renderers import json_text

    with displayed_in("metric"):
        text = json_text(record()) + "\n"
    write_atomically(path, lambda temporary: temporary.write_text(text, encoding="utf-8"))


def _is_empty(value: Any) -> bool:
    """Whether a field says nothing: None, or a text or container without content."""
    return value is None or (isinstance(value, str | Mapping | list | tuple) and not value)


def _brief(value: Any) -> str:
    """A value of `__repr__`: a short list in full, other containers by their names or their size."""
    if isinstance(value, list | tuple):
        is_short = len(value) <= MAX_SHOWN and all(isinstance(each, int | float | None) for each in value)
        return f"[{', '.join(map(brief, value))}]" if is_short else f"[{len(value)}]"
    if isinstance(value, Mapping):
        return f"{{{', '.join(map(str, value))}}}" if len(value) <= MAX_SHOWN else f"{{{len(value)}}}"
    return type(value).__name__ if is_dataclass(value) else brief(value)
