"""Seeded random plans: small decks of held bodies whose contact changes from step to step."""

import numpy as np

from .. import fe
from ..deck import face_nodes
from ..decks import random_deck
from ..enumeration import hard
from .plan import Behavior, Controls, Plan, Step

POINTS_MAX_ROUGH = 6
KINDS = [
    "augmented",
    "penalty",
    "nonlinear",
    "separation",
    "modified",
    "rough",
    "bonded",
    "damped",
    "changing",
    "given",
]


def scale(rng, low, high):
    """A random size, evenly spread over its logarithm."""
    return float(10.0 ** rng.uniform(low, high))


def damping(rng):
    """(mu0, c0, eta): over gaps of the decks, weak beside the bodies."""
    return scale(rng, -1.0, 1.5), scale(rng, -2.3, -1.5), float(rng.choice([0.0, rng.uniform(0.0, 0.9)]))


def behavior(rng, kind):
    """A behaviour of a kind of plan."""
    clearance = float(rng.choice([0.0, rng.uniform(0.0, 0.004)]))
    if kind == "augmented":
        return Behavior("augmented", scale(rng, 3.0, 5.0), clearance)
    if kind == "penalty":
        return Behavior("penalty", scale(rng, 3.0, 5.0), clearance)
    if kind == "nonlinear":
        curve = (scale(rng, -2.7, -2.0), float(rng.uniform(0.01, 0.3)), float(rng.uniform(0.1, 0.6)))
        return Behavior("nonlinear", scale(rng, 3.5, 5.5), clearance, curve)
    if kind in ("separation", "bonded"):
        return Behavior("hard", separation=False, rough=kind == "bonded")
    if kind == "rough":
        which = rng.choice(["hard", "linear", "augmented"])
        return Behavior(str(which), scale(rng, 3.0, 5.0) if which != "hard" else 0.0, rough=True)
    if kind == "damped":
        which = str(rng.choice(["hard", "linear", "penalty", "augmented"]))
        return Behavior(which, scale(rng, 3.0, 5.0) if which != "hard" else 0.0, damping=damping(rng))
    if kind == "modified":
        return Behavior("hard")
    which = str(rng.choice(["hard", "linear", "augmented", "separation"]))
    if which == "separation":
        return Behavior("hard", separation=False)
    return Behavior(which, scale(rng, 3.0, 5.0) if which != "hard" else 0.0)


def controls(rng, behavior, kind, before):
    """Controls of a pair in a step; what an earlier step gave stays unless it is given again."""
    found = Controls(scale=before.scale if before else None)
    if behavior.kind == "augmented":
        found.tolerance = scale(rng, -6.0, -3.5)
    if behavior.kind in ("augmented", "penalty", "nonlinear") and rng.random() < 0.5:
        found.scale = float(rng.uniform(0.3, 3.0))
    if kind == "modified":
        found.modified = (int(rng.integers(0, 7)), scale(rng, -3.5, -2.0), scale(rng, -1.0, 1.3))
    return found


def pushed(rng, fixed):
    """Prescribed displacements of another step: each body is moved as a whole, as in the first."""
    moved, shift = {}, {}
    for dof, value in fixed.items():
        if value == 0.0:
            moved[dof] = 0.0
            continue
        key = (round(value, 3), dof % 3)
        shift.setdefault(key, float(rng.uniform(-0.02, 0.02)))
        moved[dof] = value + shift[key]
    return moved


def interference(rng, kind, number):
    """Allowed interference of a pair."""
    if kind != "given" or rng.random() < 0.4:
        return None
    if number == 0 and rng.random() < 0.5:
        return "shrink"
    return float(rng.uniform(0.0005, 0.01))


def random_plan(seed):
    """The plan of a seed and its kind."""
    rng = np.random.default_rng((seed, 4711))
    kind = KINDS[seed % len(KINDS)]
    for attempt in range(200):
        deck = random_deck((seed, attempt), ("hard",))
        points = sum(len(pair.secondary_nodes) for pair in deck.pairs)
        if points <= POINTS_MAX_ROUGH or kind not in ("rough", "bonded"):
            break
    deck.full_integration = False
    behaviors = [behavior(rng, kind) for _ in deck.pairs]
    for pair, chosen in zip(deck.pairs, behaviors, strict=True):
        pair.behavior, pair.law = chosen.lines(face_length(deck, pair)), hard()
    steps, active = [], [True] * len(deck.pairs)
    fixed, forces = dict(deck.fixed), dict(deck.nodal_forces)
    for number in range(int(rng.integers(2, 4))):
        if number:
            fixed = pushed(rng, fixed)
            forces = {dof: value * float(rng.uniform(-1.0, 1.5)) for dof, value in forces.items()}
        if kind == "changing" and number:
            active = [bool(rng.random() < 0.5) for _ in deck.pairs]
        if number and rng.random() < 0.5 and kind != "modified":
            chosen = steps[-1].controls
        else:
            before = steps[-1].controls if number else [None] * len(behaviors)
            chosen = [controls(rng, b, kind, c) for b, c in zip(behaviors, before, strict=True)]
        allowed = [interference(rng, kind, number) for _ in deck.pairs]
        period = float(rng.choice([1.0, 0.25, 3.0]))
        steps.append(Step(fixed, forces, int(rng.integers(1, 4)), chosen, list(active), allowed, period))
    deck.nodal_forces, deck.fixed = forces, fixed
    clearances = [given(rng, pair, kind) for pair in deck.pairs]
    return Plan(deck, behaviors, steps, clearances), kind


def given(rng, pair, kind):
    """Clearances that override the geometry at some of the nodes."""
    if kind != "given" or rng.random() < 0.3:
        return None
    nodes = [n for n in pair.secondary_nodes if rng.random() < 0.7]
    return {node: float(rng.uniform(-0.006, 0.01)) for node in nodes} or None


def face_length(deck, pair):
    """Characteristic length of a pair: mean size (root of the area) of the secondary faces, of the primary ones for nodes."""
    faces = face_nodes(deck, pair.primary_faces if pair.node_based else pair.secondary_faces)
    return float(np.mean([np.sqrt(fe.face_integrals(deck.coordinates[nodes])[0].sum()) for nodes in faces]))
