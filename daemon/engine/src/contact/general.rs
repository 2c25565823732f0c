//! Contact points of general contact: nodes of outer faces against the faces of other bodies.
//!
//! A body is what elements and rigid bodies connect. A node meets the nearest face of another body that its own side looks at, and, as
//! in a pair, further ones only in clearly different directions. Both ways count half, so that the two sides are treated alike.

use rustc_hash::FxHashMap;

use super::points::{ContactPoint, direction, tangents};
use super::primary::Hold;
use super::search::{Anchor, DIRECTION_COSINE, PrimarySurface, Query, TOUCHING};
use super::secondary;
use super::underlying::Underlying;
use crate::element::quad::dot;
use crate::model::{ElementFace, GeneralContact, Mesh, Model, NodeId, SurfaceId, SurfaceKind};

/// Part of a face by which a node may hang over the rim of a body's surface.
const EXTENSION: f64 = 0.1;
/// Further anchors are looked for within this many face sizes beyond the nearest: sliding is small.
const REACH: f64 = 2.0;

/// Body of each node: the lowest node that elements and rigid bodies connect it with.
fn bodies(model: &Model) -> Vec<u32> {
    let mut parent: Vec<u32> = (0..model.mesh.nodes.len() as u32).collect();
    fn root(parent: &mut [u32], mut i: u32) -> u32 {
        while parent[i as usize] != i {
            parent[i as usize] = parent[parent[i as usize] as usize];
            i = parent[i as usize];
        }
        i
    }
    let mut join = |nodes: &mut dyn Iterator<Item = NodeId>| {
        let mut first = None;
        for node in nodes {
            let (a, b) = (root(&mut parent, *first.get_or_insert(node.0)), root(&mut parent, node.0));
            parent[a.max(b) as usize] = a.min(b);
        }
    };
    for (kind, nodes) in model.mesh.elements.iter().filter(|(kind, _)| kind.is_solid() || kind.is_facet()) {
        debug_assert!(kind.node_count() == nodes.len());
        join(&mut nodes.iter().copied());
    }
    for body in &model.rigid_bodies {
        join(&mut body.nodes.iter().copied().chain([body.reference]));
    }
    (0..parent.len() as u32).map(|i| root(&mut parent, i)).collect()
}

/// Faces of a body, ready to be searched.
struct Part {
    body: u32,
    faces: Vec<ElementFace>,
    surface: PrimarySurface,
}

/// Surface membership of nodes and faces, for exclusions.
struct Exclusions<'a> {
    mesh: &'a Mesh,
    couples: &'a [[SurfaceId; 2]],
}

impl Exclusions<'_> {
    fn faces(&self, surface: SurfaceId) -> &[ElementFace] {
        match &self.mesh.surfaces[surface.index()].kind {
            SurfaceKind::Faces(faces) => faces,
            _ => &[],
        }
    }

    fn has_node(&self, surface: SurfaceId, node: NodeId) -> bool {
        self.faces(surface).iter().any(|&f| self.mesh.face_nodes(f).contains(&node))
    }

    /// Couples that a node is on one side of, by the surface of the other.
    fn of_node(&self, node: NodeId) -> Vec<SurfaceId> {
        let mut out = Vec::new();
        for &[a, b] in self.couples {
            if self.has_node(a, node) {
                out.push(b);
            }
            if self.has_node(b, node) {
                out.push(a);
            }
        }
        out
    }

    fn excludes(&self, others: &[SurfaceId], face: ElementFace) -> bool {
        others.iter().any(|&surface| self.faces(surface).binary_search(&face).is_ok())
    }
}

/// Faces of a surface by body, in the order of their lowest nodes.
fn parts(mesh: &Mesh, surface: SurfaceId, bodies: &[u32]) -> Vec<Part> {
    let SurfaceKind::Faces(faces) = &mesh.surfaces[surface.index()].kind else { return Vec::new() };
    let mut of_body: FxHashMap<u32, Vec<ElementFace>> = FxHashMap::default();
    for &face in faces {
        let body = bodies[mesh.face_nodes(face)[0].index()];
        of_body.entry(body).or_default().push(face);
    }
    let mut all: Vec<_> = of_body.into_iter().collect();
    all.sort_by_key(|&(body, _)| body);
    all.into_iter().map(|(body, faces)| Part { body, surface: PrimarySurface::new(mesh, &faces), faces }).collect()
}

