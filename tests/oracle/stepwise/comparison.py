"""A random plan solved by the oracle and by the solver, compared figure by figure."""

import itertools
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

import support

from ..comparison import DISPLACEMENT_MAX, columns
from .draws import KINDS, random_plan
from .march import March
from .plan import text
from .problem import Unsuitable

TRIES = 40


@dataclass
class Report:
    """Differences of a seed, by kind of figure, relative to the largest of the kind; what the plan exercised."""

    seed: int
    kind: str
    points: int = 0
    changes: int = 0
    augmentations: int = 0
    tension: bool = False
    differences: dict[str, float] = field(default_factory=dict)
    problem: str = ""


def suitable(seed):
    """Plan, kind, answers and augmentations; draws without a clear answer are replaced by the next draw of the seed."""
    for attempt in range(TRIES):
        # Keeps the kind, which is the last digit.
        plan, kind = random_plan(seed + attempt * 1000003 // len(KINDS) * len(KINDS))
        try:
            march = March(plan)
            answers, augmentations = march.run()
        except (Unsuitable, np.linalg.LinAlgError):
            continue
        if max(np.abs(a.displacement).max() for a in answers) <= DISPLACEMENT_MAX:
            return plan, kind, march, answers, augmentations
    raise RuntimeError(f"seed {seed} gives no suitable plan in {TRIES} draws")


def compare(seed):
    """Solves the plan of a seed both ways."""
    plan, kind, march, answers, augmentations = suitable(seed)
    report = Report(seed, kind, march.size)
    states = [tuple(a.status) for a in answers]
    report.changes = sum(a != b for a, b in itertools.pairwise(states))
    report.augmentations = sum(augmentations)
    report.tension = any((a.pressure < 0.0).any() for a in answers)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "plan.inp"
        path.write_text(text(plan))
        try:
            result = support.run(path, folder)
            measure(report, plan, march, answers, result)
            found = [step["augmentations"] for step in result.summary()["steps"]]
            if found != augmentations:
                report.problem = f"augmentations {found} instead of {augmentations}"
            elif kind != "modified" and result.summary()["audit"]:
                report.problem = f"audit: {result.summary()['audit']}"
        except (AssertionError, KeyError, ValueError) as error:
            report.problem = f"{type(error).__name__}: {str(error)[-700:]}"
    return report


def measure(report, plan, march, answers, result):
    """Fills in the differences."""
    contact, nodes = by_increment_and_step(result.table("contact")), by_increment_and_step(result.table("nodes"))
    if not len(contact) == len(nodes) == len(answers):
        raise ValueError(f"{len(contact)}, {len(nodes)} output times instead of {len(answers)}")
    order = plan.deck.point_labels()
    motion = max(np.abs(a.displacement).max() for a in answers)
    scale = {
        "pressure": max(np.abs(a.pressure).max() for a in answers),
        "shear": max(max(np.abs(a.shear).max(), np.abs(a.pressure).max()) for a in answers),
        "overclosure": max(max(np.abs(a.overclosure).max() for a in answers), motion),
        "displacement": motion,
        # What nothing presses has reactions of rounding alone.
        "reaction": max(max(np.abs(a.reaction).max() for a in answers), 1e-3 * motion / march.weight),
    }
    worst = dict.fromkeys(scale, 0.0)

    def note(kind, actual, expected):
        worst[kind] = max(worst[kind], float(np.abs(actual - expected).max(initial=0.0)) / (scale[kind] or 1.0))

    for answer, points, rows in zip(answers, contact, nodes, strict=True):
        points = [row for row in points if answer.active[order[row["pair"], int(row["node"])]]]
        places = [order[row["pair"], int(row["node"])] for row in points]
        if sorted(places) != list(np.flatnonzero(answer.active)):
            raise ValueError("contact rows are missing or repeated")
        if points:
            values = columns(points, "COPEN", "CPRESS", "CSHEAR1", "CSHEAR2")
            note("overclosure", -values[:, 0], (answer.overclosure - answer.allowed)[places])
            note("pressure", values[:, 1], (answer.pressure + answer.viscous)[places])
            note("shear", values[:, 2:], answer.shear[places])
            told = [row["status"] for row in points]
            expected = [answer.status[i] for i in places]
            if told != expected:
                raise ValueError(f"step {answer.step + 1}: statuses {told} instead of {expected}")
        labels = [int(row["node"]) - 1 for row in rows]
        note("displacement", columns(rows, "U1", "U2", "U3"), answer.displacement[labels])
        note("reaction", columns(rows, "RF1", "RF2", "RF3"), answer.reaction[labels])
    report.differences = worst


def by_increment_and_step(rows):
    """Rows grouped by step and increment, in order."""
    groups = {}
    for row in rows:
        groups.setdefault((int(row["step"]), int(row["increment"])), []).append(row)
    return [groups[key] for key in sorted(groups)]
