"""Every claim of [Kim], H.-C. Kim, "Motions of a billiard ball after a cue stroke", against its own equations.

What: each numbered result of the paper is evaluated as printed, beside what follows from the equations of motion
(kim_walk.py: the impulse equations dv = B dp, followed from event to event), at one stroke: b/R = 0.5, the paper's
two-part cue (epsilon = m_c/M = 2/35, Q0 = M_c/M = 18/7, nu_c = 1/3), e = 3/4, mu = 0.7 (a rigid cue: Q0 = 3, nu_c =
0.136, mu = 0.6). Limits epsilon -> 0 are Richardson-extrapolated from the exact law. Numbers that the text quotes stand
beside the same quantities as derived. Sections are the paper's, I (introduction) to VI (summary). Equations: handbook:
Frame and signs, Inverse mass, The impulse solver, What the paper says; cuefem.squirt. Parts: kim_stroke.py (I to IV),
kim_cue.py (V, VI), kim_shaft.py (the cue end, and what finite elements say of the shaft). `python -m studies.kim`
writes kim.md and kim_*.svg beside itself; takes seconds.
"""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from cuefem import squirt
from cuefem.validation import VERDICTS, Claim, markdown
from studies import kim_cue, kim_shaft, kim_stroke

HERE = Path(__file__).parent
ENDS = (0, 2 / 35, 0.1, 0.2, 0.3, 0.4, 0.7, 1.0)
CUES = (0.3, 1, 18 / 7, 5)
STYLE = {"svg.hashsalt": "cuefem", "svg.fonttype": "path", "font.size": 10, "axes.grid": True, "grid.alpha": 0.3}


def claims() -> list[Claim]:
    """Every claim of the paper: sections I to IV, V and VI, and then what it says of the shaft itself."""
    return [*kim_stroke.rows(), *kim_cue.rows(), *kim_shaft.rows()]


def table() -> str:
    """The table of claims, with a count of the verdicts."""
    found = claims()
    count = Counter(claim.verdict for claim in found)
    counts = ", ".join(f"{verdict}: {count[verdict]}" for verdict in VERDICTS)
    return f"# What [Kim] prints, and what follows from its equations\n\n{len(found)} claims; {counts}.\n\n" + markdown(
        found
    )


def draw_rigid(axes: plt.Axes) -> None:
    """Squirt of a rigid cue over phi and Q0 (the paper's fig. squirt2)."""
    phi, ratios, psi = kim_stroke.rigid_map()
    levels = np.arange(0, 27, 2)
    phi, ratios, psi = phi[::2], ratios[1::2], psi[1::2, ::2]
    filled = axes.contourf(phi, ratios, psi, levels, cmap="viridis")
    lines = axes.contour(phi, ratios, psi, levels[1:], colors="white", linewidths=0.5)
    axes.clabel(lines, fmt="%d°", fontsize=8)
    axes.figure.colorbar(filled, ax=axes, label="squirt ψ, degrees")
    axes.set(
        xlabel="φ = asin(b/R), degrees",
        ylabel="cue over ball mass, Q₀",
        title="Rigid cue: e = 3/4, μ = 0.6, ν_c = 0.136",
    )
    axes.text(44.5, 0.25, "slip outlasts\ncompression", ha="right", fontsize=8)


def draw_ends(axes: plt.Axes) -> None:
    """Squirt of the two-part cue for eight cue ends (left panel of fig. squirt)."""
    b = np.linspace(0, 0.7, 701)
    shades = iter(plt.colormaps["viridis"](np.linspace(0.05, 0.85, len(ENDS) - 2)))
    for eps in ENDS:
        if eps == 0:
            axes.plot(b, 0 * b, color="black", label="0")
            continue
        hold = b[squirt.closed_form_holds(b, mass=18 / 7, end_mass=eps / 4, ball_mass=1.0, friction=0.7)]
        psi = squirt.closed_form(hold, mass=18 / 7, end_mass=eps / 4, ball_mass=1.0).squirt
        kim = eps == 2 / 35
        axes.plot(
            hold,
            np.degrees(psi),
            color="red" if kim else next(shades),
            lw=2.2 if kim else 1.3,
            label="2/35" if kim else f"{eps:g}",
        )
    handles, labels = axes.get_legend_handles_labels()
    axes.text(0.69, 0.3, "curves end where slip outlasts compression", ha="right", fontsize=8)
    axes.legend(handles[::-1], labels[::-1], title="m_c/M", fontsize=8)
    axes.set(
        xlabel="offset b/R",
        ylabel="squirt ψ, degrees",
        title="Two-part cue: e = 3/4, Q₀ = 18/7, μ = 0.7",
        xlim=(0, 0.7),
    )


def draw_slopes(axes: plt.Axes) -> None:
    """psi/epsilon for four cue masses: first order, and the exact law at 2/35 (right panel of fig. squirt)."""
    b = np.linspace(0, 0.58, 581)
    for colour, ratio in zip(("C0", "C1", "C2", "C3"), CUES, strict=True):
        name = "18/7" if ratio == 18 / 7 else f"{ratio:g}"
        axes.plot(b, squirt.squirt_slope(b, cue_mass_ratio=ratio), color=colour, label=name)
        exact = squirt.closed_form(b, mass=ratio, end_mass=2 / 140, ball_mass=1.0).squirt
        axes.plot(b, exact / (2 / 35), color=colour, ls="--")
    axes.legend(title="Q₀ = M_c/M", fontsize=8)
    axes.set(xlabel="offset b/R", ylabel="ψ/ε, rad", title="ψ/ε: first order (solid), ε = 2/35 (dashed)", xlim=(0, 0.6))


FIGURES = {"kim_rigid": draw_rigid, "kim_ends": draw_ends, "kim_slopes": draw_slopes}


def figures(folder: Path) -> None:
    """Draw the paper's figures into ``folder``."""
    with plt.rc_context(STYLE):
        for name, draw in FIGURES.items():
            figure, axes = plt.subplots(figsize=(6, 4.2), layout="constrained")
            draw(axes)
            figure.savefig(Path(folder) / f"{name}.svg", metadata={"Date": None})
            plt.close(figure)


def main() -> None:
    """Write the table and the figures."""
    (HERE / "kim.md").write_text(table(), encoding="utf-8")
    figures(HERE)


if __name__ == "__main__":
    main()
