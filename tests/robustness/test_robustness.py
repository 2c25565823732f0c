"""Random decks end, and end well; the whole set is run by `make robustness`."""

from dataclasses import dataclass

from oracle.enumeration import hard, linear
from oracle.parallel import in_parallel

from . import runner
from .decks import Drawn
from .runner import Outcome, broken

DECKS = 150


def test_random_decks_end_clean():
    """The solver shall complete at least 98 % of random small decks with a clean audit and every frictionless hard or softened one;
    none hangs, panics or is refused."""
    outcomes = in_parallel(runner.run, range(DECKS))
    problems = broken(outcomes)
    assert not problems, "\n".join(problems[:20]) + "\n" + runner.report(outcomes)
    words = {word for outcome in outcomes for word in outcome.words}
    wanted = {"hard", "linear", "tabular", "exponential", "augmented", "penalty", "nonlinear", "no separation", "rough"}
    wanted |= {
        "damping",
        "modified hard",
        "stabilize",
        "removal",
        "interference",
        "clearance",
        "held",
        "pressed",
        "sprung",
    }
    assert words == wanted
    assert sum(outcome.plain for outcome in outcomes) > DECKS // 8
    assert sum(outcome.augmentations for outcome in outcomes) > DECKS // 2


def test_the_same_seed_gives_the_same_deck():
    assert (
        runner.random_robust_deck(17).text == runner.random_robust_deck(17).text != runner.random_robust_deck(18).text
    )


@dataclass
class Told:
    """A result with a contact table of one point."""

    overclosure: float
    pressure: float

    def table(self, name):
        """The rows."""
        assert name == "contact"
        return [{"pair": "SEC1_PRI1", "COPEN": repr(-self.overclosure), "CPRESS": repr(self.pressure)}]


def test_broken_laws_are_noticed():
    """A point off its law, an overlap and a tension of hard contact, and forces across a gap."""
    for law, good, bad in (
        (linear(1e3), [(0.002, 2.0), (-0.1, 0.0)], [(0.002, 2.00001), (-0.1, 1.0), (0.002, 0.0)]),
        (hard(), [(0.0, 5.0), (-0.3, 0.0), (0.0, 0.0)], [(1e-6, 5.0), (0.0, -1.0), (-0.3, 1.0)]),
    ):
        drawn = Drawn(0, "", set(), True, {"SEC1_PRI1": law})
        assert all(runner.law_violation(drawn, Told(*point)) <= runner.LAW_KEPT for point in good)
        assert all(runner.law_violation(drawn, Told(*point)) > runner.LAW_KEPT for point in bad)


def outcome(seed, code=0, audit=(), plain=False, reason=""):
    """An outcome."""
    return Outcome(seed, ["hard"], plain, code, list(audit), 0.1, reason)


def test_broken_promises_are_noticed():
    good = [outcome(i) for i in range(98)]
    assert broken([*good, outcome(98, 3), outcome(99, audit=["tension"])]) == []
    assert broken([*good, *(outcome(98 + i, 3) for i in range(3))])
    for bad in (outcome(99, 1), outcome(99, None), outcome(99, 2), outcome(99, 3, plain=True), outcome(99, -9)):
        assert broken([*good, outcome(98), bad])
    assert broken([*good, outcome(98), outcome(99, 0, ["overclosure"], plain=True)])
    assert broken([*good, outcome(98), outcome(99, 3, reason="panic: index out of bounds")])
