"""Seeded random small decks of bodies that only contact holds, with equations, springs and bars.

Loads are derived from contact forces that are drawn first, so that an equilibrium exists.
"""

import numpy as np

from . import constraints, fe
from .constrained import Structure, Unsuitable
from .deck import Deck, Pair
from .decks import FOOT_MARGIN, Builder, load, random_law, random_rotation
from .enumeration import Law

LAYOUTS = ["rest", "stack", "press", "two", "hinge", "corner"]
POINTS_MAX = 10
ALL_LAWS = ("hard", "hard", "linear", "tabular", "exponential")


class Scene(Builder):
    """Blocks on a base.

    `links` are contact pairs: secondary (body, side) list, primary (body, side). `holders` are the nodes that hold a body;
    a body without any floats. `hinge_nodes` are pairs of nodes to be joined by equations.
    """

    def __init__(self, rng, kind):
        super().__init__(rng)
        self.kind = kind
        self.links, self.hinge_nodes, self.holders = [], [], {}
        self.rough = float(rng.choice([0.0, 0.0, 0.02]))
        self.size = np.array([rng.uniform(1.2, 2.0), rng.uniform(1.0, 1.5), rng.uniform(0.4, 1.0)])
        divisions = tuple(rng.integers(1, 3, 3))
        rough = float(rng.choice([self.rough, 0.0]))
        numbers = [self.block([0, 0, -self.size[2]], [*self.size[:2], 0], divisions, 0.0, rough)]
        self.holders[0] = self.layer(numbers[0], 2, 0)
        if rng.random() < 0.15:
            self.holders[0] = list(numbers[0].values())
        getattr(self, kind)(numbers)
        self.numbers = numbers

    @staticmethod
    def layer(number, axis, level):
        """Nodes of a grid layer."""
        return [n for key, n in number.items() if key[axis] == level]

    def gap(self):
        """Distance at the start; negative is overlap."""
        return float(self.rng.uniform(-0.008, 0.008))

    def on(self, floor, divisions, inset=0.12, x=(0.0, 1.0)):
        """A block on a level, within a part of the base's width."""
        low, high = inset * self.size[:2], (1.0 - inset) * self.size[:2]
        width = high[0] - low[0]
        low_x, high_x = low[0] + x[0] * width, low[0] + x[1] * width
        bottom = floor + self.gap()
        top = bottom + self.rng.uniform(0.4, 0.8)
        return self.block([low_x, low[1], bottom], [high_x, high[1], top], divisions, self.rough, self.rough), top

    def few(self):
        """Divisions of a block with four or six points."""
        return (*[(1, 1), (1, 2), (2, 1)][self.rng.integers(3)], int(self.rng.integers(1, 3)))

    def rest(self, numbers):
        """One block on the base."""
        numbers.append(self.on(0.0, tuple(self.rng.integers(1, 3, 3)))[0])
        self.links = [([(1, "b")], (0, "t"))]

    def stack(self, numbers):
        """One block on the other on the base."""
        first, top = self.on(0.0, (1, 1, int(self.rng.integers(1, 3))))
        numbers += [first, self.on(top, self.few(), inset=0.18)[0]]
        self.links = [([(1, "b")], (0, "t")), ([(2, "b")], (1, "t"))]

    def press(self, numbers):
        """The upper one of a stack is pushed."""
        self.stack(numbers)
        self.holders[2] = self.layer(numbers[2], 2, max(key[2] for key in numbers[2]))

    def two(self, numbers):
        """Two blocks side by side."""
        numbers += [self.on(0.0, (1, 1, 1), x=(0.0, 0.46))[0], self.on(0.0, self.few(), x=(0.54, 1.0))[0]]
        self.links = [([(1, "b")], (0, "t")), ([(2, "b")], (0, "t"))]

    def hinge(self, numbers):
        """Two blocks side by side that have one lower edge in common: the same nodes, or nodes joined by equations."""
        along = int(self.rng.random() < 0.2) + 1
        numbers += [self.on(0.0, (1, along, 1), x=x)[0] for x in ((0.0, 0.5), (0.5, 1.0))]
        first, second = numbers[1], numbers[2]
        offset = self.count - len(self.points[2])
        joined = [(first[1, j, 0], second[0, j, 0]) for j in range(along + 1)]
        for j in range(along + 1):
            self.points[2][second[0, j, 1] - offset, 0] += 0.05
        for a, b in joined:
            self.points[2][b - offset] = self.all_points()[a]
        self.links = [([(1, "b")], (0, "t")), ([(2, "b")], (0, "t"))]
        if self.rng.random() < 0.5:
            self.hinge_nodes = joined
            return
        same = {b: a for a, b in joined}
        self.elements = [[same.get(n, n) for n in element] for element in self.elements]
        numbers[2] = {key: same.get(n, n) for key, n in second.items()}
        if self.rng.random() < 0.5:
            self.links = [([(1, "b"), (2, "b")], (0, "t"))]

    def corner(self, numbers):
        """A block on the base and beside a wall: the nodes of one edge belong to both pairs."""
        number, top = self.on(0.0, (1, 1, int(self.rng.integers(1, 3))), x=(0.0, 0.8))
        x = max(self.all_points()[self.layer(number, 0, 1), 0]) + self.gap()
        wall = self.block([x, 0.0, -0.15], [x + 0.5, self.size[1], top + 0.1], (1, 1, 1), 0.0, 0.0)
        numbers += [number, wall]
        self.holders[2] = self.layer(wall, 0, 1)
        self.links = [([(1, "b")], (0, "t")), ([(1, "x1")], (2, "x0"))]

    def all_points(self):
        """Coordinates so far."""
        return np.concatenate(self.points)


