"""Decks of stacked blocks for the closed-form cases."""

from dataclasses import dataclass


@dataclass
class Block:
    """A box of bricks: its corners, its divisions and Young's modulus. Poisson's ratio is zero."""

    low: tuple[float, float, float]
    high: tuple[float, float, float]
    divisions: tuple[int, int, int]
    young: float


LAWS = {
    "linear": ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", "250."],
    "exponential": ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=EXPONENTIAL", "0.01, 5."],
    "tabular": ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR", "0., 0.", "2., 0.01", "10., 0.02", "40., 0.03"],
    "hard": ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"],
}


def stack(blocks, law, step):
    """Deck text of blocks TOP and BOTTOM with contact between them, and the lines of its step.

    Node sets: {name}_ALL, {name}_LOW, {name}_HIGH; {name}_X and {name}_Y on the sides at the least x and y.
    Surfaces: {name}_UP and {name}_DOWN. TOP_DOWN is the secondary surface.
    """
    lines, node_number, element_number = ["*HEADING", "stacked blocks"], 0, 0
    for name, block in blocks.items():
        counts = block.divisions
        numbers, elements = {}, {}
        lines.append(f"*NODE, NSET={name}_ALL")
        for k in range(counts[2] + 1):
            for j in range(counts[1] + 1):
                for i in range(counts[0] + 1):
                    node_number += 1
                    numbers[i, j, k] = node_number
                    at = [
                        block.low[a] + (block.high[a] - block.low[a]) * n / counts[a] for a, n in enumerate((i, j, k))
                    ]
                    lines.append(f"{node_number}, " + ", ".join(repr(v) for v in at))
        lines.append(f"*ELEMENT, TYPE=C3D8, ELSET=E{name}")
        for k in range(counts[2]):
            for j in range(counts[1]):
                for i in range(counts[0]):
                    element_number += 1
                    elements[i, j, k] = element_number
                    ring = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                    corners = [numbers[a, b, c] for c in (k, k + 1) for a, b in ring]
                    lines.append(f"{element_number}, " + ", ".join(map(str, corners)))
        sides = {"LOW": (2, 0), "HIGH": (2, counts[2]), "X": (0, 0), "Y": (1, 0)}
        for side, (axis, level) in sides.items():
            lines.append(f"*NSET, NSET={name}_{side}")
            lines += [f"{n}," for key, n in numbers.items() if key[axis] == level]
        for side, face, level in (("DOWN", "S1", 0), ("UP", "S2", counts[2] - 1)):
            lines.append(f"*SURFACE, NAME={name}_{side}, TYPE=ELEMENT")
            lines += [f"{e}, {face}" for key, e in elements.items() if key[2] == level]
        lines += [f"*MATERIAL, NAME=M{name}", "*ELASTIC", f"{block.young!r}, 0."]
        lines.append(f"*SOLID SECTION, ELSET=E{name}, MATERIAL=M{name}")
    lines += ["*SURFACE INTERACTION, NAME=SI", *law, "*CONTACT PAIR, INTERACTION=SI, TYPE=NODE TO SURFACE"]
    return "\n".join([*lines, "TOP_DOWN, BOTTOM_UP", *step]) + "\n"


def output_of(*sets):
    """Output requests: displacements and reactions of sets, contact at every point."""
    lines = []
    for name in sets:
        lines += [f"*NODE PRINT, NSET={name}, TOTALS=YES", "U, RF"]
    return [*lines, "*CONTACT PRINT", "CSTR, CDIS", "*END STEP"]
