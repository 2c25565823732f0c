"""Seeded random small decks of well-held bodies."""

import numpy as np

from . import fe
from .deck import Deck, Pair, primary_corners
from .enumeration import hard, linear, tabular
from .projection import project

POINTS_MAX = 10
FOOT_MARGIN = 1e-3


class Unsuitable(Exception):
    """The draw has a foot on an edge or outside: another draw is taken."""


def box(rng, low, high, divisions, jitter):
    """Nodes (n, 3) of a grid of bricks with inner and face nodes moved within their faces, and the grid's numbering."""
    axes = [np.linspace(low[a], high[a], divisions[a] + 1) for a in range(3)]
    number, points = {}, []
    for k in range(divisions[2] + 1):
        for j in range(divisions[1] + 1):
            for i in range(divisions[0] + 1):
                number[i, j, k] = len(points)
                points.append([axes[0][i], axes[1][j], axes[2][k]])
    points = np.array(points)
    spacing = (np.asarray(high) - low) / divisions
    moves = rng.uniform(-jitter, jitter, points.shape) * spacing
    for axis in range(3):
        flat = (points[:, axis] == low[axis]) | (points[:, axis] == high[axis])
        moves[flat, axis] *= 0.25 if axis < 2 else 0.0
    return points + moves, number


# Sides of a block: name, axis, end of the axis, face of its bricks.
SIDES = [("b", 2, 0, 0), ("t", 2, 1, 1), ("x0", 0, 0, 5), ("x1", 0, 1, 3), ("y0", 1, 0, 2), ("y1", 1, 1, 4)]


def bricks(divisions, number):
    """Elements of the grid, and the faces on each of its sides."""
    elements, faces = [], {name: [] for name, *_ in SIDES}
    for k in range(divisions[2]):
        for j in range(divisions[1]):
            for i in range(divisions[0]):
                ring = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                for name, axis, end, face in SIDES:
                    if (i, j, k)[axis] == (divisions[axis] - 1 if end else 0):
                        faces[name].append((len(elements), face))
                elements.append([number[a, b, c] for c in (k, k + 1) for a, b in ring])
    return elements, faces


class Builder:
    """Stacks blocks and collects the deck."""

    def __init__(self, rng):
        self.rng = rng
        self.points, self.elements, self.bodies, self.faces = [], [], [], []
        self.count = 0

    def block(self, low, high, divisions, rough_bottom, rough_top):
        """Adds a block; `rough_*` is the largest move of contact face nodes along the normal [length]."""
        points, number = box(self.rng, np.array(low), np.array(high), np.array(divisions), 0.12)
        elements, faces = bricks(divisions, number)
        for level, rough in ((0, rough_bottom), (divisions[2], rough_top)):
            layer = [n for (_, _, k), n in number.items() if k == level]
            points[layer, 2] += self.rng.uniform(-rough, rough, len(layer))
        first_node, first_element = self.count, len(self.elements)
        self.points.append(points)
        self.count += len(points)
        self.elements += [[n + first_node for n in e] for e in elements]
        self.bodies.append(list(range(first_element, len(self.elements))))
        self.faces.append({name: [(e + first_element, f) for e, f in side] for name, side in faces.items()})
        return {key: n + first_node for key, n in number.items()}


def random_law(rng, allowed):
    """A law for the oracle, and its data for the deck."""
    kind = rng.choice(allowed)
    if kind == "hard":
        return hard(), ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"]
    if kind == "linear":
        stiffness = float(10.0 ** rng.uniform(3.0, 6.0))
        return linear(stiffness), ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", repr(stiffness)]
    if kind == "exponential":
        c0, p0 = float(10.0 ** rng.uniform(-3.0, -2.0)), float(10.0 ** rng.uniform(-1.0, 1.0))
        return (c0, p0), ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=EXPONENTIAL", f"{c0!r}, {p0!r}"]
    steps = rng.uniform(0.001, 0.01, 2)
    rises = rng.uniform(2.0, 30.0, 2)
    onset = float(rng.uniform(-0.005, 0.003))
    points = [(0.0, onset)]
    for step, rise in zip(steps, rises, strict=True):
        points.append((points[-1][0] + float(rise), points[-1][1] + float(step)))
    lines = [f"{p!r}, {h!r}" for p, h in points]
    return tabular(points), ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR", *lines]


def layouts(rng):
    """Blocks on top of the base: either one, two side by side, or two stacked. Divisions keep the points within the limit."""
    kind = rng.choice(["single", "beside", "stacked"], p=[0.5, 0.25, 0.25])
    if kind == "single":
        return kind, [tuple(rng.integers(1, 3, 3))]
    first, second = (1, 1), [(1, 1), (1, 2), (2, 1)][rng.integers(3)]
    return kind, [(*first, int(rng.integers(1, 3))), (*second, int(rng.integers(1, 3)))]


