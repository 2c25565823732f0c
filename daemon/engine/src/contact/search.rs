//! Anchors of a position on a primary surface: where a constraint takes hold, and in which direction.
//!
//! An anchor is a local minimum of the distance to the surface. The nearest one that the secondary side looks at always counts; a
//! further one only when it pushes in a clearly different direction (a floor and a wall), so that a node in a corner has a
//! constraint against each.
//!
//! The direction at an anchor inside a face is the normal of the face. On an edge or corner that faces share it is the line from
//! the anchor to the position, which lies between their normals: a node above a convex edge is as much above the surface as any
//! other, however far away. On the rim of the surface what hangs over the rim is taken out first, and the overhang is limited.

use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{PointDistance, RTree};
use rustc_hash::FxHashMap;

use crate::element::quad::{cross, dot, norm, sub};
use crate::element::{Coordinates, face};
use crate::model::{ElementFace, FaceNodes, Mesh, NodeId};

/// The secondary side looks at an anchor when their outward directions are more than about 93 degrees apart. At 90 degrees a side
/// wall would look at the floor it stands on, or not, as rounding decides.
pub(super) const FACING_COSINE: f64 = -0.05;
/// Further anchors differ in direction from each nearer one by more than 30 degrees: the facets of a curved surface do not.
pub(super) const DIRECTION_COSINE: f64 = 0.866;
/// Further anchors are looked for within this many face sizes beyond the nearest: sliding is small.
const REACH: f64 = 2.0;
/// Natural coordinates this close to the end of their range are on the edge.
const ON_EDGE: f64 = 1e-9;
/// Distances that differ by less than this part of a face are equal.
pub(super) const HAIR: f64 = 1e-9;
/// Below this part of a face the line from the anchor to the position has no direction of its own.
pub(super) const TOUCHING: f64 = 1e-6;

/// Where and in which direction a constraint takes hold.
#[derive(Clone, Copy, Debug)]
pub struct Anchor {
    /// Face, as a position in the surface.
    pub face: u32,
    /// Natural coordinates on it.
    pub natural: [f64; 2],
    /// Where it is [length].
    pub foot: [f64; 3],
    /// Unit normal of the primary, towards the secondary side.
    pub normal: [f64; 3],
    /// Clearance along the normal [length]; negative when the bodies overlap.
    pub clearance: f64,
    /// Distance of the position [length].
    pub(super) distance: f64,
}

/// What the search asks for at one secondary node.
#[derive(Clone, Copy, Debug)]
pub struct Query {
    /// The secondary node.
    pub node: NodeId,
    /// Unit outward direction of the secondary surface there; none for a node-based surface, which then has one anchor.
    pub outward: Option<[f64; 3]>,
    /// Part of a face by which the position may hang over the rim of the surface.
    pub extension_zone: f64,
}

/// A primary surface, ready to be searched.
pub struct PrimarySurface {
    nodes: Vec<FaceNodes>,
    coordinates: Vec<Coordinates>,
    sizes: Vec<f64>,
    /// Faces at each corner node.
    at_corner: FxHashMap<NodeId, Vec<u32>>,
    /// Number of faces at each edge, by its corner nodes.
    at_edge: FxHashMap<(NodeId, NodeId), u8>,
    tree: RTree<GeomWithData<Rectangle<[f64; 3]>, u32>>,
}

/// Part of the surface that shares a foot: the faces, and outward directions of the rim there.
struct Foot {
    faces: Vec<u32>,
    normal: [f64; 3],
    rims: Vec<[f64; 3]>,
}

