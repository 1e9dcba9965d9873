"""Default ball, tip and stroke of each game, for a cue without a scene."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from types import MappingProxyType
from typing import Literal, cast

from cuefem.cue import MAX_LEATHER_MODULUS, Cue
from cuefem.cue.materials import LEATHERS, leather_restitution
from cuefem.effects.cue_effects import AxialWaves, GeometricStiffness
from cuefem.effects.effect import Effect
from cuefem.effects.leather_tip import LeatherTip
from cuefem.quantity.fields import check_kind, quote, suggestion
from cuefem.quantity.unit_checks import MIN_CUE_MASS
from cuefem.quantity.units import conversion_factor
from cuefem.scene.scene import Ball, Scene, Stroke, Tip

GameName = Literal["pool", "carom", "snooker"]
StrokeName = GameName | Literal["kim"]

OUNCE = float(conversion_factor("oz", "kg"))
LEATHER_KEYS = frozenset(("tip_height", "dome", "leather"))  # parameters of a leather tip
BODY_MASS_RANGE = (13.5, 17.5)  # oz, of pool: cues of 18 to 21 oz less shafts of 3.5 to 4.5 oz
WAVE_SPEED = 4430.0  # m/s in the butt: the root of E over the density of maple, and of ash


@dataclass(frozen=True)
class Game:
    """A default stroke of a game, SI, and where its numbers are from.

    Attributes
    ----------
    ball
        The ball.
    height
        Height of the leather from the ferrule to the apex of the dome, m.
    dome_radius
        Radius of the dome, m.
    leather
        Name of the leather in `cuefem.cue.materials.LEATHERS`.
    restitution
        Of the whole cue in a central impact, as measured: that of the tip without axial waves.
    body_mass
        Of the rest of the cue, kg, behind a drawing that is too light to be a whole cue.
    face_diameter
        Of the end of the ferrule that height and dome are usual for, m.
    cue_length, butt_diameter
        Of a whole cue, m: axial waves run in a butt up to there if the drawing ends at the joint.
    friction
        Of tip and ball.
    speed
        Speed of the cue, m/s.
    offset
        Tip offset b/R: well off centre, and far from a miscue.
    source
        Where each number comes from. A number marked "usual" has no single source: players and shops agree on it.
    """

    ball: Ball
    height: float
    dome_radius: float
    speed: float
    cue_length: float
    butt_diameter: float
    face_diameter: float
    body_mass: float
    source: str
    leather: str = "medium"
    restitution: float = 0.73
    friction: float = 0.7
    offset: float = 0.3

    @cached_property
    def tip(self) -> LeatherTip:
        """The default tip."""
        leather = LEATHERS[self.leather]
        return LeatherTip(self.height, self.dome_radius, leather.E, leather.nu, leather.rho)

    def tip_with(self, effects: Sequence[Effect]) -> Tip:
        """Tip with the leather's own restitution beside axial waves; otherwise that of the whole cue."""
        E = next((effect.E for effect in effects if isinstance(effect, LeatherTip)), LEATHERS[self.leather].E)
        waves = any(isinstance(effect, AxialWaves) for effect in effects)
        return Tip(leather_restitution(E) if waves else self.restitution, self.friction)

    @cached_property
    def effects(self) -> tuple[Effect, ...]:
        """Effects of a default stroke beside the tip: axial waves and geometric stiffness."""
        return AxialWaves(self.cue_length, self.butt_diameter, WAVE_SPEED), GeometricStiffness()


_ALL = (
    "Restitution: playing cues 0.71 to 0.75 (billiards.colostate.edu, FAQ, cue tip efficiency; TP A.30), of the whole "
    "cue; the tip's own follows from it. Friction: chalked leather, 0.6 to 0.7 (usual). Leather: see `cuefem parts`. "
    "Butt: length and diameter usual, its mass is the cue's, its waves are as fast as in maple or ash (4,430 m/s; "
    "purpleheart 4,480, rosewood 4,040). Rest of the cue: usual cues of 19 oz (pool), 17.5 oz (carom) and 18 oz "
    "(snooker) less shafts of 4, 4 and 5.5 oz"
)
GAMES: Mapping[str, Game] = MappingProxyType(
    {
        "pool": Game(
            ball=Ball(mass=0.170, radius=0.028575),
            height=6e-3,
            dome_radius=9.5e-3,
            speed=2.0,
            cue_length=1.4732,
            butt_diameter=0.03175,
            face_diameter=0.01275,
            body_mass=15 * OUNCE,
            source=(
                "Ball: WPA 57.15 mm, 156 to 170 g. Height: usual, 4 to 8 mm. Dome: usual, between a dime's (8.96 mm) "
                f"and a nickel's (10.6 mm) radius. Speed: a medium stroke (usual). {_ALL}"
            ),
        ),
        "carom": Game(
            ball=Ball(mass=0.210, radius=0.03075),
            height=4e-3,
            dome_radius=9.5e-3,
            speed=3.0,
            cue_length=1.397,
            butt_diameter=0.030,
            face_diameter=0.012,
            body_mass=13.5 * OUNCE,
            source=f"Ball: UMB 61 to 61.5 mm, 205 to 220 g. Height, dome and speed: assumed. {_ALL}",
        ),
        "snooker": Game(
            ball=Ball(mass=0.142, radius=0.02625),
            height=4e-3,
            dome_radius=7e-3,
            speed=3.0,
            cue_length=1.4605,
            butt_diameter=0.029,
            face_diameter=0.0095,
            body_mass=12.5 * OUNCE,
            source=(
                "Ball: WPBSA 52.5 mm; sets are sold at 140 to 143 g. Height, dome (flatter than half-round, on a tip "
                f"of 9.5 mm) and speed: assumed. {_ALL}"
            ),
        ),
    }
)
DEFAULT_GAME: GameName = "pool"
KIM: Literal["kim"] = "kim"  # no game, but the stroke of [Kim]: his ball, a spring as tip, head on, and no effects
STROKES = (*GAMES, KIM)


