//! What each row of the contact system does in an increment: from the model, its step and the state.
//!
//! Rows stand in the order of the contact points, then the tangential rows that rough friction and tangential damping need.

use crate::contact::points::ContactPoint;
use crate::law::{Damping, NormalBehavior, Penalty};
use crate::model::{
    ContactControls, Enforcement, Friction, FrictionOnset, MechanicalConstraint, Model, ModifiedHard,
    PenetrationTolerance, StepContact,
};
use crate::solve::contact::{Curve, Dashpot, Row, Viscosity, Wall};
use crate::state::State;

/// Augmented Lagrange: automatic stiffness over that of the underlying elements. Source: later Abaqus manuals; the value of v6.5 is
/// not printed.
const AUGMENTED_STIFFNESS: f64 = 1000.0;
/// Linear penalty: the same. Source: as above.
const PENALTY_STIFFNESS: f64 = 10.0;
/// Nonlinear penalty: final stiffness over that of the underlying elements. Source: as above.
const FINAL_STIFFNESS: f64 = 100.0;
/// Automatic stabilization: pressure that a point moving by its underlying elements' size over the step meets, over what straining them by
/// one would take. Our choice: the manual gives no value.
const STABILIZATION: f64 = 1e-4;

/// A tangential row: slip of a contact point along one of its tangents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tangential {
    /// Contact point.
    pub point: u32,
    /// Tangent, 0 or 1.
    pub direction: u8,
}

/// Rows of a model. Immutable.
pub struct RowPlan {
    /// Pair of each contact point.
    pub pairs: Vec<u32>,
    /// Area of each contact point [length²].
    areas: Vec<f64>,
    /// Characteristic length at each contact point \[length\].
    lengths: Vec<f64>,
    /// Penalty stiffness of each contact point, 0 where there is none [pressure/length].
    stiffnesses: Vec<f64>,
    /// Stiffness of the elements underneath, 0 where there are none [pressure/length].
    underlying: Vec<f64>,
    /// Tangential rows.
    pub tangential: Vec<Tangential>,
}

/// Whether some step needs tangential rows at a pair.
fn needs_tangential(model: &Model, pair: usize) -> bool {
    let interaction = &model.interactions[model.pairs[pair].interaction.index()];
    let damped = interaction.damping.is_some_and(|d| d.tangent_fraction > 0.0 && d.coefficient > 0.0);
    let in_step = |contact: &StepContact| {
        friction_of(model, contact, pair) == Friction::Rough
            || contact.controls_of(pair).stabilization.is_some_and(|s| s.tangent_fraction > 0.0)
    };
    damped || model.steps.iter().any(|step| in_step(&step.contact))
}

/// Friction of a pair in a step.
fn friction_of(model: &Model, contact: &StepContact, pair: usize) -> Friction {
    let own = model.interactions[model.pairs[pair].interaction.index()].friction;
    contact.frictions.get(pair).copied().unwrap_or(own)
}

/// Contact points followed by a point for each tangential row, whose normal is the tangent turned round: its overclosure is the slip.
pub fn with_tangential(model: &Model, points: &[ContactPoint]) -> Vec<ContactPoint> {
    let mut rows = points.to_vec();
    let needed: Vec<bool> = (0..model.pairs.len()).map(|pair| needs_tangential(model, pair)).collect();
    for point in points.iter().filter(|p| needed[p.pair as usize]) {
        for tangent in point.tangents {
            rows.push(ContactPoint { normal: tangent.map(|x| -x), clearance: 0.0, ..point.clone() });
        }
    }
    rows
}

impl RowPlan {
    /// Rows of a model; the pairs whose automatic stiffness has nothing to be taken from are the error.
    pub fn new(model: &Model, points: &[ContactPoint]) -> Result<Self, Vec<u32>> {
        let mut lost: Vec<u32> = Vec::new();
        let mut stiffnesses = Vec::with_capacity(points.len());
        let mut tangential = Vec::new();
        for (i, point) in (0..).zip(points) {
            let interaction = &model.interactions[model.pairs[point.pair as usize].interaction.index()];
            let wanted = match (&interaction.normal, interaction.enforcement) {
                (NormalBehavior::Softened(_), _) | (_, Enforcement::Lagrange) => Some(0.0),
                (_, Enforcement::AugmentedLagrange(line)) => {
                    let automatic = point.underlying.map(|k| AUGMENTED_STIFFNESS * k);
                    line.stiffness.or(automatic).map(|k| line.scale * k)
                }
                (_, Enforcement::Penalty(line)) => {
                    let automatic = point.underlying.map(|k| PENALTY_STIFFNESS * k);
                    line.stiffness.or(automatic).map(|k| line.scale * k)
                }
                (_, Enforcement::NonlinearPenalty(line)) => {
                    let automatic = point.underlying.map(|k| FINAL_STIFFNESS * k);
                    line.stiffness_final.or(automatic).map(|k| line.scale * k)
                }
            };
            // An automatic stabilization is a part of the same stiffness.
            let stabilized = |contact: &StepContact| {
                let stabilization = contact.controls_of(point.pair as usize).stabilization;
                stabilization.is_some_and(|s| s.coefficient.is_none())
            };
            let unknown = wanted.is_none()
                || point.underlying.is_none() && model.steps.iter().any(|step| stabilized(&step.contact));
            if unknown && lost.last() != Some(&point.pair) {
                lost.push(point.pair);
            }
            stiffnesses.push(wanted.unwrap_or(0.0));
            if needs_tangential(model, point.pair as usize) {
                tangential.extend([0, 1].map(|direction| Tangential { point: i, direction }));
            }
        }
        if !lost.is_empty() {
            lost.dedup();
            return Err(lost);
        }
        Ok(Self {
            pairs: points.iter().map(|p| p.pair).collect(),
            areas: points.iter().map(|p| p.area).collect(),
            lengths: points.iter().map(|p| p.length).collect(),
            stiffnesses,
            underlying: points.iter().map(|p| p.underlying.unwrap_or(0.0)).collect(),
            tangential,
        })
    }

