"""A deck whose contact changes from step to step, as numbers for the oracle and as text for the solver."""

from dataclasses import dataclass, field

from ..deck import Deck, cload_lines, model_lines


@dataclass
class Behavior:
    """How the points of a pair push. `kind`: hard, linear, augmented, penalty, nonlinear.

    `stiffness` [pressure/length] and `clearance` [length] belong to the curves; `nonlinear` holds (e, Ki / Kf, d / e) with e as a
    length. `damping` is (mu0, c0, eta).
    """

    kind: str
    stiffness: float = 0.0
    clearance: float = 0.0
    nonlinear: tuple[float, float, float] | None = None
    separation: bool = True
    rough: bool = False
    damping: tuple[float, float, float] | None = None

    def lines(self, face):
        """Deck lines; `face` is the characteristic length of the pair [length]."""
        words = f"{self.stiffness!r}, {self.clearance!r}"
        cards = {
            "hard": ["*SURFACE BEHAVIOR" + (", PRESSURE-OVERCLOSURE=HARD" if self.separation else ", NO SEPARATION")],
            "linear": ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", repr(self.stiffness)],
            "augmented": ["*SURFACE BEHAVIOR, AUGMENTED LAGRANGE", words],
            "penalty": ["*SURFACE BEHAVIOR, PENALTY=LINEAR", words],
        }
        if self.kind == "nonlinear":
            upper, ratio, lower = self.nonlinear
            cards["nonlinear"] = ["*SURFACE BEHAVIOR, PENALTY=NONLINEAR"]
            cards["nonlinear"] += [f"{words}, 1.0, {upper / face!r}, {ratio!r}, {lower!r}"]
        lines = cards[self.kind]
        if self.damping:
            data = ", ".join(map(repr, self.damping))
            lines = [*lines, "*CONTACT DAMPING, DEFINITION=DAMPING COEFFICIENT", data]
        return [*lines, "*FRICTION, ROUGH"] if self.rough else lines


@dataclass
class Controls:
    """`*CONTACT CONTROLS` of a pair in a step: tolerance [length], factor on stiffnesses, (MAXCHP, UERRMX, PERRMX)."""

    tolerance: float | None = None
    scale: float | None = None
    modified: tuple[int, float, float] | None = None

    def words(self):
        """Parameters of the card."""
        words = []
        if self.tolerance is not None:
            words.append(f"ABSOLUTE PENETRATION TOLERANCE={self.tolerance!r}")
        if self.scale is not None:
            words.append(f"STIFFNESS SCALE FACTOR={self.scale!r}")
        if self.modified is not None:
            count, overclosure, tension = self.modified
            words += [f"MAXCHP={count}", f"UERRMX={overclosure!r}", f"PERRMX={tension!r}"]
        return words


@dataclass
class Step:
    """A step: prescribed displacements and nodal forces by dof at its end, reached linearly; what contact does meanwhile.

    `controls` has one entry per pair; `active` says which pairs act; `interference` is by pair: an allowed overclosure [length],
    "shrink", or none.
    """

    fixed: dict[int, float]
    forces: dict[int, float]
    increments: int
    controls: list[Controls]
    active: list[bool]
    interference: list[object]
    period: float = 1.0


@dataclass
class Plan:
    """A deck with its behaviours and steps; loads that are not nodal grow over the first step and stay.

    `clearances` is by pair: {node: clearance}, or none.
    """

    deck: Deck
    behaviors: list[Behavior]
    steps: list[Step]
    clearances: list[dict[int, float] | None] = field(default_factory=list)


def pair_names(index):
    """`MASTER=, SLAVE=` of a pair."""
    return f"MASTER=PRI{index + 1}, SLAVE=SEC{index + 1}"


def text(plan):
    """The deck as text; numbers with 17 digits."""
    lines = [
        line.replace("TYPE=NODE TO SURFACE", "TYPE=NODE TO SURFACE, SMALL SLIDING") for line in model_lines(plan.deck)
    ]
    for index, given in enumerate(plan.clearances):
        if given:
            lines.append(f"*CLEARANCE, {pair_names(index)}, TABULAR")
            lines += [f"{node + 1}, {value!r}" for node, value in given.items()]
    return "\n".join(lines + [line for number in range(len(plan.steps)) for line in step_lines(plan, number)]) + "\n"


def step_lines(plan, number):
    """A step; the supports of the model stand before the first."""
    step, before = plan.steps[number], plan.steps[number - 1] if number else None
    supports = {dof for dof in step.fixed if all(s.fixed[dof] == 0.0 for s in plan.steps)}
    lines = []
    if before is None:
        lines += ["*BOUNDARY", *(f"{dof // 3 + 1}, {dof % 3 + 1}" for dof in sorted(supports))]
    lines += ["*STEP, INC=1000", "*STATIC, DIRECT", f"{step.period / step.increments!r}, {step.period!r}"]
    for index, controls in enumerate(step.controls):
        words = controls.words()
        if words and (before is None or controls != before.controls[index]):
            lines.append(f"*CONTACT CONTROLS, {pair_names(index)}, " + ", ".join(words))
    for index, active in enumerate(step.active):
        was = before.active[index] if before else True
        if active != was:
            word = "ADD" if active else "REMOVE"
            lines += [f"*MODEL CHANGE, TYPE=CONTACT PAIR, {word}", f"SEC{index + 1}, PRI{index + 1}"]
    for index, allowed in enumerate(step.interference):
        if allowed == "shrink":
            lines += ["*CONTACT INTERFERENCE, SHRINK", f"SEC{index + 1}, PRI{index + 1}"]
        elif allowed is not None:
            lines += ["*CONTACT INTERFERENCE", f"SEC{index + 1}, PRI{index + 1}, {allowed!r}"]
    driven = [(dof, value) for dof, value in step.fixed.items() if dof not in supports]
    lines += ["*BOUNDARY", *(f"{dof // 3 + 1}, {dof % 3 + 1}, {dof % 3 + 1}, {v!r}" for dof, v in driven)]
    lines += cload_lines(step.forces)
    if before is None:
        lines += distributed_lines(plan.deck)
    return [*lines, "*NODE PRINT, NSET=NALL", "U, RF", "*CONTACT PRINT", "CSTR, CDIS", "*END STEP"]


def distributed_lines(deck):
    """Pressures and gravity."""
    lines = []
    if deck.face_pressures or deck.gravities:
        lines += ["*DLOAD", *(f"{e + 1}, P{f + 1}, {value!r}" for e, f, value in deck.face_pressures)]
        lines += [f"BODY{b + 1}, GRAV, {g!r}, " + ", ".join(repr(float(v)) for v in n) for b, g, n in deck.gravities]
    for index, (_, _, value) in enumerate(deck.surface_pressures, 1):
        lines += ["*DSLOAD", f"PUSHED{index}, P, {value!r}"]
    return lines
