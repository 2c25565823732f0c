"""Small decks that move through contact, of every kind: what snapshots, frames, units and paths are tried on."""

from verification.dynamics import bouncing
from verification.dynamics.motion import HARD, UNDAMPED, Scene, exponential, linear, tabular

OUTPUT = ["*NODE PRINT, NSET=ALL", "U, V, A, RF", "*CONTACT PRINT", "CSTR, CDIS", "*END STEP"]


def collided(law, explicit=False):
    """Two masses on a spring that meet a wall and, in implicit steps, a third mass; two steps."""
    scene = Scene(explicit=explicit)
    near, far = scene.node(0.011, -2.0, 1.0), scene.node(1.0, -2.0, 4.0)
    scene.spring([near, far], 900.0)
    scene.dashpot([near, far], 3.0)
    if explicit:
        scene.pair([near], law, 1.0, ["MECHANICAL CONSTRAINT=PENALTY"])
        return scene.text(scene.central(0.004, 12), scene.central(0.004, 12, pairs=False))
    third = scene.node(2.0, -3.0, 0.5)
    scene.pair([near], law)
    scene.gap(far, third, 0.02, HARD)
    return scene.text(scene.implicit(0.004, 12), scene.implicit(0.004, 12))


def automatic():
    """Automatic implicit increments through a softened impact."""
    scene = Scene()
    node = scene.node(3e-4, -0.5, 1.0)
    scene.pair([node], exponential(1e-4, 1e6), 1e-3)
    step = ["*STEP, INC=100000", "*DYNAMIC", "4e-5, 2.5e-3", *scene.implicit(1.0, 1)[3:]]
    return scene.text(step)


def thrown(case):
    """A block that bounces: from before its first contact to after it."""
    return bouncing.deck(case, 100 if case.explicit else 30, OUTPUT, implicit_size=2.0)


def sized():
    """Automatic explicit increments: the contact spring changes their size."""
    lines = thrown(bouncing.Case("exponential", "penalty")).splitlines()
    at = next(i for i, line in enumerate(lines) if line.startswith("*DYNAMIC"))
    lines[at : at + 2] = ["*DYNAMIC, EXPLICIT", f",{lines[at + 1].split(',')[1]}"]
    return "\n".join(lines) + "\n"


TABLE = [(0.0, 0.0), (200.0, 0.01), (900.0, 0.02)]
DAMPED = ["*CONTACT DAMPING, DEFINITION=DAMPING COEFFICIENT", "20., 0.01, 0.5"]
BLOCKS = [
    bouncing.Case("hard", "implicit"),
    bouncing.Case("hard", "kinematic"),
    bouncing.Case("hard", "kinematic", "balanced"),
    bouncing.Case("hard", "penalty", "balanced"),
    bouncing.Case("exponential", "kinematic"),
    bouncing.Case("linear, no separation", "penalty"),
    bouncing.Case("hard, no separation", "kinematic"),
]


def decks():
    """Deck texts by name."""
    found = {
        "implicit hard": collided(HARD),
        "implicit linear": collided(linear(5e4)),
        "implicit tabular": collided(tabular(TABLE)),
        "implicit damped": collided([*linear(5e4), *DAMPED]),
        "implicit automatic": automatic(),
        "explicit tabular": collided([*tabular(TABLE), *UNDAMPED], explicit=True),
        "explicit automatic": sized(),
    }
    return found | {case.name: thrown(case) for case in BLOCKS}
