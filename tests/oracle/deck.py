"""A small deck: the model as numbers for the oracle, and the same model as deck text for the solver."""

from dataclasses import dataclass, field

import numpy as np

from . import fe


@dataclass
class Pair:
    """One contact pair: who touches whom, and by which law."""

    secondary_nodes: list[int]
    secondary_faces: list[tuple[int, int]]
    primary_faces: list[tuple[int, int]]
    node_based: bool
    node_area: float | None
    law: object
    behavior: list[str]


@dataclass
class Connector:
    """A spring or a bar. `directions` (0..2) belong to SPRING1 and SPRING2; a bar has an area and Young's modulus."""

    kind: str
    nodes: list[int]
    stiffness: float = 0.0
    directions: tuple[int, ...] = ()
    area: float = 0.0
    young: float = 0.0


@dataclass
class Deck:
    """A model. Nodes, elements and directions count from zero here, from one in the text; a dof is 3 * node + direction.

    Loads grow linearly over the first step. `second` replaces nodal forces and prescribed displacements over a second step.
    Terms of an equation are (dof, coefficient), the dependent one first; their sum is zero.
    """

    coordinates: np.ndarray
    elements: list[list[int]]
    bodies: list[list[int]]
    materials: list[tuple[float, float, float]]
    pairs: list[Pair]
    fixed: dict[int, float] = field(default_factory=dict)
    nodal_forces: dict[int, float] = field(default_factory=dict)
    face_pressures: list[tuple[int, int, float]] = field(default_factory=list)
    surface_pressures: list[tuple[int, int, float]] = field(default_factory=list)
    gravities: list[tuple[int, float, np.ndarray]] = field(default_factory=list)
    equations: list[list[tuple[int, float]]] = field(default_factory=list)
    connectors: list[Connector] = field(default_factory=list)
    second: tuple[dict[int, float], dict[int, float]] | None = None
    full_integration: bool = False
    increments: int = 1
    kind: str = ""

    def point_labels(self):
        """Position of each contact point by (pair name, node label), in the order of the oracle's arrays."""
        points = ((p, n) for p, pair in enumerate(self.pairs) for n in pair.secondary_nodes)
        return {(f"SEC{p + 1}_PRI{p + 1}", n + 1): index for index, (p, n) in enumerate(points)}


def primary_corners(deck, pair):
    """Corner coordinates of each primary face, outward."""
    return [deck.coordinates[nodes] for nodes in face_nodes(deck, pair.primary_faces)]


def face_nodes(deck, faces):
    """Node numbers of faces, in the cyclic order whose normal points out of the body."""
    result = []
    for element, face in faces:
        nodes = np.array(deck.elements[element])
        result.append([int(n) for n in nodes[fe.outward_face(deck.coordinates[nodes], face)]])
    return result


def surface_lines(name, faces):
    """`*SURFACE, TYPE=ELEMENT`."""
    return [f"*SURFACE, NAME={name}, TYPE=ELEMENT", *(f"{e + 1}, S{f + 1}" for e, f in faces)]


def text(deck):
    """The deck as Abaqus text; numbers with 17 digits."""
    return "\n".join(model_lines(deck) + step_lines(deck)) + "\n"


def model_lines(deck):
    """Everything before the first supports."""
    lines = ["*HEADING", "random deck", "*NODE, NSET=NALL"]
    lines += [f"{i + 1}, {x!r}, {y!r}, {z!r}" for i, (x, y, z) in enumerate(deck.coordinates.tolist())]
    for index, members in enumerate(deck.bodies, 1):
        lines.append(f"*ELEMENT, TYPE=C3D8, ELSET=BODY{index}")
        lines += [f"{e + 1}, " + ", ".join(str(n + 1) for n in deck.elements[e]) for e in members]
    for index, (young, poisson, density) in enumerate(deck.materials, 1):
        lines += [f"*MATERIAL, NAME=M{index}", "*ELASTIC", f"{young!r}, {poisson!r}", "*DENSITY", f"{density!r},"]
        lines += [f"*SOLID SECTION, ELSET=BODY{index}, MATERIAL=M{index}"]
    lines += connector_lines(deck) + equation_lines(deck)
    for index, pair in enumerate(deck.pairs, 1):
        if pair.node_based:
            lines += [f"*SURFACE, NAME=SEC{index}, TYPE=NODE", *(f"{n + 1}," for n in pair.secondary_nodes)]
        else:
            lines += surface_lines(f"SEC{index}", pair.secondary_faces)
        lines += surface_lines(f"PRI{index}", pair.primary_faces)
        lines += [f"*SURFACE INTERACTION, NAME=INT{index}"]
        lines += [repr(pair.node_area)] if pair.node_area is not None else []
        lines += [
            *pair.behavior,
            f"*CONTACT PAIR, INTERACTION=INT{index}, TYPE=NODE TO SURFACE",
            f"SEC{index}, PRI{index}",
        ]
    for index, (element, face, _) in enumerate(deck.surface_pressures, 1):
        lines += surface_lines(f"PUSHED{index}", [(element, face)])
    return lines


