"""The table of CalculiX's contact decks says what becomes of them."""

import pytest

from peers import collection, survey

DECK = """*ELEMENT, TYPE=C3D8, ELSET=A
*Element,type = SPRINGA
*CONTACT PAIR, INTERACTION=I, Type=Node to Surface, ADJUST=0.1
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
*INITIAL CONDITIONS, TYPE=VELOCITY
*STEP, INC=3, NLGEOM
"""


def test_what_a_deck_has_is_read_in_any_spelling():
    assert survey.has(DECK) == "C3D8, SPRINGA; node-to-surface; linear; ADJUST; NLGEOM"


@pytest.mark.parametrize(
    ("keyword", "message", "shown"),
    [
        ("*FRICTION", "friction coefficient 0.2", "friction"),
        ("*INITIAL CONDITIONS", "the keyword is not supported", "dynamics"),
        (
            "*CONTACT PAIR",
            "the secondary surface S has faces with midside nodes",
            "a secondary surface with midside nodes",
        ),
        ("*CONTACT PAIR", "the data line is missing", "*CONTACT PAIR: the data line is missing"),
    ],
)
def test_reasons_are_short_where_known_and_whole_where_not(keyword, message, shown):
    assert survey.reason(keyword, message, DECK) == shown


def test_the_document_shows_the_present_table():
    rows = survey.survey(collection.required())
    assert {row.name: row for row in rows} == survey.documented(), "renew it: python -m peers.survey --write"
    assert len(rows) >= 50
