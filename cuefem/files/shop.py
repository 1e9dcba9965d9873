"""`shop.toml`, with a shop's name and logo and the defaults of its shafts, and the [order] of a cue's file."""

from __future__ import annotations

import base64
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import platformdirs

from cuefem.files.cue_names import cue_name
from cuefem.files.defaults_report import Assumption, own_values
from cuefem.files.errors import InputError, read_bytes
from cuefem.files.schema import build
from cuefem.files.toml_reader import Order, check_lines, read_tables
from cuefem.quantity.display_units import SYSTEMS

SHOP = "shop.toml"
LARGEST_LOGO = 1_000_000  # bytes
PICTURES = {b"\x89PNG\r\n\x1a\n": "png", b"\xff\xd8\xff": "jpeg", b"GIF8": "gif"}  # by the first bytes


@dataclass(frozen=True)
class Shop:
    """A shop on a customer's sheet.

    Parameters
    ----------
    name, line : str
        Its name, and a line below it such as an address; at most 80 characters each.
    logo : str
        The path of a picture (PNG, JPEG, GIF or SVG, of at most `LARGEST_LOGO`), in a file from its folder.
    """

    name: str = ""
    line: str = ""
    logo: str = ""

    def __post_init__(self) -> None:
        check_lines(self)


@dataclass(frozen=True)
class ShopLimits:
    """The usual limits of a shop's design changes, as the options of `cuefem improve`."""

    wall: str | None = None
    keep: tuple[str, ...] = ()
    stiffness_loss: str | None = None

    def __post_init__(self) -> None:
        if not all(isinstance(part, str) for part in self.keep):
            raise ValueError("ShopLimits.keep must be an array of texts")


@dataclass(frozen=True)
class Defaults:
    """What a shop's files leave open: texts as of the options of commands, and the units displayed."""

    body_mass: str | None = None
    ferrule: str | None = None
    units: str | None = None
    limits: ShopLimits = ShopLimits()

    def __post_init__(self) -> None:
        if self.units not in (None, *SYSTEMS):
            raise ValueError(f"Defaults.units must be {' or '.join(SYSTEMS)}; got {self.units!r}")


@dataclass(frozen=True)
class ShopFile:
    """What a shop.toml says: [shop] and [defaults]."""

    shop: Shop = Shop()
    defaults: Defaults = Defaults()
    path: Path = field(default=Path(SHOP), compare=False)  # which is no key of the file

    def logo(self) -> str:
        """The picture as the address of an image, "" without one; InputError if it is none or too large."""
        return picture_address(self.path.parent / self.shop.logo) if self.shop.logo else ""


def find_shop(path: Path) -> ShopFile:
    """The shop.toml in the folder of a path or a parent of it, or in the user's configuration; an empty one without."""
    folder = path.resolve() if path.is_dir() else path.resolve().parent
    places = [*(each / SHOP for each in (folder, *folder.parents)), platformdirs.user_config_path("cuefem") / SHOP]
    found = next((each for each in places if each.is_file()), None)
    return ShopFile() if found is None else load_shop(found)


def shop_of(file: Path) -> ShopFile:
    """The shop.toml of a cue's file; that of the working folder for a cue by its name."""
    return find_shop(Path() if cue_name(file) else file)


def shop_defaults(
    file: Path, given: Mapping[str, Any], offered: Collection[str] = ("body_mass", "ferrule")
) -> tuple[dict[str, str], list[Assumption]]:
    """Options that the shop.toml of a file adds, and the assumptions which say so.

    given: the options beside the file. offered: the options that there are.
    """
    shop = shop_of(file)
    texts = {"body_mass": shop.defaults.body_mass, "ferrule": shop.defaults.ferrule}
    left_open = {key: text for key, text in texts.items() if text and key in offered and key not in given}
    own = own_values(file, given.get("length_unit")) if left_open else set()
    added = {key: text for key, text in left_open.items() if key not in own}
    notes = [
        Assumption("", f"{key.replace('_', ' ')} {text}, the default of {shop.path.name}", key)
        for key, text in added.items()
    ]
    return added, notes


def load_shop(path: Path) -> ShopFile:
    """What a shop.toml says; InputError for a key or a value that it cannot have."""
    return replace(build(ShopFile, read_tables(path), file=str(path), key=""), path=path)


def order_of(path: Path) -> Order:
    """The [order] of a cue's file; an empty one of another file."""
    tables = read_tables(path) if path.suffix.lower() == ".toml" else {}
    made: Order = build(Order, tables.get("order", {}), file=str(path), key="order")
    return made


def picture_address(path: Path) -> str:
    """A picture as a data address; InputError if it is none or larger than `LARGEST_LOGO`."""
    content = read_bytes(path, LARGEST_LOGO)
    kind = next((kind for start, kind in PICTURES.items() if content.startswith(start)), "")
    if not kind and _is_svg(content):
        kind = "svg+xml"
    if not kind:
        raise InputError(path, "", "must be a picture for the logo: PNG, JPEG, GIF or SVG")
    return f"data:image/{kind};base64,{base64.b64encode(content).decode('ascii')}"


def _is_svg(content: bytes) -> bool:
    try:
        return ElementTree.fromstring(content).tag.rpartition("}")[2] == "svg"
    except ElementTree.ParseError:
        return False
