"""Result tables by both paths, and their comparison figure by figure."""

import csv

import numpy as np

import support

TOLERANCE = 1e-10
# What is small against what: columns that share a scale, because some of them are rounding alone.
LENGTHS, FORCES = ("U", "COPEN", "CSLIP"), ("RF", "CFN", "CPRESS")


def tables(folder, deck, path):
    """Header and rows of the result tables, text columns apart."""
    folder.mkdir(parents=True)
    source = folder / "deck.inp"
    source.write_text(deck.text)
    support.run(source, folder, *deck.arguments, "--path", path)
    found = {}
    for name in ("contact", "nodes", "history"):
        with open(folder / f"deck_{name}.csv", newline="", encoding="utf-8") as file:
            header, *rows = csv.reader(file)
        found[name] = header, rows
    return found


def family(column):
    """Columns with one scale: displacements with clearances, forces with forces, energies, every other column by itself."""
    name = column.partition("[")[0].rstrip("123M")
    if name in LENGTHS:
        return "length"
    if name in FORCES:
        return name
    return "energy" if column.startswith(("ALL", "ETOTAL", "IMPACT")) else column


def differing(dense, sparse):
    """Columns that differ by more than TOLERANCE against the largest value of their family, and statuses that differ."""
    found, scales = {}, {}
    numbers = {}
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
    force = max(scales.get("RF", 0.0), scales.get("CFN", 0.0))
    scales |= {"RF": force, "CFN": force}
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
            bad = differing(tables(place / "dense", deck, "dense"), tables(place / "sparse", deck, "sparse"))
        except AssertionError as error:
            bad = str(error)[-600:]
        if bad:
            problems.append(f"{deck.name} {' '.join(deck.arguments)}: {bad}")
    return problems