def pairs_of(rng, scene, laws):
    """Contact pairs of a scene; some have a second pair over a part of their nodes."""
    pairs = []
    for secondaries, (primary, side) in scene.links:
        faces = [face for body, name in secondaries for face in scene.faces[body][name]]
        nodes = sorted({scene.elements[e][n] for e, f in faces for n in fe.FACES[f]})
        node_based = bool(rng.random() < 0.2)
        area = float(rng.uniform(0.05, 0.5)) if node_based and rng.random() < 0.7 else None
        pairs.append(Pair(nodes, faces, scene.faces[primary][side], node_based, area, *random_law(rng, laws)))
    if rng.random() < 0.15:
        again = pairs[rng.integers(len(pairs))]
        part = sorted(int(n) for n in rng.choice(again.secondary_nodes, 2, replace=False))
        pairs.append(Pair(part, again.secondary_faces, again.primary_faces, True, None, *random_law(rng, laws)))
    return pairs


def supports(rng, deck, scene, rotation):
    """Held bodies are fixed and, but for the base, pushed; now and then a floating one is held along one axis."""
    for body, nodes in scene.holders.items():
        push = rotation @ [*rng.uniform(-0.003, 0.003, 2), rng.uniform(-0.02, 0.002)] if body else np.zeros(3)
        deck.fixed |= {3 * node + d: float(push[d]) for node in nodes for d in range(3)}
    if np.array_equal(rotation, np.eye(3)) and rng.random() < 0.3:
        body = int(rng.choice(floating(scene)))
        nodes = rng.choice(sorted(scene.numbers[body].values()), int(rng.integers(1, 3)), replace=False)
        deck.fixed |= {3 * int(node) + int(rng.integers(2)): float(rng.uniform(-0.002, 0.002)) for node in nodes}


def floating(scene):
    """Bodies that have no supports."""
    return [body for body in range(len(scene.numbers)) if body not in scene.holders]


def join(rng, deck, scene):
    """Hinges, equations, springs and bars."""
    bodies = [sorted(set(number.values())) for number in scene.numbers]
    equations = constraints.Equations(deck)
    for a, b in scene.hinge_nodes:
        for d in range(3):
            equations.add([(3 * b + d, 1.0), (3 * a + d, -1.0)])
    if rng.random() < 0.55:
        for _ in range(int(rng.integers(1, 4))):
            constraints.KINDS[rng.integers(len(constraints.KINDS))](rng, deck, equations, bodies)
    if rng.random() < 0.4:
        for _ in range(int(rng.integers(1, 4))):
            constraints.connect(rng, deck, bodies)


