"""The motion of a deck does not depend on where it is, how it is turned, and in which units it is written."""

import pytest

from .collection import moving_decks
from .test_invariance import CHANGES, problem, solve


@pytest.fixture(scope="module")
def moved(tmp_path_factory):
    """Every moving deck with its physics as it stands."""
    folder = tmp_path_factory.mktemp("moving")
    return [(deck, solve(folder / str(i), deck.text, deck.arguments)) for i, deck in enumerate(moving_decks())]


def ignored(deck, change):
    """A turned deck holds its nodes through equations. At the end of an implicit increment forces are in balance with weights for its
    start and its end: reactions that come through equations carry what that leaves at the directions which they eliminate.
    """
    through_equations = change.startswith("turned") and "*DYNAMIC, EXPLICIT" not in deck.text
    return ("reaction", "total") if through_equations else ()


@pytest.mark.parametrize("change", CHANGES)
def test_the_motion_stays(moved, tmp_path, change):
    """The solver shall give the same motion through contact in any frame and any units, to 1e-9."""
    # Automatic increments follow the largest component of what is out of balance, which turns with the deck.
    cases = [case for case in moved if not (change.startswith("turned") and case[0].name == "implicit automatic")]
    found = [
        problem(tmp_path / str(i), *case, CHANGES[change], ignored(case[0], change)) for i, case in enumerate(cases)
    ]
    found = [message for message in found if message]
    assert not found, f"{len(found)} of {len(moved)} decks differ:\n" + "\n".join(found[:20])
