"""Node-to-surface geometry of the oracle: closest points on bilinear faces, and tributary areas."""

import numpy as np

from .fe import face_integrals, quad_shape


def closest_on_face(point, corners):
    """Closest point of a bilinear face: (distance, r, s, unit normal). Newton from a grid of starts, clipped to the face."""
    best = None
    for start_r in (-0.5, 0.5):
        for start_s in (-0.5, 0.5):
            r, s = start_r, start_s
            for _ in range(60):
                values, along_r, along_s = quad_shape(r, s)
                offset = values @ corners - point
                t_r, t_s = along_r @ corners, along_s @ corners
                twist = 0.25 * (corners[0] - corners[1] + corners[2] - corners[3])
                gradient = np.array([offset @ t_r, offset @ t_s])
                cross = t_r @ t_s + offset @ twist
                hessian = np.array([[t_r @ t_r, cross], [cross, t_s @ t_s]])
                step = np.linalg.solve(hessian, gradient)
                new_r, new_s = np.clip([r - step[0], s - step[1]], -1.0, 1.0)
                moved = max(abs(new_r - r), abs(new_s - s))
                r, s = new_r, new_s
                if moved < 1e-15:
                    break
            values, along_r, along_s = quad_shape(r, s)
            distance = np.linalg.norm(values @ corners - point)
            if best is None or distance < best[0] - 1e-14:
                normal = np.cross(along_r @ corners, along_s @ corners)
                best = (distance, r, s, normal / np.linalg.norm(normal))
    return best


def project(point, faces):
    """Closest point over a list of faces given as corner arrays: (face index, weights, normal, clearance, margin).

    `margin` is how far the foot lies inside the face in parent coordinates; zero on an edge.
    """
    found = [(closest_on_face(point, corners), index) for index, corners in enumerate(faces)]
    (_, r, s, normal), index = min(found, key=lambda item: item[0][0])
    weights = quad_shape(r, s)[0]
    clearance = normal @ (point - weights @ faces[index])
    return index, weights, normal, clearance, 1.0 - max(abs(r), abs(s))


def tributary_areas(node_count, faces, coordinates):
    """Integral of each node's function over the faces (lists of four node indices)."""
    areas = np.zeros(node_count)
    for nodes in faces:
        areas[list(nodes)] += face_integrals(coordinates[list(nodes)])[0]
    return areas
