//! One matrix factored, its compliance at the contact points, and solves with it.

use std::sync::Arc;

use super::{Hht, ImplicitModel};
use crate::diagnostic::Diagnostic;
use crate::model::MassMatrix;
use crate::prepared::PreparedModel;
use crate::solve::body::{Body, BodyContribution, BodyError};
use crate::solve::budget::Budget;
use crate::solve::contact::{ContactSolver, ContactSystem, Structure};
use crate::solve::context::{Blend, Context};
use crate::solve::floating::Floating;
use crate::solve::linear::Dense;
use crate::solve::motions::Motions;
use crate::solve::plan::BodyPlan;
use crate::solve::sparse::{Coupled, SparseStructure};

/// Operators that are kept; the least recently used goes first.
const KEPT_MAX: usize = 12;

/// A matrix of bodies, factored.
pub struct Operator {
    bodies: Arc<Vec<Body>>,
    /// Compliance at the contact rows.
    pub system: ContactSystem,
    /// Its solver.
    pub solver: ContactSolver,
    /// Halves of solves, one per body.
    halves: Vec<Dense>,
    /// Whether anything but diagonals was factored.
    pub was_factored: bool,
}

impl Operator {
    /// Factors the bodies made of a blend. Errors: a direction with neither stiffness nor mass, memory.
    pub fn new(prepared: &PreparedModel, model: &ImplicitModel, blend: Blend) -> Result<Self, Vec<Diagnostic>> {
        let budget = Budget::new(model.memory_limit);
        let context = Context { blend, columns: &[], points: &prepared.row_points, ..prepared.context(&budget) };
        let numbering = &prepared.numbering;
        let massive = blend.stiffness == 0.0;
        let (mut bodies, mut parts, mut errors) = (Vec::new(), Vec::new(), Vec::new());
        let mut was_factored = false;
        for (b, (nodes, elements)) in numbering.nodes.iter().zip(&numbering.elements).enumerate() {
            let own;
            let plan = match massive {
                false => &model.plans[b],
                true => {
                    let known = &model.plans[b];
                    own = BodyPlan::new(&context, nodes, elements, &[], known.points.clone(), known.condense);
                    &own
                }
            };
            was_factored |= plan.count > 0 && elements.iter().any(|&e| context.couples(e));
            match Body::prepare_by(&context, nodes, elements, plan, &mut |_| {}) {
                Ok((body, part)) => {
                    bodies.push(body);
                    parts.push(part);
                }
                Err(error) => errors.push(describe(prepared, b, error)),
            }
        }
        if !errors.is_empty() {
            return Err(errors);
        }
        let bodies = Arc::new(bodies);
        let structure = match model.condense {
            true => Structure::Dense(compliance(&bodies, &parts, context.points.len())),
            false => {
                let mut still: Vec<Motions> = numbering.nodes.iter().map(|_| Motions::none()).collect();
                let floating = Floating::new(context.model, context.constraints, context.points, numbering, &mut still);
                let coupled = Coupled::new(&context, numbering, &still, &floating);
                let own = coupled.own_compliances();
                Structure::Sparse(Box::new(SparseStructure { bodies: bodies.clone(), coupled, own }))
            }
        };
        let system = ContactSystem {
            extent: prepared.extent,
            springs: Vec::new(),
            gap_motions: Dense::zeros(prepared.rows.count(), 0),
            resisted: Vec::new(),
            loose: Dense::default(),
            structure,
            count: prepared.rows.count(),
            behaviors: prepared.model.interactions.iter().map(|i| i.normal.clone()).collect(),
        };
        let solver = ContactSolver::new(&system);
        let halves = bodies.iter().map(|_| Dense::default()).collect();
        Ok(Self { bodies, system, solver, halves, was_factored })
    }

    /// The first half of a solve: overclosures that nodal forces on independent directions cause are added.
    pub fn begin(&mut self, forces: &[[f64; 3]], overclosures: &mut [f64]) {
        for (body, half) in self.bodies.iter().zip(&mut self.halves) {
            body.begin_solve(forces, overclosures, half);
        }
    }

    /// The second half: displacements of free directions under these forces less contact forces, into `out`.
    pub fn end(&mut self, contact: &[f64], out: &mut [[f64; 3]]) {
        for (body, half) in self.bodies.iter().zip(&mut self.halves) {
            body.end_solve(contact, half, out);
        }
    }
}

/// `W` of all bodies together.
fn compliance(bodies: &[Body], parts: &[BodyContribution], rows: usize) -> Dense {
    let mut out = Dense::zeros(rows, rows);
    for (body, part) in bodies.iter().zip(parts) {
        for (j, &q) in body.points.iter().enumerate() {
            for (i, &p) in body.points.iter().enumerate() {
                out.column_mut(q as usize)[p as usize] += part.compliance.column(j)[i];
            }
        }
    }
    out
}

fn describe(prepared: &PreparedModel, body: usize, error: BodyError) -> Diagnostic {
    let (message, remedy) = match error {
        BodyError::NoStiffness { node, direction } => (
            format!(
                "node {} has neither mass nor stiffness in degree of freedom {}",
                prepared.model.mesh.node_labels[node.index()],
                prepared.model.mesh.dof_of(node, direction as u8)
            ),
            "give it a mass (*DENSITY, *MASS, *ROTARY INERTIA), or hold it by *BOUNDARY",
        ),
        BodyError::Memory(shortage) => {
            (shortage.describe(&prepared.name_of_body(body)), "use a coarser mesh, or a machine with more memory")
        }
    };
    Diagnostic::error(crate::diagnostic::Place::nowhere(), "*DYNAMIC", message, remedy)
}

/// Operators of the increment sizes in use.
#[derive(Default)]
pub struct Operators {
    /// Latest use last.
    kept: Vec<(Key, Operator)>,
    /// The mass matrix.
    mass: Option<(MassMatrix, Operator)>,
}

/// What tells operators apart.
type Key = (u64, u64, MassMatrix);

impl Operators {
    /// Operator of an increment, and whether it had to be factored.
    pub fn increment(
        &mut self,
        prepared: &PreparedModel,
        hht: &Hht,
        form: MassMatrix,
    ) -> Result<(&mut Operator, bool), Vec<Diagnostic>> {
        let key = (hht.alpha.to_bits(), hht.size.to_bits(), form);
        let known = self.kept.iter().position(|(own, _)| *own == key);
        match known {
            Some(at) => self.kept[at..].rotate_left(1),
            None => {
                if self.kept.len() == KEPT_MAX {
                    self.kept.remove(0);
                }
                let operator = Operator::new(prepared, prepared.implicit(), hht.blend(form))?;
                self.kept.push((key, operator));
            }
        }
        let (_, operator) = self.kept.last_mut().expect("one was found or has been added");
        Ok((operator, known.is_none()))
    }

    /// Operator of the mass matrix, and whether it had to be factored.
    pub fn mass(
        &mut self,
        prepared: &PreparedModel,
        form: MassMatrix,
    ) -> Result<(&mut Operator, bool), Vec<Diagnostic>> {
        let mut fresh = false;
        if self.mass.as_ref().is_none_or(|(own, _)| *own != form) {
            let operator = Operator::new(prepared, prepared.implicit(), Blend::mass(form))?;
            fresh = operator.was_factored;
            self.mass = Some((form, operator));
        }
        let (_, operator) = self.mass.as_mut().expect("it was there or has been made");
        Ok((operator, fresh))
    }
}
