"""A sourced table of the materials that cues are made of: pure data.

Each entry is a `Material` with the ranges in which real pieces lie and the place where the numbers stand. Woods are
read as a rod along the grain: E is E_L, G the mean of G_LR and G_LT (a turned shaft shows both planes), nu the mean of
nu_LR and nu_LT, rho that at 12 % moisture. "Textbook value" marks what was taken from standard tables of its kind and
not from a measurement on a cue; "estimate" marks what no source gives. The last section of meshes/README.md says
which of the pages were at hand and which books are quoted without.

Keys: [FPL] Wood Handbook, USDA Forest Service FPL-GTR-282 (2021), the same numbers as FPL-GTR-190 (2010), ch. 5.
[CH] Cremer & Heckl, Structure-Borne Sound, 2nd ed. 1988, table 3.1 (bending loss factors). [Call] Callister, Materials
Science and Engineering, appendix B. [Phil] Philpot, Mechanics of Materials, 2017, table D.1. [Ono] Ono & Norimoto,
Jpn. J. Appl. Phys. 22 (1983) 611: tan delta = 10^-1.23 (E/rho)^-0.68, E/rho in GPa m3/Mg, woods along the grain.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from difflib import get_close_matches
from types import MappingProxyType

from cuefem.cue.geometry import Material

Range = tuple[float, float]


@dataclass(frozen=True)
class Leather:
    """The leather of a tip that is given by its geometry (`cuefem.LeatherTip`), SI, and where its numbers are from.

    contact_time: of a head-on blow of the reference tip at 2 m/s, s (see `LEATHERS`), which fixes E.
    """

    E: float
    nu: float
    rho: float
    contact_time: float
    source: str


@dataclass(frozen=True)
class Documented:
    """A material, the ranges in which real pieces of it lie (SI; keys E, G, rho, loss, nu), and its source."""

    material: Material
    ranges: Mapping[str, Range]
    source: str
    note: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "ranges", MappingProxyType(dict(self.ranges)))


BENDING_TO_LONGITUDINAL = 1.10  # [FPL] 5-2: a bending test's modulus holds shear; E_L is 10 % above it
AIR_DRY = 1120.0  # kg/m3 for each unit of [FPL]'s specific gravity (oven-dry mass over volume at 12 %)


def _wood(
    *,
    bending_modulus: float,
    G_LR: float,
    G_LT: float,
    rho: float,
    loss: float,
    nu_LR: float,
    nu_LT: float,
    across: tuple[float, float, float, float] | None = None,
) -> Material:
    """A wood along its grain from [FPL]'s columns: modulus of a bending test, Pa; G_LR, G_LT as fractions of E_L.

    across: E_R and E_T as fractions of E_L, nu_RT and nu_TR. A turned shaft shows both planes: the mean of the two
    moduli, and the geometric mean of the two Poisson's ratios, which one plane of equal moduli would have.
    """
    E_R, E_T, nu_RT, nu_TR = across or (None, None, None, None)
    E = BENDING_TO_LONGITUDINAL * bending_modulus
    return Material(
        E=E,
        G=E * (G_LR + G_LT) / 2,
        rho=rho,
        loss=loss,
        nu=(nu_LR + nu_LT) / 2,
        across_ratio=None if E_R is None or E_T is None else (E_R + E_T) / 2,
        nu_across=None if nu_RT is None or nu_TR is None else round(math.sqrt(nu_RT * nu_TR), 2),
    )


def _ranges(*, E: Range, G: Range, rho: Range, loss: Range, nu: Range) -> Mapping[str, Range]:
    return {"E": E, "G": G, "rho": rho, "loss": loss, "nu": nu}


_WOODS = {
    "hard maple": Documented(
        _wood(
            bending_modulus=12.6e9,
            G_LR=0.111,
            G_LT=0.063,
            rho=0.63 * AIR_DRY,
            loss=0.012,
            nu_LR=0.424,
            nu_LT=0.476,
            across=(0.132, 0.065, 0.774, 0.349),
        ),
        _ranges(E=(10.8e9, 16.9e9), G=(0.85e9, 1.55e9), rho=(630, 780), loss=(0.007, 0.016), nu=(0.42, 0.48)),
        "[FPL] sugar maple: table 5-3a (12 %), elastic ratios table 5-1, Poisson's ratios table 5-2. "
        "Loss: Haines, Catgut Acoust. Soc. Newsl. 31 (1979) 23, maple along the grain",
        "Ranges of E and rho are one coefficient of variation (22 % and 10 %, [FPL] table 5-6), of G from all G_LT to "
        "all G_LR. [Ono] gives a loss of 0.008, the low end.",
    ),
    "ash": Documented(
        _wood(
            bending_modulus=12.0e9,
            G_LR=0.109,
            G_LT=0.077,
            rho=0.60 * AIR_DRY,
            loss=0.010,
            nu_LR=0.371,
            nu_LT=0.440,
        ),
        _ranges(E=(10.3e9, 16.1e9), G=(1.0e9, 1.45e9), rho=(600, 740), loss=(0.007, 0.016), nu=(0.37, 0.44)),
        "[FPL] white ash: table 5-3a (12 %), tables 5-1 and 5-2. Loss: estimate between [Ono] (0.008) and maple",
        "White ash of North America; snooker cues are often of European ash, which is close to it.",
    ),
    "yellow birch": Documented(
        _wood(
            bending_modulus=13.9e9,
            G_LR=0.074,
            G_LT=0.068,
            rho=0.62 * AIR_DRY,
            loss=0.010,
            nu_LR=0.426,
            nu_LT=0.451,
        ),
        _ranges(E=(11.9e9, 18.7e9), G=(0.95e9, 1.25e9), rho=(620, 770), loss=(0.006, 0.016), nu=(0.42, 0.46)),
        "[FPL] yellow birch: table 5-3a (12 %), tables 5-1 and 5-2. Loss: estimate between [Ono] (0.007) and maple",
    ),
    "purpleheart": Documented(
        _wood(bending_modulus=15.7e9, G_LR=0.087, G_LT=0.069, rho=860.0, loss=0.008, nu_LR=0.37, nu_LT=0.45),
        _ranges(E=(15.7e9, 22.3e9), G=(1.0e9, 1.8e9), rho=(830, 905), loss=(0.005, 0.012), nu=(0.35, 0.46)),
        "[FPL] Peltogyne, table 5-5a (2.27e6 psi at 12 %). Density: 833 (52 lb/ft3, air dry) to 905 (The Wood "
        "Database, which gives 20.3 GPa). Loss: [Ono]",
        "G and nu estimate: the mean ratios of the 14 hardwoods of [FPL] table 5-1, G = 0.078 E; no measurement found.",
    ),
    "rosewood": Documented(
        _wood(bending_modulus=12.3e9, G_LR=0.087, G_LT=0.069, rho=830.0, loss=0.008, nu_LR=0.37, nu_LT=0.45),
        _ranges(E=(11.0e9, 16.0e9), G=(0.8e9, 1.4e9), rho=(750, 900), loss=(0.005, 0.012), nu=(0.35, 0.46)),
        "[FPL] Indian rosewood (Dalbergia latifolia), table 5-5a (12 %). Density: The Wood Database. Loss: [Ono]",
        "G and nu estimate, as for purpleheart.",
    ),
}

_COMPOSITES_AND_PLASTICS = {
    "carbon fibre": Documented(
        Material(E=79.7e9, G=14.0e9, rho=1580.0, loss=0.005, nu=0.27, across_ratio=0.545, nu_across=0.3),
        _ranges(E=(29.6e9, 135e9), G=(5e9, 35e9), rho=(1500, 1650), loss=(0.002, 0.015), nu=(0.2, 0.5)),
        "Lamination theory with a textbook ply of standard-modulus carbon and epoxy, 60 % fibre: E1 135, E2 10, "
        "G12 5 GPa, nu12 0.3. Density: [Call] table B.1, fibre 1780 and epoxy 1250. Loss: textbook value, Gibson, "
        "Principles of Composite Material Mechanics",
        "Layup of a roll-wrapped tube, along its axis: 50 % of the plies at 0, 30 % at +-45, 20 % at 90 degrees (an "
        "assumption: makers do not tell). The lower E is the least that US patent 6,110,051 claims for a cue shaft "
        "(4.3e6 psi), the upper the bare ply at 0 degrees. Across the axis: the hoop modulus of that layup, 43.4 GPa.",
    ),
    "foam": Documented(
        Material(E=30e6, G=11e6, rho=96.0, loss=0.03, nu=0.33),
        _ranges(E=(8e6, 60e6), G=(3e6, 20e6), rho=(48, 160), loss=(0.01, 0.1), nu=(0.2, 0.4)),
        "Textbook value: Gibson & Ashby, Cellular Solids, 2nd ed. 1997, ch. 5, rigid polyurethane (solid 1.6 GPa, "
        "1200 kg/m3)",
        "Closed cells, 6 lb/ft3; E between (rho/rho_s)^2 E_s of the edges alone and that with stretched faces. "
        "It carries no load in a shaft: its density is what counts.",
    ),
    "leather": Documented(
        Material(E=100e6, G=36e6, rho=1000.0, loss=0.15, nu=0.4),
        _ranges(E=(45e6, 210e6), G=(15e6, 75e6), rho=(850, 1100), loss=(0.1, 0.25), nu=(0.3, 0.5)),
        "Cue tips: head-on contact times of 1 ms (Alciatore, billiards.colostate.edu, high-speed video) with a pool "
        "ball and cue mean 0.97 MN/m. Loss: restitution 0.71 to 0.75 of playing tips (Alciatore, TP A.30). Density "
        "and nu: textbook values of compressed sole leather",
        "E is inferred and the least certain number here: 45 MPa if a 6 mm disc of leather holds all of the "
        "compliance, 210 MPa if the touching spot (5 mm wide) does its share. Loss: (1 - e^2)/pi.",
    ),
    "abs": Documented(
        Material(E=2.3e9, G=0.85e9, rho=1050.0, loss=0.02, nu=0.35),
        _ranges(E=(1.9e9, 2.7e9), G=(0.7e9, 1.0e9), rho=(1030, 1070), loss=(0.01, 0.04), nu=(0.33, 0.4)),
        "[Phil] 2.1 GPa, 1060 kg/m3; CCT Precision data sheet 346,000 psi, 1.04. nu and loss: textbook values",
    ),
    "phenolic": Documented(
        Material(E=7.2e9, G=2.7e9, rho=1340.0, loss=0.02, nu=0.33),
        _ranges(E=(6.5e9, 9.7e9), G=(2.3e9, 3.7e9), rho=(1320, 1380), loss=(0.01, 0.04), nu=(0.25, 0.4)),
        "Linen phenolic, NEMA grade L/LE: CCT Precision data sheet, flexural modulus 1.05e6 psi (canvas 0.95, paper "
        "1.3 to 1.4), specific gravity 1.34. G, nu, loss: textbook values",
    ),
    "melamine": Documented(
        Material(E=8.6e9, G=3.2e9, rho=1500.0, loss=0.02, nu=0.33),
        _ranges(E=(7.6e9, 9.7e9), G=(2.7e9, 3.8e9), rho=(1400, 1520), loss=(0.01, 0.04), nu=(0.25, 0.4)),
        "Textbook value: Modern Plastics Encyclopedia, melamine with alpha-cellulose, 1.1 to 1.4e6 psi, 1.47 to 1.52",
        "Stands for linen-based melamine, the common ferrule material and ivory substitute, of which no modulus was "
        "found. G, nu, loss: textbook values.",
    ),
    "nylon": Documented(
        Material(E=2.8e9, G=1.0e9, rho=1140.0, loss=0.03, nu=0.40),
        _ranges(E=(1.2e9, 3.3e9), G=(0.43e9, 1.2e9), rho=(1100, 1150), loss=(0.01, 0.1), nu=(0.35, 0.42)),
        "Nylon 6/6: Beer & Johnston, Mechanics of Materials, appendix B (0.4e6 psi, 0.0412 lb/in3). nu: ecoursesbook. "
        "Loss: textbook value",
        "Dry; nylon in damp air is about half as stiff ([Phil] 1.4 GPa).",
    ),
}

_METALS = {
    "brass": Documented(
        Material(E=97e9, G=37e9, rho=8500.0, loss=5e-4, nu=0.31),
        _ranges(E=(97e9, 115e9), G=(35e9, 44e9), rho=(8390, 8740), loss=(0, 1e-3), nu=(0.30, 0.35)),
        "Free-cutting brass C36000: [Call] appendix B (textbook value). Loss: [CH], below 1e-3",
    ),
    "steel": Documented(
        Material(E=193e9, G=76e9, rho=7900.0, loss=4e-4, nu=0.27),
        _ranges(E=(190e9, 207e9), G=(73e9, 81e9), rho=(7850, 8000), loss=(2e-4, 6e-4), nu=(0.26, 0.32)),
        "Stainless steel 303/304: [Call], [Phil] (textbook value). Loss: [CH], 2e-4 to 6e-4",
    ),
    "aluminium": Documented(
        Material(E=68.9e9, G=26e9, rho=2700.0, loss=1e-4, nu=0.33),
        _ranges(E=(68e9, 74e9), G=(25.5e9, 28e9), rho=(2690, 2810), loss=(3e-5, 2e-4), nu=(0.32, 0.35)),
        "Alloy 6061-T6: [Call], [Phil] (textbook value). Loss: [CH], about 1e-4",
    ),
    "titanium": Documented(
        Material(E=114e9, G=43e9, rho=4430.0, loss=1e-3, nu=0.33),
        _ranges(E=(110e9, 120e9), G=(41e9, 45e9), rho=(4400, 4460), loss=(3e-4, 3e-3), nu=(0.31, 0.36)),
        "Ti-6Al-4V: [Phil] (textbook value). Loss: estimate",
    ),
}

MATERIALS: Mapping[str, Documented] = MappingProxyType(_WOODS | _COMPOSITES_AND_PLASTICS | _METALS)
WOODS: tuple[str, ...] = tuple(_WOODS)

# The leathers of tips by their hardness. No source gives an E that was measured on the leather of a tip, so each is
# that with which a head-on blow at 2 m/s lasts as long as is published: a maple pool shaft and a pool ball (a cue of
# 566 g; 170 g, 57.15 mm), a tip 12.75 mm wide and 6 mm high, its dome of 9.5 mm, e = 0.73
# (studies/measured/leather_tip.toml).
_INFERRED = "E is inferred from that time and not measured. nu and density: textbook values of compressed sole leather"
LEATHERS: Mapping[str, Leather] = MappingProxyType(
    {
        "soft": Leather(
            *(30e6, 0.4, 1000.0, 2.0e-3),
            f"2 ms head on at 2 m/s: the longest of the published contact times, 0.8 to 2 ms. {_INFERRED}",
        ),
        "medium": Leather(
            *(140e6, 0.4, 1000.0, 1.135e-3),
            "1.135 ms head on at 2 m/s: Alciatore, billiards.colostate.edu, high-speed video, 1.0 to 1.2 ms of medium "
            f"leather. {_INFERRED}",
        ),
        "hard": Leather(
            *(360e6, 0.4, 1000.0, 0.8e-3),
            f"0.8 ms head on at 2 m/s: the shortest of the published contact times, 0.8 to 2 ms. {_INFERRED}",
        ),
    }
)

_ASSUMED = "Its E was not measured and is assumed: that of {} leather"
_KAMUI = "Kamui: layers of leather, sold as super soft, soft, medium and hard (mcbillard.de, cue tip guide). "
# Tips that are sold, as the leather that stands for them.
TIPS: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        **{f"kamui {grade}": (grade, _KAMUI + _ASSUMED.format(grade)) for grade in ("soft", "medium", "hard")},
        "moori soft": (
            "soft",
            f"Moori: layers of leather, sold by hardness (mooribrand.com). {_ASSUMED.format('soft')}",
        ),
        "moori medium": ("medium", f"As Moori soft, harder. {_ASSUMED.format('medium')}"),
        "elk master": ("soft", f"Tweeten's Elk Master: one layer, told to be soft. {_ASSUMED.format('soft')}"),
        "le professional": (
            "medium",
            f"Tweeten's Le Professional: one layer, told to be medium to hard. {_ASSUMED.format('medium')}",
        ),
    }
)
# What names a leather in a file, an option and the designer: E, nu and rho by the leather's or the tip's name.
LEATHER_NAMES: Mapping[str, Mapping[str, float]] = MappingProxyType(
    {
        name: {"E": LEATHERS[leather].E, "nu": LEATHERS[leather].nu, "rho": LEATHERS[leather].rho}
        for name, leather in [*((name, name) for name in LEATHERS), *((name, tip[0]) for name, tip in TIPS.items())]
    }
)


def material(name: str) -> Material:
    """The material of this name in `MATERIALS`, in any case; ValueError, suggesting others, if there is none."""
    plain = " ".join(name.replace("_", " ").replace("-", " ").casefold().split())
    plain = _ALSO.get(plain, plain)
    if plain not in MATERIALS:
        raise ValueError(f"no material is called {name!r}; {_offer(plain)}")
    return MATERIALS[plain].material


def table_name(material: Material) -> str | None:
    """The name in the table of a material, or of one that differs from it in density alone; None if there is none."""
    alike = (name for name, known in MATERIALS.items() if replace(known.material, rho=material.rho) == material)
    return next((name for name, known in MATERIALS.items() if known.material == material), next(alike, None))


def material_name(material: Material) -> str:
    """A material's name in the table of materials, with its density if that is its own; or its modulus."""
    name = table_name(material)
    if name is None:
        return f"E {material.E / 1e9:.4g} GPa"
    return name if MATERIALS[name].material == material else f"{name} of {material.rho:.0f} kg/m³"


