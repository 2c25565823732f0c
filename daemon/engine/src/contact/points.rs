//! Contact points: each secondary node with its tributary area and its anchors on the primary surface.
//!
//! Small sliding: anchor, normal and tangents are those of the undeformed bodies. How anchors are found: `search.rs`.

use rustc_hash::FxHashMap;

use super::search::{PrimarySurface, Query};
use super::underlying::{self, Underlying};
use super::{adjust, gap_points, node_areas};
use crate::diagnostic::Diagnostic;
use crate::element::quad::{cross, dot, norm};
use crate::element::{Coordinates, face};
use crate::model::{
    Dialect, ElementFace, FACE_NODES_MAX, FaceNodes, InteractionId, Mesh, Model, NodeId, PairMembers, SurfaceId,
    SurfaceKind, SurfacePair,
};

/// Overlap at the start, in face sizes, beyond which the analyst should look at the geometry (HCRIT: half a face).
const OVERLAP_MAX: f64 = 0.5;

/// Component of a unit vector or shape function that is rounding: left in, it would give a row of prescribed nodes a compliance.
const ENTRY_ROUNDING: f64 = 1e-14;

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
    /// Size of the primary face: square root of its area [length]. Of a gap the distance over which its direction holds.
    pub face_size: f64,
    /// Characteristic length of the interface \[length\]: tolerances and automatic stiffnesses are parts of it.
    pub length: f64,
    /// Stiffness of the elements underneath, both sides in series \[pressure/length\]; none where neither side has any.
    pub underlying: Option<f64>,
}

impl ContactPoint {
    /// Entries of the row `v · (u_secondary − Σ N u_primary)`: calls `entry(node, direction, coefficient)`.
    ///
    /// With `v = −normal` the row gives the overclosure that displacements add, with a tangent the slip.
    pub fn row(&self, v: [f64; 3], mut entry: impl FnMut(NodeId, usize, f64)) {
        for (direction, component) in v.into_iter().enumerate().filter(|(_, c)| c.abs() > ENTRY_ROUNDING) {
            entry(self.node, direction, component);
            for (&node, &weight) in self.primary.iter().zip(&self.weights) {
                if weight.abs() > ENTRY_ROUNDING {
                    entry(node, direction, -weight * component);
                }
            }
        }
    }
}

