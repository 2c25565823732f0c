"""One random deck of floating bodies through the solver and through the oracle, compared in what is unique.

A motion that changes no closed point is held by nothing: displacements and clearances are compared up to such motions, and the
motion itself must stay small. Contact forces of hard points that depend on each other are compared up to what cancels.
"""

import itertools
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

import support

from . import laws
from .comparison import columns
from .deck import text
from .equilibrium import Contact
from .floating import random_deck

# Beyond this the small-sliding formulation may stop, as it should; the draw is replaced.
DISPLACEMENT_MAX = 0.06
# An unheld motion may not be larger than this many times the largest displacement without it.
DRIFT_MAX = 3.0
TRIES = 60
NEGLIGIBLE = 1e-9


@dataclass
class Comparison:
    """Largest differences over all increments, each relative to the largest value of its kind in the deck."""

    seed: int
    kind: str = ""
    points: int = 0
    closed: list[int] = field(default_factory=list)
    floating: int = 0
    loose: int = 0
    equations: int = 0
    connectors: int = 0
    redundant: bool = False
    unresolved: int = 0
    differences: dict[str, float] = field(default_factory=dict)
    problem: str = ""


def solutions(deck, structure):
    """States at every increment of every step."""
    steps = [(0.0, {}, dict.fromkeys(deck.fixed, 0.0)), (1.0, deck.nodal_forces, deck.fixed)]
    if deck.second:
        steps.append((1.0, *deck.second))
    loads = [(structure.load(forces, factor), values) for factor, forces, values in steps]
    found = []
    for (load0, values0), (load1, values1) in itertools.pairwise(loads):
        for i in range(1, deck.increments + 1):
            t = i / deck.increments
            values = {d: (1.0 - t) * values0[d] + t * values1[d] for d in deck.fixed}
            contact = Contact(structure, (1.0 - t) * load0 + t * load1, values)
            found.append(contact.equilibrium())
            if np.abs(found[-1].displacement).max() > DISPLACEMENT_MAX:
                raise ArithmeticError("slides far")
    return found


def suitable(seed):
    """Deck, structure and solutions of a seed, and how many draws had no solution that the oracle could prove."""
    unresolved = 0
    for attempt in range(TRIES):
        deck, structure = random_deck(seed, attempt)
        try:
            return deck, structure, solutions(deck, structure), unresolved
        except ArithmeticError as error:
            unresolved += "keeps all" in str(error)
    raise RuntimeError(f"seed {seed} gives no suitable deck in {TRIES} draws")


def compare(seed):
    """Solves the deck of a seed both ways."""
    deck, structure, states, unresolved = suitable(seed)
    report = Comparison(seed, deck.kind, len(structure.rows), unresolved=unresolved)
    report.closed = [int((s.forces > 0.0).sum()) for s in states]
    report.floating, report.loose = structure.held.shape[1], structure.loose.shape[1]
    report.equations, report.connectors = len(deck.equations), len(deck.connectors)
    dialect = "calculix" if deck.full_integration else "abaqus"
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "random.inp"
        path.write_text(text(deck))
        try:
            result = support.run(path, folder, "--dialect", dialect)
            Measure(report, deck, structure, states).all(result)
        except (AssertionError, KeyError, ValueError) as error:
            report.problem = f"{type(error).__name__}: {error}"
    return report


