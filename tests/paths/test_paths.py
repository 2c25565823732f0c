"""The dense and the sparse path give the same results."""

from invariance.collection import generated_decks, oracle_decks, verification_decks

from .tables import differing, disagreements

HELD = range(100)


def test_both_paths_give_the_same_results(tmp_path, tmp_path_factory):
    """The solver shall give the same figures by the dense and by the sparse path, to 1e-10 of the largest of their kind."""
    verification = verification_decks(tmp_path_factory.mktemp("recorded"))
    assert len(verification) > 300, "the verification tests solve fewer decks than they have"
    decks = verification + generated_decks(tmp_path_factory.mktemp("generated")) + oracle_decks(HELD)
    problems = disagreements(decks, tmp_path)
    assert not problems, f"{len(problems)} of {len(decks)} decks differ:\n" + "\n".join(problems[:20])


def test_the_comparison_notices_small_differences():
    """A figure wrong by 1e-9, a changed status and a missing row are found."""
    header = ["step", "status", "COPEN", "CPRESS"]
    dense = {"contact": (header, [["1", "CL", "0.0", "2.0"], ["1", "OP", "0.25", "0.0"]])}
    same = {"contact": (header, [["1", "CL", "1e-15", "2.0"], ["1", "OP", "0.25", "0.0"]])}
    assert not differing(dense, same)
    wrong = [
        [["1", "CL", "0.0", "2.000000002"], ["1", "OP", "0.25", "0.0"]],
        [["1", "OP", "0.0", "2.0"], ["1", "OP", "0.25", "0.0"]],
        [["1", "CL", "0.0", "2.0"]],
    ]
    for rows in wrong:
        assert differing(dense, {"contact": (header, rows)})