/// Secondary nodes of a surface with area and outward normal (none for a node-based surface), by node.
pub(super) fn secondary_nodes(mesh: &Mesh, kind: &SurfaceKind, node_area: f64) -> Vec<Secondary> {
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

/// Unit vector.
pub fn direction(v: [f64; 3]) -> [f64; 3] {
    let length = norm(v);
    v.map(|x| x / length)
}

/// First the projection of the 1-axis (of the 3-axis where that is the normal), then the normal times it.
pub(super) fn tangents(normal: [f64; 3]) -> [[f64; 3]; 2] {
    // Within 0.1 degree of the normal the 1-axis has no usable projection: take the 3-axis.
    let axis = if normal[0].abs() > 0.1f64.to_radians().cos() { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
    let along = dot(axis, normal);
    let raw: [f64; 3] = std::array::from_fn(|i| axis[i] - along * normal[i]);
    let length = norm(raw);
    let first = raw.map(|x| x / length);
    [first, cross(normal, first)]
}

/// A secondary node, its area, and its area vector where it belongs to faces.
type Secondary = (NodeId, f64, Option<[f64; 3]>);

/// Secondary nodes of a pair with their areas as the dialect has them, and the labels of those whose area it leaves open.
fn secondaries_of(model: &Model, interaction: InteractionId, pair: &SurfacePair) -> (Vec<Secondary>, Vec<u32>) {
    let mesh = &model.mesh;
    let kind = &mesh.surfaces[pair.secondary.index()].kind;
    let given = model.interactions[interaction.index()].node_area;
    let mut secondaries = secondary_nodes(mesh, kind, given.unwrap_or(1.0));
    let mut unknown = Vec::new();
    if let (SurfaceKind::Nodes(nodes), None, Dialect::Calculix) = (kind, given, model.dialect) {
        for ((node, area, _), share) in secondaries.iter_mut().zip(node_areas::of_outer_faces(mesh, nodes)) {
            match share {
                Some(share) => *area = share,
                None => unknown.push(mesh.node_labels[node.index()]),
            }
        }
    }
    (secondaries, unknown)
}

/// Stiffness under both sides of a pair.
struct Stiffness<'a> {
    underlying: &'a Underlying<'a>,
    /// Under the nodes of an element-based secondary surface; none for nodes.
    secondary: Option<FxHashMap<NodeId, f64>>,
    primary: &'a [ElementFace],
}

impl<'a> Stiffness<'a> {
    fn new(underlying: &'a Underlying<'a>, pair: &SurfacePair, primary: &'a [ElementFace]) -> Self {
        let secondary = match &underlying.model.mesh.surfaces[pair.secondary.index()].kind {
            SurfaceKind::Faces(faces) => Some(underlying.of_faces(faces)),
            SurfaceKind::Nodes(_) => None,
        };
        Self { underlying, secondary, primary }
    }

    /// At a point with a normal towards the secondary side, an area, and a position in the primary surface [pressure/length].
    fn at(&self, node: NodeId, normal: [f64; 3], area: f64, face: u32) -> Option<f64> {
        let face = self.primary[face as usize];
        let (solids, primary) = match &self.secondary {
            Some(nodes) => (nodes.get(&node).copied(), self.underlying.of_face(face)),
            None => {
                let share = |force: Option<f64>| force.map(|k| k / area);
                let solids = self.underlying.of_node(node, normal.map(|x| -x));
                (share(solids), share(self.underlying.force_of_face(face)))
            }
        };
        let connectors = self.underlying.of_connectors(node, normal).map(|k| k / area);
        let secondary = match (solids, connectors) {
            (Some(a), Some(b)) => Some(a + b),
            (only, None) | (None, only) => only,
        };
        underlying::in_series(secondary, primary)
    }
}

/// Characteristic length of an interface: the mean size of the faces of the secondary surface, of a node-based one those of the
/// primary surface [length].
fn characteristic_length(model: &Model, pair: &SurfacePair) -> f64 {
    let kind = |surface: SurfaceId| &model.mesh.surfaces[surface.index()].kind;
    let ((SurfaceKind::Faces(faces), _) | (_, SurfaceKind::Faces(faces))) = (kind(pair.secondary), kind(pair.primary))
    else {
        unreachable!("the deck reader admits element-based primary surfaces only")
    };
    faces.iter().map(|&face| underlying::face_area(model, face).sqrt()).sum::<f64>() / faces.len() as f64
}

/// Contact points of all pairs, pair by pair, by node; and warnings about secondary nodes that found no partner or start deep
/// inside one.
///
/// A node with one anchor carries its whole tributary area. A node in a corner carries against each anchor what its faces show in
/// that direction: the component of its area vector.
pub fn find(model: &Model) -> (Vec<ContactPoint>, Vec<Diagnostic>) {
    let mesh = &model.mesh;
    let (mut points, mut warnings) = (Vec::new(), Vec::new());
    let underlying = Underlying::new(model);
    for (pair, index) in model.pairs.iter().zip(0u32..) {
        let surfaces = match &pair.members {
            PairMembers::Surfaces(surfaces) => surfaces,
            PairMembers::Gaps(gaps) => {
                points.extend(gap_points::points(&underlying, index, gaps));
                continue;
            }
        };
        let SurfaceKind::Faces(faces) = &mesh.surfaces[surfaces.primary.index()].kind else {
            unreachable!("the deck reader admits element-based primary surfaces only")
        };
        let primary = PrimarySurface::new(mesh, faces);
        let stiffness = Stiffness::new(&underlying, surfaces, faces);
        let length = characteristic_length(model, surfaces);
        let (secondaries, unknown) = secondaries_of(model, pair.interaction, surfaces);
        let total = secondaries.len();
        let (mut lost, mut deep) = (Vec::new(), Vec::new());
        for (node, area, vector) in secondaries {
            let label = mesh.node_labels[node.index()];
            let outward = vector.map(direction);
            let anchors = primary.anchors(mesh, Query { node, outward, extension_zone: surfaces.extension_zone });
            if anchors.is_empty() {
                lost.push(label);
            }
            let several = anchors.len() > 1;
            for (i, anchor) in anchors.into_iter().enumerate() {
                let face_size = primary.size(anchor.face);
                // ADJUST has moved the node; what is left is rounding, or a primary surface that moved behind it.
                let adjusted = surfaces.adjust.is_some_and(|a| adjust::applies(mesh, a.region, node, &anchor, i == 0));
                let clearance = if adjusted { 0.0 } else { anchor.clearance };
                if clearance < -OVERLAP_MAX * face_size {
                    deep.push(label);
                }
                let shown = vector.filter(|_| several).map(|v| dot(v, anchor.normal).abs());
                let area = shown.unwrap_or(area);
                points.push(ContactPoint {
                    pair: index,
                    node,
                    area,
                    normal: anchor.normal,
                    tangents: tangents(anchor.normal),
                    primary: primary.face_nodes(anchor.face),
                    weights: primary.weights(&anchor),
                    clearance,
                    face_size,
                    length,
                    underlying: stiffness.at(node, anchor.normal, area, anchor.face),
                });
            }
        }
        let mut warn = |labels: &[u32], what: &str, remedy: &str| {
            if !labels.is_empty() {
                let shown: Vec<String> = labels.iter().take(8).map(u32::to_string).collect();
                let more = if labels.len() > 8 { ", …" } else { "" };
                let message = format!(
                    "pair {}: {} of {total} secondary nodes {what}: {}{more}",
                    pair.name,
                    labels.len(),
                    shown.join(", ")
                );
                warnings.push(Diagnostic::warning(pair.place.clone(), "*CONTACT PAIR", message, remedy));
            }
        };
        warn(
            &unknown,
            "have no outer faces without midside nodes, from which CalculiX takes the area of a node, and stand for 1",
            "give the area on the data line of *SURFACE INTERACTION",
        );
        warn(
            &lost,
            "have no face of the primary surface opposite them and take no part in contact",
            "extend the primary surface if these nodes should be in contact",
        );
        warn(
            &deep,
            "start more than half a face inside the primary surface",
            "check the geometry and the sides of the surfaces: contact will push these nodes out",
        );
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
