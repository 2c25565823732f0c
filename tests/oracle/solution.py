"""The oracle's answer for a deck at a load factor."""

from dataclasses import dataclass

import numpy as np

from . import fe
from .decks import face_nodes, primary_corners
from .enumeration import Law, solve, solve_exponential
from .projection import project, tributary_areas


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
        blocks = [None] * len(deck.elements)
        for (young, poisson, _), members in zip(deck.materials, deck.bodies, strict=True):
            coordinates = deck.coordinates[np.array([deck.elements[e] for e in members])]
            found = fe.stiffnesses(coordinates, fe.elasticity(young, poisson), deck.full_integration)
            for element, block in zip(members, found, strict=True):
                blocks[element] = block
        self.stiffness = fe.assemble(count, deck.elements, blocks)
        self.load = self.external_forces()
        self.prescribed = np.array(sorted(deck.fixed))
        self.free = np.setdiff1d(np.arange(3 * count), self.prescribed)
        self.values = np.array([deck.fixed[d] for d in self.prescribed])
        self.contact_rows()
        inner = self.stiffness[np.ix_(self.free, self.free)]
        columns = np.column_stack([self.rows[:, self.free].T, self.load[self.free]])
        columns = np.column_stack([columns, self.stiffness[np.ix_(self.free, self.prescribed)] @ self.values])
        solved = np.linalg.solve(inner, columns)
        self.influence = solved[:, : len(self.rows)]
        self.unloaded = solved[:, -2] - solved[:, -1]
        self.compliance = self.rows[:, self.free] @ self.influence

    def external_forces(self):
        """Consistent nodal forces of all loads at factor one."""
        deck = self.deck
        forces = np.zeros(3 * len(deck.coordinates))
        for dof, value in deck.nodal_forces.items():
            forces[dof] += value
        for element, face, pressure in deck.face_pressures + deck.surface_pressures:
            (nodes,) = face_nodes(deck, [(element, face)])
            vectors = fe.face_integrals(deck.coordinates[nodes])[1]
            for node, vector in zip(nodes, vectors, strict=True):
                forces[3 * node : 3 * node + 3] -= pressure * vector
        for body, magnitude, direction in deck.gravities:
            density = deck.materials[body][2]
            for element in deck.bodies[body]:
                nodes = deck.elements[element]
                parts = fe.gravity_forces(deck.coordinates[nodes], magnitude * direction, density)
                for node, part in zip(nodes, parts, strict=True):
                    forces[3 * node : 3 * node + 3] += part
        return forces

    def contact_rows(self):
        """Rows dh/du, initial overclosures, areas, and the pair of each point."""
        deck = self.deck
        rows, initial, areas, pairs, normals = [], [], [], [], []
        for index, pair in enumerate(deck.pairs):
            corners = primary_corners(deck, pair)
            primary = face_nodes(deck, pair.primary_faces)
            tributary = tributary_areas(len(deck.coordinates), face_nodes(deck, pair.secondary_faces), deck.coordinates)
            for node in pair.secondary_nodes:
                face, weights, normal, clearance, _ = project(deck.coordinates[node], corners)
                row = np.zeros(3 * len(deck.coordinates))
                row[3 * node : 3 * node + 3] -= normal
                for corner, weight in zip(primary[face], weights, strict=True):
                    row[3 * corner : 3 * corner + 3] += weight * normal
                rows.append(row)
                initial.append(-clearance)
                areas.append((pair.node_area or 1.0) if pair.node_based else tributary[node])
                pairs.append(index)
                normals.append(normal)
        self.rows, self.initial, self.areas = np.array(rows), np.array(initial), np.array(areas)
        self.point_pairs, self.normals = np.array(pairs), np.array(normals)

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
