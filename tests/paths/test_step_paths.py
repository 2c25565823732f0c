"""The dense and the sparse path where contact changes from step to step."""

from invariance.collection import Deck

from oracle.parallel import in_parallel
from oracle.stepwise.comparison import suitable
from oracle.stepwise.plan import text

from .tables import disagreements

PLANS = 100


def plan_deck(seed):
    """The plan of a seed: enforcements, latches, the state table, damping, removal, interference."""
    return Deck(f"plan_{seed}", text(suitable(seed)[0]), [])


def test_both_paths_give_the_same_results_step_by_step(tmp_path):
    """The solver shall give the same figures by the dense and by the sparse path, to 1e-10 of the largest of their kind."""
    decks = in_parallel(plan_deck, range(PLANS))
    problems = disagreements(decks, tmp_path)
    assert not problems, f"{len(problems)} of {len(decks)} decks differ:\n" + "\n".join(problems[:20])
