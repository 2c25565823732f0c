"""Elastic blocks that bounce under gravity: the energy balance of explicit and implicit contact, law by law.

    PYTHONPATH=tests .venv/bin/python -m verification.dynamics.bouncing [--write]

A cube of 2 x 2 x 2 bricks falls onto a fixed brick, or onto an elastic one whose foot is held, again and again for ten thousand
increments. `--write` puts the figures into tests/README.md.
"""

import argparse
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from verification.dynamics import motion, published
from verification.solids import Box, node_set, surface

YOUNG, POISSON, DENSITY, GRAVITY, HEIGHT = 2e6, 0.3, 1000.0, 10.0, 0.02
INCREMENTS, IMPLICIT_INCREMENTS = 10_000, 6000
# Part of the stable increment of an element alone.
DT = float(0.35 * 0.5 / np.sqrt(YOUNG * (1 - POISSON) / ((1 + POISSON) * (1 - 2 * POISSON)) / DENSITY))

TABLE = [(0.0, 0.0), (2e3, 1e-3), (1e4, 2e-3), (4e4, 4e-3)]
LAWS = {
    "hard": motion.HARD,
    "linear": motion.linear(4e6),
    "tabular": motion.tabular(TABLE),
    "exponential": motion.exponential(2e-3, 2e3),
    "linear, no separation": ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR, NO SEPARATION", "4e6,"],
    "tabular, no separation": [
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR, NO SEPARATION",
        *(f"{p!r}, {h!r}" for p, h in TABLE),
    ],
    "hard, no separation": ["*SURFACE BEHAVIOR, NO SEPARATION"],
}


@dataclass(frozen=True)
class Case:
    """A run: law, enforcement (kinematic, penalty, or implicit), weighting (pure or balanced), damping as in the deck or none."""

    law: str
    enforcement: str
    weight: str = "pure"
    damped: bool = True
    alpha: float = -0.05

    @property
    def explicit(self):
        """Whether it is of Abaqus/Explicit."""
        return self.enforcement in ("kinematic", "penalty")

    @property
    def name(self):
        """For the table."""
        words = [self.law, self.enforcement]
        words += [self.weight] if self.explicit else [f"alpha {self.alpha:g}"]
        words += [] if self.damped or not self.explicit else ["undamped"]
        return "; ".join(words)


def cases():
    """Every legal law, enforcement and weighting."""
    found = []
    for law in LAWS:
        for enforcement in ("kinematic", "penalty"):
            if law == "hard, no separation" and enforcement == "penalty":
                continue
            for weight in ("pure", "balanced"):
                if weight == "balanced" and "no separation" in law:
                    continue
                found.append(Case(law, enforcement, weight))
        if "no separation" not in law:
            found.append(Case(law, "penalty", damped=False))
    for law in ("hard", "linear", "tabular", "exponential"):
        found += [Case(law, "implicit", alpha=0.0), Case(law, "implicit")]
    return found