def connector_lines(deck):
    """Springs and bars, each with its own set."""
    lines = []
    for index, connector in enumerate(deck.connectors, 1):
        name = f"CONNECTOR{index}"
        lines.append(f"*ELEMENT, TYPE={connector.kind}, ELSET={name}")
        lines.append(", ".join(str(n + 1) for n in (len(deck.elements) + index - 1, *connector.nodes)))
        if connector.kind == "T3D2":
            lines += [f"*MATERIAL, NAME=M{name}", "*ELASTIC", f"{connector.young!r}, 0.3"]
            lines += [f"*SOLID SECTION, ELSET={name}, MATERIAL=M{name}", f"{connector.area!r},"]
        else:
            directions = ", ".join(str(d + 1) for d in connector.directions)
            lines += [f"*SPRING, ELSET={name}", directions, f"{connector.stiffness!r},"]
    return lines


def equation_lines(deck):
    """`*EQUATION`, four terms a line."""
    lines = []
    for terms in deck.equations:
        lines += ["*EQUATION", f"{len(terms)}"]
        words = [f"{dof // 3 + 1}, {dof % 3 + 1}, {coefficient!r}" for dof, coefficient in terms]
        lines += [", ".join(words[i : i + 4]) for i in range(0, len(words), 4)]
    return lines


def boundary_lines(fixed, supports):
    """`*BOUNDARY` values of all but the supports."""
    driven = ((dof, value) for dof, value in fixed.items() if dof not in supports)
    return [f"{dof // 3 + 1}, {dof % 3 + 1}, {dof % 3 + 1}, {value!r}" for dof, value in driven]


def cload_lines(forces):
    """`*CLOAD`."""
    lines = [f"{dof // 3 + 1}, {dof % 3 + 1}, {value!r}" for dof, value in forces.items()]
    return ["*CLOAD", *lines] if lines else []


def step_lines(deck):
    """Supports, the step with its loads, and the second step if there is one."""
    later = deck.second[1] if deck.second else deck.fixed
    supports = {dof for dof, value in deck.fixed.items() if value == 0.0 and later[dof] == 0.0}
    begin = ["*STEP", "*STATIC, DIRECT", f"{1.0 / deck.increments!r}, 1.0", "*BOUNDARY"]
    output = ["*NODE PRINT, NSET=NALL", "U, RF", "*CONTACT PRINT", "CSTR, CDIS", "*END STEP"]
    lines = ["*BOUNDARY", *(f"{dof // 3 + 1}, {dof % 3 + 1}" for dof in sorted(supports))]
    lines += [*begin, *boundary_lines(deck.fixed, supports), *cload_lines(deck.nodal_forces)]
    if deck.face_pressures or deck.gravities:
        lines += ["*DLOAD", *(f"{e + 1}, P{f + 1}, {value!r}" for e, f, value in deck.face_pressures)]
        lines += [f"BODY{b + 1}, GRAV, {g!r}, " + ", ".join(repr(float(v)) for v in n) for b, g, n in deck.gravities]
    for index, (_, _, value) in enumerate(deck.surface_pressures, 1):
        lines += ["*DSLOAD", f"PUSHED{index}, P, {value!r}"]
    lines += output
    if deck.second:
        forces, fixed = deck.second
        lines += [*begin, *boundary_lines(fixed, supports), *cload_lines(forces), *output]
    return lines
