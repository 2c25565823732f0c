#!/usr/bin/env python3
"""Writes contact decks of any size in Abaqus format (readable by CalculiX as well). Standard library only.

    generate_deck.py punch 16 punch16.inp --increments 20
    generate_deck.py hertz 54 hertz54.inp --law hard

punch N   an elastic block, N x N x N/2 bricks, pressed into a larger elastic block on a mesh that does not match.
hertz N   a quarter of a cylinder on a block, one brick thick in plane strain, N bricks along the quarter arc, graded
          towards the contact.

Both are held by prescribed displacements: NTOP is pushed down, NBOT supports. SSL is the secondary surface (on the punch, on
the cylinder), SMA the primary one (on the block below).
"""

import argparse
import math
from dataclasses import dataclass, field
from pathlib import Path

LAWS = ("linear", "hard", "tabular", "exponential")


@dataclass
class Deck:
    """Mesh, sets and surfaces of a deck, with the labels that are written."""

    nodes: list[tuple[float, float, float]] = field(default_factory=list)
    elements: dict[str, list[tuple[int, tuple[int, ...]]]] = field(default_factory=dict)
    node_sets: dict[str, list[int]] = field(default_factory=dict)
    surfaces: dict[str, list[tuple[int, int]]] = field(default_factory=dict)
    element_count: int = 0

    def node(self, x, y, z):
        """Adds a node and returns its label."""
        self.nodes.append((x, y, z))
        return len(self.nodes)

    def brick(self, part, corners):
        """Adds a brick to a part and returns its label."""
        self.element_count += 1
        self.elements.setdefault(part, []).append((self.element_count, tuple(corners)))
        return self.element_count

    def grid(self, part, xs, ys, zs):
        """Fills a box with bricks. Returns the node labels by (i, j, k) and the element labels by (i, j, k)."""
        node = {
            (i, j, k): self.node(x, y, z) for k, z in enumerate(zs) for j, y in enumerate(ys) for i, x in enumerate(xs)
        }
        element = {}
        for k in range(len(zs) - 1):
            for j in range(len(ys) - 1):
                for i in range(len(xs) - 1):
                    ring = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                    corners = [node[a, b, c] for c in (k, k + 1) for a, b in ring]
                    element[i, j, k] = self.brick(part, corners)
        return node, element


def evenly(start, end, count):
    """`count` equal intervals between two coordinates."""
    return [start + (end - start) * i / count for i in range(count + 1)]


