"""Pressure profiles of C01 and C03 against Hertz, and errors over the mesh, as pictures and as a table.

    PYTHONPATH=tests:examples .venv/bin/python -m hertz.pictures --out out/hertz
    PYTHONPATH=tests:examples .venv/bin/python -m hertz.pictures --finest     # ball with 20 elements too: minutes, gigabytes

The tests assert what the pictures show; these are for looking at.
"""

import argparse
import math
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
from demo_plots import GRID, MUTED, style

import support
from hertz import cylinder, sphere
from hertz.theory import line_contact, plane_modulus, point_contact, profile_error
from verification.catalogue import reference

SHADES = ["#9cc3e6", "#5a95cf", "#1f5fa8", "#0b2e59"]


def ball_answers(meshes, folder):
    """C01: (elements over a, answer, theory at its force) of each mesh."""
    inputs = reference("C01")["inputs"]
    problem = sphere.Ball(inputs["R"], inputs["F"], inputs["E"], inputs["nu"])
    for elements in meshes:
        text, mesh = sphere.deck(problem, elements, "approach")
        deck = folder / f"ball{elements}.inp"
        deck.write_text(text, encoding="ascii")
        answer = sphere.read(support.run(deck, folder, timeout=3600), mesh)
        modulus = plane_modulus((problem.young, problem.poisson))
        yield elements, answer, point_contact(problem.radius, answer.force, modulus)


def roller_answers(meshes, folder, load):
    """C03 under that part of its force: the same."""
    inputs = reference("C03")["inputs"]
    steel, aluminium = ((inputs[name], inputs["nu"]) for name in ("E1", "E2"))
    problem = cylinder.Roller(inputs["R"], load * inputs["P_per_length"], steel, aluminium, 100.0)
    for elements in meshes:
        text, mesh = cylinder.deck(problem, elements, problem.line_load_approach())
        deck = folder / f"roller{elements}.inp"
        deck.write_text(text, encoding="ascii")
        answer = cylinder.read(support.run(deck, folder, timeout=3600), mesh)
        yield elements, answer, line_contact(problem.radius, answer.force_per_length, plane_modulus(steel, aluminium))


def profiles(axes, answers, title):
    """Pressures of all meshes in units of a and p_max, and the ellipse."""
    circle = [math.pi * i / 400.0 for i in range(201)]
    axes.plot([math.sin(t) for t in circle], [math.cos(t) for t in circle], color=MUTED, ls="--", lw=1.4, label="Hertz")
    for (elements, answer, theory), color in zip(answers, SHADES, strict=False):
        near = [(r / theory.a, p / theory.p_max) for r, p, _ in answer.profile if r <= 1.4 * theory.a]
        axes.plot(*zip(*near, strict=True), ".", ms=4, color=color, label=f"{elements} elements over a")
    axes.grid(color=GRID, lw=0.6)
    axes.legend(frameon=False)
    style(axes, title, "distance from the centre / a", "CPRESS / peak pressure of Hertz")


def errors(axes, families):
    """Errors over the number of elements, both axes logarithmic. `families`: (name, color, answers)."""
    for name, color, answers in families:
        counts = [elements for elements, _, _ in answers]
        peak = [abs(answer.p_max / theory.p_max - 1.0) for _, answer, theory in answers]
        mean = [profile_error(answer.profile, theory) for _, answer, theory in answers]
        axes.loglog(counts, peak, "o-", color=color, label=f"{name}: peak")
        axes.loglog(counts, mean, "s--", color=color, mfc="none", label=f"{name}: mean")
    span = [5.0, 20.0]
    for order, start in ((1, 0.06), (2, 0.008)):
        axes.loglog(span, [start * (span[0] / x) ** order for x in span], color=MUTED, lw=0.8, ls=":")
        axes.annotate(f"slope {order}", (span[1], start * (span[0] / span[1]) ** order), color=MUTED, fontsize=8)
    axes.set_xticks([5, 7, 10, 20], ["5", "7", "10", "20"], minor=False)
    axes.set_xticks([], minor=True)
    axes.grid(color=GRID, lw=0.6, which="both")
    axes.legend(frameon=False, fontsize=8)
    style(axes, "Relative error of CPRESS", "elements over a", "")


def main():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=support.ROOT / "out" / "hertz", help="folder of the pictures")
    parser.add_argument("--finest", action="store_true", help="the ball with 20 elements over the radius as well")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    balls = list(ball_answers((5, 7, 10, 20) if options.finest else (5, 7, 10), options.out))
    light = list(roller_answers((5, 10, 20), options.out, 0.01))
    rollers = list(roller_answers((5, 10, 20), options.out, 1.0))
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(15, 4.6), layout="constrained")
    profiles(left, balls, "Ball on a flat (C01)")
    profiles(middle, rollers, "Roller on a block (C03)")
    errors(right, [("ball", SHADES[2], balls), ("roller, light", "#d9772b", light)])
    figure.savefig(options.out / "hertz.png", dpi=150)
    print("deck, elements over a, peak pressure / Hertz - 1, mean error of CPRESS")
    for name, answers in (("ball", balls), ("roller, 1 % of the force", light), ("roller", rollers)):
        for elements, answer, theory in answers:
            mean = profile_error(answer.profile, theory)
            print(f"{name}, {elements}, {answer.p_max / theory.p_max - 1.0:+.5f}, {mean:.4f}")


if __name__ == "__main__":
    main()
