"""What the comparisons share: our solution of a deck by node, the dense ones, and the smoothed law as a table."""

from pathlib import Path

import numpy as np

import support
from peers import springs

HERE = Path(__file__).resolve().parent


def by_node(deck, displacements):
    """Displacements of a dense solution by node, as in a `.dat` block."""
    return {(label,): displacements[3 * i : 3 * i + 3].tolist() for i, label in enumerate(deck.labels)}


def ours(path, folder):
    """Displacements by (node label,) of our solution at its end, and the summary."""
    result = support.run(path, folder, "--dialect", "calculix")
    rows = {(int(row["node"]),): [float(row[f"U{d}"] or 0.0) for d in (1, 2, 3)] for row in result.last("nodes")}
    return rows, result.summary()


def exact(deck):
    """Our law; in the CalculiX dialect the areas are CalculiX's."""
    law = springs.Exact(deck.law[0]) if deck.kind == "LINEAR" else springs.Exponential(*deck.law)
    return springs.solve(deck, law, deck.areas)


def calculix(deck):
    """CalculiX's law and its areas."""
    if deck.kind == "EXPONENTIAL":
        return springs.solve(deck, springs.Exponential(*deck.law), deck.areas)
    return springs.solve(deck, springs.Smoothed(deck.law[0], deck.law[1], deck.areas), deck.areas)


def smoothed_table(deck, largest):
    """Data lines `pressure, overclosure` of CalculiX's law for h >= 0, up to the overclosure `largest`.

    The points stand in proportion, 2 % apart, from a millionth of the largest overclosure: straight lines between them miss
    the curve by less than 1e-4 of the pressure at its bend, and by far less where it is straight.
    """
    law = springs.Smoothed(deck.law[0], deck.law[1], deck.areas)
    steps = np.arange(700)
    overclosures = np.array([0.0, *(largest * 1.02 ** (steps - steps[-1]))])
    pressures = law.curve(overclosures)
    return [f"{p!r}, {h!r}" for p, h in zip(pressures.tolist(), overclosures.tolist(), strict=True)]


def with_table(text, deck, largest):
    """Deck text with the law replaced by its table."""
    lines, skip = [], False
    for line in text.splitlines():
        keyword = line.upper().replace(" ", "")
        if keyword.startswith("*SURFACEBEHAVIOR"):
            lines += ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR", *smoothed_table(deck, largest)]
            skip = True
        elif line.startswith("*"):
            skip = False
        if not skip:
            lines.append(line)
    return "\n".join(lines) + "\n"
