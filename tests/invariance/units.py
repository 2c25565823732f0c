"""A deck in other units: every quantity that the text holds, times the powers of its dimension."""

import copy
from dataclasses import dataclass


@dataclass(frozen=True)
class Units:
    """Size of the old units in the new ones: lengths are multiplied by `length`, forces by `force`. Time stays."""

    length: float
    force: float

    def scale(self, length=0, force=0):
        """Factor of a quantity with these powers."""
        return self.length**length * self.force**force


def number(word, factor):
    """A word times a factor, with 17 digits; empty words stay."""
    return repr(float(word) * factor) if word else word


def converted(cards, units, sets, dialect):
    """The cards in other units."""
    result = copy.deepcopy(cards)
    pressure, stiffness = units.scale(-2, 1), units.scale(-3, 1)
    interaction = None
    for card in result:
        name, data = card.keyword, card.data
        if name == "*NODE":
            columns(data, dict.fromkeys((1, 2, 3), units.length))
        elif name == "*ELASTIC":
            columns(data, {0: pressure})
        elif name == "*DENSITY":
            columns(data, {0: units.scale(-4, 1)})
        elif name == "*BOUNDARY":
            columns(data, {3: units.length})
        elif name == "*CLOAD":
            columns(data, {2: units.force})
        elif name in ("*DLOAD", "*DSLOAD"):
            for line in data:
                line[2] = number(line[2], units.length if line[1].upper() == "GRAV" else pressure)
        elif name == "*SURFACE INTERACTION":
            interaction = card
            # Without a line, a node of a node-based surface has the area one in the old units; in CalculiX its share of faces.
            card.data = data or ([["1."]] if dialect == "abaqus" else [])
            columns(card.data, {0: units.scale(2)})
        elif name == "*SURFACE BEHAVIOR":
            if interaction is None:
                raise ValueError("*SURFACE BEHAVIOR without *SURFACE INTERACTION or *GAP")
            columns(data, law_factors(card.parameters, units))
        elif name == "*CONTACT DAMPING":
            by_fraction = card.parameters.get("DEFINITION", "").startswith("CRITICAL")
            columns(data, {} if by_fraction else {0: stiffness, 1: units.length})
        elif name == "*INITIAL CONDITIONS":
            columns(data, {2: units.length})
        elif name == "*CONTACT CONTROLS":
            for parameter, factor in CONTROLS.items():
                if parameter in card.parameters:
                    card.parameters[parameter] = number(card.parameters[parameter], units.scale(*factor))
            columns(data, {0: stiffness, 2: units.length})
        elif name == "*CONTACT INTERFERENCE":
            columns(data, {2: units.length})
        elif name == "*CLEARANCE":
            if "VALUE" in card.parameters:
                card.parameters["VALUE"] = number(card.parameters["VALUE"], units.length)
            columns(data, {1: units.length})
        elif name == "*GAP":
            interaction = card
            # Without an area the element has the area one in the old units.
            for line in data:
                line.extend([""] * (5 - len(line)))
                line[4] = line[4] or "1."
            columns(data, {0: units.length, 4: units.scale(2)})
        elif name in ("*SPRING", "*DASHPOT"):
            columns(data[-1:], {0: units.scale(-1, 1)})
        elif name == "*MASS":
            columns(data, {0: units.scale(-1, 1)})
        elif name == "*SOLID SECTION" and sets.types.get(card.parameters["ELSET"].upper()) == "T3D2":
            columns(data, {0: units.scale(2)})
        elif name not in UNCHANGED:
            raise ValueError(f"the dimensions of {name} are not known here")
    return result


def law_factors(parameters, units):
    """Factors of the data columns of `*SURFACE BEHAVIOR`."""
    pressure, stiffness = units.scale(-2, 1), units.scale(-3, 1)
    if "AUGMENTED LAGRANGE" in parameters or "PENALTY" in parameters:
        return {0: stiffness, 1: units.length}
    by_law = {
        "HARD": {},
        "LINEAR": {0: stiffness},
        "TABULAR": {0: pressure, 1: units.length},
        "EXPONENTIAL": {0: units.length, 1: pressure, 2: stiffness},
    }
    return by_law[parameters.get("PRESSURE-OVERCLOSURE", "HARD").upper()]


def columns(data, factors):
    """Multiplies columns of data lines that are there."""
    for line in data:
        for column, factor in factors.items():
            if column < len(line):
                line[column] = number(line[column], factor)


UNCHANGED = {
    *("*HEADING", "*ELEMENT", "*NSET", "*ELSET", "*SURFACE", "*MATERIAL", "*SOLID SECTION", "*EQUATION", "*AMPLITUDE"),
    *("*CONTACT PAIR", "*STEP", "*STATIC", "*END STEP", "*NODE PRINT", "*NODE FILE", "*EL PRINT", "*EL FILE"),
    *("*CONTACT PRINT", "*CONTACT FILE", "*FRICTION", "*CHANGE FRICTION", "*MODEL CHANGE"),
    *("*DYNAMIC", "*BULK VISCOSITY", "*DAMPING"),
}
# Powers (length, force) of parameters of *CONTACT CONTROLS.
CONTROLS = {"ABSOLUTE PENETRATION TOLERANCE": (1, 0), "UERRMX": (1, 0), "PERRMX": (-2, 1)}
