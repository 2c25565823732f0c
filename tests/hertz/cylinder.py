"""Case C03: a steel roller on an aluminium block in plane strain, as a deck, and what its solution says about Hertz's.

Half of the lower half of the roller and half of the block, one brick thick along y, with y displacements prescribed; x = 0 is the
plane of symmetry. The cut through the axis of the roller moves down as a plane. The block is twice as deep as half of it is wide,
as in the benchmark (200 mm square, roller of 100 mm diameter); its lower side is held in z.
"""

import math
from dataclasses import dataclass

import numpy as np

from hertz.meshes import disc, flipped, shells, strip
from hertz.theory import line_contact, plane_modulus

CORE = 1.2  # side of the core in half widths
REACH = 2.0  # secondary faces begin within this many half widths


@dataclass(frozen=True)
class Roller:
    """Radius, force per length, (Young's modulus, Poisson's ratio) of roller and block, half the width of the block."""

    radius: float
    force_per_length: float
    roller: tuple[float, float]
    block: tuple[float, float]
    half_width: float

    def theory(self):
        """Hertz's answer."""
        return line_contact(self.radius, self.force_per_length, plane_modulus(self.roller, self.block))

    def line_load_approach(self):
        """How far the cut moves, about: the logarithmic law of two half planes cut off at the sizes of the bodies.

        Only a start for the search of the displacement that gives the force.
        """
        a, total = self.theory().a, 0.0
        for (young, poisson), size in ((self.roller, self.radius), (self.block, 2.0 * self.half_width)):
            factor = self.force_per_length * (1.0 - poisson**2) / (math.pi * young)
            total += factor * (2.0 * math.log(2.0 * size / a) - 0.5)
        return total


def meshes_of(problem, elements, thickness):
    """Meshes of roller and block with that many elements over the half width of the contact."""
    n = math.ceil(CORE * elements)
    # The edge of the contact lies in the middle of an element.
    core = problem.theory().a * n / (elements - 0.5)
    roller = strip(n, shells(core, 2.0 * problem.radius, CORE / n, growth=0.25), thickness)
    roller.points = disc(roller.points, problem.radius)
    roller.points[np.abs(roller.points) < 1e-12 * problem.radius] = 0.0
    roller.points[roller.shell == roller.shell.max(), 2] = problem.radius
    sizes = shells(core, problem.half_width, CORE / n, growth=0.25)
    block = flipped(strip(n, sizes, thickness, round_shells=False, stretch=2.0))
    block.points[block.points == 0.0] = 0.0
    return roller, block


def deck(problem, elements, drive, element_type="C3D8", thickness=1.0):
    """Deck text and the roller's mesh. `drive`: displacement of the cut [length], or "force"."""
    roller, block = meshes_of(problem, elements, thickness)
    theory, small = problem.theory(), 1e-9 * problem.radius
    lines = ["*HEADING", f"roller on a block, {elements} elements over the half width"]
    bodies = {"ROLLER": (roller, 0, 0), "BLOCK": (block, len(roller.points), len(roller.bricks))}
    for name, (mesh, node, element) in bodies.items():
        lines.append(f"*NODE, NSET=N{name}")
        lines += [f"{node + p}, {x!r}, {y!r}, {z!r}" for p, (x, y, z) in enumerate(mesh.points.tolist(), 1)]
        lines.append(f"*ELEMENT, TYPE={element_type}, ELSET=E{name}")
        for e, nodes in enumerate(mesh.bricks.tolist(), 1):
            lines.append(f"{element + e}, " + ", ".join(str(node + p + 1) for p in nodes))
        lines += [f"*NSET, NSET=XSYM{name}", *(f"{node + p + 1}," for p in mesh.on(0, 0.0, small))]
    lines += ["*NSET, NSET=CUT", *(f"{p + 1}," for p in roller.on(2, problem.radius, small))]
    _, node, element = bodies["BLOCK"]
    low = block.on(2, -2.0 * problem.half_width, small)
    lines += ["*NSET, NSET=LOW", *(f"{node + p + 1}," for p in low)]
    reach = np.hypot(roller.points[:, 0], roller.points[:, 2])[roller.bricks].min(axis=1)
    lines.append("*SURFACE, NAME=ROLLER, TYPE=ELEMENT")
    lines += [f"{b + 1}, S{face}" for b, face in roller.contact if reach[b] <= REACH * theory.a]
    lines.append("*SURFACE, NAME=BLOCK, TYPE=ELEMENT")
    lines += [f"{element + b + 1}, S{face}" for b, face in block.contact]
    lines.append("*SURFACE, NAME=CUT, TYPE=ELEMENT")
    lines += [f"{b + 1}, S{face}" for b, face in roller.outer]
    for name, (young, poisson) in (("ROLLER", problem.roller), ("BLOCK", problem.block)):
        lines += [f"*MATERIAL, NAME=M{name}", "*ELASTIC", f"{young!r}, {poisson!r}"]
        lines.append(f"*SOLID SECTION, ELSET=E{name}, MATERIAL=M{name}")
    lines += ["*SURFACE INTERACTION, NAME=HARD", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"]
    lines += ["*CONTACT PAIR, INTERACTION=HARD, TYPE=NODE TO SURFACE, SMALL SLIDING", "ROLLER, BLOCK"]
    lines += ["*BOUNDARY", "NROLLER, 2, 2", "NBLOCK, 2, 2", "XSYMROLLER, 1, 1", "XSYMBLOCK, 1, 1", "LOW, 3, 3"]
    lines += ["*STEP", "*STATIC", "1., 1."]
    if drive == "force":
        lines += ["*DSLOAD", f"CUT, P, {0.5 * problem.force_per_length / problem.radius!r}"]
    else:
        lines += ["*BOUNDARY", f"CUT, 3, 3, {-drive!r}"]
    lines += ["*NODE PRINT, NSET=CUT, TOTALS=YES", "U, RF", "*CONTACT PRINT", "CSTR, CDIS", "*END STEP"]
    return "\n".join(lines) + "\n", roller


@dataclass(frozen=True)
class Answer:
    """Force per length of the whole roller, peak pressure, half width, profile (distance, pressure, area) ascending."""

    force_per_length: float
    p_max: float
    a: float
    profile: list


def read(result, roller, thickness=1.0):
    """The answer in the result files of a deck of this mesh."""
    points = result.last("contact")
    closed = sum(float(row["area"]) for row in points if row["status"] == "CL")
    across = roller.points[:, 0]
    profile = sorted((float(across[int(row["node"]) - 1]), float(row["CPRESS"]), float(row["area"])) for row in points)
    return Answer(
        force_per_length=2.0 * float(result.last("history")[0]["CFN3[ROLLER_BLOCK]"]) / thickness,
        p_max=profile[0][1],
        a=closed / thickness,
        profile=profile,
    )
