"""Seeded random small decks: blocks, gaps, behaviours, controls, loads, and several steps of them."""

from dataclasses import dataclass

import numpy as np

from oracle import fe
from oracle.deck import Deck, Pair, model_lines, primary_corners
from oracle.decks import FOOT_MARGIN, geometry, random_rotation
from oracle.enumeration import hard
from oracle.projection import project

from .behaviors import Behavior, random_behavior, random_controls, size

SCENES = ["held", "pressed", "sprung"]


@dataclass
class Drawn:
    """A deck: its text, what it exercises, whether it must converge (frictionless hard or softened contact alone), and by pair the
    law that its points keep, where they keep one."""

    seed: int
    text: str
    words: set[str]
    plain: bool
    laws: dict[str, object]


class Scene:
    """Blocks above a fixed base, their pairs, and how the upper bodies are held: by prescribed tops, by contact and lateral
    supports under a pressure, or by springs under forces."""

    def __init__(self, rng):
        self.rng, self.kind = rng, str(rng.choice(SCENES, p=[0.5, 0.3, 0.2]))
        rotation = random_rotation(rng) if self.kind == "held" else np.eye(3)
        build, coordinates, links, self.holders = geometry(rng, rotation)
        materials = [(size(rng, 2.5, 4.5), float(rng.uniform(0.0, 0.45)), 0.5) for _ in build.bodies]
        self.deck = Deck(coordinates, build.elements, build.bodies, materials, [])
        self.faces, self.rotation, self.links = build.faces, rotation, links
        self.behaviors: list[Behavior] = []
        for primary, secondary in links:
            faces = build.faces[secondary]["b"]
            nodes = sorted({build.elements[e][n] for e, f in faces for n in fe.FACES[f]})
            behavior = random_behavior(rng)
            node_based = bool(rng.random() < 0.2)
            area = float(rng.uniform(0.05, 0.5)) if node_based else None
            self.behaviors.append(behavior)
            top = build.faces[primary]["t"]
            self.deck.pairs.append(Pair(nodes, faces, top, node_based, area, hard(), behavior.lines))

    def suitable(self):
        """Whether every foot lies within a face."""
        for pair in self.deck.pairs:
            corners = primary_corners(self.deck, pair)
            if any(project(self.deck.coordinates[n], corners)[4] < FOOT_MARGIN for n in pair.secondary_nodes):
                return False
        return True

    def supports(self):
        """Model cards that hold the bodies: sets, springs and supports."""
        lines = ["*NSET, NSET=BASE", *(f"{n + 1}," for n in self.holders[0])]
        bounds = ["BASE, 1, 3"]
        number = len(self.deck.elements)
        for body, nodes in enumerate(self.holders[1:], 1):
            lines += [f"*NSET, NSET=TOP{body}", *(f"{n + 1}," for n in nodes)]
            lines += [
                f"*SURFACE, NAME=UP{body}, TYPE=ELEMENT",
                *(f"{e + 1}, S{f + 1}" for e, f in self.faces[body]["t"]),
            ]
            if self.kind == "held":
                bounds.append(f"TOP{body}, 1, 3")
            else:
                bounds.append(f"TOP{body}, 1, 2")
            if self.kind == "sprung":
                for node in nodes:
                    number += 1
                    lines += [f"*ELEMENT, TYPE=SPRING1, ELSET=SPRING{number}", f"{number}, {node + 1}"]
                    lines += [f"*SPRING, ELSET=SPRING{number}", "3", f"{size(self.rng, 0.0, 3.0)!r},"]
        return [*lines, "*BOUNDARY", *bounds]

    def clearance_cards(self):
        """*CLEARANCE of some pairs."""
        lines = []
        for index in range(1, len(self.deck.pairs) + 1):
            if self.rng.random() < 0.12:
                value = float(self.rng.uniform(-0.004, 0.008))
                lines.append(f"*CLEARANCE, MASTER=PRI{index}, SLAVE=SEC{index}, VALUE={value!r}")
        return lines

    def step(self, number, active, words):
        """Cards of a step; `active` is changed in place."""
        rng = self.rng
        lines = ["*STEP, INC=400", "*STATIC" + (", DIRECT" if rng.random() < 0.3 else ""), "0.25, 1."]
        for index, behavior in enumerate(self.behaviors, 1):
            found, more = random_controls(rng, f"MASTER=PRI{index}, SLAVE=SEC{index}", behavior)
            lines, words = lines + found, words | more
            if number and self.kind == "held" and rng.random() < 0.12:
                active[index - 1] = not active[index - 1]
                word = "ADD" if active[index - 1] else "REMOVE"
                lines += [f"*MODEL CHANGE, TYPE=CONTACT PAIR, {word}", f"SEC{index}, PRI{index}"]
                words = words | {"removal"}
                # A pair that is away keeps no law.
                behavior.law = None
            if rng.random() < 0.1:
                shrink = number == 0 and rng.random() < 0.5
                allowed = "" if shrink else f", {float(rng.uniform(0.0005, 0.01))!r}"
                lines += [f"*CONTACT INTERFERENCE{', SHRINK' if shrink else ''}", f"SEC{index}, PRI{index}{allowed}"]
                words = words | {"interference"}
        return [*lines, *self.loads(number)], words

    def loads(self, number):
        """What drives the bodies in a step."""
        rng, lines = self.rng, []
        bodies = range(1, len(self.holders))
        if self.kind == "held":
            lines.append("*BOUNDARY")
            for body in bodies:
                push = self.rotation @ np.array([*rng.uniform(-0.004, 0.004, 2), rng.uniform(-0.03, 0.012)])
                lines += [f"TOP{body}, {d + 1}, {d + 1}, {float(push[d])!r}" for d in range(3)]
            if rng.random() < 0.4:
                node = int(rng.choice(self.deck.pairs[0].secondary_nodes))
                lines += ["*CLOAD", f"{node + 1}, {int(rng.integers(1, 4))}, {float(rng.uniform(-2.0, 2.0))!r}"]
        elif self.kind == "pressed":
            # Loads push down: what contact alone holds stays on its base.
            lines.append("*DSLOAD")
            lines += [f"UP{body}, P, {float(rng.uniform(0.05, 5.0))!r}" for body in bodies]
        else:
            lines.append("*CLOAD" + (", OP=NEW" if number and rng.random() < 0.3 else ""))
            lines += [f"TOP{body}, 3, {float(rng.uniform(-3.0, 1.0))!r}" for body in bodies]
        return lines


