"""Graded meshes around a contact point: a core of equal elements inside shells that grow.

The core is the cube 0 <= x, y, z <= b (the square 0 <= x, z <= b in two dimensions) of a body that fills z > 0, with n elements on
each side. Each side but those in the planes x = 0, y = 0 and z = 0 carries n (or n x n) elements outwards from shell to shell, so
that an element stays about as wide as it is thick. Shells change from cubes to spheres about the contact point where asked.

`ball` bends such a mesh of a half ball of radius 2 R into one half of a ball of radius R that touches z = 0 at the origin: the
inversion about the pole opposite. It keeps angles and, next to the origin, lengths; the sphere |x| = 2 R becomes the equator.
"""

import itertools
from dataclasses import dataclass, field

import numpy as np

# Faces of a brick: S3 holds its edge from corner 1 to corner 2, S6 the one from corner 4 to corner 1.
SIDES = {"bottom": 1, "edge_12": 3, "edge_41": 6}


@dataclass
class Mesh:
    """Bricks of one body.

    points: coordinates (nodes, 3); bricks: positions of the corners (bricks, 8); contact: (brick, face number) on z = 0, from the
    contact point outwards shell by shell; outer: (brick, face number) on the last shell; shell: shell of each node, 0 in the core.
    """

    points: np.ndarray
    bricks: np.ndarray
    contact: list = field(default_factory=list)
    outer: list = field(default_factory=list)
    shell: np.ndarray = None

    def on(self, axis, level, tolerance):
        """Positions of the nodes in a coordinate plane."""
        return np.flatnonzero(np.abs(self.points[:, axis] - level) <= tolerance)


def shells(core, end, first, growth):
    """Sizes of the shells from `core` to `end`.

    The first is thicker than its size by the part `first`, later ones by first (size / core)^growth: what a shell adds to the
    energy falls as 1 / size, so its elements may be coarser. Half of `first` gives half the thickness everywhere.
    """
    sizes = [core]
    while sizes[-1] < end:
        sizes.append(sizes[-1] * (1.0 + first * (sizes[-1] / core) ** growth))
    logs = np.log(np.array(sizes) / core)
    return core * np.exp(logs * (np.log(end / core) / logs[-1]))


def rounding(count):
    """How far each of `count` shells has become round, from 0 to 1."""
    return np.linspace(0.0, 1.0, count)


def place(unit, size, roundness, stretch):
    """Points of a shell: `unit` (points, dimensions) on the unit cube, blended with the unit sphere, times the sizes."""
    sphere = unit / np.linalg.norm(unit, axis=1, keepdims=True)
    shaped = ((1.0 - roundness) * unit + roundness * sphere) * size
    shaped[:, -1] *= stretch
    return shaped


def solid(n, sizes, round_shells=True):
    """Bricks of a quarter of a body: n in each direction in the core of side sizes[0], shells of the other sizes."""
    keys = list(itertools.product(range(n + 1), repeat=3))
    skin = [key for key in keys if max(key) == n]
    number = {(0, *key): p for p, key in enumerate(keys)}
    blocks = [np.array(keys) * (sizes[0] / n)]
    round_by = rounding(len(sizes)) if round_shells else np.zeros(len(sizes))
    for level, (size, roundness) in enumerate(zip(sizes[1:], round_by[1:], strict=True), start=1):
        number.update({(level, *key): len(number) + p for p, key in enumerate(skin)})
        blocks.append(place(np.array(skin) / n, size, roundness, 1.0))
    mesh = Mesh(np.concatenate(blocks), None)
    mesh.shell = np.repeat(np.arange(len(blocks)), [len(b) for b in blocks])
    bricks = []
    for i, j, k in itertools.product(range(n), repeat=3):
        ring = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
        if k == 0:
            mesh.contact.append((len(bricks), SIDES["bottom"]))
        bricks.append([number[0, a, b, c] for c in (k, k + 1) for a, b in ring])
    for level in range(len(sizes) - 1):
        for axis, u, v in itertools.product(range(3), range(n), range(n)):
            # Seen from outside, the corners run around from the axis after this one to the next: y z, z x, x y.
            ring = []
            for p, q in ((u, v), (u + 1, v), (u + 1, v + 1), (u, v + 1)):
                key = [0, 0, 0]
                key[axis], key[(axis + 1) % 3], key[(axis + 2) % 3] = n, p, q
                ring.append(tuple(key))
            if axis == 0 and v == 0:
                mesh.contact.append((len(bricks), SIDES["edge_12"]))
            if axis == 1 and u == 0:
                mesh.contact.append((len(bricks), SIDES["edge_41"]))
            if level == len(sizes) - 2:
                mesh.outer.append((len(bricks), 2))
            bricks.append([number[(c, *key)] for c in (level, level + 1) for key in ring])
    mesh.bricks = np.array(bricks)
    return mesh


