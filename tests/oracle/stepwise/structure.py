"""The structure of a plan seen from its contact points: compliance of normal and tangential rows, and free motion over time."""

import numpy as np

from ..assembly import contact_points, distributed_forces, nodal_forces, stiffness


def tangents(normal):
    """Local directions of a surface: the projection of axis 1 (of axis 3 where the normal is within 0.1 degrees of axis 1), and
    the normal crossed with it."""
    axis = np.array([1.0, 0.0, 0.0])
    if abs(normal[0]) > np.cos(np.radians(0.1)):
        axis = np.array([0.0, 0.0, 1.0])
    first = axis - (axis @ normal) * normal
    first /= np.linalg.norm(first)
    return first, np.cross(normal, first)


class Structure:
    """Rows: overclosures of all points, then their displacements along the first and along the second tangent."""

    def __init__(self, plan):
        deck = plan.deck
        self.plan, self.count = plan, deck.coordinates.size
        self.matrix = stiffness(deck)
        self.distributed = distributed_forces(deck)
        points = contact_points(deck)
        self.points, self.size = points, len(points.areas)
        self.rows = np.vstack([points.rows, *self.tangential_rows()])
        self.initial = points.overclosures.copy()
        names = list(deck.point_labels())
        for pair, given in enumerate(plan.clearances):
            for node, clearance in (given or {}).items():
                self.initial[names.index((f"SEC{pair + 1}_PRI{pair + 1}", node + 1))] = -clearance
        self.prescribed = np.array(sorted(plan.steps[0].fixed))
        self.free = np.setdiff1d(np.arange(self.count), self.prescribed)
        self.inverse = np.linalg.inv(self.matrix[np.ix_(self.free, self.free)])
        self.influence = self.inverse @ self.rows[:, self.free].T
        self.compliance = self.rows[:, self.free] @ self.influence

    def tangential_rows(self):
        """Displacement of the secondary node relative to its foot along both tangents."""
        for which in (0, 1):
            found = np.zeros_like(self.points.rows)
            for row, normal, target in zip(self.points.rows, self.points.normals, found, strict=True):
                direction = tangents(normal)[which]
                # A normal row is -n at the secondary node and N n at the corners: turn n into the tangent, with the sign of the node.
                along = row.reshape(-1, 3) @ normal
                target[:] = -(along[:, None] * direction).ravel()
            yield found

    def unloaded(self, step, fraction):
        """Displacements without contact at a fraction of a step."""
        load = self.loads(step, fraction)
        u = np.zeros(self.count)
        u[self.prescribed] = self.prescribed_values(step, fraction)
        right = load - self.matrix[:, self.prescribed] @ u[self.prescribed]
        u[self.free] = self.inverse @ right[self.free]
        return u, load

    def loads(self, step, fraction):
        """Forces: nodal ones from step to step, distributed ones over the first step."""
        now = self.kept_forces(step)
        before = self.kept_forces(step - 1) if step else np.zeros(self.count)
        part = fraction if step == 0 else 1.0
        return before + fraction * (now - before) + part * self.distributed

    def kept_forces(self, step):
        """Nodal forces at the end of a step: what an earlier step gave a dof stays."""
        kept = {}
        for earlier in self.plan.steps[: step + 1]:
            kept |= earlier.forces
        return nodal_forces(self.plan.deck, kept)

    def prescribed_values(self, step, fraction):
        """Prescribed displacements."""
        now = np.array([self.plan.steps[step].fixed[d] for d in self.prescribed])
        before = np.array([self.plan.steps[step - 1].fixed[d] for d in self.prescribed]) if step else 0.0 * now
        return before + fraction * (now - before)

    def displaced(self, unloaded, forces):
        """Displacements under contact forces by row."""
        u = unloaded.copy()
        u[self.free] -= self.influence @ forces
        return u

    def reactions(self, u, load, forces):
        """Reactions by dof, zero where nothing is prescribed."""
        reaction = self.matrix @ u - load + self.rows.T @ forces
        reaction[self.free] = 0.0
        return reaction
