"""The figures of the laws: curves by `overclosure law`, loops by `overclosure run`, as CSV and SVG beside the pages.

`python docs/laws/plot.py [BINARY]` rewrites them all (BINARY: target/release/overclosure unless given). Needs matplotlib.
"""

import csv
import hashlib
import io
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
BINARY = HERE.parent.parent / "target" / "release" / "overclosure"
TABLE = "0:-0.01,2:0.005,10:0.02,40:0.03"
INK, MUTED, GRID = "#1f2430", "#6b7280", "#e3e6eb"
COLORS = ("#1f5fa8", "#d9772b", "#3b8f5a", "#8a4fa3")


@dataclass(frozen=True)
class Curve:
    """A curve of `overclosure law`: name in the legend, kind, parameters, overclosures."""

    name: str
    kind: str
    parameters: str
    at: str

    def rows(self, binary):
        """Pairs (overclosure, value): the pressure, or the coefficient of damping."""
        words = [word for parameter in self.parameters.split() for word in ("--param", parameter)]
        text = call(binary, "law", self.kind, *words, f"--at={self.at}")
        column = "coefficient" if self.kind == "damping" else "pressure"
        return [(float(row["overclosure"]), float(row[column])) for row in csv.DictReader(io.StringIO(text))]


@dataclass(frozen=True)
class Walk:
    """What a contact point goes through in a deck of decks/: name in the legend and the deck."""

    name: str
    deck: str

    def rows(self, binary):
        """Pairs (overclosure, pressure) in the order of the increments."""
        with tempfile.TemporaryDirectory() as folder:
            call(binary, "run", HERE / "decks" / f"{self.deck}.inp", "--out", folder, "--quiet")
            text = (Path(folder) / f"{self.deck}_contact.csv").read_text(encoding="utf-8")
        return [(-float(row["COPEN"]), float(row["CPRESS"])) for row in csv.DictReader(io.StringIO(text))]


@dataclass(frozen=True)
class Figure:
    """A figure: title, what is drawn, label of the values, largest value shown."""

    title: str
    curves: tuple
    label: str = "pressure"
    top: float | None = None


FIGURES = {
    "hard": Figure(
        "Hard contact by multipliers: a point is pressed, then pulled", (Walk("path of the point", "hard"),)
    ),
    "penalty": Figure(
        "What stands in for hard contact",
        (
            Curve("penalty, k = 3000", "penalty", "k=3000", "-0.006:0.012:0.0005"),
            Curve("nonlinear penalty", "nonlinear-penalty", "ki=300 kf=30000 d=0.003 e=0.009", "-0.006:0.012:0.0005"),
            Curve("augmented once", "augmented-lagrange", "k=3000 lambda=9", "-0.006:0.012:0.0005"),
            Curve("augmented twice", "augmented-lagrange", "k=3000 lambda=11.25", "-0.006:0.012:0.0005"),
        ),
        top=60.0,
    ),
    "modified-hard": Figure(
        "Modified hard contact, UERRMX = 0.02, PERRMX = 3: once round",
        (Walk("path of the point", "modified-hard"),),
    ),
    "linear": Figure("Linear, k = 250", (Curve("k = 250", "linear", "k=250", "-0.02:0.04:0.002"),)),
    "tabular": Figure(
        "Tabular: four points, then the last slope",
        (Curve(TABLE.replace(",", ", "), "tabular", f"table={TABLE}", "-0.02:0.035:0.0005"),),
    ),
    "exponential": Figure(
        "Exponential, c0 = 0.01, p0 = 5",
        (
            Curve("Standard", "exponential", "c0=0.01 p0=5", "-0.012:0.02:0.0005"),
            Curve("Explicit, Kmax = 2500", "exponential", "c0=0.01 p0=5 kmax=2500", "-0.012:0.02:0.0005"),
            Curve("Explicit, Kmax = 500", "exponential", "c0=0.01 p0=5 kmax=500", "-0.012:0.02:0.0005"),
            Curve("CalculiX, the same numbers", "calculix-exponential", "c0=0.01 p0=5", "-0.012:0.02:0.0005"),
        ),
        top=60.0,
    ),
    "exponential-far": Figure(
        "Exponential in Standard, far in: straight from 6 c0 on",
        (Curve("c0 = 0.01, p0 = 5", "exponential", "c0=0.01 p0=5", "-0.01:0.08:0.001"),),
    ),
    "no-separation": Figure(
        "No separation in Standard: open until the first touch, then either sign",
        (Walk("path of the point", "no-separation"),),
    ),
    "no-separation-soft": Figure(
        "No separation with softened laws in Explicit, after the first touch",
        (
            Curve("linear", "linear", "k=250 separation=prevented procedure=explicit", "-0.03:0.03:0.001"),
            Curve("tabular", "tabular", f"table={TABLE} separation=prevented procedure=explicit", "-0.03:0.03:0.001"),
        ),
    ),
    "damping": Figure(
        "Contact damping, mu0 = 8, c0 = 0.1",
        (
            Curve("eta = 0.4", "damping", "mu0=8 c0=0.1 eta=0.4", "-0.12:0.03:0.005"),
            Curve("eta = 0", "damping", "mu0=8 c0=0.1", "-0.12:0.03:0.005"),
        ),
        label="damping coefficient",
    ),
}


