"""Shafts with bores anywhere, as drills, plugs and inserts leave them; no tests."""

from hypothesis import strategies as st

from cuefem import Cue, Segment
from cuefem.cue.materials import material

MAPLE, MELAMINE, FOAM = map(material, ("hard maple", "melamine", "foam"))


@st.composite
def bored_cues(draw: st.DrawFn) -> Cue:
    """A shaft of 6 to 12 pieces, the first ones short; each solid, bored, bored as a cone, or filled with foam."""
    lengths = draw(st.lists(st.integers(2, 30), min_size=3, max_size=5))
    lengths += draw(st.lists(st.integers(20, 160), min_size=3, max_size=7))
    tip, end = draw(st.floats(8.5, 14.0)), draw(st.floats(18.0, 22.0))
    total, start, pieces = sum(lengths), 0, list[Segment]()
    has_ferrule = draw(st.booleans())
    for i, length in enumerate(lengths):
        outer = [tip + (end - tip) * x / total for x in (start, start + length)]
        widths = draw(st.lists(st.floats(2.0, 0.85 * min(outer)), min_size=2, max_size=2))
        kind = draw(st.sampled_from(("solid", "solid", "bored", "bored", "cone", "foam")))
        bore = {"solid": (0.0, 0.0), "cone": tuple(widths)}.get(kind, (widths[0], widths[0]))
        wood = MELAMINE if has_ferrule and i == 0 else MAPLE
        sizes = [size / 1e3 for size in (length, *outer, *bore)]
        pieces.append(Segment(*sizes[:3], wood, *sizes[3:], core=FOAM if kind == "foam" else None))
        start += length
    return Cue(tuple(pieces), body_mass=0.43)
