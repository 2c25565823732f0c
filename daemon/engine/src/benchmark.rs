//! What benchmarks measure increments against: products with the stiffness matrix of a model, and solves with the matrix of an
//! implicit increment.

use crate::diagnostic::Diagnostic;
use crate::element::Stiffness;
use crate::implicit::{Hht, Operator};
use crate::model::{Model, Procedure};
use crate::prepared::PreparedModel;
use crate::solve::assembly;
use crate::solve::block_matrix::BlockMatrix;

/// The stiffness of a model over all its nodes, symmetric by blocks, and vectors to multiply.
pub struct StiffnessProduct {
    matrix: BlockMatrix,
    displacement: Vec<[f64; 3]>,
    force: Vec<[f64; 3]>,
}

impl StiffnessProduct {
    /// Assembles it.
    pub fn of(model: &Model) -> Self {
        let elasticities = assembly::elasticities(model);
        let mut element = |e: u32, out: &mut Stiffness| assembly::element_stiffness(model, &elasticities, e, out);
        let matrix = BlockMatrix::assemble(&model.mesh, &mut element);
        let nodes = model.mesh.nodes.len();
        let wave = |i: usize| std::array::from_fn(|d| 1e-3 * ((3 * i + d) as f64 * 0.7).sin());
        Self { matrix, displacement: (0..nodes).map(wave).collect(), force: vec![[0.0; 3]; nodes] }
    }

    /// One product; gives the first number of the result, so that nothing can leave the product out.
    pub fn run(&mut self) -> f64 {
        self.matrix.multiply(&self.displacement, &mut self.force);
        self.force[0][0]
    }

    /// Blocks of 3 x 3 that are stored: the diagonal and one of each pair of neighbours.
    pub fn blocks(&self) -> usize {
        self.matrix.blocks()
    }

    /// Bytes that a product reads and writes at least: the matrix once, both vectors once.
    pub fn bytes(&self) -> usize {
        self.matrix.bytes() + 2 * size_of_val(&self.force[..])
    }
}

/// The factored matrix of an implicit increment, and vectors to solve with.
pub struct FullSolve {
    operator: Operator,
    force: Vec<[f64; 3]>,
    overclosures: Vec<f64>,
    displacement: Vec<[f64; 3]>,
}

impl FullSolve {
    /// Factors the matrix that the first step, which is `*DYNAMIC`, has for an increment of a size \[time\]. Errors: a direction
    /// with neither stiffness nor mass, memory; a first step that is something else.
    pub fn of(prepared: &PreparedModel, size: f64) -> Result<Self, Vec<Diagnostic>> {
        let model = prepared.model();
        let Some(Procedure::Dynamic(control)) = model.steps.first().map(|step| &step.procedure) else {
            let place = crate::diagnostic::Place::nowhere();
            let message = "the first step is no implicit dynamic one";
            return Err(vec![Diagnostic::error(place, "*DYNAMIC", message, "write *DYNAMIC in the first step")]);
        };
        let blend = Hht::new(control.alpha, size).blend(control.mass);
        let operator = Operator::new(prepared, prepared.implicit(), blend)?;
        let nodes = model.mesh.nodes.len();
        let wave = |i: usize| std::array::from_fn(|d| ((3 * i + d) as f64 * 0.7).sin());
        Ok(Self {
            operator,
            force: (0..nodes).map(wave).collect(),
            overclosures: vec![0.0; prepared.rows.count()],
            displacement: vec![[0.0; 3]; nodes],
        })
    }

    /// One solve: the displacements of all nodes under forces on all nodes and at the contact points. Gives a number of the result, so
    /// that nothing can leave the solve out.
    pub fn run(&mut self) -> f64 {
        self.overclosures.fill(0.0);
        self.operator.begin(&self.force, &mut self.overclosures);
        // Contact takes what it is given; here it holds against nothing.
        let contact = vec![0.0; self.overclosures.len()];
        self.operator.end(&contact, &mut self.displacement);
        self.displacement[0][0]
    }
}
