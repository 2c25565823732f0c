"""Total forces of the generated punch and Hertz decks by the oracle's own elements, projection and areas.

    PYTHONPATH=tests:examples .venv/bin/python -m oracle.totals punch 9 --full

prints the reaction of NTOP. Dense, one body after another: some seconds for the small decks, minutes and gigabytes for the large.
Only the mesh comes from the generator; nothing comes from the solver.
"""

import argparse

import numpy as np

import generate_deck

from . import fe
from .projection import project, tributary_areas

POISSON = 0.3


class Problem:
    """A generated deck as numbers, under its default linear law."""

    def __init__(self, kind, size):
        self.data = generate_deck.PROBLEMS[kind]
        mesh = self.data.mesh(size)
        self.coordinates = np.array(mesh.nodes)
        self.bricks = {label: np.array(nodes) - 1 for part in mesh.elements.values() for label, nodes in part}
        self.bodies = {part: [label for label, _ in bricks] for part, bricks in mesh.elements.items()}
        self.sets = {name: np.array(sorted(set(labels))) - 1 for name, labels in mesh.node_sets.items()}
        self.sets["NALL"] = np.arange(len(mesh.nodes))
        self.faces = {name: [self.face(*face) for face in faces] for name, faces in mesh.surfaces.items()}
        self.prescribed = {}
        for line in self.data.supports:
            name, first, last = line.split(", ")
            for direction in range(int(first) - 1, int(last)):
                self.prescribed |= dict.fromkeys((3 * self.sets[name] + direction).tolist(), 0.0)
        self.driven = (3 * self.sets["NTOP"] + self.data.direction - 1).tolist()
        self.prescribed |= dict.fromkeys(self.driven, self.data.displacement)

    def face(self, label, number):
        """Nodes of a face, in the order whose normal points out of the brick."""
        nodes = self.bricks[label]
        return nodes[fe.outward_face(self.coordinates[nodes], number - 1)]

    def contact(self):
        """Rows dh/du, initial overclosures, areas: one per secondary node."""
        corners = [self.coordinates[nodes] for nodes in self.faces["SMA"]]
        areas = tributary_areas(len(self.coordinates), self.faces["SSL"], self.coordinates)
        points = np.unique(np.concatenate(self.faces["SSL"]))
        rows, initial = np.zeros((len(points), self.coordinates.size)), np.zeros(len(points))
        for number, node in enumerate(points):
            face, weights, normal, clearance, _ = project(self.coordinates[node], corners)
            rows[number, 3 * node : 3 * node + 3] -= normal
            for corner, weight in zip(self.faces["SMA"][face], weights, strict=True):
                rows[number, 3 * corner : 3 * corner + 3] += weight * normal
            initial[number] = -clearance
        return rows, initial, areas[points]


def forces_by_linear_law(compliance, unloaded, stiffness):
    """Forces `F` with `F = K A max(h, 0)` and `h = unloaded - W F`; `stiffness` is K A per point."""
    closed = unloaded > 0.0
    for _ in range(200):
        force = np.zeros(len(unloaded))
        inner = compliance[np.ix_(closed, closed)] + np.diag(1.0 / stiffness[closed])
        force[closed] = np.linalg.solve(inner, unloaded[closed])
        now = unloaded - compliance @ force > 0.0
        if (now == closed).all():
            return force
        closed = now
    raise ArithmeticError("the set of closed points does not settle")


def total(kind, size, full):
    """Reaction of NTOP in the direction of its displacement. `full`: plain 2x2x2 rule, otherwise mean dilatation."""
    problem = Problem(kind, size)
    rows, unloaded, areas = problem.contact()
    compliance = np.zeros((len(rows), len(rows)))
    reaction, per_force = 0.0, np.zeros(len(rows))
    for part, young in problem.data.moduli.items():
        labels = problem.bodies[part]
        nodes, local = np.unique([problem.bricks[label] for label in labels], return_inverse=True)
        local = local.reshape(len(labels), 8)
        corners = problem.coordinates[nodes]
        blocks = fe.stiffnesses(corners[local], fe.elasticity(young, POISSON), full)
        stiffness = fe.assemble(len(nodes), local, blocks)
        dofs = (3 * nodes[:, None] + np.arange(3)).ravel()
        held = np.array([dof in problem.prescribed for dof in dofs.tolist()])
        values = np.array([problem.prescribed[dof] for dof in dofs[held].tolist()])
        own = rows[:, dofs]
        coupling = stiffness[np.ix_(~held, held)]
        solved = np.linalg.solve(stiffness[np.ix_(~held, ~held)], np.column_stack([own[:, ~held].T, coupling @ values]))
        # u = -solved_last - solved_points F on the free directions.
        unloaded = unloaded + own[:, held] @ values - own[:, ~held] @ solved[:, -1]
        compliance += own[:, ~held] @ solved[:, :-1]
        driven = np.isin(dofs[held], problem.driven)
        reaction += (stiffness[np.ix_(held, held)] @ values - coupling.T @ solved[:, -1])[driven].sum()
        per_force += (own[:, held].T - coupling.T @ solved[:, :-1])[driven].sum(axis=0)
    return reaction + per_force @ forces_by_linear_law(compliance, unloaded, problem.data.stiffness * areas)


def main():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", choices=generate_deck.PROBLEMS)
    parser.add_argument("size", type=int)
    parser.add_argument("--full", action="store_true", help="plain 2x2x2 rule instead of mean dilatation")
    options = parser.parse_args()
    print(f"{total(options.kind, options.size, options.full):.3f}")


if __name__ == "__main__":
    main()
