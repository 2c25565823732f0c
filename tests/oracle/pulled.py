"""Decks without equilibrium: a floating body is lifted, tipped or pushed sideways, with the proof that nothing can hold it.

The proof is a motion z without strain that keeps all constraints, closes no point (B z <= 0) and along which the load works
(f'z > 0): contact forces F >= 0 give z'(f - B'F) > 0, so that no F balances the load.
"""

import numpy as np

from .constrained import Structure, Unsuitable
from .deck import Deck
from .decks import FOOT_MARGIN, random_rotation
from .floating import ALL_LAWS, Scene, add_balance, floating, pairs_of, supports

WAYS = ["lift", "tip", "slide"]
ZERO = 1e-12


def motion(deck, scene, rotation, body, way, rng):
    """Displacements of all dofs: the body away from its support, about one of its lower edges, or along its support."""
    nodes = sorted(set(scene.numbers[body].values()))
    local = deck.coordinates[nodes] @ rotation
    if way == "tip":
        axis = int(rng.integers(2))
        arm = local[:, axis] - local[:, axis].min()
        height = local[:, 2] - local[:, 2].min()
        moves = np.zeros_like(local)
        moves[:, 2], moves[:, axis] = arm, -height
    else:
        moves = np.zeros_like(local) + ([0.0, 0.0, 1.0] if way == "lift" else [*rng.normal(size=2), 0.0])
    result = np.zeros(deck.coordinates.shape)
    result[nodes] = moves @ rotation.T
    return result.ravel()


def draw(rng):
    """A deck, the body that leaves (from zero) and the way, or Unsuitable."""
    way = str(rng.choice(WAYS))
    scene = Scene(rng, str(rng.choice(["rest", "stack", "two"])))
    rotation = random_rotation(rng)
    materials = [(float(10 ** rng.uniform(2.5, 4.0)), 0.3, 1.0) for _ in scene.bodies]
    pairs = pairs_of(rng, scene, ALL_LAWS)
    deck = Deck(scene.all_points() @ rotation.T, scene.elements, scene.bodies, materials, pairs, kind=scene.kind)
    supports(rng, deck, scene, rotation)
    structure = Structure(deck)
    if structure.points.margin < FOOT_MARGIN:
        raise Unsuitable("a foot is on an edge")
    body = floating(scene)[-1]
    away = motion(deck, scene, rotation, body, way, rng)
    strain = np.abs(structure.matrix @ away).max() / structure.scale
    if strain > 1e-10 or np.abs(structure.constraints @ away).max() > ZERO or (structure.rows @ away).max() > ZERO:
        raise Unsuitable("the motion is held")
    nodes = [int(n) for b in floating(scene) for n in rng.choice(sorted(scene.numbers[b].values()), 3, False)]
    deck.nodal_forces = add_balance(rng, structure, scene, {}, nodes)
    weight = -structure.load(deck.nodal_forces) @ away
    # Pulls where the motion is largest: tipping takes less than the weight.
    top = int(np.argmax(np.abs(away)))
    pull = (1.2 * max(weight, 0.0) + 0.5) / away[top]
    deck.nodal_forces[top] = deck.nodal_forces.get(top, 0.0) + float(pull)
    if not structure.load(deck.nodal_forces) @ away > 0.1:
        raise Unsuitable("the load does not pull")
    deck.increments = int(rng.choice([1, 3]))
    return deck, body, way


def pulled_deck(seed):
    """The deck of a seed, the body that leaves and the way. Unsuitable draws are replaced by the next of the same stream."""
    rng = np.random.default_rng(seed)
    for _ in range(200):
        try:
            return draw(rng)
        except Unsuitable:
            continue
    raise RuntimeError(f"seed {seed} gives no suitable deck")
