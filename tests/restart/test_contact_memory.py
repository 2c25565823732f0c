"""What contact remembers survives a snapshot: multipliers, latches, sticking points, statuses, dashpots, removed pairs."""

import pytest
from demonstration import ways
from restart.test_restart import insist_on_the_rest, snapshots

import support
from oracle.parallel import in_parallel
from oracle.stepwise.comparison import suitable
from oracle.stepwise.draws import KINDS
from oracle.stepwise.plan import text

# Plans of each kind.
PLANS = 3


def insist(folder, name, deck, every=1):
    """Runs a deck with a snapshot of every so many increments and goes on from each."""
    path = folder / f"{name}.inp"
    path.write_text(deck, encoding="utf-8")
    whole = support.run(path, folder / "whole", "--snapshots", every)
    listed = snapshots(whole)
    # The end of a step has one besides.
    assert len(listed) == sum(-(-step["increments"] // every) for step in whole.summary()["steps"])
    for one in listed[:-1]:
        place = folder / f"from_{one['step']}_{one['increment']}"
        rest = support.run(path, place, "--restart", whole.folder / one["file"])
        insist_on_the_rest(whole, rest, one)
        counts = ("increments", "equilibrium_iterations", "severe_discontinuity_iterations", "augmentations")
        for step, wholly in zip(rest.summary()["steps"], whole.summary()["steps"], strict=True):
            assert all(step[c] == wholly[c] for c in counts), (name, one, step, wholly)


@pytest.mark.parametrize("name", ways.decks())
def test_a_run_goes_on_with_the_same_bits(tmp_path, name):
    insist(tmp_path, name, ways.decks()[name])


def drawn(seed):
    """Text of the plan of a seed."""
    return text(suitable(seed)[0])


def test_random_plans_of_every_kind_go_on_with_the_same_bits(tmp_path):
    """Latches, multipliers, the state table, damping, removal and interference over several steps."""
    for seed, deck in enumerate(in_parallel(drawn, range(PLANS * len(KINDS)))):
        folder = tmp_path / str(seed)
        folder.mkdir()
        insist(folder, f"plan{seed}", deck)
