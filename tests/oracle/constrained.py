"""Structure of a deck with every constraint as a Lagrange multiplier, condensed onto its contact points.

Equilibrium and constraints, with the multipliers of equations and prescribed displacements and the contact forces F:

    K u + C' lambda + B' F = f,    C u = d,    h = h0 + B u

Z spans the motions that meet C u = 0 without strain. The system bordered by Z is regular, so that

    u = U_f + U_d - U_B F + Z alpha,    Z' (f - B' F) = 0
"""

import numpy as np

from .assembly import contact_points, distributed_forces, nodal_forces, stiffness

# Against the largest eigenvalue of K / |K| + C'C: below the first a motion is free, between the two the deck is no test case.
FREE_MAX, HELD_MIN = 1e-11, 1e-7
# Motions that move points less than this (unit motions over the whole deck) are not held by contact.
COUPLING_MIN, COUPLING_CLEAR = 1e-10, 1e-3


class Unsuitable(Exception):
    """The draw is no test case; another one is taken."""


class Structure:
    """Condensed structure of a deck. Points are ordered pair by pair, loads and prescribed values given with each solution."""

    def __init__(self, deck):
        self.deck = deck
        self.matrix = stiffness(deck)
        self.scale = np.abs(self.matrix).max()
        self.points = contact_points(deck)
        self.rows = self.points.rows
        self.prescribed = np.array(sorted(deck.fixed), dtype=int)
        self.constraints = constraint_rows(deck, self.prescribed)
        self.distributed = distributed_forces(deck)
        self.motions = self.free_motions()
        self.condense()

    def free_motions(self):
        """Orthonormal basis Z of the motions without strain that keep all constraints."""
        gram = self.matrix / self.scale + self.constraints.T @ self.constraints
        values, vectors = np.linalg.eigh(gram)
        limit = values[-1]
        if ((values > FREE_MAX * limit) & (values < HELD_MIN * limit)).any():
            raise Unsuitable("a motion is almost free")
        return vectors[:, values <= FREE_MAX * limit]

    def condense(self):
        """Responses of the bordered system to contact forces, loads and prescribed values."""
        count, held, free = len(self.matrix), len(self.constraints), self.motions.shape[1]
        size = count + held + free
        system = np.zeros((size, size))
        system[:count, :count] = self.matrix
        system[count : count + held, :count] = self.scale * self.constraints
        system[count + held :, :count] = self.scale * self.motions.T
        system[:count, count:] = system[count:, :count].T
        self.inverse = np.linalg.inv(system)
        # One step of inverse iteration: eigenvectors carry the rounding of the largest stiffness.
        self.motions = np.linalg.qr(self.inverse[:count, count + held :])[0]
        self.influence = self.inverse[:, :count] @ self.rows.T
        self.compliance = self.rows @ self.influence[:count]
        coupling = self.rows @ self.motions
        # Motions that no contact point sees are held by nothing; the others go with the contact solution.
        _, size, turns = np.linalg.svd(coupling, full_matrices=True)
        size = np.concatenate([size, np.zeros(len(turns) - len(size))])
        if ((size > COUPLING_MIN) & (size < COUPLING_CLEAR)).any():
            raise Unsuitable("contact hardly sees a motion")
        self.loose = self.motions @ turns[size <= COUPLING_MIN].T
        self.held = self.motions @ turns[size > COUPLING_MIN].T
        self.coupling = self.rows @ self.held

    def unloaded(self, load, values):
        """Displacements and multipliers without contact, under a load vector and prescribed values by dof."""
        count = len(self.matrix)
        right = np.zeros(len(self.inverse))
        right[:count] = load
        right[count : count + len(self.prescribed)] = self.scale * np.array([values[d] for d in self.prescribed])
        return self.inverse @ right

    def load(self, forces, factor=1.0):
        """Load vector: nodal forces by dof, and the distributed loads times a factor."""
        return nodal_forces(self.deck, forces) + factor * self.distributed


def constraint_rows(deck, prescribed):
    """Unit rows of the prescribed dofs, then the equations."""
    rows = np.zeros((len(prescribed) + len(deck.equations), deck.coordinates.size))
    rows[np.arange(len(prescribed)), prescribed] = 1.0
    for row, terms in zip(rows[len(prescribed) :], deck.equations, strict=True):
        for dof, coefficient in terms:
            row[dof] += coefficient
    return rows
