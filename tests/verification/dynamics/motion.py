"""Decks of nodes that move along z: masses, springs, dashpots and bars in front of a fixed wall or of a plate of four masses.

The wall is the upper face, z = 0, of a brick whose nodes are all held; the plate is the upper face of a brick that is next to
nothing, so that its four corner masses are the plate. Steps are implicit or explicit, with every increment written.
"""

import copy
import math
from dataclasses import dataclass, field

import numpy as np
import pytest

import support

PAIR = "POINTS_WALL"
WALL_NODES = range(1, 9)
HARD = ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"]
UNDAMPED = ["*CONTACT DAMPING, DEFINITION=DAMPING COEFFICIENT", "0.,"]
OUTPUT = ["*NODE PRINT, NSET=MOVING", "U, V, A, RF", "*CONTACT PRINT", "CSTR, CDIS", "*END STEP"]


def linear(stiffness):
    """`*SURFACE BEHAVIOR` of a straight law."""
    return ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{stiffness!r},"]


def exponential(clearance, pressure, ceiling=None):
    """`*SURFACE BEHAVIOR` of an exponential law."""
    words = [repr(clearance), repr(pressure), *([repr(ceiling)] if ceiling else [])]
    return ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=EXPONENTIAL", ", ".join(words)]


def tabular(points):
    """`*SURFACE BEHAVIOR` of a table of (pressure, overclosure)."""
    return ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR", *(f"{p!r}, {h!r}" for p, h in points)]


