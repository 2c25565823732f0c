//! One increment: what acts at its start, how large it may be, and where it ends.

use super::energies::{Ledger, Power, Stand};
use super::hard::Correction;
use super::kick::{Kick, KickWork, Vectors, amend, kick, reaction_power};
use super::kinematic::{self, KinematicWork, Places, Refusal};
use super::model::ExplicitModel;
use super::penalty::{self, Present};
use super::plan::{LimitWork, Spring, StepPlan, increment_under, springs};
use crate::model::MechanicalConstraint;
use crate::nodal::Nodal;
use crate::simulation::Energies;
use crate::solve::columns::Column;

/// Halvings in the search for an increment whose end is still stable.
const HALVINGS: usize = 16;

/// What an increment reads and changes of the state. Rows are contact points followed by tangential rows.
pub struct Memory<'a> {
    /// Displacements.
    pub displacement: &'a mut [[f64; 3]],
    /// Velocities of the middle of the increment before.
    pub velocity: &'a mut [[f64; 3]],
    /// Accelerations.
    pub acceleration: &'a mut [[f64; 3]],
    /// Reactions.
    pub reaction: &'a mut [[f64; 3]],
    /// Force of each row.
    pub forces: &'a mut [f64],
    /// Its viscous part.
    pub viscous: &'a mut [f64],
    /// Whether each row carries a force.
    pub closed: &'a mut [bool],
    /// Whether each point may not separate any more.
    pub latched: &'a mut [bool],
    /// Whether each point sticks.
    pub stuck: &'a mut [bool],
    /// Where it began to, first tangents then second.
    pub origins: &'a mut [f64],
    /// Energies so far.
    pub ledger: &'a mut Ledger,
    /// Size of the increment before; 0 for none \[time\].
    pub last: f64,
    /// Whether a step begins.
    pub begins: bool,
}

/// Work space; nothing in it outlives an increment but what belongs to the step.
pub struct ExplicitWork {
    step: usize,
    /// Forces besides `K u` \[force\].
    forces: Vec<[f64; 3]>,
    /// Overclosure of each row, of tangential ones the slip since sticking began [length].
    overclosures: Vec<f64>,
    rates: Vec<f64>,
    predicted: Vec<f64>,
    kick: KickWork,
    kinematic: KinematicWork,
    correction: Correction,
    limit: LimitWork,
    /// Limit by springs that do not change, and its row.
    straight: (f64, Option<u32>),
    /// Largest ratio of quadratic to linear bulk viscosity.
    bulk: f64,
    /// Power of the loads at the velocities before.
    loads: f64,
    /// Magnitude of what acts: numbers beyond all measure are found in it.
    size: f64,
}

/// An increment that was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// Energies at its start.
    pub energies: Energies,
    /// Largest momentum of a direction [mass·length/time].
    pub momentum: f64,
}

impl ExplicitWork {
    /// For a step.
    pub fn new(model: &ExplicitModel, nodal: &Nodal, step: usize) -> Self {
        let plan = &model.steps[step];
        let phase = &model.phases[plan.phase];
        let (rows, slots, nodes) = (nodal.rows(), phase.slots.at.len(), phase.inertia.masses.len());
        let mut limit = LimitWork::new(slots);
        let straight = increment_under(phase, plan, &plan.straight, plan.rules.len(), 1.0, &mut limit);
        limit.springs.reserve(plan.straight.len() + 3 * plan.curved.len());
        Self {
            step,
            forces: vec![[0.0; 3]; nodes],
            overclosures: vec![0.0; rows],
            rates: vec![0.0; rows],
            predicted: vec![0.0; rows],
            kick: KickWork::new(&phase.inertia),
            kinematic: KinematicWork::new(phase),
            correction: Correction::new(slots, rows),
            limit,
            straight,
            bulk: 0.0,
            loads: 0.0,
            size: 0.0,
        }
    }

    /// Step that it is for.
    pub fn step(&self) -> usize {
        self.step
    }

    /// Whether what acts at the start of the increment are numbers.
    pub fn is_finite(&self) -> bool {
        self.size.is_finite()
    }
}

