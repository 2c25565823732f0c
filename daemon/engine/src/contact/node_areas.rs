//! Areas of the nodes of a node-based secondary surface where the deck gives none, in the CalculiX dialect.
//!
//! CalculiX lets such a node stand for its share of every outer face of a solid at the node, faces that look away from the primary
//! surface included: the area of the face over the number of its corners. Measured with CalculiX 2.20 on bricks (distorted ones too)
//! and tetrahedra. What it takes at faces with midside nodes is no share of their area (a hundredth of it at corners), so nothing is
//! said about those.

use std::collections::BTreeMap;

use crate::element::{Coordinates, face};
use crate::model::{ElementId, Mesh, NodeId};

/// Corners of a face in ascending order; a triangle ends with a node that no mesh has.
type FaceKey = [NodeId; 4];

/// Area of each node [length²], in the order of `nodes`; none where a node has no outer face, or one with midside nodes.
pub fn of_outer_faces(mesh: &Mesh, nodes: &[NodeId]) -> Vec<Option<f64>> {
    let mut wanted = vec![false; mesh.nodes.len()];
    for node in nodes {
        wanted[node.index()] = true;
    }
    // Elements at each face, and the face's corner nodes and area; a face of two elements is not outer. All elements of a face at
    // a wanted node are at that node themselves, so the others need no look.
    let mut faces: BTreeMap<FaceKey, Face> = BTreeMap::new();
    for element in 0..mesh.elements.len() {
        if !mesh.elements.nodes(element).iter().any(|n| wanted[n.index()]) {
            continue;
        }
        for element_face in mesh.elements.faces_of(ElementId(element as u32)) {
            let all = mesh.face_nodes(element_face);
            let corners = &all[..face::corner_count(all.len())];
            if !all.iter().any(|n| wanted[n.index()]) {
                continue;
            }
            let mut key = [NodeId(u32::MAX); 4];
            key[..corners.len()].copy_from_slice(corners);
            key.sort_unstable();
            let entry = faces.entry(key).or_insert_with(|| {
                let coordinates = Coordinates::of(all.iter().map(|n| mesh.nodes[n.index()]));
                Face {
                    elements: 0,
                    nodes: all.to_vec(),
                    corners: corners.len(),
                    area: face::nodal_areas(&coordinates).iter().sum(),
                }
            });
            entry.elements += 1;
        }
    }
    let mut areas = vec![Some(0.0); mesh.nodes.len()];
    for outer in faces.values().filter(|f| f.elements == 1) {
        for node in &outer.nodes {
            let area = &mut areas[node.index()];
            *area = if outer.nodes.len() > outer.corners {
                None
            } else {
                area.map(|a| a + outer.area / outer.corners as f64)
            };
        }
    }
    nodes.iter().map(|n| areas[n.index()].filter(|&a| a > 0.0)).collect()
}

/// A face at a wanted node.
struct Face {
    elements: u32,
    nodes: Vec<NodeId>,
    corners: usize,
    area: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deck::read_text;
    use crate::model::Dialect;

    /// Bricks of 1 x 2 x 3 in a row along x, and a tetrahedron with legs of 1, 2 and 3.
    fn mesh(bricks: usize, kind: &str) -> Mesh {
        let mut text = String::from("*NODE, NSET=NALL\n");
        for i in 0..=bricks {
            for (k, (y, z)) in [(0, 0), (2, 0), (2, 3), (0, 3)].into_iter().enumerate() {
                text += &format!("{}, {i}., {y}., {z}.\n", 4 * i + k + 1);
            }
        }
        text += "101, 10., 0., 0.\n102, 11., 0., 0.\n103, 10., 2., 0.\n104, 10., 0., 3.\n105, 20., 0., 0.\n";
        if kind == "C3D10" {
            text += "111, 10.5, 0., 0.\n112, 10.5, 1., 0.\n113, 10., 1., 0.\n114, 10., 0., 1.5\n115, 10.5, 0., 1.5\n116, 10., 1., 1.5\n";
        }
        text += "*ELEMENT, TYPE=C3D8, ELSET=E\n";
        for i in 0..bricks {
            let n = |a: usize| 4 * i + a;
            text +=
                &format!("{}, {}, {}, {}, {}, {}, {}, {}, {}\n", i + 1, n(1), n(5), n(6), n(2), n(4), n(8), n(7), n(3));
        }
        text += match kind {
            "C3D10" => "*ELEMENT, TYPE=C3D10, ELSET=E\n99, 101, 102, 103, 104, 111, 112, 113, 114, 115, 116\n",
            _ => "*ELEMENT, TYPE=C3D4, ELSET=E\n99, 101, 102, 103, 104\n",
        };
        text += "*MATERIAL, NAME=M\n*ELASTIC\n1., 0.\n*SOLID SECTION, ELSET=E, MATERIAL=M\n";
        text += "*BOUNDARY\nNALL, 1, 3\n*STEP\n*STATIC\n*END STEP\n";
        let read = read_text(&text, Dialect::Calculix);
        read.model.unwrap_or_else(|| panic!("{:?}", read.diagnostics)).mesh
    }

    fn assert_areas(mesh: &Mesh, labels: &[u32], expected: &[Option<f64>]) {
        let found = areas(mesh, labels);
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(expected) {
            let close = match (found, expected) {
                (Some(a), Some(b)) => (a - b).abs() < 1e-14 * b,
                (a, b) => a == b,
            };
            assert!(close, "{found:?} is not {expected:?}");
        }
    }

    fn areas(mesh: &Mesh, labels: &[u32]) -> Vec<Option<f64>> {
        let nodes: Vec<NodeId> = labels
            .iter()
            .map(|l| NodeId(mesh.node_labels.iter().position(|n| n == l).expect("the label exists") as u32))
            .collect();
        of_outer_faces(mesh, &nodes)
    }

    #[test]
    fn a_corner_of_a_brick_stands_for_a_quarter_of_its_three_faces() {
        assert_areas(&mesh(1, "C3D4"), &[1], &[Some((2.0 + 3.0 + 6.0) / 4.0)]);
    }

    #[test]
    fn faces_inside_the_body_do_not_count() {
        // Two faces of 1 x 2 and two of 1 x 3 meet at node 5, between the bricks.
        assert_areas(&mesh(2, "C3D4"), &[5, 1], &[Some((2.0 + 2.0 + 3.0 + 3.0) / 4.0), Some(11.0 / 4.0)]);
    }

    #[test]
    fn a_corner_of_a_tetrahedron_stands_for_a_third_of_its_faces() {
        assert_areas(&mesh(1, "C3D4"), &[101], &[Some((1.0 + 3.0 + 1.5) / 3.0)]);
    }

    #[test]
    fn nothing_is_said_about_nodes_without_faces_or_with_midside_nodes() {
        assert_areas(&mesh(1, "C3D10"), &[101, 112, 105], &[None, None, None]);
    }
}
