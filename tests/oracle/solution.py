"""The oracle's answer for a deck at a load factor."""

from dataclasses import dataclass

import numpy as np

from .assembly import contact_points, distributed_forces, nodal_forces, stiffness
from .enumeration import Law, solve, solve_exponential


@dataclass
class Solution:
    """Fields at one load factor; contact arrays are ordered pair by pair, nodes ascending."""

    displacement: np.ndarray
    reaction: np.ndarray
    pressure: np.ndarray
    overclosure: np.ndarray
    area: np.ndarray
    pair_forces: np.ndarray
    strain_energy: float
    combinations: int


class Oracle:
    """Assembles once, answers for any load factor."""

    def __init__(self, deck):
        self.deck = deck
        count = len(deck.coordinates)
        self.stiffness = stiffness(deck)
        self.load = nodal_forces(deck, deck.nodal_forces) + distributed_forces(deck)
        self.prescribed = np.array(sorted(deck.fixed))
        self.free = np.setdiff1d(np.arange(3 * count), self.prescribed)
        self.values = np.array([deck.fixed[d] for d in self.prescribed])
        points = contact_points(deck)
        self.rows, self.initial, self.areas = points.rows, points.overclosures, points.areas
        self.point_pairs, self.normals = points.pairs, points.normals
        inner = self.stiffness[np.ix_(self.free, self.free)]
        columns = np.column_stack([self.rows[:, self.free].T, self.load[self.free]])
        columns = np.column_stack([columns, self.stiffness[np.ix_(self.free, self.prescribed)] @ self.values])
        solved = np.linalg.solve(inner, columns)
        self.influence = solved[:, : len(self.rows)]
        self.unloaded = solved[:, -2] - solved[:, -1]
        self.compliance = self.rows[:, self.free] @ self.influence

    def at(self, factor):
        """Solution with all loads and prescribed displacements times `factor`."""
        moved = self.rows[:, self.prescribed] @ self.values
        free = self.initial + factor * (self.rows[:, self.free] @ self.unloaded + moved)
        laws = [self.deck.pairs[p].law for p in self.point_pairs]
        if isinstance(laws[0], Law):
            forces, overclosure, tried = solve(self.compliance, free, self.areas, laws)
        else:
            forces, overclosure = solve_exponential(self.compliance, free, self.areas, laws)
            tried = 0
        full = np.zeros(len(self.load))
        full[self.prescribed] = factor * self.values
        full[self.free] = factor * self.unloaded - self.influence @ forces
        inner = self.stiffness @ full
        reaction = inner - factor * self.load + self.rows.T @ forces
        reaction[self.free] = 0.0
        pair_forces = np.zeros((len(self.deck.pairs), 3))
        np.add.at(pair_forces, self.point_pairs, forces[:, None] * self.normals)
        energy = 0.5 * full @ inner
        shape = (-1, 3)
        return Solution(
            full.reshape(shape),
            reaction.reshape(shape),
            forces / self.areas,
            overclosure,
            self.areas,
            pair_forces,
            energy,
            tried,
        )
