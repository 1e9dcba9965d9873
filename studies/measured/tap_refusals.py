"""How often does the tap test mistake another sound for a tap, and how often does it refuse a real one?

Other sounds: tap_sounds.py, without any tap in them, against the drawings of meshes/ in turn. Honest taps:
shafts of meshes/ and of random outline, each of another wood drawn evenly from the whole range of a wood of the table
(a tube from that of carbon fibre), diameters off by 0.1 %, weighed to 0.5 g or not at all, one or two taps, 10 to 40
dB, 44.1 or 48 kHz; the file says hard maple, or what it says. Hummed: the same with mains hum 7 dB above the ring.
Refused: status 1 or 2 without --doubted. About 30 minutes.

A shaft that was not weighed keeps the density of its drawing. Where the wood's own is another, the fixed masses of
ferrule and tip weigh too much or too little against the wood, and E/rho with them: the two are shown apart.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np
from scipy.stats import beta

from cuefem import Cue, Material, Segment
from cuefem.materials import MATERIALS, WOODS, material
from cuefem.measured.chance import LEVEL, by_chance
from cuefem.measured.fit import TapFit
from cuefem.measured.ringing import ringing
from cuefem.measured.tones import tones
from cuefem.measured.wood import TapTest
from cuefem.parts import main_material, with_material
from studies import pages
from studies.measured import tap, tap_sounds
from studies.pages import table
from studies.strokes import NAMES, cue

EACH = 25  # other sounds of each kind
HONEST, HUMMED = 40, 10
HUM = 7.0  # dB over the ring


def others(kind: str, seed: int) -> tuple[float, TapFit | None]:
    """What the test says of a sound that is no tap: the p-value, 1 without any tones, and the fit where that is low."""
    test = tap.hung(NAMES[seed % len(NAMES)])
    try:
        heard = tones(ringing(tap_sounds.other_sound(kind, seed), tap_sounds.RATE))
        chance = by_chance(test.table, heard)
        return chance, test.fit(heard) if chance <= LEVEL else None
    except (ValueError, RuntimeError):
        return 1.0, None


def drawing(seed: int, draw: np.random.Generator) -> Cue:
    """A cue of meshes/, or a plain shaft of random outline with a ferrule."""
    kind = seed % (len(NAMES) + 2)
    if kind < len(NAMES):
        return cue(NAMES[kind])
    tip, butt, maple = draw.uniform(11e-3, 14e-3), draw.uniform(19e-3, 24e-3), material("hard maple")
    long = draw.uniform(0.25, 0.4)
    return Cue(
        (
            Segment(0.022, tip, tip, material("melamine")),
            Segment(long, tip, tip + draw.uniform(0, 1e-3), maple),
            Segment(draw.uniform(0.6, 0.8) - long, tip + 1e-3, butt, maple),
        ),
        0.4,
    )


def drawn_wood(old: Material, draw: np.random.Generator) -> Material:
    """Another material of its kind, from anywhere in its range."""
    tube = old.E > 30e9
    ranges = MATERIALS["carbon fibre" if tube else str(draw.choice(WOODS))].ranges
    E, G, rho = (draw.uniform(*ranges[key]) for key in ("E", "G", "rho"))
    return replace(old, E=E, G=min(max(G, E / 20), E / 3) if tube else G, rho=rho)


def honest(seed: int, *, hummed: bool = False) -> tuple[TapFit | None, Material]:
    """What the test says of a true tap, and the wood that rang."""
    draw = np.random.default_rng([seed, 7])
    drawn = drawing(seed, draw)
    wood = drawn_wood(main_material(drawn), draw)
    true = with_material(drawn, main_material(drawn), wood)
    off = 1 + 1e-3 * draw.standard_normal((len(true.segments), 2))
    true = replace(
        true,
        segments=tuple(
            replace(s, tip_diameter=a * s.tip_diameter, butt_diameter=b * s.butt_diameter)
            for s, (a, b) in zip(true.segments, off, strict=True)
        ),
    )
    rate = float(draw.choice([44100.0, 48000.0]))
    sound = tap.ringing_shaft(true, rate)[:, :1]
    snr, taps = draw.uniform(10, 40), int(draw.integers(1, 3))
    if hummed:
        rings = np.mean(np.square(sound[int(tap.BEFORE * rate) :]))
        mains = float(draw.choice([50.0, 60.0]))
        noise = np.sqrt(rings * 10 ** (-snr / 10)) * draw.standard_normal((taps * len(sound), 1))
        hum = tap_sounds.hum(draw, len(noise), rate, mains=mains) * np.sqrt(rings * 10 ** (HUM / 10))
        samples = np.tile(sound, (taps, 1)) + noise + hum[:, None]
        samples = np.round(samples / np.abs(samples).max() * 32000) / 32768
    else:
        samples = tap.recording(sound, snr, seed, taps=taps)
    mass = true.shaft_mass + 5e-4 * draw.standard_normal() if draw.uniform() < 0.75 else None
    try:
        return TapTest(drawn, mass=mass).fit(tones(ringing(samples, rate))), wood
    except (ValueError, RuntimeError):
        return None, wood


def accepted(found: TapFit | None) -> bool:
    return found is not None and not found.refusals


def share(count: int, of: int) -> str:
    """A count of so many, with the upper end of its one-sided 95 % interval (Clopper and Pearson)."""
    most = 1.0 if count == of else float(beta.ppf(0.95, count + 1, of - count))
    return f"{count} of {of} ({100 * count / of:.1f} %, below {100 * most:.1f} % at 95 %)"


def off(sound: list[tuple[TapFit, Material]], weighed: bool) -> str:
    """Median and largest error of E/rho, %, of the shafts that were weighed, or of those that were not."""
    found = [
        abs(100 * (fit.wood.E / fit.wood.rho * wood.rho / wood.E - 1)) for fit, wood in sound if fit.weighed == weighed
    ]
    return f"{np.median(found):.2f}, {max(found):.2f}" if found else "-"


def cause(found: TapFit | None) -> str:
    return "no tones of such a shaft" if found is None else found.refusals[0].split(" (")[0]


def row_of(kind: str) -> list[str]:
    """A kind of sound: recordings, those that the p-value lets pass, and those taken for a tap."""
    found = [others(kind, seed) for seed in range(EACH)]
    unlikely, taken = sum(chance <= LEVEL for chance, _ in found), sum(accepted(fit) for _, fit in found)
    return [kind, str(EACH), str(unlikely), str(taken)]


def text() -> str:
    rows = [row_of(kind) for kind in tap_sounds.KINDS]
    wrong, total = sum(int(row[3]) for row in rows), EACH * len(rows)
    own = table(["sound", "recordings", f"p at most {LEVEL:g}", "taken for a tap"], rows)
    made, causes = [], Counter[str]()
    for name, count, hummed in (("honest", HONEST, False), ("hummed", HUMMED, True)):
        both = [honest(seed, hummed=hummed) for seed in range(count)]
        refused = [one for one, _ in both if not accepted(one)]
        causes.update(map(cause, refused))
        sound = [(one, wood) for one, wood in both if one is not None and accepted(one)]
        made.append(f"| {name} | {share(len(refused), count)} | {off(sound, True)} | {off(sound, False)} |")
    why = "; ".join(f"{count} {line}" for line, count in sorted(causes.items())) or "none"
    return (
        f"# What the tap test refuses\n\nOther sounds taken for a tap: {share(wrong, total)}.\n\n{own}\n"
        "| taps | refused | weighed: E/rho off, %, median and most | not weighed |\n|---|---|---|---|\n"
        + "\n".join(made)
        + "\n\n"
        f"Why honest taps were refused: {why}.\n"
    )


STUDY = pages.Study(
    __file__,
    text,
    again={
        kind: pages.Again(lambda kind=kind: pages.row(row_of(kind)), left_out=None)
        for kind in ("speech", "struck plate")
    },
)


if __name__ == "__main__":
    STUDY.write()
