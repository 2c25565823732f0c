#!/usr/bin/env python3
"""How time and memory grow with the size of a deck: the punch, from small to large.

    python benches/growth.py                          punch 9, 16, 26, 34
    python benches/growth.py --sizes 9 16 26 34 42    42 too: needs the memory that the table promises

CPU seconds and peak memory are those of the whole process, as the kernel accounts them; seconds by phase are wall time from
JOB.json, of the repetition with the least CPU time. Exponents are least-squares slopes in logarithms over the unknowns (free
directions of nodes). Writes growth.json, growth.md and, with matplotlib, growth.png.
"""

import argparse
import json
import math
import sys
import tempfile
from pathlib import Path

import bench

import generate_deck
import support

SIZES = (9, 16, 26, 34)
# Phases shorter than this say more about the clock than about growth [s].
SECONDS_MIN = 1e-3


def measured(folder, size, repetitions):
    """One row: the deck's size, and what the cheapest run of it cost."""
    job = f"punch{size}"
    deck = folder / f"{job}.inp"
    mesh = generate_deck.generate(["punch", size, deck])
    usage, runs = bench.Usage(), []
    for _ in range(repetitions):
        command = [support.binary(), "run", deck, "--out", folder, "--quiet", "--dialect", "calculix"]
        bench.measure(usage, command, folder, folder / f"{job}.log")
        runs.append(support.Result(folder, job).summary())
    best = min(range(repetitions), key=usage.cpu.__getitem__)
    held = len(set(mesh.node_sets["NTOP"]) | set(mesh.node_sets["NBOT"]))
    return {
        "size": size,
        "unknowns": 3 * (len(mesh.nodes) - held),
        "contact_points": runs[best]["size"]["contact_points"],
        "cpu_seconds": usage.cpu[best],
        "peak_megabytes": usage.peak(),
        "wall_seconds": runs[best]["wall_seconds"],
    }


def exponent(rows, value):
    """Slope of log(value) over log(unknowns); none with fewer than two values that mean something."""
    points = [(math.log(row["unknowns"]), math.log(value(row))) for row in rows if value(row) >= SECONDS_MIN]
    if len(points) < 2:
        return None
    x, y = (sum(axis) / len(points) for axis in zip(*points, strict=True))
    return sum((a - x) * (b - y) for a, b in points) / sum((a - x) ** 2 for a, _ in points)


def exponents(rows):
    """Of the total, of the memory and of every phase."""
    found = {"cpu": exponent(rows, lambda row: row["cpu_seconds"])}
    found["memory"] = exponent(rows, lambda row: row["peak_megabytes"])
    for phase in phases(rows):
        found[phase] = exponent(rows, lambda row, phase=phase: row["wall_seconds"].get(phase, 0.0))
    return found


def phases(rows):
    """Phases that some run had, in the order in which they come; unknown ones behind."""
    seen = {phase for row in rows for phase in row["wall_seconds"]}
    return [phase for phase in bench.PHASES if phase in seen] + sorted(seen - set(bench.PHASES))


def markdown(rows, found):
    """The table."""
    columns = ["punch", "unknowns", "contact points", "CPU s", "peak MB", *phases(rows)]
    lines = [f"Measured on {bench.processor()}.", "", "| " + " | ".join(columns) + " |", "|---" * len(columns) + "|"]
    for row in rows:
        cells = [str(row["size"]), str(row["unknowns"]), str(row["contact_points"])]
        cells += [f"{row['cpu_seconds']:.2f}", f"{row['peak_megabytes']:.0f}"]
        cells += [f"{row['wall_seconds'].get(phase, 0.0):.3f}" for phase in phases(rows)]
        lines.append("| " + " | ".join(cells) + " |")
    for name, values in (("exponent", found), ("of the two largest", exponents(rows[-2:]))):
        cells = ["" if values[key] is None else f"{values[key]:.2f}" for key in found]
        lines.append(f"| {name} | | | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def draw(rows, found, path):
    """Time by phase and memory over the unknowns, in logarithms."""
    try:
        import matplotlib
    except ImportError:
        print("matplotlib is not installed: no picture", file=sys.stderr)
        return
    matplotlib.use("Agg")
    from matplotlib import pyplot

    def label(name, key):
        return name if found[key] is None else f"{name}, exponent {found[key]:.2f}"

    unknowns = [row["unknowns"] for row in rows]
    figure, (time, memory) = pyplot.subplots(1, 2, figsize=(11, 4.5), layout="constrained")
    time.loglog(unknowns, [row["cpu_seconds"] for row in rows], "k-o", label=label("whole process (CPU)", "cpu"))
    for phase in phases(rows):
        points = [(row["unknowns"], row["wall_seconds"].get(phase, 0.0)) for row in rows]
        points = [point for point in points if point[1] >= SECONDS_MIN]
        if len(points) > 1:
            time.loglog(*zip(*points, strict=True), "--.", label=label(phase, phase))
    memory.loglog(unknowns, [row["peak_megabytes"] for row in rows], "k-o", label=label("peak", "memory"))
    for axes, title in ((time, "time [s]"), (memory, "memory [MB]")):
        axes.set(xlabel="unknowns", ylabel=title)
        axes.grid(True, which="both", alpha=0.3)
        axes.legend(fontsize="small")
    figure.savefig(path, dpi=150)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", type=int, nargs="+", default=list(SIZES))
    parser.add_argument("-n", "--repetitions", type=int, default=1)
    parser.add_argument("--out", type=Path, default=bench.ROOT / "out" / "bench")
    options = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for size in sorted(set(options.sizes)):
            rows.append(measured(Path(folder), size, options.repetitions))
            row = rows[-1]
            print(f"punch {size}: {row['cpu_seconds']:.2f} CPU s, {row['peak_megabytes']:.0f} MB", file=sys.stderr)
    found = exponents(rows)
    options.out.mkdir(parents=True, exist_ok=True)
    report = markdown(rows, found)
    (options.out / "growth.md").write_text(report, encoding="utf-8")
    content = {
        "machine": bench.processor(),
        "rows": rows,
        "exponents": found,
        "exponents_largest": exponents(rows[-2:]),
    }
    (options.out / "growth.json").write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
    draw(rows, found, options.out / "growth.png")
    print(report)


if __name__ == "__main__":
    main()