def _offer(name: str) -> str:
    """The materials that a name may mean: those that share a word with it, then those that are spelt like it."""
    words = {word for word in name.split() if len(word) > 2}
    near = [known for word in words for known in _KINDS.get(word, ())]
    near += [known for known in MATERIALS if words & {*known.split()} or any(known.startswith(word) for word in words)]
    near += [] if near else get_close_matches(name, MATERIALS, n=3, cutoff=0.6)
    return f"nearest: {', '.join(dict.fromkeys(near))}" if near else f"known: {', '.join(MATERIALS)}"


# Other names of entries: spellings, and words that mean one entry alone.
_ALSO = {
    "sugar maple": "hard maple",
    "rock maple": "hard maple",
    "white ash": "ash",
    "purple heart": "purpleheart",
    "carbon": "carbon fibre",
    "carbon fiber": "carbon fibre",
    "cfrp": "carbon fibre",
    "stainless steel": "steel",
    "aluminum": "aluminium",
}
# Words of materials that are not in the table, and what is offered for them.
_KINDS = {
    **dict.fromkeys(("wood", "timber", "oak", "beech", "ebony", "cherry", "walnut", "hickory", "cocobolo"), WOODS),
    **dict.fromkeys(
        ("plastic", "ivory", "bone", "horn", "juma", "elforyn", "ferrule"), tuple(_COMPOSITES_AND_PLASTICS)[3:]
    ),
    **dict.fromkeys(("metal", "iron", "alloy"), tuple(_METALS)),
}
