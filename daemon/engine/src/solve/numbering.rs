//! Degrees of freedom: which are prescribed, which belong to which component, and in which order they are eliminated.

use rustc_hash::FxHashMap;

use super::constraints::Constraints;
use crate::model::{Mesh, Model, NodeId};

/// Marks a degree of freedom that is not an unknown.
pub const NOT_FREE: u32 = u32::MAX;

/// Bodies: nodes connected through elements and equations; a contact node that belongs to neither is one of its own.
/// Numbered by their lowest node.
pub struct Bodies {
    /// Body of each node; `u32::MAX` for a node that nothing moves.
    pub of_node: Vec<u32>,
    /// Body-local number of each node that belongs to a body.
    pub local: Vec<u32>,
    /// Elements of each body, ascending.
    pub elements: Vec<Vec<u32>>,
    /// Nodes of each body, ascending.
    pub nodes: Vec<Vec<NodeId>>,
}

impl Bodies {
    /// Splits a model into connected bodies; `contact_nodes` are nodes that contact may hold.
    pub fn find(model: &Model, contact_nodes: impl Iterator<Item = NodeId>) -> Self {
        let mesh = &model.mesh;
        let mut sets = Unions::new(mesh.nodes.len());
        let mut used = vec![false; mesh.nodes.len()];
        for node in contact_nodes {
            used[node.index()] = true;
        }
        let mut join = |nodes: &mut dyn Iterator<Item = NodeId>| {
            let mut first = None;
            for n in nodes {
                used[n.index()] = true;
                sets.join(*first.get_or_insert(n.0), n.0);
            }
        };
        for (_, element) in mesh.elements.iter() {
            join(&mut element.iter().copied());
        }
        for equation in &model.equations {
            join(&mut equation.terms.iter().map(|t| t.0));
        }
        let mut of_node = vec![u32::MAX; mesh.nodes.len()];
        let mut local = vec![u32::MAX; mesh.nodes.len()];
        let mut nodes: Vec<Vec<NodeId>> = Vec::new();
        for i in (0..mesh.nodes.len() as u32).filter(|&i| used[i as usize]) {
            let root = sets.root(i);
            if root == i {
                of_node[i as usize] = nodes.len() as u32;
                nodes.push(Vec::new());
            }
            // A root is the lowest node of its body, so it was met before any other.
            let body = of_node[root as usize];
            of_node[i as usize] = body;
            local[i as usize] = nodes[body as usize].len() as u32;
            nodes[body as usize].push(NodeId(i));
        }
        let mut elements = vec![Vec::new(); nodes.len()];
        for (e, (_, element)) in mesh.elements.iter().enumerate() {
            elements[of_node[element[0].index()] as usize].push(e as u32);
        }
        Self { of_node, local, elements, nodes }
    }
}

/// Disjoint sets of numbers; the root of a set is its lowest member.
pub struct Unions {
    parent: Vec<u32>,
}

impl Unions {
    /// Every number a set of its own.
    pub fn new(count: usize) -> Self {
        Self { parent: (0..count as u32).collect() }
    }

    /// Lowest member of the set of a number.
    pub fn root(&mut self, mut i: u32) -> u32 {
        while self.parent[i as usize] != i {
            self.parent[i as usize] = self.parent[self.parent[i as usize] as usize];
            i = self.parent[i as usize];
        }
        i
    }

    /// Makes two sets one.
    pub fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b) as usize] = a.min(b);
    }
}

/// Nodes whose unknowns each element of a body couples: its own, and those that its dependent nodes depend on.
pub struct Reach<'a> {
    mesh: &'a Mesh,
    /// Elements with dependent nodes.
    extended: FxHashMap<u32, Vec<NodeId>>,
    /// Nodes that something else couples.
    others: Vec<Vec<NodeId>>,
}

impl<'a> Reach<'a> {
    /// Reach of the elements of a body.
    pub fn new(mesh: &'a Mesh, elements: &[u32], constraints: &Constraints) -> Self {
        let mut extended = FxHashMap::default();
        for &e in elements {
            let own = mesh.elements.nodes(e as usize);
            if own.iter().any(|&n| constraints.is_dependent(n)) {
                let mut all = own.to_vec();
                for &n in own {
                    (0..3).for_each(|d| constraints.expand(n, d, 1.0, |node, _, _| all.push(node)));
                }
                all.sort_unstable();
                all.dedup();
                extended.insert(e, all);
            }
        }
        Self { mesh, extended, others: Vec::new() }
    }

    /// With further groups of nodes that are coupled.
    pub fn with(mut self, others: Vec<Vec<NodeId>>) -> Self {
        self.others = others;
        self
    }

    /// Nodes of the i-th group that is coupled: elements first, then the others.
    fn group(&self, elements: &[u32], i: usize) -> &[NodeId] {
        if i < elements.len() { self.nodes(elements[i]) } else { &self.others[i - elements.len()] }
    }

    /// Nodes that an element couples.
    pub fn nodes(&self, element: u32) -> &[NodeId] {
        self.extended.get(&element).map_or_else(|| self.mesh.elements.nodes(element as usize), Vec::as_slice)
    }

    /// Whether an element has dependent nodes.
    pub fn is_extended(&self, element: u32) -> bool {
        self.extended.contains_key(&element)
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
    pub fn new(reach: &Reach<'_>, nodes: &[NodeId], elements: &[u32], local: &[u32]) -> Self {
        let n = nodes.len();
        let mut count = vec![0u32; n + 1];
        let groups = elements.len() + reach.others.len();
        for e in 0..groups {
            for node in reach.group(elements, e) {
                count[local[node.index()] as usize + 1] += 1;
            }
        }
        for i in 0..n {
            count[i + 1] += count[i];
        }
        let mut fill = count.clone();
        let mut incident = vec![0u32; count[n] as usize];
        for e in 0..groups {
            for node in reach.group(elements, e) {
                let slot = &mut fill[local[node.index()] as usize];
                incident[*slot as usize] = e as u32;
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
                for node in reach.group(elements, e as usize) {
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