OUTPUT = ["*NODE PRINT, NSET=BASE, TOTALS=YES", "U, RF", "*CONTACT PRINT", "CSTR, CDIS", "*END STEP"]


def random_robust_deck(seed):
    """The deck of a seed."""
    for attempt in range(200):
        rng = np.random.default_rng((seed, attempt, 815))
        scene = Scene(rng)
        if scene.suitable():
            break
    else:
        raise RuntimeError(f"seed {seed} gives no suitable deck")
    words = {scene.kind}.union(*(behavior.words for behavior in scene.behaviors))
    lines = [
        line.replace("TYPE=NODE TO SURFACE", "TYPE=NODE TO SURFACE, SMALL SLIDING") for line in model_lines(scene.deck)
    ]
    given = scene.clearance_cards()
    lines += given + scene.supports()
    words |= {"clearance"} if given else set()
    active = [True] * len(scene.behaviors)
    for number in range(int(rng.integers(1, 5))):
        found, words = scene.step(number, active, words)
        lines += [*found, *OUTPUT]
    plain = all(behavior.plain for behavior in scene.behaviors) and not words & {"modified hard", "stabilize"}
    laws = {f"SEC{i}_PRI{i}": behavior.law for i, behavior in enumerate(scene.behaviors, 1) if behavior.law is not None}
    return Drawn(seed, "\n".join(lines) + "\n", words, plain, laws)
