"""Decks whose contact remembers, solved by command line, daemon and FMU with nothing but the deck to drive them."""

import struct
import subprocess

import fmpy
from fmpy.fmi2 import FMU2Slave

import support
from verification import rings
from verification.columns import Block, stack
from verification.points import Point, amplitude, controls, deck, driver, node, step

INCREMENTS = 8
BLOCKS = {
    "TOP": Block((0.0, 0.0, 0.0), (1.0, 2.0, 1.0), (2, 2, 2), 700.0),
    "BOTTOM": Block((-0.5, -0.5, -1.0), (1.5, 2.5, 0.0), (2, 2, 1), 1000.0),
}
HARD = ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"]
DAMPING = ["*CONTACT DAMPING, DEFINITION=DAMPING COEFFICIENT", "3., 0.05, 0.25"]
CYCLE = [0.0, 0.4, 1.0, 0.3, -0.8, -0.2, 0.5, 1.2, 0.1]


def cycled(behavior, *cards, sideways=0.0):
    """A block above another whose top goes down, up and down again by an amplitude, 0.02 at its largest."""
    lines = [*amplitude("CYCLE", CYCLE, float(INCREMENTS)), "*BOUNDARY", "BOTTOM_LOW, 1, 3", "TOP_HIGH, 1, 3"]
    cards = [card.replace("MASTER=WALL, SLAVE=POINTS", "MASTER=BOTTOM_UP, SLAVE=TOP_DOWN") for card in cards]
    move = ["*BOUNDARY, AMPLITUDE=CYCLE", "TOP_HIGH, 3, 3, -0.02"]
    move += [f"TOP_HIGH, 1, 1, {sideways!r}"] if sideways else []
    lines += step(*cards, *move, increments=INCREMENTS, period=float(INCREMENTS))
    return stack(BLOCKS, behavior, lines).replace("NSET=POINTS", "NSET=TOP_HIGH")


def loop():
    """Two points of modified hard contact, in a loop through all of its states."""
    points = [Point(driver=100.0), Point(clearance=0.005, driver=150.0)]
    move = ["*BOUNDARY, AMPLITUDE=CYCLE", f"{driver(0)}, 3, 3, -0.05", f"{driver(1)}, 3, 3, -0.06"]
    card = controls("MAXCHP=2", "UERRMX=0.02", "PERRMX=5.")
    lines = step(card, *move, increments=INCREMENTS, period=float(INCREMENTS))
    return deck(points, HARD, lines, model=amplitude("CYCLE", CYCLE, float(INCREMENTS)))


def preloaded():
    """A point that closes in a first step under augmented Lagrange and is let go in a second one."""
    begin = step(controls("ABSOLUTE PENETRATION TOLERANCE=1e-6"), "*CLOAD", f"{node()}, 3, -12.", increments=2)
    end = step("*CLOAD", f"{node()}, 3, -3.", increments=INCREMENTS, period=float(INCREMENTS))
    return deck([Point(spring=1000.0)], ["*SURFACE BEHAVIOR, AUGMENTED LAGRANGE", "3000.,"], begin + end)


def shrunk():
    """Two rings, shrunk onto each other over the step."""
    ring = rings.Rings(10.0, 20.0, 40.0, 0.002, (1000.0, 0.3), (2000.0, 0.2))
    lines = ("*STATIC, DIRECT", f"1., {float(INCREMENTS)!r}", "*CONTACT INTERFERENCE, SHRINK", "SHAFT, HUB")
    behavior = ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", "4."]
    return rings.deck(ring, behavior, 8, step=lines)


def decks():
    """Deck texts by name."""
    limit = controls("ABSOLUTE PENETRATION TOLERANCE=1e-7")
    return {
        "modified_hard": loop(),
        "augmented": cycled(["*SURFACE BEHAVIOR, AUGMENTED LAGRANGE", "9000.,"], limit),
        "bonded": cycled(["*SURFACE BEHAVIOR, NO SEPARATION", "*FRICTION, ROUGH"], sideways=0.004),
        "damped": cycled([*HARD, *DAMPING]),
        "nonlinear": cycled(["*SURFACE BEHAVIOR, PENALTY=NONLINEAR", "4000., 0.001, 1., 0.03, 0.02, 0.3"]),
        "preloaded": preloaded(),
        "shrunk": shrunk(),
    }


def last_step(table):
    """Rows of the last step."""
    return [row for row in table if row["step"] == table[-1]["step"]]


def by_command_line(path, folder):
    """Times of the last step, the time at which it begins, and outputs by name at each increment."""
    result = support.run(path, folder)
    table = last_step(result.table("ports"))
    begin = sum(step["time_reached"] for step in result.summary()["steps"][-2:-1])
    names = [name for name in table[0] if name not in ("step", "increment", "time")]
    return [float(row["time"]) for row in table], begin, {n: [float(row[n]) for row in table] for n in names}


def by_daemon(client, path, times):
    """A session that is told nothing but the times."""
    with client.open(path) as session:
        replies = [session.step(t) for t in times]
        return {name: [reply.outputs[name] for reply in replies] for name in session.outputs}


def by_fmu(path, folder, times, begin):
    """The packed deck; its clock starts with the last step."""
    file = folder / f"{path.stem}.fmu"
    subprocess.run([support.binary(), "pack", path, "-o", file], check=True, capture_output=True)
    description, unzipped = fmpy.read_model_description(file), fmpy.extract(file)
    instance = FMU2Slave(
        guid=description.guid,
        unzipDirectory=unzipped,
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName=path.stem,
    )
    instance.instantiate()
    instance.setupExperiment(startTime=0.0)
    instance.enterInitializationMode()
    instance.exitInitializationMode()
    variables = [v for v in description.modelVariables if v.causality == "output"]
    outputs, now = {v.name: [] for v in variables}, 0.0
    for time in times:
        instance.doStep(currentCommunicationPoint=now, communicationStepSize=(time - begin) - now)
        now = time - begin
        for variable in variables:
            get = instance.getReal if variable.type == "Real" else instance.getInteger
            outputs[variable.name].append(float(get([variable.valueReference])[0]))
    instance.terminate()
    instance.freeInstance()
    return outputs


def bits(values):
    """The 64 bits of each number."""
    return [struct.pack("<d", value) for value in values]
