"""Reads the small decks of the comparison with CalculiX into numbers: cubes of C3D8, equations, one contact pair, one step.

Written for the comparison alone, apart from the solver's own reader: what it does not know is an error. Nodes count from zero in
the arrays; a dof is 3 * node + direction. Elements are fully integrated, as CalculiX reads C3D8.
"""

from dataclasses import dataclass, field

import numpy as np

from oracle import fe
from oracle.projection import project

KNOWN = {"NODE", "ELEMENT", "NSET", "ELSET", "BOUNDARY", "EQUATION", "MATERIAL", "ELASTIC", "SOLID SECTION", "SURFACE"}
KNOWN |= {"CONTACT PAIR", "SURFACE INTERACTION", "SURFACE BEHAVIOR", "CLOAD", "DLOAD"}
IGNORED = {"HEADING", "STATIC", "STEP", "END STEP", "NODE PRINT", "EL PRINT", "CONTACT PRINT"}
IGNORED |= {"NODE FILE", "EL FILE", "CONTACT FILE"}


@dataclass
class SmallDeck:
    """The model. rows: overclosure that displacements add, one row per contact point; initial: overclosure at the start.

    areas: what a point stands for in CalculiX: its part of the secondary faces; for a node-based surface a quarter of every
    outer face at the node, whatever the surface interaction says. law: LINEAR slope and largest tension; EXPONENTIAL clearance
    where it ends, pressure at zero clearance.
    """

    labels: list[int]
    stiffness: np.ndarray
    forces: np.ndarray
    fixed: dict[int, float]
    equations: list[list[tuple[int, float]]]
    rows: np.ndarray
    initial: np.ndarray
    areas: np.ndarray
    kind: str
    law: list[float]
    node_based: bool


@dataclass
class Cards:
    """Data lines by keyword, with the parameters of each card."""

    cards: list[tuple[str, dict[str, str], list[list[str]]]] = field(default_factory=list)

    @classmethod
    def of(cls, text):
        """Cards of deck text; comments and blank lines are gone."""
        result = cls()
        for line in text.splitlines():
            line = line.strip()
            if not line or line.startswith("**"):
                continue
            if line.startswith("*"):
                keyword, *words = [word.strip() for word in line[1:].split(",")]
                pairs = (word.partition("=") for word in words)
                parameters = {name.strip().upper(): value.strip().upper() for name, _, value in pairs}
                result.cards.append((" ".join(keyword.upper().split()), parameters, []))
            else:
                result.cards[-1][2].append([word.strip() for word in line.split(",") if word.strip()])
        return result

    def each(self, keyword):
        """Parameters and data lines of the cards of that name."""
        return [(parameters, lines) for name, parameters, lines in self.cards if name == keyword]


def members(lines):
    """Labels in data lines of a set."""
    return [int(word) for line in lines for word in line]


def read(text):
    """The model of deck text."""
    deck = Cards.of(text)
    strange = {keyword for keyword, _, _ in deck.cards} - KNOWN - IGNORED
    if strange:
        raise ValueError(f"the comparison does not read {sorted(strange)}")
    mesh = Meshing.of(deck)
    ((_, [elastic]),) = deck.each("ELASTIC")
    young, poisson = (float(word) for word in elastic[:2])
    bricks = list(mesh.elements.values())
    blocks = fe.stiffnesses(mesh.coordinates[np.array(bricks)], fe.elasticity(young, poisson), True)
    ((behavior, [law]),) = deck.each("SURFACE BEHAVIOR")
    kind = behavior["PRESSURE-OVERCLOSURE"]
    if kind not in ("LINEAR", "EXPONENTIAL"):
        raise ValueError(f"the comparison does not read the law {kind}")
    rows, initial, areas, node_based = contact_points(deck, mesh)
    return SmallDeck(
        labels=list(mesh.index),
        stiffness=fe.assemble(len(mesh.index), bricks, blocks),
        forces=forces(deck, mesh),
        fixed=fixed(deck, mesh),
        equations=equations(deck, mesh),
        rows=rows,
        initial=initial,
        areas=areas,
        kind=kind,
        law=[float(word) for word in law],
        node_based=node_based,
    )


