"""What is verified: one requirement per case, with its reference and its tolerance.

The table in tests/README.md is made from this list: `python tests/verification/catalogue.py` rewrites it, and a test holds the
two together.
"""

import json
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
README = HERE.parent / "README.md"
START, END = "<!-- verification table: generated -->", "<!-- end of the verification table -->"


@dataclass(frozen=True)
class Case:
    """One verification case."""

    name: str
    requirement: str
    reference: str
    tolerance: str


CASES = [
    Case(
        "A01",
        "The solver shall give the exponential law its defining points: zero pressure and slope at clearance c0, p0 at touch.",
        "closed form",
        "1e-13",
    ),
    Case(
        "A02",
        "The solver shall give pressure, slope and energy of the exponential law.",
        "closed form to 40 digits",
        "1e-12",
    ),
    Case(
        "A04",
        "The solver shall continue the exponential law by its tangent beyond 6 c0, without overflow at a million c0.",
        "closed form",
        "1e-12",
    ),
    Case(
        "A05",
        "The solver shall limit the slope of the explicit exponential law to stiffness_max.",
        "Lambert W",
        "1e-12",
    ),
    Case("A08", "The solver shall evaluate the linear law.", "closed form", "1e-14"),
    Case("A09", "The solver shall interpolate the tabular law and continue its last slope.", "trapezoids", "1e-12"),
    Case("A10", "The solver shall let a table begin at a clearance.", "trapezoids", "1e-12"),
    Case(
        "A12", "The solver shall let the explicit linear law pull when separation is prevented.", "closed form", "1e-14"
    ),
    Case(
        "B01",
        "The solver shall sink a loaded block that contact alone holds to the overclosure of its load, on each law.",
        "closed form",
        "1e-10",
    ),
    Case("B02", "The solver shall balance an elastic column against each law.", "roots to 40 digits", "1e-10"),
    Case(
        "B01-rigid",
        "The solver shall sink and tilt a rigid body on contact under forces and moments on its reference node.",
        "closed form; moments of tributary areas",
        "1e-10, 1e-9",
    ),
    Case(
        "B02-calculix",
        "The solver shall read EXPONENTIAL as p0 100^(h/c0) in the calculix dialect.",
        "bisection in the test",
        "1e-10",
    ),
    Case(
        "B04", "The solver shall transmit a uniform pressure through matching meshes uniformly.", "closed form", "1e-10"
    ),
    Case(
        "B04-dead",
        "The solver shall transmit a dead pressure that contact alone balances, and name the body that nothing holds against a dead tension.",
        "closed form",
        "1e-10",
    ),
    Case(
        "B04-nonmatching",
        "The solver shall keep the force resultant where meshes do not match.",
        "equilibrium: reaction above, contact force, reaction below",
        "1e-10",
    ),
    Case(
        "A03",
        "The solver shall evaluate the exponential law at its take-off without cancellation, energy included.",
        "series to 60 digits at the doubles themselves",
        "1e-12",
    ),
    Case(
        "A06",
        "The solver shall bend the explicit exponential law at its ceiling also where that is reached while surfaces are apart.",
        "bisection to 40 digits",
        "1e-11",
    ),
    Case(
        "A07",
        "The solver shall invert the exponential law, from a millionth of p0 to beyond its straight continuation.",
        "bisection to 50 digits",
        "1e-12; 1e-14 c0 near the onset",
    ),
    Case(
        "A07-deck",
        "The solver shall invert the exponential law for a dead load from 1e-12 to 1e9 times p0.",
        "bisection to 40 digits",
        "1e-10 of u = 1 + h/c0",
    ),
    Case(
        "A11",
        "The solver shall continue a table into tension with its first slope when separation is prevented.",
        "closed form",
        "1e-12",
    ),
    Case(
        "A13",
        "The solver shall evaluate the straight and the nonlinear penalty, and the penalty with a multiplier.",
        "closed form in fractions",
        "1e-11",
    ),
    Case(
        "A13-deck",
        "The solver shall enforce hard contact by linear and nonlinear penalties.",
        "closed form, bisection with a spring in series",
        "1e-11",
    ),
    Case(
        "A14",
        "The solver shall give the damping coefficient over the clearance, and its slope.",
        "closed form",
        "1e-12",
    ),
    Case(
        "automatic",
        "The solver shall take automatic penalties from the depth and the confined modulus of the elements on both sides.",
        "closed form",
        "1e-10",
    ),
    Case(
        "A14-deck",
        "The solver shall damp contact by the coefficient at the clearance of the end of an increment.",
        "closed form at 8 clearances of three curves",
        "1e-11",
    ),
    Case(
        "A15",
        "The solver shall show the viscous pressure of an open point in a static step, status VD.",
        "closed form; a quadratic equation per increment with a spring",
        "1e-12",
    ),
    Case(
        "stabilize",
        "The solver shall stabilize contact within a step by a coefficient that falls to its part at the end.",
        "closed form",
        "1e-11",
    ),
    Case("B03", "The solver shall balance two columns in series with a gap through each law.", "bisection", "1e-10"),
    Case(
        "B05",
        "The solver shall transmit a uniform pressure, tension and shear through matching meshes under each law and enforcement.",
        "closed form",
        "1e-9",
    ),
    Case(
        "B06",
        "The solver shall close GAPUNI, GAPCYL and GAPSPHER elements at their distances, hard.",
        "closed form",
        "1e-12",
    ),
    Case(
        "B07",
        "The solver shall follow force laws in GAP elements without an area, pressure laws with one.",
        "bisection",
        "1e-10",
    ),
    Case(
        "B08",
        "The solver shall read a law as pressure, force or force per length by the kind of secondary surface.",
        "closed form: bricks, nodes with and without an area, gaps, trusses",
        "1e-12",
    ),
    Case(
        "B09",
        "The solver shall augment with the penetrations and pressures of augmented Lagrange, solve by solve.",
        "geometric sequence of three springs",
        "1e-12",
    ),
    Case(
        "B10", "The solver shall contract the penetration by 1 / (1 + kp / K) per augmentation.", "closed form", "1e-12"
    ),
    Case("B11", "The solver shall need one augmentation for a dead load on a free body.", "closed form", "1e-15"),
    Case(
        "B12",
        "The solver shall fit rings and columns with the pressure delta / (C + 1/k).",
        "Lame, two meshes; exact identity of compliances on one mesh; columns in closed form",
        "2e-4 at 48 elements through each ring; 1e-9; 1e-10",
    ),
    Case(
        "B13",
        "The solver shall resolve interferences over a step: shrunk, uniform, with an amplitude.",
        "closed form at every increment",
        "1e-11",
    ),
    Case(
        "B14",
        "The solver shall hold a point that has closed when separation is prevented.",
        "closed form: a node and a block that contact alone holds",
        "1e-12",
    ),
    Case("B15", "The solver shall balance the explicit linear law in compression and tension.", "closed form", "1e-12"),
    Case("B16", "The solver shall leave a point free until it first closes.", "closed form along a path", "1e-12"),
    Case(
        "removal",
        "The solver shall forget the latch of a pair that is removed.",
        "closed form",
        "1e-12",
    ),
    Case(
        "B17",
        "The solver shall follow the loop of modified hard contact.",
        "the state table, four loops, in one step and a step per value, a node and a column",
        "1e-12",
    ),
    Case(
        "B18",
        "The solver shall open a point again that closes and pulls in one increment, whatever PERRMX allows.",
        "closed form of two coupled points",
        "1e-11",
    ),
    Case(
        "B19",
        "The solver shall close a point again that opens and overlaps in one increment, whatever UERRMX allows, and carry tension up to PERRMX.",
        "closed form of two points between floor and ceiling",
        "1e-12",
    ),
    Case("B20", "The solver shall tolerate violations up to MAXCHP in number, or none.", "closed form", "1e-12"),
    Case(
        "B24",
        "The solver shall bond rough points that may not separate: no slip, no opening, tractions as statics demands.",
        "closed form",
        "1e-12",
    ),
    Case(
        "B27",
        "The solver shall augment where a penetration exceeds its tolerance, absolute or relative to the faces, step by step.",
        "closed form",
        "exact",
    ),
    Case(
        "B28",
        "The solver shall take clearances that override the geometry: uniform, by node, by set, negative ones.",
        "closed form",
        "1e-11",
    ),
    Case(
        "friction-steps",
        "The solver shall let rough friction begin with or after closing, begin and end with steps, and let removed pairs go over a step.",
        "closed form",
        "1e-11",
    ),
    Case(
        "V01-V20",
        "The solver shall refuse what the manual forbids with line, keyword and reason, all at once, and warn where it warns.",
        "the manual's rules",
        "exit code 2, words and line numbers",
    ),
    Case(
        "oracle-steps",
        "The solver shall find contact that changes from step to step: enforcements, latches, the state table, damping, removal, interference.",
        "a march of its own over enumerated states on 500 seeded random decks, augmentations counted",
        "1e-9",
    ),
    Case(
        "totals-calculix",
        "The solver shall find the total forces of punch and Hertz decks with fully integrated bricks.",
        "recorded totals of a dense computation: hertz 24, 54, 110; punch 9, 16, 26",
        "0.05 %",
    ),
    Case(
        "totals",
        "The solver shall find the total forces of punch and Hertz decks with mean-dilatation bricks.",
        "recorded totals of a dense computation: hertz 54, punch 16",
        "0.05 %",
    ),
    Case(
        "totals-oracle",
        "The solver shall find the total forces of punch 6 and hertz 24 with both kinds of bricks.",
        "dense computation by the oracle's elements, in the test",
        "1e-9",
    ),
    Case(
        "hertz-theory",
        "The solver shall find the peak pressure of a long cylinder on a block under hard contact.",
        "Hertz: p_max = sqrt(F' E* / (pi R)) at the computed force",
        "0.5 %",
    ),
    Case(
        "C01",
        "The solver shall converge to Hertz's pressures of a ball on a rigid flat: 5, 7 and 10 elements over the radius.",
        "closed form; the approach: Tatara's for a ball between two flats",
        "0.2 % of the peak, 0.1 % of the approach at 10 elements; order at least 1.7 at the peak, 0.9 in the mean",
    ),
    Case(
        "peers",
        "The solver shall solve small contact decks as CalculiX does, but for its law: our own decks, and contact3, contact6, cubespring of its collection.",
        "recorded answers of CalculiX 2.20, displacements shipped with its decks, a dense model of its springs",
        "0.5 % of the largest displacement; 1e-9 against the model with our law, 2e-6 with a table of theirs",
    ),
    Case(
        "C03",
        "The solver shall converge to Hertz's pressures of a roller on a block: 5, 10 and 20 elements over the half width.",
        "closed form of half planes",
        "0.05 % of the peak at 20 elements and a hundredth of the load; order at least 1.7 at the peak, 0.9 in the mean",
    ),
    Case(
        "history",
        "The solver shall ramp, keep and remove displacements and loads from step to step and follow amplitudes.",
        "closed form of a column of springs at every increment",
        "1e-11",
    ),
    Case(
        "elements",
        "The solver shall find the uniform stress of a bar of distorted elements of every kind under pressure.",
        "closed form, both dialects",
        "1e-10",
    ),
    Case(
        "gravity",
        "The solver shall weigh a distorted box of elements of every kind.",
        "density times volume times acceleration",
        "1e-11",
    ),
    Case(
        "oracle",
        "The solver shall find the contact state that enumeration of all active sets finds.",
        "brute force on 500 seeded random decks",
        "1e-9",
    ),
    Case(
        "oracle-floating",
        "The solver shall find forces and displacements of bodies that contact holds, with equations, springs and bars.",
        "dense system with Lagrange multipliers on 500 seeded random decks, every state with its proof",
        "1e-9",
    ),
    Case(
        "unheld",
        "The solver shall name body and motion where a load moves a body that nothing can hold.",
        "20 seeded decks with the proof that no equilibrium exists",
        "exit code 2 or 3, with the names",
    ),
    Case(
        "oracle-exponential",
        "The solver shall find the minimum of the potential of structure and exponential contact.",
        "convex minimisation on 60 seeded random decks",
        "1e-9",
    ),
    Case(
        "D01",
        "The solver shall return a mass from a linear law after half a period, with its speed, implicit and by explicit penalties.",
        "closed form; the oracle's march at every increment",
        "an increment in time, 0.5 %; 1e-9",
    ),
    Case(
        "D02",
        "The solver shall return a mass from an exponential law.",
        "energy integral; the oracle's march",
        "an increment in time, 0.5 %; 1e-8",
    ),
    Case(
        "D03",
        "The solver shall return a mass from a table, one that begins at a clearance or an overclosure too.",
        "energy integral; the oracle's march",
        "an increment in time, 0.5 %; 1e-8",
    ),
    Case(
        "D04",
        "The solver shall return a mass from an exponential law whose slope has a ceiling.",
        "energy integral; the oracle's march",
        "an increment in time, 0.5 %; 1e-8",
    ),
    Case(
        "D05",
        "The solver shall drop a mass onto a spring and let it come back to its height.",
        "closed form",
        "0.5 %, height 1 %",
    ),
    Case(
        "D06",
        "The solver shall return a mass from damped contact with the restitution of its damping: released at zero force in Abaqus/Explicit, at zero overclosure in Abaqus/Standard.",
        "closed form; the oracle's march",
        "0.5 %; 1e-9 explicit, 2e-3 implicit",
    ),
    Case(
        "D08",
        "The solver shall join two masses that meet under hard contact by one impulse, and book the loss.",
        "closed form",
        "1e-12",
    ),
    Case(
        "D09",
        "The solver shall spread the jump of an impact by the consistent mass matrix, and keep it at the end by the lumped one.",
        "closed form; the oracle's march",
        "1e-10",
    ),
    Case(
        "D10",
        "The solver shall find the time of an impact within its increment by the clearance.",
        "closed form",
        "1e-10",
    ),
    Case(
        "D11",
        "The solver shall let points that change in one increment change together at their mean fraction, and open a point where its force ends.",
        "closed form; the oracle's march",
        "1e-10; 1e-9",
    ),
    Case(
        "D12",
        "The solver shall release a body that has met a wall when its force ends, without a jump.",
        "closed form",
        "0.2 % of force and speed, two increments of time, 1 % of the vibration left",
    ),
    Case(
        "impact-chains",
        "The solver shall carry chains of masses, springs and hard gaps through any number of impacts and releases.",
        "the oracle's march on 6 seeded chains",
        "2e-3 of the displacements, 0.5 % of the energy",
    ),
    Case(
        "D13",
        "The solver shall bring a bar of ten elements back from a rigid wall, hard kinematic, by penalties and implicit.",
        "wave theory",
        "3 % of duration and force, 6 % of the rebound",
    ),
    Case(
        "D14",
        "The solver shall give the rebound of lumped bars at Courant number one to the algorithm's own figure.",
        "published figures; the oracle's march at every increment",
        "1e-6; 1e-8",
    ),
    Case(
        "D15",
        "The solver shall load a bar through softened contact as its impedance says until the wave is back.",
        "closed form; the oracle's march",
        "1.2 %; 1e-8",
    ),
    Case(
        "D16",
        "The solver shall exchange the motion of two equal bars, by pure and balanced kinematic contact.",
        "wave theory",
        "1 %; momentum 1e-11",
    ),
    Case(
        "D17",
        "The solver shall stop a shorter striker, and give bars of any impedance their common velocity.",
        "wave theory",
        "1 %",
    ),
    Case(
        "D18",
        "The solver shall keep automatic increments below the limit of a contact spring with its dashpot, and near it.",
        "closed form",
        "never above; within 15 %",
    ),
    Case(
        "D19",
        "The solver shall take a default penalty of 0.0851 of 4 m / dt^2, and not lose more of the increment than the nodal estimate says.",
        "closed form",
        "10 % of the stiffness; never above",
    ),
    Case(
        "D21",
        "The solver shall step penalty contact by the place at the start of each increment.",
        "the recursion itself",
        "1e-12",
    ),
    Case(
        "D22",
        "The solver shall give softened kinematic contact the place that obeys the law, stable however stiff, and lose the energy that this costs.",
        "the recursion h = d / (1 + theta^2) by the oracle; estimate of the restitution",
        "1e-10; second order",
    ),
    Case(
        "D23",
        "The solver shall correct a node and a plate of four masses by hard kinematic contact.",
        "closed form",
        "1e-11",
    ),
    Case(
        "D24",
        "The solver shall keep momentum in kinematic and penalty contact off the middle of a face, hard and softened.",
        "conservation; the oracle's march",
        "1e-11; 1e-9",
    ),
    Case(
        "pressed",
        "The solver shall settle two masses that are pressed together where their softened kinematic contact carries the force.",
        "the law",
        "1e-6; momentum 1e-9",
    ),
    Case(
        "D25",
        "The solver shall step the operator of Hilber, Hughes and Taylor.",
        "published figures; the oracle's march",
        "1e-8; 1e-9",
    ),
    Case(
        "orders",
        "The solver shall converge with the square of the increment in smooth motion, and lose the amplitude that alpha says.",
        "modes of a chain of three masses; spectral radius",
        "order 2.0 +- 0.1; 0.2 %",
    ),
    Case(
        "D26",
        "The solver shall start from surfaces that touch under an exponential law with its pressure, let them part with its energy, and warn.",
        "closed form",
        "1e-10; 0.5 %",
    ),
    Case(
        "D27",
        "The solver shall swing a mass that cannot part from a linear law, in tension too.",
        "closed form; the oracle's march",
        "0.5 %; 1e-9",
    ),
    Case(
        "D28",
        "The solver shall let two free masses part elastically by penalties and join them by the kinematic corrector.",
        "closed form",
        "1 %; 1e-9",
    ),
    Case(
        "D29",
        "The solver shall damp softened contact by a critical fraction of 0.03 where nothing is said.",
        "closed form",
        "0.1 %",
    ),
    Case(
        "D30",
        "The solver shall let two masses exchange their speeds by implicit softened contact, without an impact, and warn.",
        "closed form",
        "0.2 %; two increments of time",
    ),
    Case(
        "D31",
        "The solver shall keep automatic increments below the limit of the slope that a curved law has reached.",
        "closed form",
        "never above",
    ),
    Case(
        "D32",
        "The solver shall lose the energy of half an element when a lumped bar meets a wall, and book it.",
        "closed form",
        "1e-6",
    ),
    Case(
        "bouncing",
        "The solver shall keep the balance of energy over ten thousand explicit increments of a bouncing block, with every law, enforcement and weighting, and over many implicit ones.",
        "conservation; energies of the printed motion by the oracle's matrices",
        "1e-3 of the largest energy; 1e-8",
    ),
    Case(
        "dynamics-input",
        "The solver shall refuse or stop what cannot be stepped: increments above the stable one, densities, periods and nodes that are none, rigid secondaries in kinematic contact.",
        "the rules",
        "exit code 2 or 3, with the reason and the last good time",
    ),
    Case(
        "moving",
        "The solver shall end random decks that move, and balance their energy or say that it does not.",
        "its own history: parts and sum; 90 seeded decks",
        "2 % explicit, 5 % implicit",
    ),
    Case(
        "memory-of-impact",
        "The solver shall go on from any snapshot in the middle of an impact with the bits of the run that never stopped.",
        "itself: fourteen decks of both procedures",
        "64 bits",
    ),
    Case(
        "peers-dynamics",
        "The solver shall move contdamp1 and contdamp2 of CalculiX's collection as CalculiX does.",
        "displacements and velocities shipped with the decks; one degree of freedom by the oracle",
        "0.1 %",
    ),
    Case(
        "invariance",
        "The solver shall give the same physics wherever a deck stands, however it is turned, and in any units.",
        "itself: every verification deck, generated and random decks",
        "1e-9",
    ),
    Case(
        "paths",
        "The solver shall give the same figures by the dense and by the sparse path.",
        "itself: every verification deck, generated and random decks",
        "1e-10",
    ),
    Case(
        "robustness",
        "The solver shall complete at least 98 % of random small decks with a clean audit, every frictionless hard or softened one among them; none hangs, panics or is refused.",
        "its own audit: force balance, tension, penetration; 150 decks here, 1000 by `make robustness`",
        "98 %, 100 %, none",
    ),
    Case(
        "ways",
        "The solver shall give contact that remembers the same bits by command line, daemon and FMU.",
        "itself: seven decks, every output of every increment",
        "64 bits",
    ),
    Case(
        "memory",
        "The solver shall go on from any snapshot with the bits of the run that never stopped, whatever contact remembers.",
        "itself: the decks of `ways`, three random plans of each kind",
        "64 bits",
    ),
    Case(
        "increments",
        "The solver shall reach the same end state in one increment, in 20, and in automatic ones.",
        "itself: the problem is path independent",
        "1e-10",
    ),
]


def requirement(name):
    """The case of that name; a test that names an unknown case fails."""
    return next(case for case in CASES if case.name == name)


def table():
    """Markdown table of the cases."""
    lines = ["| case | requirement | reference | tolerance |", "|---|---|---|---|"]
    lines += [f"| {c.name} | {c.requirement} | {c.reference} | {c.tolerance} |" for c in CASES]
    return "\n".join(lines)


def published():
    """The table as it stands in the README."""
    text = README.read_text(encoding="utf-8")
    return text[text.index(START) + len(START) : text.index(END)].strip()


def reference(name):
    """Inputs and expected values of a closed-form case of tests/data/cases.json."""
    cases = json.loads((HERE.parent / "data" / "cases.json").read_text(encoding="utf-8"))["cases"]
    return next(case for case in cases if case["id"] == name)


def publish():
    """Rewrites the table in the README."""
    text = README.read_text(encoding="utf-8")
    before, after = text[: text.index(START) + len(START)], text[text.index(END) :]
    README.write_text(f"{before}\n{table()}\n{after}", encoding="utf-8")


if __name__ == "__main__":
    publish()
