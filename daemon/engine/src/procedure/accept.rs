//! What an implicit dynamic increment leaves: the motion at its end, reactions, and where energy has gone.

use crate::implicit::Hht;
use crate::model::HalfIncrement;
use crate::nodal::{dot, largest, load};
use crate::procedure::failure::Failure;
use crate::procedure::interval::Interval;
use crate::simulation::Simulation;
use crate::solve::contact::{Curve, Row, Wall};

/// Part of its tolerance that a half-increment residual stays below where an increment of twice the size is tried: it grows with the
/// square of the size.
const EASY: f64 = 0.2;
/// By how much the work of softened contact may miss what its laws store in an increment, relative to the largest energy so far.
const CONTACT_WORK: f64 = 1e-4;

impl Simulation {
    /// Makes the trial in the work space the state.
    pub(crate) fn accept_motion(&mut self, end: f64, size: f64) -> Result<(), Failure> {
        let prepared = self.prepared.clone();
        let (nodal, model) = (prepared.nodal(), prepared.implicit());
        let control = self.dynamic_control();
        let (points, n) = (prepared.points.len(), prepared.rows.count());
        for (i, point) in prepared.points.iter().enumerate() {
            for (t, tangent) in point.tangents.into_iter().enumerate() {
                let mut slip = 0.0;
                let u = &self.implicit.displacement;
                point.row(tangent, |node, d, value| slip += value * u[node.index()][d]);
                self.work.tangential[t * n + i] = slip;
            }
        }
        let slid = self.slid();
        if !slid.is_empty() {
            return Err(Failure::Slid(slid));
        }
        let moment = Self::moment(&prepared, self.state.step as usize, end);
        self.keep_statuses(&moment);
        let (state, work, own) = (&mut self.state, &mut self.work, &mut self.implicit);
        let motion = state.motion.as_mut().expect("a dynamic step has a motion");
        load(&prepared.loading.columns, &state.coefficients, &mut own.loads[0]);
        // Multipliers of hard contact have the weight of inertia, all other forces that of internal ones.
        for (force, row) in work.forces.iter_mut().zip(&work.rows) {
            if row.wall == Wall::TwoSided {
                *force *= 1.0 + control.alpha;
            }
        }
        // What dashpots take: the trapezoidal rule on their way.
        let overclosure = |row: usize, u: &[[f64; 3]]| nodal.along(row, u);
        for (i, row) in work.rows.iter().enumerate() {
            let viscous = row.viscous_force(work.overclosures[i]);
            let way = overclosure(i, &own.displacement) - overclosure(i, &motion.displacement);
            motion.energies.viscous += 0.5 * (viscous + state.viscous[i]) * way;
            state.viscous[i] = viscous;
        }
        if let Some(damping) = model.damping(control.mass) {
            own.change.fill([0.0; 3]);
            damping.multiply_add(0.5, &own.velocity, &mut own.change);
            damping.multiply_add(0.5, &motion.velocity, &mut own.change);
            motion.energies.viscous += dot(&own.change, &own.displacement) - dot(&own.change, &motion.displacement);
        }
        // Work of loads and supports, by the trapezoidal rule; the new reactions come below.
        let way = |at: usize, from: &[[f64; 3]], to: &[[f64; 3]]| to.as_flattened()[at] - from.as_flattened()[at];
        let mut done = 0.0;
        for at in 0..3 * motion.displacement.len() {
            let forces = own.loads[0].as_flattened()[at] + own.loads[1].as_flattened()[at];
            if forces != 0.0 {
                done += 0.5 * forces * way(at, &motion.displacement, &own.displacement);
            }
        }
        let supports = |reaction: &[[f64; 3]], from: &[[f64; 3]], to: &[[f64; 3]]| -> f64 {
            nodal.prescribed.iter().map(|&at| 0.5 * reaction.as_flattened()[at] * way(at, from, to)).sum()
        };
        done += supports(&motion.reaction, &motion.displacement, &own.displacement);
        std::mem::swap(&mut motion.displacement, &mut own.displacement);
        std::mem::swap(&mut motion.velocity, &mut own.velocity);
        std::mem::swap(&mut motion.acceleration, &mut own.acceleration);
        motion.increment_last = size;
        motion.opened.fill(false);
        std::mem::swap(&mut state.forces, &mut work.forces);
        std::mem::swap(&mut state.closed, &mut work.closed);
        std::mem::swap(&mut state.tangential, &mut work.tangential);
        std::mem::swap(&mut state.multipliers, &mut work.multipliers);
        std::mem::swap(&mut state.coefficients, &mut work.coefficients);
        motion.rates.clear();
        motion.rates.extend(work.columns.iter().map(|column| column.rate));
        motion.curvatures.clear();
        motion.curvatures.extend(work.columns.iter().map(|column| column.acceleration));
        state.step_time = end;
        self.balance_motion(control.alpha);
        let (motion, own) = (self.state.motion.as_mut().expect("as above"), &self.implicit);
        done += supports(&motion.reaction, &own.displacement, &motion.displacement);
        motion.energies.external_work += done;
        self.measure_energies();
        self.settle_overclosures();
        debug_assert!(self.work.tangential.len() == 2 * n && points <= n);
        Ok(())
    }

