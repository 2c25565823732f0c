#!/usr/bin/env python3
"""CPU seconds against CalculiX on the same decks in the same run, and the price of further increments.

    make bench                      everything, three repetitions
    python benches/bench.py -n 5    five repetitions

CPU seconds are user plus system time of the whole process, as the kernel accounts them. The two programs take turns, so that a
disturbance hits both; the table gives medians and the ratio of medians. CalculiX (`ccx`) runs with OMP_NUM_THREADS=1; without
it the table has our figures alone.
"""

import argparse
import json
import os
import platform
import shutil
import statistics
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "examples"), str(ROOT / "tests")]

import generate_deck  # noqa: E402
import support  # noqa: E402

# Deck, how many times cheaper than CalculiX it has to be, and how many times its memory it may take.
DECKS = {("punch", 16): (6.0, None), ("hertz", 110): (8.0, None)}
LARGE = {("punch", 26): (6.0, 2.0)}
FURTHER_INCREMENTS = 100
FURTHER_SHARE_MAX = 0.10
PHASES = ("read", "search", "assemble", "order", "symbolic", "numeric", "condense", "solve", "write")


@dataclass
class Usage:
    """What the kernel accounts to one process."""

    cpu: list[float] = field(default_factory=list)
    memory: list[float] = field(default_factory=list)

    def median(self):
        """Median CPU seconds."""
        return statistics.median(self.cpu)

    def spread(self):
        """Smallest and largest, as text."""
        return f"{min(self.cpu):.2f} to {max(self.cpu):.2f}"

    def peak(self):
        """Largest resident memory in MB."""
        return max(self.memory)


def measure(usage, command, folder, log):
    """Runs a command in a folder and adds its CPU seconds and peak memory. Stops the benchmark when it fails."""
    environment = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
    with open(log, "wb") as output:
        process = subprocess.Popen(command, cwd=folder, env=environment, stdout=output, stderr=subprocess.STDOUT)
        _, status, rusage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, command))} ended with {process.returncode}; see {log}")
    usage.cpu.append(rusage.ru_utime + rusage.ru_stime)
    # Linux counts kilobytes, macOS bytes.
    usage.memory.append(rusage.ru_maxrss / (1024.0 if sys.platform != "darwin" else 1024.0**2))


def last_total(text):
    """Reaction total in the last line of numbers of a CalculiX .dat file: its largest component."""
    rows = [line.split() for line in text.splitlines() if line.strip() and line.split()[0].lstrip("-")[0].isdigit()]
    return max((float(v) for v in rows[-1][-3:]), key=abs)


def our_total(folder, job):
    """The same from our history."""
    row = support.Result(Path(folder), job).last("history")[0]
    return max((float(row[f"RF{d}[NTOP]"]) for d in (1, 2, 3)), key=abs)


def phases(folder, job):
    """Wall seconds by phase of the last of our runs."""
    return support.Result(Path(folder), job).summary()["wall_seconds"]


def against_calculix(folder, decks, repetitions, ccx):
    """Rows of the first table."""
    rows = []
    for (kind, size), (wanted, memory_wanted) in decks.items():
        job = f"{kind}{size}"
        deck = folder / f"{job}.inp"
        generate_deck.generate([kind, size, deck])
        # CalculiX loses contact of the cylinder under SMALL SLIDING (its force is a third too small), and solves less for it.
        # Its finite sliding meets ours; we read the deck alike either way.
        deck.write_text(deck.read_text().replace(", SMALL SLIDING", ""))
        ours, theirs, split = {"calculix": Usage(), "abaqus": Usage()}, Usage(), []
        for _ in range(repetitions):
            for dialect, usage in ours.items():
                out = folder / dialect
                command = [support.binary(), "run", deck, "--out", out, "--quiet", "--dialect", dialect]
                measure(usage, command, folder, folder / f"{job}-{dialect}.log")
            split.append(phases(folder / "calculix", job))
            if ccx:
                measure(theirs, [ccx, "-i", job], folder, folder / f"{job}-ccx.log")
        row = {"deck": job, "wanted": wanted, "memory_wanted": memory_wanted}
        row |= {"force": our_total(folder / "calculix", job)}
        # Wall time: the run that others on the machine disturbed least.
        row |= {"phases": min(split, key=lambda seconds: sum(seconds.values()))}
        row |= {f"{dialect}_cpu": usage.median() for dialect, usage in ours.items()}
        row |= {"memory": ours["calculix"].peak(), "spread": ours["calculix"].spread()}
        if ccx:
            row |= {"ccx_cpu": theirs.median(), "ccx_spread": theirs.spread(), "ccx_memory": theirs.peak()}
            row |= {"ratio": theirs.median() / ours["calculix"].median()}
            row |= {"memory_ratio": ours["calculix"].peak() / theirs.peak()}
            row |= {"ccx_force": last_total((folder / f"{job}.dat").read_text())}
        rows.append(row)
    return rows


