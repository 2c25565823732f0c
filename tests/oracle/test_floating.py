"""The solver against the oracle on seeded random decks of bodies that contact holds, with equations, springs and bars."""

import collections

import pytest

import support
from oracle.deck import text
from oracle.floating_comparison import compare
from oracle.parallel import in_parallel
from oracle.pulled import pulled_deck

DECKS = 500
TOLERANCE = 1e-9


def failures(reports):
    """What a developer wants to read first: seeds with the largest differences."""
    lines = []
    for report in reports:
        bad = {k: v for k, v in report.differences.items() if not v <= TOLERANCE}
        if bad or report.problem:
            lines.append(f"seed {report.seed} ({report.kind}, {report.points} points): {bad or report.problem}")
    return lines


def test_500_decks_of_floating_bodies_agree_with_the_oracle():
    """The solver shall solve every deck that has a solution, and agree with it in all that is unique, to 1e-9."""
    reports = in_parallel(compare, range(DECKS))
    found = failures(reports)
    assert not found, f"{len(found)} of {DECKS} decks differ:\n" + "\n".join(found[:20])
    kinds = collections.Counter(r.kind for r in reports)
    assert len(kinds) == 6 and min(kinds.values()) > DECKS // 20, kinds
    shares = {
        "partly closed": sum(any(0 < n < r.points for n in r.closed) for r in reports),
        "with points that open or close": sum(len(set(r.closed)) > 1 for r in reports),
        "with motions that contact holds": sum(r.floating > 0 for r in reports),
        "with motions that nothing holds": sum(r.loose > 0 for r in reports),
        "with equations": sum(r.equations > 0 for r in reports),
        "with springs or bars": sum(r.connectors > 0 for r in reports),
    }
    assert min(shares.values()) > DECKS // 8, shares
    assert sum(r.redundant for r in reports) > DECKS // 50, "too few decks have dependent hard points"
    assert sum(r.unresolved for r in reports) < DECKS // 10, "the oracle cannot solve what it draws"


@pytest.mark.parametrize("seed", range(20))
def test_a_body_that_nothing_can_hold_is_told_by_name_and_motion(tmp_path, seed):
    """The solver shall stop where a load moves a body for ever, and name body and motion: before it starts (exit code 2) where
    contact could never resist the motion, else when contact has let go (exit code 3)."""
    deck, body, _ = pulled_deck(seed)
    path = tmp_path / "pulled.inp"
    path.write_text(text(deck))
    done = support.call("run", path, "--out", tmp_path, "--quiet")
    assert done.returncode in (2, 3), done.stderr
    said = [line for line in done.stderr.splitlines() if "neither supports nor contact hold" in line]
    assert said and f"BODY{body + 1}" in said[0], done.stderr
    assert "translation" in said[0] or "rotation" in said[0]
    if done.returncode == 3:
        summary = support.Result(tmp_path, "pulled").summary()
        assert summary["outcome"] == "stopped" and f"BODY{body + 1}" in summary["reason"]
