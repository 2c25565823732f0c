//! Primary surfaces: faces of elements, or an analytical surface of a rigid body.

use super::search::{Anchor, PrimarySurface, Query};
use super::underlying::Underlying;
use crate::element::quad::sub;
use crate::model::{AnalyticalSurface, ElementFace, FACE_NODES_MAX, FaceNodes, Mesh, NodeId, RigidBody, SurfaceKind};

/// A primary surface, ready to be searched.
pub enum Primary<'a> {
    /// Faces.
    Faces(&'a [ElementFace], Box<PrimarySurface>),
    /// An analytical surface.
    Analytical(&'a AnalyticalSurface),
}

/// Lever of a contact force about the reference node of a rigid body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lever {
    /// Node whose displacements are the rotations.
    pub rotation: NodeId,
    /// From the reference node to the anchor [length].
    pub arm: [f64; 3],
}

/// What moves with the primary surface at an anchor.
pub struct Hold {
    /// Nodes that carry the anchor.
    pub nodes: FaceNodes,
    /// Their shares; they add up to 1.
    pub weights: [f64; FACE_NODES_MAX],
    /// Rotations that move it too.
    pub lever: Option<Lever>,
}

impl<'a> Primary<'a> {
    /// A primary surface with the coordinates of a mesh.
    pub fn new(mesh: &Mesh, kind: &'a SurfaceKind, analytical: &'a [AnalyticalSurface]) -> Self {
        match kind {
            SurfaceKind::Faces(faces) => Self::Faces(faces, Box::new(PrimarySurface::new(mesh, faces))),
            SurfaceKind::Analytical(index) => Self::Analytical(&analytical[*index as usize]),
            SurfaceKind::Nodes(_) | SurfaceKind::Bars(_) => {
                unreachable!("the deck reader admits faces and analytical surfaces as primary ones")
            }
        }
    }

    /// Anchors of a secondary node: the nearest first.
    pub fn anchors(&self, mesh: &Mesh, query: Query) -> Vec<Anchor> {
        match self {
            Self::Faces(_, surface) => surface.anchors(mesh, query),
            Self::Analytical(surface) => surface.anchors(mesh, query),
        }
    }

    /// What moves with an anchor.
    pub fn hold(&self, mesh: &Mesh, bodies: &[RigidBody], anchor: &Anchor) -> Hold {
        match self {
            Self::Faces(_, surface) => {
                Hold { nodes: surface.face_nodes(anchor.face), weights: surface.weights(anchor), lever: None }
            }
            Self::Analytical(surface) => {
                let body = surface.body.map(|body| &bodies[body as usize]);
                let body = body.expect("the deck reader gives each analytical surface in contact a rigid body");
                let mut weights = [0.0; FACE_NODES_MAX];
                weights[0] = 1.0;
                let arm = sub(anchor.foot, mesh.nodes[body.reference.index()]);
                let lever = Some(Lever { rotation: body.rotation, arm });
                Hold { nodes: FaceNodes::single(body.reference), weights, lever }
            }
        }
    }

    /// Size of the surface at an anchor: that of the face, or of the profile's segment [length].
    pub fn size(&self, anchor: &Anchor) -> f64 {
        match self {
            Self::Faces(_, surface) => surface.size(anchor.face),
            Self::Analytical(surface) => surface.size(anchor),
        }
    }

    /// Area of the face at an anchor, from the Jacobian there \[length²\]; none on analytical surfaces.
    pub fn area_at(&self, anchor: &Anchor) -> Option<f64> {
        match self {
            Self::Faces(_, surface) => Some(surface.area_at(anchor)),
            Self::Analytical(_) => None,
        }
    }

    /// Length over which the normal of an anchor holds: the size of its face; of an analytical surface `length`, of a plane no end.
    pub fn reach(&self, anchor: &Anchor, length: f64) -> f64 {
        match self {
            Self::Faces(_, surface) => surface.size(anchor.face),
            Self::Analytical(surface) if surface.is_plane(anchor) => f64::INFINITY,
            Self::Analytical(_) => length,
        }
    }

    /// Stiffness under an anchor [pressure/length], and as a force per length; none on rigid surfaces.
    pub fn stiffness(&self, underlying: &Underlying<'_>, anchor: &Anchor) -> Option<(f64, f64)> {
        match self {
            Self::Faces(faces, _) => {
                let face = faces[anchor.face as usize];
                Some((underlying.of_face(face)?, underlying.force_of_face(face)?))
            }
            Self::Analytical(_) => None,
        }
    }
}
