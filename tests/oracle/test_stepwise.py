"""The solver against a march of its own over seeded random decks whose contact changes from step to step."""

from collections import Counter

from oracle.parallel import in_parallel
from oracle.stepwise.comparison import compare
from oracle.stepwise.draws import KINDS

DECKS = 500
TOLERANCE = 1e-9


def test_random_decks_of_every_enforcement_agree_step_by_step():
    """The solver shall find statuses, pressures, shear, displacements and augmentations of every increment, to 1e-9."""
    reports = in_parallel(compare, range(DECKS))
    lines = [f"seed {r.seed} ({r.kind}): {r.problem}" for r in reports if r.problem]
    for report in reports:
        bad = {k: v for k, v in report.differences.items() if not v <= TOLERANCE}
        if bad and not report.problem:
            lines.append(f"seed {report.seed} ({report.kind}, {report.points} points): {bad}")
    assert not lines, f"{len(lines)} of {DECKS} decks differ:\n" + "\n".join(lines[:20])
    assert Counter(r.kind for r in reports) == dict.fromkeys(KINDS, DECKS // len(KINDS))
    assert sum(r.changes > 0 for r in reports) > DECKS // 3, "too few decks change status to prove anything"
    assert sum(r.augmentations > 1 for r in reports) > DECKS // 20
    assert sum(r.tension for r in reports) > DECKS // 12
