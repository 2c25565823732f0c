//! Contact points of one side of a pair: the nodes of a secondary surface against a primary one.
//!
//! A balanced pair of Abaqus/Explicit has two sides, with the roles of its surfaces exchanged; each has its share of the areas.

use super::adjust;
use super::points::{ContactPoint, direction, tangents};
use super::primary::{Hold, Primary};
use super::search::{Anchor, Query};
use super::secondary::{self, Secondaries};
use super::underlying::Underlying;
use crate::diagnostic::Diagnostic;
use crate::element::quad::dot;
use crate::model::{FACE_NODES_MAX, Model, NodeId, SurfacePair};

/// Overlap at the start, in face sizes, beyond which the analyst should look at the geometry (HCRIT: half a face).
const OVERLAP_MAX: f64 = 0.5;

/// A side of a pair.
pub struct Side {
    /// Index of the pair.
    pair: u32,
    /// Surfaces in their roles.
    surfaces: SurfacePair,
    /// Clearances of the pair, by nodes of its first surface.
    given: Vec<(NodeId, f64)>,
    share: f64,
    mirrored: bool,
    /// Whether overclosures of the geometry are none: Abaqus/Explicit moves the nodes without strain before its first step.
    starts_closed: bool,
}

impl Side {
    /// Sides of a pair; `share`: weight of the one that has the surfaces in the order of the deck.
    pub fn of_pair(model: &Model, pair: u32, surfaces: &SurfacePair, share: f64) -> impl Iterator<Item = Self> + use<> {
        let first_step = model.steps.first().is_some_and(|step| step.contact.is_active(pair as usize));
        let side = |surfaces: SurfacePair, given: &[(NodeId, f64)], share, mirrored| Self {
            pair,
            surfaces,
            given: given.to_vec(),
            share,
            mirrored,
            starts_closed: model.is_explicit() && first_step && given.is_empty(),
        };
        let own = side(surfaces.clone(), &surfaces.clearances, share, false);
        let turned = SurfacePair {
            secondary: surfaces.primary,
            primary: surfaces.secondary,
            adjust: None,
            clearances: Vec::new(),
            ..surfaces.clone()
        };
        let other = side(turned, &surfaces.clearances, 1.0 - share, true);
        [own, other].into_iter().filter(|side| side.share > 0.0)
    }

    /// Clearance that the deck gives a node at an anchor.
    fn given_clearance(&self, node: NodeId, hold: &Hold) -> Option<f64> {
        let of = |node: NodeId| {
            let at = self.given.binary_search_by_key(&node, |&(node, _)| node).ok()?;
            Some(self.given[at].1)
        };
        if !self.mirrored {
            return of(node);
        }
        // The clearances of a mirrored side are those of the nodes it meets.
        let mut sum = 0.0;
        for (&node, weight) in hold.nodes.iter().zip(hold.weights) {
            sum += weight * of(node)?;
        }
        Some(sum)
    }

    /// Whether a node belongs to a rigid body.
    fn is_rigid(model: &Model, node: NodeId) -> bool {
        model.rigid_bodies.iter().any(|b| b.reference == node || b.nodes.binary_search(&node).is_ok())
    }

    /// Finds the points.
    ///
    /// A node with one anchor carries its whole tributary area. A node in a corner carries against each anchor what its faces show in
    /// that direction: the component of its area vector.
    pub fn find(&self, underlying: &Underlying<'_>, points: &mut Vec<ContactPoint>, warnings: &mut Vec<Diagnostic>) {
        let (model, surfaces) = (underlying.model, &self.surfaces);
        let (mesh, pair) = (&model.mesh, &model.pairs[self.pair as usize]);
        let kind = &mesh.surfaces[surfaces.primary.index()].kind;
        let primary = Primary::new(mesh, kind, &mesh.analytical);
        let stiffness = secondary::Stiffness::new(underlying, surfaces.secondary);
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
            for (i, anchor) in anchors.into_iter().enumerate() {
                let hold = primary.hold(mesh, &model.rigid_bodies, &anchor);
                // ADJUST has moved the node; what is left is rounding, or a primary surface that moved behind it.
                let adjusted = surfaces.adjust.is_some_and(|a| adjust::applies(mesh, a.region, node, &anchor, i == 0));
                let geometric = if adjusted { 0.0 } else { anchor.clearance };
                let given = self.given_clearance(node, &hold);
                let face_size = primary.reach(&anchor, length);
                let critical = if face_size.is_finite() { face_size } else { length };
                if given.unwrap_or(geometric) < -surfaces.hcrit.unwrap_or(OVERLAP_MAX * critical) {
                    deep.push(label);
                }
                let moved = self.starts_closed && geometric < 0.0 && !Self::is_rigid(model, node);
                let clearance = given.unwrap_or(if moved { 0.0 } else { geometric });
                let bare = bare.binary_search(&node).is_ok();
                let under = if bare { primary.area_at(&anchor) } else { None };
                if bare && under.is_none() && unknown.last() != Some(&label) {
                    unknown.push(label);
                }
                let area = under.unwrap_or(area);
                let shown = vector.filter(|_| several).map(|v| dot(v, anchor.normal).abs());
                let area = shown.unwrap_or(area);
                let under = stiffness.with(node, anchor.normal, area, primary.stiffness(underlying, &anchor));
                let place = Place { face_size, length, underlying: under };
                points.push(self.point(node, self.share * area, clearance, &anchor, hold, place));
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
        // Of a surface that goes on beyond the other, the second side of a balanced pair says nothing new.
        if !self.mirrored {
            warn(
                &lost,
                "have no face of the primary surface opposite them and take no part in contact",
                "extend the primary surface if these nodes should be in contact",
            );
        }
        let what = match surfaces.hcrit {
            Some(_) => "start more than HCRIT inside the primary surface",
            None => "start more than half a face inside the primary surface",
        };
        let remedy = match self.starts_closed {
            false => "check the geometry and the sides of the surfaces: contact will push these nodes out",
            true => "check the geometry and the sides of the surfaces: these nodes count as touching, without strain",
        };
        warn(&deep, what, remedy);
    }

    fn point(
        &self,
        node: NodeId,
        area: f64,
        clearance: f64,
        anchor: &Anchor,
        hold: Hold,
        place: Place,
    ) -> ContactPoint {
        let Hold { nodes, weights, lever } = hold;
        debug_assert!(nodes.len() <= FACE_NODES_MAX);
        ContactPoint {
            pair: self.pair,
            node,
            area,
            share: self.share,
            mirrored: self.mirrored,
            normal: anchor.normal,
            tangents: tangents(anchor.normal),
            primary: nodes,
            weights,
            lever,
            clearance,
            face_size: place.face_size,
            length: place.length,
            underlying: place.underlying,
        }
    }
}

/// What lies under and around an anchor.
struct Place {
    face_size: f64,
    length: f64,
    underlying: Option<f64>,
}