def strip(n, sizes, thickness, round_shells=True, stretch=1.0):
    """One layer of bricks of half a body in plane strain, along x and z; y runs from 0 to the thickness.

    The last shell is `stretch` times as deep (z) as it is wide, the core as deep as wide, those between in proportion.
    """
    keys = list(itertools.product(range(n + 1), repeat=2))
    skin = [key for key in keys if max(key) == n]
    number = {(0, *key): p for p, key in enumerate(keys)}
    blocks = [np.array(keys) * (sizes[0] / n)]
    progress = rounding(len(sizes))
    for level, size in enumerate(sizes[1:], start=1):
        number.update({(level, *key): len(number) + p for p, key in enumerate(skin)})
        roundness = progress[level] if round_shells else 0.0
        blocks.append(place(np.array(skin) / n, size, roundness, 1.0 + (stretch - 1.0) * progress[level]))
    plane = np.concatenate(blocks)
    count = len(plane)
    layer = [np.column_stack([plane[:, 0], np.full(count, y), plane[:, 1]]) for y in (thickness, 0.0)]
    mesh = Mesh(np.concatenate(layer), None)
    mesh.shell = np.tile(np.repeat(np.arange(len(blocks)), [len(b) for b in blocks]), 2)
    quads = []
    for i, k in itertools.product(range(n), repeat=2):
        if k == 0:
            mesh.contact.append((len(quads), SIDES["edge_12"]))
        quads.append([number[0, a, b] for a, b in ((i, k), (i + 1, k), (i + 1, k + 1), (i, k + 1))])
    for level in range(len(sizes) - 1):
        for k in range(n):
            if k == 0:
                mesh.contact.append((len(quads), SIDES["edge_12"]))
            if level == len(sizes) - 2:
                mesh.outer.append((len(quads), 4))
            ring = (level, n, k), (level + 1, n, k), (level + 1, n, k + 1), (level, n, k + 1)
            quads.append([number[key] for key in ring])
        for i in range(n):
            if level == len(sizes) - 2:
                mesh.outer.append((len(quads), 5))
            ring = (level, i, n), (level, i + 1, n), (level + 1, i + 1, n), (level + 1, i, n)
            quads.append([number[key] for key in ring])
    mesh.bricks = np.array([[*quad, *(count + p for p in quad)] for quad in quads])
    return mesh


def ball(points, radius):
    """Bends the half space z > 0 into the ball of that radius about (0, 0, radius); along y too where the points have a y."""
    mirrored = points * [1.0, 1.0, -1.0]
    from_pole = mirrored - [0.0, 0.0, 2.0 * radius]
    squared = np.sum(from_pole**2, axis=1, keepdims=True)
    bent = [0.0, 0.0, 2.0 * radius] + (2.0 * radius) ** 2 * from_pole / squared
    return bent


def disc(points, radius):
    """The same in the plane of x and z; y stays."""
    bent = ball(points * [1.0, 0.0, 1.0], radius)
    bent[:, 1] = points[:, 1]
    return bent


def flipped(mesh):
    """The mirror image at z = 0, corners in the order that keeps volumes positive."""
    order = [4, 5, 6, 7, 0, 1, 2, 3]
    swapped = {1: 2, 2: 1}
    contact, outer = (
        [(brick, swapped.get(face, face)) for brick, face in faces] for faces in (mesh.contact, mesh.outer)
    )
    return Mesh(mesh.points * [1.0, 1.0, -1.0], mesh.bricks[:, order], contact, outer, mesh.shell)


def volumes(mesh):
    """Jacobian determinants at the corners of every brick, times 8; all positive in a valid mesh."""
    neighbours = [(1, 3, 4), (2, 0, 5), (3, 1, 6), (0, 2, 7), (7, 5, 0), (4, 6, 1), (5, 7, 2), (6, 4, 3)]
    corners = mesh.points[mesh.bricks]
    found = []
    for corner, (a, b, c) in enumerate(neighbours):
        edges = [corners[:, other] - corners[:, corner] for other in (a, b, c)]
        found.append(np.einsum("ij,ij->i", np.cross(edges[0], edges[1]), edges[2]))
    return np.array(found)
