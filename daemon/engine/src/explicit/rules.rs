//! What each contact point does in a step of Abaqus/Explicit: enforcement, law, stiffness, damping.

use super::slots::Slots;
use super::stable::default_stiffness;
use crate::contact::points::ContactPoint;
use crate::law::{
    Exponential, LawPoint, LawProcedure, NormalBehavior, Penalty, PressureLaw, PressureOverclosure, ResolvedLaw,
    Separation,
};
use crate::model::{DampingDefinition, Friction, MechanicalConstraint, Model, PairMembers};
use crate::nodal::flat;

/// Pressure over overclosure of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// None: no overclosure.
    Hard,
    /// Softened, that of an interaction.
    Interaction(u32),
    /// An exponential law with a limit of its own.
    Limited(Exponential),
    /// The penalty that stands in for hard contact.
    Penalty(Penalty),
}

/// A contact point in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rule {
    /// Whether its pair acts.
    pub acts: bool,
    /// How its constraint is enforced.
    pub constraint: MechanicalConstraint,
    /// Its law.
    pub law: Law,
    /// Area that its law acts on \[length²\]: under kinematic enforcement all that its node stands for, else its share of it.
    pub area: f64,
    /// Share of the result: 1, or its part in a balanced pair.
    pub share: f64,
    /// Whether it belongs to the second surface of its pair.
    pub mirrored: bool,
    /// Whether surfaces may not separate once they have touched.
    pub latches: bool,
    /// Whether there is no slip.
    pub rough: bool,
    /// Default penalty stiffness [force/length].
    pub stiffness: f64,
    /// Damping, and its tangential part of it.
    pub damping: DampingDefinition,
    /// See `damping`.
    pub tangent_fraction: f64,
    /// Mass that critical damping is a part of \[mass\].
    pub mass: f64,
    /// First tangential row, where the pair has some.
    pub tangential: Option<u32>,
}

/// Softened laws by interaction: of points that may separate, and of points that may not.
pub struct Laws(Vec<Option<[ResolvedLaw; 2]>>);

/// A pair that asks for a law that cannot be resolved.
pub fn laws(model: &Model) -> Result<Laws, String> {
    let resolved = |law: &PressureOverclosure, separation| {
        ResolvedLaw::new(&law.parameters().into(), separation, LawProcedure::Explicit).map_err(|e| e.to_string())
    };
    let of = |i: &crate::model::SurfaceInteraction| match &i.normal {
        NormalBehavior::Hard => Ok(None),
        NormalBehavior::Softened(law) => Ok(Some([resolved(law, Separation::Allowed)?, resolved(law, i.separation)?])),
    };
    Ok(Laws(model.interactions.iter().map(of).collect::<Result<_, String>>()?))
}

impl Laws {
    /// Pressure of a rule at an overclosure [length]; `latched` points pull where their law goes on into tension.
    pub fn evaluate(&self, rule: &Rule, overclosure: f64, latched: bool) -> LawPoint {
        match &rule.law {
            Law::Hard => LawPoint::default(),
            Law::Interaction(i) => self.0[*i as usize]
                .as_ref()
                .map_or_else(LawPoint::default, |laws| laws[usize::from(latched)].evaluate(overclosure)),
            Law::Limited(law) => law.evaluate(overclosure),
            Law::Penalty(law) => (if latched { law.extended() } else { *law }).evaluate(overclosure),
        }
    }

    /// Overclosure at which a rule begins to push [length].
    pub fn onset(&self, rule: &Rule) -> f64 {
        match &rule.law {
            Law::Hard | Law::Penalty(_) => 0.0,
            Law::Interaction(i) => self.0[*i as usize].as_ref().map_or(0.0, |laws| laws[0].overclosure_at(0.0)),
            Law::Limited(law) => law.overclosure_at(0.0),
        }
    }

