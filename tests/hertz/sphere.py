"""Case C01: an elastic ball on a rigid flat, as a deck, and what its solution says about Hertz's.

One eighth of the ball: x = 0 and y = 0 are planes of symmetry; the equator moves down as a plane, which makes it the plane of
symmetry between two flats. The flat is one brick all of whose nodes are prescribed. N elements lie over the contact radius that
theory gives for the force; the contact edge falls into the middle of an element on the axes, on every mesh.
"""

import math
from dataclasses import dataclass

import numpy as np

from hertz.meshes import ball, shells, solid
from hertz.theory import plane_modulus, point_contact

CORE = 1.2  # side of the core in contact radii
REACH = 2.9  # secondary faces lie within this many contact radii


@dataclass(frozen=True)
class Ball:
    """Radius, force of the whole ball, Young's modulus, Poisson's ratio (SI units in C01)."""

    radius: float
    force: float
    young: float
    poisson: float

    def theory(self):
        """Hertz's answer."""
        return point_contact(self.radius, self.force, plane_modulus((self.young, self.poisson)))


def mesh_of(problem, elements):
    """Mesh with that many elements over the contact radius."""
    n = math.ceil(CORE * elements)
    core = problem.theory().a * n / (elements - 0.5)
    mesh = solid(n, shells(core, 2.0 * problem.radius, CORE / n, growth=0.25))
    mesh.points = ball(mesh.points, problem.radius)
    # Coordinates of the planes, free of rounding.
    mesh.points[np.abs(mesh.points) < 1e-12 * problem.radius] = 0.0
    mesh.points[mesh.shell == mesh.shell.max(), 2] = problem.radius
    return mesh


def labels(positions):
    """Data lines of node labels."""
    return [f"{p + 1}," for p in positions]


def deck(problem, elements, drive, element_type="C3D8", gap=0.0, increment=1.0):
    """Deck text and mesh. `drive`: "approach" prescribes Hertz's approach at the equator, "force" presses it with the force.

    gap: clearance between ball and flat at the start [length]; increment: first increment of the step of length 1.
    """
    mesh, theory, small = mesh_of(problem, elements), problem.theory(), 1e-9 * problem.radius
    count, bricks = len(mesh.points), len(mesh.bricks)
    lines = ["*HEADING", f"ball on a flat, {elements} elements over the contact radius", "*NODE, NSET=NBALL"]
    lines += [f"{p}, {x!r}, {y!r}, {z!r}" for p, (x, y, z) in enumerate(mesh.points.tolist(), 1)]
    side = 2.0 * REACH * theory.a
    corners = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)]
    lines.append("*NODE, NSET=NFLAT")
    box = [(x, y, z) for z in (-side - gap, -gap) for x, y in corners]
    lines += [f"{count + p}, {x!r}, {y!r}, {z!r}" for p, (x, y, z) in enumerate(box, 1)]
    lines.append(f"*ELEMENT, TYPE={element_type}, ELSET=EBALL")
    lines += [f"{e}, " + ", ".join(str(p + 1) for p in nodes) for e, nodes in enumerate(mesh.bricks.tolist(), 1)]
    lines.append("*ELEMENT, TYPE=C3D8, ELSET=EFLAT")
    lines.append(f"{bricks + 1}, " + ", ".join(str(count + p) for p in range(1, 9)))
    for name, axis, level in (("XSYM", 0, 0.0), ("YSYM", 1, 0.0), ("EQUATOR", 2, problem.radius)):
        lines += [f"*NSET, NSET={name}", *labels(mesh.on(axis, level, small))]
    reach = np.linalg.norm(mesh.points, axis=1)[mesh.bricks].max(axis=1)
    lines.append("*SURFACE, NAME=BALL, TYPE=ELEMENT")
    lines += [f"{b + 1}, S{face}" for b, face in mesh.contact if reach[b] <= REACH * theory.a]
    lines += ["*SURFACE, NAME=FLAT, TYPE=ELEMENT", f"{bricks + 1}, S2", "*SURFACE, NAME=CUT, TYPE=ELEMENT"]
    lines += [f"{b + 1}, S{face}" for b, face in mesh.outer]
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{problem.young!r}, {problem.poisson!r}"]
    lines += ["*SOLID SECTION, ELSET=EBALL, MATERIAL=STEEL", "*SOLID SECTION, ELSET=EFLAT, MATERIAL=STEEL"]
    lines += ["*SURFACE INTERACTION, NAME=HARD", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"]
    lines += ["*CONTACT PAIR, INTERACTION=HARD, TYPE=NODE TO SURFACE, SMALL SLIDING", "BALL, FLAT"]
    lines += ["*BOUNDARY", "XSYM, 1, 1", "YSYM, 2, 2", "NFLAT, 1, 3", "*STEP", "*STATIC", f"{increment!r}, 1."]
    if drive == "approach":
        lines += ["*BOUNDARY", f"EQUATOR, 3, 3, {-theory.approach!r}"]
    else:
        lines += ["*DSLOAD", f"CUT, P, {0.25 * problem.force / cut_area(mesh)!r}"]
    lines += ["*NODE PRINT, NSET=EQUATOR, TOTALS=YES", "U, RF", "*CONTACT PRINT", "CSTR, CDIS", "*END STEP"]
    return "\n".join(lines) + "\n", mesh


def cut_area(mesh):
    """Area of the equator's faces (brick face S2: corners 5 to 8)."""
    total = 0.0
    for brick, _ in mesh.outer:
        a, b, c, d = mesh.points[mesh.bricks[brick, 4:8]]
        total += 0.5 * np.linalg.norm(np.cross(c - a, d - b))
    return float(total)


@dataclass(frozen=True)
class Answer:
    """What a solution says: force of the whole ball, peak pressure, contact radius, approach, and the profile.

    profile: (radius, pressure, area) of every secondary node, ascending.
    """

    force: float
    p_max: float
    a: float
    approach: float
    profile: list


def read(result, mesh):
    """The answer in the result files of a deck of this mesh."""
    points = result.last("contact")
    closed = sum(float(row["area"]) for row in points if row["status"] == "CL")
    distance = np.hypot(mesh.points[:, 0], mesh.points[:, 1])
    profile = sorted(
        (float(distance[int(row["node"]) - 1]), float(row["CPRESS"]), float(row["area"])) for row in points
    )
    moved = [float(row["U3"]) for row in result.last("nodes") if row["U3"]]
    return Answer(
        force=4.0 * float(result.last("history")[0]["CFN3[BALL_FLAT]"]),
        p_max=profile[0][1],
        a=math.sqrt(4.0 * closed / math.pi),
        approach=-sum(moved) / len(moved),
        profile=profile,
    )
