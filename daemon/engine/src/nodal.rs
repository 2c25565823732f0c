//! A model on the displacements of all its nodes, as dynamics sees it: contact rows, dependent and prescribed directions.
//!
//! A nodal vector has three numbers for each node of the mesh; the three of a hidden node are rotations or moments.

use crate::contact::points::ContactPoint;
use crate::model::NodeId;
use crate::solve::columns::Column;
use crate::solve::constraints::Constraints;

/// Position of a direction of a node in a flattened nodal vector.
pub fn flat(node: NodeId, direction: usize) -> usize {
    3 * node.index() + direction
}

/// Contact rows and constraints on nodal vectors. Immutable.
pub struct Nodal {
    /// Start of each row in `entries`; one more than there are rows.
    starts: Vec<usize>,
    /// Flat position and coefficient.
    entries: Vec<(u32, f64)>,
    /// `h_0`: overclosures of the geometry \[length\]; zero for tangential rows.
    pub initial: Vec<f64>,
    /// Dependent directions, each with what it depends on.
    dependents: Vec<(usize, Vec<(usize, f64)>)>,
    /// Prescribed directions, ascending.
    pub prescribed: Vec<usize>,
}

impl Nodal {
    /// Of contact points followed by tangential rows.
    pub fn new(constraints: &Constraints, row_points: &[ContactPoint], points: usize, nodes: usize) -> Self {
        let (mut starts, mut entries) = (vec![0], Vec::new());
        for point in row_points {
            point.row(point.normal.map(|x| -x), |node, d, value| entries.push((flat(node, d) as u32, value)));
            starts.push(entries.len());
        }
        let initial = row_points.iter().enumerate().map(|(i, p)| if i < points { -p.clearance } else { 0.0 }).collect();
        let dependents = (constraints.dependents().into_iter())
            .map(|((node, d), terms)| {
                let terms = terms.iter().map(|&(n, d, factor)| (flat(n, usize::from(d)), factor)).collect();
                (flat(node, usize::from(d)), terms)
            })
            .collect();
        let prescribed = (0..nodes)
            .flat_map(|n| (0..3).map(move |d| (NodeId(n as u32), d)))
            .filter(|&(node, d)| constraints.is_prescribed(node, d))
            .map(|(node, d)| flat(node, d))
            .collect();
        Self { starts, entries, initial, dependents, prescribed }
    }

    /// Number of contact rows.
    pub fn rows(&self) -> usize {
        self.initial.len()
    }

    /// Entries of a row: flat positions and coefficients.
    pub fn row(&self, row: usize) -> &[(u32, f64)] {
        &self.entries[self.starts[row]..self.starts[row + 1]]
    }

    /// `B x` of one row.
    pub fn along(&self, row: usize, x: &[[f64; 3]]) -> f64 {
        let x = x.as_flattened();
        self.row(row).iter().map(|&(at, value)| value * x[at as usize]).sum()
    }

    /// Adds `factor Bᵀ F` to nodal forces.
    pub fn push(&self, forces: &[f64], factor: f64, out: &mut [[f64; 3]]) {
        let out = out.as_flattened_mut();
        for (row, force) in forces.iter().enumerate().filter(|(_, f)| **f != 0.0) {
            for &(at, value) in self.row(row) {
                out[at as usize] += factor * force * value;
            }
        }
    }

    /// Gives dependent directions what those that they depend on have.
    pub fn extend(&self, x: &mut [[f64; 3]]) {
        let x = x.as_flattened_mut();
        for (at, terms) in &self.dependents {
            x[*at] = terms.iter().map(|&(from, factor)| factor * x[from]).sum();
        }
    }

    /// Moves forces on dependent directions to those that they depend on.
    pub fn restrict(&self, forces: &mut [[f64; 3]]) {
        let forces = forces.as_flattened_mut();
        for (at, terms) in &self.dependents {
            let force = std::mem::take(&mut forces[*at]);
            for &(to, factor) in terms {
                forces[to] += factor * force;
            }
        }
    }

    /// Moves masses of dependent directions to those that they depend on: what is left is the diagonal of the mass that independent
    /// directions have with everything that hangs on them.
    pub fn restrict_masses(&self, masses: &mut [[f64; 3]]) {
        let masses = masses.as_flattened_mut();
        for (at, terms) in &self.dependents {
            let mass = std::mem::take(&mut masses[*at]);
            for &(to, factor) in terms {
                masses[to] += factor * factor * mass;
            }
        }
    }
}

/// Adds the displacements of columns with these coefficients.
pub fn place(columns: &[Column], coefficients: &[f64], out: &mut [[f64; 3]]) {
    for (column, a) in columns.iter().zip(coefficients) {
        if let Column::Displacement(entries) = column {
            for &(node, d, value) in entries {
                out[node.index()][usize::from(d)] += a * value;
            }
        }
    }
}

/// Nodal forces of columns with these coefficients, in place of what `out` holds.
pub fn load(columns: &[Column], coefficients: &[f64], out: &mut [[f64; 3]]) {
    out.fill([0.0; 3]);
    for (column, a) in columns.iter().zip(coefficients).filter(|(_, a)| **a != 0.0) {
        if let Column::Force(entries) = column {
            for &(node, d, value) in entries {
                out[node.index()][usize::from(d)] += a * value;
            }
        }
    }
}

/// `x · y`.
pub fn dot(x: &[[f64; 3]], y: &[[f64; 3]]) -> f64 {
    x.as_flattened().iter().zip(y.as_flattened()).map(|(a, b)| a * b).sum()
}

/// Largest entry.
pub fn largest(x: &[[f64; 3]]) -> f64 {
    x.as_flattened().iter().fold(0.0, |m, a| a.abs().max(m))
}
