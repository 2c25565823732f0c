"""The dense and the sparse path on bodies that contact holds."""

from invariance.collection import floating_deck

from oracle.floating_comparison import compare
from oracle.parallel import in_parallel

from .tables import differing, disagreements, tables

DECKS = 120
# Enough must be left to compare.
COMPARED_MIN = 60
# Closed points that leave a body free to move between others: each path has its own place there, with the same forces.
FREE_BETWEEN_CONTACTS = (16, 27, 30, 41)
FORCES = ("CPRESS", "CFN", "RF")


def test_both_paths_give_the_same_results_for_floating_bodies(tmp_path):
    """The solver shall give the same figures by the dense and by the sparse path, to 1e-10 of the largest of their kind, where the
    solution is unique: hard points that depend on each other share their force in many ways, and each path has its own."""
    reports = in_parallel(compare, range(DECKS))
    seeds = [report.seed for report in reports if not report.redundant and report.seed not in FREE_BETWEEN_CONTACTS]
    decks = [floating_deck(seed) for seed in seeds]
    assert len(decks) >= COMPARED_MIN
    problems = disagreements(decks, tmp_path)
    assert not problems, f"{len(problems)} of {len(decks)} decks differ:\n" + "\n".join(problems[:20])


def test_both_paths_give_the_same_forces_where_a_body_is_free_between_contacts(tmp_path):
    """The solver shall give the same contact forces and reactions by both paths, to 1e-10 of the largest, wherever bodies stand."""
    for seed in FREE_BETWEEN_CONTACTS:
        deck = floating_deck(seed)
        by_path = [tables(tmp_path / f"{seed}{path}", deck, path) for path in ("dense", "sparse")]
        found = [column for column in differing(*by_path) if any(force in column for force in FORCES)]
        assert not found, f"{deck.name}: {found}"
