"""One random deck through the solver and through the oracle."""

import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import support

from .deck import text
from .decks import random_deck
from .solution import Oracle

# Beyond this the small-sliding formulation may stop, as it should; the draw is replaced.
DISPLACEMENT_MAX = 0.06
TRIES = 50


@dataclass
class Comparison:
    """Largest differences over all increments, each relative to the largest value of its kind in the deck."""

    seed: int
    points: int
    combinations: int
    closed: int
    dialect: str
    differences: dict[str, float]
    problem: str = ""


def suitable(seed, laws):
    """Deck and solutions of a seed; draws that slide too far or are ambiguous are replaced by the next draw of the seed."""
    for attempt in range(TRIES):
        deck = random_deck((seed, attempt), laws)
        oracle = Oracle(deck)
        try:
            solutions = [oracle.at(i / deck.increments) for i in range(1, deck.increments + 1)]
        except ArithmeticError:
            continue
        if max(np.abs(s.displacement).max() for s in solutions) <= DISPLACEMENT_MAX:
            return deck, oracle, solutions
    raise RuntimeError(f"seed {seed} gives no suitable deck in {TRIES} draws")


def columns(rows, *names):
    """Named columns of CSV rows as an array."""
    return np.array([[float(row[name]) for name in names] for row in rows])


def by_increment(rows):
    """Rows grouped by increment number, in order."""
    groups = {}
    for row in rows:
        groups.setdefault(int(row["increment"]), []).append(row)
    return [groups[key] for key in sorted(groups)]


def compare(seed, laws=("hard", "linear", "tabular")):
    """Solves the deck of a seed both ways."""
    deck, oracle, solutions = suitable(seed, laws)
    dialect = "calculix" if deck.full_integration else "abaqus"
    report = Comparison(seed, len(oracle.areas), max(s.combinations for s in solutions), 0, dialect, {})
    report.closed = int((solutions[-1].pressure > 0.0).sum())
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "random.inp"
        path.write_text(text(deck))
        try:
            result = support.run(path, folder, "--dialect", dialect)
            measure(report, deck, oracle, solutions, result)
        except (AssertionError, KeyError, ValueError) as error:
            report.problem = f"{type(error).__name__}: {error}"
    return report


def measure(report, deck, oracle, solutions, result):
    """Fills in the differences."""
    contact, nodes = by_increment(result.table("contact")), by_increment(result.table("nodes"))
    history = result.table("history")
    if not len(contact) == len(nodes) == len(history) == deck.increments:
        raise ValueError(f"{len(contact)}, {len(nodes)}, {len(history)} output times instead of {deck.increments}")
    order = {}
    for index, (pair, node) in enumerate((p, n) for p, d in enumerate(deck.pairs) for n in d.secondary_nodes):
        order[f"SEC{pair + 1}_PRI{pair + 1}", node + 1] = index
    scale = {
        "pressure": max(np.abs(s.pressure).max() for s in solutions),
        # Closed hard points have no clearance but rounding: displacements are what it is small against.
        "clearance": max(max(np.abs(s.overclosure).max(), np.abs(s.displacement).max()) for s in solutions),
        "displacement": max(np.abs(s.displacement).max() for s in solutions),
        "reaction": max(np.abs(s.reaction).max() for s in solutions),
        "pair force": max(np.abs(s.pair_forces).max() for s in solutions),
        "strain energy": max(abs(s.strain_energy) for s in solutions),
        "area": oracle.areas.max(),
    }
    worst = dict.fromkeys(scale, 0.0)

    def note(kind, actual, expected):
        difference = float(np.abs(actual - expected).max()) / (scale[kind] or 1.0)
        worst[kind] = max(worst[kind], difference)

    for solution, points, rows, totals in zip(solutions, contact, nodes, history, strict=True):
        places = [order[row["pair"], int(row["node"])] for row in points]
        if sorted(places) != list(range(len(order))):
            raise ValueError("contact rows are missing or repeated")
        values = columns(points, "area", "COPEN", "CPRESS")
        note("area", values[:, 0], solution.area[places])
        note("clearance", -values[:, 1], solution.overclosure[places])
        note("pressure", values[:, 2], solution.pressure[places])
        labels = [int(row["node"]) - 1 for row in rows]
        if sorted(labels) != list(range(len(deck.coordinates))):
            raise ValueError("node rows are missing or repeated")
        note("displacement", columns(rows, "U1", "U2", "U3"), solution.displacement[labels])
        note("reaction", columns(rows, "RF1", "RF2", "RF3"), solution.reaction[labels])
        for pair, force in enumerate(solution.pair_forces, 1):
            found = [float(totals[f"CFN{d}[SEC{pair}_PRI{pair}]"]) for d in (1, 2, 3)]
            note("pair force", np.array(found), force)
        note("strain energy", np.array([float(totals["ALLSE"])]), np.array([solution.strain_energy]))
    report.differences = worst
