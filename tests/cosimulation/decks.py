"""Small decks as text, and how they are packed."""

import support

TWO_BRICKS = """\
*HEADING
One brick on another
*NODE
1, 0, 0, 0
2, 1, 0, 0
3, 1, 1, 0
4, 0, 1, 0
5, 0, 0, 1
6, 1, 0, 1
7, 1, 1, 1
8, 0, 1, 1
11, 0, 0, 1
12, 1, 0, 1
13, 1, 1, 1
14, 0, 1, 1
15, 0, 0, 2
16, 1, 0, 2
17, 1, 1, 2
18, 0, 1, 2
*ELEMENT, TYPE=C3D8, ELSET=LOWER
1, 1, 2, 3, 4, 5, 6, 7, 8
*ELEMENT, TYPE=C3D8, ELSET=UPPER
2, 11, 12, 13, 14, 15, 16, 17, 18
*NSET, NSET=BOTTOM
1, 2, 3, 4
*NSET, NSET={top}
15, 16, 17, 18
{material}
*SOLID SECTION, ELSET=LOWER, MATERIAL=STEEL
*SOLID SECTION, ELSET=UPPER, MATERIAL=STEEL
*SURFACE, NAME=BELOW, TYPE=ELEMENT
1, S2
*SURFACE, NAME=ABOVE, TYPE=ELEMENT
2, S1
*SURFACE INTERACTION, NAME=SOFT
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
1000.
*CONTACT PAIR, INTERACTION=SOFT, SMALL SLIDING
ABOVE, BELOW
*BOUNDARY
BOTTOM, 1, 3
{top}, 1, 2
"""

MATERIAL = "*MATERIAL, NAME=STEEL\n*ELASTIC\n1000., 0.3"

STEP = """\
*STEP
*STATIC, DIRECT
0.1, {period}
*BOUNDARY
{top}, 3, 3, {displacement}
*NODE PRINT, NSET={top}
U, RF
*END STEP
"""


def two_bricks(displacements=(-0.01,), period=1.0, top="TOP", material=MATERIAL):
    """A brick pressed onto another, one step per displacement."""
    steps = [STEP.format(top=top, period=period, displacement=displacement) for displacement in displacements]
    return TWO_BRICKS.format(top=top, material=material) + "".join(steps)


def pack(*arguments):
    """Packs, insists on success."""
    done = support.call("pack", *arguments)
    assert done.returncode == 0, (done.returncode, done.stderr)
    return done
