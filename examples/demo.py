#!/usr/bin/env python3
"""The main job: two contact decks, each solved three ways, every output of every increment compared bit for bit.

    make demo            or, in the environment that make creates:
    python examples/demo.py --out out/demo

The three ways are `overclosure run`, a session of the daemon driven through the Python client, and the packed FMU driven by
FMPy. In each, a master applies the displacement of the deck in 20 increments. Ends with a table and pictures; the exit code is 1
when any bit differs.
"""

import argparse
import csv
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import time
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import generate_deck

ROOT = Path(__file__).resolve().parent.parent
INCREMENTS = 20
DECKS = {"punch": 16, "hertz": 54}
OUTPUT = ["--field-frequency", 5]
WAYS = ("overclosure run", "daemon session", "FMU in FMPy")
PAIR = "SSL_SMA"


@dataclass
class Answer:
    """What one way of solving gave: outputs by name, one value per increment, and how long it took."""

    times: list[float]
    outputs: dict[str, list[float]]
    setup: float
    increments: float


@dataclass
class Job:
    """One deck and its three answers."""

    kind: str
    size: int
    deck: Path
    mesh: generate_deck.Deck
    answers: dict[str, Answer] = field(default_factory=dict)
    differences: list[str] = field(default_factory=list)

    @property
    def name(self):
        """Name of the deck without extension."""
        return self.deck.stem

    @property
    def drive(self):
        """Name of the input: the prescribed displacement of NTOP."""
        return f"boundary.NTOP.{generate_deck.PROBLEMS[self.kind].direction}"

    def displacement(self, at):
        """Displacement of NTOP at a time: the deck's ramp, here applied by the master."""
        return generate_deck.PROBLEMS[self.kind].displacement * at

    def final(self, output):
        """Value of an output at the end, by the command line."""
        return self.answers[WAYS[0]].outputs[output][-1]


def binary():
    """The executable: OVERCLOSURE_BINARY, or the release build of this checkout."""
    path = Path(os.environ.get("OVERCLOSURE_BINARY", ROOT / "target" / "release" / "overclosure"))
    if not path.is_file():
        raise SystemExit(f"{path} is missing; build it with `cargo build --release --workspace`")
    return path


def rows(path):
    """Rows of a CSV file as dictionaries of text."""
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def by_command_line(job, folder):
    """`overclosure run`: JOB_ports.csv has one column per output."""
    subprocess.run([binary(), "run", job.deck, "--out", folder, "--quiet"], check=True)
    table = rows(folder / f"{job.name}_ports.csv")
    names = [name for name in table[0] if name not in ("step", "increment", "time")]
    seconds = json.loads((folder / f"{job.name}.json").read_text())["wall_seconds"]
    solving = seconds.pop("solve", 0.0)
    outputs = {name: [float(row[name]) for row in table] for name in names}
    return Answer([float(row["time"]) for row in table], outputs, sum(seconds.values()), solving)


def by_daemon(job, client, times):
    """A session of the daemon: one request per increment, input in, all outputs in the reply."""
    started = time.perf_counter()
    with client.open(job.deck) as session:
        opened = time.perf_counter()
        replies = [session.step(t, inputs={job.drive: job.displacement(t)}) for t in times]
        ended = time.perf_counter()
        outputs = {name: [reply.outputs[name] for reply in replies] for name in session.outputs}
        return Answer([reply.time for reply in replies], outputs, opened - started, ended - opened)