def balance(rng, structure, scene, load, nodes):
    """Nodal forces that, with a load vector, are in equilibrium with random contact forces."""
    count = len(structure.rows)
    contact = rng.uniform(0.1, 1.0, count) * (rng.random(count) < 0.8)
    motions = structure.motions
    wanted = motions.T @ (structure.rows.T @ contact - load)
    # Blocks of a hinge may share a node.
    dofs = [3 * n + d for n in dict.fromkeys(nodes) for d in range(3)]
    forces = np.linalg.lstsq(motions[dofs].T, wanted, rcond=1e-10)[0]
    if wanted.size and np.abs(motions[dofs].T @ forces - wanted).max() > 1e-12 * np.abs(wanted).max():
        raise Unsuitable("the chosen nodes cannot balance the load")
    return dict(zip(dofs, forces.tolist(), strict=True))


def prescribed_later(rng, deck):
    """Prescribed values of the second step: some are kept, some changed, supports stay."""
    return {dof: value * float(rng.choice([1.0, 0.4, -0.3])) for dof, value in deck.fixed.items()}


def draw(rng, laws, kind):
    """One deck of a layout and its structure, or Unsuitable."""
    scene = Scene(rng, kind)
    rotation = random_rotation(rng)
    materials = [
        (float(10 ** rng.uniform(2.5, 4.0)), float(rng.uniform(0.0, 0.45)), float(rng.uniform(0.1, 1.0)))
        for _ in scene.bodies
    ]
    deck = Deck(scene.all_points() @ rotation.T, scene.elements, scene.bodies, materials, pairs_of(rng, scene, laws))
    if sum(len(p.secondary_nodes) for p in deck.pairs) > POINTS_MAX:
        raise Unsuitable("too many points")
    supports(rng, deck, scene, rotation)
    load(rng, deck, 0.3)
    join(rng, deck, scene)
    deck.nodal_forces = {dof: value for dof, value in deck.nodal_forces.items() if dof not in deck.fixed}
    # With fully integrated bricks goes the other exponential law of the CalculiX dialect.
    deck.full_integration = bool(rng.random() < 0.4) and all(isinstance(p.law, Law) for p in deck.pairs)
    deck.increments = int(rng.choice([1, 1, 2, 4]))
    deck.kind = kind
    structure = Structure(deck)
    if structure.points.margin < FOOT_MARGIN:
        raise Unsuitable("a foot is on an edge")
    nodes = [
        int(n) for body in floating(scene) for n in rng.choice(sorted(set(scene.numbers[body].values())), 3, False)
    ]
    loads = [add_balance(rng, structure, scene, deck.nodal_forces, nodes)]
    if rng.random() < 0.4:
        changed = {dof: value * float(rng.uniform(-1.0, 1.0)) for dof, value in deck.nodal_forces.items()}
        loads.append(add_balance(rng, structure, scene, changed, nodes))
        deck.second = (loads[1], prescribed_later(rng, deck))
    deck.nodal_forces = loads[0]
    return deck, structure


def add_balance(rng, structure, scene, forces, nodes):
    """Nodal forces with those that balance them."""
    added = balance(rng, structure, scene, structure.load(forces), nodes)
    return {dof: forces.get(dof, 0.0) + added.get(dof, 0.0) for dof in forces | added}


def random_deck(seed, attempt=0, laws=ALL_LAWS):
    """The deck of a seed and its structure. Unsuitable draws are replaced by the next of the same stream."""
    rng = np.random.default_rng((seed, attempt))
    for _ in range(200):
        try:
            return draw(rng, laws, LAYOUTS[seed % len(LAYOUTS)])
        except Unsuitable:
            continue
    raise RuntimeError(f"seed {seed} gives no suitable deck")
