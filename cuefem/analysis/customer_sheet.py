"""The sheet that a maker hands over with a cue: one printed page of shop, order, drawing, numbers and how it plays."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from cuefem.analysis.cue_report import CueReport
from cuefem.analysis.first_screen import UNIT_WORDS, tiles_markup
from cuefem.analysis.report_page import headline_cue
from cuefem.analysis.verdict import Verdict, offset_text
from cuefem.cue.materials import table_name
from cuefem.files.shop import Shop
from cuefem.files.toml_reader import Order
from cuefem.measurements.measurement_types import CLOTH_FRICTION, ELEVATION
from cuefem.measurements.swerve import reading_angle
from cuefem.parameters.parts import main_material
from cuefem.quantity.display_units import OFF_LINE, display_unit, displayed_system, off_line, with_unit
from cuefem.results.quantities import format_value
from cuefem.results.records import Record, Table
from cuefem.scene import Scene
from cuefem.show.analysis import Analysis, PageFrame
from cuefem.show.drawings import DIAMETER_SCALE, lathe_drawing, legend
from cuefem.show.templates import SHEET_STYLES, framed

SHOT = {"metric": 1.0, "us": 1.2192}  # m, after which the off-line distance is given
TABLE = (2.54, 1.27)  # m, playing surface of a 9-ft table
STEPS = 24  # of the drawn path


class BallPath(NamedTuple):
    """The ball's way on a table, mm: places along the aim and aside, of a level cue and of a raised one."""

    level: list[tuple[float, float]]
    raised: list[tuple[float, float]]
    radius: float
    strike: float  # distance of the cue's axis from the ball's centre


@dataclass(frozen=True)
class CustomerSheet(Analysis):
    """One printed page for a customer, made by `customer_sheet`; its record is that of the report.

    Parameters
    ----------
    scene : Scene
        The analysed stroke.
    report : CueReport
        The report, whose numbers it shows.
    shop : Shop
        Name and line of the shop.
    order : Order
        Customer, serial and date.
    logo : str
        The address of a picture, such as "data:image/png;base64,...".
    """

    report: CueReport = field(repr=False)
    shop: Shop = Shop()  # noqa: RUF009  # frozen
    order: Order = Order()  # noqa: RUF009  # frozen
    logo: str = field(default="", repr=False)

    def headline(self) -> str:
        """Squirt with its uncertainty."""
        return self.report.headline()

    def values(self) -> Record:
        """The numbers of the report."""
        return self.report.values()

    def tables(self) -> list[Table | str]:
        """The tables of the report."""
        return self.report.tables()

    def _markup(self, frame: PageFrame) -> str:
        """The page. made: the date, where the order has none; assumptions and warnings are on the report's page."""
        verdict: Any = self.report.sections["verdict"]
        numbers: Any = self.report.sections["numbers"]
        speed, title = float(numbers.numbers["ball_speed"]), shaft_title(self.scene)
        return framed(
            "sheet.html.j2",
            inline=frame.inline,
            styles=SHEET_STYLES,
            title=" ".join(filter(None, (self.order.serial, title))),
            name=title,
            warnings=(),
            shop=self.shop,
            logo=self.logo,
            order=self.order,
            made=str(self.order.date or frame.made),
            drawn=lathe_drawing(self.scene, title),
            legend=legend([self.scene]),
            scale=DIAMETER_SCALE,
            unit=UNIT_WORDS[display_unit("m").name],
            tiles=tiles_markup(headline_cue(self.scene, self.report.sections, title)),
            path=ball_path(verdict, speed),
            table=[1e3 * side for side in TABLE],
            sentences=sentences(verdict, speed),
            trust=trust(verdict),
        )


