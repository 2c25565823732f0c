"""Errors of both time operators over the size of increments, measured through the binary.

    PYTHONPATH=tests .venv/bin/python -m verification.dynamics.orders [--write]

A chain of three masses, whose motion is known from its modes; a mass that falls onto a hard wall; a mass on a straight law; the
amplitude that alpha takes per period. `--write` puts the tables into tests/README.md.
"""

import argparse
import itertools
import math
import tempfile
from pathlib import Path

import numpy as np

from oracle.dynamics import system
from verification.dynamics import motion, published

MASSES, SPRINGS, GROUND = [1.0, 2.0, 0.5], [400.0, 900.0], [(0, 250.0)]
SPEEDS, PERIOD = [1.0, -0.5, 2.0], 0.4
COUNTS = [80, 160, 320, 640]
ALPHAS = [0.0, -0.05, -0.1, -0.3]
# Increments per period in which alpha is measured.
PER_PERIOD = [10, 20, 40]


def solve(text, folder):
    """The run of deck text."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "deck.inp"
    path.write_text(text, encoding="utf-8")
    return motion.Run(motion.support.run(path, folder))


def exact(time):
    """Displacements of the chain from its modes, and velocities."""
    mass, stiffness = system.chain(MASSES, SPRINGS, GROUND)
    root = np.sqrt(np.diag(mass))
    squares, modes = np.linalg.eigh(stiffness / np.outer(root, root))
    w = np.sqrt(squares)
    amplitude = modes.T @ (root * SPEEDS)
    return (modes @ (amplitude * np.sin(w * time) / w)) / root, (modes @ (amplitude * np.cos(w * time))) / root


def chain_error(folder, count, alpha):
    """Largest error of a displacement at the end over the largest displacement there; explicit where alpha is none."""
    scene = motion.Scene(explicit=alpha is None)
    labels = [scene.node(1.0 + i, v, m) for i, (v, m) in enumerate(zip(SPEEDS, MASSES, strict=True))]
    for i, k in enumerate(SPRINGS):
        scene.spring(labels[i : i + 2], k)
    for i, k in GROUND:
        scene.spring([labels[i]], k)
    options = {} if alpha is None else {"alpha": alpha}
    run = solve(scene.text(scene.step(PERIOD / count, count, **options)), folder)
    expected, _ = exact(PERIOD)
    found = np.array([run.node(label, "U3")[-1] for label in labels])
    return float(np.abs(found - expected).max() / np.abs(expected).max())


def impact_error(folder, count):
    """Error of the time at which a mass that is pushed from rest meets a hard wall, over that time."""
    gap, push = 0.3, 2.0
    expected = math.sqrt(2.0 * gap / push)
    # The impact stands at 0.4 of its increment in every run.
    dt = expected / (count + 0.4)
    scene = motion.Scene()
    node = scene.node(gap, mass=1.0)
    scene.pair([node], motion.HARD)
    run = solve(scene.text(scene.implicit(dt, count + 2, "*CLOAD", f"{node}, 3, {-push!r}")), folder)
    (change,) = [c for c in run.summary["status_changes"] if c["to"] == "CL"]
    return abs(change["time"] - expected) / expected


def touch_error(folder, count):
    """Explicit, hard kinematic: end of the first increment in contact less the time of touch, over that time."""
    gap, speed = 0.3, 2.0
    expected = gap / speed
    dt = expected / (count + 0.4)
    scene = motion.Scene(explicit=True)
    node = scene.node(gap, -speed, 1.0)
    scene.pair([node], motion.HARD)
    run = solve(scene.text(scene.central(dt, count + 2)), folder)
    return abs(run.time[np.flatnonzero(run.force(node) > 0.0)[0]] - expected) / expected


def rebound_error(folder, count, explicit):
    """Error of the time in contact with a straight law, over that time."""
    stiffness, speed = 400.0, 1.0
    expected = math.pi / 20.0
    dt = expected / count
    scene = motion.Scene(explicit=explicit)
    gap = 1.4 * dt * speed
    node = scene.node(gap, -speed, 1.0)
    damping = motion.UNDAMPED if explicit else []
    words = ["MECHANICAL CONSTRAINT=PENALTY"] if explicit else []
    scene.pair([node], [*motion.linear(stiffness), *damping], 1.0, words)
    run = solve(scene.text(scene.step(dt, count + 6)), folder)
    place = gap + run.node(node, "U3")
    span = motion.crossing(run.time, place, 0.0, True) - motion.crossing(run.time, place, 0.0, False)
    return abs(span - expected) / expected


def amplification(alpha, scaled):
    """Spectral radius of the operator for frequency times dt: from its own 3 by 3 matrix of (u, dt v, dt^2 a)."""
    beta, gamma = 0.25 * (1.0 - alpha) ** 2, 0.5 - alpha
    square = scaled**2
    new = np.array([[1.0, 0.0, -beta], [0.0, 1.0, -gamma], [(1.0 + alpha) * square, 0.0, 1.0]])
    old = np.array([[1.0, 1.0, 0.5 - beta], [0.0, 1.0, 1.0 - gamma], [alpha * square, 0.0, 0.0]])
    return float(np.abs(np.linalg.eigvals(np.linalg.solve(new, old))).max())


def amplitude_kept(folder, alpha, per_period):
    """Part of the amplitude of a mass on a spring that is left after ten periods: by its energy."""
    w, count = 2.0 * math.pi, 10 * per_period
    scene = motion.Scene()
    node = scene.node(1.0, 1.0, 1.0)
    scene.spring([node], w**2)
    run = solve(scene.text(scene.implicit(1.0 / per_period, count, alpha=alpha)), folder)
    u, v = run.node(node, "U3"), run.node(node, "V3")
    energy = 0.5 * (v**2 + (w * u) ** 2)
    # Between two periods later on: the start is not of the principal root alone.
    middle, whole = 2 * per_period, 8 * per_period
    return float(math.sqrt(energy[middle + whole - 1] / energy[middle - 1]))


def orders(errors):
    """Order between each two neighbours."""
    return [math.log2(a / b) for a, b in itertools.pairwise(errors)]


def measure(folder):
    """Errors by the name of a row."""
    found = {}
    for alpha in (*ALPHAS, None):
        name = "explicit" if alpha is None else f"implicit, alpha {alpha:g}"
        found[f"{name}: three masses on springs"] = [chain_error(folder / f"chain{alpha}{n}", n, alpha) for n in COUNTS]
    found["implicit: time of a hard impact"] = [impact_error(folder / f"impact{n}", n) for n in (5, 10, 20, 40)]
    found["explicit: first increment of a hard contact"] = [
        touch_error(folder / f"touch{n}", n) for n in (5, 10, 20, 40)
    ]
    for explicit in (False, True):
        name = "explicit, penalty" if explicit else "implicit"
        found[f"{name}: time in contact with a straight law"] = [
            rebound_error(folder / f"rebound{explicit}{n}", n, explicit) for n in (25, 50, 100, 200)
        ]
    return found


def measure_alpha(folder):
    """Rows (alpha, per period, kept, expected) after eight periods."""
    rows = []
    for alpha in ALPHAS:
        for n in PER_PERIOD:
            expected = amplification(alpha, 2.0 * math.pi / n) ** (8 * n)
            rows.append((alpha, n, amplitude_kept(folder / f"alpha{alpha}{n}", alpha, n), expected))
    return rows


def table(found):
    """Markdown of the errors."""
    rows = []
    for name, errors in found.items():
        rows.append([name, *(f"{e:.2e}" for e in errors), f"{orders(errors)[-1]:.2f}"])
    return published.markdown(["what", "dt", "dt / 2", "dt / 4", "dt / 8", "order at the end"], rows)


def alpha_table(rows):
    """Markdown of the amplitudes."""
    header = ["alpha", *(f"{n} increments per period" for n in PER_PERIOD)]
    lines = [[f"{a:g}", *(f"{kept:.4f}" for b, _, kept, _ in rows if b == a)] for a in ALPHAS]
    return published.markdown(header, lines)


def main():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="write the tables into tests/README.md")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        tables = {"orders": table(measure(Path(folder))), "alpha": alpha_table(measure_alpha(Path(folder)))}
    for name, text in tables.items():
        print(text)
        if options.write:
            published.write(name, text)


if __name__ == "__main__":
    main()
