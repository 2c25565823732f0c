//! Contact points of GAP elements.
//!
//! ```text
//! GAPUNI              c = d + n · (u2 − u1)
//! GAPCYL, GAPSPHER    c = d − ρ      d > 0: the nodes come no farther apart than d
//!                     c = ρ − |d|    d < 0: the nodes come no nearer than |d|
//! ```
//!
//! `ρ` is the distance of the nodes, for GAPCYL normal to the axis. Displacements are small, so the direction of `ρ` is that of
//! the start: `ρ = ρ0 + e · (u2 − u1)`. The secondary node is node 2, the primary one node 1.

use super::points::{ContactPoint, tangents};
use super::underlying::{Underlying, in_series};
use crate::element::quad::{dot, norm, sub};
use crate::model::{FACE_NODES_MAX, FaceNodes, GapElement, GapKind, Mesh};

/// A gap before anything moves.
struct Geometry {
    normal: [f64; 3],
    clearance: f64,
    /// Distance over which the direction holds: that of the nodes, without end where the direction is fixed.
    reach: f64,
}

fn geometry(mesh: &Mesh, gap: &GapElement) -> Geometry {
    let [first, second] = gap.nodes.map(|n| mesh.nodes[n.index()]);
    let between = sub(second, first);
    let across = match gap.kind {
        GapKind::Unidirectional(normal) => {
            return Geometry { normal, clearance: gap.distance, reach: f64::INFINITY };
        }
        GapKind::Cylindrical(axis) => {
            let along = dot(between, axis);
            std::array::from_fn(|i| between[i] - along * axis[i])
        }
        GapKind::Spherical => between,
    };
    let distance = norm(across);
    let outward = across.map(|x| x / distance);
    let (normal, clearance) = if gap.distance > 0.0 {
        (outward.map(|x| -x), gap.distance - distance)
    } else {
        (outward, distance + gap.distance)
    };
    Geometry { normal, clearance, reach: distance }
}

/// Length of a gap: the distance of its nodes, where they coincide its opening, else 1.
fn length(mesh: &Mesh, gap: &GapElement) -> f64 {
    let [first, second] = gap.nodes.map(|n| mesh.nodes[n.index()]);
    [norm(sub(second, first)), gap.distance.abs()].into_iter().find(|&l| l > 0.0).unwrap_or(1.0)
}

/// Contact points of the elements of a pair, in their order.
pub fn points(underlying: &Underlying<'_>, pair: u32, gaps: &[GapElement]) -> Vec<ContactPoint> {
    let mesh = &underlying.model.mesh;
    let mean = gaps.iter().map(|gap| length(mesh, gap)).sum::<f64>() / gaps.len() as f64;
    let point = |gap: &GapElement| {
        let Geometry { normal, clearance, reach } = geometry(mesh, gap);
        let [primary, secondary] = gap.nodes;
        let side = |node, outward| {
            let solids = underlying.of_node(node, outward);
            let connectors = underlying.of_connectors(node, normal);
            let force = if solids.is_none() { connectors } else { solids.map(|k| k + connectors.unwrap_or(0.0)) };
            force.map(|k| k / gap.area)
        };
        let mut weights = [0.0; FACE_NODES_MAX];
        weights[0] = 1.0;
        ContactPoint {
            pair,
            node: secondary,
            area: gap.area,
            share: 1.0,
            mirrored: false,
            normal,
            tangents: tangents(normal),
            primary: FaceNodes::single(primary),
            weights,
            lever: None,
            clearance,
            face_size: reach,
            length: mean,
            underlying: in_series(side(secondary, normal.map(|x| -x)), side(primary, normal)),
        }
    };
    gaps.iter().map(point).collect()
}
