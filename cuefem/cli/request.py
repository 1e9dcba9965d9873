"""What a command asks: a file, and the options given beside it; the scene and the assumptions that follow."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import click

from cuefem.cli.pending_warnings import warn
from cuefem.cli.scene_options import (
    NO_SHAFT,
    offset_value,
    option,
    option_value,
)
from cuefem.cue import Cue
from cuefem.effects.force_law import IndentationOutOfRange
from cuefem.files import InputError, load, with_body_mass
from cuefem.files.cue_names import cue_name
from cuefem.files.defaults_report import (
    Assumption,
    assumptions,
    drawing_assumptions,
    notes_on_options,
    offered_assumptions,
    own_values,
)
from cuefem.files.errors import as_input_error
from cuefem.files.shaft_additions import SHAFT_ADDITIONS
from cuefem.files.shop import shop_defaults
from cuefem.parameters.field_paths import Path as Steps
from cuefem.parameters.field_paths import with_fields
from cuefem.parameters.parameter import Parameter
from cuefem.parameters.parts import main_material, with_material
from cuefem.parameters.scene_changes import with_parameters, with_values_at
from cuefem.parameters.table import PARAMETERS
from cuefem.quantity.fields import OutOfBounds, Quantity
from cuefem.results.plausibility import drawing_warnings_of, plausibility_warnings
from cuefem.results.records import Table
from cuefem.scene import Scene
from cuefem.scene.default_scene import DEFAULT_GAME, default_tip, stroke_name, usual_scene
from cuefem.solid.tip_cache import computing_message

WEIGHT = Quantity("kg", "(0, 100]")  # of a shaft


@contextmanager
def errors_name_file(file: Path, helping: str = "") -> Iterator[None]:
    """Prefix errors of the computation with the file name, such as an effect beyond the cue.

    helping: the options that help against an indentation beyond the force law.
    """
    try:
        yield
    except InputError:  # which names a file already
        raise
    except ValueError as error:
        words = f" ({helping})" if helping and isinstance(error, IndentationOutOfRange) else ""
        raise InputError(file, "", f"{error}{words}") from None


@dataclass(frozen=True)
class Request:
    """What a command asks.

    Parameters
    ----------
    file : Path
        A cue's or a scene's file.
    given : dict of str to str
        The texts of the given options that supplement or replace values of the file, by name.
    offered : frozenset of str
        The names of all such options of the command.
    with_impact : bool
        Whether ball, tip and stroke matter to the command. If not, a cue alone stays as drawn unless an option sets its
        game or tip.
    hints : list
        Lines that the command adds, printed after the tables.
    shop_notes : sequence of Assumption
        What a shop.toml adds to the options.
    """

    file: Path
    given: Mapping[str, str]
    offered: frozenset[str] = frozenset()
    with_impact: bool = True
    hints: list[Table | str] = field(default_factory=list)
    shop_notes: Sequence[Assumption] = ()

    @classmethod
    def of(cls, file: Path, options: Mapping[str, str | None], *, with_impact: bool = True) -> Request:
        """The request of a command's options; None: not given."""
        given = {name: text for name, text in options.items() if text is not None}
        return cls(file, given, frozenset(options), with_impact)

    def own_values(self) -> set[str]:
        """The options of cue and tip whose values the file has itself."""
        return own_values(self.file, self.given.get("length_unit"))

    def with_shop(self) -> Request:
        """The request with the defaults of a shop.toml that the file and the options leave open."""
        added, notes = shop_defaults(self.file, self.given, self.offered)
        return replace(self, given={**self.given, **added}, shop_notes=notes)

    @contextmanager
    def errors(self) -> Iterator[None]:
        """A context that adds to an error of the computation the file, and the option that caused it or can mend it."""
        with errors_name_file(self.file, "--tip-height, --leather, --speed" if "leather" in self.offered else ""):
            try:
                yield
            except OutOfBounds as error:
                raise self._named(error) from None

    @cached_property
    def opened(self) -> Any:
        """The cue or the scene of the file, with the additions to its drawing; errors name the option."""
        additions: Any = {name: self.given.get(name) for name in SHAFT_ADDITIONS}
        try:
            return load(self.file, **additions)
        except InputError as error:
            name, _, problem = f"{error.key}: {error.problem}".removeprefix(": ").partition(": ")
            if name not in self.given:
                raise
            raise InputError(self.file, option(name), problem) from None

    @cached_property
    def scene(self) -> Scene:
        """The scene of the file with the options; a cue alone gets a game's default stroke."""
        if isinstance(self.opened, Scene):
            self._reject_game()
            scene = self._with_given(self.opened)
        elif self._is_as_drawn:
            scene = self._as_drawn(self.opened)
        else:
            scene = self._struck(self.opened)
        with errors_name_file(self.file):
            compute_tip(scene)
        return scene

    @cached_property
    def drawing(self) -> Any:
        """What the file holds, as drawn, with the options."""
        if isinstance(self.opened, Scene):
            return self._with_given(self.opened)
        cue = self.opened
        if "body_mass" in self.given:
            cue = with_body_mass(cue, self.file, "--body-mass", self.given["body_mass"])
        return self._weighed(cue) if "shaft_mass" in self.given else cue

    def _weighed(self, cue: Cue) -> Cue:
        """The cue with the density of its wood by --shaft-mass; a scale weighs it with its usual tip."""
        mass = option_value(self.file, "--shaft-mass", self.given["shaft_mass"], WEIGHT)
        with as_input_error(self.file, "--shaft-mass"):
            weighed = with_parameters(usual_scene(cue), {"shaft mass": mass}).shaft
        return replace(with_material(cue, *map(main_material, (cue, weighed))), shaft_mass_measured=True)

    @property
    def assumed(self) -> list[Assumption]:
        """The values that neither the file nor an option sets."""
        found = [*self.shop_notes, *assumptions(self.file, self.scene, self.given)]
        return [each for each in found if not (self._is_as_drawn and each.key == "game")]

    @property
    def assumptions(self) -> list[Assumption]:
        """The assumptions that matter to the command; each names its option if the command has that option."""
        offered = self.offered - ({"game"} if isinstance(self.opened, Scene) else set())
        return offered_assumptions(self.assumed, offered, with_impact=self.with_impact)

    @property
    def assumptions_of_drawing(self) -> list[Assumption]:
        """Those of the drawing alone."""
        if not isinstance(self.drawing, Cue):
            return []
        listed = [
            *self.shop_notes,
            *notes_on_options(self.file, self.given),
            *drawing_assumptions(self.file, self.drawing, self.given),
        ]
        return offered_assumptions(listed, self.offered)

    def print_warnings(self) -> None:
        """Warn on stderr of implausible numbers of the scene."""
        print_warnings(self.scene, with_impact=self.with_impact)

    @property
    def _is_as_drawn(self) -> bool:
        sets_tip = "game" in self.given or any(map(_is_leather, self._parameters()))
        return not (self.with_impact or sets_tip or isinstance(self.opened, Scene))

    def _struck(self, cue: Cue) -> Scene:
        """The scene of a cue alone: the game's default stroke."""
        game = stroke_name(self.given.get("game", DEFAULT_GAME))
        leather = default_tip(cue, game)
        changes = self._values(SimpleNamespace(effects=(leather,)), _is_leather)
        try:
            own = {path[1:]: value for path, value in changes.items() if path[0] == "leather"}
            leather = with_fields(leather, own)
            scene = usual_scene(cue, game, tip=leather)
        except ValueError as error:
            implausible = drawing_warnings_of(cue)
            hint = f"; {implausible[0]}" if implausible else " (options: --tip-height, --dome)"
            text = str(error).replace("dome radius", "--dome") if "dome" in self.given else str(error)
            raise InputError(self.file, "", f"{text}{hint}") from None
        return self._with_given(scene)

    def _as_drawn(self, cue: Cue) -> Scene:
        """The scene of a cue without a tip; --shaft-mass weighs it with its usual tip, as in `cuefem convert`."""
        if "shaft_mass" not in self.given:
            return self._with_given(Scene(cue))
        return self._with_given(Scene(self._weighed(cue)), lambda known: known.key != "shaft_mass")

    def _with_given(self, scene: Scene, which: Callable[[Parameter], bool] = lambda known: True) -> Scene:
        """The scene with the values of the given options."""
        changes = self._values(scene, which)
        try:
            return with_values_at(scene, changes) if changes else scene
        except OutOfBounds as error:
            raise self._named(error) from None
        except ValueError as error:
            raise InputError(self.file, "", str(error)) from None

    def _named(self, error: OutOfBounds) -> InputError:
        """The error with the option that gave the number, as it was given; with the field's name if none did."""
        for known in self._parameters():
            if error.name.casefold().endswith(known.path.casefold()):
                bounds = error.bounds.bounds_in(error.bounds.unit)
                problem = f"must be {bounds}{error.reason}; got {self.given[known.key]}"
                return InputError(self.file, option(known.key), problem)
        return InputError(self.file, "", str(error))

    def _parameters(self) -> list[Parameter]:
        """The parameters that options set."""
        return [known for known in PARAMETERS.values() if known.option and known.key in self.given]

    def _values(self, scene: Any, which: Callable[[Parameter], bool]) -> dict[Steps, Any]:
        """The values of the given options, by their paths."""
        changes = dict[Steps, Any]()
        for known in filter(which, self._parameters()):
            text, name = self.given[known.key], option(known.key)
            try:
                wanted = known.quantity(scene)
            except ValueError:
                raise InputError(self.file, name, _absent(scene, known)) from None
            changes |= known.named_value(text)
            changes[known.steps()] = (
                offset_value(self.file, text, float(scene.ball.radius))
                if known.key == "offset"
                else option_value(self.file, name, text, wanted)
            )
        return changes

    def _reject_game(self) -> None:
        """Reject a game for a scene, which has its own ball, tip and stroke."""
        if "game" in self.given:
            problem = "does not apply: FILE is a scene, which has its own ball, tip and stroke"
            raise InputError(self.file, "--game", problem)


