"""Boxes of any solid element as deck text: the meshes of the element tests."""

import itertools

# Corners of the elements that fill a hexahedron, by corner count.
PARTS = {
    8: [(0, 1, 2, 3, 4, 5, 6, 7)],
    6: [(0, 1, 3, 4, 5, 7), (1, 2, 3, 5, 6, 7)],
    4: [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)],
}

# Edges with a midside node, in the order of the manual, by corner count.
EDGES = {
    8: [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)],
    6: [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
    4: [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
}

# Corners of the faces S1, S2, … in any order, by corner count.
FACES = {
    8: [(0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)],
    6: [(0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)],
    4: [(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)],
}

# Corners, and whether there are midside nodes.
KINDS = {
    "C3D8": (8, False),
    "C3D8I": (8, False),
    "C3D8R": (8, False),
    "C3D20": (8, True),
    "C3D20R": (8, True),
    "C3D6": (6, False),
    "C3D15": (6, True),
    "C3D4": (4, False),
    "C3D10": (4, True),
}


class Box:
    """A box of one kind of element: coordinates by node number, nodes by element number."""

    def __init__(self, kind, low, high, cells, place=lambda x: x, first_node=1, first_element=1):
        corners, middles = KINDS[kind]
        self.kind, self.low, self.high = kind, low, high
        self.ideal, self.nodes, self.elements, self.faces = {}, {}, {}, {}
        number = {}
        ranges = [range(n + 1) for n in reversed(cells)]
        for count, (k, j, i) in enumerate(itertools.product(*ranges)):
            number[i, j, k] = first_node + count
            ideal = tuple(low[a] + (high[a] - low[a]) * n / cells[a] for a, n in enumerate((i, j, k)))
            self.ideal[first_node + count] = ideal
            self.nodes[first_node + count] = place(ideal)
        between = {}
        for k, j, i in itertools.product(*[range(n) for n in reversed(cells)]):
            ring = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            hexahedron = [number[a, b, c] for c in (k, k + 1) for a, b in ring]
            for part in PARTS[corners]:
                element = [hexahedron[a] for a in part]
                label = first_element + len(self.elements)
                for face, local in enumerate(FACES[corners], start=1):
                    self.faces[label, face] = [element[a] for a in local]
                for a, b in EDGES[corners] if middles else []:
                    key = frozenset((element[a], element[b]))
                    if key not in between:
                        between[key] = first_node + len(self.nodes)
                        for points in (self.ideal, self.nodes):
                            points[between[key]] = tuple(
                                0.5 * (p + q) for p, q in zip(points[element[a]], points[element[b]], strict=True)
                            )
                    element.append(between[key])
                self.elements[label] = element

    def side(self, axis, level):
        """Nodes on a side of the undistorted box."""
        return [n for n, x in self.ideal.items() if abs(x[axis] - level) < 1e-12]

    def side_faces(self, axis, level):
        """(element, face number) of a side."""
        on_side = set(self.side(axis, level))
        return [key for key, nodes in self.faces.items() if on_side.issuperset(nodes)]

    def lines(self, name):
        """`*NODE` and `*ELEMENT` with the sets N{name} and E{name}; long elements continue on the next line."""
        lines = [f"*NODE, NSET=N{name}"]
        lines += [f"{n}, " + ", ".join(repr(float(c)) for c in x) for n, x in self.nodes.items()]
        lines.append(f"*ELEMENT, TYPE={self.kind}, ELSET=E{name}")
        for label, nodes in self.elements.items():
            numbers = [str(n) for n in (label, *nodes)]
            rows = [", ".join(numbers[i : i + 16]) for i in range(0, len(numbers), 16)]
            lines += [",\n".join(rows)]
        return lines


def node_set(name, nodes):
    """`*NSET` of nodes."""
    return [f"*NSET, NSET={name}", *[f"{n}," for n in nodes]]


def surface(name, faces):
    """`*SURFACE` of faces."""
    return [f"*SURFACE, NAME={name}, TYPE=ELEMENT", *[f"{element}, S{face}" for element, face in faces]]
