//! Contact points: each secondary node with its tributary area and its anchors on the primary surface.
//!
//! Small sliding: anchor, normal and tangents are those of the undeformed bodies. How anchors are found: `search.rs`.

use super::primary::{Hold, Lever, Primary};
use super::search::Query;
use super::secondary::Secondaries;
use super::underlying::Underlying;
use super::{adjust, gap_points, secondary};
use crate::diagnostic::Diagnostic;
use crate::element::quad::{cross, dot, norm};
use crate::model::{FACE_NODES_MAX, FaceNodes, Model, NodeId, PairMembers};

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
    /// Lever about the reference node of an analytical surface, which is then the only primary node.
    pub lever: Option<Lever>,
    /// Initial clearance along the normal [length]; negative when the bodies overlap.
    pub clearance: f64,
    /// Size of the primary face: square root of its area [length]. Of a gap or an analytical surface the length over which its
    /// direction holds.
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
        // u_primary = u_reference + θ × r, so that v · (θ × r) = θ · (r × v). All three, so that the nodes of a row do not depend
        // on v.
        if let Some(Lever { rotation, arm }) = self.lever {
            for (direction, component) in cross(arm, v).into_iter().enumerate() {
                entry(rotation, direction, -component);
            }
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
            // Its points are found by general contact itself.
            PairMembers::General(_) => continue,
            PairMembers::Gaps(gaps) => {
                points.extend(gap_points::points(&underlying, index, gaps));
                continue;
            }
        };
        let kind = &mesh.surfaces[surfaces.primary.index()].kind;
        let primary = Primary::new(mesh, kind, &mesh.analytical);
        let stiffness = secondary::Stiffness::new(&underlying, surfaces.secondary);
        let length = secondary::characteristic_length(model, surfaces);
        let Secondaries { all: secondaries, mut unknown, bare } = secondary::of_pair(model, pair.interaction, surfaces);
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
            let given = surfaces.clearances.binary_search_by_key(&node, |&(node, _)| node);
            for (i, anchor) in anchors.into_iter().enumerate() {
                // ADJUST has moved the node; what is left is rounding, or a primary surface that moved behind it.
                let adjusted = surfaces.adjust.is_some_and(|a| adjust::applies(mesh, a.region, node, &anchor, i == 0));
                let clearance = match given {
                    Ok(at) => surfaces.clearances[at].1,
                    Err(_) if adjusted => 0.0,
                    Err(_) => anchor.clearance,
                };
                let face_size = primary.reach(&anchor, length);
                let critical = if face_size.is_finite() { face_size } else { length };
                if clearance < -surfaces.hcrit.unwrap_or(OVERLAP_MAX * critical) {
                    deep.push(label);
                }
                let bare = bare.binary_search(&node).is_ok();
                let under = if bare { primary.area_at(&anchor) } else { None };
                if bare && under.is_none() && unknown.last() != Some(&label) {
                    unknown.push(label);
                }
                let area = under.unwrap_or(area);
                let shown = vector.filter(|_| several).map(|v| dot(v, anchor.normal).abs());
                let area = shown.unwrap_or(area);
                let Hold { nodes, weights, lever } = primary.hold(mesh, &model.rigid_bodies, &anchor);
                points.push(ContactPoint {
                    pair: index,
                    node,
                    area,
                    normal: anchor.normal,
                    tangents: tangents(anchor.normal),
                    primary: nodes,
                    weights,
                    lever,
                    clearance,
                    face_size,
                    length,
                    underlying: stiffness.with(node, anchor.normal, area, primary.stiffness(&underlying, &anchor)),
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
            "have midside nodes on their outer faces, or are on no solid and meet an analytical surface: CalculiX takes the area of a node from faces without, and these stand for 1",
            "give the area on the data line of *SURFACE INTERACTION",
        );
        warn(
            &lost,
            "have no face of the primary surface opposite them and take no part in contact",
            "extend the primary surface if these nodes should be in contact",
        );
        warn(
            &deep,
            match surfaces.hcrit {
                Some(_) => "start more than HCRIT inside the primary surface",
                None => "start more than half a face inside the primary surface",
            },
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
