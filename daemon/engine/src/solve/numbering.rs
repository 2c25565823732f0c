//! Degrees of freedom: which are prescribed, which belong to which component, and in which order they are eliminated.

use crate::model::{Mesh, NodeId};

/// Marks a degree of freedom that is not an unknown.
pub const NOT_FREE: u32 = u32::MAX;

/// Bodies: nodes connected through elements. Numbered by their lowest node.
pub struct Bodies {
    /// Body of each node; `u32::MAX` for a node in no element.
    pub of_node: Vec<u32>,
    /// Elements of each body, ascending.
    pub elements: Vec<Vec<u32>>,
    /// Nodes of each body, ascending.
    pub nodes: Vec<Vec<NodeId>>,
}

impl Bodies {
    /// Splits the mesh into connected bodies.
    pub fn find(mesh: &Mesh) -> Self {
        let mut parent: Vec<u32> = (0..mesh.nodes.len() as u32).collect();
        fn root(parent: &mut [u32], mut i: u32) -> u32 {
            while parent[i as usize] != i {
                parent[i as usize] = parent[parent[i as usize] as usize];
                i = parent[i as usize];
            }
            i
        }
        let mut used = vec![false; mesh.nodes.len()];
        for (_, element) in mesh.elements.iter() {
            let first = root(&mut parent, element[0].0);
            let mut low = first;
            for n in element {
                used[n.index()] = true;
                let r = root(&mut parent, n.0);
                let (a, b) = (low.min(r), low.max(r));
                parent[b as usize] = a;
                low = a;
            }
        }
        let mut of_node = vec![u32::MAX; mesh.nodes.len()];
        let mut nodes: Vec<Vec<NodeId>> = Vec::new();
        for i in 0..mesh.nodes.len() as u32 {
            if !used[i as usize] {
                continue;
            }
            let r = root(&mut parent, i);
            if r == i {
                of_node[i as usize] = nodes.len() as u32;
                nodes.push(Vec::new());
            }
            // A root is the lowest node of its body, so it was met before any other.
            let body = of_node[r as usize];
            of_node[i as usize] = body;
            nodes[body as usize].push(NodeId(i));
        }
        let mut elements = vec![Vec::new(); nodes.len()];
        for (e, (_, element)) in mesh.elements.iter().enumerate() {
            elements[of_node[element[0].index()] as usize].push(e as u32);
        }
        Self { of_node, elements, nodes }
    }
}

/// Nodes of one body with the nodes that touch each of them, as a graph on body-local numbers.
pub struct NodeGraph {
    /// Start of each node's neighbours; one more than there are nodes.
    pub starts: Vec<u32>,
    /// Neighbours, ascending, without the node itself.
    pub neighbours: Vec<u32>,
}

impl NodeGraph {
    /// Graph of a body; `local` maps nodes to body-local numbers.
    pub fn new(mesh: &Mesh, nodes: &[NodeId], elements: &[u32], local: &[u32]) -> Self {
        let n = nodes.len();
        let mut count = vec![0u32; n + 1];
        for &e in elements {
            for node in mesh.elements.nodes(e as usize) {
                count[local[node.index()] as usize + 1] += 1;
            }
        }
        for i in 0..n {
            count[i + 1] += count[i];
        }
        let mut fill = count.clone();
        let mut incident = vec![0u32; count[n] as usize];
        for &e in elements {
            for node in mesh.elements.nodes(e as usize) {
                let slot = &mut fill[local[node.index()] as usize];
                incident[*slot as usize] = e;
                *slot += 1;
            }
        }
        let mut mark = vec![u32::MAX; n];
        let mut starts = Vec::with_capacity(n + 1);
        let mut neighbours = Vec::with_capacity(26 * n);
        starts.push(0);
        for i in 0..n {
            mark[i] = i as u32;
            let begin = neighbours.len();
            for &e in &incident[count[i] as usize..count[i + 1] as usize] {
                for node in mesh.elements.nodes(e as usize) {
                    let j = local[node.index()];
                    if mark[j as usize] != i as u32 {
                        mark[j as usize] = i as u32;
                        neighbours.push(j);
                    }
                }
            }
            neighbours[begin..].sort_unstable();
            starts.push(neighbours.len() as u32);
        }
        Self { starts, neighbours }
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Neighbours of a node.
    pub fn of(&self, node: usize) -> &[u32] {
        &self.neighbours[self.starts[node] as usize..self.starts[node + 1] as usize]
    }
}
