//! ADJUST of a contact pair: secondary nodes are moved onto the primary surface before anything is computed.
//!
//! As in Abaqus and CalculiX the coordinates change, along the normal of the primary, so the moved nodes carry neither strain nor
//! stress. A node in a corner is moved against each surface within the distance, by turns.

use super::primary::Primary;
use super::search::{Anchor, Query};
use super::secondary;
use crate::model::{AdjustRegion, Mesh, NodeId, SurfaceId, SurfacePair};

/// Turns of a node in a corner: at right angles two are enough, at 30 degrees each leaves three quarters of the rest.
const TURNS_MAX: usize = 100;
/// Part of a face within which a node is on the surface: above rounding, far below what a mesh resolves.
const ON_SURFACE: f64 = 1e-12;

/// Whether ADJUST moves a node onto an anchor, the nearest of the node or a further one.
pub fn applies(mesh: &Mesh, region: AdjustRegion, node: NodeId, anchor: &Anchor, nearest: bool) -> bool {
    match region {
        AdjustRegion::Within(distance) => anchor.clearance <= distance,
        AdjustRegion::Set(set) => nearest && mesh.node_sets[set.index()].nodes.binary_search(&node).is_ok(),
    }
}

/// Moves the nodes of a pair; returns those that moved, ascending, with the distance [length].
pub fn adjust(mesh: &mut Mesh, pair: &SurfacePair, region: AdjustRegion) -> Vec<(NodeId, f64)> {
    let surface = |surface: SurfaceId| mesh.surfaces[surface.index()].kind.clone();
    let (first, second, analytical) = (surface(pair.secondary), surface(pair.primary), mesh.analytical.clone());
    let primary = Primary::new(mesh, &second, &analytical);
    let mut moved = Vec::new();
    // Areas are not needed.
    for (node, _, vector) in secondary::nodes(mesh, &first, 1.0) {
        let query = Query { node, outward: vector.map(super::points::direction), extension_zone: pair.extension_zone };
        let start = mesh.nodes[node.index()];
        for _ in 0..TURNS_MAX {
            let anchors = primary.anchors(mesh, query);
            let wanted = anchors.iter().enumerate().filter(|(i, a)| applies(mesh, region, node, a, *i == 0));
            let Some((_, farthest)) = wanted.max_by(|a, b| a.1.clearance.abs().total_cmp(&b.1.clearance.abs())) else {
                break;
            };
            if farthest.clearance.abs() <= ON_SURFACE * primary.size(farthest) {
                break;
            }
            for (x, n) in mesh.nodes[node.index()].iter_mut().zip(farthest.normal) {
                *x -= farthest.clearance * n;
            }
        }
        let distance = mesh.nodes[node.index()].iter().zip(start).map(|(x, s)| (x - s).powi(2)).sum::<f64>().sqrt();
        if distance > 0.0 {
            moved.push((node, distance));
        }
    }
    moved
}
