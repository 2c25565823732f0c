//! Contact points: each secondary node with its tributary area and its anchor on the primary surface.
//!
//! Small sliding: the anchor, the normal and the tangents are those of the undeformed bodies. The anchor is the
//! closest point of the primary surface that faces the secondary node; a node that hangs over the edge of the surface
//! by no more than EXTENSION ZONE of `*CONTACT PAIR` times the size of the face is taken along.

use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{PointDistance, RTree};
use rustc_hash::FxHashMap;

use crate::diagnostic::Diagnostic;
use crate::element::quad::{Projection, cross, dot, norm, sub};
use crate::element::{Coordinates, face};
use crate::model::{ElementFace, FACE_NODES_MAX, FaceNodes, Mesh, Model, NodeId, SurfaceKind};

/// One node-to-surface constraint.
#[derive(Clone, Debug)]
pub struct ContactPoint {
    /// Index into `model.pairs`.
    pub pair: u32,
    /// Secondary node.
    pub node: NodeId,
    /// Tributary area [length²].
    pub area: f64,
    /// Unit normal of the primary at the anchor, towards the secondary side.
    pub normal: [f64; 3],
    /// Unit tangents: the projection of the 1-axis (of the 3-axis where that is normal), and normal x first tangent.
    pub tangents: [[f64; 3]; 2],
    /// Nodes of the primary face.
    pub primary: FaceNodes,
    /// Shape functions of the face at the anchor; they add up to 1. Zero beyond the nodes of the face.
    pub weights: [f64; FACE_NODES_MAX],
    /// Initial clearance along the normal [length]; negative when the bodies overlap.
    pub clearance: f64,
    /// Size of the primary face: square root of its area [length].
    pub face_size: f64,
}

impl ContactPoint {
    /// Nodes that the constraint couples.
    pub fn nodes(&self) -> impl Iterator<Item = NodeId> + '_ {
        std::iter::once(self.node).chain(self.primary.iter().copied())
    }

    /// Entries of the row `v · (u_secondary − Σ N u_primary)`: calls `entry(node, direction, coefficient)`.
    ///
    /// With `v = −normal` the row gives the overclosure that displacements add, with a tangent the slip.
    pub fn row(&self, v: [f64; 3], mut entry: impl FnMut(NodeId, usize, f64)) {
        for (direction, component) in v.into_iter().enumerate().filter(|(_, c)| *c != 0.0) {
            entry(self.node, direction, component);
            for (&node, &weight) in self.primary.iter().zip(&self.weights) {
                if weight != 0.0 {
                    entry(node, direction, -weight * component);
                }
            }
        }
    }
}

/// Axis-aligned box of a primary face with the position of the face in the surface.
type Box3 = GeomWithData<Rectangle<[f64; 3]>, u32>;

struct Primary {
    faces: Vec<ElementFace>,
    coordinates: Vec<Coordinates>,
    sizes: Vec<f64>,
    tree: RTree<Box3>,
}

impl Primary {
    fn new(mesh: &Mesh, faces: &[ElementFace]) -> Self {
        let coordinates: Vec<_> =
            faces.iter().map(|&f| Coordinates::of(mesh.face_nodes(f).iter().map(|n| mesh.nodes[n.index()]))).collect();
        let sizes = coordinates.iter().map(|c| face::nodal_areas(c).iter().sum::<f64>().sqrt()).collect();
        let boxes = coordinates
            .iter()
            .zip(0u32..)
            .map(|(c, index)| {
                let bound = |pick: fn(f64, f64) -> f64| {
                    c.iter().skip(1).fold(c[0], |b, x| std::array::from_fn(|i| pick(b[i], x[i])))
                };
                let (mut low, mut high) = (bound(f64::min), bound(f64::max));
                // A curved face reaches out of the box of its nodes.
                let bulge = face::bulge(c.len());
                for (l, h) in low.iter_mut().zip(&mut high).filter(|_| bulge > 0.0) {
                    let reach = bulge * (*h - *l);
                    (*l, *h) = (*l - reach, *h + reach);
                }
                GeomWithData::new(Rectangle::from_corners(low, high), index)
            })
            .collect();
        Self { faces: faces.to_vec(), coordinates, sizes, tree: RTree::bulk_load(boxes) }
    }

    /// Anchor of a secondary node: the nearest face that faces it, with the normals of equally near faces averaged.
    fn anchor(
        &self,
        mesh: &Mesh,
        node: NodeId,
        facing: Option<[f64; 3]>,
        extension_zone: f64,
    ) -> Option<(u32, Projection)> {
        let position = mesh.nodes[node.index()];
        let mut found: Vec<(u32, Projection)> = Vec::new();
        let mut nearest = f64::INFINITY;
        for candidate in self.tree.nearest_neighbor_iter(position) {
            // A tie is decided within a hair of the face size, so that a foot on a shared edge sees both faces.
            let index = candidate.data as usize;
            let hair = 1e-9 * self.sizes[index];
            if candidate.distance_2(&position).sqrt() > nearest + hair {
                break;
            }
            if mesh.face_nodes(self.faces[index]).contains(&node) {
                continue;
            }
            let Some(projection) = face::project(&self.coordinates[index], position) else { continue };
            let averted = facing.is_some_and(|outward| dot(outward, projection.normal) >= 0.0);
            if averted || projection.overhang > extension_zone * self.sizes[index] + hair {
                continue;
            }
            nearest = nearest.min(projection.distance);
            found.push((candidate.data, projection));
        }
        found.retain(|(face, p)| p.distance <= nearest + 1e-9 * self.sizes[*face as usize]);
        found.sort_by_key(|&(face, _)| face);
        let sum = found.iter().fold([0.0; 3], |s, (_, p)| std::array::from_fn(|i| s[i] + p.normal[i]));
        let (face, mut projection) = found.into_iter().next()?;
        let length = norm(sum);
        if length > 0.0 {
            projection.normal = sum.map(|x| x / length);
        }
        Some((face, projection))
    }
}