def call(binary, *arguments):
    """Standard output of the binary; raises with what it complained about."""
    done = subprocess.run([str(binary), *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"overclosure {' '.join(map(str, arguments))}\n{done.stderr}")
    return done.stdout


def data(figure, binary):
    """CSV of a figure."""
    lines = [f"curve,overclosure,{figure.label.replace(' ', '_')}"]
    for curve in figure.curves:
        lines += [f'"{curve.name}",{x!r},{y!r}' for x, y in curve.rows(binary)]
    return "\n".join(lines) + "\n"


def digest(text):
    """Checksum that ties a picture to its data."""
    return hashlib.sha256(text.encode()).hexdigest()


def draw(figure, text, path):
    """SVG of a figure from its CSV."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    plt.rcParams |= {"svg.hashsalt": "overclosure", "svg.fonttype": "none", "font.family": "sans-serif"}
    picture, axes = plt.subplots(figsize=(6.4, 3.8), layout="constrained")
    curves = {}
    for row in csv.reader(io.StringIO(text)):
        curves.setdefault(row[0], []).append(row[1:])
    header = curves.pop("curve")[0]
    for (name, points), color in zip(curves.items(), COLORS, strict=False):
        x, y = zip(*((float(a), float(b)) for a, b in points), strict=True)
        if isinstance(figure.curves[0], Walk):
            walk(axes, x, y, color, name)
        else:
            axes.plot(x, y, color=color, linewidth=1.8, label=name)
    axes.axhline(0, color=MUTED, linewidth=0.8, zorder=0)
    axes.axvline(0, color=MUTED, linewidth=0.8, zorder=0)
    axes.grid(color=GRID)
    axes.set_axisbelow(True)
    if figure.top:
        axes.set_ylim(-0.05 * figure.top, figure.top)
    axes.set_title(figure.title, loc="left", fontsize=11, color=INK)
    axes.set_xlabel("overclosure h (positive when the bodies overlap)", color=INK)
    axes.set_ylabel(header[1].replace("_", " "), color=INK)
    axes.tick_params(colors=MUTED)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    axes.legend(frameon=False, loc="upper left")
    picture.savefig(path, format="svg", metadata={"Date": None, "Description": f"data {digest(text)}"})
    plt.close(picture)


def walk(axes, x, y, color, name):
    """A path, point by point; changes of status, where both numbers jump, as dashed arrows, and an arrow along every leg."""
    axes.plot(x, y, linestyle="", marker="o", markersize=2.5, color=color, label=name)
    span = (max(x) - min(x), max(y) - min(y))
    steps = [((b - a) / span[0], (d - c) / span[1]) for a, b, c, d in zip(x, x[1:], y, y[1:], strict=False)]
    legs, headings = [], []
    for i, (across, up) in enumerate(steps):
        jump = min(abs(across), abs(up)) > 1e-3
        heading = "jump" if jump else (across > 1e-9) - (across < -1e-9), (up > 1e-9) - (up < -1e-9)
        if legs and heading == headings[-1] and not jump:
            legs[-1][1] = i + 1
        else:
            legs.append([i, i + 1])
            headings.append(heading)
    for (start, end), heading in zip(legs, headings, strict=True):
        dashed = heading[0] == "jump"
        axes.plot(
            (x[start], x[end]),
            (y[start], y[end]),
            color=color,
            linewidth=1.2 if dashed else 1.8,
            linestyle="--" if dashed else "-",
        )
        # Not in the middle: where the path goes back on itself, the arrows stand beside each other.
        tail, tip = (tuple(line[start] + part * (line[end] - line[start]) for line in (x, y)) for part in (0.4, 0.43))
        if tip != tail:
            style = {"arrowstyle": "-|>", "color": color, "mutation_scale": 14}
            axes.annotate("", xy=tip, xytext=tail, arrowprops=style)


def main(binary=BINARY):
    """Writes every figure with its data."""
    for name, figure in FIGURES.items():
        text = data(figure, binary)
        (HERE / f"{name}.csv").write_text(text, encoding="utf-8")
        draw(figure, text, HERE / f"{name}.svg")


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
