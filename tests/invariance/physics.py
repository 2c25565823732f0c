"""Results of a deck as numbers with dimension and direction, and their comparison with those of a changed deck."""

from dataclasses import dataclass

import numpy as np

from .rotation import EXTRA

TOUCH = 1e-9
ENERGIES = ["ALLSE", "ALLKE", "ALLWK", "ALLFD", "ALLVD", "ALLCCE", "IMPACT_LOSS", "ETOTAL"]


@dataclass
class Physics:
    """What a run says. Keys are output times with point, node or name; vectors are in the axes of the deck."""

    times: list
    statuses: dict
    areas: dict
    clearances: dict
    pressures: dict
    displacements: dict
    reactions: dict
    contact_forces: dict
    totals: dict
    energies: dict


def read(result):
    """The physics of a result. Reactions of extra nodes are in the old axes already."""
    contact, nodes, history = (result.table(name) for name in ("contact", "nodes", "history"))

    def at(row):
        return int(row["step"]), int(row["increment"])

    def vector(row, pattern):
        return np.array([float(row[pattern.format(d)]) for d in (1, 2, 3)])

    def points(column, kind=float):
        return {(*at(row), row["pair"], row["node"]): kind(row[column]) for row in contact}

    def fields(pattern):
        return {(*at(row), int(row["node"])): vector(row, pattern) for row in nodes}

    def rows(name, end):
        patterns = (
            [c.replace("1[", "{}[") for c in history[0] if c.startswith(f"{name}1[") and end(c)] if history else []
        )
        return {(*at(row), pattern): vector(row, pattern) for row in history for pattern in patterns}

    return Physics(
        [(*at(row), float(row["time"])) for row in history],
        points("status", str),
        points("area"),
        points("COPEN"),
        points("CPRESS"),
        fields("U{}"),
        fields("RF{}"),
        rows("CFN", lambda c: True),
        rows("RF", lambda c: not c.endswith(f"{EXTRA}]")),
        {(*at(row), name): float(row[name]) for row in history for name in ENERGIES},
    )


@dataclass
class Change:
    """How results change with a deck: rotation (3, 3), factors of lengths and forces, and label of an extra node."""

    rotation: np.ndarray
    length: float = 1.0
    force: float = 1.0
    extra: object = None
    sets: object = None


def differences(before, after, change):
    """Largest difference per kind, relative to the largest value of the kind; ValueError where other rows are there."""
    # Impacts are found within increments: their times have rounding.
    same = [(s, i) for s, i, _ in before.times] == [(s, i) for s, i, _ in after.times]
    if not same or any(abs(t[2] - u[2]) > TOUCH * t[2] for t, u in zip(before.times, after.times, strict=True)):
        raise ValueError(f"{len(after.times)} increments instead of {len(before.times)}, or other times")
    length, force, turn = change.length, change.force, change.rotation.T
    pressure = force / length**2
    # Closed hard points have no clearance but rounding: displacements are what it is small against.
    motion = largest(before.displacements)
    strength = max(map(largest, (before.reactions, before.totals, before.contact_forces)))
    changed = [key for key, status in before.statuses.items() if after.statuses.get(key) != status]
    # A point that just touches may be told as either.
    changed = [k for k in changed if abs(before.clearances[k]) > TOUCH * motion or pressed(before, k, strength)]
    # Nor does a dashpot that gives next to nothing decide.
    apart = {"OP", "VD"}
    changed = [
        k for k in changed if pressed(before, k, strength) or not {before.statuses[k], after.statuses.get(k)} <= apart
    ]
    if changed:
        raise ValueError(f"other contact statuses at {changed[:5]}")
    moved = {key: turn @ after.displacements[key] for key in before.displacements}
    contact = {key: turn @ value for key, value in after.contact_forces.items()}
    energies = {key: value / (force * length) for key, value in after.energies.items()}
    return {
        "area": relative(before.areas, after.areas, length**2),
        "clearance": relative(before.clearances, after.clearances, length, motion),
        "pressure": relative(before.pressures, after.pressures, pressure),
        "displacement": relative(before.displacements, moved, length),
        "reaction": relative(before.reactions, reactions(before, after, change), force, strength),
        "contact force": relative(before.contact_forces, contact, force, strength),
        "total": relative(before.totals, totals(before, after, change), force, strength),
        "energy": relative(before.energies, energies, 1.0, strength * motion),
    }


def pressed(physics, key, strength):
    """Whether the force of a point is more than rounding."""
    return abs(physics.pressures[key]) * physics.areas[key] > TOUCH * strength


def reactions(before, after, change):
    """Reactions in the old axes: at the extra nodes, or turned back where nothing is prescribed askew."""
    if change.extra is None:
        return {key: change.rotation.T @ after.reactions[key] for key in before.reactions}
    found = {}
    for step, increment, node in before.reactions:
        key = (step, increment, change.extra(node))
        found[step, increment, node] = after.reactions.get(key, np.zeros(3))
    return found


def totals(before, after, change):
    """Total reactions of node sets: sums over the extra nodes."""
    if change.extra is None:
        return {key: change.rotation.T @ after.totals[key] for key in before.totals}
    found = {}
    for step, increment, pattern in before.totals:
        nodes = set(change.sets.of(pattern[pattern.index("[") + 1 : -1]))
        keys = ((step, increment, change.extra(node)) for node in nodes)
        found[step, increment, pattern] = sum((after.reactions[k] for k in keys if k in after.reactions), np.zeros(3))
    return found


def largest(values):
    """Largest size among numbers or vectors."""
    return max((float(np.abs(v).max()) for v in values.values()), default=0.0)


def relative(before, after, factor, least=0.0):
    """Largest difference of `after / factor` against the largest value, at least `least`."""
    if set(before) - set(after):
        raise ValueError(f"rows are missing: {sorted(set(before) - set(after), key=str)[:5]}")
    scale = max(largest(before), least)
    worst = max((float(np.abs(after[k] / factor - v).max()) for k, v in before.items()), default=0.0)
    return worst / scale if scale else worst
