"""Runs random decks through the binary and keeps what came of each."""

import json
import subprocess
import tempfile
import time
from dataclasses import asdict, dataclass
from pathlib import Path

import support
from oracle import laws

from .decks import random_robust_deck

SECONDS_MAX = 20.0
# How well points keep their law: pressures against the largest. Overclosures are known to a part of the extent of the deck, that
# to which the motions of bodies are balanced that contact alone holds; a stiff law makes pressures of it.
LAW_KEPT, BALANCED, EXTENT = 1e-9, 1e-12, 2.0
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
    law: float = 0.0

    @property
    def clean(self):
        """Completed, with nothing that the audit finds and every law kept."""
        return self.code == 0 and not self.audit and self.law <= LAW_KEPT


def law_violation(drawn, result):
    """How far any point is from the law of its pair, relative to LAW_KEPT's scales; 0 is exact."""
    table = result.table("contact")
    strength = max((abs(float(row["CPRESS"])) for row in table), default=0.0) or 1.0
    worst = 0.0
    for row in table:
        law = drawn.laws.get(row["pair"])
        if law is None:
            continue
        h, p = -float(row["COPEN"]), float(row["CPRESS"])
        if laws.is_hard(law):
            product = min(abs(h) / EXTENT, abs(p) / strength)
            worst = max(worst, h / EXTENT, -p / strength, product)
        else:
            value, slope = laws.pressure(law, h)
            worst = max(worst, (abs(p - value) - slope * BALANCED * EXTENT) / strength)
    return worst


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
        law = law_violation(drawn, support.Result(Path(folder), "deck")) if done.returncode == 0 else 0.0
        summary = Path(folder) / "deck.json"
        told = json.loads(summary.read_text()) if summary.is_file() else {"audit": [], "reason": None, "steps": []}
    errors = [line.replace(folder, "") for line in done.stderr.splitlines() if "warning:" not in line]
    reason = told["reason"] or " | ".join(errors[:3]) if done.returncode else "; ".join(told["audit"])
    if "panicked" in done.stderr:
        reason = "panic: " + " | ".join(errors[:3])
    counts = [sum(step[name] for step in told["steps"]) for name in ("cutbacks", "augmentations")]
    if law > LAW_KEPT:
        reason = f"{reason} law kept to {law:.1e} only".strip()
    return Outcome(
        seed, sorted(drawn.words), drawn.plain, done.returncode, told["audit"], seconds, reason, *counts, law
    )


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
        "law kept to": max(outcome.law for outcome in outcomes),
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