def punch_mesh(n, width=1.0, height=0.5, foundation_width=3.0, foundation_height=1.5):
    """Punch of n x n x n/2 bricks in the middle of a block of m x m x m/2 bricks with m = 1.45 n, not matching."""
    m = max(4, round(1.45 * n))
    layers, foundation_layers = max(2, n // 2), max(2, m // 2)
    edge = 0.5 * (foundation_width - width)
    deck = Deck()
    span = evenly(edge, edge + width, n)
    node, element = deck.grid("PUNCH", span, span, evenly(0.0, height, layers))
    deck.node_sets["NTOP"] = [node[i, j, layers] for i in range(n + 1) for j in range(n + 1)]
    deck.surfaces["SSL"] = [(element[i, j, 0], 1) for i in range(n) for j in range(n)]
    span = evenly(0.0, foundation_width, m)
    node, element = deck.grid("FOUNDATION", span, span, evenly(-foundation_height, 0.0, foundation_layers))
    deck.node_sets["NBOT"] = [node[i, j, 0] for i in range(m + 1) for j in range(m + 1)]
    deck.surfaces["SMA"] = [(element[i, j, foundation_layers - 1], 2) for i in range(m) for j in range(m)]
    return deck


def hertz_mesh(n, radius=10.0, thickness=0.5, block_width=None, block_height=None):
    """Quarter cylinder (axis along z, centre above the origin) on a block; both graded towards the origin by power 1.6."""
    grading, core = 1.6, 0.15 * radius
    block_width = radius if block_width is None else block_width
    block_height = 0.8 * radius if block_height is None else block_height
    rings = max(4, 2 * n // 3)
    angles = [0.5 * math.pi * (i / n) ** grading for i in range(n + 1)]
    radii = [core + (radius - core) * (1.0 - (1.0 - k / rings) ** grading) for k in range(rings + 1)]
    deck = Deck()
    node = {
        (a, k, s): deck.node(r * math.sin(angle), radius - r * math.cos(angle), s * thickness)
        for s in range(2)
        for k, r in enumerate(radii)
        for a, angle in enumerate(angles)
    }
    element = {}
    for k in range(rings):
        for a in range(n):
            # Outwards, then along the arc: the right hand then points along the axis, so that face S3 lies on the arc side.
            ring = [(a, k), (a, k + 1), (a + 1, k + 1), (a + 1, k)]
            element[a, k] = deck.brick("CYLINDER", [node[i, j, s] for s in range(2) for i, j in ring])
    both = range(2)
    symmetry = [node[0, k, s] for k in range(rings + 1) for s in both]
    deck.node_sets["NTOP"] = [node[n, k, s] for k in range(rings + 1) for s in both]
    # Corners 2 and 3 of a brick (and 6, 7) lie on its outer arc: face S4.
    deck.surfaces["SSL"] = [(element[a, rings - 1], 4) for a in range(max(2, int(0.75 * n)))]
    columns, rows = int(1.2 * n), max(4, int(0.8 * n))
    xs = [block_width * (i / columns) ** grading for i in range(columns + 1)]
    ys = [-block_height * ((rows - j) / rows) ** grading for j in range(rows + 1)]
    node, element = deck.grid("BLOCK", xs, ys, [0.0, thickness])
    deck.node_sets["NSYM"] = symmetry + [node[0, j, s] for j in range(rows + 1) for s in both]
    deck.node_sets["NBOT"] = [node[i, 0, s] for i in range(columns + 1) for s in both]
    deck.surfaces["SMA"] = [(element[i, rows - 1, 0], 5) for i in range(columns)]
    return deck


@dataclass
class Problem:
    """What differs between the two kinds."""

    mesh: object
    moduli: dict[str, float]
    stiffness: float
    displacement: float
    direction: int
    supports: list[str]


PROBLEMS = {
    "punch": Problem(
        punch_mesh, {"PUNCH": 210e3, "FOUNDATION": 70e3}, 50 * 70e3, -0.005, 3, ["NBOT, 1, 3", "NTOP, 1, 2"]
    ),
    "hertz": Problem(
        hertz_mesh,
        {"CYLINDER": 210e3, "BLOCK": 2100e3},
        50 * 210e3,
        -0.02,
        2,
        ["NALL, 3, 3", "NSYM, 1, 1", "NBOT, 2, 2"],
    ),
}


def law_lines(kind, stiffness, table, c0, p0):
    """`*SURFACE BEHAVIOR` and its data lines."""
    if kind == "hard":
        return ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"]
    lines = [f"*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE={kind.upper()}"]
    if kind == "linear":
        return [*lines, f"{stiffness!r}"]
    if kind == "exponential":
        return [*lines, f"{c0!r}, {p0!r}"]
    return lines + [f"{p!r}, {h!r}" for p, h in table]


def wrapped(numbers, per_line=12):
    """Data lines with at most `per_line` numbers."""
    return [", ".join(str(n) for n in numbers[i : i + per_line]) for i in range(0, len(numbers), per_line)]


def write(path, kind, size, options):
    """Writes the deck and returns its mesh."""
    problem = PROBLEMS[kind]
    dimensions = {k: v for k, v in options.dimensions.items() if v is not None}
    deck = problem.mesh(size, **dimensions)
    moduli = dict(zip(problem.moduli, options.young or problem.moduli.values(), strict=True))
    stiffness = problem.stiffness if options.stiffness is None else options.stiffness
    displacement = problem.displacement if options.displacement is None else options.displacement
    lines = ["*HEADING", f"{kind} {size}, {options.law}", "*NODE, NSET=NALL"]
    # 14 digits: CalculiX reads 20 characters of a number.
    lines += [f"{label}, {x:.14g}, {y:.14g}, {z:.14g}" for label, (x, y, z) in enumerate(deck.nodes, 1)]
    for part, bricks in deck.elements.items():
        lines.append(f"*ELEMENT, TYPE=C3D8, ELSET={part}")
        lines += [f"{label}, " + ", ".join(map(str, corners)) for label, corners in bricks]
    for name, members in deck.node_sets.items():
        lines += [f"*NSET, NSET={name}", *wrapped(sorted(set(members)))]
    for name, faces in deck.surfaces.items():
        lines += [f"*SURFACE, NAME={name}, TYPE=ELEMENT", *(f"{element}, S{face}" for element, face in faces)]
    for part, young in moduli.items():
        lines += [f"*MATERIAL, NAME=M{part}", "*ELASTIC", f"{young!r}, {options.poisson!r}"]
        lines += [f"*SOLID SECTION, ELSET={part}, MATERIAL=M{part}"]
    lines += ["*SURFACE INTERACTION, NAME=CONTACT"]
    lines += law_lines(options.law, stiffness, options.table, options.c0, options.p0)
    lines += ["*CONTACT PAIR, INTERACTION=CONTACT, TYPE=NODE TO SURFACE, SMALL SLIDING", "SSL, SMA"]
    lines += ["*BOUNDARY", *problem.supports]
    if options.increments:
        lines += [f"*STEP, INC={max(100, options.increments)}", "*STATIC, DIRECT", f"{1.0 / options.increments!r}, 1."]
    else:
        lines += ["*STEP, INC=100", "*STATIC", "1., 1."]
    lines += ["*BOUNDARY", f"NTOP, {problem.direction}, {problem.direction}, {displacement!r}"]
    lines += ["*NODE PRINT, NSET=NTOP, TOTALS=ONLY", "RF"]
    if options.fields:
        every = f", FREQUENCY={options.field_frequency}" if options.field_frequency > 1 else ""
        lines += [f"*CONTACT FILE{every}", "CDIS, CSTR", f"*NODE FILE{every}", "U"]
    lines += ["*END STEP"]
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    Path(path).write_text("\n".join(lines) + "\n", encoding="ascii")
    return deck


def table(text):
    """`p1:h1,p2:h2,...` as pairs."""
    try:
        return [(float(p), float(h)) for p, h in (pair.split(":") for pair in text.split(","))]
    except ValueError as error:
        raise argparse.ArgumentTypeError(f"{text!r} is not p1:h1,p2:h2,... (pressure:overclosure)") from error


class Help(argparse.ArgumentDefaultsHelpFormatter, argparse.RawDescriptionHelpFormatter):
    """Keeps the lines of the description, and tells the defaults."""

    def _get_help_string(self, action):
        # A default of None is told in words by the help itself.
        return action.help if action.default is None or action.default is True else super()._get_help_string(action)


def told(name, text="{:g}".format):
    """Defaults of both kinds, for the help: ` (default: punch ..., hertz ...)`."""
    values = ", ".join(f"{kind} {text(getattr(problem, name))}" for kind, problem in PROBLEMS.items())
    return f" (default: {values})"


def parser():
    """Command line."""
    result = argparse.ArgumentParser(description=__doc__, formatter_class=Help)
    result.add_argument("kind", choices=PROBLEMS, help="which deck")
    result.add_argument("size", type=int, help="bricks per punch side, or along the quarter arc")
    result.add_argument("deck", help="file to write")
    result.add_argument("--law", choices=LAWS, default="linear", help="pressure-overclosure law")
    stiffness = "of the linear law [pressure/length]" + told("stiffness")
    result.add_argument("--stiffness", type=float, help=stiffness)
    result.add_argument(
        "--table", type=table, default="0:0,2000:0.0005,8000:0.001", help="p1:h1,p2:h2,... of the tabular law"
    )
    result.add_argument(
        "--c0", type=float, default=1e-4, help="clearance at zero pressure of the exponential law [length]"
    )
    result.add_argument("--p0", type=float, default=100.0, help="pressure at zero clearance of the exponential law")
    moduli = "moduli of the upper and the lower body"
    moduli += told("moduli", lambda moduli: " ".join(f"{young:g}" for young in moduli.values()))
    result.add_argument("--young", type=float, nargs=2, metavar="E", help=moduli)
    result.add_argument("--poisson", type=float, default=0.3, help="Poisson's ratio of both bodies")
    displacement = "of NTOP, negative is down" + told("displacement")
    result.add_argument("--displacement", type=float, help=displacement)
    result.add_argument("--increments", type=int, default=0, help="fixed increments; 0: automatic, starting with one")
    result.add_argument("--field-frequency", type=int, default=1, help="fields every so many increments")
    result.add_argument("--no-fields", dest="fields", action="store_false", help="ask for the reaction total only")
    shape = result.add_argument_group("dimensions of the punch deck [length]")
    for name, default in (("width", 1.0), ("height", 0.5), ("foundation-width", 3.0), ("foundation-height", 1.5)):
        shape.add_argument(f"--{name}", type=float, help=f"(default: {default})")
    shape = result.add_argument_group("dimensions of the hertz deck [length]")
    defaults = {"radius": 10.0, "thickness": 0.5, "block-width": "the radius", "block-height": "0.8 of the radius"}
    for name, default in defaults.items():
        shape.add_argument(f"--{name}", type=float, help=f"(default: {default})")
    return result


def generate(arguments):
    """Writes a deck from command line arguments (a list of words); returns its mesh."""
    options = parser().parse_args([str(a) for a in arguments])
    shared = {"punch": ("width", "height", "foundation_width", "foundation_height")}
    shared["hertz"] = ("radius", "thickness", "block_width", "block_height")
    for kind, names in shared.items():
        if kind != options.kind and any(getattr(options, name) is not None for name in names):
            parser().error(f"a {options.kind} deck has no {', '.join(names)}")
    if options.size < 2 or options.increments < 0:
        parser().error("size must be at least 2 and increments not negative")
    options.dimensions = {name: getattr(options, name) for name in shared[options.kind]}
    try:
        return write(options.deck, options.kind, options.size, options)
    except OSError as error:
        parser().error(f"cannot write {options.deck}: {error.strerror}")


if __name__ == "__main__":
    import sys

    mesh = generate(sys.argv[1:])
    print(f"{len(mesh.nodes)} nodes, {mesh.element_count} elements, {len(mesh.surfaces['SSL'])} secondary faces")