def further_increments(folder, repetitions):
    """CPU seconds of punch 16 in one increment, and of a hundred more."""
    usages = {}
    for increments in (1, 1 + FURTHER_INCREMENTS):
        deck = folder / f"further{increments}.inp"
        generate_deck.generate(["punch", 16, deck, "--increments", increments, "--no-fields"])
        usages[increments] = (deck, Usage())
    for _ in range(repetitions):
        for deck, usage in usages.values():
            command = [support.binary(), "run", deck, "--out", folder / "further", "--quiet"]
            measure(usage, command, folder, folder / f"{deck.stem}.log")
    first, more = (usage.median() for _, usage in usages.values())
    return {"setup": first, "further": more - first, "share": (more - first) / first}


def markdown(rows, further, machine):
    """The report."""
    lines = [f"Measured on {machine}.", ""]
    lines += [
        "| deck | ours, CPU s (range) | ccx, CPU s (range) | ccx / ours | wanted | ours as Abaqus, CPU s | peak MB ours / ccx | total force ours / ccx |"
    ]
    lines += ["|---|---|---|---|---|---|---|---|"]
    for r in rows:
        ours = f"{r['calculix_cpu']:.2f} ({r['spread']})"
        if "ratio" in r:
            theirs = [f"{r['ccx_cpu']:.2f} ({r['ccx_spread']})", f"{r['ratio']:.1f}"]
            pairs = [f"{r['memory']:.0f} / {r['ccx_memory']:.0f}", f"{r['force']:.3f} / {r['ccx_force']:.3f}"]
        else:
            theirs, pairs = ["-", "-"], [f"{r['memory']:.0f} / -", f"{r['force']:.3f} / -"]
        lines.append(
            "| " + " | ".join([r["deck"], ours, *theirs, f"{r['wanted']:.0f}", f"{r['abaqus_cpu']:.2f}", *pairs]) + " |"
        )
    lines += ["", "Wall seconds of ours by phase, read as CalculiX does, in the shortest run:", ""]
    lines += ["| deck | " + " | ".join(PHASES) + " |", "|---" * (1 + len(PHASES)) + "|"]
    for r in rows:
        lines.append("| " + " | ".join([r["deck"], *(f"{r['phases'].get(phase, 0.0):.3f}" for phase in PHASES)]) + " |")
    lines += ["", f"punch 16, one increment: {further['setup']:.3f} CPU s. {FURTHER_INCREMENTS} further increments: "]
    lines[-1] += (
        f"{further['further']:.3f} CPU s, {100 * further['share']:.1f} % (wanted: below {100 * FURTHER_SHARE_MAX:.0f} %)."
    )
    return "\n".join(lines) + "\n"


def processor():
    """Name of the processor and number of cores."""
    name = platform.processor() or platform.machine()
    info = Path("/proc/cpuinfo")
    if info.is_file():
        named = [
            line.split(":", 1)[1].strip() for line in info.read_text().splitlines() if line.startswith("model name")
        ]
        name = named[0] if named else name
    return f"{name}, {os.cpu_count()} cores, {platform.system()}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-n", "--repetitions", type=int, default=3)
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "bench")
    parser.add_argument("--check", action="store_true", help="fail when a figure is worse than wanted")
    parser.add_argument("--large", action="store_true", help="punch 26 as well, once: minutes of CalculiX")
    options = parser.parse_args()
    ccx = shutil.which("ccx")
    if ccx is None:
        print("ccx is not installed: our figures only (Debian and Ubuntu: apt install calculix-ccx)", file=sys.stderr)
    with tempfile.TemporaryDirectory() as folder:
        rows = against_calculix(Path(folder), DECKS, options.repetitions, ccx)
        if options.large:
            rows += against_calculix(Path(folder), LARGE, 1, ccx)
        further = further_increments(Path(folder), options.repetitions)
    options.out.mkdir(parents=True, exist_ok=True)
    report = markdown(rows, further, processor())
    (options.out / "table.md").write_text(report, encoding="utf-8")
    (options.out / "table.json").write_text(json.dumps({"decks": rows, "further": further}, indent=1), encoding="utf-8")
    print(report)
    slow = [r["deck"] for r in rows if r.get("ratio", r["wanted"]) < r["wanted"]]
    slow += [
        f"memory of {r['deck']}" for r in rows if r["memory_wanted"] and r.get("memory_ratio", 0) > r["memory_wanted"]
    ]
    if further["share"] > FURTHER_SHARE_MAX:
        slow.append("further increments")
    if options.check and slow:
        raise SystemExit("worse than wanted: " + ", ".join(slow))


if __name__ == "__main__":
    main()
