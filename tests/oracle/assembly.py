"""Dense matrices and vectors of a deck: stiffness, loads, contact points."""

from dataclasses import dataclass

import numpy as np

from . import fe
from .deck import face_nodes, primary_corners
from .projection import project, tributary_areas


def stiffness(deck):
    """Stiffness of solids, springs and bars."""
    blocks = [None] * len(deck.elements)
    for (young, poisson, _), members in zip(deck.materials, deck.bodies, strict=True):
        coordinates = deck.coordinates[np.array([deck.elements[e] for e in members])]
        found = fe.stiffnesses(coordinates, fe.elasticity(young, poisson), deck.full_integration)
        for element, block in zip(members, found, strict=True):
            blocks[element] = block
    total = fe.assemble(len(deck.coordinates), deck.elements, blocks)
    for connector in deck.connectors:
        row, value = elongation(deck, connector)
        total += value * np.outer(row, row)
    return total


def elongation(deck, connector):
    """Row of the elongation of a spring or bar over all dofs, and its stiffness [force/length]."""
    row = np.zeros(deck.coordinates.size)
    if connector.kind in ("SPRING1", "SPRING2"):
        for node, direction, sign in zip(connector.nodes, connector.directions, (1.0, -1.0), strict=False):
            row[3 * node + direction] += sign
        return row, connector.stiffness
    first, second = connector.nodes
    along = deck.coordinates[second] - deck.coordinates[first]
    length = np.linalg.norm(along)
    row[3 * first : 3 * first + 3] = -along / length
    row[3 * second : 3 * second + 3] = along / length
    return row, connector.young * connector.area / length if connector.kind == "T3D2" else connector.stiffness


def nodal_forces(deck, forces):
    """Vector of forces given by dof."""
    vector = np.zeros(deck.coordinates.size)
    for dof, value in forces.items():
        vector[dof] += value
    return vector


def distributed_forces(deck):
    """Consistent nodal forces of pressures and gravity."""
    forces = np.zeros(deck.coordinates.size)
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


def node_area(deck, pair, node):
    """Area of a node of a node-based surface: as given, or by the dialect."""
    if pair.node_area is not None:
        return pair.node_area
    if not deck.full_integration:
        return 1.0
    # The CalculiX dialect: a share of every face at the node that belongs to one element only.
    faces = {}
    for element, nodes in enumerate(deck.elements):
        for face, local in enumerate(fe.FACES):
            faces.setdefault(frozenset(nodes[n] for n in local), []).append((element, face))
    outer = [owners[0] for members, owners in faces.items() if node in members and len(owners) == 1]
    return sum(fe.face_integrals(deck.coordinates[n])[0].sum() / 4.0 for n in face_nodes(deck, outer))


@dataclass
class ContactPoints:
    """Contact points pair by pair: rows dh/du, overclosures at zero displacement, areas, pair and normal of each."""

    rows: np.ndarray
    overclosures: np.ndarray
    areas: np.ndarray
    pairs: np.ndarray
    normals: np.ndarray
    margin: float


def contact_points(deck):
    """Contact points of a deck. `margin` is the least distance of a foot from the edges of its face (parent coordinates)."""
    rows, initial, areas, pairs, normals, margins = [], [], [], [], [], []
    for index, pair in enumerate(deck.pairs):
        corners = primary_corners(deck, pair)
        primary = face_nodes(deck, pair.primary_faces)
        tributary = tributary_areas(len(deck.coordinates), face_nodes(deck, pair.secondary_faces), deck.coordinates)
        for node in pair.secondary_nodes:
            face, weights, normal, clearance, margin = project(deck.coordinates[node], corners)
            row = np.zeros(deck.coordinates.size)
            row[3 * node : 3 * node + 3] -= normal
            for corner, weight in zip(primary[face], weights, strict=True):
                row[3 * corner : 3 * corner + 3] += weight * normal
            rows.append(row)
            initial.append(-clearance)
            areas.append(node_area(deck, pair, node) if pair.node_based else tributary[node])
            pairs.append(index)
            normals.append(normal)
            margins.append(margin)
    arrays = (np.array(values) for values in (rows, initial, areas, pairs, normals))
    return ContactPoints(*arrays, min(margins))