/// Power of loads at some velocities.
fn load_power(columns: &[Column], coefficients: &[f64], v: &[[f64; 3]]) -> f64 {
    let of = |(column, &a): (&Column, &f64)| match column {
        Column::Force(entries) if a != 0.0 => {
            a * entries.iter().map(|&(node, d, value)| value * v[node.index()][usize::from(d)]).sum::<f64>()
        }
        _ => 0.0,
    };
    columns.iter().zip(coefficients).map(of).sum()
}

impl ExplicitModel {
    fn plan(&self, work: &ExplicitWork) -> &StepPlan {
        &self.steps[work.step]
    }

    /// Stable increment of a step without contact \[time\]; infinite where nothing limits it.
    pub fn free_increment(&self, step: usize) -> f64 {
        self.phases[self.steps[step].phase].limits.increment
    }

    /// Finds what acts at the start of an increment: contact, loads with their coefficients, damping.
    pub fn look(
        &self,
        nodal: &Nodal,
        columns: &[Column],
        loads: &[f64],
        memory: &mut Memory<'_>,
        work: &mut ExplicitWork,
    ) {
        let plan = &self.steps[work.step];
        let phase = &self.phases[plan.phase];
        let points = plan.rules.len();
        let (u, v) = (&*memory.displacement, &*memory.velocity);
        for (i, rule) in plan.rules.iter().enumerate().filter(|(_, r)| r.acts) {
            work.overclosures[i] = nodal.initial[i] + nodal.along(i, u);
            work.rates[i] = nodal.along(i, v);
            let Some(first) = rule.tangential.filter(|_| rule.rough) else { continue };
            for d in 0..2 {
                let row = first as usize + d;
                let slip = nodal.along(row, u);
                if !memory.stuck[i] {
                    memory.origins[d * points + i] = slip;
                }
                work.overclosures[row] = slip - memory.origins[d * points + i];
                work.rates[row] = nodal.along(row, v);
            }
        }
        work.forces.fill([0.0; 3]);
        work.bulk = phase.viscosity.resist(v, &mut work.forces);
        if let Some(damping) = &phase.damping {
            damping.multiply_add(-1.0, v, &mut work.forces);
        }
        for (column, &a) in columns.iter().zip(loads) {
            if let Column::Force(entries) = column
                && a != 0.0
            {
                for &(node, d, value) in entries {
                    work.forces[node.index()][usize::from(d)] += a * value;
                }
            }
        }
        let present = Present { overclosures: &work.overclosures, rates: &work.rates, latched: memory.latched };
        penalty::push(nodal, plan, &self.laws, &present, memory.forces, memory.viscous, &mut work.forces);
        work.loads = load_power(columns, loads, v);
        let of_points = plan.penalties.iter().map(|&i| memory.forces[i as usize]);
        work.size = of_points.chain(loads.iter().copied()).fold(work.loads, |sum, x| sum + x.abs());
    }

    /// Stable increment at the start of an increment that [`Self::look`] has seen, and the contact row that limits it, if one does;
    /// `wished`: no more is asked for \[time\]; `scale`: part of it that the increment will have.
    pub fn stable_increment(
        &self,
        wished: f64,
        scale: f64,
        memory: &Memory<'_>,
        work: &mut ExplicitWork,
    ) -> (f64, Option<u32>) {
        let plan = &self.steps[work.step];
        let phase = &self.phases[plan.phase];
        let bulk = 1.0 + work.bulk;
        let free = (phase.limits.nodes[phase.limits.slowest].increment(bulk), None);
        let least = |a: (f64, Option<u32>), b: (f64, Option<u32>)| if b.0 < a.0 { b } else { a };
        if plan.curved.is_empty() {
            let straight = match work.bulk > 0.0 && !plan.straight.is_empty() {
                true => increment_under(phase, plan, &plan.straight, plan.rules.len(), bulk, &mut work.limit),
                false => work.straight,
            };
            return least(free, straight);
        }
        // An increment into a law that stiffens must be stable at its end too.
        let (overclosures, rates) = (&work.overclosures, &work.rates);
        let at = |size: f64, limit: &mut LimitWork| {
            let mut list: Vec<Spring> = std::mem::take(&mut limit.springs);
            list.clear();
            list.extend_from_slice(&plan.straight);
            for &point in &plan.curved {
                let (i, rule) = (point as usize, &plan.rules[point as usize]);
                let here = overclosures[i] + rates[i].max(0.0) * scale * size;
                let slope = self.laws.evaluate(rule, here, memory.latched[i]).stiffness;
                if slope > 0.0 {
                    list.extend(springs(rule, point, slope));
                }
            }
            let found = increment_under(phase, plan, &list, plan.rules.len(), bulk, limit);
            limit.springs = list;
            least(free, found)
        };
        let far = wished.min(free.0);
        let first = at(far, &mut work.limit);
        if first.0 >= far {
            return if first.0 < free.0 { first } else { free };
        }
        // Sizes of any order of magnitude: the bracket is halved on a logarithmic scale.
        let (mut low, mut high, mut row) = (first.0, far, first.1);
        for _ in 0..HALVINGS {
            let middle = (low * high).sqrt();
            let found = at(middle, &mut work.limit);
            if found.0 >= middle {
                low = middle;
            } else {
                (high, row) = (middle, found.1);
            }
        }
        (low, row)
    }

