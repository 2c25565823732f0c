"""Runs random decks through the binary and keeps what came of each."""

import json
import subprocess
import tempfile
import time
from dataclasses import asdict, dataclass
from pathlib import Path

import support

from .decks import random_robust_deck

SECONDS_MAX = 20.0
# Done, the input is wrong, the solution could not be continued.
CODES = (0, 2, 3)


@dataclass
class Outcome:
    """What came of a deck. `code` is none when it did not end in time; `reason` says why it failed, "" when it did not."""

    seed: int
    words: list[str]
    plain: bool
    code: int | None
    audit: list[str]
    seconds: float
    reason: str
    cutbacks: int = 0
    augmentations: int = 0

    @property
    def clean(self):
        """Completed, with nothing that the audit finds."""
        return self.code == 0 and not self.audit


def run(seed):
    """Solves the deck of a seed."""
    drawn = random_robust_deck(seed)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "deck.inp"
        path.write_text(drawn.text, encoding="utf-8")
        started = time.perf_counter()
        try:
            done = support.call("run", path, "--out", folder, "--quiet", timeout=SECONDS_MAX)
        except subprocess.TimeoutExpired:
            seconds = time.perf_counter() - started
            return Outcome(seed, sorted(drawn.words), drawn.plain, None, [], seconds, "did not end in time")
        seconds = time.perf_counter() - started
        summary = Path(folder) / "deck.json"
        told = json.loads(summary.read_text()) if summary.is_file() else {"audit": [], "reason": None, "steps": []}
    errors = [line.replace(folder, "") for line in done.stderr.splitlines() if "warning:" not in line]
    reason = told["reason"] or " | ".join(errors[:3]) if done.returncode else "; ".join(told["audit"])
    if "panicked" in done.stderr:
        reason = "panic: " + " | ".join(errors[:3])
    counts = [sum(step[name] for step in told["steps"]) for name in ("cutbacks", "augmentations")]
    return Outcome(seed, sorted(drawn.words), drawn.plain, done.returncode, told["audit"], seconds, reason, *counts)


def figures(outcomes):
    """Numbers of a set of outcomes."""
    times = sorted(outcome.seconds for outcome in outcomes)
    plain = [outcome for outcome in outcomes if outcome.plain]
    return {
        "decks": len(outcomes),
        "completed": sum(outcome.code == 0 for outcome in outcomes),
        "clean": sum(outcome.clean for outcome in outcomes),
        "frictionless hard or softened": len(plain),
        "of these clean": sum(outcome.clean for outcome in plain),
        "stopped": sum(outcome.code == 3 for outcome in outcomes),
        "refused": sum(outcome.code == 2 for outcome in outcomes),
        "neither": sum(outcome.code not in CODES for outcome in outcomes),
        "with cutbacks": sum(outcome.cutbacks > 0 for outcome in outcomes),
        "augmentations": sum(outcome.augmentations for outcome in outcomes),
        "seconds, median": times[len(times) // 2],
        "seconds, longest": times[-1],
    }


def report(outcomes):
    """Text: the figures, then every deck that did not end clean, with its reason."""
    lines = [
        f"{name}: {value:.3g}" if isinstance(value, float) else f"{name}: {value}"
        for name, value in figures(outcomes).items()
    ]
    for outcome in outcomes:
        if not outcome.clean:
            words = ", ".join(outcome.words)
            lines.append(
                f"seed {outcome.seed} ({words}{'; plain' if outcome.plain else ''}): exit {outcome.code}: {outcome.reason}"
            )
    return "\n".join(lines) + "\n"


def write(outcomes, folder):
    """Leaves report.txt and outcomes.json."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "report.txt").write_text(report(outcomes), encoding="utf-8")
    (folder / "outcomes.json").write_text(json.dumps([asdict(o) for o in outcomes], indent=1), encoding="utf-8")


CLEAN_MIN = 0.98


def broken(outcomes):
    """Promises that a set of outcomes breaks, as text."""
    found = [
        f"seed {o.seed}: exit {o.code}: {o.reason}" for o in outcomes if o.code not in CODES or "panic" in o.reason
    ]
    found += [f"seed {o.seed} is refused: {o.reason}" for o in outcomes if o.code == 2]
    found += [f"seed {o.seed} (frictionless hard or softened): {o.reason}" for o in outcomes if o.plain and not o.clean]
    clean = sum(outcome.clean for outcome in outcomes)
    if clean < CLEAN_MIN * len(outcomes):
        found.append(f"{clean} of {len(outcomes)} decks end clean, fewer than {CLEAN_MIN:.0%}")
    return found
