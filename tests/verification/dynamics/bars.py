"""Two columns of bricks that meet end to end, as bars: Poisson's ratio is zero and nodes move along z alone."""

from dataclasses import dataclass

from verification.dynamics.motion import OUTPUT
from verification.solids import Box, node_set, surface


@dataclass(frozen=True)
class Column:
    """A bar of square section of edge `width`: elements along it, length, Young's modulus, density, velocity along z."""

    elements: int
    length: float
    young: float
    density: float
    velocity: float
    width: float = 1.0
    across: int = 1

    @property
    def mass(self):
        """Of the whole bar."""
        return self.density * self.length * self.width**2


def boxes(upper, lower, gap=0.0):
    """Meshes of the upper bar, which begins at z = gap, and of the lower one, which ends at z = 0."""
    half = 0.5 * upper.width
    high = Box(
        "C3D8", (-half, -half, gap), (half, half, gap + upper.length), (upper.across, upper.across, upper.elements)
    )
    half, first = 0.5 * lower.width, len(high.nodes) + 1
    cells = (lower.across, lower.across, lower.elements)
    low = Box(
        "C3D8",
        (-half, -half, -lower.length),
        (half, half, 0.0),
        cells,
        first_node=first,
        first_element=len(high.elements) + 1,
    )
    return high, low


def deck(upper, lower, behavior, step, pair=(), gap=0.0, explicit=True, output=OUTPUT):
    """Deck text. `step`: lines from *STEP on to the procedure's data line; `pair`: words of *CONTACT PAIR. The lower bar is secondary:
    LOW_UP meets HIGH_DOWN. Node sets: NHIGH, NLOW, MOVING."""
    high, low = boxes(upper, lower, gap)
    lines = ["*HEADING", "two bars"]
    for name, box, column in (("HIGH", high, upper), ("LOW", low, lower)):
        lines += box.lines(name)
        lines += [f"*MATERIAL, NAME=M{name}", "*ELASTIC", f"{column.young!r}, 0.", "*DENSITY", f"{column.density!r},"]
        lines += [f"*SOLID SECTION, ELSET=E{name}, MATERIAL=M{name}"]
    lines += node_set("MOVING", [*high.nodes, *low.nodes])
    lines += surface("HIGH_DOWN", at(high, gap)) + surface("LOW_UP", at(low, 0.0))
    lines += ["*SURFACE INTERACTION, NAME=SI", *behavior]
    card = ["*CONTACT PAIR", "INTERACTION=SI", *([] if explicit else ["TYPE=NODE TO SURFACE"]), *pair]
    pairs = [", ".join(card), "LOW_UP, HIGH_DOWN"]
    lines += [] if explicit else pairs
    lines += ["*BOUNDARY", "MOVING, 1, 2", "*INITIAL CONDITIONS, TYPE=VELOCITY"]
    for name, column in (("HIGH", upper), ("LOW", lower)):
        lines += [f"N{name}, 3, {column.velocity!r}"] if column.velocity else []
    return "\n".join([*lines, *step, *(pairs if explicit else []), *output]) + "\n"


def at(box, level):
    """Faces of a mesh that lie at a level of z."""
    return [key for key, nodes in box.faces.items() if all(box.nodes[n][2] == level for n in nodes)]


def speed(run, box):
    """Velocity of the centre of mass at each increment: end nodes weigh half."""
    ends = {min(box.nodes[n][2] for n in box.nodes), max(box.nodes[n][2] for n in box.nodes)}
    weights = {n: 0.5 if x[2] in ends else 1.0 for n, x in box.nodes.items()}
    total = sum(weights.values())
    return sum(weights[n] / total * run.node(n, "V3") for n in box.nodes)