    /// Overclosures of the state, as after a restore: the last increment's have other roundings.
    pub(crate) fn settle_overclosures(&mut self) {
        self.moved_overclosures();
        self.derived.overclosures.clone_from(&self.work.overclosures);
    }

    /// Forces out of balance without inertia and multipliers, strain energy, and reactions: of the state, with the loads at its time in `loads[1]`.
    /// Reactions are multipliers: behind an increment they take the forces of its start along as the operator's `alpha` says; at one time it is 0.
    pub(crate) fn balance_motion(&mut self, alpha: f64) {
        let prepared = self.prepared.clone();
        let (nodal, model, form) = (prepared.nodal(), prepared.implicit(), self.dynamic_control().mass);
        let (own, work) = (&mut self.implicit, &self.work);
        let motion = self.state.motion.as_mut().expect("a dynamic step has a motion");
        let force = &mut own.force;
        force.clear();
        model.stiffness.multiply(&motion.displacement, &mut own.change);
        motion.energies.strain = 0.5 * dot(&own.change, &motion.displacement);
        let internal = own.change.iter().zip(&own.loads[1]);
        force.extend(internal.map(|(k, load)| std::array::from_fn::<f64, 3, _>(|d| k[d] - load[d])));
        if let Some(damping) = model.damping(form) {
            damping.multiply_add(1.0, &motion.velocity, force);
        }
        let hard = |row: usize| work.rows.get(row).is_some_and(|row| row.wall == Wall::TwoSided);
        let (walls, others): (Vec<f64>, Vec<f64>) =
            (self.state.forces.iter().enumerate()).map(|(row, &f)| if hard(row) { (f, 0.0) } else { (0.0, f) }).unzip();
        nodal.push(&others, 1.0, force);
        std::mem::swap(&mut motion.unbalance, force);
        // R = M a_1 + (1 + α) r_1 − α r_0 + Bᵀ Λ at the supports.
        if alpha == 0.0 {
            force.clone_from(&motion.unbalance);
        } else {
            for (before, now) in force.iter_mut().zip(&motion.unbalance) {
                (0..3).for_each(|d| before[d] = (1.0 + alpha) * now[d] - alpha * before[d]);
            }
        }
        // Reactions hold what is left with inertia and multipliers.
        own.change.fill([0.0; 3]);
        model.mass(form).multiply_add(1.0, &motion.acceleration, &mut own.change);
        let inertia = largest(&own.change);
        for (force, inertia) in force.iter_mut().zip(&own.change) {
            (0..3).for_each(|d| force[d] += inertia[d]);
        }
        nodal.push(&walls, 1.0, force);
        nodal.restrict(force);
        motion.reaction.as_flattened_mut().fill(0.0);
        for &at in &nodal.prescribed {
            motion.reaction.as_flattened_mut()[at] = force.as_flattened()[at];
        }
        let contact = self.state.forces.iter().fold(0.0f64, |m, f| m.max(f.abs()));
        motion.force_max = motion.force_max.max(largest(&own.loads[1])).max(inertia).max(contact);
    }

    /// Kinetic and contact energies of the state, and the total with what is strained, was dissipated and supplied.
    pub(crate) fn measure_energies(&mut self) {
        let prepared = self.prepared.clone();
        let (model, form) = (prepared.implicit(), self.dynamic_control().mass);
        let (own, state) = (&mut self.implicit, &mut self.state);
        let motion = state.motion.as_mut().expect("a dynamic step has a motion");
        model.mass(form).multiply(&motion.velocity, &mut own.change);
        motion.energies.kinetic = 0.5 * dot(&own.change, &motion.velocity);
        motion.momentum_max = motion.momentum_max.max(largest(&own.change));
        let behaviors = &prepared.model.interactions;
        motion.energies.contact = (self.work.rows.iter().zip(&self.work.overclosures).zip(&state.closed))
            .filter(|(_, closed)| **closed)
            .map(|((row, &h), _)| row.area * row.law_of(|i| &behaviors[i].normal, h).energy)
            .sum();
        let e = &mut motion.energies;
        e.total = e.strain + e.kinetic + e.contact + e.viscous + e.friction + e.impact_loss - e.external_work;
        let present = [e.strain, e.kinetic, e.contact, e.external_work.abs()].into_iter().fold(0.0, f64::max);
        motion.energy_max = motion.energy_max.max(present);
    }

    /// Compares the residual half-way with its tolerance; whether a larger increment would do.
    pub(crate) fn check_half_increment(&mut self, end: f64, size: f64, interval: &Interval) -> Result<bool, Failure> {
        let control = self.dynamic_control();
        if control.direct || control.half_increment == HalfIncrement::Unchecked {
            return Ok(true);
        }
        let (residual, inertia) = self.half_increment_residual(end, size, interval);
        let tolerance = match control.half_increment {
            HalfIncrement::Unchecked => f64::INFINITY,
            HalfIncrement::Force(force) => force,
            HalfIncrement::Relative(factor) => factor * self.force_scale().max(inertia),
        };
        if residual > tolerance {
            return Err(Failure::HalfIncrement { residual, tolerance });
        }
        let (error, largest) = self.contact_work_error();
        if error > CONTACT_WORK * largest {
            return Err(Failure::ContactWork { error, largest });
        }
        Ok(residual < EASY * tolerance && error < EASY * CONTACT_WORK * largest)
    }