def stroke_name(name: str) -> StrokeName:
    """The name of a default stroke; ValueError if none has it."""
    if name not in STROKES:
        raise ValueError(f"game must be one of {', '.join(STROKES)}; got {quote(name)}{suggestion(str(name), STROKES)}")
    return cast(StrokeName, name)


def without_leather(cue: Cue) -> Cue:
    """The cue without the leather that is drawn at its tip (`Cue.leather_height`)."""
    if not cue.leather_height:
        return cue
    front = next(i for i, segment in enumerate(cue.segments) if segment.material.E >= MAX_LEATHER_MODULUS)
    return replace(cue, segments=cue.segments[front:])


def with_usual_rest(cue: Cue, game: str = DEFAULT_GAME) -> Cue:
    """The cue; without a body mass and too light to be a whole one, it gets the usual rest of a game's cue.

    So does a cue with the usual rest of another game.
    """
    if cue.is_body_mass_assumed:
        cue = replace(cue, body_mass=0.0, assumed_body_mass=0.0)
    if cue.body_mass or cue.mass >= MIN_CUE_MASS or game == KIM:
        return cue
    rest = _game(game).body_mass
    return replace(cue, body_mass=rest, assumed_body_mass=rest)


def default_tip(cue: Cue, game: str = DEFAULT_GAME) -> LeatherTip:
    """The default tip of a game, with the height of the leather drawn on the cue, if any.

    A dome that is too small for the cue's face is wider, of the same shape.

    Parameters
    ----------
    cue
        A drawing.
    game
        "pool", "carom" or "snooker".

    Returns
    -------
    LeatherTip
        With the game's default dome and leather.

    Raises
    ------
    ValueError
        If no game has that name.

    Examples
    --------
    >>> import cuefem as cf
    >>> from cuefem.scene.default_scene import default_tip
    >>> default_tip(cf.Cue((cf.Segment(0.7, 0.012, 0.021, cf.Material(12.6e9, 0.84e9, 700.0)),))).height
    0.006
    """
    defaults, ferrule = _game(game), without_leather(cue)
    tip = defaults.tip
    if cue.leather_height:
        tip = replace(tip, height=cue.leather_height)
    if tip.fits(ferrule):
        return tip
    wider = tip.with_scaled_dome(ferrule.segments[0].tip_diameter / defaults.face_diameter)
    return wider if wider.fits(ferrule) else tip


def usual_scene(cue: Cue, game: StrokeName = DEFAULT_GAME, *, tip: LeatherTip | None = None) -> Scene:
    """The default stroke of a game with a cue, which the commands use for a cue without a scene.

    Parameters
    ----------
    cue
        A drawing. The tip replaces leather drawn on it; a drawing without leather ends at the ferrule, and the tip is
        added in front of it. Without a body mass and too light to be a whole cue, it gets that of the game, an
        uncertain parameter.
    game
        "pool", "carom" or "snooker": `GAMES` has their values and sources. "kim" is ``Scene(cue)``, the cue as drawn
        with the ball, tip and stroke of Kim's paper and without effects.
    tip
        Instead of `default_tip`; not with "kim".

    Returns
    -------
    Scene
        The cue with the game's ball, tip, speed and offset, axial waves and geometric stiffness. Axial waves continue
        behind the drawing, in a butt of ``cue.body_mass``, which does not bend. The tip has the restitution of its
        leather, which axial waves raise to about that of whole cues.

    Raises
    ------
    ValueError
        If no game has that name, or the tip does not fit this cue.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> cue = cf.Cue((cf.Segment(0.7, 0.01275, 0.021, wood),), body_mass=0.43)
    >>> scene = cf.usual_scene(cue)
    >>> scene.ball.mass, scene.stroke.speed, scene.leather_tip.dome_radius
    (0.17, 2.0, 0.0095)
    >>> shaft = cf.Cue((cf.Segment(0.7, 0.01275, 0.021, wood),))
    >>> cf.usual_scene(shaft).cue.body_mass, cf.Scene(shaft).cue.body_mass  # 15 oz, none
    (0.425242846875, 0.0)
    """
    check_kind("usual_scene cue", cue, Cue)
    stroke_name(game)
    if game == KIM and tip is None:
        return Scene(cue).assuming(game=KIM)
    defaults = _game(game)
    effects = (default_tip(cue, game) if tip is None else tip, *defaults.effects)
    stroke = Stroke(defaults.speed, defaults.offset)
    struck = with_usual_rest(without_leather(cue), game)
    scene = Scene(struck, defaults.ball, defaults.tip_with(effects), stroke, effects)
    return scene.assuming(game=game, given=frozenset() if tip is None else LEATHER_KEYS)


def _game(name: str) -> Game:
    if name not in GAMES:
        raise ValueError(f"game must be one of {', '.join(GAMES)}; got {name!r}")
    return GAMES[name]