impl PrimarySurface {
    /// Prepares the faces of a surface.
    pub fn new(mesh: &Mesh, faces: &[ElementFace]) -> Self {
        let nodes: Vec<FaceNodes> = faces.iter().map(|&f| mesh.face_nodes(f)).collect();
        let coordinates: Vec<Coordinates> =
            nodes.iter().map(|n| Coordinates::of(n.iter().map(|n| mesh.nodes[n.index()]))).collect();
        let sizes = coordinates.iter().map(|c| face::nodal_areas(c).iter().sum::<f64>().sqrt()).collect();
        let boxes = coordinates.iter().zip(0u32..).map(|(c, index)| GeomWithData::new(bounds(c), index)).collect();
        let (mut at_corner, mut at_edge) = (FxHashMap::<NodeId, Vec<u32>>::default(), FxHashMap::default());
        for (list, index) in nodes.iter().zip(0u32..) {
            let corners = face::corner_count(list.len());
            for k in 0..corners {
                at_corner.entry(list[k]).or_default().push(index);
                *at_edge.entry(edge_key(list, k)).or_insert(0) += 1;
            }
        }
        Self { nodes, coordinates, sizes, at_corner, at_edge, tree: RTree::bulk_load(boxes) }
    }

    /// Nodes of a face.
    pub fn face_nodes(&self, face: u32) -> FaceNodes {
        self.nodes[face as usize]
    }

    /// Shape functions of an anchor's face there.
    pub fn weights(&self, anchor: &Anchor) -> [f64; crate::model::FACE_NODES_MAX] {
        face::shape(self.coordinates[anchor.face as usize].len(), anchor.natural)
    }

    /// Size of a face: square root of its area [length].
    pub fn size(&self, face: u32) -> f64 {
        self.sizes[face as usize]
    }

    /// Area of an anchor's face by the Jacobian there \[length²\].
    pub fn area_at(&self, anchor: &Anchor) -> f64 {
        face::area_by(&self.coordinates[anchor.face as usize], anchor.natural)
    }

    /// Anchors of a secondary node: the nearest first.
    pub fn anchors(&self, mesh: &Mesh, query: Query) -> Vec<Anchor> {
        let position = mesh.nodes[query.node.index()];
        let mut found: Vec<Anchor> = Vec::new();
        let mut limit = f64::INFINITY;
        for candidate in self.tree.nearest_neighbor_iter(position) {
            let index = candidate.data;
            let size = self.size(index);
            if candidate.distance_2(&position).sqrt() > limit + HAIR * size {
                break;
            }
            let Some(anchor) = self.local_minimum(index, position, query) else { continue };
            let reach = if query.outward.is_some() { REACH * size } else { HAIR * size };
            limit = limit.min(anchor.distance + reach);
            found.push(anchor);
        }
        found.sort_by(|a, b| a.distance.total_cmp(&b.distance).then(a.face.cmp(&b.face)));
        let mut kept: Vec<Anchor> = Vec::new();
        for anchor in found {
            let Some(nearest) = kept.first() else {
                kept.push(anchor);
                continue;
            };
            // A position that overlaps one face a little is not meant to be far inside another.
            let overlap = 2.0 * (-nearest.clearance).max(0.0) + TOUCHING * self.size(anchor.face);
            let apart = kept.iter().all(|k| dot(k.normal, anchor.normal) < DIRECTION_COSINE);
            if query.outward.is_some() && apart && anchor.clearance >= -overlap {
                kept.push(anchor);
            }
        }
        kept
    }

    /// The anchor on a face, if its closest point is a local minimum of the distance to the whole surface, is not counted on
    /// an earlier face already, and the secondary side looks at it.
    fn local_minimum(&self, index: u32, position: [f64; 3], query: Query) -> Option<Anchor> {
        if self.nodes[index as usize].contains(&query.node) {
            return None;
        }
        let projection = face::project(&self.coordinates[index as usize], position)?;
        let size = self.size(index);
        let foot = self.foot(index, &projection, position)?;
        if foot.faces.first() != Some(&index) {
            return None;
        }
        let mut line = sub(position, projection.foot);
        let mut overhang = 0.0;
        for rim in &foot.rims {
            let over = dot(line, *rim);
            if over > 0.0 {
                overhang += over * over;
                line = std::array::from_fn(|i| line[i] - over * rim[i]);
            }
        }
        if f64::sqrt(overhang) > (query.extension_zone + HAIR) * size {
            return None;
        }
        let length = norm(line);
        let side = dot(line, foot.normal);
        let normal = if foot.faces.len() == 1 || length <= TOUCHING * size {
            foot.normal
        } else {
            line.map(|x| x / length.copysign(side))
        };
        if query.outward.is_some_and(|outward| dot(outward, normal) > FACING_COSINE) {
            return None;
        }
        Some(Anchor {
            face: index,
            natural: projection.natural,
            foot: projection.foot,
            normal,
            clearance: dot(line, normal),
            distance: projection.distance,
        })
    }