/// Points of a part of general contact; `weight`: share of the nodes of the first surface.
pub fn points(underlying: &Underlying<'_>, pair: u32, members: &GeneralContact, weight: f64) -> Vec<ContactPoint> {
    let model = underlying.model;
    let bodies = bodies(model);
    let [first, second] = members.surfaces;
    let exclusions = Exclusions { mesh: &model.mesh, couples: &members.excluded };
    let ways = match first == second {
        true => vec![(first, second, 0.5, false)],
        false => vec![(first, second, weight, false), (second, first, 1.0 - weight, true)],
    };
    let mut out = Vec::new();
    for (nodes, faces, share, mirrored) in ways.into_iter().filter(|way| way.2 > 0.0) {
        let parts = parts(&model.mesh, faces, &bodies);
        let stiffness = secondary::Stiffness::new(underlying, nodes);
        let kind = &model.mesh.surfaces[nodes.index()].kind;
        for (node, area, vector) in secondary::nodes(&model.mesh, kind, 1.0) {
            let Some(vector) = vector else { continue };
            let anchors = anchors(&model.mesh, &parts, bodies[node.index()], node, vector, &exclusions);
            let several = anchors.len() > 1;
            for (part, anchor) in anchors {
                let area = if several { dot(vector, anchor.normal).abs() } else { area };
                let face = parts[part].faces[anchor.face as usize];
                let under = underlying.of_face(face).zip(underlying.force_of_face(face));
                let surface = &parts[part].surface;
                let hold =
                    Hold { nodes: surface.face_nodes(anchor.face), weights: surface.weights(&anchor), lever: None };
                out.push(ContactPoint {
                    pair,
                    node,
                    area: share * area,
                    share,
                    mirrored,
                    normal: anchor.normal,
                    tangents: tangents(anchor.normal),
                    primary: hold.nodes,
                    weights: hold.weights,
                    lever: None,
                    // Overclosures at the start are none, without strain.
                    clearance: anchor.clearance.max(0.0),
                    face_size: surface.size(anchor.face),
                    length: surface.size(anchor.face),
                    underlying: stiffness.with(node, anchor.normal, area, under),
                });
            }
        }
    }
    out
}

/// Anchors of a node on the faces of other bodies, the nearest first.
fn anchors(
    mesh: &Mesh,
    parts: &[Part],
    body: u32,
    node: NodeId,
    vector: [f64; 3],
    exclusions: &Exclusions<'_>,
) -> Vec<(usize, Anchor)> {
    let query = Query { node, outward: Some(direction(vector)), extension_zone: EXTENSION };
    let others = exclusions.of_node(node);
    let mut found: Vec<(usize, Anchor)> = Vec::new();
    for (index, part) in parts.iter().enumerate().filter(|(_, part)| part.body != body) {
        let here = part.surface.anchors(mesh, query).into_iter();
        let allowed = here.filter(|a| !exclusions.excludes(&others, part.faces[a.face as usize]));
        found.extend(allowed.map(|anchor| (index, anchor)));
    }
    found.sort_by(|a, b| a.1.distance.total_cmp(&b.1.distance).then(a.0.cmp(&b.0)));
    let mut kept: Vec<(usize, Anchor)> = Vec::new();
    for (part, anchor) in found {
        let size = parts[part].surface.size(anchor.face);
        let Some((_, nearest)) = kept.first() else {
            kept.push((part, anchor));
            continue;
        };
        let overlap = 2.0 * (-nearest.clearance).max(0.0) + TOUCHING * size;
        let apart = kept.iter().all(|(_, k)| dot(k.normal, anchor.normal) < DIRECTION_COSINE);
        if apart && anchor.clearance >= -overlap && anchor.distance <= nearest.distance + REACH * size {
            kept.push((part, anchor));
        }
    }
    kept
}
