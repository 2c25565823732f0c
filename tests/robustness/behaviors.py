"""Random contact behaviours and controls, as deck lines."""

from dataclasses import dataclass, field

from oracle.enumeration import hard, linear, tabular

NUMBERS = "{0!r}, {1!r}"


@dataclass
class Behavior:
    """Lines after *SURFACE INTERACTION, words for what they are, and the law for the oracle where points keep one."""

    lines: list[str]
    words: set[str] = field(default_factory=set)
    law: object = None

    @property
    def plain(self):
        """Frictionless hard contact by multipliers, or a softened law, and nothing else."""
        return not self.words - {"hard", "linear", "tabular", "exponential"}


def size(rng, low, high):
    """A random size, evenly spread over its logarithm."""
    return float(10.0 ** rng.uniform(low, high))


def softened(rng):
    """A softened law."""
    kind = str(rng.choice(["linear", "tabular", "exponential"]))
    card = f"*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE={kind.upper()}"
    if kind == "linear":
        stiffness = size(rng, 1.0, 8.0)
        return Behavior([card, repr(stiffness)], {kind}, linear(stiffness))
    if kind == "exponential":
        data = size(rng, -4.0, -1.7), size(rng, -2.0, 2.0)
        return Behavior([card, NUMBERS.format(*data)], {kind}, data)
    pressure, overclosure, points = 0.0, float(rng.uniform(-0.005, 0.003)), []
    for _ in range(int(rng.integers(2, 6))):
        points.append((pressure, overclosure))
        pressure, overclosure = pressure + size(rng, -1.0, 2.0), overclosure + size(rng, -4.0, -2.0)
    return Behavior([card, *(NUMBERS.format(*point) for point in points)], {kind}, tabular(points))


def enforced(rng):
    """Hard contact by multipliers, augmented Lagrange or a penalty, with automatic or given stiffness."""
    kind = str(rng.choice(["hard", "augmented", "penalty", "nonlinear"], p=[0.4, 0.3, 0.15, 0.15]))
    if kind == "hard":
        return Behavior(["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"], {kind}, hard())
    card = {"augmented": "AUGMENTED LAGRANGE", "penalty": "PENALTY=LINEAR", "nonlinear": "PENALTY=NONLINEAR"}[kind]
    lines = [f"*SURFACE BEHAVIOR, {card}"]
    if rng.random() < 0.5:
        clearance = float(rng.choice([0.0, size(rng, -5.0, -2.5)]))
        lines.append(NUMBERS.format(size(rng, 3.0, 6.5), clearance))
        if kind == "nonlinear" and rng.random() < 0.5:
            lines[-1] += f", 1., {size(rng, -2.5, -1.0)!r}, {size(rng, -2.5, 0.0)!r}, {float(rng.uniform(0.05, 0.9))!r}"
    return Behavior(lines, {kind})


def random_behavior(rng):
    """Any behaviour that statics allows."""
    if rng.random() < 0.15:
        found = Behavior(["*SURFACE BEHAVIOR, NO SEPARATION"], {"hard", "no separation"})
    else:
        found = softened(rng) if rng.random() < 0.35 else enforced(rng)
    if rng.random() < 0.2:
        data = ", ".join(map(repr, (size(rng, -2.0, 2.0), size(rng, -3.0, -1.0), float(rng.uniform(0.0, 0.95)))))
        found.lines += ["*CONTACT DAMPING, DEFINITION=DAMPING COEFFICIENT", data]
        found.words.add("damping")
        # The pressure of a closed point has its viscous part in it.
        found.law = None
    if rng.random() < 0.2:
        found.lines.append("*FRICTION, ROUGH")
        found.words.add("rough")
    return found


def random_controls(rng, name, behavior):
    """Cards of *CONTACT CONTROLS of a pair in a step, and what they make of it."""
    parameters, data, words = [], [], set()
    if "augmented" in behavior.words and rng.random() < 0.5:
        which = rng.choice(["ABSOLUTE", "RELATIVE"])
        parameters.append(f"{which} PENETRATION TOLERANCE={size(rng, -6.0, -2.5)!r}")
    if behavior.words & {"augmented", "penalty", "nonlinear"} and rng.random() < 0.4:
        parameters.append(f"STIFFNESS SCALE FACTOR={size(rng, -1.0, 1.0)!r}")
    if behavior.words == {"hard"} and rng.random() < 0.4:
        parameters += [f"MAXCHP={int(rng.integers(0, 8))}", f"UERRMX={size(rng, -5.0, -2.3)!r}"]
        parameters.append(f"PERRMX={size(rng, -2.0, 1.0)!r}")
        words.add("modified hard")
        behavior.law = None
    elif rng.random() < 0.1:
        parameters.append("STABILIZE")
        data = [f"{size(rng, -3.0, 1.0)!r}, {float(rng.choice([0.0, 0.3]))!r}, {size(rng, -2.0, 0.0)!r}"]
        words.add("stabilize")
        behavior.law = None
    if not parameters:
        return [], words
    return [", ".join([f"*CONTACT CONTROLS, {name}", *parameters]), *data], words
