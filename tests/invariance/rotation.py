"""A deck in another place and attitude.

What has a direction of its own turns with it: loads by components; prescribed directions, springs along axes and equations through
extra nodes. The extra node n' of node n has the displacement of n in the old axes, u_d(n') = sum_j R_jd u_j(n), so that supports,
prescribed motions and reactions keep their numbers there.
"""

import copy

import numpy as np

from .cards import Card
from .elimination import Elimination

EXTRA = "OLDAXES"
# Elements along axes.
READING = ("SPRING1", "SPRING2", "DASHPOT1", "DASHPOT2")


class Turned:
    """The cards of a deck rotated by R (3, 3) and moved; `extra(n)` is the label of the extra node of n."""

    def __init__(self, cards, rotation, shift, sets):
        self.rotation, self.sets = np.asarray(rotation), sets
        self.shift = 10 ** len(str(max(sets.coordinates)))
        self.extras = set()
        self.regions = {}
        self.forces = {}
        self.offset = np.asarray(shift)
        self.constraints = Elimination(lambda dof: dof[0] > self.shift)
        # Springs read the old axes: there the extra direction depends on the node, not the other way round.
        self.readings = []
        self.cards = [self.turned(card) for card in copy.deepcopy(cards)]
        self.insert()

    def extra(self, node):
        """Label of the extra node."""
        return self.shift + node

    def row(self, node, direction, coefficient=1.0):
        """The displacement of a node along an old axis (0..2) as a row."""
        return {(node, j): coefficient * self.rotation[j, direction] for j in range(3)}

    def turned(self, card):
        """The card in the new axes."""
        if card.keyword == "*NODE":
            for line in card.data:
                place = self.rotation @ [float(x) for x in line[1:4]] + self.offset
                line[1:4] = [repr(float(x)) for x in place]
        elif card.keyword == "*BOUNDARY":
            card.data = [self.boundary(line) for line in card.data]
        elif card.keyword == "*CLOAD":
            self.cload(card)
        elif card.keyword == "*DLOAD":
            for line in card.data:
                if line[1].upper() == "GRAV":
                    direction = self.rotation @ [float(x) for x in line[3:6]]
                    line[3:6] = [repr(float(x)) for x in direction]
        elif card.keyword == "*GAP":
            for line in card.data:
                if any(line[1:4]):
                    direction = self.rotation @ [float(x or 0.0) for x in line[1:4]]
                    line[1:4] = [repr(float(x)) for x in direction]
        elif card.keyword == "*INITIAL CONDITIONS":
            card.data = self.velocities(card.data)
        elif card.keyword == "*EQUATION":
            card = self.equation(card)
        elif card.keyword == "*ELEMENT" and card.parameters["TYPE"].upper() in READING:
            for line in card.data:
                line[1:] = [self.reading(int(node)) for node in line[1:]]
        return card

    def boundary(self, line):
        """A prescribed direction moves to the extra nodes."""
        first = int(line[1])
        last = int(line[2]) if len(line) > 2 and line[2] else first
        for node in self.sets.of(line[0]):
            for direction in range(first - 1, last):
                if (node, direction) not in self.extras:
                    self.extras.add((node, direction))
                    row = self.row(node, direction)
                    row[self.extra(node), direction] = -1.0
                    self.constraints.add(row)
        return [self.region(line[0]), *line[1:]]

    def region(self, name):
        """The region of the extra nodes."""
        if name.isdigit():
            return str(self.extra(int(name)))
        self.regions[f"{name.upper()}_{EXTRA}"] = self.sets.of(name)
        return f"{name}_{EXTRA}"

    def cload(self, card):
        """Forces by components. What an earlier card gave the same region is kept, as without OP=NEW."""
        touched = {}
        for region, direction, value in card.data:
            force = self.forces.setdefault(region, np.zeros(3))
            force[int(direction) - 1] = float(value)
            touched[region] = force
        card.data = [
            [region, str(j + 1), repr(float(value))]
            for region, force in touched.items()
            for j, value in enumerate(self.rotation @ force)
        ]

    def velocities(self, data):
        """Initial velocities by components."""
        found = {}
        for region, direction, value in data:
            found.setdefault(region, np.zeros(3))[int(direction) - 1] = float(value)
        return [
            [region, str(j + 1), repr(float(value))]
            for region, velocity in found.items()
            for j, value in enumerate(self.rotation @ velocity)
        ]

    def equation(self, card):
        """Equations join the constraints; they are written by `insert`."""
        words = [word for line in card.data for word in line if word]
        while words:
            count, row = int(words[0]), {}
            for node, direction, coefficient in zip(*[iter(words[1 : 1 + 3 * count])] * 3, strict=True):
                for dof, value in self.row(int(node), int(direction) - 1, float(coefficient)).items():
                    row[dof] = row.get(dof, 0.0) + value
            self.constraints.add(row)
            words = words[1 + 3 * count :]
        return Card("**")

    def reading(self, node):
        """An extra node that follows a node in all old directions; those that are prescribed follow already."""
        if node not in self.readings:
            self.readings.append(node)
        return str(self.extra(node))

    def insert(self):
        """Puts extra nodes, their sets and the equations before the first step, and asks for their reactions."""
        for node in self.readings:
            for direction in range(3):
                if (node, direction) not in self.extras:
                    row = self.row(node, direction, -1.0)
                    self.follow((self.extra(node), direction), row)
        labels = sorted({node for node, _ in self.extras} | set(self.readings))
        if not labels and not self.constraints.rows:
            return
        places = [self.rotation @ self.sets.coordinates[n] + self.offset for n in labels]
        lines = [[str(self.extra(n)), *(repr(float(x)) for x in p)] for n, p in zip(labels, places, strict=True)]
        extra = [Card("*NODE", {"NSET": EXTRA}, lines)] if labels else []
        for name, nodes in self.regions.items():
            extra.append(Card("*NSET", {"NSET": name}, [[str(self.extra(n)), ""] for n in nodes]))
        for terms in self.constraints.equations():
            data = [[str(node), str(direction + 1), repr(float(c))] for (node, direction), c in terms]
            extra.append(Card("*EQUATION", {}, [[str(len(terms))], *data]))
        first = next(i for i, card in enumerate(self.cards) if card.keyword in ("*BOUNDARY", "*STEP"))
        self.cards[first:first] = extra
        if labels:
            ends = [i for i, card in enumerate(self.cards) if card.keyword == "*END STEP"]
            for i in reversed(ends):
                self.cards.insert(i, Card("*NODE PRINT", {"NSET": EXTRA}, [["RF"]]))

    def follow(self, dof, row):
        """An equation whose dependent dof is the extra one."""
        row[dof] = 1.0
        for pivot in [d for d in row if d in self.constraints.rows]:
            factor = row[pivot]
            for d, c in self.constraints.rows[pivot].items():
                row[d] = row.get(d, 0.0) - factor * c
            row.pop(pivot)
        self.constraints.rows[dof] = row