    /// Goes from the start of an increment that [`Self::look`] has seen to its end, where prescribed directions have `coefficients`.
    #[allow(clippy::too_many_arguments)] // All of what an increment is made of.
    pub fn advance(
        &self,
        nodal: &Nodal,
        columns: &[Column],
        loads: &[f64],
        coefficients: &[f64],
        size: f64,
        memory: &mut Memory<'_>,
        work: &mut ExplicitWork,
    ) -> Result<Found, Refusal> {
        let plan = &self.steps[work.step];
        let phase = &self.phases[plan.phase];
        let before = if memory.last > 0.0 { memory.last } else { size };
        let times = Kick { mean: 0.5 * (before + size), size };
        self.stiffness.multiply(memory.displacement, memory.acceleration);
        let strain = 0.5 * dot(memory.displacement, memory.acceleration);
        let stored = self.stored(plan, memory, work);
        let mut vectors = Vectors {
            u: &mut *memory.displacement,
            v: &mut *memory.velocity,
            a: &mut *memory.acceleration,
            r: &mut *memory.reaction,
        };
        let mut sums = kick(&phase.inertia, times, &work.forces, coefficients, &mut vectors, &mut work.kick);
        let mut power = Power::default();
        if plan.has_kinematic() {
            for (i, rule) in plan.rules.iter().enumerate().filter(|(_, r)| is_kinematic(r)) {
                work.predicted[i] = nodal.initial[i] + nodal.along(i, vectors.u);
                for row in rule.tangential.filter(|_| rule.rough).into_iter().flat_map(|t| [t, t + 1]) {
                    let d = (row - rule.tangential.unwrap_or(row)) as usize;
                    work.predicted[row as usize] =
                        nodal.along(row as usize, vectors.u) - memory.origins[d * plan.rules.len() + i];
                }
            }
            let places = Places {
                predicted: &work.predicted,
                start: &work.overclosures,
                forces: memory.forces,
                latched: memory.latched,
                tau: times.tau(),
                size,
            };
            kinematic::solve(phase, plan, &self.laws, &places, &mut work.kinematic, &mut work.correction)?;
            let Correction { acceleration, thrust, forces, viscous } = &work.correction;
            let changed = amend(&phase.inertia, &phase.slots, times, acceleration, thrust, &work.forces, &mut vectors);
            sums.kinetic += changed.kinetic;
            sums.after += changed.forces;
            power.contact = [-changed.before, -changed.after];
            for (i, rule) in plan.rules.iter().enumerate().filter(|(_, r)| is_kinematic(r)) {
                memory.forces[i] = forces[i];
                memory.viscous[i] = viscous[i];
                for row in rule.tangential.into_iter().flat_map(|t| [t as usize, t as usize + 1]) {
                    memory.forces[row] = forces[row];
                }
                if viscous[i] != 0.0 {
                    let taken = [viscous[i] * work.rates[i], viscous[i] * nodal.along(i, vectors.v)];
                    (0..2).for_each(|k| {
                        power.viscous[k] += taken[k];
                        power.contact[k] -= taken[k];
                    });
                }
            }
        }
        let (v, a, r) = (&*vectors.v, &*vectors.a, &*vectors.r);
        power.external = reaction_power(&phase.inertia, times, v, a, r);
        let loads = [work.loads, load_power(columns, loads, v)];
        (0..2).for_each(|k| power.external[k] += loads[k]);
        // q v = loads v − contact − given v, for the given forces are loads − Bᵀ F − q.
        let mut resisted = [loads[0] - sums.before, loads[1] - sums.after];
        for row in penalty_rows(plan) {
            if memory.forces[row] != 0.0 || memory.viscous[row] != 0.0 {
                let rates = [work.rates[row], nodal.along(row, v)];
                for k in 0..2 {
                    resisted[k] -= memory.forces[row] * rates[k];
                    power.viscous[k] += memory.viscous[row] * rates[k];
                    power.contact[k] += (memory.forces[row] - memory.viscous[row]) * rates[k];
                }
            }
        }
        if phase.is_damped() {
            (0..2).for_each(|k| power.viscous[k] += resisted[k]);
        }
        let mut kinetic = sums.kinetic;
        if before != size {
            kinetic -= 0.25 * (size - before) * phase.inertia.power(v, a, size);
        }
        let stand = Stand { strain, kinetic, stored };
        if memory.last == 0.0 {
            memory.ledger.stored_start = stored;
        } else if memory.begins && plan.changed {
            // Pairs that come or go take what they store with them.
            memory.ledger.count_anew(stored, &power, before);
        }
        let energies = memory.ledger.book(stand, &power, before, size);
        self.keep_statuses(plan, memory);
        Ok(Found { energies, momentum: sums.momentum })
    }

