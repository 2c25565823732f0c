"""Seeded random decks that move: blocks thrown onto a floor and onto each other, implicit and explicit, any law and enforcement."""

from dataclasses import dataclass

import numpy as np

from verification.solids import Box, node_set, surface

from .behaviors import size

OUTPUT = ["*NODE PRINT, NSET=EVERY, TOTALS=YES", "U, V, RF", "*CONTACT PRINT", "CSTR, CDIS", "*END STEP"]
PROCEDURES = ["implicit", "kinematic", "penalty"]


@dataclass
class Moving:
    """A deck: its text, what it exercises, its procedure."""

    seed: int
    text: str
    words: set[str]
    procedure: str

    @property
    def explicit(self):
        """Whether it is of Abaqus/Explicit."""
        return self.procedure != "implicit"


class Throw:
    """The draw of a deck: two or three boxes above each other, the lowest held at its foot."""

    def __init__(self, seed):
        self.rng = np.random.default_rng((seed, 4711))
        self.seed, self.words = seed, set()
        self.procedure = str(self.rng.choice(PROCEDURES))
        self.young, self.density = size(self.rng, 2.0, 6.0), size(self.rng, -2.0, 2.0)
        self.poisson = float(self.rng.uniform(0.0, 0.45))
        self.wave = float(np.sqrt(self.young / self.density * 1.5))
        self.lines, self.boxes, self.faces = ["*HEADING", f"moving {seed}"], [], []
        self.speed = self.wave * size(self.rng, -4.0, -1.7)

    def mesh(self):
        """Boxes, the upper one smaller than the lower one."""
        rng, level, node, element = self.rng, 0.0, 1, 1
        for number in range(int(rng.integers(2, 4))):
            wide = 1.6 - 0.35 * number
            kind = str(rng.choice(["C3D8", "C3D8", "C3D4", "C3D6"]))
            high = float(rng.uniform(0.3, 1.0))
            cells = tuple(int(rng.integers(1, 3)) for _ in range(3))
            corner = float(rng.uniform(-0.1, 0.1)) - 0.5 * wide
            box = Box(
                kind,
                (corner, corner, level),
                (corner + wide, corner + wide, level + high),
                cells,
                first_node=node,
                first_element=element,
            )
            self.boxes.append((box, level, level + high))
            node, element = node + len(box.nodes), element + len(box.elements)
            level += high + float(rng.choice([0.0, size(rng, -4.0, -1.0)]))
        for number, (box, low, high) in enumerate(self.boxes):
            self.lines += box.lines(f"B{number}")
            self.lines += surface(f"DOWN{number}", box.side_faces(2, low)) + surface(
                f"UP{number}", box.side_faces(2, high)
            )
            scale = size(rng, -0.7, 0.7)
            self.lines += [f"*MATERIAL, NAME=M{number}", "*ELASTIC", f"{self.young * scale!r}, {self.poisson!r}"]
            self.lines += ["*DENSITY", f"{self.density!r},"]
            if rng.random() < 0.3:
                beta = 0.0 if self.procedure != "implicit" else 0.02 / self.wave
                self.lines += [f"*DAMPING, ALPHA={0.1 * self.wave!r}, BETA={beta!r}"]
                self.words.add("rayleigh")
            self.lines += [f"*SOLID SECTION, ELSET=EB{number}, MATERIAL=M{number}"]

    def behavior(self):
        """A law with lines that the procedure allows, in proportion to the bodies."""
        rng, modulus = self.rng, self.young
        laws = ["hard", "linear", "tabular", "exponential"]
        kind = str(rng.choice(laws))
        self.words.add(kind)
        deep = 10.0 * self.speed / self.wave
        card = f"*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE={kind.upper()}"
        parting = rng.random() < 0.15 and (
            kind == "hard" if self.procedure == "implicit" else kind in ("linear", "tabular")
        )
        if parting and "balanced" not in self.words:
            card += ", NO SEPARATION"
            self.words.add("no separation")
        if kind == "hard":
            return [card if "NO SEPARATION" not in card else "*SURFACE BEHAVIOR, NO SEPARATION"]
        if kind == "linear":
            return [card, f"{modulus * size(rng, -1.0, 1.0)!r},"]
        if kind == "exponential":
            return [card, f"{deep * size(rng, -1.0, 0.0)!r}, {modulus * deep * size(rng, -1.5, 0.0)!r}"]
        points, p, h = [], 0.0, 0.0
        for _ in range(int(rng.integers(2, 5))):
            points.append(f"{p!r}, {h!r}")
            p, h = p + modulus * deep * size(rng, -1.0, 0.5), h + deep * size(rng, -1.0, 0.3)
        return [card, *points]

    def damping(self):
        """`*CONTACT DAMPING`, sometimes."""
        rng = self.rng
        if rng.random() > 0.35:
            return []
        self.words.add("damping")
        impedance = self.density * self.wave
        if self.procedure == "implicit":
            return [
                "*CONTACT DAMPING, DEFINITION=DAMPING COEFFICIENT",
                f"{impedance * size(rng, -2.0, 0.0)!r}, {size(rng, -3.0, -1.0)!r}, {float(rng.uniform(0.0, 0.9))!r}",
            ]
        if rng.random() < 0.5:
            return ["*CONTACT DAMPING, DEFINITION=DAMPING COEFFICIENT", f"{impedance * size(rng, -2.5, -0.5)!r},"]
        return ["*CONTACT DAMPING, DEFINITION=CRITICAL DAMPING FRACTION", f"{float(rng.uniform(0.0, 0.5))!r},"]

    def pairs(self):
        """`*CONTACT PAIR`s between neighbours; their interactions go into the model."""
        rng, found = self.rng, []
        for number in range(1, len(self.boxes)):
            words = [f"INTERACTION=I{number}"]
            if self.procedure == "implicit":
                words += ["TYPE=NODE TO SURFACE", "SMALL SLIDING"]
            else:
                words.append(f"MECHANICAL CONSTRAINT={self.procedure.upper()}")
                weight = str(rng.choice(["", "0.", "1.", "0.5", "0.3"], p=[0.3, 0.3, 0.1, 0.2, 0.1]))
                words += [f"WEIGHT={weight}"] if weight else []
                if weight not in ("0.", "1."):
                    self.words.add("balanced")
            behavior = self.behavior()
            if "NO SEPARATION" in behavior[0] and self.procedure != "implicit":
                words = [w for w in words if not w.startswith("WEIGHT")] + ["WEIGHT=0."]
            if not (self.procedure == "kinematic" and "hard" in self.words):
                behavior += self.damping()
            self.lines += [f"*SURFACE INTERACTION, NAME=I{number}", *behavior]
            found += [", ".join(["*CONTACT PAIR", *words]), f"DOWN{number}, UP{number - 1}"]
        return found

    def velocities(self):
        """`*INITIAL CONDITIONS` of every upper box."""
        lines = ["*INITIAL CONDITIONS, TYPE=VELOCITY"]
        for number in range(1, len(self.boxes)):
            lines.append(f"NB{number}, 3, {-self.speed * float(self.rng.uniform(0.0, 1.0))!r}")
            if self.rng.random() < 0.3:
                lines.append(f"NB{number}, 1, {0.1 * self.speed * float(self.rng.uniform(-1.0, 1.0))!r}")
        return lines

    def step(self, number, pairs):
        """Cards of a step."""
        rng = self.rng
        unit = 0.3 / self.wave
        if self.procedure == "implicit":
            dt = unit * size(rng, -0.7, 0.7)
            count = int(rng.integers(10, 40))
            words = [
                *(["DIRECT"] if rng.random() < 0.6 else []),
                *([f"ALPHA={float(-rng.uniform(0, 0.3333))!r}"] if rng.random() < 0.5 else []),
            ]
            self.words |= {"direct"} if "DIRECT" in words else {"automatic"}
            lines = ["*STEP, INC=4000", ", ".join(["*DYNAMIC", *words]), f"{dt!r}, {dt * count!r}"]
        else:
            period = unit * float(rng.uniform(10.0, 40.0))
            lines = ["*STEP", "*DYNAMIC, EXPLICIT", f", {period!r}"]
            if rng.random() < 0.3:
                lines += ["*BULK VISCOSITY", "0., 0."]
            lines += pairs if number == 0 else []
        weight = self.speed * self.wave * size(rng, -1.5, 0.0)
        kind = str(rng.choice(["gravity", "pressure", "none"]))
        self.words.add(kind)
        if kind == "gravity":
            lines += ["*DLOAD", *(f"EB{i}, GRAV, {weight!r}, 0., 0., -1." for i in range(1, len(self.boxes)))]
        if kind == "pressure":
            lines += ["*DSLOAD", f"UP{len(self.boxes) - 1}, P, {self.density * weight!r}"]
        return [*lines, *OUTPUT]

    def deck(self):
        """The deck."""
        self.mesh()
        pairs = self.pairs()
        base = self.boxes[0][0]
        self.lines += node_set("FOOT", base.side(2, 0.0))
        self.lines += ["*NSET, NSET=EVERY", ", ".join(f"NB{i}" for i in range(len(self.boxes)))]
        self.lines += pairs if self.procedure == "implicit" else []
        self.lines += ["*BOUNDARY", "FOOT, 1, 3", *self.velocities()]
        for number in range(int(self.rng.integers(1, 3))):
            self.lines += self.step(number, pairs)
        return Moving(self.seed, "\n".join(self.lines) + "\n", self.words | {self.procedure}, self.procedure)


def random_moving_deck(seed):
    """The deck of a seed."""
    return Throw(seed).deck()
