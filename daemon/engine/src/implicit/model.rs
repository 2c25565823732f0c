//! What implicit dynamic steps need of a model: its matrices on nodes, and how its bodies are numbered.

use crate::model::{MassMatrix, Model};
use crate::simulation::PathChoice;
use crate::solve::block_matrix::BlockMatrix;
use crate::solve::bodies::{choose_path, points_of_body};
use crate::solve::context::{Blend, Context};
use crate::solve::floating::Floating;
use crate::solve::inertia;
use crate::solve::motions::Motions;
use crate::solve::numbering::Bodies;
use crate::solve::plan::BodyPlan;

/// Matrices on nodes, and plans of the bodies. Immutable.
pub struct ImplicitModel {
    /// `K`.
    pub stiffness: BlockMatrix,
    /// `M` of each form that a step asks for.
    masses: Vec<(MassMatrix, BlockMatrix)>,
    /// `C`, where anything damps.
    damping: Vec<(MassMatrix, BlockMatrix)>,
    /// Plans for matrices with stiffness.
    pub plans: Vec<BodyPlan>,
    /// Whether bodies are condensed onto their contact points.
    pub condense: bool,
    /// Most memory that operators may take \[bytes\].
    pub memory_limit: Option<u64>,
}

/// Forms of the mass matrix that the implicit steps of a model ask for.
fn forms(model: &Model) -> Vec<MassMatrix> {
    let mut forms: Vec<MassMatrix> = Vec::new();
    for step in &model.steps {
        if let crate::model::Procedure::Dynamic(control) = &step.procedure
            && !forms.contains(&control.mass)
        {
            forms.push(control.mass);
        }
    }
    forms
}

impl ImplicitModel {
    /// Assembles the matrices of a model with an implicit dynamic step; none for others.
    pub fn new(context: &Context<'_>, bodies: &Bodies, path: PathChoice, memory_limit: Option<u64>) -> Option<Self> {
        let model = context.model;
        let forms = forms(model);
        if forms.is_empty() {
            return None;
        }
        let mut still: Vec<Motions> = bodies.nodes.iter().map(|_| Motions::none()).collect();
        let floating = Floating::new(model, context.constraints, context.points, bodies, &mut still);
        let (condense, _) = choose_path(context, path, bodies, &still, &floating);
        let plan = |b: usize| {
            let points = points_of_body(context, bodies, b);
            BodyPlan::new(context, &bodies.nodes[b], &bodies.elements[b], &[], points, condense)
        };
        let plans = (0..bodies.nodes.len()).map(plan).collect();
        let assemble = |blend: Blend| {
            let context = Context { blend, ..*context };
            BlockMatrix::assemble(&model.mesh, &mut |e, out| context.element_matrix(e, out))
        };
        let stiffness = assemble(Blend::STIFFNESS);
        let masses = forms.iter().map(|&form| (form, assemble(Blend::mass(form)))).collect();
        let damps = (0..model.mesh.elements.len() as u32).any(|e| inertia::damps(model, e));
        let of_form = |&form: &MassMatrix| (form, assemble(Blend { stiffness: 0.0, damping: 1.0, mass: 0.0, form }));
        let damping = if damps { forms.iter().map(of_form).collect() } else { Vec::new() };
        Some(Self { stiffness, masses, damping, plans, condense, memory_limit })
    }

    /// `M`.
    pub fn mass(&self, form: MassMatrix) -> &BlockMatrix {
        let (_, matrix) = self.masses.iter().find(|(own, _)| *own == form).expect("every form of a step is assembled");
        matrix
    }

    /// `C`, if anything damps.
    pub fn damping(&self, form: MassMatrix) -> Option<&BlockMatrix> {
        self.damping.iter().find(|(own, _)| *own == form).map(|(_, matrix)| matrix)
    }
}
