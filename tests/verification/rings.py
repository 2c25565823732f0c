"""A sector of two rings, one shrunk onto the other, as a deck of one brick across and many through the thickness."""

import math
from dataclasses import dataclass

# Of the sector, in radians.
ANGLE = 0.01


@dataclass(frozen=True)
class Rings:
    """Radii a < b < c, overlap at b, and the materials (Young's modulus, Poisson's ratio) of the inner and the outer ring."""

    a: float
    b: float
    c: float
    overlap: float
    inner: tuple[float, float]
    outer: tuple[float, float]

    def overlap_along_the_facet(self, angle=ANGLE):
        """Overlap at the nodes along the normal of the flat facet of a sector between them [length]."""
        return self.overlap * math.cos(0.5 * angle)

    def compliance(self):
        """Overlap per pressure of both rings between planes that hold them along the axis (Lame)."""
        strain = [(1.0 - n * n) / e for e, n in (self.inner, self.outer)]
        ratios = [n / (1.0 - n) for _, n in (self.inner, self.outer)]
        inside = (self.b**2 + self.a**2) / (self.b**2 - self.a**2) - ratios[0]
        outside = (self.c**2 + self.b**2) / (self.c**2 - self.b**2) + ratios[1]
        return self.b * (strain[0] * inside + strain[1] * outside)


def deck(rings, behavior, divisions, angle=ANGLE, step=("*STATIC", "1., 1.")):
    """Deck text: a sector of `angle` (radians), one brick across and along the axis, `divisions` through each ring.

    Each node moves along its own radius: u_2 = tan(phi) u_1 by an equation. The inner ring's outer face is the secondary surface.
    """
    lines, elements = ["*HEADING", "shrink fit", "*NODE, NSET=NALL"], {"INNER": [], "OUTER": []}
    number, equations = 0, []
    spans = {"INNER": (rings.a, rings.b + rings.overlap), "OUTER": (rings.b, rings.c)}
    for name, (low, high) in spans.items():
        labels = {}
        for k in range(divisions + 1):
            radius = low + (high - low) * k / divisions
            for j, phi in enumerate((-0.5 * angle, 0.5 * angle)):
                for i, z in enumerate((0.0, angle * rings.b)):
                    number += 1
                    labels[i, j, k] = number
                    lines.append(f"{number}, {radius * math.cos(phi)!r}, {radius * math.sin(phi)!r}, {z!r}")
                    equations += ["*EQUATION", "2", f"{number}, 2, 1., {number}, 1, {-math.tan(phi)!r}"]
        for k in range(divisions):
            ring = [(0, 0), (0, 1), (1, 1), (1, 0)]
            elements[name].append([labels[i, j, level] for level in (k, k + 1) for i, j in ring])
    count = 0
    for name, members in elements.items():
        lines.append(f"*ELEMENT, TYPE=C3D8, ELSET={name}")
        for corners in members:
            count += 1
            lines.append(f"{count}, " + ", ".join(map(str, corners)))
    for name, (young, poisson) in (("INNER", rings.inner), ("OUTER", rings.outer)):
        lines += [f"*MATERIAL, NAME=M{name}", "*ELASTIC", f"{young!r}, {poisson!r}"]
        lines.append(f"*SOLID SECTION, ELSET={name}, MATERIAL=M{name}")
    lines += equations
    lines += ["*SURFACE, NAME=SHAFT, TYPE=ELEMENT", f"{divisions}, S2"]
    lines += ["*SURFACE, NAME=HUB, TYPE=ELEMENT", f"{divisions + 1}, S1"]
    lines += ["*SURFACE INTERACTION, NAME=FIT", *behavior]
    lines += ["*CONTACT PAIR, INTERACTION=FIT, TYPE=NODE TO SURFACE, SMALL SLIDING", "SHAFT, HUB"]
    lines += ["*BOUNDARY", "NALL, 3, 3", "*STEP", *step, "*NODE PRINT, NSET=NALL", "U"]
    return "\n".join([*lines, "*CONTACT PRINT", "CSTR, CDIS", "*END STEP"]) + "\n"