def customer_sheet(
    report: CueReport,
    shop: Shop = Shop(),  # noqa: B008  # frozen
    order: Order = Order(),  # noqa: B008  # frozen
    *,
    logo: str = "",
) -> CustomerSheet:
    """A sheet for the customer of a cue: one printed page, letter or A4.

    Parameters
    ----------
    report : CueReport
        The answer of `report` for the cue.
    shop : Shop
        Name of the shop, and a line below it.
    order : Order
        Customer, serial and date.
    logo : str
        The address of a picture, such as "data:image/png;base64,..."; by default none.

    Returns
    -------
    CustomerSheet
        Save it with ``.save("0142.html")`` and print that page.

    Raises
    ------
    ValueError
        If the cue is lumped, or its stroke has no squirt.

    Examples
    --------
    >>> import cuefem as cf
    >>> sheet = cf.customer_sheet(cf.report(cf.load_scene("plain maple")), order=cf.Order(customer="A. Player"))
    >>> "A. Player" in sheet.to_html(), sheet.headline()[:11]
    (True, 'squirt 1.79')
    """
    problem = report.no_contact or report.no_squirt
    if problem:
        raise ValueError(problem)
    if not report.scene.cue.segments:
        raise ValueError("a sheet needs a drawn cue; got a lumped one")
    return CustomerSheet(report.scene, report, shop, order, logo)


def shaft_title(scene: Scene) -> str:
    """What a customer calls the shaft: its wood, its length and the width of its tip."""
    wood = table_name(main_material(scene.shaft))
    sizes = f"{with_unit(scene.shaft.length, 'm')}, tip {with_unit(scene.tip_diameter, 'm')}"
    return f"{f'{wood} shaft' if wood else 'shaft'}, {sizes}".capitalize()


def _raised(verdict: Verdict, ball_speed: float, distance: float) -> float:
    """How far aside, m, the ball of a raised cue is at a distance; nan where the cloth stops it before."""
    try:
        angle = reading_angle(
            abs(verdict.squirt),
            abs(verdict.offset),
            elevation=ELEVATION,
            speed=ball_speed,
            distance=distance,
            friction=CLOTH_FRICTION,
        )
    except ValueError:
        return math.nan
    return distance * math.tan(angle)


def ball_path(verdict: Verdict, ball_speed: float) -> BallPath:
    """The ball's way over the distance of a shot, to scale. ball_speed: m/s, of a level cue."""
    end, radius = SHOT[displayed_system()], float(verdict.scene.ball.radius)
    places = [end * i / STEPS for i in range(1, STEPS + 1)]
    raised = [(x, _raised(verdict, ball_speed, x)) for x in places]
    tangent = math.tan(abs(verdict.squirt))
    return BallPath(
        [(0.0, 0.0), (1e3 * end, 1e3 * tangent * end)],
        [(0.0, 0.0), *((1e3 * x, 1e3 * y) for x, y in raised if math.isfinite(y))],
        1e3 * radius,
        1e3 * radius * abs(verdict.offset),
    )


def sentences(verdict: Verdict, ball_speed: float) -> list[str]:
    """How the cue plays with side spin, in sentences for its owner."""
    squirt, error = verdict.squirt_text()
    distance, per = off_line(abs(verdict.squirt), verdict.squirt_error)
    said = [
        f"Hit {offset_text(verdict.offset)}, this shaft sends the cue ball {squirt} ± {error} to the other side: "
        f"{distance} off line after {per}. Half as much side, half as much squirt.",
    ]
    others = [f"{name} {format_value('squirt', abs(row['squirt']))}" for name, row in verdict.references.items()]
    if others:
        said.append(f"Other shafts, struck alike: {', '.join(others)}.")
    end = SHOT[displayed_system()]
    raised = _raised(verdict, ball_speed, end)
    if math.isfinite(raised):
        aside = with_unit(abs(raised) / end, OFF_LINE, decimals=0).partition("/")[0]
        side = "" if raised > 0 else " to the struck side"
        said.append(
            f"Swerve: with the cue raised by {math.degrees(ELEVATION):.0f}°, as over a rail, the cloth turns the ball "
            f"back: {aside}{side} off line after {per}."
        )
    return said


def trust(verdict: Verdict) -> str:
    """One line on how good the numbers are and for which stroke."""
    part = 100 * verdict.uncertainty["total"]
    speed = with_unit(verdict.scene.stroke.speed, "m/s")
    return (
        f"Computed from the drawing by cuefem, squirt to ± {part:.0f} % (1σ), better between two shafts; cue at "
        f"{speed}, cloth of friction {CLOTH_FRICTION:g}. Table and balls to scale."
    )
