//! What explicit steps need of a model: found at preparation, never changed.

use super::elements;
use super::phase::{Phase, Source, without_inertia};
use super::plan::StepPlan;
use super::rules::{self, Law, Laws};
use super::scaling;
use crate::contact::points::ContactPoint;
use crate::diagnostic::{Diagnostic, Place};
use crate::element::Elasticity;
use crate::model::{ExplicitControl, ExplicitIncrements, MechanicalConstraint, Model, Procedure};
use crate::nodal::Nodal;
use crate::solve::assembly::element_stiffness;
use crate::solve::block_matrix::BlockMatrix;
use crate::solve::budget::Budget;
use crate::solve::columns::Column;
use crate::solve::constraints::Constraints;

/// Part of the step that an increment has where nothing limits it.
pub const UNLIMITED: f64 = 1e-3;
/// Nodes named in a message.
const NAMED: usize = 8;

/// What an explicit model is made from.
pub struct Setting<'a> {
    /// The model.
    pub model: &'a Model,
    /// Elastic constants by material.
    pub elasticities: &'a [Elasticity],
    /// Prescribed and dependent directions.
    pub constraints: &'a Constraints,
    /// Columns that carry loads.
    pub columns: &'a [Column],
    /// Contact rows.
    pub nodal: &'a Nodal,
    /// Contact points.
    pub points: &'a [ContactPoint],
    /// The same followed by the tangential rows.
    pub row_points: &'a [ContactPoint],
    /// First tangential row of each point that has some, ascending.
    pub tangential: Vec<(u32, u32)>,
}

/// See the module.
pub struct ExplicitModel {
    /// Stiffness over all nodes, nothing eliminated.
    pub(super) stiffness: BlockMatrix,
    pub(super) laws: Laws,
    pub(super) phases: Vec<Phase>,
    pub(super) steps: Vec<StepPlan>,
    /// Findings that leave the answer standing.
    pub warnings: Vec<Diagnostic>,
}

/// An error without a line of its own.
fn error(keyword: &'static str, message: String, remedy: &str) -> Diagnostic {
    Diagnostic::error(Place::nowhere(), keyword, message, remedy)
}

/// Control of an explicit step.
pub fn control(model: &Model, step: usize) -> &ExplicitControl {
    match &model.steps[step].procedure {
        Procedure::Explicit(control) => control,
        Procedure::Static(_) | Procedure::Dynamic(_) => {
            unreachable!("the deck reader mixes no explicit steps with others")
        }
    }
}

/// Increment that default penalties are made for, given the stable one without contact \[time\].
fn free_increment(control: &ExplicitControl, stable: f64) -> f64 {
    // What lets go a whole step in one increment limits nothing.
    if stable < control.period {
        return stable;
    }
    match (control.increments, control.increment_max) {
        (ExplicitIncrements::Direct(size), _) => size,
        (_, Some(largest)) => largest.min(control.period),
        _ => UNLIMITED * control.period,
    }
}

impl ExplicitModel {
    /// Prepares all steps. Errors are findings about the deck.
    pub fn new(setting: &Setting<'_>, budget: &Budget) -> Result<Self, Vec<Diagnostic>> {
        let Setting { model, elasticities, constraints, columns, nodal, points, row_points, .. } = *setting;
        let too_large = |shortage: &crate::solve::budget::Shortage| {
            vec![error("", shortage.describe("explicit dynamics"), "use a coarser mesh, or a machine with more memory")]
        };
        let stiffness =
            BlockMatrix::assemble(&model.mesh, &mut |e, out| element_stiffness(model, elasticities, e, out));
        budget.take(stiffness.bytes() / 8).map_err(|s| too_large(&s))?;
        let parts = elements::parts(model, elasticities);
        let source = Source { model, elasticities, constraints, columns, nodal, row_points, parts: &parts };
        let laws = rules::laws(model).map_err(|message| vec![error("*SURFACE BEHAVIOR", message, "")])?;
        let mut factors = vec![1.0; parts.len()];
        let mut this = Self { stiffness, laws, phases: Vec::new(), steps: Vec::new(), warnings: Vec::new() };
        let mut bulk_before = None;
        for step in 0..model.steps.len() {
            let control = control(model, step);
            scaling::scale(model, &parts, control, &mut factors);
            if !control.mass_scaling.is_empty() || bulk_before != Some(control.bulk_viscosity) {
                let phase = Phase::new(&source, &factors, control.bulk_viscosity)
                    .map_err(|message| vec![error("*EQUATION", message, "")])?;
                budget.take(phase.numbers()).map_err(|s| too_large(&s))?;
                this.phases.push(phase);
            }
            bulk_before = Some(control.bulk_viscosity);
            let index = this.phases.len() - 1;
            let phase = &this.phases[index];
            let free = free_increment(control, phase.limits.increment);
            let rules =
                rules::of_step(model, step, points, &setting.tangential, &phase.slots, &phase.inertia.masses, free);
            let changed = this
                .steps
                .last()
                .is_some_and(|before| before.rules.iter().zip(&rules).any(|(a, b)| a.acts != b.acts || a.law != b.law));
            this.steps.push(StepPlan::new(index, phase, &this.laws, rules, changed));
        }
        let errors = this.findings(setting, &source);
        if !errors.is_empty() {
            return Err(errors);
        }
        this.warn_of_pressure(setting);
        Ok(this)
    }

