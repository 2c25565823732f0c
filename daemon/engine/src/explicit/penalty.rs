//! Penalty contact: forces by the law at the present place, with damping, on both sides.
//!
//! ```text
//! f = A p(h) + c ḣ        ḣ that of the middle of the increment before; clipped at zero where surfaces may separate
//! ```

use super::plan::StepPlan;
use super::rules::{Laws, Rule};
use crate::nodal::Nodal;

/// Points at the start of an increment.
pub struct Present<'a> {
    /// Overclosures; of tangential rows the slip since sticking began [length].
    pub overclosures: &'a [f64],
    /// Rates of all rows [length/time].
    pub rates: &'a [f64],
    /// Whether points may not separate any more.
    pub latched: &'a [bool],
}

/// Puts the forces of all penalty points, and their viscous parts, into `forces` and `viscous`, and adds them to nodal forces.
pub fn push(
    nodal: &Nodal,
    plan: &StepPlan,
    laws: &Laws,
    present: &Present<'_>,
    forces: &mut [f64],
    viscous: &mut [f64],
    nodal_forces: &mut [[f64; 3]],
) {
    let out = nodal_forces.as_flattened_mut();
    let mut add = |row: usize, force: f64| {
        for &(at, b) in nodal.row(row) {
            out[at as usize] -= b * force;
        }
    };
    for &point in &plan.penalties {
        let (i, rule) = (point as usize, &plan.rules[point as usize]);
        let (total, part, slope) = normal(laws, rule, present, i);
        forces[i] = total;
        viscous[i] = part;
        if total != 0.0 {
            add(i, total);
        }
        let Some(first) = rule.tangential else { continue };
        for row in [first as usize, first as usize + 1] {
            (forces[row], viscous[row]) = (0.0, 0.0);
            if rule.rough && (total != 0.0 || slope > 0.0) {
                let c = rule.tangent_fraction * rule.viscosity(slope);
                viscous[row] = c * present.rates[row];
                forces[row] = rule.stiffness * present.overclosures[row] + viscous[row];
                add(row, forces[row]);
            }
        }
    }
}

/// Force of a point, its viscous part, and the slope of its law.
fn normal(laws: &Laws, rule: &Rule, present: &Present<'_>, i: usize) -> (f64, f64, f64) {
    let latched = present.latched[i];
    let at = laws.evaluate(rule, present.overclosures[i], latched);
    if at.pressure == 0.0 && !latched {
        return (0.0, 0.0, 0.0);
    }
    let elastic = rule.area * at.pressure;
    let viscous = rule.viscosity(at.stiffness) * present.rates[i];
    let total = elastic + viscous;
    if total < 0.0 && !latched { (0.0, -elastic, at.stiffness) } else { (total, viscous, at.stiffness) }
}