    /// The slope of a rule where it has only one: dp/dh [pressure/length].
    pub fn constant_slope(&self, rule: &Rule) -> Option<f64> {
        match &rule.law {
            Law::Penalty(law) => Some(law.stiffness()),
            Law::Hard => None,
            Law::Limited(law) => law.stiffness_max(),
            Law::Interaction(i) => {
                let law = &self.0[*i as usize].as_ref()?[0];
                // A straight law has one kink, at its onset; a limited exponential none, and its limit bounds it.
                match law.kinks()[..] {
                    [onset] => Some(law.evaluate(onset + onset.abs().max(1.0)).stiffness),
                    _ => None,
                }
            }
        }
    }
}

impl Rule {
    /// Force per closing speed at a stiffness of the law [pressure/length]: [force·time/length].
    pub fn viscosity(&self, slope: f64) -> f64 {
        match self.damping {
            DampingDefinition::Coefficient(mu) => mu * self.area,
            DampingDefinition::CriticalFraction(xi) => 2.0 * xi * (self.mass * self.area * slope).sqrt(),
        }
    }
}

/// Rules of all points in a step. `masses`: lumped masses of all nodes; `free`: the stable increment without contact \[time\].
pub fn of_step(
    model: &Model,
    step: usize,
    points: &[ContactPoint],
    tangential: &[(u32, u32)],
    slots: &Slots,
    masses: &[f64],
    free: f64,
) -> Vec<Rule> {
    let contact = &model.steps[step].contact;
    let rule = |(i, point): (usize, &ContactPoint)| {
        let pair = &model.pairs[point.pair as usize];
        let interaction = &model.interactions[pair.interaction.index()];
        let general = matches!(pair.members, PairMembers::General(_));
        let constraint = if general { MechanicalConstraint::Penalty } else { pair.explicit.constraint };
        let by_penalty = constraint == MechanicalConstraint::Penalty;
        let friction = contact.frictions.get(point.pair as usize).copied().unwrap_or(interaction.friction);
        // The mass of the secondary node or, if smaller, what both sides have together.
        let compliance = slots.rows[i].compliance;
        let together = if compliance > 0.0 { 1.0 / compliance } else { f64::INFINITY };
        let own = Some(masses[flat(point.node, 0) / 3]).filter(|m| *m > 0.0);
        let smaller = own.map_or(together, |m| m.min(together));
        let share = point.share;
        let unscaled = if smaller.is_finite() { share * default_stiffness(smaller, free) } else { 0.0 };
        let stiffness = contact.controls_of(point.pair as usize).scale_penalty * unscaled;
        let area = if by_penalty { point.area } else { point.area / share };
        let law = match (&interaction.normal, by_penalty) {
            (NormalBehavior::Hard, false) => Law::Hard,
            (NormalBehavior::Hard, true) => Law::Penalty(Penalty::linear(stiffness / area, 0.0)),
            (NormalBehavior::Softened(PressureOverclosure::Exponential(law)), true)
                if law.stiffness_max().is_none() =>
            {
                let limited = Exponential::with_stiffness_max(
                    law.clearance_at_zero_pressure(),
                    law.pressure_at_zero_clearance(),
                    unscaled / area,
                );
                // A limit beyond all measure is none.
                limited.map_or(Law::Interaction(pair.interaction.0), Law::Limited)
            }
            (NormalBehavior::Softened(_), _) => Law::Interaction(pair.interaction.0),
        };
        Rule {
            acts: contact.is_active(point.pair as usize),
            constraint,
            law,
            area,
            share,
            mirrored: point.mirrored,
            latches: interaction.separation == Separation::Prevented,
            rough: friction == Friction::Rough,
            stiffness,
            damping: interaction.explicit_damping.definition,
            tangent_fraction: interaction.explicit_damping.tangent_fraction,
            // Dashpots of balanced points add up to the one of a pure point.
            mass: own.unwrap_or(together) * if by_penalty { share } else { 1.0 },
            tangential: tangential.binary_search_by_key(&(i as u32), |t| t.0).ok().map(|k| tangential[k].1),
        }
    };
    points.iter().enumerate().map(rule).collect()
}