    /// `Σ A U(h)` at the start of the increment.
    fn stored(&self, plan: &StepPlan, memory: &Memory<'_>, work: &ExplicitWork) -> f64 {
        let of = |(i, rule): (usize, &super::rules::Rule)| {
            let area = if is_kinematic(rule) { rule.area * rule.share } else { rule.area };
            area * self.laws.evaluate(rule, work.overclosures[i], memory.latched[i]).energy
        };
        let normal: f64 = plan.rules.iter().enumerate().filter(|(_, r)| r.acts).map(of).sum();
        // Sticking under a penalty is a spring.
        let sticking = plan.penalties.iter().map(|&i| (i, &plan.rules[i as usize])).filter(|(_, r)| r.rough);
        let tangential: f64 = sticking
            .flat_map(|(i, rule)| rule.tangential.into_iter().flat_map(|t| [t, t + 1]).map(move |row| (i, rule, row)))
            .filter(|&(i, ..)| memory.forces[i as usize] != 0.0)
            .map(|(_, rule, row)| 0.5 * rule.stiffness * work.overclosures[row as usize].powi(2))
            .sum();
        normal + tangential
    }

    fn keep_statuses(&self, plan: &StepPlan, memory: &mut Memory<'_>) {
        for (i, rule) in plan.rules.iter().enumerate() {
            memory.closed[i] = rule.acts && (memory.forces[i] != 0.0 || memory.latched[i]);
            memory.latched[i] = rule.acts && (memory.latched[i] || (rule.latches && memory.closed[i]));
            memory.stuck[i] = rule.rough && memory.closed[i];
            if !rule.acts {
                (memory.forces[i], memory.viscous[i]) = (0.0, 0.0);
            }
            for row in rule.tangential.into_iter().flat_map(|t| [t as usize, t as usize + 1]) {
                memory.closed[row] = memory.stuck[i];
                if !memory.stuck[i] {
                    (memory.forces[row], memory.viscous[row]) = (0.0, 0.0);
                }
            }
        }
    }

    /// What limits the stable increment: an element, a node or a contact point.
    pub fn limited_by(&self, work: &ExplicitWork) -> (Option<u32>, usize) {
        let limits = &self.phases[self.plan(work).phase].limits;
        (limits.element, limits.slowest)
    }
}

fn is_kinematic(rule: &super::rules::Rule) -> bool {
    rule.acts && rule.constraint == MechanicalConstraint::Kinematic
}

/// Normal and tangential rows of all penalty points.
fn penalty_rows(plan: &StepPlan) -> impl Iterator<Item = usize> + '_ {
    plan.penalties.iter().flat_map(|&point| {
        let tangential = plan.rules[point as usize].tangential.into_iter().flat_map(|t| [t as usize, t as usize + 1]);
        std::iter::once(point as usize).chain(tangential)
    })
}

fn dot(x: &[[f64; 3]], y: &[[f64; 3]]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x[0] * y[0] + x[1] * y[1] + x[2] * y[2]).sum()
}
