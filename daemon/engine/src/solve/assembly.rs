//! Stiffness matrix of one body on its free degrees of freedom, lower triangle by columns, in elimination order.

use super::context::Context;
use super::numbering::{NOT_FREE, NodeGraph, Reach};
use crate::element::{self, Coordinates, Elasticity, Stiffness, connector};
use crate::model::{ElementId, Mesh, Model};

/// Symmetric matrix: lower triangle, column by column, rows ascending.
pub struct LowerMatrix {
    /// Start of each column; one more than there are columns.
    pub starts: Vec<usize>,
    /// Row of each entry.
    pub rows: Vec<usize>,
    /// Entries.
    pub values: Vec<f64>,
}

impl LowerMatrix {
    /// Order of the matrix.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Position of an entry of the lower triangle that the pattern has.
    pub fn entry(&self, row: usize, column: usize) -> usize {
        let range = self.starts[column]..self.starts[column + 1];
        let at = self.rows[range.clone()].binary_search(&row).expect("nodes that an element couples are neighbours");
        range.start + at
    }

    /// Gives diagonal entries that are zero a part of the largest one.
    pub fn fill_diagonal(&mut self, part: f64) {
        let small = part * self.diagonal().fold(0.0, f64::max);
        for &start in &self.starts[..self.len()] {
            if self.values[start] == 0.0 {
                self.values[start] = small;
            }
        }
    }

    /// Diagonal entries: the first of each column.
    pub fn diagonal(&self) -> impl Iterator<Item = f64> + '_ {
        self.starts[..self.len()].iter().map(|&s| self.values[s])
    }
}

/// Elastic constants of every material.
pub fn elasticities(model: &Model) -> Vec<Elasticity> {
    model.materials.iter().map(|m| Elasticity::new(m.youngs_modulus, m.poissons_ratio)).collect()
}

/// Node coordinates of an element.
pub fn coordinates(mesh: &Mesh, element: u32) -> Coordinates {
    Coordinates::of(mesh.elements.nodes(element as usize).iter().map(|n| mesh.nodes[n.index()]))
}

/// Stiffness of an element of the model, into `out`.
pub fn element_stiffness(model: &Model, elasticities: &[Elasticity], element: u32, out: &mut Stiffness) {
    let mesh = &model.mesh;
    let material = mesh.element_materials[element as usize];
    let kind = mesh.elements.kind(element as usize);
    match mesh.connectors.get(&ElementId(element)) {
        None => element::stiffness(kind, &coordinates(mesh, element), elasticities[material.index()], out),
        Some(&section) => {
            let youngs_modulus = elasticities.get(material.index()).map_or(0.0, |e| e.youngs_modulus());
            connector::stiffness(kind, &coordinates(mesh, element), section, youngs_modulus, out);
        }
    }
}

/// Numbering that assembly needs of a body.
pub struct Layout<'a> {
    /// Nodes that each element couples.
    pub reach: &'a Reach<'a>,
    /// Neighbours by body-local node.
    pub graph: &'a NodeGraph,
    /// Body-local nodes in elimination order.
    pub order: &'a [u32],
    /// Unknown of each direction of each body-local node, or `NOT_FREE`.
    pub unknowns: &'a [[u32; 3]],
    /// Number of unknowns.
    pub count: usize,
}