    /// Faces that share the foot of a projection, ascending; none when one of them comes nearer elsewhere.
    fn foot(&self, index: u32, projection: &face::Projection, position: [f64; 3]) -> Option<Foot> {
        let own = &self.nodes[index as usize];
        let edges = face::edges_at(own.len(), projection.natural, ON_EDGE);
        let mut faces = vec![index];
        match edges.as_slice() {
            [] => return Some(Foot { faces, normal: projection.normal, rims: Vec::new() }),
            [edge] => {
                let (a, b) = edge_key(own, *edge);
                faces.extend(self.at_corner[&a].iter().copied().filter(|&f| f != index && self.has_edge(f, (a, b))));
            }
            [first, second, ..] => {
                let corner = own[face::shared_corner(own.len(), *first, *second)];
                faces.extend(self.at_corner[&corner].iter().copied().filter(|&f| f != index));
            }
        }
        faces.sort_unstable();
        let hair = HAIR * self.size(index);
        let (mut sum, mut rims) = ([0.0; 3], Vec::new());
        for &f in &faces {
            let there = if f == index { *projection } else { face::project(&self.coordinates[f as usize], position)? };
            if there.distance < projection.distance - hair {
                return None;
            }
            sum = std::array::from_fn(|i| sum[i] + there.normal[i]);
            let list = &self.nodes[f as usize];
            for k in face::edges_at(list.len(), there.natural, ON_EDGE) {
                if self.at_edge[&edge_key(list, k)] == 1 {
                    rims.extend(self.rim(f, k, there.normal));
                }
            }
        }
        let length = norm(sum);
        // Faces folded back on each other have no direction in common.
        (length > HAIR).then(|| Foot { faces, normal: sum.map(|x| x / length), rims })
    }

    fn has_edge(&self, face: u32, edge: (NodeId, NodeId)) -> bool {
        let list = &self.nodes[face as usize];
        (0..face::corner_count(list.len())).any(|k| edge_key(list, k) == edge)
    }

    /// Unit vector in a face, perpendicular to an edge, away from the face.
    fn rim(&self, face: u32, edge: usize, normal: [f64; 3]) -> Option<[f64; 3]> {
        let c = &self.coordinates[face as usize];
        let corners = face::corner_count(c.len());
        let out = cross(sub(c[(edge + 1) % corners], c[edge]), normal);
        let length = norm(out);
        (length > 0.0).then(|| out.map(|x| x / length))
    }
}

/// Corner nodes of an edge of a face, the lower one first.
fn edge_key(nodes: &FaceNodes, edge: usize) -> (NodeId, NodeId) {
    let (a, b) = (nodes[edge], nodes[(edge + 1) % face::corner_count(nodes.len())]);
    (a.min(b), a.max(b))
}

/// Box around a face; a curved face reaches out of the box of its nodes.
fn bounds(c: &Coordinates) -> Rectangle<[f64; 3]> {
    let bound =
        |pick: fn(f64, f64) -> f64| c.iter().skip(1).fold(c[0], |b, x| std::array::from_fn(|i| pick(b[i], x[i])));
    let (mut low, mut high) = (bound(f64::min), bound(f64::max));
    let bulge = face::bulge(c.len());
    for (l, h) in low.iter_mut().zip(&mut high).filter(|_| bulge > 0.0) {
        let reach = bulge * (*h - *l);
        (*l, *h) = (*l - reach, *h + reach);
    }
    Rectangle::from_corners(low, high)
}
