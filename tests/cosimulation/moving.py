"""A block that is thrown onto another one, in steps of either dynamic procedure."""

MODEL = """\
*HEADING
A block thrown onto another one
*NODE
1, 0, 0, 0
2, 1, 0, 0
3, 1, 1, 0
4, 0, 1, 0
5, 0, 0, 1
6, 1, 0, 1
7, 1, 1, 1
8, 0, 1, 1
11, 0, 0, 1.005
12, 1, 0, 1.005
13, 1, 1, 1.005
14, 0, 1, 1.005
15, 0, 0, 2.005
16, 1, 0, 2.005
17, 1, 1, 2.005
18, 0, 1, 2.005
*ELEMENT, TYPE=C3D8, ELSET=LOWER
1, 1, 2, 3, 4, 5, 6, 7, 8
*ELEMENT, TYPE=C3D8, ELSET=UPPER
2, 11, 12, 13, 14, 15, 16, 17, 18
*NSET, NSET=BOTTOM
1, 2, 3, 4
*NSET, NSET=TOP
15, 16, 17, 18
*NSET, NSET=THROWN
11, 12, 13, 14, 15, 16, 17, 18
*MATERIAL, NAME=STEEL
*ELASTIC
1000., 0.3
*DENSITY
1.
{damping}*SOLID SECTION, ELSET=LOWER, MATERIAL=STEEL
*SOLID SECTION, ELSET=UPPER, MATERIAL=STEEL
*SURFACE, NAME=BELOW, TYPE=ELEMENT
1, S2
*SURFACE, NAME=ABOVE, TYPE=ELEMENT
2, S1
*SURFACE INTERACTION, NAME=TOUCH
{behavior}*CONTACT PAIR, INTERACTION=TOUCH, SMALL SLIDING{pair}
ABOVE, BELOW
*BOUNDARY
BOTTOM, 1, 3
*INITIAL CONDITIONS, TYPE=VELOCITY
THROWN, 3, -1.
*STEP, NAME=Blow{increments}
{procedure}
*CLOAD
TOP, 3, -0.5
TOP, 1, 0.05
*NODE PRINT, NSET=TOP
U, V, A, RF
*NODE PRINT, NSET=BOTTOM
RF
*END STEP
"""

PERIOD = 0.2
IMPLICIT = f"*DYNAMIC\n0.002, {PERIOD}"
FIXED = f"*DYNAMIC, DIRECT\n0.004, {PERIOD}"
EXPLICIT = f"*DYNAMIC, EXPLICIT\n, {PERIOD}"
EXPLICIT_FIXED = f"*DYNAMIC, EXPLICIT, DIRECT USER CONTROL\n0.003, {PERIOD}"
LINEAR = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n2000.\n"
KINEMATIC = ", MECHANICAL CONSTRAINT=KINEMATIC"
PENALTY = ", MECHANICAL CONSTRAINT=PENALTY"


def thrown(procedure, behavior="", pair="", damping=""):
    """The deck with a procedure, a law, parameters of the pair and cards behind the density."""
    increments = "" if "EXPLICIT" in procedure else ", INC=10000"
    return MODEL.format(procedure=procedure, behavior=behavior, pair=pair, damping=damping, increments=increments)


def decks():
    """Deck texts by name: both procedures, automatic and fixed increments, hard, softened, damped."""
    return {
        "implicit_hard": thrown(IMPLICIT),
        "implicit_fixed": thrown(FIXED),
        "implicit_softened": thrown(IMPLICIT, LINEAR, damping="*DAMPING, ALPHA=0.2, BETA=1e-4\n"),
        "explicit_kinematic": thrown(EXPLICIT, pair=KINEMATIC),
        "explicit_penalty": thrown(EXPLICIT, pair=PENALTY),
        "explicit_softened": thrown(EXPLICIT_FIXED, LINEAR, pair=KINEMATIC),
    }