    /// First tangential row of each point that has some, ascending.
    pub fn first_tangential(&self) -> Vec<(u32, u32)> {
        let rows = self.tangential.iter().zip(self.pairs.len() as u32..);
        rows.filter(|(t, _)| t.direction == 0).map(|(t, row)| (t.point, row)).collect()
    }

    /// Number of contact points.
    pub fn points(&self) -> usize {
        self.pairs.len()
    }

    /// Characteristic length at a contact point \[length\].
    pub fn length(&self, point: usize) -> f64 {
        self.lengths[point]
    }

    /// Number of rows.
    pub fn count(&self) -> usize {
        self.pairs.len() + self.tangential.len()
    }
}

/// Rows in one step, at one time.
#[derive(Clone, Copy)]
pub struct Moment<'a> {
    /// The model.
    pub model: &'a Model,
    /// Its rows.
    pub plan: &'a RowPlan,
    /// Index of the step.
    pub step: usize,
    /// Step time at the end of the increment over the period, in 0..1.
    pub progress: f64,
    /// Period of the step \[time\].
    pub period: f64,
}

impl<'a> Moment<'a> {
    fn contact(&self) -> &'a StepContact {
        &self.model.steps[self.step].contact
    }

    /// Controls of a point's pair.
    pub fn controls(&self, point: usize) -> ContactControls {
        self.contact().controls_of(self.plan.pairs[point] as usize)
    }

    /// Whether a point's pair acts.
    pub fn is_active(&self, point: usize) -> bool {
        self.contact().is_active(self.plan.pairs[point] as usize)
    }

    /// Whether a point's pair has rough friction.
    pub fn is_rough(&self, point: usize) -> bool {
        friction_of(self.model, self.contact(), self.plan.pairs[point] as usize) == Friction::Rough
    }

    /// Enforcement of hard contact at a point; none where its law is softened.
    pub fn enforcement(&self, point: usize) -> Option<Enforcement> {
        let interaction = &self.model.interactions[self.interaction(point)];
        (interaction.normal == NormalBehavior::Hard).then_some(interaction.enforcement)
    }

    /// Controls of modified hard contact where they apply: to hard contact by multipliers.
    pub fn modified(&self, point: usize) -> Option<ModifiedHard> {
        let hard = self.is_active(point) && self.enforcement(point) == Some(Enforcement::Lagrange);
        self.controls(point).modified.filter(|_| hard && !self.is_dynamic())
    }

    /// Whether a closed point has no overclosure: hard contact by multipliers, or kinematic.
    pub fn is_exact(&self, point: usize) -> bool {
        let by_penalty = self.model.is_explicit()
            && self.model.pairs[self.plan.pairs[point] as usize].explicit.constraint == MechanicalConstraint::Penalty;
        self.enforcement(point) == Some(Enforcement::Lagrange) && !by_penalty
    }

    /// Whether statuses of hard points change by impacts and releases, not within a solve.
    pub fn is_dynamic(&self) -> bool {
        self.model.steps[self.step].procedure.is_dynamic()
    }

    /// Whether surfaces at a point may not separate again.
    pub fn latches(&self, point: usize) -> bool {
        self.model.interactions[self.interaction(point)].separation == crate::law::Separation::Prevented
    }

    /// Penetration that augmented Lagrange leaves at a point, and the clearance at which its pressure begins \[length\]; none for
    /// other points.
    pub fn penetration_max(&self, point: usize) -> Option<(f64, f64)> {
        match self.enforcement(point)? {
            Enforcement::AugmentedLagrange(line) if self.is_active(point) => {
                let tolerance = match self.controls(point).penetration_tolerance {
                    PenetrationTolerance::Absolute(length) => length,
                    PenetrationTolerance::Relative(part) => part * self.plan.lengths[point],
                };
                Some((tolerance, line.clearance))
            }
            _ => None,
        }
    }

    fn interaction(&self, point: usize) -> usize {
        self.model.pairs[self.plan.pairs[point] as usize].interaction.index()
    }

    /// Row of a contact point without its dashpot.
    pub fn normal_row(&self, state: &State, point: usize, closed: bool, multiplier: f64) -> Row {
        let mut row = Row { area: self.plan.areas[point], ..Row::default() };
        if !self.is_active(point) {
            return row;
        }
        let latched = state.latched[point];
        let stiffness = self.controls(point).stiffness_scale * self.plan.stiffnesses[point];
        let extend = |curve: Penalty| Curve::Penalty(if latched { curve.extended() } else { curve });
        match self.enforcement(point) {
            None => row.curve = Curve::Law(self.interaction(point) as u32),
            Some(Enforcement::Lagrange) => {
                row.wall = match (latched, self.modified(point).is_some() || self.is_dynamic()) {
                    (true, _) => Wall::TwoSided,
                    (false, true) if closed => Wall::TwoSided,
                    (false, true) => Wall::None,
                    (false, false) => Wall::OneSided,
                };
            }
            // p = max(0, λ + k (h + c0))
            Some(Enforcement::AugmentedLagrange(line)) => {
                row.curve = extend(Penalty::linear(stiffness, line.clearance + multiplier / stiffness));
            }
            Some(Enforcement::Penalty(line)) => row.curve = extend(Penalty::linear(stiffness, line.clearance)),
            Some(Enforcement::NonlinearPenalty(line)) => {
                let upper = line.upper_limit * self.plan.lengths[point];
                let initial = line.stiffness_ratio * stiffness;
                let curve = Penalty::nonlinear(initial, stiffness, line.lower_ratio * upper, upper, line.clearance);
                row.curve = extend(curve);
            }
        }
        row
    }

    /// Row of a tangential direction: tied at the place where its point began to stick, or free.
    pub fn tangential_row(&self, state: &State, row: Tangential, tied: bool) -> Row {
        let point = row.point as usize;
        let origin = state.origins[usize::from(row.direction) * self.plan.points() + point];
        let wall = if tied { Wall::TwoSided } else { Wall::None };
        Row { area: self.plan.areas[point], wall, position: origin, ..Row::default() }
    }

    /// Whether a point that is closed sticks.
    pub fn sticks(&self, point: usize, closed: bool, was_closed: bool) -> bool {
        let onset = self.controls(point).friction_onset == FrictionOnset::Immediate || was_closed;
        self.is_active(point) && self.is_rough(point) && closed && onset
    }

    /// Dashpots of a point: contact damping and stabilization; none where nothing damps.
    fn dampings(&self, point: usize) -> [Damping; 2] {
        let none = Damping { coefficient: 0.0, clearance: 1.0, fraction: 0.0 };
        if !self.is_active(point) {
            return [none; 2];
        }
        let own = self.model.interactions[self.interaction(point)].damping.map(|d| Damping {
            coefficient: d.coefficient,
            clearance: d.clearance,
            fraction: d.fraction,
        });
        let stabilization = self.controls(point).stabilization.map(|s| {
            let automatic = s.factor * STABILIZATION * self.plan.underlying[point] * self.period;
            let left = 1.0 - (1.0 - s.fraction_end) * self.progress;
            Damping {
                coefficient: s.coefficient.unwrap_or(automatic) * left,
                clearance: s.clearance.unwrap_or(self.plan.lengths[point]),
                fraction: 0.0,
            }
        });
        [own.unwrap_or(none), stabilization.unwrap_or(none)]
    }

    /// Dashpot of a point over an increment of a size that began at an overclosure.
    pub fn dashpot(&self, point: usize, start: f64, size: f64) -> Option<Dashpot> {
        let dampings = self.dampings(point);
        let acts = size > 0.0 && dampings.iter().any(|d| d.coefficient > 0.0);
        acts.then(|| Dashpot { viscosity: Viscosity::Ramps(dampings), start, rate: 1.0 / size })
    }

    /// Tangential dashpot at the present overclosure of the point.
    pub fn tangential_dashpot(&self, point: usize, overclosure: f64, start: f64, size: f64) -> Option<Dashpot> {
        let own = self.model.interactions[self.interaction(point)].damping.map_or(0.0, |d| d.tangent_fraction);
        let stabilization = self.controls(point).stabilization.map_or(0.0, |s| s.tangent_fraction);
        let [a, b] = self.dampings(point);
        let coefficient = own * a.at(overclosure).0 + stabilization * b.at(overclosure).0;
        let acts = size > 0.0 && coefficient > 0.0;
        acts.then(|| Dashpot { viscosity: Viscosity::Constant(coefficient), start, rate: 1.0 / size })
    }
}
