"""The published table of requirements is the list that the tests use."""

from verification.catalogue import CASES, END, START, published, table


def test_the_readme_shows_the_present_table():
    assert published() == table(), (
        f"run `python tests/verification/catalogue.py` to renew the table between {START} and {END}"
    )


def test_every_requirement_is_a_sentence_and_every_name_is_unique():
    assert len({case.name for case in CASES}) == len(CASES)
    for case in CASES:
        assert " shall " in case.requirement and case.requirement.endswith(".")