def by_fmu(job, folder, times):
    """The packed FMU: per increment, set the input, `fmi2DoStep`, read all outputs."""
    import fmpy
    from fmpy.fmi2 import FMU2Slave

    fmu = folder / f"{job.name}.fmu"
    subprocess.run([binary(), "pack", job.deck, "-o", fmu], check=True, stdout=subprocess.DEVNULL)
    description = fmpy.read_model_description(fmu)
    variables = [v for v in description.modelVariables if v.causality == "output"]
    (drive,) = [v.valueReference for v in description.modelVariables if v.name == job.drive]
    unzipped = fmpy.extract(fmu)
    try:
        started = time.perf_counter()
        instance = FMU2Slave(
            guid=description.guid,
            unzipDirectory=unzipped,
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName=job.name,
        )
        instance.instantiate()
        instance.setupExperiment(startTime=0.0)
        instance.enterInitializationMode()
        instance.exitInitializationMode()
        ready = time.perf_counter()
        outputs = {v.name: [] for v in variables}
        now = 0.0
        for target in times:
            step = target - now
            if now + step != target:
                raise SystemExit(f"{target} cannot be reached exactly from {now}")
            instance.setReal([drive], [job.displacement(target)])
            instance.doStep(currentCommunicationPoint=now, communicationStepSize=step)
            now = target
            for variable in variables:
                get = instance.getReal if variable.type == "Real" else instance.getInteger
                outputs[variable.name].append(float(get([variable.valueReference])[0]))
        ended = time.perf_counter()
        instance.terminate()
        instance.freeInstance()
    finally:
        shutil.rmtree(unzipped, ignore_errors=True)
    return Answer(list(times), outputs, ready - started, ended - ready)


@contextmanager
def running_daemon(folder):
    """A daemon on a free port of the loopback; yields its endpoint and stops it by SIGTERM."""
    with open(folder / "daemon.log", "wb") as log:
        process = subprocess.Popen(
            [binary(), "serve", "--listen", "tcp/127.0.0.1:0"], stdout=subprocess.PIPE, stderr=log, text=True
        )
        try:
            # The first line says what is bound; end of file says that it did not start.
            found = re.search(r"listens on (tcp/\S+?)(,|$)", process.stdout.readline().strip())
            if found is None:
                raise SystemExit(f"the daemon did not start; see {folder / 'daemon.log'}")
            yield found.group(1)
        finally:
            process.terminate()
            try:
                process.wait(timeout=30)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
                raise


def bits(value):
    """The 64 bits of a double: tells -0 from 0, and compares NaN."""
    return struct.pack("<d", value)


def compare(job):
    """Every output at every increment; fills `job.differences`."""
    first = job.answers[WAYS[0]]
    for way in WAYS[1:]:
        other = job.answers[way]
        if set(other.outputs) != set(first.outputs):
            unmatched = sorted(set(other.outputs) ^ set(first.outputs))
            job.differences.append(f"{way}: outputs on one side only: {', '.join(unmatched)}")
        if [bits(t) for t in other.times] != [bits(t) for t in first.times]:
            job.differences.append(f"{way}: times differ")
        for name in sorted(set(other.outputs) & set(first.outputs)):
            pairs = zip(first.outputs[name], other.outputs[name], strict=True)
            wrong = [i for i, (a, b) in enumerate(pairs, 1) if bits(a) != bits(b)]
            if wrong:
                job.differences.append(f"{way}: {name} differs in {len(wrong)} increments, first in {wrong[0]}")


def solve(out, jobs, endpoint):
    """All jobs, all ways."""
    import overclosure

    for job in jobs:
        job.answers[WAYS[0]] = by_command_line(job, out)
    times = {job.name: job.answers[WAYS[0]].times for job in jobs}
    with overclosure.connect(endpoint) as client:
        for job in jobs:
            job.answers[WAYS[1]] = by_daemon(job, client, times[job.name])
    for job in jobs:
        job.answers[WAYS[2]] = by_fmu(job, out, times[job.name])
        compare(job)