def deck(case, increments, output=None, implicit_size=0.06):
    """Deck text; `implicit_size`: implicit increments over explicit ones. TOP falls onto BOTTOM; balanced pairs have an elastic BOTTOM of two layers."""
    elastic = case.weight == "balanced"
    onset = 2e-3 if case.law == "exponential" else 0.0
    low = HEIGHT + onset
    top = Box("C3D8", (0.0, 0.0, low), (1.0, 1.0, low + 1.0), (2, 2, 2))
    layers = 2 if elastic else 1
    bottom = Box(
        "C3D8",
        (-0.25, -0.25, -0.5 * layers),
        (1.25, 1.25, 0.0),
        (2, 2, layers),
        first_node=len(top.nodes) + 1,
        first_element=len(top.elements) + 1,
    )
    lines = ["*HEADING", "a block that bounces"]
    for name, box in (("TOP", top), ("BOTTOM", bottom)):
        lines += box.lines(name)
    lines += ["*MATERIAL, NAME=RUBBER", "*ELASTIC", f"{YOUNG!r}, {POISSON!r}", "*DENSITY", f"{DENSITY!r},"]
    lines += [f"*SOLID SECTION, ELSET=E{name}, MATERIAL=RUBBER" for name in ("TOP", "BOTTOM")]
    lines += surface("DOWN", top.side_faces(2, low)) + surface("UP", bottom.side_faces(2, 0.0))
    held = bottom.side(2, -0.5 * layers) if elastic else list(bottom.nodes)
    lines += node_set("FIXED", held) + node_set("ALL", [*top.nodes, *bottom.nodes])
    behavior = list(LAWS[case.law])
    if not case.damped:
        behavior += motion.UNDAMPED
    lines += ["*SURFACE INTERACTION, NAME=SI", *behavior]
    # Held nodes are primary where contact is pure.
    if case.explicit:
        words = [f"MECHANICAL CONSTRAINT={case.enforcement.upper()}"]
        words += ["WEIGHT=0.5"] if elastic else []
        pair = [", ".join(["*CONTACT PAIR, INTERACTION=SI", *words]), "DOWN, UP"]
        if not elastic:
            pair[0] += ", WEIGHT=0."
    else:
        pair = ["*CONTACT PAIR, INTERACTION=SI, TYPE=NODE TO SURFACE, SMALL SLIDING", "DOWN, UP"]
        lines += pair
    lines += ["*BOUNDARY", "FIXED, 1, 3"]
    if case.explicit:
        step = ["*STEP", "*DYNAMIC, EXPLICIT, DIRECT USER CONTROL", f"{DT!r}, {DT * increments!r}", *pair]
    else:
        dt = implicit_size * DT
        words = [f"ALPHA={case.alpha!r}"]
        step = ["*STEP, INC=100000", ", ".join(["*DYNAMIC, DIRECT", *words]), f"{dt!r}, {dt * increments!r}"]
    output = output or [
        "*NODE PRINT, NSET=ALL, FREQUENCY=100000",
        "U, V",
        "*CONTACT PRINT, FREQUENCY=100000",
        "CSTR, CDIS",
        "*END STEP",
    ]
    return "\n".join([*lines, *step, "*DLOAD", f"ETOP, GRAV, {GRAVITY!r}, 0., 0., -1.", *output]) + "\n"


@dataclass(frozen=True)
class Figures:
    """Energies of a run over the largest of them: drift of ETOTAL, what was lost where; bounces; seconds."""

    drift: float
    impact: float
    viscous: float
    contacts: int
    deepest: float


def figures(run):
    """Of a run's history."""
    names = ("ALLSE", "ALLKE", "ALLWK", "ALLFD", "ALLVD", "ALLCCE", "IMPACT_LOSS")
    energies = {name: run.energy(name) for name in names}
    largest = max(np.abs(values).max() for values in energies.values())
    total = run.energy("ETOTAL")
    own = sum(energies[n] for n in names if n != "ALLWK") - energies["ALLWK"]
    assert np.abs(own - total).max() <= 1e-9 * largest, "ETOTAL is not the sum of its parts"
    pushed = np.array([float(row["CAREA[DOWN_UP]"]) for row in run.history]) > 0.0
    return Figures(
        drift=float(np.abs(total - total[0]).max() / largest),
        impact=float(energies["IMPACT_LOSS"][-1] / largest),
        viscous=float(energies["ALLVD"][-1] / largest),
        contacts=int((pushed[1:] & ~pushed[:-1]).sum()),
        deepest=float(energies["ALLCCE"].max() / largest),
    )


def measure(case, folder, increments=None):
    """Figures of a case."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "deck.inp"
    count = increments or (INCREMENTS if case.explicit else IMPLICIT_INCREMENTS)
    path.write_text(deck(case, count), encoding="utf-8")
    return figures(motion.Run(motion.support.run(path, folder, timeout=300)))


def table(rows):
    """Markdown of (case, figures)."""
    header = [
        "law; enforcement; weighting",
        "drift of ETOTAL",
        "lost in impacts and steps",
        "lost to damping",
        "contacts begun",
    ]
    lines = [
        [c.name, f"{f.drift:.1e}" if f.drift > 1e-12 else "rounding", f"{f.impact:.1%}", f"{f.viscous:.1%}", f.contacts]
        for c, f in rows
    ]
    return published.markdown(header, lines)


def main():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="write the figures into tests/README.md")
    options = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for number, case in enumerate(cases()):
            rows.append((case, measure(case, Path(folder) / str(number))))
            print(rows[-1], flush=True)
    text = table(rows)
    print(text)
    if options.write:
        published.write("bouncing", text)


if __name__ == "__main__":
    main()
