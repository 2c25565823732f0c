"""Finite elements of the oracle: eight-node bricks, face pressure, gravity. Dense, slow, and written from the theory alone.

Conventions: displacements are numbered ``3 * node + direction``; strains and stresses are ordered 11, 22, 33, 12, 13, 23 with
engineering shear strains; element arrays have the element as first axis.
"""

import numpy as np

# Corner positions of the parent cube in the order of the manual: bottom face 1-4, top face 5-8.
CORNERS = np.array(
    [[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]], dtype=float
)
# Faces S1..S6 by the manual, as node positions (0-based) in cyclic order. Orientation is settled by `outward_face`.
FACES = [(0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)]
GAUSS = 1.0 / np.sqrt(3.0)


def elasticity(young, poisson):
    """Isotropic Hooke matrix, 6 by 6 [pressure]."""
    lame = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson))
    shear = young / (2.0 * (1.0 + poisson))
    matrix = np.diag([2.0 * shear] * 3 + [shear] * 3)
    matrix[:3, :3] += lame
    return matrix


def shape(point):
    """Values and parent derivatives of the eight shape functions at a parent point."""
    factors = 1.0 + CORNERS * np.asarray(point)
    values = factors.prod(axis=1) / 8.0
    slopes = np.empty((8, 3))
    for axis in range(3):
        others = [a for a in range(3) if a != axis]
        slopes[:, axis] = CORNERS[:, axis] * factors[:, others].prod(axis=1) / 8.0
    return values, slopes


def gauss_points():
    """The eight points of the 2x2x2 rule; all weights are one."""
    return [GAUSS * corner for corner in CORNERS]


def gradients(coordinates, point):
    """Gradients of the shape functions (elements, 8, 3) and Jacobian determinants (elements,)."""
    _, slopes = shape(point)
    jacobian = np.einsum("eai,ak->eik", coordinates, slopes)
    return np.einsum("ak,eki->eai", slopes, np.linalg.inv(jacobian)), np.linalg.det(jacobian)


def strain_matrix(gradient):
    """Strain-displacement matrices (elements, 6, 24)."""
    matrix = np.zeros((gradient.shape[0], 6, 24))
    for node in range(8):
        x, y, z = gradient[:, node, 0], gradient[:, node, 1], gradient[:, node, 2]
        column = 3 * node
        matrix[:, 0, column] = x
        matrix[:, 1, column + 1] = y
        matrix[:, 2, column + 2] = z
        matrix[:, 3, column], matrix[:, 3, column + 1] = y, x
        matrix[:, 4, column], matrix[:, 4, column + 2] = z, x
        matrix[:, 5, column + 1], matrix[:, 5, column + 2] = z, y
    return matrix


def mean_dilatation(matrices, weights):
    """Replaces the volumetric part at every point by its average over the element (Nagtegaal, Parks and Rice 1974)."""
    volume = sum(weights)
    traces = [m[:, :3, :].sum(axis=1) for m in matrices]
    average = sum(w[:, None] * t for w, t in zip(weights, traces, strict=True)) / volume[:, None]
    corrected = []
    for matrix, trace in zip(matrices, traces, strict=True):
        matrix = matrix.copy()
        matrix[:, :3, :] += ((average - trace) / 3.0)[:, None, :]
        corrected.append(matrix)
    return corrected


def stiffnesses(coordinates, hooke, full):
    """Element stiffness matrices (elements, 24, 24). `full` is the plain 2x2x2 rule, otherwise mean dilatation."""
    matrices, weights = [], []
    for point in gauss_points():
        gradient, determinant = gradients(coordinates, point)
        if determinant.min() <= 0.0:
            raise ValueError("inverted element in an oracle deck")
        matrices.append(strain_matrix(gradient))
        weights.append(determinant)
    if not full:
        matrices = mean_dilatation(matrices, weights)
    total = np.zeros((coordinates.shape[0], 24, 24))
    for matrix, weight in zip(matrices, weights, strict=True):
        total += np.einsum("e,eki,kl,elj->eij", weight, matrix, hooke, matrix, optimize=True)
    return total


def assemble(node_count, elements, blocks):
    """Dense global stiffness from element blocks."""
    total = np.zeros((3 * node_count, 3 * node_count))
    for nodes, block in zip(elements, blocks, strict=True):
        dofs = (3 * np.asarray(nodes)[:, None] + np.arange(3)).ravel()
        total[np.ix_(dofs, dofs)] += block
    return total


def quad_shape(r, s):
    """Bilinear functions of a four-node face and their derivatives along r and s."""
    corner_r, corner_s = np.array([-1, 1, 1, -1.0]), np.array([-1, -1, 1, 1.0])
    values = 0.25 * (1 + r * corner_r) * (1 + s * corner_s)
    return values, 0.25 * corner_r * (1 + s * corner_s), 0.25 * corner_s * (1 + r * corner_r)


def outward_face(element_coordinates, face):
    """Local nodes of a face in the cyclic order whose normal points out of the element."""
    nodes = list(FACES[face])
    corners = element_coordinates[nodes]
    normal = np.cross(corners[2] - corners[0], corners[3] - corners[1])
    if normal @ (corners.mean(axis=0) - element_coordinates.mean(axis=0)) < 0.0:
        nodes.reverse()
    return nodes


def face_integrals(corners):
    """Per corner: integral of its function over the face [length^2], and of function times normal (4, 3)."""
    areas, vectors = np.zeros(4), np.zeros((4, 3))
    for r in (-GAUSS, GAUSS):
        for s in (-GAUSS, GAUSS):
            values, along_r, along_s = quad_shape(r, s)
            normal = np.cross(along_r @ corners, along_s @ corners)
            areas += values * np.linalg.norm(normal)
            vectors += np.outer(values, normal)
    return areas, vectors


def gravity_forces(element_coordinates, acceleration, density):
    """Nodal forces (8, 3) of a body force on one element."""
    forces = np.zeros((8, 3))
    for point in gauss_points():
        values, slopes = shape(point)
        determinant = np.linalg.det(element_coordinates.T @ slopes)
        forces += np.outer(values, density * determinant * np.asarray(acceleration))
    return forces
