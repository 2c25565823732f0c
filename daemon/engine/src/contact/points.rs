//! Contact points: each secondary node with its tributary area and its anchors on the primary surface.
//!
//! Small sliding: anchor, normal and tangents are those of the undeformed bodies. How anchors are found: `search.rs`.

use super::primary::Lever;
use super::side::Side;
use super::underlying::Underlying;
use super::{gap_points, general};
use crate::diagnostic::Diagnostic;
use crate::element::quad::{cross, dot, norm};
use crate::model::{FACE_NODES_MAX, FaceNodes, Model, NodeId, PairMembers};

/// Component of a unit vector or shape function that is rounding: left in, it would give a row of prescribed nodes a compliance.
const ENTRY_ROUNDING: f64 = 1e-14;

/// One node-to-surface constraint.
#[derive(Clone, Debug)]
pub struct ContactPoint {
    /// Index into `model.pairs`.
    pub pair: u32,
    /// Secondary node.
    pub node: NodeId,
    /// Tributary area [length²]: the share of it that the point has of the result.
    pub area: f64,
    /// 1, or the weight that the points of this side have in a balanced pair.
    pub share: f64,
    /// Whether the secondary node is on the surface that the pair names second.
    pub mirrored: bool,
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

/// Contact points of all pairs, pair by pair, by node, the mirrored ones of balanced pairs behind the others; and warnings about
/// secondary nodes that found no partner or start deep inside one.
pub fn find(model: &Model) -> (Vec<ContactPoint>, Vec<Diagnostic>) {
    let (mut points, mut warnings) = (Vec::new(), Vec::new());
    let underlying = Underlying::new(model);
    for (pair, index) in model.pairs.iter().zip(0u32..) {
        match &pair.members {
            PairMembers::Gaps(gaps) => points.extend(gap_points::points(&underlying, index, gaps)),
            PairMembers::General(members) => {
                points.extend(general::points(&underlying, index, members, pair.explicit.weight.0));
            }
            PairMembers::Surfaces(surfaces) => {
                let share = if model.is_explicit() { pair.explicit.weight.0 } else { 1.0 };
                for side in Side::of_pair(model, index, surfaces, share) {
                    side.find(&underlying, &mut points, &mut warnings);
                }
            }
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
