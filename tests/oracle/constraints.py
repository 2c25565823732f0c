"""Random equations, springs and bars between the bodies of a deck."""

import numpy as np

from .deck import Connector


class Equations:
    """Adds equations to a deck; a dof depends once, is not prescribed then, and depends on itself through no chain."""

    def __init__(self, deck):
        self.deck = deck
        self.depends = {}

    def add(self, terms):
        """Takes an equation if it is allowed. Returns whether it was."""
        first = terms[0][0]
        others = [dof for dof, _ in terms[1:]]
        if first in self.deck.fixed or first in self.depends or first in self.reached(others):
            return False
        self.depends[first] = set(others)
        self.deck.equations.append([(int(dof), float(coefficient)) for dof, coefficient in terms])
        return True

    def reached(self, dofs):
        """Dofs on which the given ones depend, through any chain, and they themselves."""
        seen, rest = set(), list(dofs)
        while rest:
            dof = rest.pop()
            if dof not in seen:
                seen.add(dof)
                rest += self.depends.get(dof, ())
        return seen


def add_node(deck, place):
    """Appends a node that belongs to no solid; returns its number."""
    deck.coordinates = np.vstack([deck.coordinates, place])
    return len(deck.coordinates) - 1


def dof(rng, nodes, direction=None):
    """A random dof of one of the nodes."""
    return 3 * int(rng.choice(nodes)) + int(rng.integers(3) if direction is None else direction)


def tie(rng, deck, equations, bodies):
    """One direction of a node follows the same of another body's."""
    a, b = rng.choice(len(bodies), 2, replace=False)
    direction = int(rng.integers(3))
    equations.add([(dof(rng, bodies[a], direction), 1.0), (dof(rng, bodies[b], direction), -1.0)])


def average(rng, deck, equations, bodies):
    """A reference node moves as the mean of some nodes; it is loaded, prescribed, or only follows."""
    nodes = rng.choice(bodies[rng.integers(1, len(bodies))], 4, replace=False)
    direction = int(rng.integers(3))
    reference = add_node(deck, deck.coordinates[nodes].mean(axis=0) + np.array([0.0, 0.0, 0.5]))
    own = 3 * reference + direction
    terms = [(3 * int(n) + direction, 0.25) for n in nodes] + [(own, -1.0)]
    use = rng.choice(["loaded", "prescribed", "follows"])
    if use == "follows" or (use == "loaded" and rng.random() < 0.5):
        terms = [terms[-1], *terms[:-1]]
    if use == "prescribed":
        deck.fixed[own] = float(rng.uniform(-0.004, 0.004))
    added = equations.add(terms)
    if use == "loaded" and added:
        deck.nodal_forces[own] = float(rng.uniform(-1.0, 1.0))
    if rng.random() < 0.5:
        deck.fixed |= {3 * reference + d: 0.0 for d in range(3) if d != direction}


def combination(rng, deck, equations, bodies):
    """Random coefficients over dofs of one body, as no structure has them."""
    nodes = bodies[rng.integers(1, len(bodies))]
    dofs = {dof(rng, nodes) for _ in range(int(rng.integers(2, 6)))}
    if len(dofs) > 1:
        equations.add([(d, c) for d, c in zip(dofs, rng.choice([-1.0, 1.0, 0.5, 2.0, -0.7], len(dofs)), strict=True)])


def chain(rng, deck, equations, bodies):
    """A dof follows one that follows two others; written in either order."""
    nodes = bodies[rng.integers(1, len(bodies))]
    a, b, c, d = 3 * rng.choice(nodes, 4, replace=False) + int(rng.integers(3))
    links = [[(a, 1.0), (b, -1.0)], [(b, 2.0), (c, -1.0), (d, -1.0)]]
    for terms in links if rng.random() < 0.5 else links[::-1]:
        equations.add(terms)


def roller(rng, deck, equations, bodies):
    """A node slides in a plane that is askew."""
    nodes = bodies[rng.integers(1, len(bodies))]
    normal = rng.normal(size=3)
    first = int(np.argmax(np.abs(normal)))
    node = 3 * int(rng.choice(nodes))
    equations.add([(node + d, normal[d]) for d in (first, (first + 1) % 3, (first + 2) % 3)])


KINDS = [tie, average, combination, chain, roller]


def connect(rng, deck, bodies):
    """One spring or bar on a floating body: to another body, or to the ground."""
    body = int(rng.integers(1, len(bodies)))
    other = int(rng.choice([b for b in range(len(bodies)) if b != body]))
    ends = [int(rng.choice(bodies[body])), int(rng.choice(bodies[other]))]
    stiffness = float(10.0 ** rng.uniform(1.0, 3.0))
    kind = str(rng.choice(["SPRING1", "SPRING2", "SPRINGA", "T3D2"]))
    if kind in ("SPRING1", "SPRING2"):
        directions = tuple(int(d) for d in rng.integers(0, 3, 2 if kind == "SPRING2" else 1))
        deck.connectors.append(Connector(kind, ends[: len(directions)], stiffness, directions))
        return
    if rng.random() < 0.4:
        ends[1] = add_node(deck, deck.coordinates[ends[0]] + rng.normal(size=3))
        deck.fixed |= {3 * ends[1] + d: float(v) for d, v in enumerate(rng.uniform(-0.002, 0.002, 3))}
    if np.linalg.norm(deck.coordinates[ends[0]] - deck.coordinates[ends[1]]) < 0.1:
        return
    if kind == "SPRINGA":
        deck.connectors.append(Connector(kind, ends, stiffness))
    else:
        deck.connectors.append(Connector(kind, ends, young=1000.0, area=float(rng.uniform(0.01, 0.5))))
