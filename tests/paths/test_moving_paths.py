"""The dense and the sparse path where implicit decks move through contact."""

from invariance.collection import moving_decks

from .tables import disagreements


def test_both_paths_give_the_same_motion(tmp_path):
    """The solver shall give the same figures by the dense and by the sparse path, to 1e-10 of the largest of their kind."""
    decks = [deck for deck in moving_decks() if "*DYNAMIC, EXPLICIT" not in deck.text]
    assert len(decks) >= 5
    problems = disagreements(decks, tmp_path)
    assert not problems, f"{len(problems)} of {len(decks)} decks differ:\n" + "\n".join(problems)
