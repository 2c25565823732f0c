//! `*FIXED MASS SCALING`: factors on the masses of elements.

use super::elements::Part;
use crate::model::{ElementId, ExplicitControl, MassScaling, MassScalingKind, Model};

/// Halvings of the bracket around a factor: below the last digit.
const HALVINGS: usize = 80;

/// Applies the lines of a step to the factors that earlier steps have left, one for each part.
pub fn scale(model: &Model, parts: &[Part], control: &ExplicitControl, factors: &mut [f64]) {
    for line in &control.mass_scaling {
        apply(model, parts, control.bulk_viscosity[0], line, factors);
    }
}

fn apply(model: &Model, parts: &[Part], linear: f64, line: &MassScaling, factors: &mut [f64]) {
    let set = line.element_set.map(|set| &model.mesh.element_sets[set.index()].elements);
    let chosen = |part: &Part| set.is_none_or(|set| set.binary_search(&ElementId(part.element)).is_ok());
    let limit = |part: &Part, factor: f64| part.increment(model, linear, factor);
    match line.kind {
        MassScalingKind::Factor(factor) => {
            parts.iter().zip(factors).filter(|(p, _)| chosen(p)).for_each(|(_, f)| *f *= factor);
        }
        MassScalingKind::Uniform(target) => {
            let slowest = parts.iter().zip(&*factors).filter(|(p, _)| chosen(p));
            let slowest = slowest.map(|(p, f)| (limit(p, *f), p, *f)).min_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((now, part, factor)) = slowest.filter(|s| s.0.is_finite()) {
                let by = factor_for(|f| limit(part, f), now, factor, target) / factor;
                parts.iter().zip(factors).filter(|(p, _)| chosen(p)).for_each(|(_, f)| *f *= by);
            }
        }
        MassScalingKind::BelowMin(target) | MassScalingKind::SetEqual(target) => {
            let only_below = matches!(line.kind, MassScalingKind::BelowMin(_));
            for (part, factor) in parts.iter().zip(factors).filter(|(p, _)| chosen(p)) {
                let now = limit(part, *factor);
                if now.is_finite() && (now < target || !only_below) {
                    *factor = factor_for(|f| limit(part, f), now, *factor, target);
                }
            }
        }
    }
}

/// Factor that gives an element a stable increment: without damping it goes with the square of the increment.
fn factor_for(limit: impl Fn(f64) -> f64, now: f64, factor: f64, target: f64) -> f64 {
    let guess = factor * (target / now) * (target / now);
    if (limit(guess) - target).abs() <= 4.0 * f64::EPSILON * target {
        return guess;
    }
    // Mass-proportional damping and damping by stiffness change with the factor in their own ways.
    let (mut low, mut high) = (guess, guess);
    for _ in 0..HALVINGS {
        if limit(low) > target {
            low *= 0.5;
        }
        if limit(high) < target {
            high *= 2.0;
        }
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if limit(middle) < target { low = middle } else { high = middle }
    }
    high
}