@dataclass
class Scene:
    """Cards of a model under construction. `explicit`: whether its steps are of Abaqus/Explicit.

    `plate`: masses of the four corners and their velocity, where the secondary nodes meet them instead of a wall; `side`: edge of the wall
    or plate; `soft`: Young's modulus of its brick.
    """

    explicit: bool = False
    plate: tuple | None = None
    side: float = 2.0
    soft: float = 1e-12
    nodes: dict = field(default_factory=dict)
    velocities: dict = field(default_factory=dict)
    cards: list = field(default_factory=list)
    pairs: list = field(default_factory=list)
    interactions: list = field(default_factory=list)
    held: list = field(default_factory=list)
    loads: list = field(default_factory=list)
    number: int = 100

    def node(self, z, velocity=0.0, mass=None, at=(0.0, 0.0), fixed=False):
        """A node that moves along z; its label."""
        label = 11 + len(self.nodes)
        self.nodes[label] = (*at, z)
        self.held.append(f"{label}, 1, {3 if fixed else 2}")
        if velocity:
            self.velocities[label] = velocity
        if mass:
            self.element("MASS", [label], "*MASS", f"{mass!r},")
        return label

    def element(self, kind, nodes, card, *data):
        """An element in a set of its own, with the card that describes it."""
        self.number += 1
        name = f"S{self.number}"
        self.cards += [f"*ELEMENT, TYPE={kind}, ELSET={name}", f"{self.number}, " + ", ".join(map(str, nodes))]
        words = card.split(",", 1)
        self.cards += [", ".join([words[0], f"ELSET={name}", *(w.strip() for w in words[1:])]), *data]
        return self.number

    def spring(self, nodes, stiffness):
        """Between two nodes along z, or from one to the ground."""
        if len(nodes) == 1:
            return self.element("SPRING1", nodes, "*SPRING", "3", f"{stiffness!r},")
        return self.element("SPRING2", nodes, "*SPRING", "3, 3", f"{stiffness!r},")

    def dashpot(self, nodes, coefficient):
        """Between two nodes along z, or from one to the ground."""
        if len(nodes) == 1:
            return self.element("DASHPOT1", nodes, "*DASHPOT", "3", f"{coefficient!r},")
        return self.element("DASHPOT2", nodes, "*DASHPOT", "3, 3", f"{coefficient!r},")

    def bar(self, elements, length, area, young, density, start=0.0, velocity=0.0, rayleigh=None):
        """Two-node bars in a row from `start` upwards; labels of their nodes."""
        labels = [self.node(start + length * i / elements, velocity) for i in range(elements + 1)]
        first = self.number + 1
        self.number += elements
        name = f"BAR{first}"
        self.cards += [f"*ELEMENT, TYPE=T3D2, ELSET={name}"]
        self.cards += [f"{first + i}, {labels[i]}, {labels[i + 1]}" for i in range(elements)]
        self.cards += [f"*MATERIAL, NAME=M{name}", "*ELASTIC", f"{young!r}, 0.", "*DENSITY", f"{density!r},"]
        if rayleigh:
            self.cards += [f"*DAMPING, ALPHA={rayleigh[0]!r}, BETA={rayleigh[1]!r}"]
        self.cards += [f"*SOLID SECTION, ELSET={name}, MATERIAL=M{name}", f"{area!r},"]
        return labels

    def gap(self, near, far, clearance, behavior=(), area=None, direction=1.0):
        """GAPUNI from `near` to `far` along z (implicit steps only)."""
        words = [repr(clearance), "0.", "0.", repr(direction), *([repr(area)] if area else [])]
        self.element("GAPUNI", [near, far], "*GAP", ", ".join(words), *behavior)

    def pair(self, nodes, behavior, area=1.0, words=(), name="POINTS", primary="WALL"):
        """Nodes as a node-based surface in front of the wall or the plate."""
        self.cards += [f"*SURFACE, NAME={name}, TYPE=NODE", *(f"{n}," for n in nodes)]
        self.interactions += [f"*SURFACE INTERACTION, NAME=I{name}", f"{area!r},", *behavior]
        kind = [] if self.explicit else ["TYPE=NODE TO SURFACE"]
        card = ["*CONTACT PAIR", f"INTERACTION=I{name}", *kind, "SMALL SLIDING", *words]
        if self.explicit and "MECHANICAL CONSTRAINT=PENALTY" in words:
            card.remove("SMALL SLIDING")
        self.pairs += [", ".join(card), f"{name}, {primary}"]

    def brick(self):
        """The wall, or the plate."""
        half = 0.5 * self.side
        ring = [(-half, -half), (half, -half), (half, half), (-half, half)]
        places = [(x, y, z) for z in (-1.0, 0.0) for x, y in ring]
        lines = ["*NODE, NSET=NWALL", *(f"{n}, {x!r}, {y!r}, {z!r}" for n, (x, y, z) in enumerate(places, 1))]
        lines += ["*ELEMENT, TYPE=C3D8, ELSET=EWALL", "1, 1, 2, 3, 4, 5, 6, 7, 8"]
        # The wall is slow: its nodes never move, and no increment is too large for it.
        density = 1.0 if self.plate is None else 1e-12
        lines += ["*MATERIAL, NAME=MWALL", "*ELASTIC", f"{self.soft!r}, 0.", "*DENSITY", f"{density!r},"]
        lines += ["*SOLID SECTION, ELSET=EWALL, MATERIAL=MWALL", "*SURFACE, NAME=WALL, TYPE=ELEMENT", "1, S2"]
        if self.plate is None:
            return lines, ["NWALL, 1, 3"]
        masses, speed = self.plate
        for label, mass in zip(range(5, 9), masses, strict=True):
            self.element("MASS", [label], "*MASS", f"{mass!r},")
            if speed:
                self.velocities[label] = speed
        return lines, ["1, 1, 3", "2, 1, 3", "3, 1, 3", "4, 1, 3", *(f"{n}, 1, 2" for n in range(5, 9))]

    def text(self, *steps):
        """Deck text with the lines of its steps."""
        brick, fixed = self.brick()
        lines = ["*HEADING", "masses that move", *brick, "*NODE, NSET=NMOVING"]
        lines += [f"{n}, " + ", ".join(repr(float(c)) for c in x) for n, x in self.nodes.items()]
        corners = "" if self.plate is None else ", 5, 6, 7, 8"
        lines += ["*NSET, NSET=MOVING", f"NMOVING{corners}", *self.cards, *self.interactions]
        if not self.explicit:
            lines += self.pairs
        lines += ["*BOUNDARY", *fixed, *self.held]
        if self.velocities:
            lines += ["*INITIAL CONDITIONS, TYPE=VELOCITY"]
            lines += [f"{n}, 3, {float(v)!r}" for n, v in self.velocities.items()]
        return "\n".join([*lines, *(line for step in steps for line in step)]) + "\n"

    def implicit(self, dt, increments, *lines, alpha=None, words=(), output=OUTPUT):
        """A step of equal increments."""
        card = ["*DYNAMIC", "DIRECT", *([f"ALPHA={alpha!r}"] if alpha is not None else []), *words]
        return ["*STEP, INC=1000000", ", ".join(card), f"{dt!r}, {dt * increments!r}", *lines, *output]

    def central(self, dt, increments, *lines, viscosity=(0.0, 0.0), output=OUTPUT, pairs=True):
        """An explicit step of equal increments; its contact pairs are those of an earlier step where `pairs` is not set."""
        head = ["*STEP", "*DYNAMIC, EXPLICIT, DIRECT USER CONTROL", f"{dt!r}, {dt * increments!r}"]
        head += ["*BULK VISCOSITY", ", ".join(map(repr, viscosity))]
        return [*head, *(self.pairs if pairs else []), *lines, *output]

    def step(self, dt, increments, *lines, **options):
        """A step of equal increments in the procedure of the scene."""
        return (self.central if self.explicit else self.implicit)(dt, increments, *lines, **options)