@dataclass
class Meshing:
    """Node positions by label, coordinates, corner nodes by element label, sets by keyword and name."""

    index: dict[int, int]
    coordinates: np.ndarray
    elements: dict[int, list[int]]
    sets: dict[str, dict[str, list[int]]]

    @classmethod
    def of(cls, deck):
        """Mesh and sets of the cards."""
        nodes = [(int(line[0]), [float(x) for x in line[1:4]]) for _, lines in deck.each("NODE") for line in lines]
        index = {label: i for i, (label, _) in enumerate(nodes)}
        elements = {}
        for parameters, lines in deck.each("ELEMENT"):
            if parameters["TYPE"] != "C3D8":
                raise ValueError(f"the comparison does not read {parameters['TYPE']}")
            elements.update({int(line[0]): [index[int(word)] for word in line[1:9]] for line in lines})
        sets = {}
        for keyword in ("NSET", "ELSET"):
            sets[keyword] = {parameters[keyword]: members(lines) for parameters, lines in deck.each(keyword)}
        for parameters, _ in deck.each("NODE") + deck.each("ELEMENT"):
            for keyword, everything in (("NSET", list(index)), ("ELSET", list(elements))):
                if keyword in parameters:
                    sets[keyword][parameters[keyword]] = everything
        return cls(index, np.array([x for _, x in nodes]), elements, sets)

    def nodes(self, word):
        """Positions of a node or of the members of a set."""
        return [self.index[label] for label in self.sets["NSET"].get(word.upper()) or [int(word)]]

    def face(self, element, face):
        """Corner nodes of a face S1 to S6 (or P1 to P6), outward."""
        nodes = self.elements[element]
        return [nodes[a] for a in fe.outward_face(self.coordinates[nodes], int(face[1:]) - 1)]

    def faces(self, lines):
        """Corner nodes of the faces in data lines `element or set, face`."""
        chosen = ((self.sets["ELSET"].get(name.upper()) or [int(name)], face) for name, face in lines)
        return [self.face(element, face) for elements, face in chosen for element in elements]

    def outer_faces(self):
        """Faces that belong to one element alone, outward."""
        found = {}
        for element in self.elements:
            for number in range(1, 7):
                corners = self.face(element, f"S{number}")
                found.setdefault(frozenset(corners), []).append(corners)
        return [faces[0] for faces in found.values() if len(faces) == 1]


def fixed(deck, mesh):
    """Prescribed displacements by dof."""
    values = {}
    for _, lines in deck.each("BOUNDARY"):
        for name, first, *rest in lines:
            for node in mesh.nodes(name):
                for direction in range(int(first), int(rest[0] if rest else first) + 1):
                    values[3 * node + direction - 1] = float(rest[1]) if len(rest) > 1 else 0.0
    return values


def equations(deck, mesh):
    """Terms (dof, coefficient) of each equation; their sum is zero."""
    found = []
    for _, lines in deck.each("EQUATION"):
        words = [word for line in lines for word in line]
        while words:
            count, words = int(words[0]), words[1:]
            terms = [words[3 * k : 3 * k + 3] for k in range(count)]
            found.append([(3 * mesh.index[int(n)] + int(d) - 1, float(c)) for n, d, c in terms])
            words = words[3 * count :]
    return found


def forces(deck, mesh):
    """Nodal forces of *CLOAD and of pressures on faces, by dof."""
    values = np.zeros(mesh.coordinates.size)
    for _, lines in deck.each("CLOAD"):
        for name, direction, value in lines:
            for node in mesh.nodes(name):
                values[3 * node + int(direction) - 1] += float(value)
    for _, lines in deck.each("DLOAD"):
        for name, face, value in lines:
            for corners in mesh.faces([(name, face)]):
                vectors = fe.face_integrals(mesh.coordinates[corners])[1]
                for node, vector in zip(corners, vectors, strict=True):
                    values[3 * node : 3 * node + 3] -= float(value) * vector
    return values


def contact_points(deck, mesh):
    """Rows, initial overclosures and areas of the contact points, and whether the secondary surface is one of nodes."""
    surfaces = {parameters["NAME"]: (parameters, lines) for parameters, lines in deck.each("SURFACE")}
    ((_, [pair]),) = deck.each("CONTACT PAIR")
    (parameters, secondary), (_, primary) = (surfaces[name.upper()] for name in pair)
    faces = mesh.faces(primary)
    corners = [mesh.coordinates[face] for face in faces]
    node_based = parameters.get("TYPE") == "NODE"
    if node_based:
        nodes = [node for line in secondary for node in mesh.nodes(line[0])]
    else:
        nodes = sorted({node for face in mesh.faces(secondary) for node in face})
    areas = np.zeros(len(mesh.coordinates))
    for face in mesh.outer_faces() if node_based else mesh.faces(secondary):
        areas[face] += fe.face_integrals(mesh.coordinates[face])[0]
    rows, initial = np.zeros((len(nodes), mesh.coordinates.size)), np.zeros(len(nodes))
    for point, node in enumerate(nodes):
        face, weights, normal, clearance, _ = project(mesh.coordinates[node], corners)
        rows[point, 3 * node : 3 * node + 3] -= normal
        for corner, weight in zip(faces[face], weights, strict=True):
            rows[point, 3 * corner : 3 * corner + 3] += weight * normal
        initial[point] = -clearance
    return rows, initial, areas[nodes], node_based