    /// By how much the work of softened contact and penalties in the trial misses what their curves store, and the largest energy so
    /// far, kinetic energy of the trial included: a point that meets its curve, or bends along it, within an increment does work by
    /// the trapezoidal rule \[energy\].
    fn contact_work_error(&mut self) -> (f64, f64) {
        let (prepared, form) = (self.prepared.clone(), self.dynamic_control().mass);
        let own = &mut self.implicit;
        prepared.implicit().mass(form).multiply(&own.velocity, &mut own.change);
        let kinetic = 0.5 * dot(&own.change, &own.velocity);
        let behaviors = &self.prepared.model.interactions;
        let error = |(i, row): (usize, &Row)| {
            let (h0, h1) = (self.derived.overclosures[i], self.work.overclosures[i]);
            let [start, end] = [h0, h1].map(|h| row.law_of(|i| &behaviors[i].normal, h));
            row.area * (0.5 * (start.pressure + end.pressure) * (h1 - h0) - (end.energy - start.energy)).abs()
        };
        let curves = self.work.rows.iter().enumerate().filter(|(_, row)| row.curve != Curve::None);
        let largest = self.state.motion.as_ref().map_or(kinetic, |motion| motion.energy_max.max(kinetic));
        (curves.map(error).sum(), largest)
    }

    /// Largest force at work so far, that of the trial included; what would stop the largest momentum within the step where that is more:
    /// before the first contact no force has been at work.
    fn force_scale(&self) -> f64 {
        let own = &self.implicit;
        let motion = self.state.motion.as_ref().expect("a dynamic step has a motion");
        let contact = self.work.forces.iter().fold(0.0f64, |m, f| m.max(f.abs()));
        let stopping = motion.momentum_max / self.dynamic_control().period;
        motion.force_max.max(largest(&own.loads[1])).max(contact).max(stopping)
    }

    /// Largest force out of balance in the middle of the trial, accelerations going linearly from start to end: what a free direction
    /// would need to follow; and the largest inertia force there.
    fn half_increment_residual(&mut self, end: f64, size: f64, interval: &Interval) -> (f64, f64) {
        let prepared = self.prepared.clone();
        let (nodal, model) = (prepared.nodal(), prepared.implicit());
        let control = self.dynamic_control();
        let weight = 1.0 + control.alpha;
        let half = Hht::new(control.alpha, 0.5 * size);
        let mut coefficients = Vec::new();
        self.coefficients_at(end - 0.5 * size, interval, &mut coefficients);
        let motion = self.state.motion.as_ref().expect("a dynamic step has a motion");
        let own = &mut self.implicit;
        let nodes = motion.displacement.len();
        let (mut u, mut v, mut a) = (vec![[0.0; 3]; nodes], vec![[0.0; 3]; nodes], vec![[0.0; 3]; nodes]);
        for i in 0..nodes {
            for d in 0..3 {
                let (u0, v0, a0) = (motion.displacement[i][d], motion.velocity[i][d], motion.acceleration[i][d]);
                let middle = 0.5 * (a0 + own.acceleration[i][d]);
                let (u1, v1) = half.predict(u0, v0, a0);
                u[i][d] = u1 + half.size * half.size * half.beta * middle;
                v[i][d] = v1 + half.size * half.gamma * middle;
                a[i][d] = middle;
            }
        }
        let mut force = vec![[0.0; 3]; nodes];
        model.mass(control.mass).multiply(&a, &mut force);
        let inertia = largest(&force);
        load(&prepared.loading.columns, &coefficients, &mut own.change);
        for ((f, load), unbalance) in force.iter_mut().zip(&own.change).zip(&motion.unbalance) {
            (0..3).for_each(|d| f[d] -= weight * load[d] + control.alpha * unbalance[d]);
        }
        model.stiffness.multiply_add(weight, &u, &mut force);
        if let Some(damping) = model.damping(control.mass) {
            damping.multiply_add(weight, &v, &mut force);
        }
        let behaviors = &prepared.model.interactions;
        let contact: Vec<f64> = (self.work.rows.iter().enumerate())
            .map(|(i, row)| match row.wall {
                Wall::TwoSided => 0.5 * (self.state.forces[i] + weight * self.work.forces[i]),
                Wall::None | Wall::OneSided => {
                    let h = 0.5 * (self.derived.overclosures[i] + self.work.overclosures[i]);
                    let law = row.area * row.law_of(|i| &behaviors[i].normal, h).pressure;
                    weight * (law + 0.5 * (self.state.viscous[i] + row.viscous_force(self.work.overclosures[i])))
                }
            })
            .collect();
        nodal.push(&contact, 1.0, &mut force);
        nodal.restrict(&mut force);
        for &at in &nodal.prescribed {
            force.as_flattened_mut()[at] = 0.0;
        }
        (largest(&force), inertia)
    }
}
