//! The audit of a solution: what a careful analyst would check before believing it.

use crate::model::Enforcement;
use crate::nodal::largest;
use crate::simulation::Simulation;
use crate::state::Motion;

/// Unbalanced force, relative to the forces at work, that rounding explains.
const BALANCE_TOLERANCE: f64 = 1e-8;
/// Overclosure of a closed hard point, relative to the largest overclosure that contact prevents.
const HARD_TOLERANCE: f64 = 1e-8;
/// Overclosure, relative to the size of the model and the way that bodies go, that rounding explains.
const PLACE_ROUNDING: f64 = 1e-13;
/// Part of a tolerance of the deck by which rounding may exceed it.
const TOLERATED: f64 = 1e-9;
/// Change of ETOTAL, relative to the largest energy so far, beyond which a dynamic solution is not to be trusted.
const ENERGY_DRIFT_MAX: f64 = 0.05;
/// Energy that contact may make by the error of its time integration, relative to the largest energy so far.
const ENERGY_MADE_MAX: f64 = 0.01;
/// Overclosure, relative to the face, beyond which a softened law is outside small sliding (HCRIT: half a face).
const OVERCLOSURE_MAX: f64 = 0.5;

impl Simulation {
    /// What the audit of the present solution found; empty when clean.
    pub fn audit(&self) -> Vec<String> {
        let mut findings = Vec::new();
        match &self.state.motion {
            None => self.audit_balance(&mut findings),
            Some(motion) => audit_energy(motion, self.prepared.extent, &mut findings),
        }
        self.audit_points(&mut findings);
        findings
    }

    /// Reactions and loads add up to zero in each direction, except where equations or springs to the ground take part.
    fn audit_balance(&self, findings: &mut Vec<String>) {
        let prepared = &self.prepared;
        let (coefficients, forces) = (&self.state.coefficients, &self.state.forces);
        // Forces at work before anything cancels: what prescribed displacements and loads would do alone.
        let mut scale: f64 = forces.iter().map(|f| f.abs()).sum();
        for (column, a) in coefficients.iter().enumerate() {
            scale += match prepared.statics().condensed.is_displacement[column] {
                true => prepared.statics().condensed.unrelieved[column] * a.abs(),
                false => prepared.load_totals[column].iter().map(|t| (t * a).abs()).sum(),
            };
        }
        for d in 0..3 {
            if !prepared.translates[d] {
                continue;
            }
            let Some(column) = prepared.outputs.all_reactions[d] else { continue };
            let reaction = prepared.statics().condensed.conjugate(column, self.state.response());
            let load: f64 = prepared.load_totals.iter().zip(coefficients).map(|(total, a)| total[d] * a).sum();
            if (reaction + load).abs() > BALANCE_TOLERANCE * scale {
                findings.push(format!(
                    "force balance in direction {}: reactions {reaction:e} and loads {load:e} differ by {:e}",
                    d + 1,
                    reaction + load
                ));
            }
        }
    }

    /// No tension, no overclosure of hard points, no overclosure that small sliding does not cover.
    fn audit_points(&self, findings: &mut Vec<String>) {
        let prepared = &self.prepared;
        let moment = Self::moment(prepared, self.state.step as usize, self.state.step_time);
        // What contact prevents: overclosures without its forces, in dynamic steps the way of the bodies.
        let scale = match &self.state.motion {
            None => self.work.free.iter().fold(0.0f64, |m, h| m.max(h.abs())),
            Some(motion) => largest(&motion.displacement),
        };
        // Of coordinates, and of motions that go a long way.
        let motion = self.state.motions.iter().fold(0.0f64, |m, a| m.max(a.abs()));
        let rounding = PLACE_ROUNDING * prepared.extent.max(motion);
        let at_work = |motion: &Motion| motion.force_scale(motion.increment_last);
        let force_scale = self.state.motion.as_ref().map_or(0.0, at_work);
        let force_scale = self.state.forces.iter().fold(force_scale, |m, f| m.max(f.abs()));
        let (mut tension, mut overlap, mut deep) = (Vec::new(), Vec::new(), Vec::new());
        for (i, point) in prepared.points.iter().enumerate() {
            let (force, overclosure) = (self.state.forces[i], self.derived.overclosures[i]);
            let label = prepared.model.mesh.node_labels[point.node.index()];
            let modified = moment.modified(i).filter(|_| !self.state.latched[i]);
            let tension_max = modified.map_or(0.0, |m| m.tension_max * point.area * (1.0 + TOLERATED));
            // What pulls on purpose is no finding: dashpots, latched points, what a removed pair still carries.
            let pulls = self.state.latched[i] || self.state.viscous[i] != 0.0 || !moment.is_active(i);
            if !pulls && force < -1e-10 * force_scale - tension_max {
                tension.push(label);
            }
            let allowed = modified
                .map_or(0.0, |m| m.overclosure_max * (1.0 + TOLERATED))
                .max(moment.penetration_max(i).map_or(0.0, |(tolerance, _)| tolerance) * (1.0 + TOLERATED));
            let hard = match moment.enforcement(i) {
                Some(Enforcement::Lagrange) => moment.is_active(i) && moment.is_exact(i),
                Some(Enforcement::AugmentedLagrange(_)) => moment.is_active(i),
                Some(Enforcement::Penalty(_) | Enforcement::NonlinearPenalty(_)) | None => false,
            };
            if hard && self.state.step_time > 0.0 && overclosure > HARD_TOLERANCE * scale + rounding + allowed {
                overlap.push(label);
            }
            if overclosure > OVERCLOSURE_MAX * point.face_size {
                deep.push(label);
            }
        }
        let mut report = |what: &str, labels: Vec<u32>| {
            if !labels.is_empty() {
                let shown: Vec<String> = labels.iter().take(8).map(u32::to_string).collect();
                let more = if labels.len() > 8 { ", …" } else { "" };
                findings.push(format!("{what} at {} contact points: node {}{more}", labels.len(), shown.join(", ")));
            }
        };
        report("tension where the law allows none", tension);
        report("overclosure of hard contact", overlap);
        report("overclosure of more than half a primary face, which small sliding does not cover", deep);
    }
}

/// ETOTAL stays what it was, and contact makes no energy.
fn audit_energy(motion: &Motion, extent: f64, findings: &mut Vec<String>) {
    let drift = motion.energies.total - motion.energy_start;
    // Forces along the last digits of places.
    let rounding = PLACE_ROUNDING * extent * motion.force_scale(motion.increment_last);
    if drift.abs() > ENERGY_DRIFT_MAX * motion.energy_max + rounding {
        findings.push(format!(
            "energy balance: ETOTAL has changed by {drift:e}, the largest energy is {:e}: increments are too large for this motion",
            motion.energy_max
        ));
    }
    let lost = motion.energies.impact_loss;
    if lost < -ENERGY_MADE_MAX * motion.energy_max - rounding {
        findings.push(format!(
            "contact has made energy: IMPACT_LOSS is {lost:e}, the largest energy is {:e}: increments are too large for the stiffness of its penalty or law",
            motion.energy_max
        ));
    }
}
