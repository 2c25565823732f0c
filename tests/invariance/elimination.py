"""Linear constraints between displacements as equations in which no dependent direction appears twice."""


class Elimination:
    """Gauss-Jordan elimination of constraint rows `{dof: coefficient}`; a dof is any hashable name."""

    def __init__(self, never):
        """`never(dof)` tells the dofs that may not become dependent."""
        self.never = never
        self.rows = {}

    def add(self, row):
        """Adds the constraint sum(coefficient * dof) = 0. Its largest allowed dof becomes dependent."""
        for pivot in [dof for dof in row if dof in self.rows]:
            subtract(row, row[pivot], self.rows[pivot])
        allowed = {dof: abs(c) for dof, c in row.items() if not self.never(dof)}
        pivot = max(allowed, key=allowed.get, default=None)
        if pivot is None or allowed[pivot] < 1e-9:
            raise ValueError(f"constraint {row} depends on others or on prescribed directions only")
        row = {dof: c / row[pivot] for dof, c in row.items()}
        for other in self.rows.values():
            if pivot in other:
                subtract(other, other[pivot], row)
        self.rows[pivot] = row

    def equations(self):
        """Terms (dof, coefficient) of each equation, the dependent one first."""
        for pivot, row in self.rows.items():
            yield [(pivot, 1.0), *((dof, c) for dof, c in row.items() if dof != pivot)]


def subtract(row, factor, other):
    """`row -= factor * other`, without the zeros that cancel."""
    for dof, coefficient in other.items():
        value = row.get(dof, 0.0) - factor * coefficient
        if abs(value) > 1e-14:
            row[dof] = value
        else:
            row.pop(dof, None)
