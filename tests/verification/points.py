"""Decks of nodes on springs in front of a rigid wall: one contact point and one degree of freedom each."""

from dataclasses import dataclass

PAIR = "POINTS_WALL"
FIRST, DRIVERS = 11, 31


@dataclass
class Point:
    """A node above the wall, whose plane is z = 0.

    `clearance` is its distance [length], `spring` the stiffness to ground along z, `driver` that of a spring to a node of its own
    that is prescribed [force/length], `lateral` that of springs to ground along x and y; without them it moves along z alone.
    """

    clearance: float = 0.0
    spring: float = 0.0
    driver: float = 0.0
    lateral: float = 0.0

    @property
    def stiffness(self):
        """Stiffness along z with the driver held [force/length]."""
        return self.spring + self.driver


def node(index=0):
    """Label of a point's node."""
    return FIRST + index


def driver(index=0):
    """Label of the node that drives it."""
    return DRIVERS + index


def springs(number, kind, nodes, directions, stiffness):
    """One spring with its own set."""
    words = ", ".join(map(str, directions))
    lines = [f"*ELEMENT, TYPE={kind}, ELSET=S{number}", f"{number}, " + ", ".join(map(str, nodes))]
    return [*lines, f"*SPRING, ELSET=S{number}", words, f"{stiffness!r},"]


def wall(face, depth):
    """A brick whose upper face has edges of length `face`."""
    half = 0.5 * face
    ring = [(-half, -half), (half, -half), (half, half), (-half, half)]
    places = [(x, y, z) for z in (-depth, 0.0) for x, y in ring]
    lines = ["*NODE, NSET=NWALL", *(f"{n}, {x!r}, {y!r}, {z!r}" for n, (x, y, z) in enumerate(places, 1))]
    return [*lines, "*ELEMENT, TYPE=C3D8, ELSET=EWALL", "1, 1, 2, 3, 4, 5, 6, 7, 8"]


def deck(points, behavior, steps, *, face=2.0, area=1.0, pair=(), model=()):
    """Deck text.

    Points stand in a row over the wall. `behavior` are the lines after *SURFACE INTERACTION and its area, `pair` further parameters
    of *CONTACT PAIR, `model` lines of the model after it, `steps` the lines of all steps.
    """
    lines = ["*HEADING", "points on springs", *wall(face, 1.0), "*NODE, NSET=POINTS"]
    across = [face * ((i + 1) / (len(points) + 1) - 0.5) for i in range(len(points))]
    lines += [f"{node(i)}, {x!r}, 0., {p.clearance!r}" for i, (p, x) in enumerate(zip(points, across, strict=True))]
    driven = [i for i, point in enumerate(points) if point.driver]
    if driven:
        lines.append("*NODE, NSET=DRIVERS")
        lines += [f"{driver(i)}, {across[i]!r}, 0., {points[i].clearance + 1.0!r}" for i in driven]
        lines += ["*NSET, NSET=MOVING", "POINTS, DRIVERS"]
        steps = [line.replace("*NODE PRINT, NSET=POINTS", "*NODE PRINT, NSET=MOVING") for line in steps]
    number, held = 100, []
    for i, point in enumerate(points):
        if point.spring:
            lines += springs(number := number + 1, "SPRING1", [node(i)], [3], point.spring)
        if point.driver:
            lines += springs(number := number + 1, "SPRING2", [node(i), driver(i)], [3, 3], point.driver)
            held.append(f"{driver(i)}, 1, 3")
        if point.lateral:
            for direction in (1, 2):
                lines += springs(number := number + 1, "SPRING1", [node(i)], [direction], point.lateral)
        else:
            held.append(f"{node(i)}, 1, 2")
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", "1000., 0.3", "*SOLID SECTION, ELSET=EWALL, MATERIAL=STEEL"]
    lines += ["*SURFACE, NAME=WALL, TYPE=ELEMENT", "1, S2", "*SURFACE, NAME=POINTS, TYPE=NODE"]
    lines += [f"{node(i)}," for i in range(len(points))]
    lines += ["*SURFACE INTERACTION, NAME=SI", f"{area!r},", *behavior]
    card = ["*CONTACT PAIR, INTERACTION=SI, TYPE=NODE TO SURFACE, SMALL SLIDING", *pair]
    lines += [", ".join(card), "POINTS, WALL", *model]
    return "\n".join([*lines, "*BOUNDARY", "NWALL, 1, 3", *held, *steps]) + "\n"


def step(*lines, increments=1, period=1.0):
    """A step of equal increments with all output at each."""
    output = ["*NODE PRINT, NSET=POINTS", "U, RF", "*CONTACT PRINT", "CSTR, CDIS", "*END STEP"]
    return ["*STEP, INC=1000", "*STATIC, DIRECT", f"{period / increments!r}, {period!r}", *lines, *output]


def controls(*words):
    """`*CONTACT CONTROLS` of the pair."""
    return ", ".join(["*CONTACT CONTROLS, MASTER=WALL, SLAVE=POINTS", *words])


def amplitude(name, values, period=1.0):
    """`*AMPLITUDE` with values at equal distances in time, the first at time zero."""
    spacing = period / (len(values) - 1)
    return [f"*AMPLITUDE, NAME={name}", *(f"{i * spacing!r}, {value!r}" for i, value in enumerate(values))]


def moved(result, label=FIRST):
    """Displacements of a node at each output time."""
    found = [row for row in result.table("nodes") if int(row["node"]) == label]
    return [tuple(float(row[f"U{d}"]) for d in (1, 2, 3)) for row in found]


@dataclass(frozen=True)
class Row:
    """A contact point at an output time."""

    status: str
    pressure: float
    overclosure: float
    shear: tuple[float, float]
    slip: tuple[float, float]


def rows(result):
    """Per increment, the points in order of their nodes."""
    groups = {}
    for row in result.table("contact"):
        groups.setdefault((int(row["step"]), int(row["increment"])), []).append(row)
    return [[point(row) for row in sorted(group, key=lambda r: int(r["node"]))] for group in groups.values()]


def point(row):
    """A row of the contact table."""
    number = {name: float(row[name] or 0.0) for name in ("CPRESS", "COPEN", "CSHEAR1", "CSHEAR2", "CSLIP1", "CSLIP2")}
    shear, slip = (number["CSHEAR1"], number["CSHEAR2"]), (number["CSLIP1"], number["CSLIP2"])
    return Row(row["status"], number["CPRESS"], -number["COPEN"], shear, slip)