/// Secondary nodes of a surface with area and outward normal (none for a node-based surface), by node.
fn secondary_nodes(mesh: &Mesh, kind: &SurfaceKind, node_area: f64) -> Vec<(NodeId, f64, Option<[f64; 3]>)> {
    match kind {
        SurfaceKind::Nodes(nodes) => nodes.iter().map(|&n| (n, node_area, None)).collect(),
        SurfaceKind::Faces(faces) => {
            let mut sums: FxHashMap<NodeId, (f64, [f64; 3])> = FxHashMap::default();
            for &element_face in faces {
                let nodes = mesh.face_nodes(element_face);
                let coordinates = Coordinates::of(nodes.iter().map(|n| mesh.nodes[n.index()]));
                let (areas, vectors) = (face::nodal_areas(&coordinates), face::nodal_area_vectors(&coordinates));
                for ((&node, area), vector) in nodes.iter().zip(areas).zip(vectors) {
                    let entry = sums.entry(node).or_default();
                    entry.0 += area;
                    for (sum, v) in entry.1.iter_mut().zip(vector) {
                        *sum += v;
                    }
                }
            }
            let mut all: Vec<_> = sums.into_iter().map(|(n, (area, vector))| (n, area, Some(vector))).collect();
            all.sort_by_key(|&(n, ..)| n);
            all
        }
    }
}

fn tangents(normal: [f64; 3]) -> [[f64; 3]; 2] {
    // Within 0.1 degree of the normal the 1-axis has no usable projection: take the 3-axis.
    let axis = if normal[0].abs() > 0.1f64.to_radians().cos() { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
    let along = dot(axis, normal);
    let raw: [f64; 3] = std::array::from_fn(|i| axis[i] - along * normal[i]);
    let length = norm(raw);
    let first = raw.map(|x| x / length);
    [first, cross(normal, first)]
}

/// Contact points of all pairs, pair by pair, by node; and warnings about secondary nodes that found no partner.
pub fn find(model: &Model) -> (Vec<ContactPoint>, Vec<Diagnostic>) {
    let mesh = &model.mesh;
    let (mut points, mut warnings) = (Vec::new(), Vec::new());
    for (pair, index) in model.pairs.iter().zip(0u32..) {
        let SurfaceKind::Faces(faces) = &mesh.surfaces[pair.primary.index()].kind else {
            unreachable!("the deck reader admits element-based primary surfaces only")
        };
        let primary = Primary::new(mesh, faces);
        let node_area = model.interactions[pair.interaction.index()].node_area;
        let secondaries = secondary_nodes(mesh, &mesh.surfaces[pair.secondary.index()].kind, node_area);
        let total = secondaries.len();
        let mut lost = Vec::new();
        for (node, area, outward) in secondaries {
            let Some((found, p)) = primary.anchor(mesh, node, outward, pair.extension_zone) else {
                lost.push(mesh.node_labels[node.index()]);
                continue;
            };
            points.push(ContactPoint {
                pair: index,
                node,
                area,
                normal: p.normal,
                tangents: tangents(p.normal),
                primary: mesh.face_nodes(primary.faces[found as usize]),
                weights: face::shape(primary.coordinates[found as usize].len(), p.natural),
                clearance: dot(p.normal, sub(mesh.nodes[node.index()], p.foot)),
                face_size: primary.sizes[found as usize],
            });
        }
        if !lost.is_empty() {
            let shown: Vec<String> = lost.iter().take(8).map(u32::to_string).collect();
            let more = if lost.len() > 8 { ", …" } else { "" };
            warnings.push(Diagnostic::warning(
                pair.place.clone(),
                "*CONTACT PAIR",
                format!(
                    "pair {}: {} of {total} secondary nodes have no face of the primary surface opposite them and can never touch: {}{more}",
                    pair.name,
                    lost.len(),
                    shown.join(", ")
                ),
                "extend the primary surface if these nodes should be in contact",
            ));
        }
    }
    (points, warnings)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tangents_are_an_orthonormal_frame_for_any_normal() {
        for raw in [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [-1.0, 1e-5, 0.0], [0.3, -0.8, 0.5]] {
            let length = norm(raw);
            let n = raw.map(|x| x / length);
            let [t, s] = tangents(n);
            for (value, expected) in
                [(dot(t, t), 1.0), (dot(s, s), 1.0), (dot(t, s), 0.0), (dot(t, n), 0.0), (dot(s, n), 0.0)]
            {
                assert!((value - expected).abs() < 1e-12);
            }
        }
        assert_eq!(tangents([0.0, 0.0, 1.0])[0], [1.0, 0.0, 0.0]);
    }
}