@dataclass
class Run:
    """What a run left, as arrays over the increments."""

    result: support.Result

    def __post_init__(self):
        self.history = self.result.table("history")
        self.time = np.array([float(row["time"]) for row in self.history])
        nodes = self.result.table("nodes")
        self.by_label = {}
        for row in nodes:
            self.by_label.setdefault(int(row["node"]), []).append(row)
        self.contact = {}
        for row in self.result.table("contact"):
            self.contact.setdefault(int(row["node"]), []).append(row)

    def at(self, times):
        """The same run at some of its times alone: increments that end at events between them are left out."""
        picked = [int(np.abs(self.time - t).argmin()) for t in times]
        assert self.time[picked] == pytest.approx(times, rel=1e-9), "the run has no increments that end there"
        other = copy.copy(self)
        other.history, other.time = [self.history[i] for i in picked], self.time[picked]
        other.by_label = {n: [rows[i] for i in picked] for n, rows in self.by_label.items()}
        other.contact = {n: [rows[i] for i in picked] for n, rows in self.contact.items()}
        return other

    def node(self, label, column):
        """A column of JOB_nodes.csv of a node."""
        return np.array([float(row[column]) for row in self.by_label[label]])

    def point(self, label, column):
        """A column of JOB_contact.csv of a point."""
        return np.array([float(row[column]) for row in self.contact[label]])

    def force(self, label):
        """Contact force of a point."""
        return self.point(label, "CPRESS") * self.point(label, "area")

    def energy(self, name):
        """A column of JOB_history.csv."""
        return np.array([float(row[name]) for row in self.history])

    @property
    def summary(self):
        """JOB.json."""
        return self.result.summary()


def solve(write_deck, folder, text, name="deck.inp", clean=True):
    """Runs deck text; its audit is clean, or says nothing but the words of `clean`."""
    folder.mkdir(parents=True, exist_ok=True)
    result = support.run(write_deck(text, name), folder)
    if clean:
        allowed = clean if isinstance(clean, str) else None
        findings = result.summary()["audit"]
        assert [finding for finding in findings if allowed is None or allowed not in finding] == []
    return Run(result)


def crossing(time, place, level, rising):
    """First time at which a motion crosses a level, by its straight line between two of its points."""
    above = place > level
    change = np.flatnonzero((~above[:-1] & above[1:]) if rising else (above[:-1] & ~above[1:]))
    i = int(change[0])
    return time[i] + (time[i + 1] - time[i]) * (level - place[i]) / (place[i + 1] - place[i])


def frequency(mass, stiffness):
    """Of a mass on a spring."""
    return math.sqrt(stiffness / mass)