def open_request(file: Path, options: Mapping[str, str | None]) -> Request:
    """The request of a file with the options that it leaves open."""
    request = Request.of(file, options)
    own = request.own_values()
    return replace(request, given={key: text for key, text in request.given.items() if key not in own}).with_shop()


def file_names(files: Sequence[Path]) -> list[str]:
    """The files' names, without folder and extension if they are distinct."""
    for i, file in enumerate(files):
        if file.resolve() in [other.resolve() for other in files[:i]]:
            raise InputError(file, "", "is given twice; compare different files")
    forms = [(cue_name(file) or file.stem, file.name, str(file)) for file in files]
    return [next(own for k, own in enumerate(form) if [each[k] for each in forms].count(own) == 1) for form in forms]


def compute_tip(scene: Scene) -> None:
    """Compute the scene's leather tip unless it is tabulated or cached, and announce the waiting time."""
    if not scene.tip_is_cached:
        click.echo(computing_message(), err=True)
        scene.tip_law()


def print_warnings(scene: Scene, *, with_impact: bool = True) -> None:
    """Warn on stderr of implausible numbers; a wrong unit is the most common reason."""
    for line in plausibility_warnings(scene, with_impact=with_impact):
        warn(line)


def _is_leather(known: Parameter) -> bool:
    return known.path.startswith("leather.")


def _absent(scene: Any, known: Parameter) -> str:
    """Why a scene has no such parameter, for an error."""
    if _is_leather(known):
        return "does not apply: the scene has no LeatherTip among its effects"
    return NO_SHAFT if scene.lumped else f"does not apply: the scene has no {known.label}"
