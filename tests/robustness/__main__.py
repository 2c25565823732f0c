"""`python -m robustness --decks 1000 --out out/robustness`: runs the random decks, prints and keeps the report."""

import argparse
import sys
from pathlib import Path

from oracle.parallel import in_parallel
from robustness import runner


def main():
    """Exit code 1 when the suite does not keep its promises."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--decks", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--out", type=Path, default=Path("out/robustness"))
    parser.add_argument("--deck", type=int, help="print the deck of one seed and stop")
    options = parser.parse_args()
    if options.deck is not None:
        sys.stdout.write(runner.random_robust_deck(options.deck).text)
        return 0
    outcomes = in_parallel(runner.run, range(options.first, options.first + options.decks))
    runner.write(outcomes, options.out)
    print(runner.report(outcomes), end="")
    problems = runner.broken(outcomes)
    for problem in problems:
        print(f"FAILED: {problem}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
