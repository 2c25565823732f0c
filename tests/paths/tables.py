"""Result tables by both paths, and their comparison figure by figure."""

import csv

import numpy as np
from invariance.cards import Sets, parse

import support

TOLERANCE = 1e-10
# What is small against what: columns that share a scale, because some of them are rounding alone.
FAMILIES = {
    "length": ("U", "COPEN", "CSLIP"),
    "force": ("RF", "CFN", "CFS", "CFT"),
    "pressure": ("CPRESS", "CSHEAR", "CDPRESS", "CDSHEAR"),
    "moment": ("CMN", "CMS", "CMT", "CTRQ", "RM"),
    "rotation": ("UR",),
    "velocity": ("V",),
    "acceleration": ("A",),
    "place": ("XN", "XS", "XT"),
}
# Displacements below this part of the deck's size are not to be had to TOLERANCE: coordinates have 16 digits.
RESOLVED = 1e-6


def tables(folder, deck, path):
    """Header and rows of the result tables, text columns apart."""
    folder.mkdir(parents=True)
    source = folder / "deck.inp"
    source.write_text(deck.text)
    arguments = [word for word in deck.arguments if word not in ("--path", "dense", "sparse")]
    support.run(source, folder, *arguments, "--path", path)
    found = {}
    for name in ("contact", "nodes", "history"):
        with open(folder / f"deck_{name}.csv", newline="", encoding="utf-8") as file:
            header, *rows = csv.reader(file)
        found[name] = header, rows
    return found


def family(column):
    """Columns with one scale: displacements with clearances, forces, pressures with shear, energies; every other column by itself."""
    name = column.partition("[")[0].rstrip("123M")
    for kind, names in FAMILIES.items():
        if name in names:
            return kind
    return "energy" if column.startswith(("ALL", "ETOTAL", "IMPACT")) else column


def size(text):
    """Largest extent of the nodes of a deck."""
    coordinates = list(Sets(parse(text)).coordinates.values())
    return float(np.ptp(np.array(coordinates), axis=0).max())


def differing(dense, sparse, extent=0.0):
    """Columns that differ by more than TOLERANCE against the largest value of their family, and statuses that differ.

    `extent` is the size of the deck [length].
    """
    found, scales, numbers = {}, {"length": RESOLVED * extent, "force": 0.0, "energy": 0.0}, {}
    for name, (header, rows) in dense.items():
        other, theirs = sparse[name]
        if header != other or len(rows) != len(theirs):
            return {name: "other columns or rows"}
        for index, column in enumerate(header):
            ours, yours = [row[index] for row in rows], [row[index] for row in theirs]
            if column in ("pair", "status"):
                if ours != yours:
                    found[column] = [(a, b) for a, b in zip(ours, yours, strict=True) if a != b][:3]
                continue
            if [bool(v) for v in ours] != [bool(v) for v in yours]:
                return {column: "empty in one of them"}
            pair = [np.array([float(v or 0.0) for v in values]) for values in (ours, yours)]
            numbers[name, column] = pair
            scales[family(column)] = max(scales.get(family(column), 0.0), np.abs(pair[0]).max(initial=0.0))
    scales["energy"] = max(scales["energy"], scales["force"] * scales["length"])
    scales["moment"] = max(scales.get("moment", 0.0), scales["force"] * extent)
    scales["rotation"] = max(scales.get("rotation", 0.0), scales["length"] / extent if extent else 0.0)
    scales["place"] = max(scales.get("place", 0.0), extent)
    for (name, column), (ours, yours) in numbers.items():
        difference = np.abs(ours - yours).max(initial=0.0)
        if not difference <= TOLERANCE * scales[family(column)]:
            found[f"{name} {column}"] = difference / (scales[family(column)] or 1.0)
    return found


def disagreements(decks, folder):
    """One line for each deck whose tables differ between the paths."""
    problems = []
    for number, deck in enumerate(decks):
        place = folder / str(number)
        try:
            by_path = [tables(place / path, deck, path) for path in ("dense", "sparse")]
            bad = differing(*by_path, size(deck.text))
        except AssertionError as error:
            bad = str(error)[-600:]
        if bad:
            problems.append(f"{deck.name} {' '.join(deck.arguments)}: {bad}")
    return problems