    fn findings(&self, setting: &Setting<'_>, source: &Source<'_>) -> Vec<Diagnostic> {
        let mesh = &setting.model.mesh;
        let mut errors = Vec::new();
        let lost = without_inertia(&self.phases[0], source, &self.stiffness);
        let mut named: Vec<String> = Vec::new();
        for node in lost.chunk_by(|a, b| a / 3 == b / 3) {
            let index = node[0] as usize / 3;
            let dofs: Vec<String> =
                node.iter().map(|at| mesh.dof_of(crate::model::NodeId(at / 3), (at % 3) as u8).to_string()).collect();
            named.push(format!("{} in degree of freedom {}", mesh.node_labels[index], dofs.join(", ")));
        }
        if !named.is_empty() {
            let more = if named.len() > NAMED { format!(" and {} more", named.len() - NAMED) } else { String::new() };
            named.truncate(NAMED);
            errors.push(error(
                "*DYNAMIC, EXPLICIT",
                format!("something acts on nodes without inertia: node {}{more}", named.join("; node ")),
                "give their elements a *DENSITY or add MASS or ROTARYI elements, or hold them by *BOUNDARY",
            ));
        }
        let rigid = |node: crate::model::NodeId| {
            setting.model.rigid_bodies.iter().any(|b| b.reference == node || b.nodes.binary_search(&node).is_ok())
        };
        for (index, pair) in setting.model.pairs.iter().enumerate() {
            let kinematic = self.steps.iter().any(|plan| {
                let own = |(_, p): &(_, &ContactPoint)| p.pair as usize == index;
                plan.rules
                    .iter()
                    .zip(setting.points)
                    .filter(own)
                    .any(|(r, p)| r.acts && r.constraint == MechanicalConstraint::Kinematic && rigid(p.node))
            });
            if kinematic {
                errors.push(Diagnostic::error(
                    pair.place.clone(),
                    "*CONTACT PAIR",
                    format!("pair {}: nodes of a rigid body are secondary nodes of kinematic contact", pair.name),
                    "make the rigid surface the primary one, or use MECHANICAL CONSTRAINT=PENALTY",
                ));
            }
        }
        errors
    }

    /// Softened laws that push at the start, where nothing balances them.
    fn warn_of_pressure(&mut self, setting: &Setting<'_>) {
        let model = setting.model;
        let rules = &self.steps[0].rules;
        let mut largest = vec![0.0f64; model.pairs.len()];
        for (rule, point) in
            rules.iter().zip(setting.points).filter(|(r, _)| r.acts && !matches!(r.law, Law::Hard | Law::Penalty(_)))
        {
            let pressure = self.laws.evaluate(rule, -point.clearance, false).pressure;
            largest[point.pair as usize] = largest[point.pair as usize].max(pressure);
        }
        for (pair, pressure) in model.pairs.iter().zip(largest).filter(|(_, p)| *p > 0.0) {
            self.warnings.push(Diagnostic::warning(
                pair.place.clone(),
                "*SURFACE BEHAVIOR",
                format!(
                    "pair {}: the law presses with up to {pressure} at the start, where nothing balances it: the bodies are thrown apart",
                    pair.name
                ),
                "let the surfaces start as far apart as the law reaches: by their coordinates, or by *CLEARANCE",
            ));
        }
    }
}