class Measure:
    """Differences between the solver's tables and the oracle's states."""

    def __init__(self, report, deck, structure, states):
        self.report, self.deck, self.structure, self.states = report, deck, structure, states
        self.points = structure.points
        self.laws = [deck.pairs[p].law for p in self.points.pairs]
        self.hard = np.array([laws.is_hard(law) for law in self.laws])
        forces = max(np.abs(s.forces).max() for s in states)
        moved = max(np.abs(s.displacement).max() for s in states)
        reactions = [np.abs(s.multipliers).max(initial=0.0) for s in states]
        load = np.abs(structure.load(deck.nodal_forces)).max()
        # Bodies that only move carry forces of rounding, which is small against stiffness times displacement.
        rounding = 1e-5 * structure.scale * moved
        self.scale = {
            "area": self.points.areas.max(),
            "force": max(forces, load, rounding),
            "clearance": max(moved, np.abs(self.points.overclosures).max()),
            "displacement": moved,
            "reaction": max(*reactions, forces, load, rounding),
            "strain energy": max(*(self.energy(s.displacement) for s in states), rounding * moved),
        }
        self.worst = dict.fromkeys(self.scale, 0.0)
        # Reactions of dofs that only equations hold are nobody's support.
        tied = {dof for terms in deck.equations for dof, _ in terms} - set(deck.fixed)
        self.free_of_equations = np.array([dof not in tied for dof in range(deck.coordinates.size)])

    def energy(self, displacement):
        """Strain energy."""
        return 0.5 * displacement @ self.structure.matrix @ displacement

    def note(self, kind, difference):
        """Keeps the largest difference."""
        value = float(np.abs(difference).max(initial=0.0)) / (self.scale[kind] or 1.0)
        self.worst[kind] = max(self.worst[kind], value if np.isfinite(value) else np.inf)

    def all(self, result):
        """Goes through all output times."""
        tables = [result.table(name) for name in ("contact", "nodes", "history")]
        contact, nodes = (by_time(rows) for rows in tables[:2])
        if not len(contact) == len(nodes) == len(tables[2]) == len(self.states):
            raise ValueError(f"{len(contact)}, {len(nodes)}, {len(tables[2])} times instead of {len(self.states)}")
        for state, points, rows, totals in zip(self.states, contact, nodes, tables[2], strict=True):
            self.one(state, points, rows, totals)
        self.report.differences = self.worst

    def one(self, state, points, rows, totals):
        """One output time."""
        order = self.deck.point_labels()
        places = [order[row["pair"], int(row["node"])] for row in points]
        labels = [int(row["node"]) - 1 for row in rows]
        if sorted(places) != list(range(len(order))) or sorted(labels) != list(range(len(self.deck.coordinates))):
            raise ValueError("rows are missing or repeated")
        table = np.empty((len(order), 3))
        table[places] = columns(points, "area", "COPEN", "CPRESS")
        found = np.empty((len(labels), 6))
        found[labels] = columns(rows, "U1", "U2", "U3", "RF1", "RF2", "RF3")
        displacement, forces = found[:, :3].ravel(), table[:, 0] * table[:, 2]
        self.note("area", table[:, 0] - self.points.areas)
        self.displacements(state, displacement, -table[:, 1])
        self.forces(state, forces, totals)
        self.note("strain energy", float(totals["ALLSE"]) - self.energy(state.displacement))
        reaction = np.zeros(len(displacement))
        reaction[self.structure.prescribed] = -state.multipliers[: len(self.structure.prescribed)]
        self.note("reaction", (found[:, 3:].ravel() - reaction)[self.free_of_equations])
        statuses = dict(zip(places, (row["status"] for row in points), strict=True))
        self.statuses(state, -table[:, 1], [statuses[i] for i in range(len(order))])

    def displacements(self, state, displacement, overclosures):
        """Displacements and overclosures up to motions that no closed point feels."""
        s = self.structure
        closed = state.forces > NEGLIGIBLE * self.scale["force"]
        _, size, turns = np.linalg.svd(s.rows[closed] @ s.motions, full_matrices=True)
        size = np.concatenate([size, np.zeros(len(turns) - len(size))])
        unheld = s.motions @ turns[size <= 1e-9].T
        difference = displacement - state.displacement
        drift = unheld @ (unheld.T @ difference)
        self.note("displacement", difference - drift)
        self.note("clearance", overclosures - state.overclosures - s.rows @ drift)
        own = np.abs(displacement - unheld @ (unheld.T @ displacement)).max()
        if np.abs(displacement).max() > DRIFT_MAX * own + NEGLIGIBLE:
            raise ValueError(f"a motion that nothing holds went {np.abs(displacement).max()}, the rest {own}")

    def forces(self, state, forces, totals):
        """Contact forces up to what cancels among dependent hard points; pair forces as sums of the point forces."""
        s = self.structure
        hard = self.hard & (np.abs(state.overclosures) <= NEGLIGIBLE * self.scale["clearance"])
        felt = np.vstack([s.compliance[:, hard] / np.diag(s.compliance).mean(), s.coupling[hard].T])
        _, size, turns = np.linalg.svd(felt, full_matrices=True)
        size = np.concatenate([size, np.zeros(len(turns) - len(size))])
        cancel = turns[size <= 1e-9]
        self.report.redundant |= bool(len(cancel))
        difference = forces - state.forces
        difference[hard] -= cancel.T @ (cancel @ difference[hard])
        self.note("force", difference)
        if forces.min() < -NEGLIGIBLE * self.scale["force"]:
            raise ValueError(f"a point pulls with {-forces.min()}")
        for pair in range(len(self.deck.pairs)):
            own = self.points.pairs == pair
            total = forces[own] @ self.points.normals[own]
            name = f"SEC{pair + 1}_PRI{pair + 1}"
            self.note("force", np.array([float(totals[f"CFN{d}[{name}]"]) for d in (1, 2, 3)]) - total)

    def statuses(self, state, overclosures, statuses):
        """Clear cases only: a point that presses is closed, one with a clearance is open."""
        for law, force, h, status in zip(self.laws, state.forces, overclosures, statuses, strict=True):
            presses = force > 1e-6 * self.scale["force"]
            apart = h < laws.onset(law) - 1e-6 * self.scale["clearance"]
            redundant = laws.is_hard(law) and self.report.redundant
            if (presses and status != "CL" and not redundant) or (apart and status != "OP"):
                raise ValueError(f"status {status} with force {force} and overclosure {h}")


def by_time(rows):
    """Rows grouped by output time, in order."""
    groups = {}
    for row in rows:
        groups.setdefault((int(row["step"]), int(row["increment"])), []).append(row)
    return [groups[key] for key in sorted(groups)]
