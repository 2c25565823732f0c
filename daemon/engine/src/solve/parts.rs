//! Parts of a body that can move as rigid ones: clusters of solids joined by faces, and lone nodes.
//!
//! Two solids that share a node or an edge only are hinged to each other there. Nodes that no solid holds (of springs,
//! bars, masses, equations) are parts of their own, with a translation for each of their free directions.

use crate::element::quad::{cross, dot};
use crate::model::{Mesh, NodeId};
use crate::solve::numbering::Unions;

/// Sine of the angle below which three nodes are on a line.
const COLLINEAR: f64 = 1e-8;

/// Parts of one body.
#[derive(Default)]
pub struct Parts {
    /// First parameter of each part; one more than there are parts. Solids have three translations and three rotations.
    pub offsets: Vec<usize>,
    /// Directions of the parameters of each part; of a lone node its free ones.
    pub directions: Vec<u8>,
    /// Part of each body-local node; the first of several.
    pub of_node: Vec<u32>,
    /// Further parts that a body-local node belongs to.
    pub shared: Vec<(u32, u32)>,
    /// An element of each part, if it has one, else its node.
    pub sample: Vec<Sample>,
}

/// Something to name a part by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sample {
    /// A solid of the part.
    Element(u32),
    /// The lone node.
    Node(NodeId),
}

impl Parts {
    /// Finds the parts of a body; `local` maps nodes to body-local numbers.
    pub fn find(
        mesh: &Mesh,
        nodes: &[NodeId],
        elements: &[u32],
        local: &[u32],
        is_free: impl Fn(NodeId, usize) -> bool,
    ) -> Self {
        let solids: Vec<u32> =
            elements.iter().copied().filter(|&e| mesh.elements.kind(e as usize).is_solid()).collect();
        let mut clusters = joined_by_faces(mesh, nodes.len(), &solids, local);
        let mut part_of_root = vec![u32::MAX; solids.len()];
        let (mut offsets, mut sample, mut directions) = (vec![0usize], Vec::new(), Vec::new());
        let mut of_node = vec![u32::MAX; nodes.len()];
        let mut shared = Vec::new();
        for (i, &e) in solids.iter().enumerate() {
            let root = clusters.root(i as u32) as usize;
            if part_of_root[root] == u32::MAX {
                part_of_root[root] = sample.len() as u32;
                sample.push(Sample::Element(e));
                directions.extend(0..6u8);
                offsets.push(directions.len());
            }
            let part = part_of_root[root];
            for n in mesh.elements.nodes(e as usize) {
                let n = local[n.index()];
                match of_node[n as usize] {
                    u32::MAX => of_node[n as usize] = part,
                    known if known != part => shared.push((n, part)),
                    _ => {}
                }
            }
        }
        shared.sort_unstable();
        shared.dedup();
        for (i, &node) in nodes.iter().enumerate() {
            if of_node[i] == u32::MAX {
                of_node[i] = sample.len() as u32;
                sample.push(Sample::Node(node));
                directions.extend((0..3u8).filter(|&d| is_free(node, usize::from(d))));
                offsets.push(directions.len());
            }
        }
        Self { offsets, directions, of_node, shared, sample }
    }

    /// Number of rigid parameters of all parts.
    pub fn parameters(&self) -> usize {
        self.offsets[self.sample.len()]
    }
}