/// Assembles the stiffness of a body.
pub fn assemble(context: &Context<'_>, elements: &[u32], layout: &Layout<'_>) -> LowerMatrix {
    let (model, local) = (context.model, context.local);
    let free = |node: u32| layout.unknowns[node as usize].into_iter().filter(|&u| u != NOT_FREE);
    let mut position = vec![0u32; layout.order.len()];
    for (p, &node) in layout.order.iter().enumerate() {
        position[node as usize] = p as u32;
    }
    // Later neighbours of each node by elimination position: each is one block of rows below the node's own.
    let mut later_starts = vec![0usize];
    let mut later: Vec<u32> = Vec::with_capacity(layout.graph.neighbours.len() / 2);
    // First row of each such block within the node's columns, counted from the end of the node's own rows.
    let mut offsets: Vec<u32> = Vec::with_capacity(later.capacity());
    let (mut starts, mut rows) = (vec![0usize], Vec::new());
    let mut own_starts = vec![0usize; layout.order.len()];
    for (p, &node) in layout.order.iter().enumerate() {
        let begin = later.len();
        later.extend(layout.graph.of(node as usize).iter().map(|&j| position[j as usize]).filter(|&q| q > p as u32));
        later[begin..].sort_unstable();
        own_starts[p] = starts.len() - 1;
        let mut below = 0;
        for &q in &later[begin..] {
            offsets.push(below);
            below += free(layout.order[q as usize]).count() as u32;
        }
        for column in free(node) {
            rows.extend(free(node).filter(|&r| r >= column).map(|r| r as usize));
            for &q in &later[begin..] {
                rows.extend(free(layout.order[q as usize]).map(|r| r as usize));
            }
            starts.push(rows.len());
        }
        later_starts.push(later.len());
    }
    let mut values = vec![0.0; rows.len()];
    let mut k = Stiffness::default();
    let mut nodes = Vec::new();
    let mut constrained = Vec::new();
    for &e in elements {
        context.element_matrix(e, &mut k);
        if layout.reach.is_extended(e) {
            constrained.push(e);
            continue;
        }
        nodes.clear();
        nodes.extend(model.mesh.elements.nodes(e as usize).iter().map(|n| local[n.index()]));
        for a in 0..nodes.len() {
            for b in a..nodes.len() {
                let block = k.block(a, b);
                // Lumped masses couple nothing: the pattern may have no room for it.
                if a != b && block.iter().all(|&x| x == 0.0) {
                    continue;
                }
                let (pa, pb) = (position[nodes[a] as usize], position[nodes[b] as usize]);
                // The earlier node owns the columns. `transposed`: block rows belong to the earlier node's columns.
                let (first, second, transposed) = if pa <= pb { (a, b, false) } else { (b, a, true) };
                let (p, q) = (pa.min(pb) as usize, pa.max(pb));
                let (columns, row_dofs) =
                    (layout.unknowns[nodes[first] as usize], layout.unknowns[nodes[second] as usize]);
                let own = columns.iter().filter(|&&u| u != NOT_FREE).count();
                let block_row = if q as usize == p {
                    None
                } else {
                    let list = &later[later_starts[p]..later_starts[p + 1]];
                    let at = list.binary_search(&q).expect("nodes of one element are neighbours");
                    Some(offsets[later_starts[p] + at] as usize)
                };
                let mut column = own_starts[p];
                let mut column_rank = 0;
                for (i, &c) in columns.iter().enumerate() {
                    if c == NOT_FREE {
                        continue;
                    }
                    let base = starts[column];
                    let mut rank = 0;
                    for (j, &r) in row_dofs.iter().enumerate() {
                        if r == NOT_FREE {
                            continue;
                        }
                        let entry = if transposed { block[3 * j + i] } else { block[3 * i + j] };
                        match block_row {
                            Some(offset) => values[base + (own - column_rank) + offset + rank] += entry,
                            None if rank >= column_rank => values[base + rank - column_rank] += entry,
                            None => {}
                        }
                        rank += 1;
                    }
                    column += 1;
                    column_rank += 1;
                }
            }
        }
    }
    debug_assert_eq!(starts.len() - 1, layout.count);
    let mut matrix = LowerMatrix { starts, rows, values };
    for e in constrained {
        add_constrained(context, layout, e, &mut matrix);
    }
    matrix
}

/// Adds `Tᵀ K T` of an element with dependent nodes.
fn add_constrained(context: &Context<'_>, layout: &Layout<'_>, element: u32, matrix: &mut LowerMatrix) {
    let mut k = Stiffness::default();
    context.element_matrix(element, &mut k);
    let nodes = context.model.mesh.elements.nodes(element as usize);
    // Unknowns of each direction of the element, with factors.
    let mut shares: Vec<Vec<(usize, f64)>> = vec![Vec::new(); 3 * nodes.len()];
    for (a, &node) in nodes.iter().enumerate() {
        for d in 0..3 {
            context.constraints.expand(node, d, 1.0, |n, direction, factor| {
                let unknown = layout.unknowns[context.local[n.index()] as usize][direction];
                if unknown != NOT_FREE {
                    shares[3 * a + d].push((unknown as usize, factor));
                }
            });
        }
    }
    for a in 0..nodes.len() {
        for b in 0..nodes.len() {
            let block = k.block(a.min(b), a.max(b));
            for i in 0..3 {
                for j in 0..3 {
                    let entry = if a <= b { block[3 * i + j] } else { block[3 * j + i] };
                    for &(row, p) in &shares[3 * a + i] {
                        for &(column, q) in shares[3 * b + j].iter().filter(|&&(column, _)| column <= row) {
                            let at = matrix.entry(row, column);
                            matrix.values[at] += p * q * entry;
                        }
                    }
                }
            }
        }
    }
}
