//! Areas of the nodes of a node-based secondary surface where the deck gives none, in the CalculiX dialect.
//!
//! CalculiX lets such a node stand for its share of every outer face of a solid at the node, faces that look away from the primary
//! surface included: the area of the face over the number of its corners. Measured with CalculiX 2.20 on bricks (distorted ones too)
//! and tetrahedra. What it takes at faces with midside nodes is no share of their area (a hundredth of it at corners), so nothing is
//! said about those. A node that is on no solid stands for the primary face under it (`PrimarySurface::area_at`).

use std::collections::BTreeMap;

use crate::element::{Coordinates, face};
use crate::model::{ElementId, Mesh, NodeId};

/// Corners of a face in ascending order; a triangle ends with a node that no mesh has.
type FaceKey = [NodeId; 4];

/// What a node has of outer faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Share {
    /// A share of their area \[length²\].
    Area(f64),
    /// Faces with midside nodes.
    Midside,
    /// None.
    Nothing,
}

impl Share {
    /// The area, if it is known.
    pub fn area(self) -> Option<f64> {
        match self {
            Self::Area(area) => Some(area),
            Self::Midside | Self::Nothing => None,
        }
    }
}

/// Share of each node, in the order of `nodes`.
pub fn of_outer_faces(mesh: &Mesh, nodes: &[NodeId]) -> Vec<Share> {
    let mut wanted = vec![false; mesh.nodes.len()];
    for node in nodes {
        wanted[node.index()] = true;
    }
    // Elements at each face, and the face's corner nodes and area; a face of two elements is not outer. All elements of a face at
    // a wanted node are at that node themselves, so the others need no look.
    let mut faces: BTreeMap<FaceKey, Face> = BTreeMap::new();
    for element in 0..mesh.elements.len() {
        let is_solid = mesh.elements.kind(element).is_solid();
        if !is_solid || !mesh.elements.nodes(element).iter().any(|n| wanted[n.index()]) {
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
    let mut shares = vec![Share::Nothing; mesh.nodes.len()];
    for outer in faces.values().filter(|f| f.elements == 1) {
        for node in &outer.nodes {
            let share = &mut shares[node.index()];
            *share = match *share {
                _ if outer.nodes.len() > outer.corners => Share::Midside,
                Share::Midside => Share::Midside,
                before => Share::Area(before.area().unwrap_or(0.0) + outer.area / outer.corners as f64),
            };
        }
    }
    nodes.iter().map(|n| shares[n.index()]).collect()
}

/// A face at a wanted node.
struct Face {
    elements: u32,
    nodes: Vec<NodeId>,
    corners: usize,
    area: f64,
}