/// Clusters of solids (by position) that share three nodes not on a line.
fn joined_by_faces(mesh: &Mesh, node_count: usize, solids: &[u32], local: &[u32]) -> Unions {
    let nodes_of = |i: usize| mesh.elements.nodes(solids[i] as usize);
    let mut starts = vec![0u32; node_count + 1];
    for i in 0..solids.len() {
        for n in nodes_of(i) {
            starts[local[n.index()] as usize + 1] += 1;
        }
    }
    for i in 0..node_count {
        starts[i + 1] += starts[i];
    }
    let mut fill = starts.clone();
    let mut incident = vec![0u32; starts[node_count] as usize];
    for i in 0..solids.len() {
        for n in nodes_of(i) {
            let slot = &mut fill[local[n.index()] as usize];
            incident[*slot as usize] = i as u32;
            *slot += 1;
        }
    }
    let mut clusters = Unions::new(solids.len());
    let mut count = vec![0u8; solids.len()];
    let mut touched: Vec<u32> = Vec::new();
    let mut common: Vec<[f64; 3]> = Vec::new();
    for i in 0..solids.len() {
        for n in nodes_of(i) {
            let n = local[n.index()] as usize;
            for &j in &incident[starts[n] as usize..starts[n + 1] as usize] {
                if (j as usize) > i {
                    if count[j as usize] == 0 {
                        touched.push(j);
                    }
                    count[j as usize] += 1;
                }
            }
        }
        for j in touched.drain(..) {
            let enough = std::mem::take(&mut count[j as usize]) >= 3;
            if !enough || clusters.root(i as u32) == clusters.root(j) {
                continue;
            }
            common.clear();
            common
                .extend(nodes_of(i).iter().filter(|n| nodes_of(j as usize).contains(n)).map(|n| mesh.nodes[n.index()]));
            if !on_a_line(&common) {
                clusters.join(i as u32, j);
            }
        }
    }
    clusters
}

/// Whether points lie on one line.
fn on_a_line(points: &[[f64; 3]]) -> bool {
    let from = |p: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|d| p[d] - points[0][d]) };
    let square = |v: [f64; 3]| dot(v, v);
    let Some(longest) = points.iter().map(from).max_by(|a, b| square(*a).total_cmp(&square(*b))) else { return true };
    points.iter().map(from).all(|v| {
        let area = square(cross(longest, v));
        area <= COLLINEAR * COLLINEAR * square(longest) * square(longest)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::basis;
    use crate::model::{ElementKind, ElementShape};

    /// Unit cubes with their lowest corners at the given places, sharing nodes where they touch.
    fn cubes(places: &[[f64; 3]]) -> (Mesh, Vec<NodeId>) {
        let mut mesh = Mesh::default();
        for at in places {
            let nodes: Vec<NodeId> = (0..8)
                .map(|a| basis::node(ElementShape::Hexahedron8, a))
                .map(|c| {
                    let x: [f64; 3] = std::array::from_fn(|d| at[d] + 0.5 * (1.0 + c[d]));
                    let known = mesh.nodes.iter().position(|y| *y == x);
                    NodeId(known.unwrap_or_else(|| {
                        mesh.nodes.push(x);
                        mesh.nodes.len() - 1
                    }) as u32)
                })
                .collect();
            mesh.elements.push(ElementKind::C3D8, &nodes);
        }
        let nodes = (0..mesh.nodes.len() as u32).map(NodeId).collect();
        (mesh, nodes)
    }

    fn parts(places: &[[f64; 3]]) -> Parts {
        let (mesh, nodes) = cubes(places);
        let elements: Vec<u32> = (0..places.len() as u32).collect();
        let local: Vec<u32> = (0..nodes.len() as u32).collect();
        Parts::find(&mesh, &nodes, &elements, &local, |_, _| true)
    }

    #[test]
    fn a_face_joins_and_an_edge_or_a_corner_hinges() {
        assert_eq!(parts(&[[0.0; 3], [1.0, 0.0, 0.0]]).sample.len(), 1);
        let edge = parts(&[[0.0; 3], [1.0, 1.0, 0.0]]);
        assert_eq!((edge.sample.len(), edge.shared.len(), edge.parameters()), (2, 2, 12));
        let corner = parts(&[[0.0; 3], [1.0, 1.0, 1.0]]);
        assert_eq!((corner.sample.len(), corner.shared.len()), (2, 1));
    }

    #[test]
    fn cubes_round_a_corner_are_one_part() {
        assert_eq!(parts(&[[0.0; 3], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0]]).sample.len(), 1);
    }

    #[test]
    fn a_node_without_solids_is_a_part_with_its_free_directions() {
        let (mut mesh, mut nodes) = cubes(&[[0.0; 3]]);
        mesh.nodes.push([5.0, 0.0, 0.0]);
        nodes.push(NodeId(8));
        let parts = Parts::find(&mesh, &nodes, &[0], &(0..9).collect::<Vec<_>>(), |_, d| d != 1);
        assert_eq!((parts.parameters(), parts.sample[1]), (8, Sample::Node(NodeId(8))));
    }
}
