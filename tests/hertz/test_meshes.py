"""The meshes are what the cases say: valid bricks, nodes on the sphere, volumes and areas of the bodies."""

import math

import numpy as np
import pytest

from hertz import cylinder, sphere
from hertz.meshes import volumes

BALL = sphere.Ball(0.01, 100.0, 210e9, 0.3)
ROLLER = cylinder.Roller(50.0, 35000.0, (210e3, 0.3), (70e3, 0.3), 100.0)


@pytest.mark.parametrize("elements", [5, 7, 10])
def test_the_ball_is_made_of_valid_bricks_with_their_outer_nodes_on_the_sphere(elements):
    mesh = sphere.mesh_of(BALL, elements)
    determinants = volumes(mesh)
    assert determinants.min() > 0.0
    skin = {
        int(p)
        for b, face in mesh.contact
        for p in mesh.bricks[b, {1: [0, 1, 2, 3], 3: [0, 1, 5, 4], 6: [0, 3, 7, 4]}[face]]
    }
    from_centre = np.linalg.norm(mesh.points[sorted(skin)] - [0.0, 0.0, BALL.radius], axis=1)
    assert np.abs(from_centre / BALL.radius - 1.0).max() < 1e-12
    assert mesh.points.min() == 0.0 and mesh.points[:, 2].max() == BALL.radius
    # An eighth of a ball, less what chords cut off.
    volume = determinants.mean(axis=0).sum()
    exact = math.pi * BALL.radius**3 / 6.0
    assert 0.95 * exact < volume < 1.001 * exact
    assert sphere.cut_area(mesh) == pytest.approx(0.25 * math.pi * BALL.radius**2, rel=0.03)


@pytest.mark.parametrize("elements", [5, 10])
def test_the_contact_edge_lies_in_the_middle_of_an_element(elements):
    mesh = sphere.mesh_of(BALL, elements)
    core = mesh.points[(mesh.shell == 0) & (mesh.points[:, 1] == 0.0)]
    on_sphere = np.linalg.norm(core - [0.0, 0.0, BALL.radius], axis=1) > BALL.radius * (1.0 - 1e-12)
    along = np.sort(core[on_sphere, 0])
    inside = (along < BALL.theory().a).sum()
    assert inside == elements
    edge = 0.5 * (along[inside - 1] + along[inside])
    assert edge == pytest.approx(BALL.theory().a, rel=0.001)


@pytest.mark.parametrize("elements", [5, 10, 20])
def test_roller_and_block_are_made_of_valid_bricks(elements):
    roller, block = cylinder.meshes_of(ROLLER, elements, 1.0)
    for mesh, area in ((roller, 0.25 * math.pi * 50.0**2), (block, 100.0 * 200.0)):
        determinants = volumes(mesh)
        assert determinants.min() > 0.0
        assert determinants.mean(axis=0).sum() == pytest.approx(area, rel=0.02)
    assert list(block.points.min(axis=0)) == pytest.approx([0.0, 0.0, -200.0], rel=1e-12)
