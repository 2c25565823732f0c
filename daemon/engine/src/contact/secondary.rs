//! Secondary surfaces: nodes with tributary areas, and their side of the interface.

use rustc_hash::FxHashMap;

use super::node_areas::{self, Share};
use super::underlying::{Underlying, face_area};
use crate::element::{Coordinates, connector, face};
use crate::model::{Dialect, ElementId, InteractionId, Mesh, Model, NodeId, SurfaceId, SurfaceKind, SurfacePair};

/// A secondary node, its area, and its area vector where it belongs to faces.
pub type Secondary = (NodeId, f64, Option<[f64; 3]>);

/// Secondary nodes of a surface, by node. The area of a node is its share of the faces \[length²\], on bars of the lengths
/// \[length\], on a node-based surface the given one; faces give an outward area vector too.
pub fn nodes(mesh: &Mesh, kind: &SurfaceKind, node_area: f64) -> Vec<Secondary> {
    let mut sums: FxHashMap<NodeId, (f64, Option<[f64; 3]>)> = FxHashMap::default();
    match kind {
        SurfaceKind::Nodes(nodes) => return nodes.iter().map(|&n| (n, node_area, None)).collect(),
        SurfaceKind::Bars(bars) => {
            for &bar in bars {
                let half = 0.5 * length(mesh, bar);
                mesh.elements.nodes(bar.index()).iter().for_each(|n| sums.entry(*n).or_default().0 += half);
            }
        }
        SurfaceKind::Faces(faces) => {
            for &element_face in faces {
                let nodes = mesh.face_nodes(element_face);
                let coordinates = Coordinates::of(nodes.iter().map(|n| mesh.nodes[n.index()]));
                let (areas, vectors) = (face::nodal_areas(&coordinates), face::nodal_area_vectors(&coordinates));
                for ((&node, area), vector) in nodes.iter().zip(areas).zip(vectors) {
                    let entry = sums.entry(node).or_default();
                    entry.0 += area;
                    for (sum, v) in entry.1.get_or_insert_default().iter_mut().zip(vector) {
                        *sum += v;
                    }
                }
            }
        }
        SurfaceKind::Analytical(_) => unreachable!("the deck reader admits no analytical surface as a secondary one"),
    }
    let mut all: Vec<_> = sums.into_iter().map(|(n, (area, vector))| (n, area, vector)).collect();
    all.sort_by_key(|&(n, ..)| n);
    all
}

/// Secondary nodes of a pair.
pub struct Secondaries {
    /// With their areas as the dialect has them.
    pub all: Vec<Secondary>,
    /// Labels of those whose area the dialect leaves open.
    pub unknown: Vec<u32>,
    /// Those that stand for the primary face under them, ascending.
    pub bare: Vec<NodeId>,
}

/// Secondary nodes of a pair.
pub fn of_pair(model: &Model, interaction: InteractionId, pair: &SurfacePair) -> Secondaries {
    let mesh = &model.mesh;
    let kind = &mesh.surfaces[pair.secondary.index()].kind;
    let given = model.interactions[interaction.index()].node_area;
    let mut secondaries = nodes(mesh, kind, given.unwrap_or(1.0));
    let (mut unknown, mut bare) = (Vec::new(), Vec::new());
    if let (SurfaceKind::Nodes(nodes), None, Dialect::Calculix) = (kind, given, model.dialect) {
        for ((node, area, _), share) in secondaries.iter_mut().zip(node_areas::of_outer_faces(mesh, nodes)) {
            match share {
                Share::Area(share) => *area = share,
                Share::Midside => unknown.push(mesh.node_labels[node.index()]),
                Share::Nothing => bare.push(*node),
            }
        }
    }
    bare.sort_unstable();
    Secondaries { all: secondaries, unknown, bare }
}

fn length(mesh: &Mesh, bar: ElementId) -> f64 {
    let coordinates = Coordinates::of(mesh.elements.nodes(bar.index()).iter().map(|n| mesh.nodes[n.index()]));
    connector::length(&coordinates)
}

/// Characteristic length of an interface \[length\]: the mean size of the faces (length of the bars) of the secondary surface, of a
/// node-based one that of the primary surface. Nodes on an analytical surface: the mean size of their share of outer faces, else 1.
pub fn characteristic_length(model: &Model, pair: &SurfacePair) -> f64 {
    let mesh = &model.mesh;
    let kind = |surface: SurfaceId| &mesh.surfaces[surface.index()].kind;
    let mean = |values: &mut dyn Iterator<Item = f64>| {
        let (sum, count) = values.fold((0.0, 0.0), |(sum, count), v| (sum + v, count + 1.0));
        (count > 0.0).then(|| sum / count)
    };
    let found = match (kind(pair.secondary), kind(pair.primary)) {
        (SurfaceKind::Faces(faces), _) | (SurfaceKind::Nodes(_), SurfaceKind::Faces(faces)) => {
            mean(&mut faces.iter().map(|&face| face_area(model, face).sqrt()))
        }
        (SurfaceKind::Bars(bars), _) => mean(&mut bars.iter().map(|&bar| length(mesh, bar))),
        (SurfaceKind::Nodes(nodes), _) => {
            mean(&mut node_areas::of_outer_faces(mesh, nodes).into_iter().filter_map(Share::area).map(f64::sqrt))
        }
        (SurfaceKind::Analytical(_), _) => None,
    };
    found.unwrap_or(1.0)
}

/// Stiffness under the nodes of a secondary surface.
pub struct Stiffness<'a> {
    underlying: &'a Underlying<'a>,
    /// Under the nodes of an element-based surface; none for nodes and bars.
    faces: Option<FxHashMap<NodeId, f64>>,
}

impl<'a> Stiffness<'a> {
    /// Looks at every face once.
    pub fn new(underlying: &'a Underlying<'a>, surface: SurfaceId) -> Self {
        let faces = match &underlying.model.mesh.surfaces[surface.index()].kind {
            SurfaceKind::Faces(faces) => Some(underlying.of_faces(faces)),
            _ => None,
        };
        Self { underlying, faces }
    }

    /// At a node of a given area, along a normal towards the secondary side, with what lies under the primary side as stiffness
    /// and as a force per length \[pressure/length\]; for areas that are no face's the forces are divided by them.
    pub fn with(&self, node: NodeId, normal: [f64; 3], area: f64, primary: Option<(f64, f64)>) -> Option<f64> {
        let connectors = self.underlying.of_connectors(node, normal).map(|k| k / area);
        let (solids, primary) = match &self.faces {
            Some(faces) => (faces.get(&node).copied(), primary.map(|(stiffness, _)| stiffness)),
            None => {
                let solids = self.underlying.of_node(node, normal.map(|x| -x));
                (solids.map(|k| k / area), primary.map(|(_, force)| force / area))
            }
        };
        let own = if solids.is_none() { connectors } else { solids.map(|k| k + connectors.unwrap_or(0.0)) };
        super::underlying::in_series(own, primary)
    }
}