def geometry(rng, rotation):
    """Blocks, pairs' surfaces and the nodes that hold each body."""
    build = Builder(rng)
    kind, tops = layouts(rng)
    rough = float(rng.choice([0.0, 0.01]))
    rough_primary = float(rng.choice([0.0, 0.01]))
    size = np.array([rng.uniform(1.2, 2.0), rng.uniform(1.0, 1.5), rng.uniform(0.4, 1.0)])
    base = build.block([0, 0, -size[2]], [size[0], size[1], 0], tuple(rng.integers(1, 3, 3)), 0.0, rough_primary)
    holders = [[n for (_, _, k), n in base.items() if k == 0]]
    links, floor = [], 0.0
    for index, divisions in enumerate(tops):
        gap = floor + rng.uniform(-0.008, 0.012)
        height = rng.uniform(0.4, 0.8)
        inset = 0.12 + 0.06 * index if kind == "stacked" else 0.12
        low = [inset * size[0], inset * size[1], gap]
        high = [(1 - inset) * size[0], (1 - inset) * size[1], gap + height]
        if kind == "beside":
            middle = 0.5 * size[0]
            low[0], high[0] = (low[0], middle - 0.03) if index == 0 else (middle + 0.03, high[0])
        below = index if kind == "stacked" else 0
        number = build.block(low, high, divisions, rough, rough_primary)
        top = divisions[2]
        holders.append([n for (_, _, k), n in number.items() if k == top])
        if kind == "stacked" and index == 0:
            i, j = divisions[0], divisions[1]
            holders[-1] = [number[0, 0, top], number[i, 0, top], number[0, j, top], number[i, j, top]]
            floor = high[2]
        links.append((below, index + 1))
    coordinates = np.concatenate(build.points) @ rotation.T
    return build, coordinates, links, holders


def random_rotation(rng):
    """A rotation matrix, the identity every other time."""
    if rng.random() < 0.5:
        return np.eye(3)
    q, r = np.linalg.qr(rng.normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0 else q[:, [1, 0, 2]]


def hold(rng, deck, holders, rotation):
    """Prescribed displacements: the base is fixed, each other body is held completely or at its corners, and pushed."""
    for node in holders[0]:
        deck.fixed.update({3 * node + d: 0.0 for d in range(3)})
    for body in holders[1:]:
        push = np.array([*rng.uniform(-0.004, 0.004, 2), rng.uniform(-0.03, 0.008)])
        push = rotation @ push
        sparse = rng.random() < 0.3 and np.array_equal(rotation, np.eye(3))
        chosen = body if not sparse else body[:1] + body[1:2] + body[-1:]
        for place, node in enumerate(chosen):
            directions = range(3) if not sparse or place == 0 else ([1, 2] if place == 1 else [0, 2])
            for d in directions:
                tilt = rng.uniform(-0.001, 0.001) if rng.random() < 0.3 else 0.0
                deck.fixed[3 * node + d] = float(push[d] + tilt)


def load(rng, deck, size=1.0):
    """Any of: nodal forces, pressure on element faces, pressure on a surface, gravity; all of them times a size."""
    if rng.random() < 0.5:
        for node in rng.choice(len(deck.coordinates), 2, replace=False):
            deck.nodal_forces[3 * int(node) + int(rng.integers(3))] = size * float(rng.uniform(-3.0, 3.0))
    for target in (deck.face_pressures, deck.surface_pressures):
        if rng.random() < 0.4:
            target.append(
                (int(rng.integers(len(deck.elements))), int(rng.integers(6)), size * float(rng.uniform(-4.0, 8.0)))
            )
    if rng.random() < 0.4:
        direction = rng.normal(size=3)
        deck.gravities.append(
            (
                int(rng.integers(len(deck.bodies))),
                size * float(rng.uniform(1.0, 10.0)),
                direction / np.linalg.norm(direction),
            )
        )


def draw(rng, laws):
    """One deck, or Unsuitable."""
    rotation = random_rotation(rng)
    build, coordinates, links, holders = geometry(rng, rotation)
    materials = [
        (float(10 ** rng.uniform(2.5, 4.0)), float(rng.uniform(0.0, 0.45)), float(rng.uniform(0.1, 1.0)))
        for _ in build.bodies
    ]
    deck = Deck(coordinates, build.elements, build.bodies, materials, [])
    for primary, secondary in links:
        faces = build.faces[secondary]["b"]
        nodes = sorted({build.elements[e][n] for e, f in faces for n in fe.FACES[f]})
        node_based = bool(rng.random() < 0.25)
        area = float(rng.uniform(0.05, 0.5)) if node_based and rng.random() < 0.7 else None
        law, behavior = random_law(rng, laws)
        deck.pairs.append(Pair(nodes, faces, build.faces[primary]["t"], node_based, area, law, behavior))
    hold(rng, deck, holders, rotation)
    load(rng, deck)
    deck.full_integration = bool(rng.random() < 0.4)
    deck.increments = int(rng.choice([1, 1, 2, 4]))
    for pair in deck.pairs:
        corners = primary_corners(deck, pair)
        for node in pair.secondary_nodes:
            if project(coordinates[node], corners)[4] < FOOT_MARGIN:
                raise Unsuitable
    if sum(len(p.secondary_nodes) for p in deck.pairs) > POINTS_MAX:
        raise Unsuitable
    return deck


def random_deck(seed, laws=("hard", "linear", "tabular")):
    """The deck of a seed. Unsuitable draws are replaced by the next of the same stream."""
    rng = np.random.default_rng(seed)
    for _ in range(200):
        try:
            return draw(rng, laws)
        except Unsuitable:
            continue
    raise RuntimeError(f"seed {seed} gives no suitable deck")
