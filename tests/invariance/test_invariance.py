"""The physics of a deck does not depend on where it is, how it is turned, and in which units it is written."""

import numpy as np
import pytest

import support

from . import cards as deck_cards
from .collection import generated_decks, oracle_decks, verification_decks
from .physics import Change, differences, largest, read
from .rotation import Turned
from .units import Units, converted

TOLERANCE = 1e-9
# Displacements below this part of the deck's size are not to be had to 1e-9: coordinates have 16 digits.
RESOLVED = 1e-6
AXIS, ANGLE = np.array([1.0, 2.0, -0.5]), 0.7
METRES = Units(length=1e-3, force=1.0)
INCHES = Units(length=1.0 / 25.4, force=1.0 / 4.4482216152605)


def rotation():
    """Rotation by ANGLE about AXIS (Rodrigues)."""
    x, y, z = AXIS / np.linalg.norm(AXIS)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(ANGLE) * cross + (1.0 - np.cos(ANGLE)) * cross @ cross


def size(cards):
    """Largest extent of the nodes [length]."""
    return float(np.ptp(np.array(list(deck_cards.Sets(cards).coordinates.values())), axis=0).max())


def turned(cards, turn, shift):
    """A deck turned about the origin and moved by parts of its size."""
    sets = deck_cards.Sets(cards)
    result = Turned(cards, turn, size(cards) * np.array(shift), sets)
    extra = result.extra if result.extras else None
    return result.cards, Change(turn, extra=extra, sets=sets)


def moved(cards, dialect):
    """Somewhere else."""
    shifted = deck_cards.parse(deck_cards.text(cards))
    shift = size(cards) * np.array([1.7, -2.3, 0.9])
    for card in shifted:
        if card.keyword == "*NODE":
            for line in card.data:
                line[1:4] = [repr(float(x) + float(s)) for x, s in zip(line[1:4], shift, strict=True)]
    return shifted, Change(np.eye(3))


def in_units(units):
    """A change of units."""
    return lambda cards, dialect: (
        converted(cards, units, deck_cards.Sets(cards), dialect),
        Change(np.eye(3), length=units.length, force=units.force),
    )


CHANGES = {
    "moved": moved,
    "turned": lambda cards, dialect: turned(cards, rotation(), (0.0, 0.0, 0.0)),
    "turned and moved": lambda cards, dialect: turned(cards, rotation().T, (-0.8, 0.6, 1.9)),
    "metres": in_units(METRES),
    "inches": in_units(INCHES),
}


# Decks at the edge of a tolerance, where rounding decides between two answers, and those whose law is a force per length, whose
# areas are lengths; reference nodes have rotations and moments, which extra nodes do not turn.
LEFT_OUT = ("the_published_loop", "a_truss_carries", "a_rigid_block")


@pytest.fixture(scope="session")
def solved(tmp_path_factory):
    """Every deck with its physics as it stands."""
    verification = verification_decks(tmp_path_factory.mktemp("recorded"))
    assert len(verification) > 300, "the verification tests solve fewer decks than they have"
    verification = [deck for deck in verification if not any(name in deck.name for name in LEFT_OUT)]
    decks = verification + generated_decks(tmp_path_factory.mktemp("generated")) + oracle_decks(range(3000, 3030))
    folder = tmp_path_factory.mktemp("solved")
    return [(deck, solve(folder / str(number), deck.text, deck.arguments)) for number, deck in enumerate(decks)]


def solve(folder, text, arguments):
    """Runs a deck text."""
    folder.mkdir(parents=True)
    path = folder / "deck.inp"
    path.write_text(text)
    return read(support.run(path, folder, *arguments))


def problem(folder, deck, before, change, ignored=()):
    """Why a changed deck has other physics; None when it has not. `ignored`: kinds that are not compared."""
    try:
        changed, rule = change(deck_cards.parse(deck.text), "calculix" if "calculix" in deck.arguments else "abaqus")
        after = solve(folder, deck_cards.text(changed), deck.arguments)
        motion = largest(before.displacements)
        allowed = TOLERANCE * max(1.0, RESOLVED * size(deck_cards.parse(deck.text)) / motion if motion else 1.0)
        found = differences(before, after, rule)
        bad = {kind: value for kind, value in found.items() if kind not in ignored and not value <= allowed}
    except (AssertionError, ValueError, KeyError) as error:
        bad = f"{type(error).__name__}: {str(error)[:600]}"
    return f"{deck.name} {' '.join(deck.arguments)}: {bad}" if bad else None


@pytest.mark.parametrize("change", CHANGES)
def test_the_physics_stays(solved, tmp_path, change):
    """The solver shall give the same physics in any frame and any units, to 1e-9."""
    found = [problem(tmp_path / str(i), *case, CHANGES[change]) for i, case in enumerate(solved)]
    found = [message for message in found if message]
    assert not found, f"{len(found)} of {len(solved)} decks differ:\n" + "\n".join(found[:20])


WRONG = {
    "a stiffness in other units than its deck": lambda cards, dialect: spoiled(cards, dialect, "*SURFACE BEHAVIOR", 0),
    "a motion in other units than its deck": lambda cards, dialect: spoiled(cards, dialect, "*BOUNDARY", 3),
    "a coordinate": lambda cards, dialect: spoiled(cards, dialect, "*NODE", 3),
}


def spoiled(cards, dialect, keyword, column):
    """A deck in metres with one number wrong in the seventh digit."""
    changed, rule = CHANGES["metres"](cards, dialect)
    lines = [line for card in changed if card.keyword == keyword for line in card.data]
    line = next(line for line in reversed(lines) if column < len(line) and float(line[column]) != 0.0)
    line[column] = repr(float(line[column]) * (1.0 + 1e-7))
    return changed, rule


@pytest.mark.parametrize("mistake", WRONG)
def test_a_wrong_change_is_noticed(solved, tmp_path, mistake):
    """The comparison shall tell a number that is wrong by 1e-7."""
    case = next(case for case in solved if case[0].name == "two_blocks.inp")
    assert problem(tmp_path / "right", *case, CHANGES["metres"]) is None
    assert problem(tmp_path / "wrong", *case, WRONG[mistake]) is not None


def test_a_wrong_rotation_is_noticed(solved, tmp_path):
    """Turned by 1e-7 more than the comparison knows."""
    case = next(case for case in solved if case[0].name == "two_blocks.inp")

    def more(cards, dialect):
        little = np.array([[1.0, 0.0, 1e-7], [0.0, 1.0, 0.0], [-1e-7, 0.0, 1.0]])
        changed, rule = turned(cards, rotation() @ little, (0.0, 0.0, 0.0))
        rule.rotation = rotation()
        return changed, rule

    assert problem(tmp_path / "right", *case, CHANGES["turned"]) is None
    assert problem(tmp_path / "wrong", *case, more) is not None