def table(jobs):
    """The table at the end, as lines."""
    lines = [
        f"{'deck':10} {'solved by':17} {'force':>12} {'contact area':>13} {'max pressure':>13} {'set-up s':>9} {'20 incr. s':>11}  equal bits"
    ]
    for job in jobs:
        direction = generate_deck.PROBLEMS[job.kind].direction
        for way in WAYS:
            answer = job.answers[way]
            same = "-" if way == WAYS[0] else "no" if any(d.startswith(way) for d in job.differences) else "yes"
            values = [
                answer.outputs[n][-1]
                for n in (f"node.NTOP.RF{direction}", f"contact.{PAIR}.CAREA", f"contact.{PAIR}.CPRESS_max")
            ]
            lines.append(
                f"{job.name:10} {way:17} {values[0]:12.4f} {values[1]:13.6f} {values[2]:13.4f} {answer.setup:9.3f} {answer.increments:11.4f}  {same}"
            )
    return lines


def draw(job, out):
    """The pictures of a job; returns their paths."""
    import demo_plots
    import numpy as np

    contact = [row for row in rows(out / f"{job.name}_contact.csv") if int(row["increment"]) == INCREMENTS]
    position = {int(row["node"]): place for place, row in enumerate(contact)}
    corners = {label: nodes for part in job.mesh.elements.values() for label, nodes in part}
    brick_faces = {1: (0, 1, 2, 3), 4: (1, 5, 6, 2)}
    quads = [[position[corners[e][i]] for i in brick_faces[face]] for e, face in job.mesh.surfaces["SSL"]]
    surface = demo_plots.Surface(
        np.array([job.mesh.nodes[int(row["node"]) - 1] for row in contact]),
        np.array(quads),
        np.array([float(row["CPRESS"]) for row in contact]),
    )
    pressure, curve = out / f"{job.name}_cpress.png", out / f"{job.name}_force.png"
    force = job.final(f"contact.{PAIR}.CFNM")
    if job.kind == "punch":
        demo_plots.punch_pressure(surface, pressure, force, job.final(f"contact.{PAIR}.CAREA"))
    else:
        demo_plots.hertz_pressure(surface, pressure, hertz_theory(force))
    problem = generate_deck.PROBLEMS[job.kind]
    output = f"node.NTOP.RF{problem.direction}"
    curves = {}
    for way, answer in job.answers.items():
        moved = [-problem.displacement * t for t in answer.times]
        curves[way] = (moved, [-f for f in answer.outputs[output]])
    demo_plots.force_displacement(curves, curve, f"{job.kind} {job.size}: force over displacement, solved three ways")
    return [pressure, curve]


def hertz_theory(force, radius=10.0, thickness=0.5, poisson=0.3):
    """Half width and peak pressure of Hertz line contact; `force` is that of the modelled half of the cylinder."""
    upper, lower = generate_deck.PROBLEMS["hertz"].moduli.values()
    modulus = 1.0 / ((1.0 - poisson**2) * (1.0 / upper + 1.0 / lower))
    per_length = 2.0 * force / thickness
    half_width = (4.0 * per_length * radius / (3.141592653589793 * modulus)) ** 0.5
    return half_width, 2.0 * per_length / (3.141592653589793 * half_width)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "demo", help="folder to write into [%(default)s]")
    parser.add_argument("--no-pictures", dest="pictures", action="store_false", help="table only")
    options = parser.parse_args()
    out = options.out
    out.mkdir(parents=True, exist_ok=True)
    jobs = []
    for kind, size in DECKS.items():
        deck = out / f"{kind}{size}.inp"
        mesh = generate_deck.generate([kind, size, deck, "--increments", INCREMENTS, *OUTPUT])
        jobs.append(Job(kind, size, deck, mesh))
    with running_daemon(out) as endpoint:
        solve(out, jobs, endpoint)
    report = table(jobs)
    count = len(jobs[0].answers[WAYS[0]].outputs)
    report.append(f"{count} outputs compared in each of {INCREMENTS} increments, bit for bit.")
    report += [f"{job.name}: {difference}" for job in jobs for difference in job.differences]
    if options.pictures:
        report += [f"picture: {path}" for job in jobs for path in draw(job, out)]
    (out / "table.txt").write_text("\n".join(report) + "\n", encoding="utf-8")
    print("\n".join(report))
    return 1 if any(job.differences for job in jobs) else 0


if __name__ == "__main__":
    sys.exit(main())
